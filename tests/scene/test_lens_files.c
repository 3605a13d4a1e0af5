/* Tests of lens files, and of lens systems as solids: published prescriptions by rays that are traced through their
 * solids, round trips of the formats, damaged files, and solids that follow another one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/text.h"
#include "probe_fixture.h"
#include "scene/file/write.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"

#define LENSES "experiments/lenses/"

static void assert_near(double a, double b, double tolerance, const char *what)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%s: %.17g is not %.17g within %g", what, a, b, tolerance);
}

static lens_prescription read_lens(const char *path)
{
    lens_prescription p;
    diagnostic why = {.what = ""};
    if (lens_file_read(path, NULL, &p, &why) != STATUS_OK)
        fail_msg("%s:%ld: %s; %s", path, why.line, why.what, why.remedy);
    return p;
}

static scene *scene_of(const lens_prescription *p, const char *name)
{
    scene *s;
    diagnostic why = {.what = ""};
    if (lens_scene_create(p, NULL, &s, &why) != STATUS_OK || scene_check(s, &why) != STATUS_OK ||
        scene_load(s, &why) != STATUS_OK)
        fail_msg("%s: %s; %s", name, why.what, why.remedy);
    return s;
}

/* --- published prescriptions --- */

/* Focal length and back focal distance as published, in the file's unit, with the digits that are. Distances of images
 * whose published plane is not the paraxial one, and of thick image spaces, are left out (0). */
static const struct {
    const char *file;
    double efl, efl_within, back, back_within;
} published[] = {
    {"cooke-triplet.csv", 50.0, 0.05, 0, 0},
    {"double-gauss.csv", 100.0, 0.01, 61.487536, 0.001},
    {"heliar.csv", 10.0, 0.02, 8.5066, 0.02},
    {"tessar.csv", 4.0, 0.01, 3.4025, 0.02},
    {"petzval.csv", 2.0, 0.01, 0.3921, 0.01},
    {"telephoto.csv", 5.0, 0.005, 2.4796, 0.02},
    {"cemented-achromat.csv", 20.0, 0.01, 19.6059, 0.002},
    {"telescope-doublet.csv", 48.0, 0.02, 47.3562, 0.01},
    {"reverse-telephoto.csv", 2.0, 0.01, 2.35130547, 0.03},
    {"landscape.csv", 10.0, 0.05, 10.150245, 0.05},
    {"aspheric-condenser.csv", 26.0, 0.1, 18.09209481, 0.01},
    {"navarro-eye.csv", 0, 0, 16.3203, 0.0001},
    {"dgauss.50mm.dat", 50.0, 0.5, 0, 0},
    {"fisheye.10mm.dat", 10.0, 0.02, 0, 0},
    {"wide.22mm.dat", 22.0, 0.05, 0, 0},
    {"hubble.csv", 57600.0, 1.0, 6365.20955, 0.05},
};

static void published_values_are_those_of_the_files(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(published); i++) {
        char path[128];
        snprintf(path, sizeof path, LENSES "%s", published[i].file);
        lens_prescription p = read_lens(path);
        const lens_first_order f = lens_first_order_of(&p, p.wavelength[p.primary].nm);
        if (published[i].efl > 0.0)
            assert_near(f.efl, published[i].efl, published[i].efl_within, published[i].file);
        if (published[i].back > 0.0)
            assert_near(f.back, published[i].back, published[i].back_within, published[i].file);
        lens_prescription_release(&p);
    }
}

static size_t refractions_of(const lens_prescription *p)
{
    size_t count = 0;
    const lens_medium *before = &p->object_medium;
    for (size_t i = 0; i < p->count; before = &p->surface[i++].medium)
        count += p->surface[i].mirror || !lens_media_match(before, &p->surface[i].medium);
    return count;
}

