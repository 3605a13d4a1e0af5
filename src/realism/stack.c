/* A stack of parallel plates, solids named plate1 and plate2: equal boxes with equal rotation
 * (experiments/scenes/plates.yaml). The transmittance for the camera's central ray and white light: with polarisation s
 * and p light are transmitted separately, without it every interface uses the mean of both, as most renderers do.
 *
 * Tolerance: the bound of the reflectance at that angle times the derivative by it, and the rounding of the products.
 * What the depth limit cuts off is no part of it: the closed form counts the paths of up to that depth. */
#include "realism/metrics.h"

#include "realism/setup.h"
#include "realism/theory.h"
#include "scene/model/scene.h"
#include <math.h>

enum { INTERFACES = 4, STACK_DEPTH = 16 };

bool stack_is_there(const scene *s)
{
    return scene_find_solid(s, "plate1") >= 0 && scene_find_solid(s, "plate2") >= 0;
}

typedef struct stack {
    double angle, n;
    bool polarised;
} stack;

static bool stack_read(const scene *s, stack *out)
{
    const solid *plate = &s->solids[scene_find_solid(s, "plate1")];
    const vec3 normal = mat3_apply(rotation_from_deg(plate->shape.rotation_deg), vec3_make(0.0, 0.0, 1.0));
    *out = (stack){.angle = acos(fmin(fabs(normal.z), 1.0)),
                   .polarised = s->render.polarisation != 0,
                   .n = relative_index(s, scene_find_solid(s, "plate1"), s->render.lambda_nm)};
    return !isnan(out->n) && s->solids[scene_find_solid(s, "plate2")].surface.transparency == 1.0 &&
           plate->surface.transparency == 1.0;
}

static double through_to_depth(double R)
{
    return theory_pile(R, INTERFACES, STACK_DEPTH);
}

static double straight_through(double R)
{
    return pow(1.0 - R, INTERFACES);
}

static double of_both(const stack *s, double (*through)(double R))
{
    const double R_s = theory_fresnel_s(s->angle, 1.0, s->n), R_p = theory_fresnel_p(s->angle, 1.0, s->n);
    return s->polarised ? 0.5 * (through(R_s) + through(R_p)) : through(0.5 * (R_s + R_p));
}

/* By the derivative of the transmittance by R, for the R that are used. */
static double tolerance_of(const stack *s, double (*through)(double R), int interfaces)
{
    const share_bound off = bound_shares(s->angle, bound_difference(BOUND_TURN), 1.0, s->n);
    const double R_s = theory_fresnel_s(s->angle, 1.0, s->n), R_p = theory_fresnel_p(s->angle, 1.0, s->n), step = 1e-6,
                 R[] = {R_s, R_p, 0.5 * (R_s + R_p)}, of_R[] = {off.R_s, off.R_p, off.R};
    double most = 0.0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, of_R[i] * fabs(through(R[i] + step) - through(R[i] - step)) / (2.0 * step));
    return most + bound_difference(BOUND_FORM * interfaces);
}

/* Sums the radiance of rays that end in the sky or on a board in the direction of view, since parallel faces do not
 * change directions. */
static double add_up(const ray_tree *tree, vec3 forward)
{
    double through = 0.0;
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *n = &tree->node[i];
        if ((n->end == RAY_END_SKY || (n->end == RAY_END_HIT && n->hit.opaque)) &&
            vec3_dot(n->direction, forward) > 1.0 - 1e-9)
            through += n->throughput[0];
    }
    return through;
}

static status look_through(const metrics *m, double *straight, double *whole, diagnostic *why)
{
    trial t;
    scene *s = scene_clone(m->traced);
    if (s) {
        arrange_bare(s);
        s->render.depth = STACK_DEPTH;
        s->render.min_weight = 0.0;
    }
    status code = trial_start(&t, s, m->level, why);
    const vec3 eye = m->traced->camera.position, forward = vec3_make(0.0, 0.0, 1.0);
    THEN(code, probe_path(t.p, eye, forward, -1, &t.tree, why));
    if (code == STATUS_OK) {
        const ray_node *last = &t.tree.node[t.tree.count - 1];
        *straight = t.tree.count == INTERFACES + 1 && (last->end == RAY_END_SKY || last->hit.opaque)
                        ? last->throughput[0]
                        : NAN;
        code = probe_ray(t.p, eye, forward, &t.tree, why);
    }
    if (code == STATUS_OK)
        *whole = add_up(&t.tree, forward);
    trial_end(&t);
    return code;
}

static status opaque_plates(diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "make both plates transparent: transparency 1",
                    "the plates of the stack are not transparent");
}

status realism_stack(const metrics *m, diagnostic *why)
{
    stack supposed;
    if (!stack_read(m->supposed, &supposed))
        return opaque_plates(why);
    double straight, whole;
    TRY(look_through(m, &straight, &whole, why));
    metrics_add(m, (realism_value){"stack.straight", "transmittance of four interfaces without reflections", "",
                                   straight, of_both(&supposed, straight_through),
                                   tolerance_of(&supposed, straight_through, INTERFACES)});
    metrics_add(m, (realism_value){
                       "stack.whole", "transmittance with the reflections of paths with up to 16 interfaces", "", whole,
                       of_both(&supposed, through_to_depth), tolerance_of(&supposed, through_to_depth, STACK_DEPTH)});
    return STATUS_OK;
}

/* The plates are rotated about y; their distance in the scene must leave room for that. */
status stack_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    scene *turned = scene_clone(m->traced);
    status code = turned ? STATUS_OK : out_of_memory(why);
    const metrics at = {.traced = turned, .supposed = turned, .level = m->level};
    for (int i = 0; i <= 85 && code == STATUS_OK; i++) {
        static const char *const plates[] = {"plate1", "plate2"};
        stack supposed;
        double straight = NAN, whole;
        for (int k = 0; k < 2; k++)
            turned->solids[scene_find_solid(turned, plates[k])].shape.rotation_deg = vec3_make(0.0, i, 0.0);
        if (!stack_read(turned, &supposed))
            code = opaque_plates(why);
        THEN(code, look_through(&at, &straight, &whole, why));
        if (code == STATUS_OK)
            curve_add(out, i, straight, of_both(&supposed, straight_through));
    }
    scene_destroy(turned);
    return code;
}
