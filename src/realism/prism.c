/* Minimum deviation of a prism at the F, d and C lines. The scene has solids named prism, and left and right, the
 * half-spaces that cut its two faces (experiments/scenes/prism.yaml).
 *
 * The deviation is stationary in the angle of incidence at its minimum, so its value is good to rounding. Tolerance: the
 * bound of the path at the closed form's angle, with the rounding of the apex, a difference of two normals. */
#include "realism/metrics.h"

#include "scene/model/scene.h"
#include <math.h>

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

typedef struct search {
    trial *t;
    prism_faces at;
    status code;
    diagnostic *why;
} search;

/* Deviation of a ray that hits the middle of the left face at an angle of incidence; NaN unless it passes both faces.
 * */
static double deviation(void *context, double incidence)
{
    search *s = context;
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
static double least_deviation(search *s)
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

static double tolerance_of(search *look, double apex, double least)
{
    if (isnan(deviation(look, (apex + least) / 2.0)))
        return NAN;
    return bound_path(&look->t->tree, 0.0).heading + bound_difference(BOUND_FORM) * (M_PI + 1.0 / sin(apex));
}

static status at_line(const metrics *m, double lambda_nm, double *measured, double *theory, double *tolerance,
                      diagnostic *why)
{
    const prism_faces supposed = faces_of(m->supposed);
    const double apex = M_PI - acos(vec3_dot(supposed.left, supposed.right));
    *theory = theory_least_deviation(apex, relative_index(m->supposed, supposed.region, lambda_nm));
    trial t;
    search look = {.t = &t, .at = faces_of(m->traced), .why = why};
    look.code = trial_start(&t, arrange_at(m->traced, lambda_nm), m->level, why);
    *measured = look.code == STATUS_OK ? least_deviation(&look) : NAN;
    *tolerance = look.code == STATUS_OK ? tolerance_of(&look, apex, *theory) : NAN;
    trial_end(&t);
    return look.code;
}

status realism_prism(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"prism.F", "prism.d", "prism.C", "prism.own"};
    static const char *const what[] = {
        "minimum deviation at the F line, 486.1 nm", "minimum deviation at the d line, 587.6 nm",
        "minimum deviation at the C line, 656.3 nm", "minimum deviation at render.lambda_nm"};
    double off[3];
    const status code = metrics_at_lines(m, names, what, NULL, at_line, off, why);
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
    search look = {.t = &t, .at = faces_of(m->traced), .why = why};
    look.code = trial_start(&t, arrange_at(m->traced, lambda_nm), m->level, why);
    for (int i = 2; i < 360 && look.code == STATUS_OK; i++) {
        const double measured = deviation(&look, 0.25 * i * degree);
        if (!isnan(measured)) /* else total reflection at the second face */
            curve_add(out, 0.25 * i, measured / degree, theory_prism_deviation(0.25 * i * degree, apex, n) / degree);
    }
    trial_end(&t);
    return look.code;
}