/* The ray that has met all refracting surfaces, of those that enter at the height x; light travels along +z. */
static ray_node traced(const scene *s, const lens_prescription *p, double x, double from_z, const char *name)
{
    probe *tracer;
    ray_tree tree = {.node = NULL};
    diagnostic why = {.what = ""};
    assert_int_equal(probe_create(s, isa_best(), &tracer, &why), STATUS_OK);
    probe_use_one_wavelength(tracer);
    probe_limit_depth(tracer, 64, "");
    if (probe_path(tracer, vec3_make(x, 0, from_z), vec3_make(0, 0, 1), -1, &tree, &why) != STATUS_OK)
        fail_msg("%s: %s", name, why.what);
    const size_t at = refractions_of(p);
    if (at >= tree.count)
        fail_msg("%s: the path has %zu rays, not %zu", name, tree.count, at + 1);
    const ray_node node = tree.node[at];
    ray_tree_release(&tree);
    probe_destroy(tracer);
    return node;
}

/* A ray of 1e-5 focal lengths from the axis: its aberration is below 1e-9 of the focal length. It is traced through
 * the solids, the prediction is paraxial. */
static void thin_pencils_through_the_solids_meet_the_paraxial_focus(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(published); i++) {
        char path[128];
        snprintf(path, sizeof path, LENSES "%s", published[i].file);
        lens_prescription p = read_lens(path);
        if (p.surface[0].mirror) {
            lens_prescription_release(&p);
            continue;
        }
        scene *s = scene_of(&p, path);
        const lens_first_order f = lens_first_order_of(&p, p.wavelength[p.primary].nm);
        const double h = 1e-5 * f.efl;
        const ray_node r = traced(s, &p, h, -f.efl, path);
        double vertex = 0.0;
        for (size_t k = 0; k + 1 < p.count; k++)
            vertex += p.surface[k].thickness;
        const double slope = r.direction.x / r.direction.z,
                     n = lens_medium_index(&p.surface[p.count - 1].medium, p.wavelength[p.primary].nm);
        assert_near(r.origin.z - r.origin.x / slope, vertex + f.back, 3e-9 * f.efl, path);
        assert_near(-h / (slope * n), f.efl, 3e-9 * f.efl, path);
        scene_destroy(s);
        lens_prescription_release(&p);
    }
}

/* A Ritchey-Chretien telescope has no spherical aberration: rays from the primary's middle and rim meet at its focus.
 * They pass the hole that is cut by a solid of air. */
static void the_space_telescope_is_free_of_spherical_aberration(void **state)
{
    (void)state;
    lens_prescription p = read_lens(LENSES "hubble.csv");
    scene *s = scene_of(&p, "hubble");
    const lens_first_order f = lens_first_order_of(&p, 587.5618);
    for (int i = 0; i < 3; i++) {
        const ray_node r = traced(s, &p, 400.0 + 390.0 * i, -9000.0, "hubble");
        const double z = r.origin.z - r.origin.x * r.direction.z / r.direction.x;
        assert_near(z, -4910.01016 + f.back, 0.1, "focus"); /* its conics are rounded to 1e-6 */
    }
    assert_true(scene_find_solid(s, "objective-hole-1") >= 0);
    scene_destroy(s);
    lens_prescription_release(&p);
}

/* --- formats --- */

static char *written(const lens_prescription *p, const char *name)
{
    text_writer writer;
    char *text = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(text_writer_open(&writer, &why), STATUS_OK);
    const status code = lens_file_write(p, name, writer.stream, &why);
    if (text_writer_end(&writer, code, &text, NULL, &why) != STATUS_OK)
        fail_msg("%s: %s", name, why.what);
    return text;
}

static lens_prescription parsed(const char *name, const char *text, size_t size)
{
    lens_prescription p;
    diagnostic why = {.what = ""};
    if (lens_file_parse(name, text, size, NULL, &p, &why) != STATUS_OK)
        fail_msg("%s:%ld:%ld: %s; %s\n%s", name, why.line, why.column, why.what, why.remedy, text);
    return p;
}

