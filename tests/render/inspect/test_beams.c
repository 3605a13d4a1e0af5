/* Tests of beams: scene files, rays equal to those of `cuvette trace` and `cuvette fan`, closed forms, screens. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render/inspect/beams.h"
#include "render/inspect/fan.h"
#include "render_fixture.h"
#include "scene/file/write.h"
#include "scene/model/edit/edit.h"

#define BALL "ball: {shape: sphere, transparency: 1, ior: 1.5, radius: 1}"
#define DEGREES (180.0 / 3.14159265358979323846)

static scene *with_beam(const char *keys, const char *solids)
{
    char text[1024];
    snprintf(text, sizeof text, "lights: {lamp: {position: [0, 9, 0]}}\nbeams: {ray: {%s}}\nsolids: {%s}\n", keys,
             solids);
    return scene_from(text);
}

static void refused(const char *keys, const char *what, const char *remedy)
{
    char text[512];
    scene *s = NULL;
    diagnostic why = {.line = 0};
    snprintf(text, sizeof text, "beams:\n  ray: {%s}\n", keys);
    assert_int_equal(scene_read_text("test.yaml", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, what);
    assert_string_equal(why.remedy, remedy);
    assert_int_equal(why.line, 2);
}

static void invalid_beams_are_refused_with_place_and_remedy(void **state)
{
    (void)state;
    refused("rays: 0", "ray.rays: 0 is out of range", "give an integer 1..1000000");
    refused("kind: laser", "ray.kind: 'laser' is not one of the choices", "give one of: pencil, fan, sheet, bundle");
    refused("target: [-3, 1, 0]", "ray: the beam is at its own target",
            "move its position or its target, or set its direction");
    refused("kind: fan, direction: [0, 0, 2], normal: [0, 0, 1]",
            "ray: the normal of its plane is parallel to the beam",
            "set 'normal' to a vector across the beam, or to 0,0,0");
    refused("lights: on, field_rows: 2", "ray: a beam that lights has one field point",
            "set field_columns and field_rows to 1, or lights to off");
    refused("width: -1", "ray.width: -1 is out of range", "give a number 0..1000000");
}

static void a_written_beam_is_read_back(void **state)
{
    (void)state;
    scene *s = with_beam("kind: sheet, rays: 5, white: on, wavelengths: 3, width: 0.25, color: [1, 0.5, 0]", BALL),
          *back;
    char *text = NULL;
    diagnostic why = {.line = 0};
    worked(scene_write_text(s, "", false, &text, &why), &why);
    worked(scene_read_text("test.yaml", text, strlen(text), &back, &why), &why);
    assert_int_equal(back->beam_count, 1);
    const beam *a = &s->beams[0], *b = &back->beams[0];
    assert_string_equal(b->name, "ray");
    assert_memory_equal(&a->kind, &b->kind, sizeof *a - offsetof(beam, kind));
    worked(scene_move(back, "ray", vec3_make(1, 2, 3), &why), &why);
    assert_true(b->position.x == -2 && b->position.y == 3 && b->target.z == 3);
    worked(scene_remove(back, "ray", &why), &why);
    assert_int_equal(back->beam_count, 0);
    free(text);
    scene_destroy(s);
    scene_destroy(back);
}

/* The film of the same scene with and without beams. */
static void beams_do_not_change_the_film(void **state)
{
    (void)state;
    scene *bare = rod_scene("render.width=40 render.height=30"), *s = rod_scene("render.width=40 render.height=30");
    diagnostic why = {.line = 0};
    worked(scene_add(s, PARAM_BEAM, "laser", NULL, &why), &why);
    render_result *a = render(bare), *b = render(s);
    assert_true(film_hash(a->img) == film_hash(b->img));
    render_result_destroy(a);
    render_result_destroy(b);
    scene_destroy(bare);
    scene_destroy(s);
}

/* --- rays --- */

typedef struct gathered {
    int count;
    double power;
    double lambda_nm[64];
    ray_tree last;
} gathered;

