/* The rod in the image: the position of its edges, their displacement by the filled vessel, and the magnification.
 *
 * Tolerance: the bound of the path's distance from the rod's corner, over the change of that distance per px, plus the
 * widths of the bisections, in the tracer's image and in theory. */
#include "realism/metrics.h"

#include "scene/model/scene.h"
#include <math.h>

/* --- theory: the rod seen from above --- */

/* Theory of the rod in the image: whether the camera ray through a point of the image hits the rod behind the wall of a
 * filled vessel. Vertical surfaces preserve n d_y of a ray, d_y the vertical component of its unit direction. Seen from
 * above, a ray therefore refracts at the circles like a ray in the plane with the indices sqrt(n^2 - (n d_y)^2):
 * Snell's law without the component along y. Exact. Pure; scalars only. */
typedef struct level_section {
    view eye;
    theory_shells shells;
    double x, z;                     /* of the axis */
    double corner_x[4], corner_z[4]; /* of the rod, relative to the axis */
} level_section;

/* NULL, or the reason why theory does not apply to this scene. */
static const char *level_section_read(const scene *s, const setup *at, level_section *out)
{
    const solid_shape *rod = &s->solids[at->rod].shape;
    if (rod->rotation_deg.x != 0.0 || rod->rotation_deg.z != 0.0)
        return "the rod leans; this metric requires an upright rod";
    *out = (level_section){.eye = view_of(s), .shells = setup_shells(at), .x = at->x, .z = at->z};
    out->eye.roll = 0.0; /* as in arrange_empty */
    const double turn = rod->rotation_deg.y * M_PI / 180.0;
    for (int i = 0; i < 4; i++) {
        const double x = (i & 1 ? 0.5 : -0.5) * rod->size.x, z = (i & 2 ? 0.5 : -0.5) * rod->size.z;
        out->corner_x[i] = rod->position.x - at->x + x * cos(turn) + z * sin(turn);
        out->corner_z[i] = rod->position.z - at->z - x * sin(turn) + z * cos(turn);
        if (hypot(out->corner_x[i], out->corner_z[i]) >= at->inner)
            return "the rod reaches into the vessel's wall";
    }
    if (hypot(out->eye.x - at->x, out->eye.z - at->z) <= at->outer)
        return "the camera is within the vessel's circle";
    return NULL;
}

/* The same section without vessel and liquid. */
static level_section level_section_bare(const level_section *c)
{
    level_section bare = *c;
    bare.shells.n_wall = bare.shells.n_core = bare.shells.n_around;
    return bare;
}

/* A ray seen from above: its offset from the axis, its heading, and the effective indices of the shells. */
typedef struct flat_ray {
    double heading, offset, steepness;
    theory_shells shells;
} flat_ray;

static double flat_index(double n, double steepness)
{
    return sqrt(n * n - steepness * steepness);
}

static flat_ray flatten(const level_section *c, double px, double py)
{
    const sight d = view_through(&c->eye, px, py);
    flat_ray r = {.heading = atan2(d.z, d.x), .steepness = c->shells.n_around * d.y, .shells = c->shells};
    r.offset = (c->eye.z - c->z) * cos(r.heading) - (c->eye.x - c->x) * sin(r.heading);
    r.shells.n_around = flat_index(c->shells.n_around, r.steepness);
    r.shells.n_wall = flat_index(c->shells.n_wall, r.steepness);
    r.shells.n_core = flat_index(c->shells.n_core, r.steepness);
    return r;
}

/* Signed distances of the rod's corners from the ray inside the vessel; false if the ray does not reach the inside. */
static bool sides_of(const level_section *c, double px, double py, double side[4])
{
    const flat_ray r = flatten(c, px, py);
    if (!(fabs(r.offset) < theory_shells_reach(&r.shells)))
        return false;
    /* A ray with an offset to the left has the axis on its right, and turns towards it: the heading decreases. */
    const double heading = r.heading - theory_shells_turn(&r.shells, r.offset);
    const double offset = r.offset * r.shells.n_around / r.shells.n_core;
    for (int i = 0; i < 4; i++)
        side[i] = c->corner_z[i] * cos(heading) - c->corner_x[i] * sin(heading) - offset;
    return true;
}