/* numbers: whether media may have lost their names. */
static void assert_same_system(const lens_prescription *a, const lens_prescription *b, double within, const char *what)
{
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->stop, b->stop);
    for (size_t i = 0; i < a->count; i++) {
        const lens_surface *s = &a->surface[i], *t = &b->surface[i];
        assert_near(s->radius, t->radius, within * fabs(s->radius), what);
        assert_near(s->thickness, t->thickness, within * (1.0 + fabs(s->thickness)), what);
        assert_near(s->conic, t->conic, within, what);
        assert_int_equal(s->mirror, t->mirror);
        for (int k = 0; k < LENS_EVEN_TERMS; k++)
            assert_near(s->even[k], t->even[k], within, what);
        assert_near(lens_medium_index(&s->medium, LINE_HELIUM_D_NM), lens_medium_index(&t->medium, LINE_HELIUM_D_NM),
                    1e-11, what);
    }
    const lens_first_order f = lens_first_order_of(a, a->wavelength[a->primary].nm),
                           g = lens_first_order_of(b, b->wavelength[b->primary].nm);
    assert_near(f.efl, g.efl, 1e-9 * fabs(f.efl), what);
    assert_near(f.pupil_diameter, g.pupil_diameter, 1e-9 * f.pupil_diameter, what);
}

static void formats_hold_what_they_are_given(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(published); i++) {
        char path[128];
        snprintf(path, sizeof path, LENSES "%s", published[i].file);
        lens_prescription p = read_lens(path);
        const char *const names[] = {"a.csv", "a.zmx"};
        for (size_t k = 0; k < COUNT(names); k++) {
            char *text = written(&p, names[k]);
            lens_prescription again = parsed(names[k], text, strlen(text));
            assert_same_system(&p, &again, 1e-15, path);
            assert_int_equal(p.field_count, again.field_count);
            assert_int_equal(p.wavelength_count, again.wavelength_count);
            assert_near(p.wavelength[p.primary].nm, again.wavelength[again.primary].nm, 1e-9, path);
            free(text);
            lens_prescription_release(&again);
        }
        if (strstr(path, ".dat")) {
            char *text = written(&p, "a.dat");
            lens_prescription again = parsed("a.dat", text, strlen(text));
            assert_same_system(&p, &again, 1e-15, path);
            free(text);
            lens_prescription_release(&again);
        }
        lens_prescription_release(&p);
    }
}

static void scenes_give_their_systems_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(published); i++) {
        char path[128];
        diagnostic why = {.what = ""};
        snprintf(path, sizeof path, LENSES "%s", published[i].file);
        lens_prescription p = read_lens(path), again;
        scene *s = scene_of(&p, path);
        const bool within = p.surface[p.count - 1].medium.kind != LENS_AIR; /* the eye, closed by a flat surface */
        if (p.surface[0].mirror) {
            assert_int_equal(lens_of_scene(s, "objective", &again, NULL, &why), STATUS_BAD_INPUT);
            assert_non_null(strstr(why.what, "mirror"));
        } else if (!within) {
            assert_int_equal(lens_of_scene(s, "objective", &again, NULL, &why), STATUS_OK);
            assert_same_system(&p, &again, 1e-10, path);
            if (p.field_count > 1 && p.field_kind == LENS_FIELD_ANGLE)
                assert_near(p.field[1].y, again.field[1].y, 1e-9, path);
            lens_prescription_release(&again);
        }
        scene_destroy(s);
        lens_prescription_release(&p);
    }
}

/* --- files of Zemax --- */

#define ZMX_HEAD "UNIT MM X W\nENPD 10\nYFLN 0 5\nWAVM 1 0.5875618 1\nSURF 0\n  TYPE STANDARD\n  DISZ INFINITY\n"
#define ZMX_TAIL "SURF 3\n  TYPE STANDARD\n  DISZ 0\n"
#define ZMX_LENS \
    "SURF 1\n  STOP\n  CURV 0.02\n  DISZ 5\n  GLAS N-BK7 0 0 1.5 40\n  DIAM 6\nSURF 2\n  CURV -0.02\n  DISZ 47\n"

static void files_of_zemax_are_read_in_both_encodings(void **state)
{
    (void)state;
    const char *text = ZMX_HEAD ZMX_LENS ZMX_TAIL;
    const size_t size = strlen(text);
    char wide[2 * sizeof(ZMX_HEAD ZMX_LENS ZMX_TAIL) + 2] = "\xff\xfe";
    for (size_t i = 0; i < size; i++)
        wide[2 + 2 * i] = text[i], wide[3 + 2 * i] = 0;
    lens_prescription narrow = parsed("a.zmx", text, size), marked = parsed("a.ZMX", wide, 2 * size + 2),
                      unmarked = parsed("a.zmx", wide + 2, 2 * size);
    assert_same_system(&narrow, &marked, 0.0, "marked");
    assert_same_system(&narrow, &unmarked, 0.0, "unmarked");
    assert_near(narrow.surface[0].radius, 50.0, 0.0, "radius");
    assert_near(narrow.surface[0].diameter, 12.0, 0.0, "diameter");
    assert_string_equal(narrow.surface[0].medium.name, "bk7");
    assert_int_equal(narrow.stop, 0);
    assert_int_equal(narrow.field_count, 2);
    lens_prescription_release(&narrow);
    lens_prescription_release(&marked);
    lens_prescription_release(&unmarked);
}

