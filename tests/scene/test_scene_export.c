/* Exports of scenes: every parameter has a decision; numbers in a .pov read back as the same doubles, margins are where
 * media meet, texts are escaped; a glTF file, read here as JSON and bytes, has the camera, lights, volumes and media of
 * the scene, and the mesh reader finds the same. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/number.h"
#include "geometry/mesh/mesh_generators.h"
#include "mesh_read.h"
#include "render_fixture.h"
#include "report/scene_export.h"
#include "scene/assets/mesh_stream.h"
#include "scene/model/edit/edit.h"
#include <jansson.h>

#define PI 3.14159265358979323846

static scene_export exported(scene *s, export_format format)
{
    scene_export e;
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    worked(scene_export_make(s, format, "", &e, &why), &why);
    return e;
}

static scene_export export_of(const char *text, export_format format)
{
    scene *s = scene_from(text);
    const scene_export e = exported(s, format);
    scene_destroy(s);
    return e;
}

static void every_parameter_has_a_decision(void **state)
{
    (void)state;
    for (size_t i = 0; i < param_count(); i++)
        for (int format = 0; format < EXPORT_FORMAT_COUNT; format++) {
            const param *row = param_at(i);
            bool known;
            const char *reason = export_reason(row, (export_format)format, &known);
            if (!known)
                fail_msg("%s.%s has no decision in export_notes.c", param_group_name(row->group), row->name);
            assert_true(!reason || strlen(reason) < 300);
            if (row->performance_only && row->group == PARAM_RENDER)
                assert_string_equal(reason, "");
        }
}

static bool has_note(const scene_export *e, const char *part)
{
    for (size_t i = 0; i < e->note_count; i++)
        if (strstr(e->notes[i], part))
            return true;
    return false;
}

/* What is set and not said is a note, and in the file; what is not set is none. */
static void what_is_not_said_is_noted(void **state)
{
    (void)state;
    const char *const text = "render: {polarisation: on, spectrum: spectral, threads: 3}\ncamera: {tone: aces}\n"
                             "materials: {g: {transparency: 1, ior: 1.5, film_thickness_nm: 300}}\n"
                             "solids:\n  a: {shape: sphere, material: g}\n"
                             "  b: {shape: sphere, position: [3, 0, 0], material: g, scatter_per_m: 1}\n";
    static const char *const parts[] = {"render.polarisation: light has no polarisation",
                                        "camera.tone: ", "g.film_thickness_nm: there is no interference",
                                        "b.scatter_per_m: media do not"};
    for (int format = 0; format < EXPORT_FORMAT_COUNT; format++) {
        scene_export e = export_of(text, (export_format)format);
        for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
            if (!has_note(&e, parts[k]))
                fail_msg("%s: no note %s", export_endings[format], parts[k]);
            if (format != EXPORT_GLB)
                assert_non_null(strstr(e.bytes, parts[k]));
        }
        assert_false(has_note(&e, "threads"));
        assert_false(has_note(&e, "roughness:"));
        for (size_t i = 0; i < e.note_count; i++)
            assert_null(strchr(e.notes[i], '\n'));
        scene_export_release(&e);
    }
    scene_export e = export_of("solids: {a: {shape: sphere, diffuse: 0.5}}\n", EXPORT_POV);
    assert_int_equal(e.note_count, 2); /* the depth limit; the tolerances */
    scene_export_release(&e);
}

/* The number after `before` at its first place in the text. */
static double number_after(const char *text, const char *before)
{
    const char *at = strstr(text, before);
    double value = 0;
    if (!at)
        fail_msg("no '%s' in:\n%.4000s", before, text);
    at += strlen(before);
    if (!number_scan(&at, &value))
        fail_msg("no number after '%s'", before);
    return value;
}

