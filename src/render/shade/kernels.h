/* The kernels of shading and of sampling: operations on a group of rays, loops without per-ray branches, compiled
 * once for each instruction set. Shading kernels: colours, Phong's light, branches, light in film units.
 * Sampling kernels: random numbers, and the camera rays, directions and points of lamps that are chosen by them.
 * Ownership: the caller owns all arrays, of at most ROW elements (the tracer's scratch); nothing fails. */
#pragma once

#include "base/isa.h"
#include "geometry/rays.h"
#include "image/texture.h"
#include "render/plan/plan.h"
#include "render/tracer/groups.h"
#include "render/tracer/integrator.h"

/* --- shading --- */

typedef struct cut_sum {
    int64_t branches, throughput[3];
} cut_sum;

typedef struct shade_kernels {
    /* The material's colour at the group's points; p: the primitive in whose frame the checker cells are. */
    void (*color)(const material *m, const primitive *p, group *g);
    /* Phong's direct light of one light at every point, weighted by the throughput. */
    void (*direct)(const material *m, const light *lamp, const group *g, lit_group *lit);
    /* Multiplies the light in lit by the fraction that the cone emits towards each point. */
    void (*spot)(const light_cone *c, bool soft, const group *g, lit_group *lit);
    /* Reflected and refracted directions with Fresnel weights at a clear surface, also a half mirror, which reflects a
     * fraction of what would be transmitted: R' = R + (1 - R) reflectivity. */
    void (*fresnel_branches)(const material *m, const group *g, branch_group *b);
    /* fresnel_branches with the material's constant weights, also for opaque surfaces. */
    void (*constant_branches)(const material *m, bool opaque, const group *g, branch_group *b);
    /* Undeflected transmission at a clear surface, with the material's constant weights. */
    void (*straight_branches)(const material *m, const group *g, branch_group *b);
    /* Adds branches that the depth limit cuts off to *sum: their number, and their throughput in units of
     * 1/COUNTERS_CUT_ONE. */
    void (*cut)(const group *g, const branch_group *b, cut_sum *sum);
    /* Light of a group in film units. own_light: radiance times the surface's colour. cut_light: radiance, equal in all
     * directions, weighted by the branches that the depth limit cuts off. */
    void (*own_light)(const group *g, vec3 radiance, film_light *out);
    void (*cut_light)(const group *g, const branch_group *b, vec3 radiance, film_light *out);
    /* Fractions of the rays' radiance, in film units. */
    void (*arrived)(int count, const double *fraction, const double *r, const double *g, const double *b,
                    film_light *out);
    /* Transmittances of optical depths, in place: 1 for 0. */
    void (*absorb)(double *depth, int count);
    texture_tinter *tint; /* a texture's colours */
} shade_kernels;

ISA_DECLARE(const shade_kernels, shade_kernels)

/* --- sampling --- */

/* Points on the lens as uniform random numbers: the fraction of the lens's area within the point's radius, and its
 * angle as a fraction of a turn. */
typedef struct lens_points {
    const double *area, *turn;
} lens_points;

typedef struct camera_rays_out {
    double *ox, *oy, *oz, *dx, *dy, *dz;
} camera_rays_out;

/* Points of spheres, as seen from the points of a group. */
typedef struct sphere_samples {
    double x[ROW], y[ROW], z[ROW], radius[ROW]; /* the sphere; its centre relative to the point */
    double u[ROW], v[ROW];                      /* random numbers */
    /* Results: the unit direction, uniform over the cone that the sphere fills; 1 - the cosine of the cone's half
     * angle; the distance to the sphere; the cosine to the normal, 0 from within the sphere. */
    double dx[ROW], dy[ROW], dz[ROW], cap[ROW], reach[ROW], n_l[ROW];
} sphere_samples;

