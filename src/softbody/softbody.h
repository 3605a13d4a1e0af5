/* A soft body of masses and springs: the slime toy. An icosahedron refined by bisection and blown up to a sphere;
 * masses at its vertices, springs along its edges, across neighbouring faces (bending) and from side to side through
 * the body; an optional pressure that holds its volume; gravity, a floor, and hands that hold parts of it.
 *
 * Forces on a mass, x to it from the other end of a spring, v its velocity against that end, l the length at rest:
 *   gravity m g; Hooke -k (|x| - l) x / |x|; damping -k_d (v.x) / (x.x) x; pressure K (V0 - V) / V0 along each face's
 *   area, a third to
 *   each of its corners.
 * Gravity and Hooke are eqs. 2.1 and 2.2 of the slime report. Its damping, eq. 2.3, is printed with x / |x| in place of
 * the last x: it falls with the spring's length and its k_d is in N s, where ours is k_d times the velocity along the
 * spring, whatever its length. (2.2 and 2.3 print x_j - x_i in the force on i, with which a drawn spring would push.)
 * They are gathered a vertex at a time, in one fixed order, and sums over all vertices go by blocks of fixed size: the
 * same bits for any number of threads and any instruction set.
 *
 * Units: lengths in scene units, time in seconds, masses in kilograms; a force is kg scene units / s^2, called N here.
 * Ownership: *_create gives, *_destroy releases; scripts are borrowed. Errors: STATUS_BAD_INPUT for settings that make
 * no body and for one that blows up, with the step and the quantity; STATUS_FAILURE when memory is out. No global
 * state; one caller at a time for each body. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "base/vec3.h"
#include "geometry/mesh.h"
#include "softbody/hand.h"
#include <stdbool.h>
#include <stdint.h>

/* euler: the slime report's step (eqs. 2.6 and 2.7), v += a dt, then x += v dt, so x gets a dt^2 where the closed form
 * of constant acceleration has half of that (semi-implicit Euler; Hairer, Lubich, Wanner, "Geometric Numerical
 * Integration", I.1.2; order 1). verlet: velocity Verlet (Swope et al., J. Chem. Phys. 76, 1982; order 2). implicit:
 * backward Euler, linearised once a step and solved by conjugate gradients (Baraff and Witkin, "Large steps in cloth
 * simulation", SIGGRAPH 1998; order 1, stable for stiff springs, loses energy). */
typedef enum softbody_integrator { SOFTBODY_EULER, SOFTBODY_VERLET, SOFTBODY_IMPLICIT } softbody_integrator;

enum { SOFTBODY_LEVEL_MAX = 7, SOFTBODY_HANDS_MAX = 16 };
#define SOFTBODY_MASS_MIN_KG 1e-6
#define SOFTBODY_DT_MIN_S 1e-9

typedef struct softbody_settings {
    int64_t level;    /* 0..7: 10 * 4^level + 2 masses */
    double radius;    /* of the sphere at rest, scene units */
    vec3 position;    /* of its centre at time 0 */
    vec3 velocity;    /* of all of it at time 0, scene units / s */
    double mass_kg;   /* of all of it, at least 1e-6; each vertex has the same share */
    double stiffness; /* k of each spring along an edge, N / scene unit */
    double bending;   /* k of each spring across two neighbouring faces, between the corners that they do not share */
    double through;   /* sum of k over all springs from side to side; each has the same share */
    /* k_d of each spring along an edge, N s / scene unit; the others have it in proportion to their k */
    double damping;
    double pressure; /* K: pressure at no volume, N / scene unit^2 */
    vec3 gravity;    /* scene units / s^2 */
    int64_t ground;  /* 1: a floor at ground_y, which it cannot pass but where a hand draws it through */
    double ground_y;
    double restitution; /* 0..1: share of the speed against the floor with which it comes back */
    double friction;    /* coefficient of Coulomb's law on the floor */
    int64_t integrator; /* softbody_integrator */
    double dt_s;        /* one step */
    int64_t adaptive; /* 1: a step is split until it is stable and the ends of no spring move against each other by more
                         than a tenth of its length */
    int64_t threads;  /* 1..1024, of which at most one for each 4096 masses is started */
} softbody_settings;

