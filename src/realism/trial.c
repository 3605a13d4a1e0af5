/* Code that all metrics use: a scene with a probe for it, edges by bisection, the pair with the largest error, and the
 * report. */
#include "realism/metrics.h"

#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

void metrics_add(const metrics *m, realism_value value)
{
    if (m->report->count < REALISM_MAX)
        m->report->value[m->report->count++] = value;
}

void curve_add(realism_points *out, double x, double measured, double theory)
{
    if (out->count < REALISM_POINTS_MAX)
        out->at[out->count++] = (realism_point){x, measured, theory};
}

void worst_pair_add(worst_pair *w, double measured, double theory, double tolerance)
{
    /* A NaN counts as the worst measurement, whatever follows; if theory is NaN, there is nothing to compare. */
    if (isnan(theory) || (w->any && isnan(w->measured)))
        return;
    if (!w->any || !(fabs(measured - theory) * w->tolerance <= fabs(w->measured - w->theory) * tolerance))
        *w = (worst_pair){measured, theory, tolerance, true};
}

status trial_start(trial *t, scene *owned, isa level, diagnostic *why)
{
    *t = (trial){.s = owned};
    if (!owned)
        return out_of_memory(why);
    return probe_create(owned, level, &t->p, why);
}

void trial_end(trial *t)
{
    ray_tree_release(&t->tree);
    probe_destroy(t->p);
    scene_destroy(t->s);
    *t = (trial){0};
}

bool trial_meets(trial *t, vec3 origin, vec3 direction, int which, bool upright, status *code, diagnostic *why)
{
    if (*code == STATUS_OK)
        *code = probe_path(t->p, origin, direction, -1, &t->tree, why);
    if (*code != STATUS_OK)
        return false;
    for (size_t i = 0; i < t->tree.count; i++) {
        const ray_node *n = &t->tree.node[i];
        if (n->kind == RAY_REFLECT || n->end != RAY_END_HIT || (upright && fabs(n->hit.normal.y) > 0.5))
            return false;
        if (n->hit.opaque)
            return n->hit.solid == which;
    }
    return false;
}

#define BISECT_WIDTH 1e-12

double bisect_width(double at)
{
    return 0.5 * BISECT_WIDTH + bound_gamma(2) * fabs(at);
}

double bisect(seen_at *seen, void *context, double from, double to, bool before)
{
    while (to - from > BISECT_WIDTH) {
        const double middle = from + (to - from) / 2.0;
        if (middle <= from || middle >= to)
            break;
        if (seen(context, middle) == before)
            from = middle;
        else
            to = middle;
    }
    return from + (to - from) / 2.0;
}

double relative_index(const scene *s, int at, double lambda_nm)
{
    index_law law;
    const index_law around = surrounding_index_law(&s->background);
    if (material_index_law(&s->solids[at].surface, s->solids[at].name, &law, NULL) != STATUS_OK)
        return NAN;
    return index_law_at(&law, lambda_nm) / index_law_at(&around, lambda_nm);
}

double least_value(double (*f)(void *context, double x), void *context, double low, double high)
{
    enum { STEPS = 80 }; /* the 80th power of the golden ratio's inverse is 2e-17 */
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = f(context, a), at_b = f(context, b);
    for (int i = 0; i < STEPS; i++) {
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - golden * (high - low), at_a = f(context, a);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + golden * (high - low), at_b = f(context, b);
        }
    }
    return fmin(at_a, at_b);
}

bool find_edges(seen_at *seen, void *context, double from, double to, int steps, double edge[2])
{
    const double step = (to - from) / steps;
    int first = -1, last = -1;
    for (int i = 0; i <= steps; i++)
        if (seen(context, from + i * step)) {
            first = first < 0 ? i : first;
            last = i;
        }
    if (first < 1 || last >= steps) /* not found, or not both edges */
        return false;
    edge[0] = bisect(seen, context, from + (first - 1) * step, from + first * step, false);
    edge[1] = bisect(seen, context, from + last * step, from + (last + 1) * step, true);
    return true;
}

typedef struct image_line {
    trial *t;
    int which;
    bool upright;
    double py;
    status code;
    diagnostic *why;
} image_line;

static bool traced_sees(void *context, double x)
{
    image_line *l = context;
    return trial_meets(l->t, l->t->s->camera.position, probe_camera_direction(l->t->p, x, l->py), l->which, l->upright,
                       &l->code, l->why);
}

status trial_edges(trial *t, int which, bool upright, double py, const double range[2], int steps, double edge[2],
                   diagnostic *why)
{
    image_line l = {t, which, upright, py, STATUS_OK, why};
    if (!find_edges(traced_sees, &l, range[0], range[1], steps, edge))
        edge[0] = edge[1] = NAN;
    return l.code;
}

status trial_edge_bound(trial *t, int which, double py, const double edge[2], int side, double curvature,
                        double *across, diagnostic *why)
{
    *across = NAN;
    if (isnan(edge[0]))
        return STATUS_OK;
    status code = STATUS_OK;
    const double px = edge[side] + (side ? -EDGE_INSIDE_PX : EDGE_INSIDE_PX);
    if (trial_meets(t, t->s->camera.position, probe_camera_direction(t->p, px, py), which, false, &code, why))
        *across = bound_path(&t->tree, curvature).across;
    return code;
}

status metrics_at_lines(const metrics *m, const char *const names[4], const char *const what[4], const char *none,
                        at_line_call *at_line, double difference[3], diagnostic *why)
{
    const double lambda_nm[] = {LINE_HYDROGEN_F_NM, LINE_HELIUM_D_NM, LINE_HYDROGEN_C_NM, m->traced->render.lambda_nm};
    double measured[4], theory[4], tolerance[4];
    status code = STATUS_OK;
    for (int i = 0; i < 4 && code == STATUS_OK; i++) {
        code = at_line(m, lambda_nm[i], &measured[i], &theory[i], &tolerance[i], why);
        metrics_add(m, (realism_value){names[i], none && isnan(theory[i]) ? none : what[i], "rad", measured[i],
                                       theory[i], tolerance[i]});
    }
    if (code == STATUS_OK) {
        difference[0] = measured[0] - measured[2];
        difference[1] = theory[0] - theory[2];
        difference[2] = tolerance[0] + tolerance[2];
    }
    return code;
}

scene *arrange_at(const scene *s, double lambda_nm)
{
    scene *copy = scene_clone(s);
    if (copy) {
        copy->render.lambda_nm = lambda_nm;
        copy->render.depth = 8;
        copy->render.min_weight = 0.0;
    }
    return copy;
}
