/* Apparent places through the surface of a liquid: the straw in the glass, and the coin in the cup. */
#include "realism/metrics.h"

#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

/* --- the straw --- */

/* The straw in the glass: a thin rod leans through a wide flat surface, and its left edge has a kink in the image
 * there. The camera is above, at a short distance, so that every point below has its own angle: this tests more than
 * small angles. The kink is the angle between two secants of the edge, above and below. In a line of the image the edge
 * is the leftmost image of the rod's four long edges, which bound its visible part.
 *
 * Tolerance: the bound of the path's position on the rod times the movement of the edge in the image per movement of
 * the edge, plus the widths of the bisections, all over the length of a secant. */

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
    double moved_x, moved_z; /* shift of the edges in the cross-section */
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

/* The px at which an edge crosses a line of the image; NaN if it does not. The projection is monotonic from the top of
 * the rod to its bottom. */
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

/* slope: movement of the edge in the image, px, per scene unit by which the edge moves in the cross-section. */
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
        what = "the part of the rod below the surface is not visible in the measured lines of the image";
    else
        code = measure_break(m, leaning_rod(m->traced, &m->at), slope, &measured, &tolerance, why);
    scene_destroy(supposed);
    metrics_add(m, (realism_value){"water_line.break", what, "deg", measured, theory, tolerance});
    return code;
}

/* --- the coin --- */

/* A coin in a cup: solids named cup (opaque), coin (an upright cylinder on the cup's floor) and liquid
 * (experiments/scenes/coin.yaml). The eye is the camera's position; the cup's near rim hides the coin until the liquid
 * is deep enough. The least depth is found by bisection: does the ray from the eye that grazes the rim end on the
 * coin? */

/* The grazing ray passes this far above the rim, scene units. */
#define CLEARANCE 1e-12

typedef struct coin_view {
    int coin, liquid;
    vec3 eye, edge; /* the point of the rim's inner edge that is nearest to the eye */
    double floor;   /* height of the cup's floor */
    double tangent; /* of the line of sight over the edge, from the vertical */
    double drop;    /* depth of the coin's upper face below the rim */
    double across;  /* horizontal distance from the edge to that face's farthest point in the plane of sight */
    double n_around;
} coin_view;

static bool has_visible(const scene *s, const char *name, shape_kind kind)
{
    const int at = scene_find_solid(s, name);
    return at >= 0 && s->solids[at].visible && s->solids[at].shape.kind == kind;
}

bool coin_is_there(const scene *s)
{
    return has_visible(s, "cup", SHAPE_CUP) && has_visible(s, "coin", SHAPE_CYLINDER) &&
           scene_find_solid(s, "liquid") >= 0;
}

static bool is_upright_and_round(const solid *one)
{
    const vec3 r = one->shape.rotation_deg;
    return r.x == 0.0 && r.y == 0.0 && r.z == 0.0 && one->shape.m == 1.0;
}

