/* Forces of springs, and the gradient of the volume. One source for all instruction sets, with bit-identical results.
 *
 * The costly part of a spring's force, its amount over the distance, is computed once, for the spring's owner. Each
 * mass then sums the forces of its springs in the order of its slots, along the vectors to their other ends. */
#include "base/isa.h"
#include "softbody/columns.h"
#include "softbody/softbody_private.h"

static void pack(vectors at, vectors velocity, double *state, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i += FOUR) {
        store_half(state + STATE * i, at, i);
        store_half(state + STATE * i + STATE / 2, velocity, i);
    }
}

/* Hooke and damping of softbody.h over the distance of the ends, for the springs at `at` of WIDE owners. */
ALWAYS_INLINE wide pull_of(const spring_batches *t, size_t at, const double *state, moving own)
{
    const moving other = gather_state(state, t->row + at);
    const columns x = minus(other.at, own.at), v = minus(other.velocity, own.velocity);
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
        const moving own = {load_columns(at, i), load_columns(velocity, i)};
        const size_t group = i / LANES, lane = i % LANES;
        for (size_t k = t->first[group] + lane; k < t->first[group + 1]; k += LANES)
            *(wide *)(t->pull + k) = pull_of(t, k, state, own);
    }
}

/* Volume is homogeneous of degree 3 in the positions, so it is a third of the sum of position times gradient (Euler);
 * relative to one mass, for the least cancellation. The sum is in the order of the masses. */
ALWAYS_INLINE double add_volume(double sum, columns place, columns origin, columns gradient)
{
    const wide share = dot(minus(place, origin), gradient);
    for (int lane = 0; lane < WIDE; lane++)
        sum += share[lane];
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