static void numbers_read_back_the_same(void **state)
{
    (void)state;
    char text[1000];
    const double ior = 1.0 + 1.0 / 3.0, x = 0.1 + 0.2, radius = 2.0 / 7.0, k = 1.0 / 11.0;
    snprintf(text, sizeof text,
             "camera: {position: [%.17g, 1, -6], target: [0, 1, 0]}\nsolids:\n  a: {shape: sphere, radius: %.17g, "
             "position: [%.17g, -1, 2e-5], transparency: 1, ior: %.17g, absorb_per_m: [%.17g, 0, 0]}\n"
             "lights: {l: {position: [1, 2, 3], color: [%.17g, 0.5, 1], intensity: 2}}\n",
             x, radius, x, ior, k, k);
    scene_export e = export_of(text, EXPORT_POV);
    assert_true(number_after(e.bytes, "location <") == x);
    assert_true(number_after(e.bytes, "sphere { 0, ") == radius);
    assert_true(number_after(e.bytes, "translate <") == x);
    assert_true(number_after(e.bytes, "interior { ior ") == ior);
    assert_true(number_after(e.bytes, "absorption rgb <") == k);
    assert_true(number_after(e.bytes, "light_source { // l\n  <1, 2, 3> rgb <") == 2 * k);
    assert_non_null(strstr(e.bytes, "reflection { 0, 1 fresnel on } conserve_energy"));
    scene_export_release(&e);
}

/* Every value that a scene's exposure, surroundings and mirror change. */
static void settings_are_said(void **state)
{
    (void)state;
    scene_export e =
        export_of("render: {depth: 5, min_weight: 0.001, width: 77, height: 33, samples: 4}\ncamera: {exposure: 1}\n"
                  "background: {color: [0.25, 0.5, 0.75], ior: 1.25}\n"
                  "solids:\n  a: {shape: sphere, transparency: 1, ior: 1.5}\n"
                  "  m: {shape: box, position: [3, 0, 0], reflectivity: 0.25, diffuse: 0.125}\n"
                  "lights: {s: {kind: cone, half_angle_deg: 20, position: [0, 5, 0], reach: 2}}\n",
                  EXPORT_POV);
    assert_non_null(strstr(e.bytes, "max_trace_level 6\n"));
    assert_true(number_after(e.bytes, "adc_bailout ") == 0.001);
    assert_true(number_after(e.bytes, "background { rgb <") == 0.5); /* twice as bright */
    assert_true(number_after(e.bytes, "interior { ior ") == 1.2);    /* relative to the surroundings */
    assert_non_null(strstr(e.bytes, "+W77 +H33"));
    assert_non_null(strstr(e.bytes, "+R2\n"));
    assert_non_null(strstr(e.bytes, "diffuse 0.125 reflection { 0.25 }"));
    assert_true(number_after(e.bytes, "radius ") == 20 && number_after(e.bytes, "falloff ") == 20);
    const double fade = number_after(e.bytes, "fade_distance "), bright = number_after(e.bytes, "<0, 5, 0> rgb <");
    for (double d = 1; d < 10; d *= 2) /* POV-Ray's law is the inverse square */
        assert_true(fabs(bright * 2 / (1 + d * d / (fade * fade)) / (2 * 4 / (d * d)) - 1) < 1e-7);
    scene_export_release(&e);
}

/* The rod: its liquid reaches into the vessel, which is cut out of it, thinner by the margin. */
static void media_meet_in_a_margin(void **state)
{
    (void)state;
    scene *s = rod_scene("");
    scene_export e = exported(s, EXPORT_POV);
    const char *liquid = strstr(e.bytes, "difference { // liquid");
    const double margin = POV_MARGIN;
    assert_non_null(liquid);
    const char *cut = strstr(liquid, "difference { cylinder { y*");
    assert_non_null(cut);
    assert_true(number_after(cut, "y*") == margin);
    assert_true(fabs(number_after(cut, "} cylinder { y*") - (0.1 - margin)) < 1e-15);
    assert_non_null(strstr(cut, "interior_texture { Pass }"));
    const char *vessel = strstr(e.bytes, "object { // vessel");
    assert_non_null(vessel);
    assert_non_null(strstr(vessel, "interior_texture { object { object {"));
    assert_non_null(strstr(e.bytes, "object { // rod"));
    assert_null(strstr(e.bytes, "difference { // ground")); /* apart */
    scene_export_release(&e);
    scene_destroy(s);
}

