/* Time integration: forces, the solver of backward Euler, substeps, and detection of divergence. */
#include "base/cancel.h"
#include "softbody/softbody_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The work of a step is done in chunks of masses, on any worker. */
typedef void chunk_work(softbody *b, size_t begin, size_t end, size_t chunk);

typedef struct chunk_task {
    softbody *b;
    chunk_work *work;
} chunk_task;

static void run_chunk(void *context, size_t chunk, int member)
{
    (void)member;
    const chunk_task *t = context;
    const size_t begin = chunk * CHUNK, stride = t->b->net.stride;
    t->work(t->b, begin, begin + CHUNK < stride ? begin + CHUNK : stride, chunk);
}

static void for_chunks(softbody *b, chunk_work *work)
{
    chunk_task t = {b, work};
    const size_t count = softbody_chunks(b);
    if (thread_team_size(b->workers) > 1) {
        thread_team_run(b->workers, run_chunk, &t, count);
        return;
    }
    for (size_t chunk = 0; chunk < count; chunk++)
        run_chunk(&t, chunk, 0);
}

static double sum_of_chunks(const softbody *b)
{
    double sum = 0.0;
    for (size_t chunk = 0; chunk < softbody_chunks(b); chunk++)
        sum += b->sums[chunk];
    return sum;
}

static void pack(softbody *b, size_t begin, size_t end, size_t chunk)
{
    (void)chunk;
    b->force_kernels->pack(b->at, *b->damped, b->state, begin, end);
}

static void pull(softbody *b, size_t begin, size_t end, size_t chunk)
{
    (void)chunk;
    b->force_kernels->pull(&b->batches, b->state, b->at, *b->damped, begin, end);
}

static void sum_forces(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->sums[chunk] =
        b->force_kernels->forces(&b->net, b->batches.pull, b->state, b->at, b->force, b->gradient, begin, end);
}

double softbody_volume_of_gradient(softbody *b)
{
    return sum_of_chunks(b) / 18.0;
}

void softbody_find_forces(softbody *b, const vectors *velocity)
{
    b->damped = velocity;
    for_chunks(b, pack);
    for_chunks(b, pull);
    for_chunks(b, sum_forces);
    const double at_rest = b->volume_at_rest;
    b->pushing.pressure =
        at_rest > 0.0 ? b->set.pressure * (at_rest - softbody_volume_of_gradient(b)) / at_rest / 6.0 : 0.0;
}

/* --- backward Euler ---
 *
 * (M + dt D + dt^2 K) dv = dt (f + f_damping) - dt^2 K v, with K and D of the springs in their current state (Baraff
 * and Witkin, 1998, equation 6), and for the pressure the term K V'V'^T / V0. If f is computed without damping, the
 * right side is dt f - (dt D + dt^2 K) v. Grabbed masses keep their velocities. Solved by conjugate gradients from dv =
 * 0, so that dv has the momentum of the forces (Shewchuk, "An introduction to the conjugate gradient method", 1994). */

enum { ITERATIONS_MAX = 10000 };
#define TOLERANCE 1e-10 /* residual over the first residual */

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

/* The pressure's stiffness applied to a field whose product with the gradient has just been summed. */
static double pressure_product(const softbody *b)
{
    const double dt = b->solver_dt_s;
    return b->volume_at_rest > 0.0 ? dt * dt * b->set.pressure / b->volume_at_rest / 36.0 * sum_of_chunks(b) : 0.0;
}

/* Stores the right side as the first residual and direction. */
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

/* Multiplies the matrix by the search direction (the product is 0 at fixed masses), and adds up the scalar product of
 * the direction with the result. */
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

static void advance_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
{
    for (size_t i = begin; i < end; i++) {
        vectors_put(b->change, i,
                    vec3_add(vectors_at(b->change, i), vec3_scale(vectors_at(b->direction, i), b->factor)));
        vectors_put(b->residual, i,
                    vec3_sub(vectors_at(b->residual, i), vec3_scale(vectors_at(b->image, i), b->factor)));
    }
    b->sums[chunk] = dot(b->residual, b->residual, begin, end);
}

static void redirect_chunk(softbody *b, size_t begin, size_t end, size_t chunk)
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

