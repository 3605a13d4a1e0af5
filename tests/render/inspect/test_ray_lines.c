/* Tests of the one rule by which rays are drawn: what leaves the scene runs to the edge of the frame. The expected ends
 * are closed forms that share no code with the rule: the projected ray meets each edge of the frame at one point, found
 * by solving for it; of these, of the start and of the vanishing point (Hartley and Zisserman, "Multiple View
 * Geometry", 2nd edition, 8.6.1), those in front of the camera and in the frame bound the line. From in front of the
 * plane of an orthographic camera, a ray leaves past the plane to the edge. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "random_stream.h"
#include "render/inspect/beams.h"
#include "render/inspect/fan.h"
#include "render/inspect/ray_line.h"
#include "render_fixture.h"
#include "report/page.h"
#include "report/trace_writers.h"
#include "scene/model/camera.h"

enum { BEAMS = 20, WIDTH = 120, HEIGHT = 90 };
#define LINES 4000

/* --- the closed form --- */

typedef struct point2 {
    double x, y;
} point2;

typedef struct bounds {
    int count;
    point2 at[2];
    double s[2]; /* distance along the ray; HUGE_VAL at the vanishing point */
} bounds;

static void include(bounds *b, point2 p, double s)
{
    if (b->count == 0 || s < b->s[0])
        b->at[0] = p, b->s[0] = s;
    if (b->count == 0 || s > b->s[1])
        b->at[1] = p, b->s[1] = s;
    b->count++;
}

static bool inside(const image_frame *f, point2 p)
{
    const double slack = 1e-7 * (f->right - f->left);
    return p.x >= f->left - slack && p.x <= f->right + slack && p.y >= f->top - slack && p.y <= f->bottom + slack;
}

static point2 image_of(const camera_frame *v, const image_frame *f, vec3 offset)
{
    const double depth = v->parallel ? 1.0 : vec3_dot(offset, v->forward);
    return (point2){(vec3_dot(offset, v->right) / depth / v->half_width + 1.0) * 0.5 * f->width,
                    (1.0 - vec3_dot(offset, v->up) / depth / v->half_height) * 0.5 * f->height};
}

/* The distance at which the image of o + s d has the coordinate `at` of one axis: x right / (z half) = u. */
static double crossing(const camera_frame *v, vec3 o, vec3 d, vec3 axis, double half, double u)
{
    const vec3 n = v->parallel ? axis : vec3_sub(axis, vec3_scale(v->forward, u * half));
    return ((v->parallel ? u * half : 0.0) - vec3_dot(o, n)) / vec3_dot(d, n);
}

static bounds expected(const camera_frame *v, const image_frame *f, vec3 from, vec3 d)
{
    bounds b = {.count = 0};
    const vec3 o = vec3_sub(from, v->eye);
    const double rate = vec3_dot(d, v->forward), depth = vec3_dot(o, v->forward);
    const double near = !v->parallel ? 1e-12 : depth >= 0.0 ? -HUGE_VAL : 0.0;
    double s[6] = {0.0, v->parallel && depth < 0.0 ? -depth / rate : -1.0};
    s[2] = crossing(v, o, d, v->right, v->half_width, 2.0 * f->left / f->width - 1.0);
    s[3] = crossing(v, o, d, v->right, v->half_width, 2.0 * f->right / f->width - 1.0);
    s[4] = crossing(v, o, d, v->up, v->half_height, 1.0 - 2.0 * f->top / f->height);
    s[5] = crossing(v, o, d, v->up, v->half_height, 1.0 - 2.0 * f->bottom / f->height);
    for (int k = 0; k < 6; k++) {
        const vec3 there = vec3_add(o, vec3_scale(d, s[k]));
        const bool ahead = s[k] >= 0.0 && (k == 1 || vec3_dot(there, v->forward) >= near);
        if (ahead && inside(f, image_of(v, f, there)))
            include(&b, image_of(v, f, there), s[k]);
    }
    if (!v->parallel && rate > 0.0 && inside(f, image_of(v, f, d)))
        include(&b, image_of(v, f, d), HUGE_VAL);
    return b;
}

static double apart(point2 a, point2 b)
{
    return hypot(a.x - b.x, a.y - b.y);
}

