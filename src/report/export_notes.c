/* Exports of scenes: the decision for every parameter, notes, and what the writers of the formats share. */
#include "base/array.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "report/scene_export.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

const char *const export_endings[EXPORT_FORMAT_COUNT] = {".pov", ".gltf", ".glb"};

/* --- the decisions --- */

#define SAID NULL /* or noted by the writer where it is not */
#define UNSEEN "" /* the image does not depend on it */
#define SETTINGS "the program that reads the file has its own settings of rendering"
#define TREES "POV-Ray traces ray trees, no random paths"
#define POLARISED "light has no polarisation"
#define SPECTRA "the image has three channels, and each medium one refractive index, that of render.lambda_nm"
#define PHOTONS "photons are left out: a clear solid casts the shadow of render.shadows=attenuated"
#define TONES "there are no tone curves"
#define SKIES "glTF has no sky: the reading program sets its own"
#define NO_RAIN "rain is left out; its sky is a gradient"
#define CIE_SKY "a CIE sky is left out; the sky has the colour of its zenith"
#define NO_AIR "the surroundings absorb no light"
#define SIZES "a light has no size"
#define SAMPLED_SIZES "the area of a light is sampled at 16 x 16 points, without regard to its direction"
#define CRYSTALS "there is no double refraction: a crystal has its ordinary index"
#define FILMS "there is no interference in thin films"
#define ONE_MATERIAL "a solid has its own material on its whole surface"
#define SHEETS "there are no polarising filters and wave plates"
#define TURBID "media do not scatter"
#define SMOOTH "surfaces that reflect or refract are smooth"
#define NO_AMBIENT "there is no ambient light"
#define HIGHLIGHTS "Phong's highlights are left out: surfaces have the roughness of their exponent"
#define MIRRORS "a reflectance that does not follow from the index is left out"
#define ONE_LAYER "layers of first hits are no image of light"
#define BEAM_LIGHT "beams are left out"

/* Names of parameters, separated by blanks. */
typedef struct decision {
    param_group group;
    const char *names, *pov, *gltf;
} decision;

