/* Backward Euler: (M + dt D + dt^2 K) dv = dt (f + f_damping) - dt^2 K v, with K and D of the springs in their current
 * state (Baraff and Witkin, 1998, equation 6), and for the pressure the term K V'V'^T / V0. With f for springs at rest,
 * the right side is dt f minus the product of the matrix without M with v. Grabbed masses keep their velocities. Solved
 * by conjugate gradients from dv = 0, so that dv has the momentum of the forces (Shewchuk, "An introduction to the
 * conjugate gradient method", 1994). */
#include "softbody/softbody_private.h"

enum { ITERATIONS_MAX = 10000 };
#define TOLERANCE 1e-10 /* of the residual, relative to the first one */

static void stiffen(softbody *b, size_t begin, size_t end, size_t chunk)
{
    (void)chunk;
    b->kernels->stiffen(&b->net, b->solver_dt_s, b->at, b->stiff, begin, end);
}

/* Sum over a chunk of a . b. */
static double dot(vectors a, vectors b, size_t begin, size_t end)
{
    double sum = 0.0;
    for (size_t i = begin; i < end; i++)
        sum += a.x[i] * b.x[i] + a.y[i] * b.y[i] + a.z[i] * b.z[i];
    return sum;
}

static void press_velocity(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->sums[chunk] = dot(b->gradient, b->velocity, begin, end);
}
static void press_direction(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->sums[chunk] = dot(b->gradient, b->direction, begin, end);
}

/* Applies the pressure's stiffness to a field whose product with the gradient has just been summed. */
static double pressing(const softbody *b)
{
    const double dt = b->solver_dt_s;
    return b->volume_at_rest > 0.0 ? dt * dt * b->set.pressure / b->volume_at_rest / 36.0 * softbody_sum(b) : 0.0;
}

/* The right side, as the first residual and direction. */
static void begin_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
{
    const push *p = &b->pushing;
    b->kernels->resist(&b->net, b->stiff, b->velocity, b->image, begin, end);
    for (size_t i = begin; i < end; i++) {
        const bool free = b->inverse_mass[i] > 0.0;
        const vec3 g = vectors_at(b->gradient, i);
        const vec3 force = vec3_add(vec3_add(vectors_at(b->force, i), vec3_scale(g, p->pressure)),
                                    vec3_scale(p->gravity, b->mass_kg[i]));
        const vec3 right =
            vec3_sub(vec3_scale(force, p->dt_s), vec3_add(vectors_at(b->image, i), vec3_scale(g, b->pressing)));
        vectors_put(b->residual, i, free ? right : vec3_make(0.0, 0.0, 0.0));
        vectors_put(b->direction, i, free ? right : vec3_make(0.0, 0.0, 0.0));
        vectors_put(b->change, i, vec3_make(0.0, 0.0, 0.0));
    }
    b->sums[chunk] = dot(b->residual, b->residual, begin, end);
}

/* The product of the matrix with the direction, and its scalar product with the direction. */
static void apply_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->kernels->resist(&b->net, b->stiff, b->direction, b->image, begin, end);
    for (size_t i = begin; i < end; i++) {
        const vec3 sum =
            vec3_add(vec3_add(vectors_at(b->image, i), vec3_scale(vectors_at(b->direction, i), b->mass_kg[i])),
                     vec3_scale(vectors_at(b->gradient, i), b->pressing));
        vectors_put(b->image, i, b->inverse_mass[i] > 0.0 ? sum : vec3_make(0.0, 0.0, 0.0));
    }
    b->sums[chunk] = dot(b->direction, b->image, begin, end);
}

static void walk_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
{
    for (size_t i = begin; i < end; i++) {
        vectors_put(b->change, i,
                    vec3_add(vectors_at(b->change, i), vec3_scale(vectors_at(b->direction, i), b->factor)));
        vectors_put(b->residual, i,
                    vec3_sub(vectors_at(b->residual, i), vec3_scale(vectors_at(b->image, i), b->factor)));
    }
    b->sums[chunk] = dot(b->residual, b->residual, begin, end);
}

static void turn_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
{
    (void)chunk;
    for (size_t i = begin; i < end; i++)
        vectors_put(b->direction, i,
                    vec3_add(vectors_at(b->residual, i), vec3_scale(vectors_at(b->direction, i), b->factor)));
}

static void clear_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
{
    (void)chunk;
    for (size_t i = begin; i < end; i++)
        vectors_put(b->change, i, vec3_make(0.0, 0.0, 0.0));
}

bool softbody_solve(softbody *b)
{
    b->solver_dt_s = b->pushing.dt_s;
    softbody_for_chunks(b, clear_chunk);
    softbody_find_forces(b, &b->change); /* damping is part of the matrix */
    softbody_for_chunks(b, stiffen);
    softbody_for_chunks(b, press_velocity);
    b->pressing = pressing(b);
    softbody_for_chunks(b, begin_chunk);
    double square = softbody_sum(b);
    const double enough = TOLERANCE * TOLERANCE * square;
    int left = ITERATIONS_MAX;
    for (; left > 0 && square > enough; left--) {
        softbody_for_chunks(b, press_direction);
        b->pressing = pressing(b);
        softbody_for_chunks(b, apply_chunk);
        b->factor = square / softbody_sum(b);
        softbody_for_chunks(b, walk_chunk);
        const double before = square;
        square = softbody_sum(b);
        b->factor = square / before;
        softbody_for_chunks(b, turn_chunk);
    }
    return left > 0 && square <= enough; /* false for NaN */
}