static bool on_edge(const image_frame *f, point2 p, double slack)
{
    const double across = fmin(fabs(p.x - f->left), fabs(p.x - f->right));
    const double down = fmin(fabs(p.y - f->top), fabs(p.y - f->bottom));
    return fmin(across, down) <= slack && inside(f, p);
}

/* --- cameras and rays --- */

static camera_frame random_camera(scene *s, uint64_t *seed)
{
    s->camera.projection = random_below(seed, 2);
    s->camera.position = random_point(seed, 6.0);
    s->camera.target = random_point(seed, 2.0);
    s->camera.fov_deg = random_real(seed, 10.0, 120.0);
    s->camera.view_height = random_real(seed, 1.0, 12.0);
    s->camera.roll_deg = random_real(seed, -180.0, 180.0);
    return camera_frame_of(s);
}

static ray_line endless(vec3 from, vec3 d)
{
    const ray_node node = {.origin = from, .direction = d, .end = RAY_END_SKY};
    return ray_line_of(&node);
}

static scene *empty_room(const char *assignments)
{
    scene *s = scene_from("camera: {position: [0, 0, -6], target: [0, 0, 0]}\n");
    char all[200];
    snprintf(all, sizeof all, "render.width=%d render.height=%d %s", WIDTH, HEIGHT, assignments);
    set_all(s, all);
    return s;
}

static void lines_of_random_rays_have_the_ends_of_the_closed_form(void **state)
{
    (void)state;
    uint64_t seed = 47;
    scene *s = empty_room("");
    int drawn = 0, to_edge = 0, vanishing = 0, past_plane = 0, from_behind = 0;
    for (int k = 0; k < LINES; k++) {
        const camera_frame v = random_camera(s, &seed);
        const image_frame f = image_frame_of(WIDTH, HEIGHT, k % 3 ? 0.0 : random_real(&seed, 0.0, 40.0));
        const vec3 from = random_point(&seed, 8.0), d = random_direction(&seed);
        const ray_line line = endless(from, d);
        const bounds wanted = expected(&v, &f, from, d);
        vec3 ends[2];
        const bool seen = ray_line_seen(&line, &v, &f, ends);
        if (wanted.count < 2) { /* a corner at most */
            assert_true(!seen || hypot(ends[0].x - ends[1].x, ends[0].y - ends[1].y) < 1e-4);
            continue;
        }
        assert_true(seen);
        for (int e = 0; e < 2; e++)
            assert_true(apart((point2){ends[e].x, ends[e].y}, wanted.at[e]) < 1e-6 * WIDTH);
        drawn++;
        const bool edge = on_edge(&f, (point2){ends[1].x, ends[1].y}, 1e-9 * WIDTH);
        to_edge += edge;
        vanishing += !edge && isinf(ends[1].z);
        past_plane += v.parallel && ends[1].z < 0.0;
        from_behind += vec3_dot(vec3_sub(from, v.eye), v.forward) < 0.0;
    }
    assert_true(drawn > LINES / 4 && from_behind > LINES / 100);
    assert_true(to_edge > drawn / 2 && vanishing > drawn / 20 && past_plane > drawn / 50);
    assert_int_equal(to_edge + vanishing, drawn);
    scene_destroy(s);
}

static void assert_ends(const vec3 ends[2], double x0, double y0, double x1, double y1)
{
    assert_true(fabs(ends[0].x - x0) + fabs(ends[0].y - y0) + fabs(ends[1].x - x1) + fabs(ends[1].y - y1) < 1e-6);
}

/* From the origin along +z, half an image width per unit of slope. */
static camera_frame looking_along_z(bool parallel)
{
    return (camera_frame){.forward = {0, 0, 1},
                          .right = {1, 0, 0},
                          .up = {0, 1, 0},
                          .half_width = 1.0,
                          .half_height = 0.75,
                          .parallel = parallel};
}

