/* The tracer's inside, shared by tracer.c (which rays when) and shading.c (what becomes of rays that met a surface). */
#ifndef CUVETTE_RENDER_CORE_TRACER_PRIVATE_H
#define CUVETTE_RENDER_CORE_TRACER_PRIVATE_H

#include "geometry/forest.h"
#include "render/shade/shade.h"
#include "render/core/ticket.h"
#include "render/core/tracer.h"
#include "render/zbuffer/zbuffer.h"

/* Stokes vectors relative to their first element, of a group and of its two branches. */
typedef struct polar_group {
    double q[ROW], u[ROW], v[ROW], rq[ROW], ru[ROW], rv[ROW], tq[ROW], tu[ROW], tv[ROW];
} polar_group;

/* What meshes need, once a scene with meshes has been traced. */
typedef struct mesh_work {
    mesh_scratch scratch;
    forest_hit hits[ROW]; /* of the gathered group */
    mesh_points points;
    group corner; /* Gouraud's: the group with a corner of each triangle in place of the point */
    lit_group corner_light;
} mesh_work;

/* What a drawn frame needs: a square of the depth buffer, and of each ray of the batch the point of the grid and the
 * triangle there. */
typedef struct drawn_work {
    zbuffer_square square;
    int x[ROW], y[ROW];
    uint32_t number[ROW];
    bool straight[ROW];               /* it meets a curved surface and looks straight on */
    double vx[ROW], vy[ROW], vz[ROW]; /* and the straight view's direction there, of a frame with layers */
    vec3 at[ROW]; /* of the gathered group: where a texture is looked up that runs straight across the picture */
} drawn_work;

/* What basic radiance needs, once a scene of it has been traced. */
typedef struct radiance_work {
    ray_crossings crossings;
    ray_batch rays;                   /* the shadow rays that crossings are noted of, ... */
    const int64_t *tickets;           /* ... their tickets, ... */
    double through[ROW];              /* ... and the product of the interfaces' transmittances, by ray */
    double kept[CROSSINGS_MAX];       /* transmittances, by crossing */
    double wr[ROW], wg[ROW], wb[ROW]; /* the gathered group's throughput, while what its surface sends out is weighed */
    surface_batch points;
    mesh_points on_mesh;
} radiance_work;

struct tracer {
    const geometry_kernels *geometry;
    const shade_kernels *shade;
    tracer_target target;
    int depth_limit, queue_count;
    ray_queue *waiting; /* by depth, 0 .. depth_limit */
    ray_queue shadows;
    bool branching;      /* reflected and refracted rays are followed */
    double least_weight; /* a branch that weighs less is not followed: render.min_weight, for its share of the camera
                            ray */
    bool by_ticket;      /* the film wants more of a ticket than its pixel */
    ray_counters counters;
    int64_t visibility_ns;            /* of a scene with meshes: in the geometry's kernels */
    uint64_t frame;                   /* of its tracer_set, in which it was last begun; 0 before */
    int64_t overflow;                 /* negative: a sum or contribution left the film's range */
    _Alignas(64) ray_scratch scratch; /* whole vectors on whole cache lines, here and below */
    _Alignas(64) hit_batch hits;
    _Alignas(64) group gathered;
    _Alignas(64) lit_group lit;
    _Alignas(64) branch_group branches;
    _Alignas(64) double transmitted[ROW];
    int list[PRIMITIVES_MAX + 2][ROW], listed[PRIMITIVES_MAX + 2]; /* see sort_by_primitive */
    const int64_t *ways_tickets;                                   /* of the batch whose ways are noted */
    ray_ways *ways;                                                /* once a scene that absorbs has been traced */
    double kept[3][ROW]; /* of an arrangement that absorbs: share of light that the way to the hit left, by channel */
    polar_group polar;
    mesh_work *meshes;           /* see mesh_work; NULL before */
    const surface_look *look;    /* of the gathered group */
    bool on_mesh;                /* the gathered group met one */
    int met_light[ROW];          /* of random paths: the light that a ray ran into, or -1 */
    drawn_work *drawn;           /* once a frame has been drawn; NULL before */
    radiance_work *basic;        /* of a plan with basic radiance; NULL in others */
    radiance_work *basic_memory; /* once one has been traced */
    bool straight;               /* the frame is drawn, its textures straight across the picture */
};

/* A build without counters compiles the statement and throws it away. */
#define COUNT(statement) ((void)(CUVETTE_COUNTERS ? (statement) : 0))

/* Runs one batch of a queue (depth -1: shadow rays), and gives each pixel its share of the time and its rays if that is
 * wanted. */
void tracer_run_batch(tracer *t, int depth);

/* Puts the camera rays of one pixel of an rgb film in line; returns how many. */
int tracer_camera_rays(tracer *t, int x, int y);