static status gather(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    gathered *g = context;
    (void)p;
    (void)why;
    g->lambda_nm[g->count % 64] = ray->lambda_nm;
    g->count++;
    g->power += ray->power;
    g->last = *tree;
    g->last.node = realloc(NULL, tree->count * sizeof *tree->node);
    memcpy(g->last.node, tree->node, tree->count * sizeof *tree->node);
    return STATUS_OK;
}

typedef struct fan_compared {
    const fan *f;
    int at;
} fan_compared;

/* The numbers of both, without what pads them. */
static void assert_same_node(const ray_node *a, const ray_node *b)
{
    assert_true(a->kind == b->kind && a->end == b->end && a->depth == b->depth && a->parent == b->parent &&
                a->first_child == b->first_child && a->next == b->next && a->medium == b->medium &&
                a->light == b->light && a->n == b->n);
    assert_memory_equal(&a->origin, &b->origin, 2 * sizeof a->origin);
    assert_memory_equal(a->throughput, b->throughput, sizeof a->throughput);
    assert_memory_equal(a->stokes, b->stokes, sizeof a->stokes);
    assert_memory_equal(a->contribution, b->contribution, sizeof a->contribution);
    if (a->end != RAY_END_HIT)
        return;
    assert_true(a->hit.solid == b->hit.solid && a->hit.face == b->hit.face && a->hit.from == b->hit.from &&
                a->hit.to == b->hit.to && a->hit.tir == b->hit.tir);
    assert_memory_equal(&a->hit.t, &b->hit.t, sizeof(double) + 2 * sizeof(vec3));
    assert_true(a->hit.R_s == b->hit.R_s && a->hit.R_p == b->hit.R_p && a->hit.T == b->hit.T &&
                a->hit.path_length_m == b->hit.path_length_m);
    assert_memory_equal(a->hit.transmittance, b->hit.transmittance, sizeof a->hit.transmittance);
}

static status compare_with_fan(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p,
                               diagnostic *why)
{
    fan_compared *c = context;
    const fan_ray *other = &c->f->ray[c->at++];
    (void)p;
    (void)why;
    assert_int_equal(ray->rays, c->f->count);
    assert_int_equal(tree->count, other->count);
    for (size_t i = 0; i < tree->count; i++)
        assert_same_node(&tree->node[i], &c->f->node[other->first + i]);
    return STATUS_OK;
}

static void rays_equal_those_of_a_fan(void **state)
{
    (void)state;
    static const struct {
        const char *beam;
        fan_rule rule;
    } pairs[] = {
        {"kind: sheet, rays: 9, width: 1.4, position: [-5, 0, 0], target: [0, 0, 0]",
         {.from = {-5, 0, 0}, .to = {0, 0, 0}, .rays = 9, .width = 1.4}},
        {"kind: fan, rays: 7, angle_deg: 20, position: [-4, 1, 0.5], target: [0, 0.1, 0]",
         {.from = {-4, 1, 0.5}, .to = {0, 0.1, 0}, .rays = 7, .spreads = true, .spread_deg = 20}},
        {"kind: sheet, rays: 4, width: 0.6, position: [-4, 1, 0.5], direction: [4, -0.9, -0.5], normal: [0, 1, 1]",
         {.from = {-4, 1, 0.5}, .to = {0, 0.1, 0}, .rays = 4, .width = 0.6, .has_normal = true, .normal = {0, 1, 1}}},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s, branches: off, depth: 6, min_fraction: 0", pairs[i].beam);
        scene *s = with_beam(text, BALL);
        diagnostic why = {.line = 0};
        probe *p = NULL;
        fan f = {0};
        s->render.depth = 6;
        worked(probe_create(s, isa_best(), &p, &why), &why);
        worked(fan_trace(p, &pairs[i].rule, &f, &why), &why);
        fan_compared c = {&f, 0};
        worked(beams_each_ray(s, isa_best(), 0, compare_with_fan, &c, &why), &why);
        assert_int_equal(c.at, f.count);
        fan_release(&f);
        probe_destroy(p);
        scene_destroy(s);
    }
}

