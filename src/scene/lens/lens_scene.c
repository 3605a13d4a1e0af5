/* Reads a lens system back from the solids of a scene (lens_prescription.h). */
#include "base/number.h"
#include "geometry/shapes/shape.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OFF_AXIS 1e-9 /* of the diameter: rounding of positions */

/* The factor of a solid's own and its leader's scale. */
static double size_of(const solid *of)
{
    return of->shape.scale.x;
}

/* A lens of the scene, with its place on the axis. */
typedef struct placed_lens {
    const solid *of;
    double y_1, y_2;
    size_t order; /* in the scene */
} placed_lens;

typedef struct lens_finder {
    const scene *s;
    const char *name;
    placed_lens lens[LENS_SURFACES_MAX];
    size_t count;
    vec3 origin, axis;
    const solid *stop, *screen;
    lens_prescription *p;
    diagnostic *why;
} lens_finder;

static bool ends_in(const char *text, const char *ending)
{
    const size_t a = strlen(text), b = strlen(ending);
    return a >= b && strcmp(text + a - b, ending) == 0;
}

static bool is_shape(const solid *of, const char *word)
{
    return strcmp(shape_name(of->shape.kind), word) == 0;
}

static bool belongs(const lens_finder *f, const char *name)
{
    const size_t length = strlen(f->name);
    return length == 0 || (strncmp(name, f->name, length) == 0 && (name[length] == '-' || !name[length]));
}

static double get(const lens_finder *f, const solid *of, const char *row, int side)
{
    char path[2 * SCENE_NAME_MAX], *text = NULL, word[32];
    double value = 0.0;
    snprintf(word, sizeof word, row, side);
    snprintf(path, sizeof path, "%s.%s", of->name, word);
    if (param_find(PARAM_SOLID, word) && scene_get(f->s, path, &text, NULL) == STATUS_OK)
        number_parse_real(text, &value);
    free(text);
    return value;
}

static status refuse(const lens_finder *f, const solid *of, const char *remedy, const char *what)
{
    return diagnose(f->why, STATUS_BAD_INPUT, remedy, "%.60s %s", of->name, what);
}

static double along(const lens_finder *f, const solid *of)
{
    return vec3_dot(f->axis, vec3_sub(of->shape.position, f->origin));
}

static status check_axis(const lens_finder *f, const solid *of)
{
    const mat3 turn = rotation_from_deg(of->shape.rotation_deg);
    const vec3 way = placed_axis(&turn, 1), away = vec3_sub(of->shape.position, f->origin),
               aside = vec3_sub(away, vec3_scale(f->axis, vec3_dot(away, f->axis)));
    if (vec3_dot(way, f->axis) < 1.0 - OFF_AXIS ||
        vec3_length(aside) > OFF_AXIS * (size_of(of) * of->shape.diameter + vec3_length(away)))
        return refuse(f, of, "give the name of one system, or put its solids on one axis, with the same rotation",
                      "is not on the axis of the first lens");
    return STATUS_OK;
}

static int by_place(const void *a, const void *b)
{
    const placed_lens *x = a, *y = b;
    return (x->y_1 > y->y_1) - (x->y_1 < y->y_1);
}

static status add_lens(lens_finder *f, const solid *of, size_t order)
{
    if (material_is_opaque(&of->surface))
        return ends_in(of->name, "-screen")
                   ? STATUS_OK
                   : refuse(f, of, "use the file of the system", "is a mirror, or opaque; mirrors are not read back");
    if (f->count == 0) {
        const mat3 turn = rotation_from_deg(of->shape.rotation_deg);
        f->axis = placed_axis(&turn, 1);
        f->origin = of->shape.position;
    }
    if (f->count >= LENS_SURFACES_MAX / 2)
        return refuse(f, of, "give the name of one system", "is one lens too many");
    TRY(check_axis(f, of));
    const vec3 k = of->shape.scale;
    if (!(k.x > 0.0) || k.x != k.y || k.x != k.z)
        return refuse(f, of, "scale it by 3 equal numbers above 0", "is not scaled evenly, or mirrored");
    const double y = along(f, of);
    f->lens[f->count++] = (placed_lens){of, y, y + size_of(of) * of->shape.thickness, order};
    return STATUS_OK;
}

static status find(lens_finder *f)
{
    for (size_t i = 0; i < f->s->solid_count; i++) {
        const solid *of = &f->s->solids[i];
        if (!belongs(f, of->name))
            continue;
        if (is_shape(of, "cup") && of->shape.floor == 0.0 &&
            (ends_in(of->name, "-stop") || strcmp(of->name, "stop") == 0) && of->visible)
            f->stop = of;
        else if (ends_in(of->name, "-screen") || strcmp(of->name, "screen") == 0)
            f->screen = of;
        else if (is_shape(of, "lens") && of->visible)
            TRY(add_lens(f, of, i));
    }
    if (f->count == 0)
        return diagnose(f->why, STATUS_BAD_INPUT, "give a scene with solids of shape lens, or a lens file",
                        *f->name ? "no lens has a name that begins with %.60s-" : "the scene has no lens%.0s", f->name);
    qsort(f->lens, f->count, sizeof *f->lens, by_place);
    return STATUS_OK;
}