static const decision decisions[] = {
    {PARAM_RENDER, "width height", SAID, SAID},
    {PARAM_RENDER, "depth min_weight weights transmission samples beyond lighting shadows", SAID, SETTINGS},
    {PARAM_RENDER, "integrator", TREES, SETTINGS},
    {PARAM_RENDER, "layer", ONE_LAYER, ONE_LAYER},
    {PARAM_RENDER, "radiance", "rays carry radiance, not basic radiance", SETTINGS},
    {PARAM_RENDER, "soft_shadows", SAMPLED_SIZES, SETTINGS},
    {PARAM_RENDER, "caustics photons", PHOTONS, SETTINGS},
    {PARAM_RENDER, "paths error sampler filter light_sampling roulette energy_compensation seed", TREES, SETTINGS},
    {PARAM_RENDER, "polarisation", POLARISED, POLARISED},
    {PARAM_RENDER, "spectrum wavelengths", SPECTRA, SPECTRA},
    {PARAM_RENDER, "lambda_nm unit_m", SAID, SAID},
    {PARAM_RENDER, "threads pool schedule tile tiles_per_worker pin accel build_threads keep rebuild count_tests",
     UNSEEN, UNSEEN},
    {PARAM_RENDER, "texturing", "textures are laid on with perspective", SETTINGS},

    {PARAM_CAMERA, "position target yaw_deg pitch_deg roll_deg projection fov_deg view_height", SAID, SAID},
    {PARAM_CAMERA, "aperture focus", SAID, "a camera has no lens: everything is in focus"},
    {PARAM_CAMERA, "analyser analyser_angle_deg", POLARISED, POLARISED},
    {PARAM_CAMERA, "exposure", SAID, SETTINGS},
    {PARAM_CAMERA, "tone white", TONES, TONES},

    {PARAM_BACKGROUND, "kind color horizon image brightness", SAID, SKIES},
    {PARAM_BACKGROUND, "rain drops", NO_RAIN, SKIES},
    {PARAM_BACKGROUND, "sun_elevation_deg sun_azimuth_deg sky_type", CIE_SKY, SKIES},
    {PARAM_BACKGROUND, "ambient", SAID, NO_AMBIENT},
    {PARAM_BACKGROUND, "ior medium", SAID, SAID},
    {PARAM_BACKGROUND, "absorb_per_m", NO_AIR, NO_AIR},

    /* said by the triangles that they make */
    {PARAM_MESH, "generate file handedness count level major minor around tube profile crease_deg size depth seed",
     SAID, SAID},
    {PARAM_MESH,
     "time_s script radius position velocity mass_kg stiffness bending through damping pressure gravity ground "
     "ground_y restitution friction integrator dt_s adaptive",
     SAID, SAID},
    {PARAM_MESH, "threads", UNSEEN, UNSEEN},

    {PARAM_TEXTURE, "file filter wrap_u wrap_v", SAID, SAID},
    {PARAM_TEXTURE, "space", SAID, "the values of an image are encoded as sRGB"},

    /* said by the index, the colour and the absorption that they give */
    {PARAM_DATA, "file glass column scale relative_to", SAID, SAID},

    {PARAM_LIGHT, "kind position target half_angle_deg color intensity reach", SAID, SAID},
    {PARAM_LIGHT, "spectrum spectrum_data temperature_k line_nm", SAID, SAID}, /* by their colour */
    {PARAM_LIGHT, "radius width height roll_deg angular_diameter_deg", SAID, SIZES},
    {PARAM_LIGHT, "polarised polarisation_deg", POLARISED, POLARISED},

    {PARAM_BEAM, "lights", BEAM_LIGHT, BEAM_LIGHT},
    {PARAM_BEAM,
     "kind follows position target direction normal rays pattern field_columns field_rows field_deg field_width "
     "angle_deg "
     "width white lambda_nm wavelengths power branches depth "
     "min_fraction color visible profile",
     UNSEEN, UNSEEN}, /* without `lights` an image shows no beam */

    {PARAM_MATERIAL, "color color_data diffuse emission transparency ior", SAID, SAID},
    {PARAM_MATERIAL, "ambient", SAID, NO_AMBIENT},
    {PARAM_MATERIAL, "specular shininess", SAID, HIGHLIGHTS},
    {PARAM_MATERIAL, "reflectivity", SAID, MIRRORS},
    {PARAM_MATERIAL, "extinction medium coefficients medium_data", SAID, SAID},
    {PARAM_MATERIAL, "extraordinary_ior optic_axis", CRYSTALS, CRYSTALS},
    {PARAM_MATERIAL, "film_thickness_nm film_ior coating coating_data", FILMS, FILMS},
    {PARAM_MATERIAL, "sheet sheet_axis sheet_pass sheet_block retardance_deg birefringence", SHEETS, SHEETS},
    {PARAM_MATERIAL, "roughness", SMOOTH, SAID},
    {PARAM_MATERIAL, "absorb_per_m absorb_spectrum absorb_data tint_distance", SAID, SAID},
    {PARAM_MATERIAL, "scatter_per_m scatter_data asymmetry", TURBID, TURBID},
    {PARAM_MATERIAL, "texture alpha alpha_cutoff", SAID, SAID},
    {PARAM_MATERIAL, "texture_size", SAID, "only meshes have textures"},
    {PARAM_MATERIAL, "checker checker_color", SAID, "there are no chequers: the surface has its first colour"},

    {PARAM_SOLID, "follows offset position rotation radius height m capillary_length contact_angle_deg contact_radius",
     SAID, SAID},
    {PARAM_SOLID, "inner_radius floor sides top_radius tube_radius radius_1 radius_2 thickness diameter", SAID, SAID},
    {PARAM_SOLID,
     "diameter_1 diameter_2 chamfer_1 chamfer_2 conic_1 conic_2 a4_1 a6_1 a8_1 a10_1 a12_1 a14_1 a16_1 a18_1 a20_1 "
     "a4_2 a6_2 a8_2 a10_2 "
     "a12_2 a14_2 a16_2 a18_2 a20_2 size mesh points scale copies spacing",
     SAID, SAID},
    {PARAM_SOLID,
     "a1_1 a2_1 a3_1 a5_1 a7_1 a9_1 a11_1 a13_1 a15_1 a1_2 a2_2 a3_2 a5_2 a7_2 a9_2 a11_2 a13_2 a15_2 form_1 form_2 "
     "radius_1_x radius_2_x conic_1_x conic_2_x",
     SAID, SAID},
    {PARAM_SOLID, "material_1 material_2 material_rim", ONE_MATERIAL, ONE_MATERIAL},
    {PARAM_SOLID, "shading priority visible", SAID, SAID},
};
enum { DECISIONS = sizeof decisions / sizeof *decisions };

static bool has_word(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = strstr(words, word); at; at = strstr(at + 1, word))
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || !at[length]))
            return true;
    return false;
}