static bool level_section_sees_rod(const level_section *c, double px, double py)
{
    double side[4], least = INFINITY, most = -INFINITY;
    if (!sides_of(c, px, py, side))
        return false;
    for (int i = 0; i < 4; i++) {
        least = fmin(least, side[i]);
        most = fmax(most, side[i]);
    }
    return least <= 0.0 && most >= 0.0; /* corners on both sides */
}

/* The change of the ray's distance from the rod's corner, scene units per px, at an edge seen at px. */
static double level_section_slope(const level_section *c, double px, double py)
{
    const double step = 1e-4;
    double before[4], at[4], after[4];
    if (!sides_of(c, px - step, py, before) || !sides_of(c, px, py, at) || !sides_of(c, px + step, py, after))
        return NAN;
    int nearest = 0;
    for (int i = 1; i < 4; i++)
        nearest = fabs(at[i]) < fabs(at[nearest]) ? i : nearest;
    return fabs(after[nearest] - before[nearest]) / (2.0 * step);
}

/* The horizontal bounds of the vessel in image line py, around the axis at px. */
static void level_section_range(const level_section *c, double px, double py, double range[2])
{
    for (int i = 0; i < 2; i++) {
        double inside = px, outside = px + (i ? 8.0 : -8.0) * c->eye.focal_px;
        for (int k = 0; k < 100; k++) {
            const double middle = (inside + outside) / 2.0;
            if (fabs(flatten(c, middle, py).offset) < c->shells.outer)
                inside = middle;
            else
                outside = middle;
        }
        range[i] = inside;
    }
}

/* Whether the ray stays between the two heights up to the rod's far side. */
static bool level_section_stays(const level_section *c, double px, double py, double low, double high)
{
    const flat_ray r = flatten(c, px, py);
    const theory_shells *n = &r.shells;
    const double b[3] = {r.offset, r.offset * n->n_around / n->n_wall, r.offset * n->n_around / n->n_core};
    const double distance = hypot(c->eye.x - c->x, c->eye.z - c->z);
    const double run[3] = {sqrt(distance * distance - b[0] * b[0]) - sqrt(n->outer * n->outer - b[0] * b[0]),
                           sqrt(n->outer * n->outer - b[1] * b[1]) - sqrt(n->inner * n->inner - b[1] * b[1]),
                           sqrt(n->inner * n->inner - b[2] * b[2]) + hypot(c->corner_x[0], c->corner_z[0])};
    const double index[3] = {n->n_around, n->n_wall, n->n_core};
    double y = c->eye.y;
    for (int i = 0; i < 3; i++) {
        y += run[i] * r.steepness / index[i];
        if (!(y > low && y < high))
            return false;
    }
    return true;
}

/* --- edges in the image --- */

enum { SCAN_STEPS = 1024 };

/* Edges measured with the tracer, and the bounds of their paths' distances from the rod. */
typedef struct traced_line {
    double edge[2], across[2];
} traced_line;

/* Finds the rod's edges in a scene, which is freed; NaN if there are none. */
static status traced_edges(scene *s, const metrics *m, const double range[2], double py, traced_line *out,
                           diagnostic *why)
{
    trial t;
    status code = trial_start(&t, s, m->level, why);
    *out = (traced_line){{NAN, NAN}, {NAN, NAN}};
    THEN(code, trial_edges(&t, m->at.rod, true, py, range, SCAN_STEPS, out->edge, why));
    for (int i = 0; i < 2 && code == STATUS_OK; i++)
        code = trial_edge_bound(&t, m->at.rod, py, out->edge, i, 1.0 / m->at.inner, &out->across[i], why);
    trial_end(&t);
    return code;
}

typedef struct theory_line {
    const level_section *c;
    double py;
} theory_line;

static bool theory_sees(void *context, double x)
{
    const theory_line *l = context;
    return level_section_sees_rod(l->c, x, l->py);
}

/* The image line through the axis at half height of the filled part of the rod, and theory for that line. */
typedef struct image_line {
    double py, range[2], filled[2], bare[2];
    double filled_slope[2], bare_slope[2];
} image_line;

