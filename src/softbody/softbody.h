/* A soft body of masses and springs: the slime toy. An icosahedron refined by bisection and projected on a sphere;
 * masses at its vertices, springs along its edges, across neighbouring faces (bending) and through the body; an
 * optional pressure that preserves its volume; gravity, a floor, and hands that grab parts of it.
 *
 * Forces on a mass, where x is the vector to the mass from the other end of a spring, v its velocity relative to that
 * end, and l the spring's length at rest: gravity m g; Hooke -k (|x| - l) x / |x|; damping -k_d (v.x) / (x.x) x;
 * pressure K (V0 - V) / V0 along each face's area vector, a third to each of its corners. Gravity and Hooke are eqs.
 * 2.1 and 2.2 of the slime report. Its damping, eq. 2.3, is printed with x / |x| in place of the last x: it decreases
 * with the spring's length and its k_d is in N s, whereas ours is k_d times the velocity along the spring, whatever
 * its length. (2.2 and 2.3 print x_j - x_i in the force on i, with which a stretched spring would push.) Forces are
 * summed per vertex in a fixed order, and sums over all vertices in blocks of fixed size: bit-identical for any number
 * of threads and any instruction set.
 *
 * Units: lengths in scene units, time in seconds, masses in kilograms; a force is kg scene units / s^2, called N here.
 * Ownership: *_create creates, *_destroy frees; scripts are borrowed. Errors: STATUS_BAD_INPUT for invalid settings
 * and for a diverged simulation, with the step and the quantity; STATUS_FAILURE if memory runs out. No global state;
 * one thread at a time for each body. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "base/vec3.h"
#include "geometry/mesh/mesh.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* euler: the slime report's step (eqs. 2.6 and 2.7), v += a dt, then x += v dt, so x gains a dt^2 per step, twice the
 * term of the closed form for constant acceleration (semi-implicit Euler; Hairer, Lubich, Wanner, "Geometric Numerical
 * Integration", I.1.2; order 1). verlet: velocity Verlet (Swope et al., J. Chem. Phys. 76, 1982; order 2). implicit:
 * backward Euler, linearised once per step and solved by conjugate gradients (Baraff and Witkin, "Large steps in cloth
 * simulation", SIGGRAPH 1998; order 1, stable for stiff springs, loses energy). */
typedef enum softbody_integrator { SOFTBODY_EULER, SOFTBODY_VERLET, SOFTBODY_IMPLICIT } softbody_integrator;

enum { SOFTBODY_LEVEL_MAX = 7, SOFTBODY_HANDS_MAX = 16 };
#define SOFTBODY_MASS_MIN_KG 1e-6
#define SOFTBODY_DT_MIN_S 1e-9

typedef struct softbody_settings {
    int64_t level;    /* 0..7: 10 * 4^level + 2 masses */
    double radius;    /* of the sphere at rest, scene units */
    vec3 position;    /* of its centre at time 0 */
    vec3 velocity;    /* of the whole body at time 0, scene units / s */
    double mass_kg;   /* of the whole body, at least 1e-6; divided equally among the vertices */
    double stiffness; /* k of each spring along an edge, N / scene unit */
    double bending;   /* k of each spring across two neighbouring faces, between their opposite corners */
    double through;   /* sum of k over all springs through the body, divided equally */
    /* k_d of each spring along an edge, N s / scene unit; that of other springs is proportional to their k */
    double damping;
    double pressure; /* K: pressure at zero volume, N / scene unit^2 */
    vec3 gravity;    /* scene units / s^2 */
    int64_t ground;  /* 1: a floor at ground_y, which only masses in hands can pass */
    double ground_y;
    double restitution; /* 0..1: fraction of the normal speed after a bounce */
    double friction;    /* friction coefficient (Coulomb) on the floor */
    int64_t integrator; /* softbody_integrator */
    double dt_s;        /* time step */
    int64_t adaptive; /* 1: a step is split until it is stable and the length of no spring changes by more than a tenth
                         per substep */
    int64_t threads;  /* 1..1024; at most one is started per 4096 masses */
} softbody_settings;

/* Checks the ranges of the settings. The diagnostic names the field. */
status softbody_check(const softbody_settings *s, diagnostic *why);

typedef struct softbody softbody;

/* The toy. level: instruction set, isa_best() or lower. */
status softbody_create(const softbody_settings *s, isa level, softbody **out, diagnostic *why);
void softbody_destroy(softbody *b);

/* Creates a body from any net of masses and springs, for comparison with closed forms: level, radius, position,
 * stiffness .. damping of the settings are ignored, each vertex has its own mass. Faces (of a closed surface) are
 * needed for pressure only. */
typedef struct softbody_spring {
    uint32_t end[2];
    double rest, stiffness, damping;
} softbody_spring;
typedef struct softbody_net {
    size_t mass_count, spring_count, face_count;
    const vec3 *position;
    const vec3 *velocity;  /* NULL: settings.velocity for all */
    const double *mass_kg; /* by vertex */
    const softbody_spring *springs;
    const mesh_triangle *faces;
} softbody_net;
status softbody_create_net(const softbody_net *net, const softbody_settings *s, isa level, softbody **out,
                           diagnostic *why);