static void refused(const char *name, const char *text, long line, long column, const char *what)
{
    lens_prescription p;
    diagnostic why = {.what = ""};
    assert_int_equal(lens_file_parse(name, text, strlen(text), NULL, &p, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what))
        fail_msg("'%s' does not contain '%s'", why.what, what);
    assert_int_equal(why.line, line);
    assert_int_equal(why.column, column);
    assert_true(why.remedy[0] != 0);
    assert_null(p.surface);
}

static void mistakes_are_located(void **state)
{
    (void)state;
    refused("a.zmx", ZMX_HEAD "SURF 1\n  TYPE COORDBRK\n" ZMX_TAIL, 9, 8, "type COORDBRK");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  CURV x\n" ZMX_TAIL, 9, 8, "CURV: 'x' is not a number");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  PARM 1 0.5\n" ZMX_TAIL, 9, 10, "r^2");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  GLAS SK99 0 0 1.5 40\n" ZMX_TAIL, 9, 8, "the glass 'SK99'");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  DISZ INFINITY\n" ZMX_TAIL, 9, 8, "infinitely far");
    refused("a.zmx", "UNIT FURLONG\n", 1, 6, "unknown unit");
    refused("a.zmx", "MODE NSC\n", 1, 6, "mode NSC");
    refused("a.zmx", "", 1, 0, "0 surfaces");
    refused("a.dat", "10 5 1.5 8\n-10 5 1 x\n", 2, 9, "the diameter");
    refused("a.dat", "10 5 1.5\n", 1, 0, "the diameter is missing");
    refused("a.dat", "10 5 -1.5 8\n", 1, 6, "index -1.5");
    refused("a.dat", "# nothing\n", 0, 0, "no surfaces");
    refused("a.csv", "radius,thickness,glas\n", 1, 18, "unknown column 'glas'");
    refused("a.csv", "pupli,3\n", 1, 1, "unknown key 'pupli'");
    refused("a.csv", "pupil,0\n", 1, 7, "out of range");
    refused("a.csv", "radius,thickness,medium\n1,2,unobtainium\n", 2, 5, "unobtainium");
    refused("a.csv", "radius,thickness,stop\n1,2,1\n1,2,1\n", 3, 5, "second surface");
    refused("a.csv", "radius,thickness,medium\n5,2,1.5\n5,2,mirror\n", 3, 0, "mirror behind glass");
    refused("a.txt", "1", 0, 0, "not that of a lens file");
}

static void media_have_many_spellings(void **state)
{
    (void)state;
    static const struct {
        const char *word;
        double n_d, V_d;
    } words[] = {{"N-BK7", 1.5168, 64.17},          {"bk7", 1.5168, 64.17},  {"1.62041/60.32", 1.62041, 60.32},
                 {"1.62041:60.32", 1.62041, 60.32}, {"517642", 1.517, 64.2}, {"1.5", 1.5, 0.0}};
    for (size_t i = 0; i < COUNT(words); i++) {
        lens_medium m;
        assert_int_equal(lens_medium_parse(words[i].word, NULL, &m, NULL), STATUS_OK);
        assert_near(lens_medium_index(&m, LINE_HELIUM_D_NM), words[i].n_d, 1e-5, words[i].word);
        const double F = lens_medium_index(&m, LINE_HYDROGEN_F_NM), C = lens_medium_index(&m, LINE_HYDROGEN_C_NM);
        if (words[i].V_d > 0.0)
            assert_near((words[i].n_d - 1.0) / (F - C), words[i].V_d, 0.01, words[i].word);
    }
}

/* --- damaged files --- */