static const char *theory_edges(const scene *s, const setup *at, image_line *out)
{
    level_section c;
    const char *none = level_section_read(s, at, &c);
    if (none)
        return none;
    const solid_shape *rod = &s->solids[at->rod].shape;
    const double low = fmax(at->low, rod->position.y - rod->size.y / 2.0),
                 high = fmin(at->high, rod->position.y + rod->size.y / 2.0);
    double px;
    if (!view_place(&c.eye, at->x, (low + high) / 2.0, at->z, &px, &out->py))
        return "the vessel is behind the camera";
    level_section_range(&c, px, out->py, out->range);
    const level_section bare = level_section_bare(&c);
    theory_line filled_line = {&c, out->py}, bare_line = {&bare, out->py};
    if (!find_edges(theory_sees, &filled_line, out->range[0], out->range[1], SCAN_STEPS, out->filled) ||
        !find_edges(theory_sees, &bare_line, out->range[0], out->range[1], SCAN_STEPS, out->bare))
        return "the edges of the rod are not visible through the vessel";
    for (int i = 0; i < 2; i++)
        if (!level_section_stays(&c, out->filled[i], out->py, low, high))
            return "the view is too steep: no ray through the filled wall hits the rod below the surface";
    for (int i = 0; i < 2; i++) {
        out->filled_slope[i] = level_section_slope(&c, out->filled[i], out->py);
        out->bare_slope[i] = level_section_slope(&bare, out->bare[i], out->py);
    }
    return NULL;
}

static status measure_edges(const metrics *m, const image_line *line, traced_line *filled, traced_line *bare,
                            diagnostic *why)
{
    scene *vessel = arrange_vessel(m->traced, &m->at), *rod_only = arrange_empty(m->traced);
    if (vessel)
        vessel->solids[m->at.rod].visible = 1;
    if (rod_only)
        rod_only->solids[m->at.rod].visible = 1;
    status code = traced_edges(vessel, m, line->range, line->py, filled, why);
    const status second = traced_edges(rod_only, m, line->range, line->py, bare, code == STATUS_OK ? why : NULL);
    return code == STATUS_OK ? second : code;
}

status edges_displacement(const metrics *m, double measured[2], double theory[2], diagnostic *why)
{
    image_line l;
    traced_line filled, bare;
    for (int i = 0; i < 2; i++)
        measured[i] = theory[i] = NAN;
    if (theory_edges(m->supposed, &m->theory_at, &l))
        return STATUS_OK;
    const status code = measure_edges(m, &l, &filled, &bare, why);
    for (int i = 0; i < 2; i++) {
        measured[i] = filled.edge[i] - bare.edge[i];
        theory[i] = l.filled[i] - l.bare[i];
    }
    return code;
}

static double edge_tolerance(double px, double across, double slope)
{
    return 2.0 * bisect_width(px) + across / slope;
}

static status add_edges(const metrics *m, diagnostic *why)
{
    image_line l = {.filled = {NAN, NAN}, .bare = {NAN, NAN}};
    traced_line in = {{NAN, NAN}, {NAN, NAN}}, out = in;
    const char *const none = theory_edges(m->supposed, &m->theory_at, &l);
    const status code = none ? STATUS_OK : measure_edges(m, &l, &in, &out, why);
    const double nan_if_undefined = none ? NAN : 0.0; /* makes theory undefined */
    const double *const filled = in.edge, *const bare = out.edge;
    double off[2], shift[2];
    for (int i = 0; i < 2; i++) {
        off[i] = edge_tolerance(l.filled[i], in.across[i], l.filled_slope[i]);
        shift[i] = off[i] + edge_tolerance(l.bare[i], out.across[i], l.bare_slope[i]);
    }
    const double width = l.bare[1] - l.bare[0], ratio = (l.filled[1] - l.filled[0]) / width,
                 off_ratio = (off[0] + off[1] + ratio * (shift[0] - off[0] + shift[1] - off[1])) / width;
    metrics_add(m, (realism_value){"edges.left",
                                   none ? none : "left edge of the rod in the image, seen through the filled vessel",
                                   "px", filled[0], l.filled[0] + nan_if_undefined, off[0]});
    metrics_add(m, (realism_value){"edges.right",
                                   none ? none : "right edge of the rod in the image, seen through the filled vessel",
                                   "px", filled[1], l.filled[1] + nan_if_undefined, off[1]});
    metrics_add(m, (realism_value){"edges.left_shift",
                                   none ? none : "shift of the left edge caused by the vessel and the liquid", "px",
                                   filled[0] - bare[0], l.filled[0] - l.bare[0] + nan_if_undefined, shift[0]});
    metrics_add(m, (realism_value){"edges.right_shift",
                                   none ? none : "shift of the right edge caused by the vessel and the liquid", "px",
                                   filled[1] - bare[1], l.filled[1] - l.bare[1] + nan_if_undefined, shift[1]});
    metrics_add(
        m, (realism_value){"edges.magnification",
                           none ? none : "ratio of the rod's width in the image with and without vessel and liquid", "",
                           (filled[1] - filled[0]) / (bare[1] - bare[0]), ratio + nan_if_undefined, off_ratio});
    return code;
}

