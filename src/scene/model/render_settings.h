/* The parameters render.*: how a scene is rendered. Integers, enums and switches (on/off) are int64_t, because the
 * parameter table has one type per kind of parameter. Plain values. */
#pragma once

#include "scene/model/integrators.h"
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef enum weights_rule { WEIGHTS_FRESNEL, WEIGHTS_CONSTANT } weights_rule;
typedef enum transmission_rule { TRANSMISSION_REFRACT, TRANSMISSION_SIMPLE } transmission_rule;
typedef enum depth_limit_rule { DEPTH_LIMIT_SKY, DEPTH_LIMIT_BLACK, DEPTH_LIMIT_MEAN } depth_limit_rule;
typedef enum radiance_rule { RADIANCE_CLASSIC, RADIANCE_BASIC } radiance_rule;
typedef enum shadow_rule { SHADOWS_OFF, SHADOWS_OPAQUE, SHADOWS_ATTENUATED } shadow_rule;
typedef enum caustics_rule { CAUSTICS_OFF, CAUSTICS_PHOTONS } caustics_rule;
typedef enum schedule_rule { SCHEDULE_COLUMNS, SCHEDULE_ROWS, SCHEDULE_TILES, SCHEDULE_DYNAMIC } schedule_rule;
typedef enum pin_rule { PIN_RULE_NONE, PIN_RULE_COMPACT, PIN_RULE_SCATTER } pin_rule;
typedef enum lighting_rule { LIGHTING_LAMBERT, LIGHTING_PHONG, LIGHTING_WHITTED } lighting_rule;
typedef enum spectrum_rule { SPECTRUM_RGB, SPECTRUM_SPECTRAL } spectrum_rule;
typedef enum sampler_rule { SAMPLER_PHILOX, SAMPLER_SOBOL } sampler_rule;
typedef enum pixel_filter { PIXEL_FILTER_CENTRE, PIXEL_FILTER_BOX } pixel_filter;
typedef enum light_sampling_rule { LIGHT_SAMPLING_ALL, LIGHT_SAMPLING_ONE } light_sampling_rule;
typedef enum texturing_rule { TEXTURING_PERSPECTIVE, TEXTURING_AFFINE } texturing_rule;

enum { SCENE_SAMPLES_MAX = 64 };
/* Ray trees end at DEPTH_TREE_MAX; random paths and photons may be longer (render.depth=unlimited). */
enum { DEPTH_TREE_MAX = 64, DEPTH_UNLIMITED = 1 << 30 };
#define SCENE_PIXELS_MAX 268435456 /* 2^28 */

typedef struct render_settings {
    int64_t width, height;    /* pixels */
    int64_t depth;            /* recursion depth, depth_limit of render/frame/tracers.c; 0: camera rays only;
                               DEPTH_UNLIMITED: only for random paths */
    int64_t samples;          /* per pixel: a square number, at most SCENE_SAMPLES_MAX */
    int64_t integrator;       /* integrator_rule */
    int64_t layer;            /* layer_rule: the layer that the film shows, for integrators that write layers */
    int64_t lighting;         /* lighting_rule */
    int64_t weights;          /* weights_rule */
    int64_t transmission;     /* transmission_rule */
    int64_t beyond;           /* depth_limit_rule */
    int64_t radiance;         /* radiance_rule */
    int64_t shadows;          /* shadow_rule */
    int64_t soft_shadows;     /* bool: rays of trees sample the lights that have a size */
    int64_t caustics;         /* caustics_rule */
    int64_t photons;          /* number of photons that the lamps emit, for caustics */
    double min_weight;        /* rays whose throughput (the product of the weights along their path) is lower in every
                               channel are not traced; 0: all rays are */
    int64_t paths;            /* per pixel, for the path integrator */
    double error;             /* target standard error of a pixel, path integrator; 0: render.paths everywhere */
    int64_t sampler;          /* sampler_rule: of the path integrator */
    int64_t filter;           /* pixel_filter: of the path integrator */
    int64_t light_sampling;   /* light_sampling_rule: of the path integrator */
    int64_t roulette;         /* 1: Russian roulette in the path integrator */
    int64_t seed;             /* of all random numbers */
    int64_t polarisation;     /* 1: rays carry Stokes vectors */
    int64_t spectrum;         /* spectrum_rule */
    int64_t wavelengths;      /* per camera ray, for the spectral film */
    int64_t bands, band;      /* no parameters: for a frame of cli/outputs_frames.c. bands > 0: the spectral film's
                               channels are not XYZ, but the mean spectral radiance in band, band + 1 and band + 2 of
                               that many equal bands, counted from 0 */
    double lambda_nm;         /* wavelength of the refractive indices of an RGB film */
    double unit_m;            /* length of one scene unit in metres */
    int64_t threads;          /* 1..1024; 0: see scene_threads */
    int64_t pool;             /* 1: persistent threads; 0: new threads for every frame */
    int64_t schedule;         /* schedule_rule */
    int64_t tile;             /* tile size, pixels */
    int64_t tiles_per_worker; /* minimum number of tiles per worker, for which tiles are halved; 0: no minimum */
    int64_t pin;              /* pin_rule */
    int64_t accel;            /* hierarchy_kind */
    int64_t build_threads;    /* threads that build hierarchies, 1..1024; 0: see scene_build_threads */
    int64_t keep;             /* 1: a mesh keeps its hierarchy; 0: every frame builds it again */
    /* a refitted hierarchy is rebuilt when its expected cost exceeds its cost at the last build by this factor */
    double rebuild;
    int64_t count_tests; /* 1: count the tests of hierarchies */
    int64_t texturing;   /* texturing_rule, for the rasteriser */
    /* 1: light that facets of rough surfaces reflect to one another is not lost; path integrator */
    int64_t energy_compensation;
} render_settings;