static void special_rays(void **state)
{
    (void)state;
    const image_frame f = image_frame_of(WIDTH, HEIGHT, 0.0);
    const camera_frame eye = looking_along_z(false), parallel = looking_along_z(true);
    vec3 ends[2];
    /* From the eye: a point. */
    ray_line line = endless(vec3_make(0, 0, 0), vec3_normalize(vec3_make(0.5, 0, 1)));
    assert_true(ray_line_seen(&line, &eye, &f, ends));
    assert_ends(ends, 90, 45, 90, 45);
    /* Along the view: in perspective from its start to the middle, under parallel rays a point. */
    line = endless(vec3_make(0.5, 0, 1), vec3_make(0, 0, 1));
    assert_true(ray_line_seen(&line, &eye, &f, ends));
    assert_ends(ends, 90, 45, 60, 45);
    assert_true(ends[0].z == 1.0 && isinf(ends[1].z));
    assert_true(ray_line_seen(&line, &parallel, &f, ends));
    assert_ends(ends, 90, 45, 90, 45);
    line = endless(vec3_make(0.5, 0, 1), vec3_normalize(vec3_make(1e-16, -1e-17, 1))); /* up to rounding */
    assert_true(ray_line_seen(&line, &parallel, &f, ends));
    assert_ends(ends, 90, 45, 90, 45);
    /* Straight at the eye from the front: the middle, up to the near plane. */
    line = endless(vec3_make(0, 0, 8), vec3_make(0, 0, -1));
    assert_true(ray_line_seen(&line, &eye, &f, ends));
    assert_ends(ends, 60, 45, 60, 45);
    assert_true(ends[0].z == 8.0 && ends[1].z > 0.0 && ends[1].z < 1e-4);
    /* Past the eye: towards the viewer, and out by the left edge, at y 0.2 / 1 of the height there. */
    line = endless(vec3_make(0, 0, 4), vec3_normalize(vec3_make(-1, 0.2, -5)));
    assert_true(ray_line_seen(&line, &eye, &f, ends));
    assert_ends(ends, 60, 45, 0, 45 - 0.2 / 0.75 * 45);
    /* A segment from behind the eye to a hit in front of it begins at the right edge, where x = z. */
    line = ray_line_between(vec3_make(0.5, 0, -2), vec3_make(0.5, 0, 2));
    assert_true(ray_line_seen(&line, &eye, &f, ends));
    assert_ends(ends, 120, 45, 75, 45);
    assert_true(fabs(ends[0].z - 0.5) < 1e-12 && ends[1].z == 2.0);
    /* Through the eye: cut at the near plane. */
    line = ray_line_between(vec3_make(0, 0, -2), vec3_make(0, 0, 2));
    assert_true(ray_line_seen(&line, &eye, &f, ends));
    assert_ends(ends, 60, 45, 60, 45);
    assert_true(ends[0].z > 0.0 && ends[0].z < 1e-4);
    /* Under parallel rays from behind the plane of the camera: from that plane. */
    line = endless(vec3_make(-1.5, 0, -1), vec3_normalize(vec3_make(1, 0, 1)));
    assert_true(ray_line_seen(&line, &parallel, &f, ends));
    assert_ends(ends, 30, 45, 120, 45);
    /* Past that plane: on to the edge; a segment to a hit behind the plane ends at it. */
    line = endless(vec3_make(0, 0, 1), vec3_normalize(vec3_make(1, 0, -4)));
    assert_true(ray_line_seen(&line, &parallel, &f, ends));
    assert_ends(ends, 60, 45, 120, 45);
    assert_true(ends[0].z == 1.0 && fabs(ends[1].z + 3.0) < 1e-12);
    line = ray_line_between(vec3_make(0, 0, 1), vec3_make(0.5, 0, -1));
    assert_true(ray_line_seen(&line, &parallel, &f, ends));
    assert_ends(ends, 60, 45, 75, 45);
    /* Behind the camera, to its right, and cut. */
    line = endless(vec3_make(0, 0, -1), vec3_make(1, 0, 0));
    assert_false(ray_line_seen(&line, &eye, &f, ends) || ray_line_seen(&line, &parallel, &f, ends));
    line = endless(vec3_make(3, 0, 1), vec3_make(1, 0, 0));
    assert_false(ray_line_seen(&line, &eye, &f, ends) || ray_line_seen(&line, &parallel, &f, ends));
    const ray_node cut = {.origin = {0, 0, 1}, .direction = {1, 0, 0}, .end = RAY_END_CUT_DEPTH};
    line = ray_line_of(&cut);
    assert_false(ray_line_seen(&line, &eye, &f, ends));
}

