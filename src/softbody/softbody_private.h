/* Memory layout of a body, and the steps of its motion. Private to src/softbody/.
 *
 * Vectors are structures of arrays, a multiple of LANES long; padding masses are at rest, held, and without springs.
 * Springs are stored by vertex, at both of their ends: slot s of vertex i at [s * stride + i], so that a loop over
 * vertices accesses arrays sequentially. A spring's forces at its two ends are exact opposites,
 * because all inputs only change sign: so the force is computed once, in batches. */
#pragma once

#include "base/isa.h"
#include "base/worker_pool.h"
#include "softbody/softbody.h"

/* Vertices are processed and summed in chunks of a fixed size. */
enum { LANES = 8, CHUNK = 512, STATE = 8, FOUR = 4 };

typedef struct vectors {
    double *x, *y, *z;
} vectors;

typedef struct springs {
    size_t count, stride; /* number of masses; rounded up to a multiple of LANES */
    int slots;
    int ring_slots; /* the first slots of a vertex are its ring of neighbours, in the orientation of the faces; a
                     * shorter ring repeats its first neighbour, without a spring; 0 without faces */
    int32_t *other; /* the other end; the vertex itself for an empty slot */
    double *rest, *stiffness, *damping; /* 0 for an empty slot */
    int32_t *row;                       /* STATE times `other` */
    uint32_t *place; /* index of the spring in the batches; until they are built, its number, or NO_SPRING */
} springs;
#define NO_SPRING UINT32_MAX

/* Each spring once, stored with the end that owns it. Batch g, first[g] .. first[g + 1] - 1, interleaves the springs of
 * masses LANES g .. LANES g + LANES - 1: one spring of each mass, then the next. A mass with fewer springs than others
 * of its batch is padded with springs to itself, which exert no force. The last entry of pull is 0, for empty slots. */
typedef struct spring_batches {
    size_t *first;
    int32_t *row;                       /* STATE times the end that is not the owner */
    double *rest, *stiffness, *damping; /* 0 without a spring */
    double *pull;                       /* the current force on the owner over the distance to the other end */
} spring_batches;

/* For the implicit solver, by slot: the spring's direction, and the coefficients of a velocity difference across and
 * along it. */
typedef struct stiff_slots {
    double *nx, *ny, *nz, *across, *along;
} stiff_slots;

/* Parameters of one update of velocities and positions. */
typedef struct push {
    double dt_s;
    double pressure; /* a sixth of the pressure: multiplied by the gradient from `forces` it is a force */
    vec3 gravity;
    double ground_y;                          /* -INFINITY without a floor */
    double restitution, friction, rest_speed; /* slower normal speeds do not bounce */
    double speed_limit;                       /* maximum speed of a body that has not diverged */
} push;

typedef struct softbody_kernels {
    /* velocity += dt (force / mass + gravity), then at += dt velocity, then the floor. Returns the number of diverged
     * masses. */
    int64_t (*euler)(const push *p, const double *inverse_mass, vectors force, vectors gradient, vectors at,
                     vectors velocity, size_t begin, size_t end);
    /* First half of Verlet: advances `at` to the end of the step and velocity to its middle; guess is the velocity
     * predicted for its end. */
    void (*drift)(const push *p, vectors acceleration, vectors at, vectors velocity, vectors guess, size_t begin,
                  size_t end);
    /* Second half: new acceleration, velocity at the end, then the floor. Returns the number of diverged masses. */
    int64_t (*kick)(const push *p, const double *inverse_mass, vectors force, vectors gradient, vectors at,
                    vectors velocity, vectors acceleration, size_t begin, size_t end);
    /* stiffen: the springs' coefficients for the solver, from dt^2 k and dt k_d. resist: their product with a field of
     * velocities. */
    void (*stiffen)(const springs *s, double dt_s, vectors at, stiff_slots out, size_t begin, size_t end);
    void (*resist)(const springs *s, stiff_slots k, vectors field, vectors out, size_t begin, size_t end);
    /* velocity += change, at += dt velocity, then the floor. Returns the number of diverged masses. */
    int64_t (*settle)(const push *p, const double *inverse_mass, vectors change, vectors at, vectors velocity,
                      size_t begin, size_t end);
} softbody_kernels;

/* begin and end are multiples of LANES. */
typedef struct softbody_force_kernels {
    /* Positions and velocities, one cache line per mass: STATE numbers, x, y, z, 0, u, v, w, 0. */
    void (*pack)(vectors at, vectors velocity, double *state, size_t begin, size_t end);
    /* Computes t->pull of the springs that masses begin .. end - 1 own. */
    void (*pull)(const spring_batches *t, const double *state, vectors at, vectors velocity, size_t begin, size_t end);
    /* Sums the springs' forces on masses begin .. end - 1. With faces, also computes six times the volume's gradient
     * with respect to a mass's position, which is twice the sum of the area vectors around it. Returns 18 times the
     * volume of these masses, 0 without faces. */
    double (*forces)(const springs *s, const double *pulls, const double *state, vectors at, vectors force,
                     vectors gradient, size_t begin, size_t end);
} softbody_force_kernels;

