/* The beam of a field: rays aimed at points of the stop or at directions, and their optical path differences. */
#include "lens/lens_private.h"

#include <math.h>

#define AIMED 1e-12  /* of the stop's radius */
#define WITHIN 1e-11 /* by which the pupil is smaller than the stop, whose edge takes rays by rounding */
enum { AIM_STEPS = 40, AIM_DEG = 4, INWARDS = 6 };

/* The unit vector of a far field: slopes tan x, tan y, as design programs have it; from 89 degrees on, the angle from
 * the axis in the direction (x, y). */
static vec3 field_direction(double x_deg, double y_deg)
{
    const double degree = M_PI / 180.0, off = hypot(x_deg, y_deg);
    if (fabs(x_deg) < 89.0 && fabs(y_deg) < 89.0) {
        const vec3 v = vec3_make(tan(x_deg * degree), tan(y_deg * degree), 1.0);
        return vec3_scale(v, 1.0 / vec3_length(v));
    }
    const double s = sin(off * degree) / off;
    return vec3_make(x_deg * s, y_deg * s, cos(off * degree));
}

/* Axes at right angles to a direction d, turned with it from the lens's own by the least rotation. */
static void set_axes(vec3 d, vec3 *across, vec3 *up)
{
    const double f = 1.0 / (1.0 + d.z);
    *across = vec3_make(1.0 - d.x * d.x * f, -d.x * d.y * f, -d.x);
    *up = vec3_make(-d.x * d.y * f, 1.0 - d.y * d.y * f, -d.y);
}

static void beam_set(const lens_prescription *p, const lens_first *first, double x, double y, lens_beam *out)
{
    const lens_model *m = out->b->m;
    const double far = m->object_distance, zE = first->z_entrance;
    out->far = isinf(far);
    if (out->far) {
        out->along = field_direction(x, y);
        set_axes(out->along, &out->across, &out->up);
        return;
    }
    double height = m->unit_mm;
    if (p->field_kind == LENS_FIELD_ANGLE) {
        const vec3 d = field_direction(x, y);
        out->object = vec3_make(-d.x / d.z * (far + zE), -d.y / d.z * (far + zE), -far);
    } else {
        out->object = vec3_make(x * height, y * height, -far);
    }
    out->across = vec3_make(1.0, 0.0, 0.0), out->up = vec3_make(0.0, 1.0, 0.0);
}

static void launch_ray(const lens_beam *bundle, const double launch[2], vec3 *from, vec3 *along, double *before)
{
    const vec3 at = vec3_add(vec3_scale(bundle->across, launch[0]), vec3_scale(bundle->up, launch[1]));
    *before = 0.0;
    if (bundle->far) {
        *along = bundle->along;
        *from = vec3_sub(at, vec3_scale(bundle->along, bundle->back));
        return;
    }
    const vec3 way = vec3_sub(at, bundle->object);
    const double length = vec3_length(way);
    *along = vec3_scale(way, 1.0 / length);
    *from = bundle->object;
    if (length > 2.0 * bundle->back) { /* objects far beyond the scene: the way there is added */
        *from = vec3_sub(at, vec3_scale(*along, bundle->back));
        *before = bundle->b->m->n_object * (length - bundle->back);
    }
}

static status launched(lens_beam *bundle, const double launch[2], lens_ray *out, diagnostic *why)
{
    vec3 from, along;
    double before;
    launch_ray(bundle, launch, &from, &along, &before);
    TRY(lens_ray_trace(bundle->b, from, along, out, why));
    out->path += before;
    return STATUS_OK;
}

/* What is aimed at: a point of the stop, mm, or cosines of direction at the image. False: the ray does not arrive. */
static bool reached(const lens_beam *bundle, bool cosines, const lens_ray *r, double at[2])
{
    at[0] = cosines ? r->direction.x * bundle->t[0] + r->direction.y * bundle->t[1] : r->stop_x;
    at[1] = cosines ? r->direction.y * bundle->t[0] - r->direction.x * bundle->t[1] : r->stop_y;
    return cosines ? r->loss == LENS_PASSES : r->loss != LENS_LOST_EARLY;
}