/* Ranges, and that there is a body. The diagnostic names the field. */
status softbody_check(const softbody_settings *s, diagnostic *why);

typedef struct softbody softbody;

/* The toy. level of instructions: isa_best() or lower. */
status softbody_create(const softbody_settings *s, isa level, softbody **out, diagnostic *why);
void softbody_destroy(softbody *b);

/* Any net of masses and springs, for what is checked against closed forms: level, radius, position, stiffness ..
 * damping of the settings mean nothing then, a mass of its own for each vertex. Faces (all springs' net is closed) are
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

/* --- time --- */

/* What the hands do; borrowed as long as the body lives. Before the first step. NULL, at any time: no more, and what
 * its hands hold they let go. STATUS_FAILURE when memory is out. */
status softbody_follow(softbody *b, const hand_script *script, diagnostic *why);

/* One step of dt_s. STATUS_BAD_INPUT when the body blows up (the diagnostic says at which step, which vertex and which
 * quantity; the body then stays as it is), and where a hand of the script takes hold of nothing (located in the
 * script). */
status softbody_step(softbody *b, diagnostic *why);

/* Steps until the time nearest to time_s that is a whole number of steps; nothing when that has been. */
status softbody_advance(softbody *b, double time_s, diagnostic *why);

/* --- hands, for who has no script --- */

/* Where a ray first meets the skin, from outside; false where it misses. direction is not zero. */
bool softbody_pick(const softbody *b, vec3 origin, vec3 direction, vec3 *where);
/* Takes hold of what lies within reach of a point and is in no other hand, or else of the nearest such mass. The hand's
 * number; HAND_NONE when all hands are full or hold all of it, HAND_NO_MEMORY when memory is out. */
enum { HAND_NONE = -1, HAND_NO_MEMORY = -2 };
int softbody_grab(softbody *b, vec3 where, double reach);
/* The hand moves to this place (its own starting place was `where`) in a straight line during the next step. */
void softbody_hold(softbody *b, int hand, vec3 target);
void softbody_release(softbody *b, int hand);

/* --- looking --- */

typedef struct softbody_account {
    double time_s;
    uint64_t steps, substeps;
    double kinetic, elastic, compression,
        gravity; /* energies, N scene units; of the springs, of the pressure, in the field (from y = 0) */
    vec3 momentum, angular_momentum; /* about the origin */
    vec3 center;                     /* of mass */
    double volume, volume_at_rest;   /* scene units^3; 0 without faces */
    double speed_max;                /* of any mass */
    double low, high;                /* smallest and largest y of any mass */
    size_t held;                     /* masses in hands */
} softbody_account;
softbody_account softbody_measure(const softbody *b);

size_t softbody_mass_count(const softbody *b);
size_t softbody_spring_count(const softbody *b);
void softbody_positions(const softbody *b, vec3 *out);
void softbody_velocities(const softbody *b, vec3 *out);
/* Puts the masses elsewhere and gives them speeds; lengths at rest and time stay. A body that blew up is good again
 * then. */
void softbody_place(softbody *b, const vec3 *positions, const vec3 *velocities);

/* A dt_s that the integrator (backward Euler: euler) is stable with near rest: 2 / omega without damping, where omega^2
 * is at most twice the largest sum of a mass's springs' k over it (Gershgorin) and the pressure's share besides;
 * damping shortens it, verlet's more. The true limit is somewhat longer. */
double softbody_stable_dt_s(const softbody *b);

/* --- the skin --- */

/* A closed mesh with normals (sums of the faces' area vectors) and texture coordinates, as the body lies now. The
 * caller is its owner. Of the toy alone. */
status softbody_surface(const softbody *b, mesh **out, diagnostic *why);
/* Moves a mesh that softbody_surface made for this body to where that lies now; no one looks at it meanwhile
 * (mesh_move). */
status softbody_move_surface(const softbody *b, mesh *skin, diagnostic *why);
