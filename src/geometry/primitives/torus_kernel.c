/* The torus primitive: (sqrt(x^2 + z^2) - radius)^2 + y^2 <= second_radius^2 around local y; second_radius, the tube's,
 * is the smaller radius. Face 0.
 *
 * With rho = sqrt(x^2 + z^2), R = radius and r = second_radius, a line o + t d crosses it at the roots of the quartic
 * (|p|^2 + R^2 - r^2)^2 - 4 R^2 rho^2 = D ((rho + R)^2 + y^2 - r^2), D = (rho - R)^2 + y^2 - r^2, whose second factor
 * is positive. Between two roots is a zero of the derivative: a cubic without a square term if t is measured from the
 * point nearest to the centre; the zeros of its own derivative are known. So signs at known points bracket the roots.
 * The signs are taken from D, whose rounding error is relative to lengths and not to their fourth powers: a root is as
 * exact as D.
 *
 * For a ray that starts on the surface, D / t replaces D: if D(0) = 0 is taken as exact, D / t is a sum of terms
 * without a division by t, and the root at the ray's start is gone. */
#include "geometry/primitives/kind.h"

enum { TORUS_CHORDS = 2 };

/* A line, with t measured from its base: its point nearest to the torus's centre, or, if it starts on the surface, its
 * start. */
typedef struct torus_line {
    double R, r;
    local_ray base;
    double from;          /* t of the base */
    double rho, rises;    /* at the base: rho, and half the derivative of rho^2 */
    double across2;       /* dx^2 + dz^2 */
    bool starts_on;       /* the base is on the surface, and that root is excluded */
    double near;          /* within this distance of the base, D / t is computed by its terms */
    double least;         /* the step below which the iteration has converged */
    double middle;        /* the point nearest to the centre, as t from the base */
    double cubic, square; /* the derivative is proportional to s^3 + cubic s + square, with s measured from `middle` */
} torus_line;

typedef double torus_value(const torus_line *l, double t);

/* D, or D / t. */
static double torus_depth(const torus_line *l, double t)
{
    const local_ray *o = &l->base;
    const double x = o->x + t * o->dx, y = o->y + t * o->dy, z = o->z + t * o->dz;
    const double rho = sqrt(x * x + z * z), apart = rho - l->R;
    if (l->starts_on && magnitude(t) < l->near) {
        const double sum = rho + l->rho;
        return (2.0 * l->rises + t * l->across2) * ((sum - 2.0 * l->R) / sum) + o->dy * (2.0 * o->y + t * o->dy);
    }
    const double depth = (apart * apart + y * y) - l->r * l->r;
    return l->starts_on ? depth / t : depth;
}

static double torus_slope(const torus_line *l, double s)
{
    return (s * s + l->cubic) * s + l->square;
}

/* A zero between a and b, where the value has different signs: the Illinois variant of false position (Dowell and
 * Jarratt, BIT 11, 1971), with occasional bisection, until a step is within rounding. */
static double zero_between(torus_value *value, const torus_line *l, double a, double b, double at_a, double at_b)
{
    double last = a;
    int retained = 0; /* the end that the last step retained: -1 a, 1 b */
    for (int step = 1; step < 200; step++) {
        double t = step % 8 ? a + (b - a) * (at_a / (at_a - at_b)) : 0.5 * (a + b);
        if (!(t > a && t < b))
            t = 0.5 * (a + b);
        const double here = value(l, t);
        if (here == 0.0 || magnitude(t - last) <= l->least + 0x1p-53 * magnitude(t))
            return t;
        last = t;
        if ((here < 0.0) == (at_a < 0.0)) {
            a = t, at_a = here;
            at_b *= retained == 1 ? 0.5 : 1.0;
            retained = 1;
        } else {
            b = t, at_b = here;
            at_a *= retained == -1 ? 0.5 : 1.0;
            retained = -1;
        }
    }
    return last;
}

/* Zeros of the value between the given points, which are distinct and in order: at most one between two neighbours. */
static int zeros_between(torus_value *value, const torus_line *l, const double *points, int count, double *zeros)
{
    int found = 0;
    double before = value(l, points[0]);
    for (int k = 1; k < count; k++) {
        const double here = value(l, points[k]);
        if ((before < 0.0) != (here < 0.0))
            zeros[found++] = zero_between(value, l, points[k - 1], points[k], before, here);
        before = here;
    }
    return found;
}

/* Lists low, those of the ascending given points that are strictly between low and high, and high. Returns the number
 * of points. */
static int points_within(double low, double high, const double *given, int count, double *points)
{
    int n = 0;
    points[n++] = low;
    for (int k = 0; k < count; k++)
        if (given[k] > points[n - 1] && given[k] < high)
            points[n++] = given[k];
    points[n++] = high;
    return n;
}

/* The range of the line near the torus: within a ball and a slab slightly larger than the torus. middle: the ray at its
 * point nearest to the centre. */
static bool torus_reach(const primitive *p, local_ray middle, double length2, double *low, double *high)
{
    const double outer = p->radius + p->second_radius, thick = 1.125 * p->second_radius;
    const vec3 q = vec3_make(middle.x, middle.y, middle.z);
    const double half2 = (1.25 * outer * outer - vec3_dot(q, q)) / length2;
    if (!(half2 > 0.0))
        return false;
    const double half = sqrt(half2);
    const slab_roots slab = slab_cross(middle.y, inverse_of_component(middle.dy), -thick, thick, 0, 0);
    *low = greater(-half, slab.in);
    *high = lesser(half, slab.out);
    return *low < *high;
}