typedef struct aim_step {
    double launch[2], off[2];
    bool any;
} aim_step;

/* Improves the derivatives by the last step (Broyden's method, 1965) and takes Newton's step. False: as near as doubles
 * come. */
static bool aim_next(aim_step *last, const double off[2], double per[4], double launch[2])
{
    const double dx = launch[0] - last->launch[0], dy = launch[1] - last->launch[1], length2 = dx * dx + dy * dy;
    for (int k = 0; k < 2 && last->any && length2 > 0.0; k++) {
        const double e = off[k] - last->off[k] - per[2 * k] * dx - per[2 * k + 1] * dy;
        per[2 * k] += e * dx / length2, per[2 * k + 1] += e * dy / length2;
    }
    const double det = per[0] * per[3] - per[1] * per[2];
    *last = (aim_step){{launch[0], launch[1]}, {off[0], off[1]}, true};
    launch[0] -= (per[3] * off[0] - per[1] * off[1]) / det;
    launch[1] -= (per[0] * off[1] - per[2] * off[0]) / det;
    return hypot(launch[0] - last->launch[0], launch[1] - last->launch[1]) >
           1e-15 * (1.0 + hypot(launch[0], launch[1]));
}

/* A step to a ray that does not get there is halved; a first guess beyond a rim is drawn towards the chief ray. */
static status aim(lens_beam *bundle, bool cosines, const double target[2], double tolerance, double launch[2],
                  double per[4], lens_ray *out, diagnostic *why)
{
    aim_step last = {.any = false};
    double off[2];
    for (int i = 0; i < AIM_STEPS; i++) {
        TRY(launched(bundle, launch, out, why));
        const bool arrives = reached(bundle, cosines, out, off);
        if (!arrives && !last.any) {
            if (cosines || i >= INWARDS)
                return STATUS_OK;
            for (int k = 0; k < 2; k++)
                launch[k] = bundle->launch[k] + 0.95 * (launch[k] - bundle->launch[k]);
            continue;
        }
        if (!arrives) {
            launch[0] = 0.5 * (launch[0] + last.launch[0]), launch[1] = 0.5 * (launch[1] + last.launch[1]);
            continue;
        }
        off[0] -= target[0], off[1] -= target[1];
        if (hypot(off[0], off[1]) <= tolerance)
            return STATUS_OK;
        if (!aim_next(&last, off, per, launch))
            break;
    }
    if (reached(bundle, cosines, out, off) && hypot(off[0] - target[0], off[1] - target[1]) > 1e3 * tolerance)
        out->loss = LENS_LOST_EARLY;
    return STATUS_OK;
}

/* The derivatives by differences from a ray that arrives: the chief ray, or one past an obstruction. */
static status aim_differences(lens_beam *bundle, const double from[2], const lens_ray *base, diagnostic *why)
{
    const double step = 1e-4 * bundle->stop_radius / hypot(bundle->per[0], bundle->per[2]);
    double at[2][2], to[2][2], stop[4], cosines[4];
    for (int k = 0; k < 2; k++) {
        lens_ray near;
        double launch[2] = {from[0], from[1]};
        launch[k] += step;
        TRY(launched(bundle, launch, &near, why));
        if (near.loss != LENS_PASSES)
            return STATUS_OK;
        reached(bundle, false, base, at[0]), reached(bundle, false, &near, to[0]);
        reached(bundle, true, base, at[1]), reached(bundle, true, &near, to[1]);
        for (int i = 0; i < 2; i++) {
            stop[2 * i + k] = (to[0][i] - at[0][i]) / step;
            cosines[2 * i + k] = (to[1][i] - at[1][i]) / step;
        }
    }
    for (int k = 0; k < 4; k++)
        bundle->per[k] = stop[k], bundle->cosines_per[k] = cosines[k];
    bundle->base[0] = from[0], bundle->base[1] = from[1];
    bundle->base_cosines[0] = at[1][0], bundle->base_cosines[1] = at[1][1];
    return STATUS_OK;
}