static inline const integrator_traits *integrator_traits_of(const render_settings *r)
{
    return &integrator_table[r->integrator];
}

/* Whether both branches at each interface are traced. */
static inline bool traces_ray_trees(const render_settings *r)
{
    return integrator_traits_of(r)->tree && r->lighting == LIGHTING_WHITTED;
}

enum { DEPTH_TEXT_MAX = 24 };

/* The depth as users write it, in text; needs no memory. */
static inline const char *render_depth_text(const render_settings *r, char text[DEPTH_TEXT_MAX])
{
    if (r->depth == DEPTH_UNLIMITED)
        return "unlimited";
    snprintf(text, DEPTH_TEXT_MAX, "%" PRId64, r->depth);
    return text;
}

/* Select the integrator to inspect a scene: whitted, with all branches of each ray; or zbuffer, a preview of
 * triangles. */
static inline void use_whitted(render_settings *r)
{
    r->integrator = INTEGRATOR_WHITTED;
    if (r->depth == DEPTH_UNLIMITED)
        r->depth = DEPTH_TREE_MAX;
}

static inline void use_zbuffer(render_settings *r)
{
    r->integrator = INTEGRATOR_ZBUFFER;
    if (r->depth == DEPTH_UNLIMITED)
        r->depth = DEPTH_TREE_MAX;
}

/* Worker threads of a frame: render.threads, or one per processing unit that the process may use now (its CPU affinity,
 * which taskset and a cgroup's cpuset restrict), at most 1024. */
int scene_threads(const render_settings *r);

/* Threads that build hierarchies: render.build_threads, or as many as without render.threads. */
int scene_build_threads(const render_settings *r);

/* Whether transparent surfaces use the material's constants as weights, not the Fresnel equations. */
static inline bool scene_has_constant_weights(const render_settings *r)
{
    return r->weights == WEIGHTS_CONSTANT || r->transmission == TRANSMISSION_SIMPLE;
}

/* Whether Whitted ray tracing or ray casting samples lights that have a size; random paths always do. */
static inline bool scene_has_soft_shadows(const render_settings *r)
{
    const integrator_traits *traits = integrator_traits_of(r);
    return r->soft_shadows && r->shadows != SHADOWS_OFF && !traits->by_chance && !traits->drawn && !traits->unlit;
}

/* Whether photons carry the light that mirrors and clear solids deflect; then radiance is basic, and shadows opaque. */
static inline bool scene_has_caustics(const render_settings *r)
{
    return r->caustics == CAUSTICS_PHOTONS && r->shadows != SHADOWS_OFF && !integrator_traits_of(r)->drawn &&
           !integrator_traits_of(r)->unlit;
}

/* Whether rays carry basic radiance, L / n^2. Only refraction changes solid angles: there is none under simple
 * transmission or with a depth buffer. */
static inline bool scene_has_basic_radiance(const render_settings *r)
{
    return (r->radiance == RADIANCE_BASIC || scene_has_caustics(r)) && r->transmission == TRANSMISSION_REFRACT &&
           !integrator_traits_of(r)->drawn;
}