const char *export_reason(const param *row, export_format format, bool *known)
{
    *known = false;
    for (size_t i = 0; i < DECISIONS; i++)
        if (decisions[i].group == row->group && has_word(decisions[i].names, row->name)) {
            *known = true;
            return format == EXPORT_POV ? decisions[i].pov : decisions[i].gltf;
        }
    return NULL;
}

/* --- notes --- */

enum { PLACES_SHOWN = 3 };

struct export_note {
    char *reason, *places[PLACES_SHOWN];
    size_t place_count;
};

static struct export_note *note_of(export_notes *n, const char *reason)
{
    for (size_t i = 0; i < n->count; i++)
        if (strcmp(n->list[i].reason, reason) == 0)
            return &n->list[i];
    char *copy = strdup(reason);
    if (!copy || !room_for_one(&n->list, n->count, sizeof *n->list)) {
        free(copy);
        return NULL;
    }
    n->list[n->count] = (struct export_note){.reason = copy};
    return &n->list[n->count++];
}

void export_note(export_notes *n, const char *where, const char *format, ...)
{
    char reason[400];
    va_list list;
    va_start(list, format);
    vsnprintf(reason, sizeof reason, format, list);
    va_end(list);
    struct export_note *one = note_of(n, reason);
    n->failed |= !one;
    if (!one || !where)
        return;
    for (size_t i = 0; i < one->place_count && i < PLACES_SHOWN; i++)
        if (strcmp(one->places[i], where) == 0)
            return;
    if (one->place_count < PLACES_SHOWN)
        n->failed |= !(one->places[one->place_count] = strdup(where));
    one->place_count++;
}

char *export_note_text(const export_notes *all, size_t at, diagnostic *why)
{
    const struct export_note *n = &all->list[at];
    text_writer to;
    char *text = NULL;
    if (text_writer_open(&to, why) != STATUS_OK)
        return NULL;
    for (size_t i = 0; i < n->place_count && i < PLACES_SHOWN; i++)
        fprintf(to.stream, "%s%s", i ? ", " : "", n->places[i]);
    if (n->place_count > PLACES_SHOWN)
        fprintf(to.stream, " and %zu more", n->place_count - PLACES_SHOWN);
    fprintf(to.stream, "%s%s", n->place_count ? ": " : "", n->reason);
    return text_writer_end(&to, STATUS_OK, &text, NULL, why) == STATUS_OK ? text : NULL;
}

void export_notes_release(export_notes *n)
{
    for (size_t i = 0; i < n->count; i++) {
        free(n->list[i].reason);
        for (size_t k = 0; k < PLACES_SHOWN; k++)
            free(n->list[i].places[k]);
    }
    free(n->list);
}

/* --- what the writers share --- */

const char *export_name(const export_work *w, int r)
{
    return w->s->solids[w->p->geometry->regions[r].solid].name;
}

bool export_has_branches(const scene *s)
{
    return s->render.lighting == LIGHTING_WHITTED &&
           (integrator_traits_of(&s->render)->tree || integrator_traits_of(&s->render)->by_chance);
}

bool export_is_clear(const export_work *w, int r)
{
    const region *b = &w->p->geometry->regions[r];
    return !b->opaque && !b->partial && export_has_branches(w->s);
}

/* The extent of a shape along a direction; an unbounded one's only along its normal. */
static double reach(const placed_shape *a, vec3 d)
{
    const vec3 up = placed_axis(&a->turn, 1);
    return a->rule->unbounded && vec3_dot(up, d) > 1.0 - 1e-12 ? placed_limit(a, d) : placed_farthest(a, d);
}

double export_gap(const solid_shape *a, const solid_shape *b)
{
    const placed_shape one = shape_placed(a), other = shape_placed(b);
    const mat3 world = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
               *axes[] = {&world, &one.turn, &other.turn};
    double most = -(double)INFINITY;
    for (int k = 0; k < 18; k++) {
        const vec3 axis = placed_axis(axes[k / 6], k % 6 / 2), d = k % 2 ? vec3_scale(axis, -1.0) : axis;
        most = fmax(most, -reach(&other, vec3_scale(d, -1.0)) - reach(&one, d));
    }
    return most;
}

vec3 export_layered_color(const export_work *w, int r)
{
    const layered_plan *l = w->p->layered;
    return layered_colors_at(l->surface[r], NULL, true, 1.0, w->p->ior[0], w->p->ior[r]).reflected;
}
