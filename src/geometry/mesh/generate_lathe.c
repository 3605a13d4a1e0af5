/* A surface of revolution about the y axis. The points of its profile become rows of around + 1 vertices. A point with
 * a crease, or one where the profile touches the axis, has two rows, for the normals of the segments before and after
 * it. */
#include "geometry/mesh/mesh_generators.h"
#include "geometry/mesh/mesh_private.h"

#include "base/cancel.h"
#include "base/elementary.h"

#include <stdlib.h>

typedef struct row {
    profile_point at, normal;
    double v;
} row; /* normal: its components away from the axis and along it */

typedef struct lathe {
    const profile_point *profile;
    size_t count;  /* number of points */
    bool backward; /* the profile is reversed so that the fronts face outwards */
    bool ring;     /* the profile is a closed curve */
    double crease_deg, length;
    row *rows;
    size_t row_count;
    size_t *low, *high; /* rows at the two ends of each segment */
} lathe;

static profile_point point_at(const lathe *l, size_t k)
{
    return l->profile[l->backward ? l->count - 1 - k : k];
}

static bool equal(profile_point a, profile_point b)
{
    return a.radius == b.radius && a.height == b.height;
}

static status check(const profile_point *profile, size_t count, int around, double crease_deg, diagnostic *why)
{
    if (around < 3)
        return diagnose(why, STATUS_BAD_INPUT, "use at least 3 segments",
                        "a surface of revolution cannot have %d segments", around);
    if (!(crease_deg >= 0.0 && crease_deg <= 180.0))
        return diagnose(why, STATUS_BAD_INPUT, "use 0 to 180 degrees", "crease angle %g is out of range", crease_deg);
    if (count < 2 || count > MESH_VERTICES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 2 to 536870912 points", "a profile cannot have %zu points", count);
    bool off_axis = false;
    for (size_t k = 0; k < count; k++) {
        const profile_point p = profile[k];
        if (!(p.radius >= 0.0 && p.radius <= MESH_FAR && fabs(p.height) <= MESH_FAR))
            return diagnose(why, STATUS_BAD_INPUT, "use a radius of 0 to 1e9 and a height of -1e9 to 1e9",
                            "point %zu of the profile is out of range: %g, %g", k, p.radius, p.height);
        if (k > 0 && equal(p, profile[k - 1]))
            return diagnose(why, STATUS_BAD_INPUT, "remove one of them", "points %zu and %zu of the profile are equal",
                            k - 1, k);
        off_axis |= p.radius > 0.0;
    }
    return off_axis ? STATUS_OK
                    : diagnose(why, STATUS_BAD_INPUT, "use a radius greater than 0",
                               "all points of the profile are on the axis");
}

/* The volume enclosed by the profile's cones, times 3 / pi; negative if the profile runs downwards on the outside. */
static double enclosed(const profile_point *p, size_t count)
{
    double sum = 0.0;
    for (size_t k = 1; k < count; k++) {
        const double a = p[k - 1].radius, b = p[k].radius;
        sum += (p[k].height - p[k - 1].height) * (a * a + a * b + b * b);
    }
    return sum;
}

/* The length of the segment that begins at point k, and its unit normal, which points outwards if the segment goes
 * up. */
static double segment(const lathe *l, size_t k, profile_point *normal)
{
    const profile_point a = point_at(l, k), b = point_at(l, k + 1);
    const double out = b.radius - a.radius, up = b.height - a.height, length = sqrt(out * out + up * up);
    *normal = (profile_point){up / length, -out / length};
    return length;
}

/* The mean of two unit normals; false if they differ by more than the crease. */
static bool mean_normal(const lathe *l, profile_point a, profile_point b, profile_point *mean)
{
    const double turn_deg =
        elementary_atan2_deg(a.radius * b.height - a.height * b.radius, a.radius * b.radius + a.height * b.height);
    const double out = a.radius + b.radius, up = a.height + b.height, length = sqrt(out * out + up * up);
    if (!(fabs(turn_deg) <= l->crease_deg) || !(length > 0.0))
        return false;
    *mean = (profile_point){out / length, up / length};
    return true;
}

static size_t add_row(lathe *l, profile_point at, profile_point normal, double v)
{
    /* across the axis the surface continues as its mirror image */
    if (at.radius == 0.0)
        mean_normal(l, normal, (profile_point){-normal.radius, normal.height}, &normal);
    l->rows[l->row_count] = (row){at, normal, v};
    return l->row_count++;
}

static void make_rows(lathe *l)
{
    const size_t segments = l->count - 1;
    profile_point before, after;
    double travelled = 0.0;
    segment(l, segments - 1, &before);
    for (size_t k = 0; k <= segments; k++) {
        const profile_point at = point_at(l, k);
        const double v = k == segments ? 1.0 : travelled / l->length;
        if (k < segments)
            travelled += segment(l, k, &after);
        else
            segment(l, 0, &after);
        profile_point mean = before;
        const bool inner = (k > 0 && k < segments) || l->ring;
        const bool smooth = inner && at.radius > 0.0 && mean_normal(l, before, after, &mean);
        if (k > 0)
            l->high[k - 1] = add_row(l, at, smooth ? mean : before, v);
        if (k < segments)
            l->low[k] = smooth && k > 0 ? l->high[k - 1] : add_row(l, at, smooth ? mean : after, v);
        before = after;
    }
}

static void place_rows(const lathe *l, int around, mesh *m)
{
    const size_t columns = (size_t)around + 1;
    for (size_t i = 0; i < columns && !cancel_asked(); i++) {
        const vec3 away = generate_azimuth((int)i, around);
        for (size_t r = 0; r < l->row_count; r++) {
            const row *at = &l->rows[r];
            const size_t v = r * columns + i;
            m->vertices[v] = vec3_make(at->at.radius * away.x, at->at.height, at->at.radius * away.z);
            m->normals[v] = vec3_make(at->normal.radius * away.x, at->normal.height, at->normal.radius * away.z);
            m->uvs[v] = (mesh_uv){((double)i + (at->at.radius == 0.0 ? 0.5 : 0.0)) / around, at->v};
        }
    }
}

/* The triangles of the segments: one instead of two if an end is on the axis. Returns their number; triangles may be
 * NULL. */
static size_t join_rows(const lathe *l, int around, mesh_triangle *triangles)
{
    const uint32_t columns = (uint32_t)around + 1;
    size_t written = 0;
    for (size_t k = 0; k + 1 < l->count; k++) {
        const row *low = &l->rows[l->low[k]], *high = &l->rows[l->high[k]];
        if (!triangles) {
            written += (size_t)around * (size_t)((low->at.radius > 0.0) + (high->at.radius > 0.0));
            continue;
        }
        for (uint32_t i = 0; i + 1 < columns && !cancel_asked_at(i); i++) {
            const uint32_t a = (uint32_t)l->low[k] * columns + i, d = (uint32_t)l->high[k] * columns + i;
            if (high->at.radius > 0.0)
                triangles[written++] = (mesh_triangle){{a, d, d + 1}};
            if (low->at.radius > 0.0)
                triangles[written++] = (mesh_triangle){{a, high->at.radius > 0.0 ? d + 1 : d, a + 1}};
        }
    }
    return written;
}

static status make(lathe *l, int around, bool closed, mesh **out, diagnostic *why)
{
    mesh *m;
    make_rows(l);
    status result =
        mesh_create(l->row_count * ((size_t)around + 1), join_rows(l, around, NULL), true, true, false, &m, why);
    if (result != STATUS_OK)
        return result;
    place_rows(l, around, m);
    join_rows(l, around, m->triangles);
    return generate_finish(m, closed, out, why);
}

status generate_lathe(const profile_point *profile, size_t count, int around, double crease_deg, mesh **out,
                      diagnostic *why)
{
    TRY(check(profile, count, around, crease_deg, why));
    status result = STATUS_OK;
    lathe l = {
        .profile = profile, .count = count, .crease_deg = crease_deg, .ring = equal(profile[0], profile[count - 1])};
    const bool closed = l.ring || (profile[0].radius == 0.0 && profile[count - 1].radius == 0.0);
    l.backward = closed && enclosed(profile, count) < 0.0;
    for (size_t k = 0; k + 1 < count; k++)
        l.length += segment(&l, k, &(profile_point){0});
    l.rows = calloc(2 * count, sizeof *l.rows);
    l.low = calloc(count, sizeof *l.low);
    l.high = calloc(count, sizeof *l.high);
    if (l.rows && l.low && l.high)
        result = make(&l, around, closed, out, why);
    else
        result = diagnose(why, STATUS_FAILURE, "use fewer points", "out of memory for a profile");
    free(l.rows);
    free(l.low);
    free(l.high);
    return result;
}