static uint32_t next_number(uint32_t *state)
{
    *state ^= *state << 13, *state ^= *state >> 17, *state ^= *state << 5;
    return *state;
}

/* Any bytes give a system, with finite numbers, or one error with a remedy. */
static void damage(const char *name, const char *text, uint32_t seed)
{
    const size_t size = strlen(text);
    char *bad = malloc(size + 1);
    assert_non_null(bad);
    for (int round = 0; round < 300; round++) {
        memcpy(bad, text, size + 1);
        size_t length = size;
        for (uint32_t n = 1 + next_number(&seed) % 4; n > 0; n--) {
            const uint32_t at = next_number(&seed) % (uint32_t)size, how = next_number(&seed) % 4;
            if (how == 0)
                length = at;
            else
                bad[at] = how == 1 ? (char)next_number(&seed) : "\n ,-.e9#"[next_number(&seed) % 8];
        }
        lens_prescription p;
        diagnostic why = {.what = ""};
        if (lens_file_parse(name, bad, length, NULL, &p, &why) != STATUS_OK) {
            assert_true(why.what[0] && why.remedy[0] && !strchr(why.what, '\n'));
            assert_null(p.surface);
            continue;
        }
        scene *s = NULL;
        if (lens_scene_create(&p, NULL, &s, &why) != STATUS_OK)
            assert_true(why.what[0] && why.remedy[0]);
        scene_destroy(s);
        lens_prescription_release(&p);
    }
    free(bad);
}

static void damaged_files_are_refused_or_read(void **state)
{
    (void)state;
    static const char *const files[] = {"cooke-triplet.csv", "dgauss.50mm.dat", "aspheric-condenser.csv", "hubble.csv"};
    for (size_t i = 0; i < COUNT(files); i++) {
        char path[128];
        snprintf(path, sizeof path, LENSES "%s", files[i]);
        lens_prescription p = read_lens(path);
        char *csv = written(&p, "a.csv"), *zmx = written(&p, "a.zmx");
        damage("a.csv", csv, 1u + (uint32_t)i);
        damage("a.zmx", zmx, 17u + (uint32_t)i);
        damage("a.dat", "1 2 1.5 3\n0 1 0 2\n-5 2 1.6 3 40\n-6 9 1 3\n", 33u + (uint32_t)i);
        free(csv), free(zmx);
        lens_prescription_release(&p);
    }
}

/* --- lens systems of scenes --- */

static const char singlet[] = "render: {unit_m: 0.001}\n"
                              "lens_systems:\n"
                              "  eyepiece:\n"
                              "    position: [1, 2, 3]\n"
                              "    rotation: [0, 0, 30]\n"
                              "    scale: 2\n"
                              "    pupil: 4\n"
                              "    surfaces:\n"
                              "      - {radius: 20, thickness: 3, medium: 1.5, diameter: 8}\n"
                              "      - {radius: -15, thickness: 2, medium: 1.7, diameter: 8}\n"
                              "      - {radius: 0, thickness: 6, diameter: 8}\n"
                              "      - {thickness: 30, stop: on}\n";

static vec3 position_of(const scene *s, const char *name)
{
    const int at = scene_find_solid(s, name);
    assert_true(at >= 0);
    return s->solids[at].shape.position;
}