/* Continuations of a group's paths, by lane. */
typedef struct continuations {
    double dx[ROW], dy[ROW], dz[ROW], r[ROW], g[ROW], b[ROW]; /* r, g, b: factors of the throughput */
    uint64_t inside[ROW];
    int64_t sample_key[ROW], exists[ROW], refracted[ROW]; /* the last two are masks */
} continuations;

/* The lights' parameters as arrays, padded to full blocks with lights of strength 0. */
enum { LAMP_BLOCK = 8, LAMPS_MAX = (SCENE_LIGHTS_MAX + LAMP_BLOCK - 1) / LAMP_BLOCK * LAMP_BLOCK };
typedef struct lamp_table {
    int blocks;
    bool cones; /* some cone lights are points */
    bool suns;  /* some are suns, whose strength in this table is 0: light_sampling.c weighs them */
    double x[LAMPS_MAX], y[LAMPS_MAX], z[LAMPS_MAX];
    float radius[LAMPS_MAX], strength[LAMPS_MAX]; /* intensity; with falloff, times the square of the reach */
    float even[LAMPS_MAX], falling[LAMPS_MAX];    /* 1 and 0 for a light without falloff, otherwise 0 and 1 */
} lamp_table;

typedef struct sampling_kernels {
    /* path_draw for each sample key. */
    void (*draw)(const path_sampling *p, int count, const int64_t *sample_key, int depth, int purpose, double *u,
                 double *v);
    /* --- camera rays --- */
    /* Directions of the rays of a perspective pinhole camera through the image points (u, v). */
    void (*camera_directions)(const camera_frame *view, int count, const double *u, const double *v, double *dx,
                              double *dy, double *dz);
    /* Rays of any camera. A lens radius of 0 gives the chief rays. */
    void (*camera_rays)(const camera_frame *view, int count, const double *u, const double *v, lens_points lens,
                        camera_rays_out out);
    /* --- directions from a group's points --- */
    /* Unit directions about the normals of g's points by the cosine law. */
    void (*cosine)(const group *g, const double *u, const double *v, double *dx, double *dy, double *dz);
    void (*spheres)(const group *g, sphere_samples *s);
    /* The light of one sphere that is equally bright from all sides, from the points of s: k_d is the diffuse
     * reflectance, shine the highlight. contributes: where the sphere is above the horizon. */
    void (*sphere_light)(const group *g, const sphere_samples *s, double radiance, vec3 color, double k_d,
                         const double *shine, lit_group *lit);
    /* --- continuations of paths that meet no photons --- */
    /* At a clear surface one of two branches by a random number in (0, 1), with the sum of their weights. */
    void (*choose_branches)(const group *g, const branch_group *b, const double *chance, continuations *c);
    /* From a matte surface, with directions that are in c. */
    void (*leave_matte)(const group *g, double diffuse, continuations *c);
    /* Sets near[i] to -1 if ray i passes within the radius of a centre, or just misses, else to 0; returns whether any
     * is -1. */
    bool (*near_sphere)(const ray_batch *rays, vec3 centre, double radius, int64_t *near);
    /* An estimate of each light's contribution at a point with normal n, for the choice of a light: weight[blocks *
     * LAMP_BLOCK]. Lights below the horizon have weight 0, unless n is 0 and `least` is below 0. */
    void (*light_weights)(const lamp_table *lamps, vec3 point, vec3 n, float k_d, float k_s, float least,
                          float *weight);
} sampling_kernels;

ISA_DECLARE(const sampling_kernels, sampling_kernels)

/* --- the camera rays of a pixel's samples (render/camera/camera_rays.c): functions of the tracer --- */

/* The camera rays of each pixel: one per sample; with a spectral film, one per sample and wavelength. */
camera_sampling camera_samples(const render_settings *r);

/* Enqueues rays first .. first + count - 1 of a row of pixels that starts at x0. */
void camera_rays_enqueue(tracer *t, int y, int x0, int64_t first, int count);

/* The chief rays of any camera, through the image points (u, v). */
void camera_chief_rays(const tracer *t, int count, const double *u, const double *v, camera_rays_out out);
