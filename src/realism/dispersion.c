/* Deviation by wavelength: a prism, and the first rainbow of a drop. */
#include "realism/metrics.h"

#include "geometry/shapes/shape.h"
#include "scene/model/edit/edit.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>
#include <string.h>

/* --- a prism --- */

/* Minimum deviation of a prism at the F, d and C lines. The scene has solids named prism, and left and right, the
 * half-spaces that cut its two faces (experiments/scenes/prism.yaml).
 *
 * The deviation is stationary in the angle of incidence at its minimum, so its value is good to rounding. Tolerance:
 * the bound of the path at the closed form's angle, with the rounding of the apex, a difference of two normals. */

/* point: on the left face; left, right: the prism's outward normals; up: along the left face, towards the apex. */
typedef struct prism_faces {
    vec3 point, left, right, up;
    int region;
} prism_faces;

bool prism_is_there(const scene *s)
{
    return scene_find_solid(s, "prism") >= 0 && scene_find_solid(s, "left") >= 0 && scene_find_solid(s, "right") >= 0;
}

/* A half-space is below its local y = 0; the face that it cuts has the negative of its normal as outward normal. */
static vec3 outward(const solid *cut)
{
    return vec3_scale(mat3_apply(rotation_from_deg(cut->shape.rotation_deg), vec3_make(0.0, 1.0, 0.0)), -1.0);
}

static prism_faces faces_of(const scene *s)
{
    const solid *left = &s->solids[scene_find_solid(s, "left")], *right = &s->solids[scene_find_solid(s, "right")];
    prism_faces f = {.point = left->shape.position,
                     .left = outward(left),
                     .right = outward(right),
                     .region = scene_find_solid(s, "prism")};
    f.up = vec3_normalize(vec3_sub(f.right, vec3_scale(f.left, vec3_dot(f.left, f.right))));
    return f;
}

typedef struct prism_search {
    trial *t;
    prism_faces at;
    status code;
    diagnostic *why;
} prism_search;

/* Deviation of a ray that hits the middle of the left face at an angle of incidence; NaN unless it passes both
 * faces. */
static double deviation(void *context, double incidence)
{
    prism_search *s = context;
    const vec3 in = vec3_sub(vec3_scale(s->at.up, sin(incidence)), vec3_scale(s->at.left, cos(incidence)));
    if (s->code == STATUS_OK)
        s->code = probe_path(s->t->p, vec3_sub(s->at.point, vec3_scale(in, 3.0)), in, -1, &s->t->tree, s->why);
    if (s->code != STATUS_OK)
        return NAN;
    const ray_tree *tree = &s->t->tree;
    if (tree->count < 3 || tree->node[2].kind != RAY_REFRACT || tree->node[0].hit.to != s->at.region ||
        tree->node[1].hit.from != s->at.region)
        return NAN;
    const vec3 out = tree->node[2].direction;
    const vec3 across = vec3_cross(in, out);
    return atan2(vec3_length(across), vec3_dot(in, out));
}

/* The least deviation over all angles of incidence at which a ray is transmitted. */
static double least_deviation(prism_search *s)
{
    double low = NAN, high = NAN;
    for (int i = 1; i < 900; i++) {
        const double incidence = i * 1e-1 * M_PI / 180.0;
        if (isnan(deviation(s, incidence)))
            continue;
        low = isnan(low) ? incidence : low;
        high = incidence;
    }
    return isnan(low) ? NAN : least_value(deviation, s, low, high);
}

/* n = sin((A + D) / 2) / sin(A / 2) solved for D: Hecht, Optics, 5th ed., 5.5.1. */
static double theory_least_deviation(double apex, double n)
{
    return 2.0 * asin(n * sin(apex / 2.0)) - apex;
}

static double prism_tolerance(prism_search *search, double apex, double least)
{
    if (isnan(deviation(search, (apex + least) / 2.0)))
        return NAN;
    return bound_path(&search->t->tree, 0.0).heading + bound_difference(BOUND_FORM) * (M_PI + 1.0 / sin(apex));
}

static status prism_at_line(const metrics *m, double lambda_nm, double *measured, double *theory, double *tolerance,
                            diagnostic *why)
{
    const prism_faces supposed = faces_of(m->supposed);
    const double apex = M_PI - acos(vec3_dot(supposed.left, supposed.right));
    *theory = theory_least_deviation(apex, relative_index(m->supposed, supposed.region, lambda_nm));
    trial t;
    prism_search search = {.t = &t, .at = faces_of(m->traced), .why = why};
    search.code = trial_start(&t, arrange_at(m->traced, lambda_nm), m->level, why);
    *measured = search.code == STATUS_OK ? least_deviation(&search) : NAN;
    *tolerance = search.code == STATUS_OK && !isnan(*theory) ? prism_tolerance(&search, apex, *theory) : NAN;
    trial_end(&t);
    return search.code;
}