static bool solve(softbody *b)
{
    b->solver_dt_s = b->pushing.dt_s;
    for_chunks(b, clear_chunk);
    softbody_find_forces(b, &b->change); /* damping is part of the matrix */
    for_chunks(b, stiffen);
    for_chunks(b, press_velocity);
    b->pressing = pressure_product(b);
    for_chunks(b, begin_chunk);
    double square = sum_of_chunks(b);
    const double enough = TOLERANCE * TOLERANCE * square;
    int left = ITERATIONS_MAX;
    for (; left > 0 && square > enough; left--) {
        for_chunks(b, press_direction);
        b->pressing = pressure_product(b);
        for_chunks(b, apply_chunk);
        b->factor = square / sum_of_chunks(b);
        for_chunks(b, advance_chunk);
        const double before = square;
        square = sum_of_chunks(b);
        b->factor = square / before;
        for_chunks(b, redirect_chunk);
    }
    return left > 0 && square <= enough; /* false for NaN */
}

/* --- substeps --- */

static void push_euler(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->bad[chunk] =
        b->kernels->euler(&b->pushing, b->inverse_mass, b->force, b->gradient, b->at, b->velocity, begin, end);
}

static void push_drift(softbody *b, size_t begin, size_t end, size_t chunk)
{
    (void)chunk;
    b->kernels->drift(&b->pushing, b->acceleration, b->at, b->velocity, b->guess, begin, end);
}

static void push_kick(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->bad[chunk] = b->kernels->kick(&b->pushing, b->inverse_mass, b->force, b->gradient, b->at, b->velocity,
                                     b->acceleration, begin, end);
}

static void push_settle(softbody *b, size_t begin, size_t end, size_t chunk)
{
    b->bad[chunk] = b->kernels->settle(&b->pushing, b->inverse_mass, b->change, b->at, b->velocity, begin, end);
}

/* The acceleration for the first half of a step. */
static void find_acceleration(softbody *b)
{
    const push step = b->pushing;
    softbody_find_forces(b, &b->velocity);
    b->pushing.dt_s = 0.0;
    b->pushing.ground_y = -INFINITY;
    for_chunks(b, push_kick);
    b->pushing = step;
    b->has_acceleration = true;
}

static void substep_verlet(softbody *b)
{
    if (!b->has_acceleration)
        find_acceleration(b);
    for_chunks(b, push_drift);
    softbody_find_forces(b, &b->guess);
    for_chunks(b, push_kick);
}

/* False if backward Euler does not converge. */
static bool substep(softbody *b, double dt_s)
{
    const softbody_settings *s = &b->set;
    b->pushing.dt_s = dt_s;
    b->pushing.gravity = s->gravity;
    b->pushing.ground_y = s->ground ? s->ground_y : -INFINITY;
    b->pushing.restitution = s->restitution;
    b->pushing.friction = s->friction;
    b->pushing.rest_speed = 2.0 * fabs(s->gravity.y) * dt_s; /* the speed that a mass at rest gains in two steps */
    b->pushing.speed_limit = b->size > 0.0 ? b->size / dt_s : 1e150;
    switch ((softbody_integrator)s->integrator) {
    case SOFTBODY_EULER:
        softbody_find_forces(b, &b->velocity);
        for_chunks(b, push_euler);
        break;
    case SOFTBODY_VERLET: substep_verlet(b); break;
    case SOFTBODY_IMPLICIT:
        if (!solve(b))
            return false;
        for_chunks(b, push_settle);
        break;
    }
    b->substeps++;
    return true;
}

/* Largest relative speed of a spring's ends, in spring lengths per second. */
static double strain_rate(const softbody *b)
{
    double square = 0.0;
    for (size_t i = 0; i < b->spring_count; i++) {
        const softbody_spring *s = &b->spring_list[i];
        const vec3 u = vec3_sub(vectors_at(b->velocity, s->end[1]), vectors_at(b->velocity, s->end[0]));
        if (s->rest > 0.0)
            square = fmax(square, vec3_dot(u, u) / (s->rest * s->rest));
    }
    return sqrt(square);
}

enum { SUBSTEPS_MAX = 10000 };

static double substeps_wanted(const softbody *b)
{
    if (!b->set.adaptive)
        return 1.0;
    const double by_motion = ceil(10.0 * strain_rate(b) * b->set.dt_s);
    const double by_springs = b->set.integrator == SOFTBODY_IMPLICIT ? 1.0 : ceil(b->set.dt_s / (0.9 * b->stable_dt_s));
    return fmax(1.0, fmax(by_motion, by_springs));
}