/* Where an obstruction takes the chief ray: the mean of rays around it stands for it. */
static status replace_chief(lens_beam *bundle, diagnostic *why)
{
    enum { AROUND = 16 };
    lens_ray sum = {.loss = LENS_LOST_EARLY};
    int count = 0;
    for (int i = 0; i < AROUND; i++) {
        lens_ray r;
        const double angle = 2.0 * M_PI * i / AROUND;
        double launch[2] = {NAN, NAN};
        TRY(lens_beam_ray(bundle, 0.8 * cos(angle), 0.8 * sin(angle), launch, &r, why));
        if (r.loss != LENS_PASSES)
            continue;
        if (count == 0)
            TRY(aim_differences(bundle, launch, &r, why));
        sum = (lens_ray){.loss = LENS_PASSES,
                         .image = vec3_add(sum.image, r.image),
                         .direction = vec3_add(sum.direction, r.direction),
                         .path = sum.path + r.path};
        count++;
    }
    if (count > 0) {
        sum.image = vec3_scale(sum.image, 1.0 / count);
        sum.direction = vec3_scale(sum.direction, 1.0 / vec3_length(sum.direction));
        sum.path /= count;
    }
    bundle->blocked = true;
    bundle->chief = sum;
    return STATUS_OK;
}

/* Distance before the first vertex from which rays start, clear of the lens. */
static double room_before(const lens_model *m, const lens_first *first)
{
    double most = first->entrance_d + fabs(first->z_entrance) + 1.0;
    for (int i = 0; i < m->count; i++)
        if (isfinite(m->step[i].clear))
            most = fmax(most, 2.0 * m->step[i].clear);
    return fmin(most, 1e4 * first->entrance_d);
}

/* Factors are of the entrance pupil, of which the stop may be an inverted image. */
static void set_vignetting(lens_beam *out, const lens_vignetting *v, double per_height)
{
    const double way = copysign(out->stop_radius, per_height);
    out->part_x = way * v->shift_x, out->part_y = way * v->shift_y;
    out->half_x = 1.0 - v->squeeze_x, out->half_y = 1.0 - v->squeeze_y;
}

status lens_beam_aim(lens_bench *b, const lens_prescription *p, const lens_first *first, double x, double y,
                     lens_beam *out, diagnostic *why)
{
    const lens_model *m = b->m;
    const double origin[2] = {0.0, 0.0}, zE = first->z_entrance;
    const bool far = isinf(m->object_distance);
    const double size = hypot(x, y);
    *out = (lens_beam){.b = b, .stop_radius = first->stop_real * (1.0 - WITHIN), .back = room_before(m, first)};
    out->t[0] = size > 0.0 ? x / size : 0.0, out->t[1] = size > 0.0 ? y / size : 1.0;
    const lens_vignetting v = lens_vignetting_of(p, x, y);
    set_vignetting(out, &v, first->per_height);
    const double per = first->per_height * (far ? 1.0 : 1.0 + zE / m->object_distance);
    out->per[0] = out->per[3] = per;
    /* Wide fields are approached in steps: pupils of wide-angle lenses move with the angle. */
    const int steps = p->field_kind == LENS_FIELD_ANGLE ? 1 + (int)(hypot(x, y) / AIM_DEG) : 2;
    double extra[2] = {0.0, 0.0};
    for (int i = 1; i <= steps; i++) {
        beam_set(p, first, x * i / steps, y * i / steps, out);
        const double share = far ? 0.0 : zE / (m->object_distance + zE);
        const double paraxial[2] = {far ? zE * out->across.z : out->object.x * share,
                                    far ? zE * out->up.z : out->object.y * share};
        double launch[2] = {paraxial[0] + extra[0], paraxial[1] + extra[1]};
        TRY(aim(out, false, origin, AIMED * out->stop_radius, launch, out->per, &out->chief, why));
        if (out->chief.loss == LENS_LOST_EARLY)
            launch[0] = paraxial[0] + extra[0], launch[1] = paraxial[1] + extra[1];
        extra[0] = launch[0] - paraxial[0], extra[1] = launch[1] - paraxial[1];
        out->launch[0] = launch[0], out->launch[1] = launch[1];
    }
    return out->chief.loss == LENS_PASSES ? aim_differences(out, out->launch, &out->chief, why)
                                          : replace_chief(out, why);
}