status realism_prism(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"prism.F", "prism.d", "prism.C", "prism.own"};
    static const char *const what[] = {
        "minimum deviation at the F line, 486.1 nm", "minimum deviation at the d line, 587.6 nm",
        "minimum deviation at the C line, 656.3 nm", "minimum deviation at render.lambda_nm"};
    double off[3];
    const status code = metrics_at_lines(m, names, what, NULL, prism_at_line, off, why);
    if (code == STATUS_OK)
        metrics_add(m, (realism_value){"prism.F-C",
                                       "angular dispersion: minimum deviation at the F line minus that at the C line",
                                       "rad", off[0], off[1], off[2]});
    return code;
}

status prism_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    const double lambda_nm = m->traced->render.lambda_nm, degree = M_PI / 180.0;
    const prism_faces faces = faces_of(m->supposed);
    const double apex = M_PI - acos(vec3_dot(faces.left, faces.right)),
                 n = relative_index(m->supposed, faces.region, lambda_nm);
    trial t;
    prism_search search = {.t = &t, .at = faces_of(m->traced), .why = why};
    search.code = trial_start(&t, arrange_at(m->traced, lambda_nm), m->level, why);
    for (int i = 2; i < 360 && search.code == STATUS_OK; i++) {
        const double measured = deviation(&search, 0.25 * i * degree);
        if (!isnan(measured)) /* else total reflection at the second face */
            curve_add(out, 0.25 * i, measured / degree, theory_prism_deviation(0.25 * i * degree, apex, n) / degree);
    }
    trial_end(&t);
    return search.code;
}

/* --- a drop --- */

/* The first rainbow of a drop: a sphere, the first solid whose name begins with drop (experiments/scenes/rainbow.yaml);
 * in a scene without one, a drop of its rain (rainbow-landscape.yaml). The rainbow appears where rays with one internal
 * reflection have minimum deviation, at an angle from the antisolar point. The angle is stationary in the ray's offset
 * there. Tolerance: the bound of the path at the closed form's offset. */

static int drop_of(const scene *s)
{
    for (size_t i = 0; i < s->solid_count; i++)
        if (strncmp(s->solids[i].name, "drop", 4) == 0 && shape_is_isotropic(&s->solids[i].shape) &&
            !shape_is_scaled(&s->solids[i].shape))
            return (int)i;
    return -1;
}

/* A scene with a vessel is measured as a vessel, even in the rain. */
bool drop_is_there(const scene *s)
{
    setup unused;
    return drop_of(s) >= 0 || (s->background.kind == BACKGROUND_RAIN && setup_read(s, &unused, NULL) != STATUS_OK);
}

/* A scene of one drop of the rain, in air; NULL if memory runs out. */
static scene *drop_of_rain(const scene *s)
{
    size_t at;
    scene *one = scene_create();
    if (!one || scene_add_solid(one, "drop", SHAPE_SPHERE, &at, NULL) != STATUS_OK) {
        scene_destroy(one);
        return NULL;
    }
    one->solids[at].shape = ball_at(vec3_make(0.0, 0.0, 0.0), 1.0);
    one->solids[at].surface.transparency = 1.0;
    one->solids[at].surface.medium = MEDIUM_CATALOGUE + DROPS_FIRST + s->background.drops;
    one->background.medium = SURROUNDING_CATALOGUE; /* air is the first of the catalogue */
    one->render.lambda_nm = s->render.lambda_nm;
    return one;
}

/* The metrics, in which a drop of the rain replaces each scene that has no drop. Call drops_end after drops_begin. */
typedef struct drop_metrics {
    metrics m;
    scene *traced, *supposed; /* owned, or NULL */
} drop_metrics;

static status drops_begin(const metrics *m, drop_metrics *out, diagnostic *why)
{
    *out = (drop_metrics){.m = *m};
    if (drop_of(m->traced) < 0)
        out->m.traced = out->traced = drop_of_rain(m->traced);
    if (drop_of(m->supposed) < 0)
        out->m.supposed = out->supposed = drop_of_rain(m->supposed);
    return out->m.traced && out->m.supposed ? STATUS_OK : out_of_memory(why);
}

static void drops_end(drop_metrics *drops)
{
    scene_destroy(drops->traced);
    scene_destroy(drops->supposed);
}

/* A copy in which only the drop is visible, at the origin, where points have the smallest rounding errors. */
static scene *drop_scene(const scene *s, double lambda_nm)
{
    scene *copy = arrange_at(s, lambda_nm);
    const int drop = drop_of(s);
    for (size_t i = 0; copy && i < copy->solid_count; i++)
        copy->solids[i].visible = (int)i == drop;
    if (copy)
        copy->solids[drop].shape.position = vec3_make(0.0, 0.0, 0.0);
    return copy;
}