/* The plane of sight is vertical, through the eye and the cup's axis. */
static status coin_read(const scene *s, coin_view *out, diagnostic *why)
{
    const solid *cup = &s->solids[scene_find_solid(s, "cup")], *coin = &s->solids[scene_find_solid(s, "coin")];
    *out = (coin_view){.coin = scene_find_solid(s, "coin"), .liquid = scene_find_solid(s, "liquid")};
    const solid *liquid = &s->solids[out->liquid];
    const vec3 base = cup->shape.position;
    const index_law around = surrounding_index_law(&s->background);
    const double away = hypot(s->camera.position.x - base.x, s->camera.position.z - base.z),
                 inner = cup->shape.inner_radius, rim = base.y + cup->shape.height;
    if (!is_upright_and_round(cup) || !is_upright_and_round(coin) || !is_upright_and_round(liquid) ||
        liquid->shape.kind != SHAPE_CYLINDER)
        return diagnose(why, STATUS_BAD_INPUT, "set their rotation to 0 and m to 1, and make the liquid a cylinder",
                        "'cup', 'coin' and 'liquid' are not upright and round");
    if (liquid->shape.capillary_length > 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set its capillary_length to 0",
                        "'liquid' has a meniscus; the curve requires a level surface");
    if (cup->surface.transparency != 0.0 || coin->surface.transparency != 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set the transparency of both to 0", "'cup' or 'coin' is not opaque");
    if (away <= inner || s->camera.position.y <= rim)
        return diagnose(why, STATUS_BAD_INPUT, "move the camera up, and away from the cup's axis",
                        "the eye does not look over the rim of 'cup' from outside");
    const vec3 ahead = vec3_make((base.x - s->camera.position.x) / away, 0.0, (base.z - s->camera.position.z) / away);
    const vec3 off = vec3_sub(coin->shape.position, base);
    const double along = vec3_dot(off, ahead), sideways = off.x * ahead.z - off.z * ahead.x;
    out->eye = s->camera.position;
    out->edge = vec3_make(base.x - inner * ahead.x, rim, base.z - inner * ahead.z);
    out->floor = base.y + cup->shape.floor;
    out->tangent = (away - inner) / (s->camera.position.y - rim);
    out->drop = rim - coin->shape.position.y - coin->shape.height;
    out->across = inner + along + sqrt(coin->shape.radius * coin->shape.radius - sideways * sideways);
    out->n_around = index_law_at(&around, s->render.lambda_nm);
    return isnan(out->across) ? diagnose(why, STATUS_BAD_INPUT, "move it towards the cup's axis",
                                         "'coin' is not in the plane of the eye and the cup's axis")
                              : STATUS_OK;
}

typedef struct filling {
    const metrics *m;
    const coin_view *at;
    scene *bare; /* only the cup, the coin and the liquid */
    status code;
    diagnostic *why;
} filling;

/* Whether the grazing ray meets the coin when the liquid's surface is at that height. */
static bool coin_is_seen(void *context, double surface)
{
    filling *f = context;
    trial t = {0};
    scene *filled = scene_clone(f->bare);
    bool seen = false;
    if (filled) {
        solid_shape *liquid = &filled->solids[f->at->liquid].shape;
        liquid->height = surface - liquid->position.y;
    }
    if (f->code == STATUS_OK)
        f->code = trial_start(&t, filled, f->m->level, f->why);
    if (f->code == STATUS_OK) {
        const vec3 clear = vec3_add(f->at->edge, vec3_make(0.0, CLEARANCE, 0.0));
        seen = trial_meets(&t, f->at->eye, vec3_sub(clear, f->at->eye), f->at->coin, false, &f->code, f->why);
    }
    trial_end(&t);
    return seen;
}

static scene *cup_scene(const scene *s, const coin_view *at)
{
    scene *bare = arrange_empty(s);
    if (bare) {
        material *liquid = &bare->solids[at->liquid].surface;
        bare->solids[at->liquid].visible = bare->solids[at->coin].visible = 1;
        bare->solids[scene_find_solid(bare, "cup")].visible = 1;
        liquid->medium = MEDIUM_IOR;
        liquid->transparency = 1.0;
    }
    return bare;
}

/* Adds the least depth at which the coin appears, by the liquid's index; indices at which the cup would overflow first
 * are omitted. */
status coin_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    coin_view at;
    TRY(coin_read(m->traced, &at, why));
    filling f = {m, &at, cup_scene(m->traced, &at), STATUS_OK, why};
    f.code = f.bare ? STATUS_OK : out_of_memory(why);
    for (int i = 10; i <= 80 && f.code == STATUS_OK; i++) {
        const double n = at.n_around * (1.0 + 0.01 * i), coin_top = at.edge.y - at.drop,
                     least = theory_least_depth(at.drop, at.across, at.tangent, n / at.n_around);
        if (!(least > 0.0 && least < at.drop))
            continue;
        f.bare->solids[at.liquid].surface.ior = n;
        const double surface = bisect(coin_is_seen, &f, coin_top, at.edge.y, false);
        curve_add(out, n, surface - at.floor, least + coin_top - at.floor);
    }
    scene_destroy(f.bare);
    return f.code;
}