bool lens_row_guess(const lens_row_launch *row, double launch[2])
{
    const double(*a)[2] = row->last;
    for (int k = 0; k < 2 && row->count > 1; k++)
        launch[k] = row->count > 2 ? 3.0 * (a[0][k] - a[1][k]) + a[2][k] : 2.0 * a[0][k] - a[1][k];
    return row->count > 1;
}

void lens_row_add(lens_row_launch *row, bool arrives, const double launch[2])
{
    for (int k = 0; k < 2; k++)
        row->last[2][k] = row->last[1][k], row->last[1][k] = row->last[0][k], row->last[0][k] = launch[k];
    row->count = arrives ? row->count + (row->count < 3) : 0;
}

status lens_beam_ray(lens_beam *bundle, double px, double py, double launch[2], lens_ray *out, diagnostic *why)
{
    const double target[2] = {px * bundle->stop_radius, py * bundle->stop_radius};
    const double det = bundle->per[0] * bundle->per[3] - bundle->per[1] * bundle->per[2];
    double own[2] = {bundle->launch[0] + (bundle->per[3] * target[0] - bundle->per[1] * target[1]) / det,
                     bundle->launch[1] + (bundle->per[0] * target[1] - bundle->per[2] * target[0]) / det};
    double per[4] = {bundle->per[0], bundle->per[1], bundle->per[2], bundle->per[3]};
    const bool guessed = launch && isfinite(launch[0]);
    if (guessed)
        own[0] = launch[0], own[1] = launch[1];
    TRY(aim(bundle, false, target, AIMED * bundle->stop_radius, own, per, out, why));
    if (launch)
        launch[0] = out->loss == LENS_LOST_EARLY ? NAN : own[0], launch[1] = own[1];
    if (out->loss == LENS_PASSES &&
        hypot(lens_beam_x(bundle, target[0]), lens_beam_y(bundle, target[1])) > bundle->stop_radius * (1.0 + WITHIN))
        out->loss = LENS_LOST, out->lost_at = bundle->b->m->stop; /* by vignetting factors */
    return STATUS_OK;
}

status lens_beam_cosines(lens_beam *bundle, const double target[2], double tolerance, double launch[2], lens_ray *out,
                         diagnostic *why)
{
    double per[4] = {bundle->cosines_per[0], bundle->cosines_per[1], bundle->cosines_per[2], bundle->cosines_per[3]};
    return aim(bundle, true, target, tolerance, launch, per, out, why);
}

double lens_opd(const lens_beam *bundle, const lens_first *first, const lens_ray *r)
{
    const lens_model *m = bundle->b->m;
    if (r->loss != LENS_PASSES || bundle->chief.loss != LENS_PASSES)
        return NAN;
    const vec3 e = vec3_sub(r->image, bundle->chief.image);
    const double ahead = vec3_dot(e, r->direction), q = vec3_dot(e, e) - ahead * ahead;
    const double R = (bundle->chief.image.z - first->z_exit) / bundle->chief.direction.z;
    const double sphere = isfinite(R) ? q / (R + copysign(sqrt(R * R - q), R)) : 0.0;
    return (bundle->chief.path - r->path + fabs(m->n_image) * (ahead - sphere)) / (m->lambda_nm * 1e-6);
}

status lens_stop_radius(lens_bench *b, const lens_prescription *p, lens_first *first, diagnostic *why)
{
    lens_ray r;
    lens_beam bundle = {.b = b, .back = room_before(b->m, first)};
    first->stop_real = first->stop_radius;
    if (p->aperture_kind == LENS_APERTURE_STOP)
        return STATUS_OK;
    beam_set(p, first, 0.0, 0.0, &bundle);
    const double zE = first->z_entrance, far = b->m->object_distance;
    const double launch[2] = {0.0, isinf(far) ? 0.5 * first->entrance_d : 0.5 * first->entrance_d * far / (far + zE)};
    TRY(launched(&bundle, launch, &r, why));
    if (r.loss != LENS_LOST_EARLY)
        first->stop_real = hypot(r.stop_x, r.stop_y);
    return STATUS_OK;
}