/* --- media --- */

/* Twelve digits, so that a product that was divided again is the published number. */
static double tidy(double x)
{
    char text[NUMBER_TEXT_MAX];
    double rounded = x;
    number_parse_real(number_format_digits(x, 12, text), &rounded);
    return rounded;
}

static status medium_of(const lens_finder *f, const solid *of, lens_medium *out)
{
    const material *m = &of->surface;
    const background *around = &f->s->background;
    const char *surroundings = surrounding_medium_name(around), *name = material_medium_name(m);
    *out = (lens_medium){.kind = LENS_CONSTANT, .glass_file = -1};
    if (surroundings && strcmp(surroundings, "air") != 0)
        return diagnose(f->why, STATUS_BAD_INPUT, "set background.medium to air, or background.ior to 1",
                        "the surroundings are %s", surroundings);
    out->around = surroundings ? 0.0 : around->ior;
    TRY(material_index_law(m, of->name, &out->law, f->why));
    out->n_d = tidy(lens_medium_index(out, LINE_HELIUM_D_NM));
    const double F = lens_medium_index(out, LINE_HYDROGEN_F_NM), C = lens_medium_index(out, LINE_HYDROGEN_C_NM);
    out->V_d = F != C ? tidy((out->n_d - 1.0) / (F - C)) : 0.0;
    if (name) {
        out->kind = LENS_CATALOGUE;
        snprintf(out->name, sizeof out->name, "%s", name);
    } else if (m->medium == MEDIUM_DATA) {
        out->kind = LENS_DATA;
        snprintf(out->name, sizeof out->name, "%s", m->medium_data);
        for (size_t i = 0; i < f->s->data_count; i++)
            if (strcmp(f->s->data[i].name, m->medium_data) == 0 && f->s->data[i].glass[0])
                snprintf(out->name, sizeof out->name, "%s", f->s->data[i].glass);
    } else if (out->V_d > 0.0) {
        out->kind = LENS_MODEL;
    }
    return STATUS_OK;
}

/* --- surfaces --- */

static lens_surface side_of(const lens_finder *f, const placed_lens *l, int side)
{
    const solid *of = l->of;
    const double k = size_of(of);
    double power = k * k * k;
    lens_surface s = {.radius = k * get(f, of, "radius_%d", side),
                      .conic = get(f, of, "conic_%d", side),
                      .diameter = k * get(f, of, "diameter_%d", side),
                      .medium = {.kind = LENS_AIR, .glass_file = -1}};
    for (int i = 0; i < LENS_EVEN_TERMS; i++, power *= k * k) {
        char row[16];
        snprintf(row, sizeof row, "a%d_%%d", 4 + 2 * i);
        s.even[i] = get(f, of, row, side) / power;
    }
    if (s.diameter == 0.0)
        s.diameter = k * of->shape.diameter;
    return s;
}

/* Appends a surface at y; the thickness of the one before it follows. */
static lens_surface *append(const lens_finder *f, double *last_y, double y, lens_surface s)
{
    lens_prescription *p = f->p;
    if (p->count > 0)
        p->surface[p->count - 1].thickness = tidy(y - *last_y);
    *last_y = y;
    p->surface[p->count] = s;
    return &p->surface[p->count++];
}

/* Whether the second solid, which begins within the first, has the true surface between them. */
static bool second_wins(const placed_lens *first, const placed_lens *second)
{
    return second->of->priority != first->of->priority ? second->of->priority > first->of->priority
                                                       : second->order < first->order;
}

static status read_surfaces(lens_finder *f)
{
    double last_y = 0.0;
    bool cemented = false;
    for (size_t i = 0; i < f->count; i++) {
        const placed_lens *l = &f->lens[i], *next = i + 1 < f->count ? l + 1 : NULL;
        lens_medium glass;
        TRY(medium_of(f, l->of, &glass));
        if (!cemented)
            append(f, &last_y, l->y_1, side_of(f, l, 1));
        f->p->surface[f->p->count - 1].medium = glass;
        cemented = next && next->y_1 < l->y_2;
        if (cemented && second_wins(l, next))
            append(f, &last_y, next->y_1, side_of(f, next, 1));
        else
            append(f, &last_y, l->y_2, side_of(f, l, 2));
    }
    if (f->screen)
        f->p->surface[f->p->count - 1].thickness = tidy(along(f, f->screen) - last_y);
    return STATUS_OK;
}

/* --- the stop --- */

