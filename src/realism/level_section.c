#include "realism/level_section.h"
#include "scene/model/scene.h"

#include <math.h>

const char *level_section_read(const scene *s, const setup *at, level_section *out)
{
    const solid_shape *rod = &s->solids[at->rod].shape;
    if (rod->rotation_deg.x != 0.0 || rod->rotation_deg.z != 0.0)
        return "the rod leans: this requires an upright one";
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

level_section level_section_bare(const level_section *c)
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

/* Distances of the ray inside from the rod's corners, with the sign of the side; false if it does not get inside. */
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

bool level_section_sees_rod(const level_section *c, double px, double py)
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

double level_section_slope(const level_section *c, double px, double py)
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

void level_section_range(const level_section *c, double px, double py, double range[2])
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

bool level_section_stays(const level_section *c, double px, double py, double low, double high)
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