/* --- scripts of hands ---
 *
 * Recorded hands: what is grabbed, where it is moved, when it is released; playback is bit-identical. A script has a
 * track for each hand. Ownership: hand_script_create creates an empty one, hand_script_add appends, hand_script_destroy
 * releases. Times of a track do not decrease; between a grab and a release the hand moves linearly from key to key. */

typedef enum hand_act { HAND_GRAB, HAND_MOVE, HAND_RELEASE } hand_act;

typedef struct hand_key {
    double time_s;
    hand_act act;
    vec3 origin, direction; /* of a grab: the grab ray in the frame of the body's mesh */
    double reach;           /* of a grab: radius around the hit of the ray with the surface; scene units */
    vec3 by;                /* of a move: displacement from the point of the grab at time_s */
    long line, column;      /* location in its file */
} hand_key;

enum { HAND_NAME_MAX = 63 };
typedef struct hand_track {
    char name[HAND_NAME_MAX + 1];
    hand_key *keys;
    size_t key_count;
} hand_track;

typedef struct hand_script {
    char *path; /* path of its file; "" for none */
    hand_track *tracks;
    size_t track_count;
} hand_script;

/* NULL if memory runs out. path is copied. */
hand_script *hand_script_create(const char *path);
void hand_script_destroy(hand_script *s); /* NULL is allowed */

/* Appends a key to the hand's track, which is created with its first key. STATUS_BAD_INPUT: more hands than
 * SOFTBODY_HANDS_MAX, a time before the previous key, a move or release of a hand without a grab, a grab of a hand that
 * already holds something; the script is then unchanged. The diagnostic is not located. */
status hand_script_add(hand_script *s, const char *hand, const hand_key *key, diagnostic *why);

/* Time of the last key of all tracks; 0 if there is none. */
double hand_script_end_s(const hand_script *s);

/* --- time --- */

/* Attaches a script, borrowed for the life of the body, before the first step. NULL, at any time: detaches it, and its
 * hands release what they hold. STATUS_FAILURE if memory runs out. */
status softbody_follow(softbody *b, const hand_script *script, diagnostic *why);

/* One step of dt_s. STATUS_BAD_INPUT if the simulation diverges (the diagnostic has the step, the vertex and the
 * quantity; the state is kept, and further steps report the divergence again until softbody_place), if the step would
 * require more than 10000 substeps, if the implicit solver does not converge, and if a hand of the script grabs nothing
 * (located in the script). */
status softbody_step(softbody *b, diagnostic *why);

/* Steps until the multiple of dt_s nearest to time_s; does nothing if that time has passed. */
status softbody_advance(softbody *b, double time_s, diagnostic *why);

/* --- hands, without a script --- */

/* First hit of a ray with the surface, from outside; false if it misses. direction is not zero. */
bool softbody_pick(const softbody *b, vec3 origin, vec3 direction, vec3 *where);
/* Grabs all masses within reach of a point that are in no other hand; if there are none, the nearest mass that is in
 * no other hand. Returns the hand's number; HAND_NONE if all hands are in use or hold all masses, HAND_NO_MEMORY if
 * memory runs out. */
enum { HAND_NONE = -1, HAND_NO_MEMORY = -2 };
int softbody_grab(softbody *b, vec3 where, double reach);
/* Moves the hand to this position (initially `where`) linearly during the next step. */
void softbody_hold(softbody *b, int hand, vec3 target);
void softbody_release(softbody *b, int hand);

/* --- state --- */

typedef struct softbody_quantities {
    double time_s;
    uint64_t steps, substeps;
    double kinetic, elastic, compression,
        gravity; /* energies, N scene units; of the springs, of the pressure, of gravity (0 at the origin) */
    vec3 momentum, angular_momentum; /* about the origin */
    vec3 center;                     /* centre of mass */
    double volume, volume_at_rest;   /* scene units^3; 0 without faces */
    double speed_max;                /* of any mass */
    double low, high;                /* smallest and largest y of the masses */
    size_t held;                     /* masses in hands */
} softbody_quantities;
softbody_quantities softbody_measure(const softbody *b);

size_t softbody_mass_count(const softbody *b);
size_t softbody_spring_count(const softbody *b);
void softbody_positions(const softbody *b, vec3 *out);
void softbody_velocities(const softbody *b, vec3 *out);
/* Sets positions and velocities of the masses; rest lengths and time are unchanged. A diverged body is valid again. */
void softbody_place(softbody *b, const vec3 *positions, const vec3 *velocities);

/* An estimate of a stable dt_s near rest (implicit: the estimate of euler): 2 / omega without damping, where omega^2 is
 * at most twice the largest sum of k over a mass (Gershgorin) plus the pressure's contribution; damping reduces it,
 * more so for verlet. The true limit is somewhat larger. */
double softbody_stable_dt_s(const softbody *b);

/* --- surface --- */

/* A closed mesh of the current surface with normals (sums of the faces' area vectors) and texture coordinates. The
 * caller owns it. For the toy only. */
status softbody_surface(const softbody *b, mesh **out, diagnostic *why);
/* Updates a mesh made by softbody_surface for this body to the current state; it must not be in use meanwhile
 * (mesh_move). */
status softbody_move_surface(const softbody *b, mesh *surface, diagnostic *why);