/* A plane between the surfaces `at` - 1 and `at`, at y; y_before is that of the surface before it. */
static void insert_stop(lens_prescription *p, size_t at, double y, double y_before, double diameter)
{
    lens_surface *s = &p->surface[at];
    memmove(s + 1, s, (p->count++ - at) * sizeof *s);
    *s = (lens_surface){.diameter = diameter, .medium = {.kind = LENS_AIR, .glass_file = -1}};
    if (at == 0) {
        s->thickness = tidy(-y);
    } else {
        s->thickness = tidy(s[-1].thickness - (y - y_before));
        s[-1].thickness = tidy(y - y_before);
    }
    p->stop = (int)at;
}

/* A ring at the edge of a surface makes that surface the stop; another one is a plane in the air. */
static void read_stop(const lens_finder *f)
{
    lens_prescription *p = f->p;
    const double k = size_of(f->stop), half = k * f->stop->shape.inner_radius, height = k * f->stop->shape.height,
                 from = along(f, f->stop), rounding = 1e-9 * half;
    double y = 0.0, y_before = 0.0;
    size_t after = 0; /* the first surface beyond the plane */
    p->aperture_kind = LENS_APERTURE_STOP;
    for (size_t i = 0; i < p->count; i++) {
        const double edge = y + lens_surface_sag(&p->surface[i], half);
        if (fabs(edge - from) < rounding || fabs(edge - from - height) < rounding) {
            p->stop = (int)i;
            p->surface[i].diameter = 2.0 * half;
            return;
        }
        if (y <= from + 0.5 * height)
            after = i + 1, y_before = y;
        y += p->surface[i].thickness;
    }
    insert_stop(p, after, from + 0.5 * height, y_before, 2.0 * half);
}

/* --- fields and wavelengths: those of the system's beams --- */

static void add_field(lens_prescription *p, double x, double y)
{
    for (size_t i = 0; i < p->field_count; i++)
        if (p->field[i].x == x && p->field[i].y == y)
            return;
    if (p->field_count < LENS_LIST_MAX)
        p->field[p->field_count++] = (lens_field){x, y, 1.0};
}

static void add_wavelength(lens_prescription *p, double nm)
{
    for (size_t i = 0; i < p->wavelength_count; i++)
        if (p->wavelength[i].nm == nm)
            return;
    if (p->wavelength_count < LENS_LIST_MAX)
        p->wavelength[p->wavelength_count++] = (lens_wavelength){nm, 1.0};
}

static void read_beams(const lens_finder *f)
{
    const double deg = 57.295779513082320877;
    lens_prescription *p = f->p;
    p->field_count = p->wavelength_count = 0;
    for (size_t i = 0; i < f->s->beam_count; i++) {
        const beam *b = &f->s->beams[i];
        if (!belongs(f, b->name) || !strstr(b->name, "-field-") || !beam_is_parallel(b))
            continue;
        const mat3 turn = rotation_from_deg(f->lens[0].of->shape.rotation_deg);
        const vec3 d = mat3_apply_transposed(turn, beam_axis(b));
        if (!(d.y > 0.0))
            continue;
        add_field(p, tidy(deg * atan2(d.x, d.y)) + 0.0, tidy(deg * atan2(-d.z, d.y)) + 0.0);
        add_wavelength(p, b->lambda_nm);
    }
    if (p->field_count == 0)
        add_field(p, 0.0, 0.0);
    if (p->wavelength_count == 0)
        add_wavelength(p, f->s->render.lambda_nm);
}

/* Where the first surface of the prescription is, which may be the stop before the first lens. */
static lens_placement placement_of(const lens_finder *f)
{
    const double stop_y = f->stop ? along(f, f->stop) + 0.5 * size_of(f->stop) * f->stop->shape.height : INFINITY;
    return (lens_placement){.name = f->stop ? f->stop->name : NULL,
                            .position = vec3_add(f->origin, vec3_scale(f->axis, fmin(stop_y, f->lens[0].y_1))),
                            .rotation_deg = f->lens[0].of->shape.rotation_deg,
                            .scale = 1.0};
}

status lens_of_scene(const scene *s, const char *name, lens_prescription *out, lens_placement *at, diagnostic *why)
{
    *out = lens_prescription_empty();
    lens_finder *f = calloc(1, sizeof *f);
    out->surface = calloc(LENS_SURFACES_MAX + 2, sizeof *out->surface);
    status code = f && out->surface ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        *f = (lens_finder){.s = s, .name = name ? name : "", .p = out, .why = why};
        out->unit_mm = 1000.0 * s->render.unit_m;
        snprintf(out->title, sizeof out->title, "%.255s", s->title);
        code = find(f);
        THEN(code, read_surfaces(f));
        if (code == STATUS_OK && f->stop)
            read_stop(f);
    }
    if (code == STATUS_OK) {
        read_beams(f);
        lens_prescription_complete(out);
        if (at)
            *at = placement_of(f);
    } else {
        lens_prescription_release(out);
    }
    free(f);
    return code;
}