/* --- fronts: twenty random beams each --- */

/* Beams in a scene without solids, from a camera among them; half of them look along parallel rays. */
static scene *with_beams(int k, uint64_t *seed)
{
    char text[1400];
    const vec3 at = random_point(seed, 1.5), d = random_direction(seed);
    snprintf(text, sizeof text,
             "render: {width: %d, height: %d}\n"
             "camera: {position: [0.3, 0.2, -2], target: [0.1, 0, 1], view_height: 2.5, projection: %s}\n"
             "beams:\n  ray: {position: [%.17g, %.17g, %.17g], direction: [%.17g, %.17g, %.17g], color: [1, 1, 1]}\n",
             WIDTH, HEIGHT, k % 2 ? "orthographic" : "perspective", at.x, at.y, at.z, d.x, d.y, d.z);
    return scene_from(text);
}

static bounds expected_of_beam(const scene *s, const image_frame *f)
{
    const camera_frame v = camera_frame_of(s);
    return expected(&v, f, s->beams[0].position, vec3_normalize(beam_axis(&s->beams[0])));
}

/* The largest distance of a white pixel from the segment. */
static double stray_of(const image *img, const bounds *b)
{
    const double dx = b->at[1].x - b->at[0].x, dy = b->at[1].y - b->at[0].y, size = dx * dx + dy * dy;
    double most = 0.0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double px = x + 0.5 - b->at[0].x, py = y + 0.5 - b->at[0].y;
            const double t = size > 0.0 ? fmin(1.0, fmax(0.0, (px * dx + py * dy) / size)) : 0.0;
            if (img->pixel[3 * (y * WIDTH + x)] > 0.0f)
                most = fmax(most, hypot(px - t * dx, py - t * dy));
        }
    return most;
}

static double to_white_pixel(const image *img, point2 p)
{
    double least = HUGE_VAL;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if (img->pixel[3 * (y * WIDTH + x)] > 0.0f)
                least = fmin(least, apart(p, (point2){x + 0.5, y + 0.5}));
    return least;
}

/* The largest distance of a point of the segment from a white pixel. */
static double gap_of(const image *img, const bounds *b)
{
    double most = 0.0;
    for (int i = 0; i <= 40; i++) {
        const point2 p = {b->at[0].x + i / 40.0 * (b->at[1].x - b->at[0].x),
                          b->at[0].y + i / 40.0 * (b->at[1].y - b->at[0].y)};
        most = fmax(most, to_white_pixel(img, p));
    }
    return most;
}

static void in_an_image_escaping_beams_reach_the_edge(void **state)
{
    (void)state;
    uint64_t seed = 20;
    const image_frame f = image_frame_of(WIDTH, HEIGHT, 0.0), wider = image_frame_of(WIDTH, HEIGHT, 3.0);
    float *distance = calloc(WIDTH * HEIGHT, sizeof *distance);
    int drawn = 0;
    for (int k = 0; k < 400 && drawn < BEAMS; k++) {
        scene *s = with_beams(k, &seed);
        const bounds wanted = expected_of_beam(s, &f), around = expected_of_beam(s, &wider);
        float pixels[3 * WIDTH * HEIGHT] = {0};
        image img = {.width = WIDTH, .height = HEIGHT, .pixel = pixels};
        diagnostic why = {0};
        worked(beams_draw(s, isa_best(), distance, &img, &why), &why);
        if (wanted.count >= 2) {
            /* A line is 1.2 px wide, with soft edges of half a pixel. */
            assert_true(stray_of(&img, &around) < 1.2 && gap_of(&img, &wanted) < 1.0);
            drawn++;
        }
        scene_destroy(s);
    }
    assert_int_equal(drawn, BEAMS);
    free(distance);
}

typedef struct drawn_line {
    point2 a, b;
} drawn_line;

/* The next line of this kind in a drawing. */
static const char *next_line(const char *text, const char *kind, drawn_line *line)
{
    for (const char *at = text; (at = strstr(at, "<line ")); at++) {
        const char *end = strchr(at, '>'), *found = strstr(at, kind), *x = strstr(at, "x1=");
        if (end && found && found < end && x &&
            sscanf(x, "x1=\"%lf\" y1=\"%lf\" x2=\"%lf\" y2=\"%lf\"", &line->a.x, &line->a.y, &line->b.x, &line->b.y) ==
                4)
            return end;
    }
    return NULL;
}