static bool any_bad(const softbody *b)
{
    int64_t bad = 0;
    for (size_t chunk = 0; chunk < softbody_chunks(b); chunk++)
        bad += b->bad[chunk];
    return bad > 0;
}

/* Speed of a mass relative to the centre of mass, a measure of divergence. */
static double speed_apart(const softbody *b, vec3 center, size_t i)
{
    return vec3_length(vec3_sub(vectors_at(b->velocity, i), center));
}

static vec3 velocity_of_center(const softbody *b)
{
    double mass = 0.0;
    vec3 sum = {0.0, 0.0, 0.0};
    for (size_t i = 0; i < b->net.count; i++) {
        sum = vec3_add(sum, vec3_scale(vectors_at(b->velocity, i), b->mass_kg[i]));
        mass += b->mass_kg[i];
    }
    return vec3_scale(sum, 1.0 / mass);
}

/* The first mass whose speed relative to the centre of mass is NaN or above the limit; the number of masses if there is
 * none. */
static size_t find_diverged(const softbody *b, double *speed)
{
    const vec3 center = velocity_of_center(b);
    size_t i = 0;
    for (; i < b->net.count; i++) {
        *speed = speed_apart(b, center, i);
        if (!(*speed <= b->pushing.speed_limit))
            break;
    }
    return i;
}

/* The kernels compare absolute speeds, but a body that moves fast has not diverged. */
static bool has_diverged(softbody *b)
{
    double speed;
    if (!any_bad(b))
        return false;
    if (find_diverged(b, &speed) < b->net.count)
        return true;
    memset(b->bad, 0, softbody_chunks(b) * sizeof *b->bad);
    return false;
}

static status report_divergence(const softbody *b, diagnostic *why)
{
    double speed = 0.0;
    const size_t i = find_diverged(b, &speed);
    char remedy[200], what[120];
    snprintf(remedy, sizeof remedy,
             "use dt_s of at most %.3g (stable at rest), 'adaptive: on', 'integrator: implicit', softer "
             "springs or a slower hand",
             b->stable_dt_s);
    if (isfinite(speed))
        snprintf(what, sizeof what,
                 "the speed of mass %zu relative to the others is %.3g: more than the slime's size per substep", i,
                 speed);
    else
        snprintf(what, sizeof what, "the speed of mass %zu is not a number", i < b->net.count ? i : 0);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the simulation diverged in step %llu, at %.6g s: %s",
                    (unsigned long long)b->steps + 1, (double)(b->steps + 1) * b->set.dt_s, what);
}

status softbody_step(softbody *b, diagnostic *why)
{
    if (any_bad(b)) /* diverged in an earlier step, and not placed anew */
        return report_divergence(b, why);
    TRY(softbody_play(b, why));
    softbody_aim_hands(b, b->set.dt_s);
    const double count = substeps_wanted(b);
    if (!(count <= SUBSTEPS_MAX))
        return diagnose(why, STATUS_BAD_INPUT, "use a smaller dt_s, or softer springs",
                        "step %llu, at %.6g s, would require %.3g substeps", (unsigned long long)b->steps + 1,
                        (double)(b->steps + 1) * b->set.dt_s, count);
    for (double i = 0.0; i < count; i += 1.0) {
        if (!substep(b, b->set.dt_s / count))
            return diagnose(why, STATUS_BAD_INPUT, "use a smaller dt_s, or softer springs",
                            "the solver of step %llu of the slime, at %.6g s, does not converge",
                            (unsigned long long)b->steps + 1, (double)(b->steps + 1) * b->set.dt_s);
        if (has_diverged(b))
            return report_divergence(b, why);
    }
    softbody_move_hands(b);
    b->steps++;
    return STATUS_OK;
}

status softbody_advance(softbody *b, double time_s, diagnostic *why)
{
    const double steps = floor(time_s / b->set.dt_s + 0.5);
    while ((double)b->steps < steps) {
        TRY(cancel_check(why)); /* between steps, so that the motion can continue later */
        TRY(softbody_step(b, why));
    }
    return STATUS_OK;
}

double softbody_stable_dt_s(const softbody *b)
{
    return b->stable_dt_s;
}
