/* Where rays start: the division of a pixel's paths into replicates; the rays of fans and beams, in a plane, or in a
 * pattern over a disc or cone. */
#include "render/plan/sampling.h"

#include "base/elementary.h"
#include "base/random.h"
#include "render/plan/film.h"

/* Replicates under sobol. */
enum { SOBOL_REPLICATES = 4, SPECTRAL_REPLICATE_MIN = 8 };

/* A round has one path for each point of the pixel's grid. Under philox, as many replicates as possible: the paths are
 * independent, so that the number of replicates costs no accuracy. */
static int64_t philox_replicates(int64_t rounds)
{
    int64_t count = FILM_REPLICATES_MAX;
    while (rounds % count != 0)
        count--;
    return count;
}

/* Under sobol, few replicates: n paths in R replicates have R^0.25 to R times the error of one set of n points (errors
 * that fall like n^-0.75 to n^-1.5). If four do not divide the rounds, the smallest number that does. least: the
 * minimum number of rounds per replicate. */
static int64_t sobol_replicates(int64_t rounds, int64_t least)
{
    if (rounds % SOBOL_REPLICATES == 0 && rounds >= SOBOL_REPLICATES * least)
        return SOBOL_REPLICATES;
    for (int64_t count = 2; count <= FILM_REPLICATES_MAX && count * least <= rounds; count++)
        if (rounds % count == 0)
            return count;
    return 1;
}

path_sampling path_sampling_of(const render_settings *r)
{
    const int64_t turns = r->filter == PIXEL_FILTER_CENTRE ? r->samples : 1;
    int64_t count = 1;
    /* under sobol each replicate has its own wavelengths, and needs enough for a white sum */
    const int64_t least = r->spectrum == SPECTRUM_SPECTRAL ? SPECTRAL_REPLICATE_MIN : 1;
    if (r->paths % turns == 0) /* each replicate covers the whole grid */
        count = r->sampler == SAMPLER_SOBOL ? sobol_replicates(r->paths / turns, least)
                                            : philox_replicates(r->paths / turns);
    return (path_sampling){.seed = r->seed,
                           .sampler = r->sampler,
                           .seed_hash = sobol_mix((uint64_t)r->seed + 1),
                           .replicates = count,
                           .per_replicate = r->paths / count,
                           .paths = r->paths,
                           .turns = turns};
}

path_sampling path_sampling_of_grid(const render_settings *r, int64_t rays)
{
    return (path_sampling){.seed = r->seed,
                           .sampler = SAMPLER_SOBOL,
                           .seed_hash = sobol_mix((uint64_t)r->seed + 1),
                           .replicates = 1,
                           .per_replicate = rays,
                           .paths = rays,
                           .turns = 1};
}

/* --- the rays of fans and beams --- */

status ray_axes_set(ray_axes *a, vec3 from, vec3 axis, const vec3 *normal, diagnostic *why)
{
    if (!(vec3_length(axis) > 0.0 && isfinite(vec3_length(axis))))
        return diagnose(why, STATUS_BAD_INPUT, "give two points", "from and to are the same point");
    a->from = from;
    a->axis = vec3_normalize(axis);
    vec3 n = normal ? *normal : vec3_make(0, 1, 0);
    if (!normal && axis.y != 0.0) {
        const vec3 level = vec3_cross(a->axis, vec3_make(0, 1, 0));
        n = vec3_length(level) > 1e-9 ? level : vec3_make(0, 0, 1);
    }
    const double length = vec3_length(n);
    vec3 across_axis = vec3_sub(n, vec3_scale(a->axis, vec3_dot(n, a->axis)));
    if (!(length > 0.0 && isfinite(length)) || vec3_length(across_axis) < 1e-9 * length)
        return diagnose(why, STATUS_BAD_INPUT, "give a normal that is not along the axis",
                        "the normal is zero or parallel to the axis");
    a->normal = vec3_normalize(across_axis);
    /* Choose the sign: upwards, or for a horizontal plane, to the left of the axis seen from above. */
    a->across = vec3_cross(a->axis, a->normal);
    if (fabs(a->across.y) > 1e-9 ? a->across.y < 0.0 : a->axis.x * a->across.z - a->axis.z * a->across.x < 0.0)
        a->across = vec3_scale(a->across, -1.0);
    return STATUS_OK;
}

double ray_axes_in_plane(const ray_axes *a, bool spreads, double size, int i, int n, vec3 *origin, vec3 *direction)
{
    const double fraction = n > 1 ? (double)i / (n - 1) - 0.5 : 0.0, offset = size * fraction;
    *origin = a->from, *direction = a->axis;
    if (!spreads) {
        *origin = vec3_add(a->from, vec3_scale(a->across, offset));
        return offset;
    }
    double sine, cosine;
    elementary_sincos_deg(offset, &sine, &cosine);
    *direction = vec3_add(vec3_scale(a->axis, cosine), vec3_scale(a->across, sine));
    return offset;
}

/* --- patterns over the unit disc --- */

/* A point by the square of its radius and by its angle. */
typedef struct disc_point {
    double radius2, cosine, sine;
} disc_point;

static disc_point at_angle(double radius2, double angle_deg)
{
    disc_point p = {.radius2 = radius2};
    elementary_sincos_deg(fmod(angle_deg, 360.0), &p.sine, &p.cosine);
    return p;
}

/* Rays within k rings: 1 + 6 + 12 + ... + 6 k. */
static int64_t within_rings(int64_t k)
{
    return 1 + 3 * k * (k + 1);
}