static void on_a_page_escaping_beams_reach_the_edge(void **state)
{
    (void)state;
    uint64_t seed = 21;
    const image_frame f = image_frame_of(WIDTH, HEIGHT, 0.0);
    int drawn = 0;
    for (int k = 0; k < 400 && drawn < BEAMS; k++) {
        scene *s = with_beams(k, &seed);
        const bounds wanted = expected_of_beam(s, &f);
        page_rays rays = {.ray = NULL};
        diagnostic why = {0};
        char *text = NULL;
        size_t size;
        worked(page_rays_collect(&rays, s, isa_best(), WIDTH, HEIGHT, &why), &why);
        FILE *out = open_memstream(&text, &size);
        page_rays_write_drawing(&rays, WIDTH, HEIGHT, out);
        fclose(out);
        drawn_line line;
        assert_int_equal(next_line(text, "class=\"beam\"", &line) != NULL, wanted.count >= 2);
        if (wanted.count >= 2) {
            assert_true(apart(line.a, wanted.at[0]) < 0.01 && apart(line.b, wanted.at[1]) < 0.01);
            drawn++;
        }
        free(text);
        page_rays_release(&rays);
        scene_destroy(s);
    }
    assert_int_equal(drawn, BEAMS);
}

/* The frame of a panel, from the path of its axes, the k-th in the file. */
static image_frame panel_of(const char *text, int k)
{
    image_frame f = {.width = 1, .height = 1};
    for (const char *at = text; (at = strstr(at, "<path d=\"M")); at++)
        if (sscanf(at, "<path d=\"M%lf %lfV%lfH%lf\"", &f.left, &f.top, &f.bottom, &f.right) == 4 && k-- == 0)
            return f;
    fail_msg("no panel");
    return f;
}

/* A line from its start in the direction (x, y) to the edge of the panel: coordinates have two digits. */
static void assert_runs_to_edge(const image_frame *f, const drawn_line *line, double x, double y)
{
    const double size = hypot(x, y), long_px = apart(line->a, line->b);
    assert_true(on_edge(f, line->b, 0.006));
    assert_true(fabs((line->b.x - line->a.x) * y - (line->b.y - line->a.y) * x) / size < 0.02 && long_px > 1.0);
    assert_true((line->b.x - line->a.x) * x + (line->b.y - line->a.y) * y > 0.0);
}