static void systems_move_as_one(void **state)
{
    (void)state;
    scene *s = scene_from(singlet);
    diagnostic why = {.what = ""};
    const mat3 before = rotation_from_deg(vec3_make(0, 0, 30));
    const vec3 stop = vec3_sub(position_of(s, "eyepiece-stop"), position_of(s, "eyepiece"));
    const vec3 along = mat3_apply_transposed(before, stop);
    assert_near(along.x, 0.0, 1e-14, "x");
    assert_near(along.y, 22.0, 0.01, "y");
    assert_int_equal(scene_set_assignment(s, "eyepiece.position=10,0,0", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(s, "eyepiece.rotation=90,0,0", &why), STATUS_OK);
    const vec3 now = position_of(s, "eyepiece-stop");
    assert_near(now.x, 10.0, 1e-14, "x");
    assert_near(now.y, 0.0, 1e-13, "y");
    assert_near(now.z, along.y, 1e-13, "z");
    assert_int_equal(scene_set_assignment(s, "eyepiece-2.position=0,0,0", &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "follows eyepiece"));
    assert_int_equal(scene_remove(s, "eyepiece", &why), STATUS_BAD_INPUT);
    assert_int_equal(scene_rename(s, "eyepiece", "ocular", &why), STATUS_OK);
    assert_int_equal(scene_move(s, "solids", vec3_make(0, 0, 1), &why), STATUS_OK);
    assert_near(position_of(s, "eyepiece-stop").z, along.y + 1.0, 1e-13, "moved");
    assert_int_equal(scene_turn(s, "solids", vec3_make(0, 90, 0), &why), STATUS_OK);
    assert_near(position_of(s, "eyepiece-stop").x, along.y + 1.0, 1e-12, "turned");
    scene *copy = scene_clone(s);
    assert_int_equal(scene_set_assignment(copy, "ocular.position=0,0,0", &why), STATUS_OK);
    assert_near(position_of(copy, "eyepiece-stop").x, along.y, 1e-12, "a clone");
    scene_destroy(copy);
    scene_destroy(s);
}

/* A point of the world in the frame of the solid objective. */
static vec3 local_of(const scene *s, vec3 point)
{
    const solid_shape *at = &s->solids[scene_find_solid(s, "objective")].shape;
    const vec3 v = mat3_apply_transposed(rotation_from_deg(at->rotation_deg), vec3_sub(point, at->position));
    return vec3_scale(v, 1.0 / at->scale.x);
}

static vec3 world_of(const scene *s, vec3 local)
{
    const solid_shape *at = &s->solids[scene_find_solid(s, "objective")].shape;
    const vec3 v = mat3_apply(rotation_from_deg(at->rotation_deg), vec3_scale(local, at->scale.x));
    return vec3_add(v, at->position);
}

/* The ray that begins at a point near a beam's start, along the beam. */
static ray_tree along_beam(const scene *s, const beam *b, vec3 local)
{
    probe *tracer;
    ray_tree tree = {.node = NULL};
    assert_int_equal(probe_create(s, isa_best(), &tracer, NULL), STATUS_OK);
    probe_limit_depth(tracer, 64, "");
    assert_int_equal(probe_path(tracer, world_of(s, local), vec3_normalize(beam_axis(b)), -1, &tree, NULL), STATUS_OK);
    probe_destroy(tracer);
    return tree;
}

static void same_rays(const lens_prescription *p, const scene *a, const scene *b)
{
    assert_int_equal(a->beam_count, b->beam_count);
    for (size_t i = 0; i < a->beam_count; i++) {
        const vec3 start = local_of(a, a->beams[i].position), there = local_of(b, b->beams[i].position);
        assert_near(vec3_length(vec3_sub(start, there)), 0.0, 1e-12, "start");
        assert_near(a->beams[i].width * 3.0, b->beams[i].width, 1e-12, "width");
        for (int k = 0; k < 5; k++) {
            const vec3 from = vec3_add(start, vec3_make(0.4 * k - 0.8, 0.0, 0.3 * k - 0.6));
            ray_tree one = along_beam(a, &a->beams[i], from), two = along_beam(b, &b->beams[i], from);
            for (size_t n = 0; n <= refractions_of(p); n++) {
                assert_true(n < one.count && n < two.count);
                const vec3 x = local_of(a, one.node[n].origin), y = local_of(b, two.node[n].origin);
                assert_near(vec3_length(vec3_sub(x, y)), 0.0, 1e-11, "a hit");
            }
            ray_tree_release(&one), ray_tree_release(&two);
        }
    }
}

static void moved_turned_and_scaled_systems_have_the_same_rays(void **state)
{
    (void)state;
    diagnostic why = {.what = ""};
    lens_prescription p = read_lens(LENSES "cooke-triplet.csv"), again;
    scene *a = scene_of(&p, "here"), *b = scene_of(&p, "there"), *c = scene_of(&p, "scaled by the page");
    assert_int_equal(scene_set_assignment(b, "objective.position=100,-20,3000", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(b, "objective.rotation=20,130,-40", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(b, "objective.scale=3,3,3", &why), STATUS_OK);
    assert_int_equal(scene_check(b, &why), STATUS_OK);
    same_rays(&p, a, b);
    assert_int_equal(lens_of_scene(b, "objective", &again, NULL, &why), STATUS_OK);
    for (size_t i = 0; i < p.count; i++) {
        assert_near(again.surface[i].radius, 3.0 * p.surface[i].radius, 1e-9 * fabs(p.surface[i].radius), "radius");
        assert_near(again.surface[i].thickness, 3.0 * p.surface[i].thickness, 1e-9, "thickness");
    }
    lens_prescription_release(&again);
    /* as the page drags: one scale, then a move and a turn of the first element */
    assert_int_equal(scene_scale(c, "objective", 3.0, &why), STATUS_OK);
    assert_int_equal(scene_move(c, "objective", vec3_make(0, 5, 0), &why), STATUS_OK);
    assert_int_equal(scene_turn(c, "objective", vec3_make(0, 70, 0), &why), STATUS_OK);
    assert_int_equal(lens_of_scene(c, "objective", &again, NULL, &why), STATUS_OK);
    assert_near(lens_first_order_of(&again, 550.0).efl, 3.0 * lens_first_order_of(&p, 550.0).efl, 1e-9, "scaled");
    const vec3 to = mat3_apply_transposed(rotation_from_deg(vec3_make(0, 70, 0)), c->beams[2].direction);
    assert_near(to.x * a->beams[2].direction.z, to.z * a->beams[2].direction.x, 1e-12, "turned");
    assert_near(c->beams[2].width, 3.0 * a->beams[2].width, 1e-12, "width");
    lens_prescription_release(&again);
    /* a follower's own rotation and scale are within its leader's */
    assert_int_equal(scene_set_assignment(a, "objective-2.rotation=0,0,10", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(a, "objective-2.scale=2,2,2", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(a, "objective.scale=3,3,3", &why), STATUS_OK);
    const solid_shape *led = &a->solids[scene_find_solid(a, "objective-2")].shape;
    const vec3 axis = mat3_apply(rotation_from_deg(led->rotation_deg), vec3_make(0, 1, 0)),
               expected = mat3_apply(rotation_from_deg(vec3_make(90, 0, 0)),
                                     mat3_apply(rotation_from_deg(vec3_make(0, 0, 10)), vec3_make(0, 1, 0)));
    assert_near(vec3_length(vec3_sub(axis, expected)), 0.0, 1e-14, "rotated");
    assert_near(led->scale.y, 6.0, 0.0, "scaled");
    assert_int_equal(scene_set_assignment(a, "objective.scale=3,2,3", &why), STATUS_OK);
    assert_int_equal(scene_check(a, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "not scaled evenly"));
    assert_int_equal(scene_remove(a, "objective", &why), STATUS_BAD_INPUT);
    scene_destroy(a), scene_destroy(b), scene_destroy(c);
    lens_prescription_release(&p);
}

static void written_systems_are_read_back(void **state)
{
    (void)state;
    scene *s = scene_from(singlet);
    char *one, *two;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_write_text(s, NULL, false, &one, &why), STATUS_OK);
    scene *again = scene_from(one);
    assert_int_equal(scene_write_text(again, NULL, false, &two, &why), STATUS_OK);
    assert_string_equal(one, two);
    assert_non_null(strstr(one, "follows: eyepiece"));
    lens_prescription p;
    assert_int_equal(lens_of_scene(again, "eyepiece", &p, NULL, &why), STATUS_OK);
    assert_near(p.surface[0].radius, 40.0, 1e-12, "scaled");
    assert_near(p.surface[1].radius, -30.0, 1e-12, "cemented");
    assert_int_equal(p.stop, 3);
    lens_prescription_release(&p);
    free(one), free(two);
    scene_destroy(again);
    scene_destroy(s);
}

static void wrong_scene(const char *text, long line, long column, const char *what)
{
    scene *s;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_read_text("a.yaml", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what))
        fail_msg("'%s' does not contain '%s'", why.what, what);
    assert_int_equal(why.line, line);
    assert_int_equal(why.column, column);
    assert_true(why.remedy[0] != 0);
}

static void mistakes_in_scenes_are_located(void **state)
{
    (void)state;
    wrong_scene("lens_systems:\n  a:\n    surfaces:\n      - {radius: x, thickness: 1}\n", 4, 9, "radius: 'x'");
    wrong_scene("lens_systems:\n  a: {file: b.zmx}\n", 2, 13, "names a file");
    wrong_scene("lens_systems:\n  a: {glasses: b.agf, surfaces: []}\n", 2, 16, "names a file");
    wrong_scene("lens_systems:\n  a: {position: [0, 0, 0]}\n", 2, 6, "neither a file nor surfaces");
    wrong_scene("lens_systems:\n  a: {surfaces: [], scal: 2}\n", 2, 21, "scal");
    wrong_scene("lens_systems:\n  a: {surfaces: [], scale: 0}\n", 2, 28, "scale");
    wrong_scene("lens_systems:\n  a: {surfaces: [{radius: 1, thickness: 1, colour: 2}]}\n", 2, 44, "colour");
    wrong_scene("lens_systems:\n  a: {surfaces: [{radius: 9, thickness: 1, medium: 1.5}, {thickness: 1}]}\n", 2, 3,
                "diameter of surface 1 is not known");
    wrong_scene("solids:\n  a: {shape: sphere, follows: b}\n", 2, 3, "no solid before it");
    wrong_scene("solids:\n  a: {shape: sphere}\n  b: {shape: box, follows: a, position: [1, 0, 0]}\n", 3, 41,
                "own place");
    wrong_scene("solids:\n  a: {shape: box}\n  b: {shape: box, follows: a}\n  c: {shape: box, follows: b}\n", 4, 3,
                "follows another solid");
    wrong_scene("beams:\n  a: {follows: b}\nsolids:\n  c: {shape: box}\n", 2, 3, "no solid has that name");
    wrong_scene("beams:\n  a: {follows: b}\nsolids:\n  b: {shape: box, scale: [1, 2, 1]}\n", 2, 3, "not scaled evenly");
}

/* A cup with a floor of 0 is a tube: rays pass along its axis, and not through its wall. */
static void a_cup_without_a_floor_is_a_tube(void **state)
{
    (void)state;
    scene *s = scene_from("solids:\n  ring: {shape: cup, radius: 2, inner_radius: 1, height: 0.1, floor: 0}\n");
    probe *tracer;
    ray_tree tree = {.node = NULL};
    diagnostic why = {.what = ""};
    assert_int_equal(scene_load(s, &why), STATUS_OK);
    assert_int_equal(probe_create(s, isa_best(), &tracer, &why), STATUS_OK);
    for (int i = 0; i < 4; i++) {
        const double x = (const double[]){0.0, 0.999999, 1.000001, 1.999999}[i];
        assert_int_equal(probe_ray(tracer, vec3_make(x, 5, 0), vec3_make(0, -1, 0), &tree, &why), STATUS_OK);
        assert_int_equal(tree.node[0].end, i < 2 ? RAY_END_SKY : RAY_END_HIT);
        assert_int_equal(probe_ray(tracer, vec3_make(x, -5, 0), vec3_make(0, 1, 0), &tree, &why), STATUS_OK);
        assert_int_equal(tree.node[0].end, i < 2 ? RAY_END_SKY : RAY_END_HIT);
        assert_int_equal(solid_shape_contains(&s->solids[0].shape, vec3_make(x, 0.0, 0)), i >= 2);
    }
    ray_tree_release(&tree);
    probe_destroy(tracer);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_values_are_those_of_the_files),
        cmocka_unit_test(thin_pencils_through_the_solids_meet_the_paraxial_focus),
        cmocka_unit_test(the_space_telescope_is_free_of_spherical_aberration),
        cmocka_unit_test(formats_hold_what_they_are_given),
        cmocka_unit_test(scenes_give_their_systems_back),
        cmocka_unit_test(files_of_zemax_are_read_in_both_encodings),
        cmocka_unit_test(mistakes_are_located),
        cmocka_unit_test(media_have_many_spellings),
        cmocka_unit_test(damaged_files_are_refused_or_read),
        cmocka_unit_test(systems_move_as_one),
        cmocka_unit_test(moved_turned_and_scaled_systems_have_the_same_rays),
        cmocka_unit_test(written_systems_are_read_back),
        cmocka_unit_test(mistakes_in_scenes_are_located),
        cmocka_unit_test(a_cup_without_a_floor_is_a_tube),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
