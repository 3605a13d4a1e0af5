/* Forces of springs, and the gradient of the volume. One source for all instruction sets, with bit-identical results.
 *
 * The costly part of a spring's force, its magnitude over the distance, is computed once, for the spring's owner. Each
 * mass then sums the forces of its springs in the order of its slots, along the vectors to their other ends. */
#include "base/isa.h"
#include "softbody/softbody_private.h"

/* --- vectors of four doubles, or of eight with AVX-512 ---
 *
 * Loads, products, and the transposition of masses' states, which are one cache line each. Transposing lines costs half
 * as much as gathering numbers; eight lanes have twice as many springs in flight. */

/* Without AVX compilers warn about passing wide vectors to functions; all functions of this file are inlined. */
#pragma GCC diagnostic ignored "-Wpsabi"

typedef double four __attribute__((vector_size(32)));
#ifdef __AVX512F__
enum { WIDE = 8 };
#else
enum { WIDE = 4 };
#endif
typedef double wide __attribute__((vector_size(8 * WIDE)));
typedef int64_t wide_int __attribute__((vector_size(8 * WIDE)));

typedef struct columns {
    wide x, y, z;
} columns;
/* Positions and velocities. */
typedef struct moving {
    columns at, velocity;
} moving;

ALWAYS_INLINE wide load(const double *from)
{
    return *(const wide *)from;
}

ALWAYS_INLINE columns load_columns(vectors v, size_t i)
{
    return (columns){load(v.x + i), load(v.y + i), load(v.z + i)};
}

ALWAYS_INLINE void store_columns(vectors v, size_t i, columns a)
{
    *(wide *)(v.x + i) = a.x;
    *(wide *)(v.y + i) = a.y;
    *(wide *)(v.z + i) = a.z;
}

ALWAYS_INLINE columns minus(columns a, columns b)
{
    return (columns){a.x - b.x, a.y - b.y, a.z - b.z};
}

ALWAYS_INLINE wide dot(columns a, columns b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* sum += k a */
ALWAYS_INLINE void add_scaled(columns *sum, wide k, columns a)
{
    sum->x += k * a.x;
    sum->y += k * a.y;
    sum->z += k * a.z;
}

/* sum += a x b */
ALWAYS_INLINE void add_cross(columns *sum, columns a, columns b)
{
    sum->x += a.y * b.z - a.z * b.y;
    sum->y += a.z * b.x - a.x * b.z;
    sum->z += a.x * b.y - a.y * b.x;
}

/* Shuffles of two vectors: EVEN and ODD interleave the elements of a and b at even or odd indices; EVEN_PAIRS and
 * ODD_PAIRS concatenate the pairs of elements at even or odd indices. */
#ifdef __AVX512F__
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define EVEN_PAIRS(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)
#define ODD_PAIRS(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
#else
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 4, 2, 6)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 5, 3, 7)
#define EVEN_PAIRS(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define ODD_PAIRS(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7)
#endif

/* x, y and z of WIDE rows of four numbers. */
ALWAYS_INLINE columns gather_three(const double *from, const int32_t *row)
{
#ifdef __AVX512F__
    wide two[4]; /* rows 0 and 2, 1 and 3, 4 and 6, 5 and 7 */
    for (int k = 0; k < 4; k++) {
        const int first = k / 2 * 4 + k % 2;
        two[k] = __builtin_shufflevector(*(const four *)(from + row[first]), *(const four *)(from + row[first + 2]), 0,
                                         1, 2, 3, 4, 5, 6, 7);
    }
    const wide a = EVEN(two[0], two[1]), b = EVEN(two[2], two[3]); /* x x z z x x z z */
    const wide c = ODD(two[0], two[1]), d = ODD(two[2], two[3]);
#else
    const wide a = EVEN(load(from + row[0]), load(from + row[1])), b = EVEN(load(from + row[2]), load(from + row[3]));
    const wide c = ODD(load(from + row[0]), load(from + row[1])), d = ODD(load(from + row[2]), load(from + row[3]));
#endif
    return (columns){EVEN_PAIRS(a, b), EVEN_PAIRS(c, d), ODD_PAIRS(a, b)};
}

/* The states of WIDE masses. */
ALWAYS_INLINE moving gather_state(const double *state, const int32_t *row)
{
#ifdef __AVX512F__
    wide line[WIDE];
    for (int lane = 0; lane < WIDE; lane++)
        line[lane] = load(state + row[lane]);
    const wide e0 = EVEN(line[0], line[1]), e1 = EVEN(line[2], line[3]), e2 = EVEN(line[4], line[5]),
               e3 = EVEN(line[6], line[7]); /* x x z z u u w w */
    const wide o0 = ODD(line[0], line[1]), o1 = ODD(line[2], line[3]), o2 = ODD(line[4], line[5]),
               o3 = ODD(line[6], line[7]);                         /* y y 0 0 v v 0 0 */
    const wide xu0 = EVEN_PAIRS(e0, e1), xu1 = EVEN_PAIRS(e2, e3); /* x x u u x x u u */
    const wide zw0 = ODD_PAIRS(e0, e1), zw1 = ODD_PAIRS(e2, e3);
    const wide yv0 = EVEN_PAIRS(o0, o1), yv1 = EVEN_PAIRS(o2, o3);
    return (moving){{EVEN_PAIRS(xu0, xu1), EVEN_PAIRS(yv0, yv1), EVEN_PAIRS(zw0, zw1)},
                    {ODD_PAIRS(xu0, xu1), ODD_PAIRS(yv0, yv1), ODD_PAIRS(zw0, zw1)}};
#else
    return (moving){gather_three(state, row), gather_three(state + STATE / 2, row)};
#endif
}