static local_ray moved(local_ray r, double t)
{
    return (local_ray){r.x + t * r.dx, r.y + t * r.dy, r.z + t * r.dz, r.dx, r.dy, r.dz};
}

/* The crossings of r's line with the torus, without the root of the face that r starts on. */
static crossings_of_one torus_cross(const primitive *p, local_ray r, bool starts_on)
{
    crossings_of_one found;
    found.count = 0;
    const double R = p->radius, r2 = p->second_radius * p->second_radius;
    const vec3 d = vec3_make(r.dx, r.dy, r.dz);
    const double length2 = vec3_dot(d, d), middle = -vec3_dot(vec3_make(r.x, r.y, r.z), d) / length2;
    const local_ray m = moved(r, middle);
    double low, high;
    if (!torus_reach(p, m, length2, &low, &high))
        return found;
    const double inverse = 1.0 / length2, across2 = d.x * d.x + d.z * d.z;
    const double least = (m.x * m.x + m.y * m.y + m.z * m.z) + R * R - r2;
    torus_line l = {.R = R,
                    .r = p->second_radius,
                    .base = starts_on ? r : m,
                    .from = starts_on ? 0.0 : middle,
                    .across2 = across2,
                    .starts_on = starts_on,
                    .near = p->second_radius * sqrt(inverse),
                    .least = 0x1p-55 * R * sqrt(inverse),
                    .middle = starts_on ? middle : 0.0,
                    .cubic = (least - 2.0 * R * R * (across2 * inverse)) * inverse,
                    .square = -2.0 * R * R * ((m.x * d.x + m.z * d.z) * inverse) * inverse};
    l.rho = sqrt(l.base.x * l.base.x + l.base.z * l.base.z);
    l.rises = l.base.x * d.x + l.base.z * d.z;
    double turn[2], points[5], flat[3];
    turn[1] = l.cubic < 0.0 ? sqrt(-l.cubic / 3.0) : 0.0, turn[0] = -turn[1];
    const int flats = zeros_between(torus_slope, &l, points, points_within(low, high, turn, 2, points), flat);
    for (int k = 0; k < flats; k++)
        flat[k] += l.middle;
    const int ends = points_within(low + l.middle, high + l.middle, flat, flats, points);
    found.count = zeros_between(torus_depth, &l, points, ends, found.t);
    for (int k = 0; k < found.count; k++)
        found.t[k] += l.from;
    return found;
}

static void one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found)
{
    (void)s;
    const bool starts_on = rays->start[i] == p->first_face;
    const local_ray r =
        ray_to_local(p, p->turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    const crossings_of_one line = torus_cross(p, r, starts_on);
    const double length = sqrt(r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    const crossings_of_one ahead = crossings_ahead(&line, starts_on, inside, 0x1p-20 * p->second_radius / length);
    intervals_of_crossings(&ahead, inside, TORUS_CHORDS, found);
}

/* Few rays hit a torus, so a vectorised loop over all rays would waste most of its work. */
static void rows(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s)
{
    for (int i = 0; i < rays->count; i++) {
        interval found[CHORDS_MAX];
        one(p, rays, i, rays->inside[i] >> bit & 1, s, found);
        for (int k = 0; k < TORUS_CHORDS; k++)
            s->in[bit + k][i] = found[k].in, s->out[bit + k][i] = found[k].out;
    }
}

ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general, (void)r, (void)at, (void)leaving;
    double rho = sqrt(q.x * q.x + q.z * q.z), inverse = 1.0 / rho, apart = rho - p->radius;
    double outwards = 1.0 / sqrt(apart * apart + q.y * q.y);
    double ux = q.x * inverse, uz = q.z * inverse, across = apart * outwards;
    double ring = p->radius + p->second_radius * across;
    local_point l;
    l.normal = vec3_make(ux * across, q.y * outwards, uz * across);
    l.point = vec3_make(ux * ring, p->second_radius * l.normal.y, uz * ring);
    l.face = p->first_face;
    return l;
}

DEFINE_POINTS(p->turned, point)

static bool contains(const primitive *p, vec3 q)
{
    const double apart = sqrt(q.x * q.x + q.z * q.z) - p->radius;
    return apart * apart + q.y * q.y <= p->second_radius * p->second_radius;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    const crossings_of_one line = torus_cross(p, r, false);
    for (int k = 0; k < line.count / 2; k++)
        found[k] = (interval){line.t[2 * k], line.t[2 * k + 1]};
    return line.count / 2;
}

/* Once around the axis, with the middle of the texture image in front, and once around the tube, with its middle on the
 * outermost circle; lengths are measured along the circle at the tube's centre and around the tube. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    (void)face;
    const double apart = sqrt(q.x * q.x + q.z * q.z) - p->radius, arc = 6.283185307179586 * p->second_radius;
    const double turn = 0.5 + elementary_atan2_deg(q.y, apart) / 360.0;
    return mapping_around(q.x, q.z, p->radius, turn * arc, arc, size);
}

const primitive_functions KERNEL(torus_functions) = {TORUS_CHORDS, rows, one, points, contains, chords, NULL, mapping};