static void texts_are_escaped(void **state)
{
    (void)state;
    scene_export e = export_of("title: \"a\\n#error \\\"b\\\"\"\nsolids: {a: {shape: sphere}}\n", EXPORT_POV);
    assert_memory_equal(e.bytes, "// a #error \"b\"\n", 16);
    scene_export_release(&e);
    scene *s = scene_from("background: {image: 'experiments/scenes/chequer.png'}\n");
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    free(s->background.image_path);
    s->background.image_path = strdup("a\"b\\c.png");
    worked(scene_export_make(s, EXPORT_POV, "", &e, &why), &why);
    assert_non_null(strstr(e.bytes, "png \"a\\\"b\\\\c.png\" gamma srgb"));
    scene_export_release(&e);
    scene_destroy(s);
}

/* --- glTF --- */

typedef struct document {
    json_t *all;
    const unsigned char *buffer;
} document;

static uint32_t word_at(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static document document_of(const scene_export *e)
{
    assert_memory_equal(e->bytes, "glTF", 4);
    assert_int_equal(word_at(e->bytes + 8), e->size);
    const uint32_t length = word_at(e->bytes + 12);
    const document d = {json_loadb(e->bytes + 20, length, 0, NULL), (const unsigned char *)e->bytes + 28 + length};
    assert_non_null(d.all);
    return d;
}

static json_t *item(const document *d, const char *list, size_t i)
{
    json_t *found = json_array_get(json_object_get(d->all, list), i);
    assert_non_null(found);
    return found;
}

static double real(const json_t *of, const char *key)
{
    assert_non_null(json_object_get(of, key));
    return json_number_value(json_object_get(of, key));
}

static size_t offset_of(const document *d, json_int_t accessor, size_t *count)
{
    const json_t *a = item(d, "accessors", (size_t)accessor);
    *count = (size_t)json_integer_value(json_object_get(a, "count"));
    return (size_t)json_integer_value(json_object_get(
        item(d, "bufferViews", (size_t)json_integer_value(json_object_get(a, "bufferView"))), "byteOffset"));
}

/* Point i of a node's mesh in the world of the file. */
static vec3 point_of(const document *d, const json_t *node, size_t positions, uint32_t i)
{
    float p[3];
    double m[16], q[3];
    for (int k = 0; k < 3; k++) {
        const uint32_t bits = word_at((const char *)d->buffer + positions + 12 * (size_t)i + 4 * (size_t)k);
        memcpy(&p[k], &bits, 4);
    }
    for (size_t k = 0; k < 16; k++)
        m[k] = json_number_value(json_array_get(json_object_get(node, "matrix"), k));
    for (int r = 0; r < 3; r++)
        q[r] = m[r] * (double)p[0] + m[4 + r] * (double)p[1] + m[8 + r] * (double)p[2] + m[12 + r];
    return vec3_make(q[0], q[1], q[2]);
}

/* Volume and centre of what a node shows, by the divergence theorem: above 0 if its fronts run counter-clockwise, as
 * the format wants. */
static double volume_of(const document *d, const json_t *node, vec3 *centre)
{
    const json_t *part = json_array_get(
        json_object_get(item(d, "meshes", (size_t)json_integer_value(json_object_get(node, "mesh"))), "primitives"), 0);
    size_t count, ends;
    const size_t positions =
        offset_of(d, json_integer_value(json_object_get(json_object_get(part, "attributes"), "POSITION")), &count);
    const size_t indices = offset_of(d, json_integer_value(json_object_get(part, "indices")), &ends);
    double volume = 0;
    *centre = vec3_make(0, 0, 0);
    for (size_t t = 0; t < ends; t += 3) {
        vec3 p[3];
        for (size_t k = 0; k < 3; k++)
            p[k] = point_of(d, node, positions, word_at((const char *)d->buffer + indices + 4 * (t + k)));
        const double v = vec3_dot(p[0], vec3_cross(p[1], p[2])) / 6;
        volume += v;
        *centre = vec3_add(*centre, vec3_scale(vec3_add(p[0], vec3_add(p[1], p[2])), v / 4));
    }
    *centre = vec3_scale(*centre, 1 / volume);
    return volume;
}

static const json_t *node_named(const document *d, const char *name)
{
    size_t i;
    const json_t *node;
    json_array_foreach(json_object_get(d->all, "nodes"), i,
                       node) if (strcmp(json_string_value(json_object_get(node, "name")), name) == 0) return node;
    fail_msg("no node %s", name);
    return NULL;
}

#define STILL_LIFE                                                                                                  \
    "camera: {position: [1, 2, -6], target: [0.5, 1, 0], fov_deg: 40, roll_deg: 10}\n"                              \
    "render: {width: 80, height: 60}\n"                                                                             \
    "materials:\n  g: {transparency: 0.9, ior: 1.6, absorb_per_m: [0.5, 1, 0.25]}\n"                                \
    "  m: {color: [0.8, 0.4, 0.2], diffuse: 0.5}\n"                                                                 \
    "meshes: {t: {generate: torus, major: 1, minor: 0.25, around: 256, tube: 128}}\n"                               \
    "solids:\n  ball: {shape: sphere, radius: 0.5, position: [1, 2, 3], material: g}\n"                             \
    "  block: {shape: box, size: [1, 2, 3], position: [4, 5, 6], rotation: [20, 30, 40], material: m}\n"            \
    "  can: {shape: cylinder, radius: 0.5, height: 2, m: 2, position: [-4, 0, 0], rotation: [0, 0, 90], material: " \
    "m}\n"                                                                                                          \
    "  ring: {shape: mesh, mesh: t, scale: [2, 1, 1], position: [0, -5, 0], material: m}\n"                         \
    "lights:\n  lamp: {position: [3, 4, -5], color: [1, 0.5, 0.25], intensity: 0.75, reach: 6}\n"                   \
    "  sun: {kind: sun, position: [0, 1, 1], target: [0, 0, 0], intensity: 0.5, angular_diameter_deg: 0}\n"

/* Volumes and centres of mass, mirrored in z. */
static void solids_are_where_they_were(void **state)
{
    (void)state;
    scene_export e = export_of(STILL_LIFE, EXPORT_GLB);
    const document d = document_of(&e);
    static const struct {
        const char *name;
        double volume;
        vec3 centre;
    } wanted[] = {{"ball", 4 * PI / 3 * 0.125, {1, 2, -3}},
                  {"block", 6, {4, 5, -6}},
                  {"can", PI * 0.25 / 2 * 2, {-5, 0, 0}}, /* its axis points along -x */
                  {"ring", 2 * 2 * PI * PI * 0.0625, {0, -5, 0}}};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        vec3 centre;
        const double volume = volume_of(&d, node_named(&d, wanted[i].name), &centre);
        if (fabs(volume / wanted[i].volume - 1) > 2e-3 || vec3_length(vec3_sub(centre, wanted[i].centre)) > 1e-5)
            fail_msg("%s: volume %g, not %g; centre %g %g %g", wanted[i].name, volume, wanted[i].volume, centre.x,
                     centre.y, centre.z);
    }
    json_decref(d.all);
    scene_export_release(&e);
}