typedef struct drop_search {
    trial *t;
    status code;
    diagnostic *why;
    double radius;
} drop_search;

/* Minus the angle between the emerging ray and the reversed incident ray, for a ray aimed past the centre at `offset`
 * radii. NaN unless the ray is reflected once inside. */
static double minus_backward_angle(void *context, double offset)
{
    drop_search *s = context;
    const vec3 in = vec3_make(0.0, 0.0, 1.0);
    const vec3 from = vec3_make(offset * s->radius, 0.0, -4.0 * s->radius);
    if (s->code == STATUS_OK)
        s->code = probe_path(s->t->p, from, in, 1, &s->t->tree, s->why);
    if (s->code != STATUS_OK || s->t->tree.count != 4)
        return NAN;
    const vec3 out = s->t->tree.node[3].direction;
    return -atan2(vec3_length(vec3_cross(in, out)), -vec3_dot(in, out));
}

/* The angle is largest at minimum deviation, between the axis and the edge of the drop. */
static double rainbow_angle(drop_search *s)
{
    return -least_value(minus_backward_angle, s, 0.4, 0.9999);
}

/* cos i = sqrt((n^2 - 1) / 3), angle 4 r - 2 i: Born and Wolf, Principles of Optics, 7th ed., 4.7 exercises;
 * Nussenzveig, "The theory of the rainbow", Scientific American 236(4), 1977. NaN for n outside 1 .. 2, where no such
 * ray exists. */
static double theory_rainbow(double n)
{
    if (!(n > 1.0 && n < 2.0))
        return NAN;
    const double i = acos(sqrt((n * n - 1.0) / 3.0)), r = asin(sin(i) / n);
    return 4.0 * r - 2.0 * i;
}

static double rainbow_tolerance(drop_search *search, double n)
{
    if (isnan(minus_backward_angle(search, sqrt((4.0 - n * n) / 3.0)))) /* sin i */
        return NAN;
    return bound_around(&search->t->tree, vec3_make(0.0, 0.0, 0.0)) + bound_difference(BOUND_FORM) * M_PI;
}

static status rainbow_at_line(const metrics *m, double lambda_nm, double *measured, double *theory, double *tolerance,
                              diagnostic *why)
{
    trial t;
    const solid *drop = &m->traced->solids[drop_of(m->traced)];
    drop_search search = {.t = &t, .why = why, .radius = drop->shape.radius};
    const double n = relative_index(m->supposed, drop_of(m->supposed), lambda_nm);
    *theory = theory_rainbow(n);
    *tolerance = NAN;
    search.code = trial_start(&t, drop_scene(m->traced, lambda_nm), m->level, why);
    *measured = search.code == STATUS_OK && !isnan(*theory) ? rainbow_angle(&search) : NAN;
    if (search.code == STATUS_OK && !isnan(*theory))
        *tolerance = rainbow_tolerance(&search, n);
    trial_end(&t);
    return search.code;
}

status realism_drop(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"rainbow.F", "rainbow.d", "rainbow.C", "rainbow.own"};
    static const char *const what[] = {
        "angle of the first rainbow at the F line, 486.1 nm", "angle of the first rainbow at the d line, 587.6 nm",
        "angle of the first rainbow at the C line, 656.3 nm", "angle of the first rainbow at render.lambda_nm"};
    double unused[3];
    drop_metrics drops;
    status code = drops_begin(m, &drops, why);
    THEN(code, metrics_at_lines(&drops.m, names, what, "a refractive index outside 1..2 has no primary rainbow",
                                rainbow_at_line, unused, why));
    drops_end(&drops);
    return code;
}

static status rainbow_points(const metrics *m, realism_points *out, diagnostic *why)
{
    const double lambda_nm = m->traced->render.lambda_nm, degree = M_PI / 180.0;
    const solid *drop = &m->traced->solids[drop_of(m->traced)];
    const double n = relative_index(m->supposed, drop_of(m->supposed), lambda_nm);
    trial t;
    drop_search search = {.t = &t, .why = why, .radius = drop->shape.radius};
    search.code = trial_start(&t, drop_scene(m->traced, lambda_nm), m->level, why);
    for (int i = 0; i < 100 && search.code == STATUS_OK; i++)
        curve_add(out, 0.01 * i, -minus_backward_angle(&search, 0.01 * i) / degree,
                  theory_drop_angle(0.01 * i, n) / degree);
    trial_end(&t);
    return search.code;
}

status drop_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    drop_metrics drops;
    status code = drops_begin(m, &drops, why);
    THEN(code, rainbow_points(&drops.m, out, why));
    drops_end(&drops);
    return code;
}
