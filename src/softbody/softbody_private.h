/* The room's inside: how a body lies in memory, and the steps of its motion. For src/softbody/ alone.
 *
 * Vectors are structures of arrays, a multiple of LANES long; masses beyond the count are at rest, held, and no
 * spring's. Springs stand by vertex, at both of their ends: slot s of vertex i at [s * stride + i], so that a loop over
 * vertices runs through arrays. A spring's force at one end is the exact negative of that at the other, because all
 * that goes into it only changes its sign. */
#pragma once

#include "base/thread_team.h"
#include "softbody/softbody.h"

/* Vertices are worked on, and summed over, in chunks of a fixed size. */
enum { LANES = 8, CHUNK = 512, STATE = 8 };

typedef struct vectors {
    double *x, *y, *z;
} vectors;

typedef struct springs {
    size_t count, stride; /* masses; rounded up to whole lanes */
    int slots;
    int ring_slots; /* the first slots are those of the neighbours around a vertex, in the faces' direction (the first
                     * again where they are fewer, without a spring); 0 without faces */
    int32_t *other; /* the other end; the vertex itself where a slot is empty */
    double *rest, *stiffness, *damping; /* 0 where it is empty */
} springs;

/* For the solver: slot's direction, and what a difference of velocities comes to across and along it. */
typedef struct stiff_slots {
    double *nx, *ny, *nz, *across, *along;
} stiff_slots;

/* What one push of the velocities and places needs. */
typedef struct push {
    double dt_s;
    double pressure; /* a sixth of it: times the gradient that `forces` gives it is a force */
    vec3 gravity;
    double ground_y;                          /* -INFINITY without a floor */
    double restitution, friction, rest_speed; /* slower than rest_speed nothing bounces */
    double speed_limit;                       /* of a body that has not blown up */
} push;

typedef struct softbody_kernels {
    /* Places and velocities, a mass on a cache line: STATE numbers, x, y, z, -, u, v, w, -. */
    void (*pack)(vectors at, vectors velocity, double *state, size_t begin, size_t end);
    /* Of vertices begin .. end - 1 the sum of the springs' forces; and with faces six times the volume's gradient with
     * regard to the vertex's place, which is twice the sum of the area vectors around it. begin and end are whole
     * lanes. */
    void (*forces)(const springs *s, const double *state, vectors at, vectors velocity, vectors force, vectors gradient,
                   size_t begin, size_t end);
    /* velocity += dt (force / mass + gravity), then at += dt velocity, then the floor. Returns how many blew up. */
    int64_t (*euler)(const push *p, const double *inverse_mass, vectors force, vectors gradient, vectors at,
                     vectors velocity, size_t begin, size_t end);
    /* Verlet's first half: at to the step's end, velocity to its middle, guess to its end. */
    void (*drift)(const push *p, vectors acceleration, vectors at, vectors velocity, vectors guess, size_t begin,
                  size_t end);
    /* Its second half: acceleration anew, velocity to the end, then the floor. */
    int64_t (*kick)(const push *p, const double *inverse_mass, vectors force, vectors gradient, vectors at,
                    vectors velocity, vectors acceleration, size_t begin, size_t end);
    /* The springs as the solver has them: dt^2 k and dt k_d; and what they make of a field of velocities. */
    void (*stiffen)(const springs *s, double dt_s, vectors at, stiff_slots out, size_t begin, size_t end);
    void (*resist)(const springs *s, stiff_slots k, vectors field, vectors out, size_t begin, size_t end);
    /* velocity += change, at += dt velocity, then the floor. Returns how many blew up. */
    int64_t (*settle)(const push *p, const double *inverse_mass, vectors change, vectors at, vectors velocity,
                      size_t begin, size_t end);
} softbody_kernels;

extern const softbody_kernels softbody_kernels_sse2, softbody_kernels_avx2, softbody_kernels_avx512;

typedef struct held_mass {
    uint32_t mass;
    vec3 offset;
} held_mass;
typedef struct grip {
    bool busy;
    vec3 at, target; /* where it is; where it is to be at the end of the step */
    held_mass *masses;
    size_t count;
} grip;

/* A script's hand: which key comes next, and which hand it is. */
typedef struct track_play {
    size_t next;
    int hand;   /* HAND_NONE: it holds nothing */
    vec3 where; /* it took hold */
    vec3 from;  /* offset at from_step, where its present way begins */
    uint64_t from_step;
} track_play;

struct softbody {
    softbody_settings set;
    springs net;
    softbody_spring *spring_list;
    size_t spring_count;
    mesh_triangle *faces;
    size_t face_count;
    double *mass_kg, *inverse_mass; /* inverse: 0 of held ones */
    vectors at, velocity, force, gradient;
    double *state;               /* at and velocity, for the kernel of forces */
    vectors acceleration, guess; /* verlet's */
    stiff_slots stiff;           /* implicit's, and its solver's vectors */
    vectors change, residual, direction, image;
    const vectors *damped; /* velocities with which forces are being found */
    double *sums;          /* by chunk */
    int64_t *bad;          /* by chunk */
    double volume_at_rest;
    double size; /* largest extent at the beginning */
    double stable_dt_s;
    uint64_t steps, substeps;
    bool has_acceleration; /* verlet: it is that of the present places */
    grip hands[SOFTBODY_HANDS_MAX];
    const hand_script *script;
    track_play *plays;
    const softbody_kernels *kernels;
    thread_team *workers;
    uint32_t *mass_of; /* the toy's: by vertex of its skin */
    int skin_level;    /* -1: it has none */
    push pushing;      /* of the present substep */
    double solver_dt_s, factor,
        pressing; /* implicit's: its step, the present multiple, and what the pressure makes of a field */
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

/* Calls work for each chunk, by whichever worker. */
typedef void chunk_work(softbody *b, size_t begin, size_t end, size_t chunk);
void softbody_for_chunks(softbody *b, chunk_work *work);
static inline size_t softbody_chunks(const softbody *b)
{
    return (b->net.stride + CHUNK - 1) / CHUNK;
}

/* An array of doubles for every mass, zero, 64-byte aligned; NULL when memory is out. */
double *softbody_array(size_t count);

/* The net of the toy, for softbody_create: arrays are the caller's (free), also mass_of by vertex of
 * generate_icosphere's mesh. */
typedef struct toy_net {
    size_t mass_count, spring_count, face_count;
    vec3 *position;
    softbody_spring *springs;
    mesh_triangle *faces;
    uint32_t *mass_of;
} toy_net;
status toy_net_create(const softbody_settings *s, toy_net *out, diagnostic *why);
void toy_net_release(toy_net *n);

/* Springs and rings by vertex. STATUS_BAD_INPUT when faces do not close around every vertex. */
status springs_build(springs *s, const softbody_net *net, diagnostic *why);
void springs_release(springs *s);

/* Forces of springs and the volume's gradient as the body lies, then the pressure. The damping is found with these
 * velocities: the body's own; verlet's guess; or none, which is what `change` has then. */
void softbody_find_forces(softbody *b, const vectors *velocity);
/* Volume by the gradient, which find_forces has just left. */
double softbody_volume_of_gradient(softbody *b);

/* Backward Euler: the change of velocities to b->change; pushing is set. False when it is not found. */
bool softbody_solve(softbody *b);

/* Sum of the chunks' sums, in their order. */
double softbody_sum(const softbody *b);

/* Hands: velocities of what they hold, for a step to their targets; keys of the script that are due before a step;
 * where they are to be after it. */
void softbody_aim_hands(softbody *b, double dt_s);
void softbody_land_hands(softbody *b);
status softbody_play(softbody *b, diagnostic *why);