/* The laser's tree is that of `cuvette trace --ray` without shadow rays. */
static void a_laser_equals_a_traced_ray(void **state)
{
    (void)state;
    scene *s = rod_scene("render.depth=8 render.min_weight=0.01 render.lambda_nm=500");
    diagnostic why = {.line = 0};
    probe *p = NULL;
    ray_tree tree = {0};
    gathered g = {.count = 0};
    worked(scene_add(s, PARAM_BEAM, "laser", NULL, &why), &why);
    set(s, "laser.position=-3,1.5,0.4");
    set(s, "laser.direction=1,-0.1,0");
    set(s, "laser.lambda_nm=500");
    worked(beams_each_ray(s, isa_best(), 0, gather, &g, &why), &why);
    worked(probe_create(s, isa_best(), &p, &why), &why);
    probe_use_one_wavelength(p);
    worked(probe_ray(p, g.last.node[0].origin, g.last.node[0].direction, &tree, &why), &why);
    assert_true(vec3_length(vec3_sub(tree.node[0].direction, vec3_normalize(vec3_make(1, -0.1, 0)))) < 1e-15);
    size_t k = 0;
    for (size_t i = 0; i < tree.count; i++) {
        if (tree.node[i].kind == RAY_SHADOW)
            continue;
        assert_true(k < g.last.count);
        const ray_node *a = &tree.node[i], *b = &g.last.node[k++];
        assert_memory_equal(&a->origin, &b->origin, 2 * sizeof a->origin);
        assert_memory_equal(a->throughput, b->throughput, sizeof a->throughput);
        assert_int_equal(a->end, b->end);
        if (a->end == RAY_END_HIT)
            assert_true(a->hit.t == b->hit.t && a->hit.R_s == b->hit.R_s && a->hit.R_p == b->hit.R_p &&
                        a->hit.T == b->hit.T && a->hit.cos_i == b->hit.cos_i && a->hit.cos_t == b->hit.cos_t &&
                        a->hit.n_from == b->hit.n_from && a->hit.n_to == b->hit.n_to && a->hit.tir == b->hit.tir);
    }
    assert_true(k == g.last.count && k > 8);
    free(g.last.node);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

/* Fresnel and Snell at a plane surface of glass (Hecht 4.6), and total reflection beyond arcsin(1 / n). */
static void a_beam_obeys_snell_and_fresnel(void **state)
{
    (void)state;
    const char *block = "block: {shape: box, size: [9, 9, 9], position: [0, -4.5, 0], transparency: 1, ior: 1.5}";
    scene *s = with_beam("position: [-1, 1, 0], target: [0, 0, 0], depth: 1, min_fraction: 0", block);
    diagnostic why = {.line = 0};
    gathered g = {.count = 0};
    worked(beams_each_ray(s, isa_best(), 0, gather, &g, &why), &why);
    const double t = asin(sin(45.0 / DEGREES) / 1.5), ci = cos(45.0 / DEGREES), ct = cos(t);
    const double r_s = (ci - 1.5 * ct) / (ci + 1.5 * ct), r_p = (1.5 * ci - ct) / (1.5 * ci + ct);
    const double R = 0.5 * (r_s * r_s + r_p * r_p);
    assert_true(fabs(beam_fraction(&g.last.node[1]) - R) < 1e-14 &&
                fabs(beam_fraction(&g.last.node[2]) - (1 - R)) < 1e-14);
    assert_true(fabs(g.last.node[2].direction.x - sin(t)) < 1e-14);
    free(g.last.node);
    g = (gathered){.count = 0};
    set(s, "ray.position=-1,-1,0");
    worked(beams_each_ray(s, isa_best(), 0, gather, &g, &why), &why);
    assert_true(g.last.node[0].hit.tir && beam_fraction(&g.last.node[1]) == 1.0);
    free(g.last.node);
    scene_destroy(s);
}

static status sum_up(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    gathered *g = context;
    (void)p;
    (void)why;
    (void)tree;
    g->lambda_nm[g->count % 64] = ray->lambda_nm;
    g->count++;
    g->power += ray->power;
    return STATUS_OK;
}

static void white_light_has_several_wavelengths_and_the_same_power(void **state)
{
    (void)state;
    scene *s = with_beam("kind: bundle, rays: 10, white: on, wavelengths: 4, power: 3", BALL);
    diagnostic why = {.line = 0};
    gathered g = {.count = 0};
    worked(beams_each_ray(s, isa_best(), 0, sum_up, &g, &why), &why);
    assert_int_equal(g.count, 40);
    assert_true(g.lambda_nm[0] == 400 && g.lambda_nm[10] == 500 && g.lambda_nm[39] == 700);
    assert_true(fabs(g.power - 3.0) < 1e-12);
    set(s, "ray.visible=off");
    g = (gathered){.count = 0};
    worked(beams_each_ray(s, isa_best(), 0, sum_up, &g, &why), &why);
    assert_int_equal(g.count, 0);
    scene_destroy(s);
}

/* --- the screen --- */

/* A parallel bundle lights a disc evenly: bins within it receive power by area, those outside nothing. */
static void a_screen_bins_the_power_of_a_bundle(void **state)
{
    (void)state;
    scene *s = with_beam("kind: bundle, width: 2, power: 5, position: [-3, 0, 0], target: [0, 0, 0]", "");
    beam_screen screen = {.normal = {1, 0, 0}, .width = 4, .height = 4, .columns = 8, .rows = 8, .rays_of_beam = 20000};
    diagnostic why = {.line = 0};
    worked(beam_screen_expose(s, isa_best(), &screen, &why), &why);
    assert_int_equal(screen.ray_count, 20000);
    assert_int_equal(screen.hit_count, 20000);
    assert_true(fabs(screen.received - 5.0) < 1e-9 && fabs(screen.power - 5.0) < 1e-9);
    for (int row = 0; row < 8; row++)
        for (int column = 0; column < 8; column++) {
            const double inner = hypot(fmax(fabs(column - 3.5) + 0.5, 0), fabs(row - 3.5) + 0.5) * 0.5;
            const double outer = hypot(fabs(column - 3.5) - 0.5, fabs(row - 3.5) - 0.5) * 0.5;
            const double bin = screen.bin[row * 8 + column];
            if (inner < 1.0) /* wholly lit: its share of the disc's area pi */
                assert_true(fabs(bin - 5.0 * 0.25 / 3.14159265358979) < 0.01);
            if (outer > 1.0)
                assert_true(bin == 0.0);
        }
    beam_screen_release(&screen);
    screen.normal = vec3_make(0, 0, 0);
    assert_int_equal(beam_screen_expose(s, isa_best(), &screen, &why), STATUS_BAD_INPUT);
    beam_screen_release(&screen);
    scene_destroy(s);
}

/* A screen narrower than the bundle receives the strip of its disc in front of it, and one lower than it the strip
 * across: 2 (h sqrt(1 - h^2) + asin h) / pi of the power within |u| < h of a disc of radius 1. */
static void rays_that_miss_a_screen_are_in_no_bin(void **state)
{
    (void)state;
    scene *s = with_beam("kind: bundle, width: 2, power: 5, position: [-3, 0, 0], target: [0, 0, 0]", "");
    const double h = 0.25, share = 2.0 * (h * sqrt(1.0 - h * h) + asin(h)) / 3.14159265358979323846;
    for (int low = 0; low < 2; low++) {
        beam_screen screen = {.normal = {1, 0, 0},
                              .width = low ? 4 : 0.5,
                              .height = low ? 0.5 : 4,
                              .columns = 8,
                              .rows = 8,
                              .rays_of_beam = 20000};
        diagnostic why = {.line = 0};
        worked(beam_screen_expose(s, isa_best(), &screen, &why), &why);
        double sum = 0.0;
        for (int bin = 0; bin < 64; bin++)
            sum += screen.bin[bin];
        assert_true(fabs(screen.received - 5.0 * share) < 0.01 && fabs(sum - screen.received) < 1e-9);
        assert_true(fabs((double)screen.hit_count - 20000 * share) < 40);
        beam_screen_release(&screen);
    }
    scene_destroy(s);
}

/* Within an absorbing slab, Beer and Lambert: the power at depth d is (1 - R) e^(-a d). */
static void a_screen_in_a_medium_receives_what_is_not_absorbed(void **state)
{
    (void)state;
    scene *s = with_beam("position: [-3, 0, 0], target: [0, 0, 0], depth: 1, min_fraction: 0, branches: off",
                         "slab: {shape: box, size: [2, 4, 4], position: [1, 0, 0], transparency: 1, ior: 1.5, "
                         "absorb_per_m: [0.7, 0.7, 0.7]}");
    beam_screen screen = {.centre = {0.5, 0, 0}, .normal = {1, 0, 0}, .width = 1, .height = 1, .columns = 1, .rows = 1};
    diagnostic why = {.line = 0};
    worked(beam_screen_expose(s, isa_best(), &screen, &why), &why);
    assert_true(fabs(screen.received - 0.96 * exp(-0.35)) < 1e-12);
    beam_screen_release(&screen);
    scene_destroy(s);
}

/* Rows count downwards; a wavelength has its own colour. */
static void a_screen_shows_where_and_in_which_colour(void **state)
{
    (void)state;
    scene *s = with_beam("position: [-3, 0.6, 0.3], direction: [1, 0, 0], power: 2, lambda_nm: 532, rays: 1", "");
    beam_screen screen = {.normal = {2, 0, 0}, .width = 2, .height = 2, .columns = 4, .rows = 4};
    diagnostic why = {.line = 0};
    worked(beam_screen_expose(s, isa_best(), &screen, &why), &why);
    double green[3];
    beam_wavelength_color(532.0, green);
    assert_true(green[1] == 1.0 && green[0] < 0.5);
    const int column = screen.e_u.z > 0.0 ? 2 : 1; /* 0.3 to the side of the centre, 0.6 above it: the top row */
    for (int bin = 0; bin < 16; bin++) {
        const double power = bin == column ? 2.0 : 0.0;
        assert_true(screen.bin[bin] == power);
        for (int k = 0; k < 3; k++)
            assert_true(screen.color[3 * bin + k] == power * green[k]);
    }
    beam_screen_release(&screen);
    screen.columns = screen.rows = 512; /* the most */
    worked(beam_screen_expose(s, isa_best(), &screen, &why), &why);
    beam_screen_release(&screen);
    screen.columns = screen.rows = 4;
    screen.width = 1e6;
    worked(beam_screen_expose(s, isa_best(), &screen, &why), &why);
    beam_screen_release(&screen);
    static const beam_screen wrong[] = {
        {.width = 1e6 + 1e-9, .height = 2, .columns = 4, .rows = 4}, {.width = 2, .height = 0, .columns = 4, .rows = 4},
        {.width = 0, .height = 2, .columns = 4, .rows = 4},          {.width = 2, .height = 2, .columns = 0, .rows = 4},
        {.width = 2, .height = 2, .columns = 513, .rows = 4},        {.width = 2, .height = 2, .columns = 4, .rows = 0},
        {.width = 2, .height = 2, .columns = 4, .rows = 513},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        screen = wrong[i];
        screen.normal = vec3_make(1, 0, 0);
        assert_int_equal(beam_screen_expose(s, isa_best(), &screen, &why), STATUS_BAD_INPUT);
        beam_screen_release(&screen);
    }
    scene_destroy(s);
}

/* --- the drawing --- */

static void expect_pixel(const image *img, int x, int y, double share)
{
    static const double color[] = {1.0, 0.5, 0.25};
    for (int k = 0; k < 3; k++)
        assert_true(fabs(img->pixel[3 * (y * img->width + x) + k] - (share * color[k] + (1.0 - share) * 0.2)) < 1e-6);
}

static image *drawn(const scene *s, int width, int height, float distance)
{
    image *img = NULL;
    diagnostic why = {.line = 0};
    float *distances = calloc((size_t)(width * height), sizeof *distances);
    assert_non_null(distances);
    for (int i = 0; i < width * height; i++)
        distances[i] = distance;
    worked(image_create(width, height, &img, &why), &why);
    for (int i = 0; i < 3 * width * height; i++)
        img->pixel[i] = 0.2F;
    worked(beams_draw(s, isa_best(), distances, img, &why), &why);
    free(distances);
    return img;
}

/* A level beam, 5 in front of a camera with a field of 90 degrees and 0.5 above its axis, is at 0.9 of half the height
 * from the top: row 28.8 of 64, from column 32 (1 - 1 / 5) = 25.6 on. Lines are 1.2 px wide, with an edge of 1 px. */
static void a_drawn_beam_is_at_its_pixels(void **state)
{
    (void)state;
    scene *s = with_beam("position: [-1, 0.5, 0], direction: [1, 0, 0], color: [1, 0.5, 0.25], rays: 1", "");
    set_all(s, "camera.position=0,0,-5 camera.target=0,0,0 camera.fov_deg=90 render.width=64 render.height=64");
    image *img = drawn(s, 64, 64, 0.0F);
    for (int x = 28; x < 64; x++) {
        expect_pixel(img, x, 27, 0.0); /* 1.3 px away */
        expect_pixel(img, x, 28, 0.8); /* 0.3 px away: 0.6 + 0.5 - 0.3 */
        expect_pixel(img, x, 29, 0.4);
        expect_pixel(img, x, 30, 0.0);
    }
    for (int x = 0; x < 24; x++)
        expect_pixel(img, x, 28, 0.0);
    image_destroy(img);
    scene *walled = with_beam("position: [-1, 0.5, 0], direction: [1, 0, 0], color: [1, 0.5, 0.25], rays: 1",
                              "wall: {shape: box, size: [1, 4, 4], position: [1.5, 0, 0]}");
    set_all(walled, "camera.position=0,0,-5 camera.target=0,0,0 camera.fov_deg=90");
    img = drawn(walled, 64, 64, 0.0F); /* until x = 1, column 38.4 */
    expect_pixel(img, 36, 28, 0.8);
    expect_pixel(img, 40, 28, 0.0);
    image_destroy(img);
    scene_destroy(walled);
    img = drawn(s, 64, 64, 4.0F); /* a surface in front of it */
    expect_pixel(img, 40, 28, 0.15 * 0.8);
    image_destroy(img);
    img = drawn(s, 64, 64, 6.0F);
    expect_pixel(img, 40, 28, 0.8);
    image_destroy(img);
    set_all(s, "render.width=8 render.height=1600"); /* lines grow with the image: 2 px to either side */
    img = drawn(s, 8, 1600, 0.0F);
    expect_pixel(img, 6, 720, 1.0); /* 1600 * 0.9 / 2 = 720 */
    expect_pixel(img, 6, 721, 1.0);
    expect_pixel(img, 6, 722, 0.0);
    image_destroy(img);
    scene_destroy(s);
}

/* Under parallel rays, 16 px to a scene unit, a beam whose distance from the eye is 5 + x passes through a surface at a
 * distance of 5 in column 32. */
static void a_drawn_beam_passes_through_a_surface(void **state)
{
    (void)state;
    scene *s = with_beam("position: [-1, 0.5, -1], direction: [1, 0, 1], color: [1, 0.5, 0.25], rays: 1", "");
    set_all(s, "camera.projection=orthographic camera.view_height=4 camera.position=0,0,-5 camera.target=0,0,0 "
               "render.width=64 render.height=64");
    image *img = drawn(s, 64, 64, 5.0F);
    const double visible = img->pixel[3 * (24 * 64 + 20)] - 0.2;
    assert_true(visible > 0.1);
    for (int x = 20; x < 44; x++)
        assert_true(fabs(img->pixel[3 * (24 * 64 + x)] - 0.2 - (x < 32 ? 1.0 : 0.15) * visible) < 1e-6);
    image_destroy(img);
    scene_destroy(s);
}

/* Light of two colours at one place: red and green of equal cover are yellow, in either order; and a white beam, whose
 * wavelengths coincide in a vacuum, has no colour of one of them. */
static void colours_at_one_place_mix(void **state)
{
    (void)state;
    static const char *const orders[] = {"a: {color: [1, 0, 0], %s}, b: {color: [0, 1, 0], %s}",
                                         "a: {color: [0, 1, 0], %s}, b: {color: [1, 0, 0], %s}"};
    const char *where = "position: [-1, 0.5, 0], direction: [1, 0, 0], rays: 1";
    for (int i = 0; i < 3; i++) {
        char beams[400], text[600];
        snprintf(beams, sizeof beams, orders[i % 2], where, where);
        if (i == 2)
            snprintf(beams, sizeof beams, "a: {white: on, wavelengths: 21, %s}", where);
        snprintf(text, sizeof text, "beams: {%s}\n", beams);
        scene *s = scene_from(text);
        set_all(s, "camera.position=0,0,-5 camera.target=0,0,0 camera.fov_deg=90 render.width=64 render.height=64");
        image *img = drawn(s, 64, 64, 0.0F);
        const float *at = img->pixel + 3 * (28 * 64 + 40); /* a cover of 0.8, as above */
        if (i < 2) {
            assert_true(fabs((double)at[0] - 0.84) < 1e-6 && fabs((double)at[1] - 0.84) < 1e-6);
            assert_true(fabs((double)at[2] - 0.04) < 1e-6);
        } else {
            assert_true(fmin(fmin((double)at[0], (double)at[1]), (double)at[2]) > 0.4); /* red alone: 0.04 */
        }
        image_destroy(img);
        scene_destroy(s);
    }
}

/* What hides beams: the opaque solids of the scene, whose distances the layers of the integrator aov have. */
static void only_opaque_solids_hide_beams(void **state)
{
    (void)state;
    scene *s = with_beam("rays: 1", "ground: {shape: plane}, glass: {shape: sphere, transparency: 1, ior: 1.5}");
    scene *hiding = NULL;
    diagnostic why = {.line = 0};
    worked(beams_hiding_scene(s, &hiding, &why), &why);
    assert_true(hiding->solids[0].visible && !hiding->solids[1].visible);
    assert_true(s->solids[1].visible);
    scene_destroy(hiding);
    scene_destroy(s);
}

static status count_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    (void)ray, (void)tree, (void)p, (void)why;
    ++*(int *)context;
    return STATUS_OK;
}