/* A thin round rod on the axis, seen along a horizontal line: inside, the tangent ray passes the axis at the rod's
 * radius; its offset outside is n_liquid / n_outside times as large. */
static scene *round_rod(const metrics *m, double radius, double distance)
{
    scene *s = arrange_vessel(m->traced, &m->at);
    if (!s)
        return NULL;
    const double height = m->at.high - m->at.low, middle = (m->at.low + m->at.high) / 2.0;
    solid *rod = &s->solids[m->at.rod];
    rod->visible = 1;
    rod->shape = cylinder_at(vec3_make(m->at.x, m->at.low + height / 4.0, m->at.z), radius, height / 2.0);
    s->camera = (struct camera){.position = {m->at.x, middle, m->at.z - distance}, .fov_deg = 45.0};
    return s;
}

/* The tolerance of the magnification. The sign of a discriminant, r^2 - d^2, decides whether a ray at the rim meets the
 * cylinder; it has the errors of distances up to the wall's. per_px: scene units per px in the plane of the axis. */
static double round_tolerance(const traced_line *l, double theory, double radius, double per_px)
{
    double sum = bound_difference(BOUND_FORM) * theory;
    for (int i = 0; i < 2; i++) {
        const double rim = bound_difference(BOUND_HIT) / (2.0 * radius);
        sum += (theory * (l->across[i] + rim) + per_px * bisect_width(l->edge[i])) / (2.0 * radius);
    }
    return sum;
}

static status add_round(const metrics *m, diagnostic *why)
{
    const double radius = 0.05 * m->at.inner, distance = 6.0 * m->at.outer;
    const theory_shells c = setup_shells(&m->theory_at);
    double theory = c.n_core / c.n_around, edge[2] = {NAN, NAN}, tolerance = NAN;
    const bool visible = radius * theory < 0.9 * theory_shells_reach(&c);
    status code = STATUS_OK;
    scene *s = round_rod(m, radius, distance);
    if (s && visible) {
        const view eye = view_of(s);
        const double wide = eye.focal_px * tan(asin(m->at.outer / distance));
        const double range[2] = {eye.width / 2.0 - wide, eye.width / 2.0 + wide};
        traced_line seen;
        code = traced_edges(s, m, range, eye.height / 2.0, &seen, why);
        tolerance = round_tolerance(&seen, theory, radius, distance / eye.focal_px);
        for (int i = 0; i < 2; i++)
            edge[i] = distance * sin(atan((seen.edge[i] - eye.width / 2.0) / eye.focal_px));
    } else {
        code = s ? STATUS_OK : out_of_memory(why);
        scene_destroy(s);
        theory = NAN;
    }
    metrics_add(m, (realism_value){
                       "edges.round_magnification",
                       visible ? "magnification of a thin round rod on the axis; theory: the liquid's refractive index"
                               : "the wall hides the rod's edges",
                       "", (edge[1] - edge[0]) / (2.0 * radius), theory, tolerance});
    return code;
}

status realism_edges(const metrics *m, diagnostic *why)
{
    TRY(add_edges(m, why));
    return add_round(m, why);
}