ISA_DECLARE(const softbody_force_kernels, softbody_force_kernels)
ISA_DECLARE(const softbody_kernels, softbody_kernels)

typedef struct held_mass {
    uint32_t mass;
    vec3 offset;
} held_mass;
typedef struct grip {
    bool busy;
    vec3 at, target; /* its position; its target at the end of the step */
    held_mass *masses;
    size_t count;
} grip;

/* The playback of a hand's track. */
typedef struct track_play {
    size_t next; /* key */
    int hand;    /* its number; HAND_NONE if it holds nothing */
    vec3 where;  /* the point that it grabbed */
    vec3 from;   /* displacement at from_step, the start of its current line */
    uint64_t from_step;
} track_play;

struct softbody {
    softbody_settings set;
    springs net;
    spring_batches batches;
    softbody_spring *spring_list;
    size_t spring_count;
    mesh_triangle *faces;
    size_t face_count;
    double *mass_kg, *inverse_mass; /* inverse masses: 0 for grabbed ones */
    vectors at, velocity, force, gradient;
    double *state;               /* at and velocity, for the kernel of forces */
    vectors acceleration, guess; /* verlet only */
    stiff_slots stiff;           /* implicit only, as the vectors of its solver: */
    vectors change, residual, direction, image;
    const vectors *damped; /* velocities for which forces are computed */
    double *sums;          /* by chunk */
    int64_t *bad;          /* by chunk */
    double volume_at_rest;
    double size; /* largest initial extent */
    double stable_dt_s;
    uint64_t steps, substeps;
    bool has_acceleration; /* verlet: the acceleration belongs to the current positions */
    grip hands[SOFTBODY_HANDS_MAX];
    const hand_script *script;
    track_play *plays;
    const softbody_kernels *kernels;
    const softbody_force_kernels *force_kernels;
    thread_team *workers;
    uint32_t *mass_of; /* toy only: the mass of each vertex of its surface */
    int surface_level; /* -1: none */
    push pushing;      /* of the current substep */
    double solver_dt_s, factor,
        pressing; /* implicit only: the solver's step, the multiple of the direction, and the product of the pressure's
                   * stiffness with a field */
};

static inline vec3 vectors_at(vectors v, size_t i)
{
    return vec3_make(v.x[i], v.y[i], v.z[i]);
}
static inline void vectors_put(vectors v, size_t i, vec3 a)
{
    v.x[i] = a.x;
    v.y[i] = a.y;
    v.z[i] = a.z;
}

static inline size_t softbody_chunks(const softbody *b)
{
    return (b->net.stride + CHUNK - 1) / CHUNK;
}

/* An array with one double per mass, zero, 64-byte aligned; NULL if memory runs out. */
double *softbody_array(size_t count);

/* The net of the toy, for softbody_create; toy_net_release frees its arrays. mass_of: by vertex of generate_icosphere's
 * mesh. */
typedef struct toy_net {
    size_t mass_count, spring_count, face_count;
    vec3 *position;
    softbody_spring *springs;
    mesh_triangle *faces;
    uint32_t *mass_of;
} toy_net;
status toy_net_create(const softbody_settings *s, toy_net *out, diagnostic *why);
void toy_net_release(toy_net *n);

/* Stores springs and rings by vertex. STATUS_BAD_INPUT unless the faces are closed around every vertex. */
status springs_build(springs *s, const softbody_net *net, diagnostic *why);
void springs_release(springs *s);

/* Batches of the springs that springs_build has stored. STATUS_FAILURE if memory runs out. */
status batches_build(spring_batches *t, springs *s, const softbody_net *net, diagnostic *why);
void batches_release(spring_batches *t);

/* Forces of springs and the volume's gradient in the current state, then the pressure. velocity, for damping: the
 * body's; Verlet's prediction; or zeros, if the solver's matrix includes damping. */
void softbody_find_forces(softbody *b, const vectors *velocity);
/* Volume from the gradient of the last find_forces. */
double softbody_volume_of_gradient(softbody *b);

/* Hands: aim sets the velocities of held masses so that the step ends at the targets; move puts the hands there after
 * the step; play executes due keys before a step. */
void softbody_aim_hands(softbody *b, double dt_s);
void softbody_move_hands(softbody *b);
status softbody_play(softbody *b, diagnostic *why);
