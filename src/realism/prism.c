/* A prism's least deviation at the F, d and C lines. The scene has solids named prism, and left and right, the
 * half-spaces that cut its two faces (experiments/scenes/prism.yaml).
 *
 * Least deviation is flat in the angle of incidence, so that its value is good to rounding however it is found. */
#include "realism/metrics.h"

#include "optics/media.h"
#include "scene/model/scene.h"
#include <math.h>

#define ANGLE_TOLERANCE 1e-12 /* rad */

/* point: on the left face; left, right: the prism's outward normals; up: along the left face, towards the apex. */
typedef struct prism_faces {
    vec3 point, left, right, up;
    int body;
} prism_faces;

bool prism_is_there(const scene *s)
{
    return scene_find_solid(s, "prism") >= 0 && scene_find_solid(s, "left") >= 0 && scene_find_solid(s, "right") >= 0;
}

/* A half-space's matter lies under its local y; what it cuts off the prism has that as its outward normal, turned
 * round. */
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
                     .body = scene_find_solid(s, "prism")};
    f.up = vec3_normalize(vec3_sub(f.right, vec3_scale(f.left, vec3_dot(f.left, f.right))));
    return f;
}

typedef struct search {
    trial *t;
    prism_faces at;
    status code;
    diagnostic *why;
} search;

/* Deviation of a ray that meets the middle of the left face at an angle of incidence; NaN if it does not come through
 * both. */
static double deviation(void *context, double incidence)
{
    search *s = context;
    const vec3 in = vec3_sub(vec3_scale(s->at.up, sin(incidence)), vec3_scale(s->at.left, cos(incidence)));
    if (s->code == STATUS_OK)
        s->code = probe_way(s->t->p, vec3_sub(s->at.point, vec3_scale(in, 3.0)), in, -1, &s->t->tree, s->why);
    if (s->code != STATUS_OK)
        return NAN;
    const ray_tree *way = &s->t->tree;
    if (way->count < 3 || way->node[2].kind != RAY_REFRACT || way->node[0].hit.to != s->at.body ||
        way->node[1].hit.from != s->at.body)
        return NAN;
    const vec3 out = way->node[2].direction;
    const vec3 across = vec3_cross(in, out);
    return atan2(vec3_length(across), vec3_dot(in, out));
}

/* Between the first and the last angle where a way leads through. */
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

static status at_line(const metrics *m, double lambda_nm, double *measured, double *theory, diagnostic *why)
{
    scene *s = scene_clone(m->traced);
    if (s) {
        s->render.lambda_nm = lambda_nm;
        s->render.depth = 8;
        s->render.min_weight = 0.0;
    }
    const prism_faces supposed = faces_of(m->supposed);
    const double apex = M_PI - acos(vec3_dot(supposed.left, supposed.right));
    *theory = theory_least_deviation(apex, relative_index(m->supposed, supposed.body, lambda_nm));
    trial t;
    search look = {.t = &t, .at = faces_of(m->traced), .why = why};
    look.code = trial_start(&t, s, m->level, why);
    *measured = look.code == STATUS_OK ? least_deviation(&look) : NAN;
    trial_end(&t);
    return look.code;
}

status realism_prism(const metrics *m, diagnostic *why)
{
    static const struct line {
        const char *metric, *what;
        double lambda_nm;
    } lines[] = {
        {"prism.F", "least deviation at the F line, 486.1 nm", LINE_HYDROGEN_F_NM},
        {"prism.d", "least deviation at the d line, 587.6 nm", LINE_HELIUM_D_NM},
        {"prism.C", "least deviation at the C line, 656.3 nm", LINE_HYDROGEN_C_NM},
        {"prism.own", "least deviation at render.lambda_nm", 0.0},
    };
    double measured[4], theory[4];
    status code = STATUS_OK;
    for (int i = 0; i < 4 && code == STATUS_OK; i++) {
        code = at_line(m, i < 3 ? lines[i].lambda_nm : m->traced->render.lambda_nm, &measured[i], &theory[i], why);
        metrics_add(m, (realism_value){lines[i].metric, lines[i].what, "rad", measured[i], theory[i], ANGLE_TOLERANCE});
    }
    if (code == STATUS_OK)
        metrics_add(m, (realism_value){"prism.F-C", "that at the F line less that at the C line", "rad",
                                       measured[0] - measured[2], theory[0] - theory[2], 2.0 * ANGLE_TOLERANCE});
    return code;
}