static disc_point ring_point(int i, int n)
{
    if (i == 0)
        return at_angle(0.0, 0.0);
    int64_t k = (int64_t)((sqrt(12.0 * i + 9.0) - 3.0) / 6.0);
    while (within_rings(k) <= i)
        k++;
    /* The ring's area is from within_rings(k - 1) to within_rings(k), in parts of 1 / n. */
    return at_angle((double)(1 + 3 * k * k) / n, 60.0 * (double)(i - within_rings(k - 1)) / (double)k);
}

/* The largest number that is no larger than its root. */
static int64_t whole_root(int64_t square)
{
    return (int64_t)sqrt((double)square); /* exact below 2^52: a square's root is, and sqrt is monotonic */
}

/* Centres within the disc in a row of the square grid: in units of half a square, centres are at a, b = 1 - side, 3 -
 * side, ... side - 1, and within where a^2 + b^2 <= side^2. */
static int64_t centres_in_row(int64_t side, int64_t row)
{
    const int64_t b = 2 * row + 1 - side, half = whole_root(side * side - b * b);
    return side % 2 ? half / 2 * 2 + 1 : (half + 1) / 2 * 2;
}

static int64_t centres_within(int64_t side)
{
    int64_t count = 0;
    for (int64_t row = 0; row < side; row++)
        count += centres_in_row(side, row);
    return count;
}

/* The largest side whose grid has at most n centres within the disc. Counts grow with the side, by (pi / 4) side^2. */
static int64_t square_side(int64_t n)
{
    int64_t side = (int64_t)(1.128 * sqrt((double)n)) - 4; /* 1.128: below sqrt(4 / pi) */
    side = side < 1 ? 1 : side;
    while (centres_within(side + 1) <= n)
        side++;
    return side;
}

static disc_point square_point(int64_t side, int i)
{
    int64_t row = 0, first = 0;
    for (int64_t count; i >= first + (count = centres_in_row(side, row)); row++)
        first += count;
    const int64_t a = 2 * (i - first) + 1 - centres_in_row(side, row), b = 2 * row + 1 - side, sum = a * a + b * b;
    const double radius = sqrt((double)sum);
    return sum == 0 ? at_angle(0.0, 0.0)
                    : (disc_point){(double)sum / (double)(side * side), (double)a / radius, (double)b / radius};
}

ray_pattern ray_pattern_of(beam_pattern kind, int wanted)
{
    ray_pattern p = {.kind = kind, .count = wanted};
    int64_t rings = 0;
    switch (kind) {
    case PATTERN_RINGS:
        while (within_rings(rings + 1) <= wanted)
            rings++;
        p.count = (int)within_rings(rings);
        break;
    case PATTERN_SQUARE:
        p.side = square_side(wanted);
        p.count = (int)centres_within(p.side);
        break;
    case PATTERN_SPIRAL:
    case PATTERN_SOBOL: break;
    }
    return p;
}

static disc_point pattern_point(const ray_pattern *p, int i)
{
    const double golden_deg = 137.50776405003785, turn_deg = 360.0 * 0x1p-32; /* golden: 180 (3 - sqrt 5) */
    const uint32_t number = (uint32_t)i;
    switch (p->kind) {
    case PATTERN_RINGS: return ring_point(i, p->count);
    case PATTERN_SQUARE: return square_point(p->side, i);
    case PATTERN_SOBOL:
        return at_angle(0x1p-32 * sobol_reverse(number), turn_deg * sobol_reverse(sobol_pascal(number)));
    case PATTERN_SPIRAL: break;
    }
    return at_angle(p->count > 1 ? (i + 0.5) / p->count : 0.0, golden_deg * i);
}

void ray_axes_round(const ray_axes *a, const ray_pattern *pattern, bool spreads, double size, int i, vec3 *origin,
                    vec3 *direction)
{
    const disc_point p = pattern_point(pattern, i);
    const vec3 radial = vec3_add(vec3_scale(a->across, p.cosine), vec3_scale(a->normal, p.sine));
    *origin = a->from, *direction = a->axis;
    if (!spreads) {
        *origin = vec3_add(a->from, vec3_scale(radial, 0.5 * size * sqrt(p.radius2)));
        return;
    }
    double half_sine, half_cosine;
    elementary_sincos_deg(0.25 * size, &half_sine, &half_cosine);
    /* 1 - cos t is uniform in solid angle; the half angle avoids cancellation in a narrow cone */
    const double versine = 2.0 * half_sine * half_sine * p.radius2;
    *direction = vec3_add(vec3_scale(a->axis, 1.0 - versine), vec3_scale(radial, sqrt(versine * (2.0 - versine))));
}

/* --- field points --- */

/* Place i of n from -size / 2 to size / 2. */
static double spaced(double size, int i, int n)
{
    return n > 1 ? size * ((double)i / (n - 1) - 0.5) : 0.0;
}

static double tangent_deg(double angle_deg)
{
    double sine, cosine;
    elementary_sincos_deg(angle_deg, &sine, &cosine);
    return sine / cosine;
}

void ray_axes_field(const ray_axes *a, bool spreads, double size, int i, int columns, int rows, vec3 *from, vec3 *axis)
{
    const double x = spaced(size, i % columns, columns), y = spaced(size, i / columns, rows);
    const vec3 level = vec3_cross(vec3_make(0, 1, 0), a->axis);
    const vec3 side = vec3_length(level) > 1e-9 ? vec3_normalize(level) : vec3_make(1, 0, 0);
    const vec3 up = vec3_cross(a->axis, side);
    *from = a->from, *axis = a->axis;
    if (spreads)
        *from = vec3_add(a->from, vec3_add(vec3_scale(side, x), vec3_scale(up, y)));
    else if (x != 0.0 || y != 0.0)
        *axis = vec3_normalize(
            vec3_add(a->axis, vec3_add(vec3_scale(side, tangent_deg(x)), vec3_scale(up, tangent_deg(y)))));
}