static void materials_camera_and_lights_are_said(void **state)
{
    (void)state;
    scene_export e = export_of(STILL_LIFE, EXPORT_GLB);
    const document d = document_of(&e);
    const json_t *perspective = json_object_get(item(&d, "cameras", 0), "perspective");
    assert_true(fabs(real(perspective, "yfov") - 40 * PI / 180) < 1e-15);
    assert_true(fabs(real(perspective, "aspectRatio") - 4.0 / 3.0) < 1e-15);
    const json_t *place = json_object_get(node_named(&d, "camera"), "matrix");
    assert_true(json_number_value(json_array_get(place, 12)) == 1 && json_number_value(json_array_get(place, 14)) == 6);
    const json_t *lamp = json_array_get(
        json_object_get(json_object_get(json_object_get(d.all, "extensions"), "KHR_lights_punctual"), "lights"), 0);
    assert_true(fabs(real(lamp, "intensity") - PI * 0.75 * 36) < 1e-12);
    bool glass = false, matt = false;
    size_t i;
    const json_t *m;
    json_array_foreach(json_object_get(d.all, "materials"), i, m)
    {
        const json_t *x = json_object_get(m, "extensions"), *volume = json_object_get(x, "KHR_materials_volume"),
                     *surface = json_object_get(m, "pbrMetallicRoughness");
        if (volume) {
            glass = true;
            assert_true(real(json_object_get(x, "KHR_materials_ior"), "ior") == 1.6);
            assert_true(real(json_object_get(x, "KHR_materials_transmission"), "transmissionFactor") == 0.9);
            for (size_t c = 0; c < 3; c++) { /* Beer and Lambert */
                const double left = json_number_value(json_array_get(json_object_get(volume, "attenuationColor"), c));
                const double k = -log(left) / real(volume, "attenuationDistance");
                assert_true(fabs(k - (c == 0 ? 0.5 : c == 1 ? 1 : 0.25)) < 1e-12);
            }
        } else {
            matt = true;
            assert_true(real(json_object_get(x, "KHR_materials_specular"), "specularFactor") == 0);
            assert_true(json_number_value(json_array_get(json_object_get(surface, "baseColorFactor"), 1)) == 0.2);
        }
    }
    assert_true(glass && matt);
    json_decref(d.all);
    scene_export_release(&e);
}