/* The left panel is the vertical plane of the ray, the right one the view from above. */
static void in_a_drawing_of_a_tree_escaping_rays_reach_the_edge(void **state)
{
    (void)state;
    uint64_t seed = 22;
    scene *s = empty_room("");
    probe *p = NULL;
    ray_tree tree = {0};
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    worked(probe_create(s, isa_best(), &p, &why), &why);
    for (int k = 0; k < BEAMS; k++) {
        const vec3 from = random_point(&seed, 3.0), d = random_direction(&seed);
        char *text = NULL;
        size_t size;
        worked(probe_ray(p, from, d, &tree, &why), &why);
        FILE *out = open_memstream(&text, &size);
        worked(trace_write_drawing(&(traced){s, p, &tree, "test", false}, out, &why), &why);
        fclose(out);
        drawn_line line;
        const image_frame side = panel_of(text, 0), top = panel_of(text, 1);
        const char *rest = next_line(text, "stroke-width=\"1.80\"", &line);
        assert_non_null(rest);
        assert_runs_to_edge(&side, &line, hypot(d.x, d.z), -d.y);
        assert_non_null(next_line(rest, "stroke-width=\"1.80\"", &line));
        assert_runs_to_edge(&top, &line, d.x, -d.z);
        free(text);
    }
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

static void in_a_drawing_of_a_fan_escaping_rays_reach_the_edge(void **state)
{
    (void)state;
    uint64_t seed = 23;
    scene *s = empty_room("");
    probe *p = NULL;
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    worked(probe_create(s, isa_best(), &p, &why), &why);
    for (int k = 0; k < BEAMS; k++) {
        const fan_rule rule = {.from = random_point(&seed, 3.0), .to = random_point(&seed, 3.0), .rays = 1};
        const vec3 d = vec3_normalize(vec3_sub(rule.to, rule.from));
        fan f = {0};
        char *text = NULL;
        size_t size;
        worked(fan_trace(p, &rule, &f, &why), &why);
        FILE *out = open_memstream(&text, &size);
        worked(fan_write_drawing(&(fan_output){.s = s, .p = p, .rule = &rule, .f = &f}, out, &why), &why);
        fclose(out);
        drawn_line line;
        const image_frame panel = panel_of(text, 0);
        assert_non_null(next_line(text, "stroke-width=\"1.80\"", &line));
        assert_runs_to_edge(&panel, &line, hypot(d.x, d.z), -d.y); /* a vertical plane, rays to the right */
        free(text);
        fan_release(&f);
    }
    probe_destroy(p);
    scene_destroy(s);
}

/* A ray across the section is a point in it, whatever the rounding of its direction. */
static void a_ray_across_a_section_is_a_point(void **state)
{
    (void)state;
    const section_plane window = {.e_u = {0.6, 0.8, 0}, .e_v = {-0.8, 0.6, 0}, .u0 = -1, .u1 = 1, .v0 = -1, .v1 = 1};
    const ray_line line = endless(vec3_make(0.2, 0.1, -3), vec3_make(1e-16, -3e-17, 1));
    section_point ends[2];
    assert_true(ray_line_projected(&line, &window, ends));
    assert_true(hypot(ends[0].u - ends[1].u, ends[0].v - ends[1].v) == 0.0 && fabs(ends[0].u - 0.2) < 1e-15);
}

/* --- what hides a line --- */

/* A beam in the plane z = 1 in front of a wall at z = 1.2, and behind one at z = 0.8: its distance in the middle of the
 * image is 1, although that of both its ends is over 1.2. */
static void a_line_is_dimmed_only_behind_surfaces(void **state)
{
    (void)state;
    scene *s = scene_from("camera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 90}\n"
                          "beams:\n  ray: {position: [-9, 0, 1], direction: [1, 0, 0], color: [1, 1, 1]}\n");
    const int middle = 3 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    static const struct {
        double z, least, most;
    } walls[] = {{1.2, 0.59, 0.61}, {0.8, 0.089, 0.091}}; /* two rows share a line 1.2 px wide */
    char size[64];
    snprintf(size, sizeof size, "render.width=%d render.height=%d", WIDTH, HEIGHT);
    set_all(s, size);
    const camera_frame v = camera_frame_of(s);
    for (size_t k = 0; k < sizeof walls / sizeof *walls; k++) {
        float distance[WIDTH * HEIGHT], pixels[3 * WIDTH * HEIGHT] = {0};
        image img = {.width = WIDTH, .height = HEIGHT, .pixel = pixels};
        diagnostic why = {0};
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double x = ((i % WIDTH + 0.5) / WIDTH * 2.0 - 1.0) * v.half_width;
            const double y = (1.0 - (i / WIDTH + 0.5) / HEIGHT * 2.0) * v.half_height;
            distance[i] = (float)(walls[k].z * sqrt(1.0 + x * x + y * y));
        }
        worked(beams_draw(s, isa_best(), distance, &img, &why), &why);
        double brightest = 0.0;
        for (int row = -1; row < 2; row++)
            brightest = fmax(brightest, (double)pixels[middle + 3 * row * WIDTH]);
        assert_true(brightest > walls[k].least && brightest < walls[k].most);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_of_random_rays_have_the_ends_of_the_closed_form),
        cmocka_unit_test(special_rays),
        cmocka_unit_test(in_an_image_escaping_beams_reach_the_edge),
        cmocka_unit_test(on_a_page_escaping_beams_reach_the_edge),
        cmocka_unit_test(in_a_drawing_of_a_tree_escaping_rays_reach_the_edge),
        cmocka_unit_test(in_a_drawing_of_a_fan_escaping_rays_reach_the_edge),
        cmocka_unit_test(a_ray_across_a_section_is_a_point),
        cmocka_unit_test(a_line_is_dimmed_only_behind_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