/* A screen is answered while the laboratory's image waits. */
static void the_work_of_a_screen_is_limited(void **state)
{
    (void)state;
    scene *s = with_beam("kind: sheet, rays: 10000, white: on, wavelengths: 64, field_rows: 2", BALL);
    diagnostic why = {.line = 0};
    beam_screen screen = {.normal = {0, 0, 1}, .width = 1, .height = 1, .columns = 1, .rows = 1};
    assert_int_equal(beam_screen_expose(s, isa_best(), &screen, &why), STATUS_BAD_INPUT);
    assert_int_equal(screen.ray_count, 0);
    assert_string_equal(why.what, "the beams have more than 1000000 rays");
    beam_screen_release(&screen);
    scene_destroy(s);
}

/* render.depth and render.min_weight do not act on beams. */
static void the_remedy_for_a_ray_of_too_many_segments_is_the_beams_own(void **state)
{
    (void)state;
    char text[2000] = "beams: {laser: {position: [0, 0, -3], target: [0, 0, 0], branches: on, depth: 64, "
                      "min_fraction: 0}}\nsolids:\n";
    for (int i = 0; i < 10; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "  pane%d: {shape: box, size: [9, 9, 0.2], position: [0, 0, %g], transparency: 1, ior: 1.5, "
                 "priority: %d}\n",
                 i, 0.5 * i, i + 1);
    scene *s = scene_from(text);
    diagnostic why = {.line = 0};
    int rays = 0;
    assert_int_equal(beams_each_ray(s, isa_best(), 0, count_ray, &rays, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "a ray of beam 'laser' has more than 2000000 segments");
    assert_string_equal(why.remedy, "use a smaller depth or a larger min_fraction");
    scene_destroy(s);
}

/* Its normal is a parameter of a fan and a sheet alone. */
static void the_normal_of_a_pencil_is_ignored(void **state)
{
    (void)state;
    scene *s = with_beam("direction: [1, 0, 0], normal: [1, 0, 0]", BALL);
    diagnostic why = {.line = 0};
    int rays = 0;
    worked(beams_each_ray(s, isa_best(), 0, count_ray, &rays, &why), &why);
    assert_int_equal(rays, 1);
    scene_destroy(s);
}

/* A laser that meets a surface still meets it after the whole scene was moved, turned and scaled. */
static void beams_go_with_the_whole_scene(void **state)
{
    (void)state;
    scene *s = with_beam("direction: [1, 0, 0], width: 0.5, normal: [0, 1, 0]", BALL);
    diagnostic why = {.line = 0};
    const beam *b = &s->beams[0];
    const vec3 from = b->position, target = b->target;
    worked(scene_move(s, "all", vec3_make(1, 2, 3), &why), &why);
    assert_true(b->position.x == from.x + 1 && b->position.z == from.z + 3 && b->target.y == target.y + 2);
    worked(scene_move(s, "solids", vec3_make(5, 5, 5), &why), &why); /* these alone */
    assert_true(b->position.x == from.x + 1);
    worked(scene_move(s, "lights", vec3_make(-1, -2, -3), &why), &why);
    assert_true(b->position.x == from.x && b->position.y == from.y);
    worked(scene_turn(s, "lights", vec3_make(0, 90, 0), &why), &why); /* x becomes -z */
    assert_true(fabs(b->position.z + from.x) < 1e-12 && fabs(b->position.x - from.z) < 1e-12);
    assert_true(fabs(b->direction.z + 1) < 1e-12 && fabs(b->direction.x) < 1e-12 && b->normal.y == 1);
    worked(scene_scale(s, "all", 2, &why), &why);
    assert_true(b->width == 1.0 && b->position.y == 2 * from.y && fabs(b->direction.z + 1) < 1e-12);
    scene_destroy(s);
}

/* A move that would leave the range of a later object moves no beam. */
static void a_refused_move_leaves_beams(void **state)
{
    (void)state;
    scene *s = with_beam("direction: [1, 0, 0]", BALL);
    diagnostic why = {.line = 0};
    worked(scene_set(s, "ray.target", "1e6,0,0", &why), &why);
    const vec3 from = s->beams[0].position;
    assert_int_equal(scene_move(s, "all", vec3_make(1e9, 0, 0), &why), STATUS_BAD_INPUT);
    assert_memory_equal(&from, &s->beams[0].position, sizeof from);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(invalid_beams_are_refused_with_place_and_remedy),
        cmocka_unit_test(a_written_beam_is_read_back),
        cmocka_unit_test(beams_do_not_change_the_film),
        cmocka_unit_test(rays_equal_those_of_a_fan),
        cmocka_unit_test(a_laser_equals_a_traced_ray),
        cmocka_unit_test(a_beam_obeys_snell_and_fresnel),
        cmocka_unit_test(white_light_has_several_wavelengths_and_the_same_power),
        cmocka_unit_test(a_screen_bins_the_power_of_a_bundle),
        cmocka_unit_test(rays_that_miss_a_screen_are_in_no_bin),
        cmocka_unit_test(a_screen_in_a_medium_receives_what_is_not_absorbed),
        cmocka_unit_test(a_screen_shows_where_and_in_which_colour),
        cmocka_unit_test(a_drawn_beam_is_at_its_pixels),
        cmocka_unit_test(a_drawn_beam_passes_through_a_surface),
        cmocka_unit_test(colours_at_one_place_mix),
        cmocka_unit_test(only_opaque_solids_hide_beams),
        cmocka_unit_test(the_remedy_for_a_ray_of_too_many_segments_is_the_beams_own),
        cmocka_unit_test(the_work_of_a_screen_is_limited),
        cmocka_unit_test(the_normal_of_a_pencil_is_ignored),
        cmocka_unit_test(beams_go_with_the_whole_scene),
        cmocka_unit_test(a_refused_move_leaves_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
