/* The straw in the glass: a thin rod leans through a wide flat surface, and its left edge has a kink in the image
 * there. The camera is above, at a short distance, so that every point below has its own angle: this tests more than
 * small angles. The kink is the angle between two secants of the edge, above and below. In a line of the image the edge
 * is the leftmost image of the rod's four long edges, which bound its visible part.
 *
 * Tolerance: the bound of the path's place on the rod, times the movement of the edge's image by a movement of the edge,
 * and the widths of the bisections; over a secant's length. */
#include "realism/metrics.h"
#include "realism/view.h"
#include "scene/model/scene.h"

#include <math.h>

#define LEAN_DEG 20.0
#define ROD_WIDTH 0.05
#define ROD_LENGTH 3.0

enum { LINES = 4 };
/* Distance in px from the centre of the image, where the rod enters the liquid. */
static const double line_at[LINES] = {-80.0, -30.0, 30.0, 80.0};

static scene *leaning_rod(const scene *s, const setup *at)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    solid *rod = &copy->solids[at->rod];
    rod->visible = 1;
    rod->priority = 2;
    rod->shape = box_at(vec3_make(0.0, 0.0, 0.0), vec3_make(ROD_WIDTH, ROD_LENGTH, ROD_WIDTH));
    rod->shape.rotation_deg.z = -LEAN_DEG;
    if (at->liquid >= 0) {
        solid *water = &copy->solids[at->liquid];
        water->visible = 1;
        water->priority = 1;
        water->shape = ground_at(0.0);
    }
    copy->camera =
        (struct camera){.position = {0.0, 3.0, -2.5}, .target = {0.0, 0.0, 0.0}, .aimed = 1, .fov_deg = 30.0};
    copy->render.width = 800;
    copy->render.height = 600;
    return copy;
}

typedef struct water {
    view eye;
    double n_above, n_below;
    double moved_x, moved_z; /* of the edges in the cross-section */
} water;

/* Projection of a point on a long edge of the rod; the edge is given by its position in the cross-section, the point by
 * its distance along the edge from the middle. */
static bool edge_image(const water *w, int edge, double along, double *px, double *py)
{
    const double lean = -LEAN_DEG * M_PI / 180.0;
    const double across = (edge & 1 ? 0.5 : -0.5) * ROD_WIDTH + w->moved_x,
                 z = (edge & 2 ? 0.5 : -0.5) * ROD_WIDTH + w->moved_z;
    const double x = across * cos(lean) - along * sin(lean), y = across * sin(lean) + along * cos(lean);
    if (y >= 0.0)
        return view_place(&w->eye, x, y, z, px, py);
    const double dx = x - w->eye.x, dz = z - w->eye.z, distance = hypot(dx, dz);
    const double tangent = theory_apparent_tangent(w->eye.y, -y, distance, w->n_above, w->n_below);
    return view_place(&w->eye, w->eye.x + tangent * dx / distance, w->eye.y - 1.0, w->eye.z + tangent * dz / distance,
                      px, py);
}

/* Where that edge crosses a line of the image; NaN if it does not. Its projection is monotonic from the top of the rod
 * to its bottom. */
static double crossing(const water *w, int edge, double line)
{
    double low = -ROD_LENGTH / 2.0, high = ROD_LENGTH / 2.0, px = NAN, py = NAN;
    if (!edge_image(w, edge, low, &px, &py) || py < line || !edge_image(w, edge, high, &px, &py) || py > line)
        return NAN;
    for (int i = 0; i < 200; i++) {
        const double middle = (low + high) / 2.0;
        if (middle <= low || middle >= high)
            break;
        edge_image(w, edge, middle, &px, &py);
        if (py > line)
            low = middle;
        else
            high = middle;
    }
    edge_image(w, edge, high, &px, &py);
    return px;
}

static double break_deg(const double x[LINES])
{
    const double above = atan((x[0] - x[1]) / (line_at[1] - line_at[0])),
                 below = atan((x[2] - x[3]) / (line_at[3] - line_at[2]));
    return (above - below) * 180.0 / M_PI;
}

static double leftmost(const water *w, double line)
{
    double px = INFINITY;
    for (int edge = 0; edge < 4; edge++) {
        const double at_line = crossing(w, edge, line);
        if (isnan(at_line))
            return NAN;
        px = fmin(px, at_line);
    }
    return px;
}

/* slope: movement of the edge's image, px, by a movement of the edge in any direction across it, scene units. */
static double theory_break(const scene *arranged, const setup *at, double slope[LINES])
{
    const double step = 1e-6;
    const water w = {.eye = view_of(arranged), .n_above = at->n[SETUP_OUTSIDE], .n_below = at->n[SETUP_LIQUID]};
    water aside = w, behind = w;
    double x[LINES];
    aside.moved_x = step, behind.moved_z = step;
    for (int i = 0; i < LINES; i++) {
        const double line = w.eye.height / 2.0 + line_at[i];
        x[i] = leftmost(&w, line);
        if (isnan(x[i]))
            return NAN;
        slope[i] = (fabs(leftmost(&aside, line) - x[i]) + fabs(leftmost(&behind, line) - x[i])) / step;
    }
    return break_deg(x);
}

static status measure_break(const metrics *m, scene *arranged, const double slope[LINES], double *degrees,
                            double *tolerance, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, arranged, m->level, why);
    double x[LINES] = {NAN, NAN, NAN, NAN}, off = 0.0;
    for (int i = 0; i < LINES && code == STATUS_OK; i++) {
        const double range[2] = {200.0, 600.0};
        double edge[2], across = NAN;
        code = trial_edges(&t, m->at.rod, false, 300.0 + line_at[i], range, 256, edge, why);
        THEN(code, trial_edge_bound(&t, m->at.rod, 300.0 + line_at[i], edge, 0, 0.0, &across, why));
        x[i] = edge[0];
        off += (across * slope[i] + 2.0 * bisect_width(x[i])) / (line_at[1] - line_at[0]);
    }
    *degrees = break_deg(x);
    *tolerance = (off + bound_difference(BOUND_FORM)) * 180.0 / M_PI;
    trial_end(&t);
    return code;
}

status realism_water_line(const metrics *m, diagnostic *why)
{
    const char *what = "apparent bend of the leaning rod's left edge at the liquid's surface, in the image";
    double measured = NAN, theory = NAN, tolerance = NAN, slope[LINES];
    status code = STATUS_OK;
    scene *supposed = leaning_rod(m->supposed, &m->theory_at);
    if (!supposed)
        return out_of_memory(why);
    if (m->theory_at.liquid < 0)
        what = "there is no liquid";
    else if (isnan(theory = theory_break(supposed, &m->theory_at, slope)))
        what = "the rod below the surface is not visible there";
    else
        code = measure_break(m, leaning_rod(m->traced, &m->at), slope, &measured, &tolerance, why);
    scene_destroy(supposed);
    metrics_add(m, (realism_value){"water_line.break", what, "deg", measured, theory, tolerance});
    return code;
}