ALWAYS_INLINE wide gather(const double *from, const uint32_t *place)
{
#ifdef __AVX512F__
    return (wide){from[place[0]], from[place[1]], from[place[2]], from[place[3]],
                  from[place[4]], from[place[5]], from[place[6]], from[place[7]]};
#else
    return (wide){from[place[0]], from[place[1]], from[place[2]], from[place[3]]};
#endif
}

/* Writes vectors i .. i + 3 into one half of four states. */
ALWAYS_INLINE void store_half(double *half, vectors v, size_t i)
{
#ifdef __AVX2__
    const four x = *(const four *)(v.x + i), y = *(const four *)(v.y + i), z = *(const four *)(v.z + i), zero = {0.0};
    const four xy = __builtin_shufflevector(x, y, 0, 4, 2, 6), xy_odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    const four z0 = __builtin_shufflevector(z, zero, 0, 4, 2, 6), z0_odd = __builtin_shufflevector(z, zero, 1, 5, 3, 7);
    *(four *)half = __builtin_shufflevector(xy, z0, 0, 1, 4, 5);
    *(four *)(half + STATE) = __builtin_shufflevector(xy_odd, z0_odd, 0, 1, 4, 5);
    *(four *)(half + 2 * STATE) = __builtin_shufflevector(xy, z0, 2, 3, 6, 7);
    *(four *)(half + 3 * STATE) = __builtin_shufflevector(xy_odd, z0_odd, 2, 3, 6, 7);
#else
    for (size_t lane = 0; lane < FOUR; lane++) {
        half[STATE * lane] = v.x[i + lane];
        half[STATE * lane + 1] = v.y[i + lane];
        half[STATE * lane + 2] = v.z[i + lane];
    }
#endif
}

/* --- forces --- */

static void pack(vectors at, vectors velocity, double *state, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i += FOUR) {
        store_half(state + STATE * i, at, i);
        store_half(state + STATE * i + STATE / 2, velocity, i);
    }
}

/* Hooke's force plus damping (softbody.h), divided by the distance between the ends, for the springs at index `at` of
 * WIDE owners. */
ALWAYS_INLINE wide pull_of(const spring_batches *t, size_t at, const double *state, moving owner_state)
{
    const moving other = gather_state(state, t->row + at);
    const columns x = minus(other.at, owner_state.at), v = minus(other.velocity, owner_state.velocity);
    const wide square = dot(x, x), zero = {0.0}, one = zero + 1.0;
    const wide_int apart = square > zero; /* two masses at one position have no direction of force */
    const wide safe = (wide)(((wide_int)square & apart) | ((wide_int)one & ~apart)), inverse = one / safe;
    wide length;
    for (int lane = 0; lane < WIDE; lane++)
        length[lane] = sqrt(safe[lane]);
    return load(t->stiffness + at) * (one - load(t->rest + at) * length * inverse) +
           load(t->damping + at) * (dot(v, x) * inverse);
}

static void pull(const spring_batches *t, const double *state, vectors at, vectors velocity, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i += WIDE) {
        const moving owner_state = {load_columns(at, i), load_columns(velocity, i)};
        const size_t group = i / LANES, lane = i % LANES;
        for (size_t k = t->first[group] + lane; k < t->first[group + 1]; k += LANES)
            *(wide *)(t->pull + k) = pull_of(t, k, state, owner_state);
    }
}

/* Volume is homogeneous of degree 3 in the positions, so it is a third of the sum of position times gradient (Euler);
 * relative to one mass, for the least cancellation. The sum is in the order of the masses. */
ALWAYS_INLINE double add_volume(double sum, columns place, columns origin, columns gradient)
{
    const wide part = dot(minus(place, origin), gradient);
    for (int lane = 0; lane < WIDE; lane++)
        sum += part[lane];
    return sum;
}

/* The volume of a closed mesh is the sum of a . (b x c) / 6 over its faces (the divergence theorem). Its gradient with
 * respect to a mass is the sum of b x c / 6 over the closed ring of faces around the mass, which does not depend on the
 * origin. The ring's neighbours are the first slots of each mass. */
static double forces(const springs *s, const double *pulls, const double *state, vectors at, vectors force,
                     vectors gradient, size_t begin, size_t end)
{
    const wide zero = {0.0};
    const columns origin = {zero + at.x[0], zero + at.y[0], zero + at.z[0]};
    double volume = 0.0;
    for (size_t i = begin; i < end; i += WIDE) {
        const columns place = load_columns(at, i);
        columns sum = {0}, area = {0};
        size_t k = i;
        int slot = 0;
        if (s->ring_slots > 0) {
            const columns first = minus(gather_three(state, s->row + k), place); /* to the other end */
            columns before = first;
            add_scaled(&sum, gather(pulls, s->place + k), first);
            for (slot = 1, k += s->stride; slot < s->ring_slots; slot++, k += s->stride) {
                const columns x = minus(gather_three(state, s->row + k), place);
                add_scaled(&sum, gather(pulls, s->place + k), x);
                add_cross(&area, before, x);
                before = x;
            }
            add_cross(&area, before, first);
            store_columns(gradient, i, area);
            volume = add_volume(volume, place, origin, area);
        }
        for (; slot < s->slots; slot++, k += s->stride)
            add_scaled(&sum, gather(pulls, s->place + k), minus(gather_three(state, s->row + k), place));
        store_columns(force, i, sum);
    }
    return volume;
}

const softbody_force_kernels KERNEL(softbody_force_kernels) = {.pack = pack, .pull = pull, .forces = forces};
