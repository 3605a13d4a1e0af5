/* Tests of lens files, and of lens systems as solids: published prescriptions by rays that are traced through their
 * solids, round trips of the formats, damaged files. */
#include "lens_fixture.h"

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
    {"phone.csv", 0, 0, 0.111974933, 1e-8},
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

/* The skew ray that ray-optics lists for this lens ("Trace an arbitrary skew ray"), to its last digit. Two of its
 * elements turn on both sides. */
static void a_phone_lens_of_odd_aspheres_has_its_published_ray(void **state)
{
    (void)state;
    lens_prescription p = read_lens(LENSES "phone-odd.csv");
    scene *s = scene_of(&p, "phone-odd");
    const vec3 d = vec3_normalize(vec3_make(0.086, 0.173, 0.981));
    const lens_first_order f = lens_first_order_of(&p, 587.5618);
    assert_near(f.efl, 5.555, 0.0005, "focal length");
    assert_near(f.back, 0.5678, 0.00005, "back focal distance");
    /* through (-d.x, -d.y, 0) */
    const ray_node r = traced_from(s, &p, vec3_make(-2.0 * d.x, -2.0 * d.y, -d.z), d, "phone-odd");
    double plane = 0.0;
    for (size_t k = 0; k < p.count; k++)
        plane += p.surface[k].thickness;
    const double path = (plane - r.origin.z) / r.direction.z;
    assert_near(path, 0.66763, 6e-6, "path");
    assert_near(r.direction.x, 0.126731, 6e-7, "x");
    assert_near(r.direction.y, 0.254936, 6e-7, "y");
    assert_near(r.origin.x + path * r.direction.x, 0.49241, 6e-6, "image x");
    assert_near(r.origin.y + path * r.direction.y, 0.99054, 6e-6, "image y");
    scene_destroy(s);
    lens_prescription_release(&p);
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

/* Surfaces that are not round, and odd coefficients, by files and by a scene's solids. */
static void all_types_of_surfaces_are_held(void **state)
{
    (void)state;
    static const char text[] =
        "f_number,8\nfield_deg,0\n"
        "radius,thickness,medium,diameter,conic,a4,a6,a1,a2,a3,form,radius_x,conic_x,stop\n"
        "50,4,1.5,10,-0.5,1e-6,0,0,0,0,toric,70,0,1\n-60,2,,10,0.25,0,0,0,0,0,biconic,0,0,0\n"
        "80,3,1.6,10,0,2e-6,0,0.01,0.001,3e-5,round,,,0\n0,40,,10,0,0,-3e-9,0,0,0,toric,-90,0,0\n";
    lens_prescription p = parsed("a.csv", text, sizeof text - 1);
    p.surface[1].radius_x = 45.0, p.surface[1].conic_x = -2.0;
    static const char *const names[] = {"a.csv", "a.zmx"};
    for (size_t k = 0; k < COUNT(names); k++) {
        char *out = written(&p, names[k]);
        lens_prescription again = parsed(names[k], out, strlen(out));
        assert_same_system(&p, &again, 1e-15, names[k]);
        assert_true(k == 0 ||
                    (strstr(out, "TYPE TOROIDAL") && strstr(out, "TYPE BICONICX") && strstr(out, "TYPE ODDASPHE")));
        free(out);
        lens_prescription_release(&again);
    }
    scene *s = scene_create();
    diagnostic why = {.what = ""};
    const lens_placement at = {.name = "lens", .scale = 2.0, .rotation_deg = {30.0, 0.0, 0.0}};
    if (lens_add_to_scene(s, &p, &at, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    lens_prescription back;
    if (lens_of_scene(s, NULL, &back, NULL, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    assert_int_equal(back.count, p.count);
    for (size_t i = 0; i < p.count; i++)
        for (int k = 0; k < 25; k++) { /* the same surface, twice as large */
            const double x = k % 5 - 2.0, y = k / 5 - 2.0, h = lens_surface_height(&p.surface[i], x, y);
            assert_near(lens_surface_height(&back.surface[i], 2.0 * x, 2.0 * y), 2.0 * h, 1e-14, "height");
        }
    lens_prescription_release(&back);
    scene_destroy(s);
    p.surface[2].odd[7] = 1e-20; /* r^13 */
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    assert_int_equal(lens_file_write(&p, "a.zmx", f, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "surface 3 has coefficients that a .zmx file cannot hold"));
    fclose(f);
    free(out);
    lens_prescription_release(&p);
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
        if (!within) {
            assert_int_equal(lens_of_scene(s, "objective", &again, NULL, &why), STATUS_OK);
            assert_same_system(&p, &again, 1e-10, path);
            for (size_t k = 0; k < p.count; k++)
                assert_near(p.surface[k].hole, again.surface[k].hole, 1e-9, path);
            if (p.field_count > 1 && p.field_kind == LENS_FIELD_ANGLE)
                assert_near(p.field[1].y, again.field[1].y, 1e-9, path);
            lens_prescription_release(&again);
        }
        scene_destroy(s);
        lens_prescription_release(&p);
    }
}

/* --- files of Zemax --- */

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
    refused("a.zmx", ZMX_HEAD "SURF 1\n  TYPE FZERNSAG\n" ZMX_TAIL, 9, 8, "type FZERNSAG");
    refused("a.zmx",
            ZMX_HEAD "SURF 1\n  TYPE COORDBRK\n  PARM 3 5\n  DISZ 0\nSURF 2\n  GLAS N-BK7\n  DISZ 5\n" ZMX_TAIL, 12, 0,
            "surface 2 is tilted");
    refused("a.zmx",
            ZMX_HEAD "SURF 1\n  TYPE COORDBRK\n  PARM 2 5\n  DISZ 0\nSURF 2\n  GLAS N-BK7\n  DISZ 5\n" ZMX_TAIL, 12, 0,
            "surface 2 is off the axis");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  TYPE COORDBRK\n  PARM 4 1e9\n" ZMX_TAIL, 10, 10, "out of range");
    refused("a.csv", "radius,thickness,medium,tilt_x\n5,2,,20\n", 2, 0, "surface 1 is tilted");
    refused("a.csv", "radius,thickness,medium,tilt_x\n0,2,mirror,89\n", 2, 0, "along the axis");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  CURV x\n" ZMX_TAIL, 9, 8, "CURV: 'x' is not a number");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  PARM 11 0.5\n" ZMX_TAIL, 9, 8, "parameter 11");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  TYPE ODDASPHE\n  PARM 9 0.5\n" ZMX_TAIL, 10, 8, "parameter 9");
    refused("a.zmx", ZMX_HEAD "SURF 1\n  TYPE BICONICX\n  PARM 3 0.5\n" ZMX_TAIL, 10, 8, "parameter 3");
    refused("a.csv", "thickness,form\n1,round\n1,oval\n", 3, 3, "unknown form 'oval'");
    refused("a.csv", "thickness,radius_x\n1,20\n", 2, 3, "the surface is round, and has no radius_x");
    refused("a.csv", "thickness,form,conic_x\n1,toric,1\n", 2, 9, "has no conic_x");
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
        cmocka_unit_test(a_phone_lens_of_odd_aspheres_has_its_published_ray),
        cmocka_unit_test(the_space_telescope_is_free_of_spherical_aberration),
        cmocka_unit_test(formats_hold_what_they_are_given),
        cmocka_unit_test(all_types_of_surfaces_are_held),
        cmocka_unit_test(scenes_give_their_systems_back),
        cmocka_unit_test(files_of_zemax_are_read_in_both_encodings),
        cmocka_unit_test(mistakes_are_located),
        cmocka_unit_test(media_have_many_spellings),
        cmocka_unit_test(damaged_files_are_refused_or_read),
        cmocka_unit_test(a_cup_without_a_floor_is_a_tube),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