/* camera_rays.c: how many camera rays a pixel has; rays first .. first + count - 1 of a row of pixels from x0 on. */
int64_t camera_rays_a_pixel(const render_settings *r);
void camera_rays_put_in_line(tracer *t, int y, int x0, int64_t first, int count);

/* mesh_shading.c: points of the gathered group on a mesh; the light and the branches that its triangles do not let
 * through; Gouraud's light; which directions lead out of the triangle of record k; and how the group's list falls into
 * faces that look alike. */
void mesh_surface(tracer *t, int rank, const int *list);
void mesh_bound_light(tracer *t);
void mesh_bound_branches(tracer *t);
bool mesh_lets_out(const tracer *t, int k, vec3 direction);
bool mesh_has_corner_light(const tracer *t, int rank);
void mesh_corner_light(tracer *t, const material *m, const light *lamp, int rank);
int mesh_next_look(const tracer *t, int *list, int count, int *slot);

/* texture_shading.c: the look's picture times the gathered group's colours. */
void texture_colors(tracer *t, const primitive *surface);

/* zbuffer_shading.c: t->hits of a batch of camera rays, as drawn; texture points or coordinates of the gathered group
 * straight across the picture. */
void drawn_hits(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays);
void drawn_bend(tracer *t, const int *list);
void drawn_branches(tracer *t, int depth);
void drawn_straighten(tracer *t, const int *list);

/* Adds radiance to a ticket's pixel. Of a spectral film the three channels are one: radiance at the ticket's
 * wavelength. */
void shading_expose(tracer *t, int64_t ticket, double r, double g, double b);

/* Adds what the sky sends along a direction, weighted. */
void shading_expose_sky(tracer *t, int64_t ticket, vec3 direction, double wr, double wg, double wb);
/* What a branch that the depth limit cuts off brings: render.beyond. */
void shading_expose_beyond(tracer *t, int64_t ticket, vec3 direction, double wr, double wg, double wb);

/* Does no light pass the surface of that rank's body with the tracer's look? */
static inline bool surface_is_opaque(const tracer *t, int rank)
{
    return t->target.scene->solids->bodies[rank].opaque || t->look->surface.transparency == 0.0;
}

/* Local light of the lights and the ambient, weighted, of the gathered group. */
void local_light(tracer *t, int rank);

/* Branches of the gathered group at a surface: directions, weights. */
void shading_branches(tracer *t, bool opaque);

/* Puts a kind of children in line, with tickets as the gathered ones'. Returns how many there are. */
int put_children_in_line(tracer *t, int depth, const double *dx, const double *dy, const double *dz,
                         const double *weight, const uint64_t *inside);

/* absorption.c: what the media on the way leave, from the stretches of the batch just looked at, which is announced
 * before; and a batch of rays dimmed by it. Of a batch that looked for its nearest interfaces, the surroundings are to
 * be spared first on ways to the sky. */
void absorption_spare_sky(tracer *t);
void absorption_begin(tracer *t, const int64_t *tickets, int count);
void absorption_dim(tracer *t, ray_queue *q, int first, int count);
double absorption_left(double optical_depth);

/* radiance.c: how much of what is sent out into the medium of a rank reaches an eye as radiance, (n_eye / n)^2; the
 * gathered group's throughput times that, and back again; and the transmittances of the interfaces that a batch of
 * shadow rays crosses, taken from t->transmitted. */
double radiance_share(const plan *p, int64_t ticket, int rank);
void radiance_weigh(tracer *t);
void radiance_weigh_back(tracer *t);
void radiance_begin_shadows(tracer *t, const ray_batch *rays, const int64_t *tickets);
void radiance_end_shadows(tracer *t);

/* spectral.c: the gathered group's indices, colours and light at each ray's wavelength. */
void spectral_indices(tracer *t, const int *list);
void spectral_colors(tracer *t, int rank);
void spectral_light(tracer *t, int lamp);

/* polarised.c: the group's Stokes vectors, and what an interface makes of weights and vectors. */
void polarised_gather(tracer *t, const ray_queue *q, int first, const int *list);
void polarised_branches(tracer *t, const material *m, bool opaque);

/* path.c: one random continuation of each of the gathered group's rays, and light that is looked for at opaque
 * surfaces; the lights that rays of a batch run into before they hit anything. */
void path_group(tracer *t, int depth, int rank);
void path_meet_lights(tracer *t, const ray_queue *q, int first, int count);
void path_expose_light(tracer *t, int64_t ticket, int lamp, int rank, vec3 direction, double wr, double wg, double wb);

/* Shades rays list[0 .. count-1] of the batch at `first` in the queue of a depth, all of which met primitive `met` as
 * the surface of the body of that rank: local light, shadow rays and children put in line. */
void shading_group(tracer *t, int depth, int first, int met, int rank, const int *list, int count);

#endif