/* Both forms of the format, read by the mesh reader of this program: the camera, the lights' ratio, and the triangles
 * are those of the scene. */
static void the_mesh_reader_finds_the_scene(void **state)
{
    (void)state;
    for (int format = EXPORT_GLTF; format <= EXPORT_GLB; format++) {
        scene_export e = export_of(STILL_LIFE, (export_format)format);
        char *path = in_folder(format == EXPORT_GLB ? "still.glb" : "still.gltf"), *notes = NULL;
        FILE *to = fopen(path, "wb");
        assert_non_null(to);
        assert_int_equal(fwrite(e.bytes, 1, e.size, to), e.size);
        assert_int_equal(fclose(to), 0);
        scene *s = NULL;
        diagnostic why = {0};
        worked(mesh_first_scene(path, &s, &notes, &why), &why);
        worked(scene_load(s, &why), &why);
        const vec3 from = s->camera.position;
        assert_true(vec3_length(vec3_sub(from, vec3_make(1, 2, -6))) < 1e-12);
        assert_true(fabs(s->camera.fov_deg - 40) < 1e-12 && fabs(s->camera.roll_deg - 10) < 1e-9);
        assert_int_equal(s->light_count, 2);
        const bounds3 b = s->meshes[0].data->bounds;
        assert_true(fabs(b.high.x - 6.0) < 1.0 && b.low.y < -5.2 && b.low.y > -5.3);
        free(notes);
        free(path);
        scene_destroy(s);
        scene_export_release(&e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_parameter_has_a_decision),  cmocka_unit_test(what_is_not_said_is_noted),
        cmocka_unit_test(numbers_read_back_the_same),      cmocka_unit_test(settings_are_said),
        cmocka_unit_test(media_meet_in_a_margin),          cmocka_unit_test(texts_are_escaped),
        cmocka_unit_test(solids_are_where_they_were),      cmocka_unit_test(materials_camera_and_lights_are_said),
        cmocka_unit_test(the_mesh_reader_finds_the_scene),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
