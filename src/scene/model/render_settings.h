/* How a scene is rendered: the parameters render.*. Integer and enum parameters are int64_t, switches (on/off) too: one
 * type a kind of parameter. Values. */
#pragma once

#include "scene/model/integrators.h"
#include "scene/model/layers.h"
#include <stdbool.h>
#include <stdint.h>

typedef enum weights_rule { WEIGHTS_FRESNEL, WEIGHTS_CONSTANT } weights_rule;
typedef enum transmission_rule { TRANSMISSION_REFRACT, TRANSMISSION_SIMPLE } transmission_rule;
typedef enum depth_limit_rule { DEPTH_LIMIT_SKY, DEPTH_LIMIT_BLACK, DEPTH_LIMIT_MEAN } depth_limit_rule;
typedef enum radiance_rule { RADIANCE_CLASSIC, RADIANCE_BASIC } radiance_rule;
typedef enum shadow_rule { SHADOWS_OFF, SHADOWS_OPAQUE, SHADOWS_ATTENUATED } shadow_rule;
typedef enum schedule_rule { SCHEDULE_COLUMNS, SCHEDULE_ROWS, SCHEDULE_TILES, SCHEDULE_DYNAMIC } schedule_rule;
typedef enum pin_rule { PIN_RULE_NONE, PIN_RULE_COMPACT, PIN_RULE_SCATTER } pin_rule;
typedef enum lighting_rule { LIGHTING_LAMBERT, LIGHTING_PHONG, LIGHTING_WHITTED } lighting_rule;
typedef enum spectrum_rule { SPECTRUM_RGB, SPECTRUM_SPECTRAL } spectrum_rule;
typedef enum texturing_rule { TEXTURING_PERSPECTIVE, TEXTURING_AFFINE } texturing_rule;

enum { SCENE_SAMPLES_MAX = 64 };
#define SCENE_PIXELS_MAX 268435456 /* 2^28 */

typedef struct render_settings {
    int64_t width, height; /* pixels */
    int64_t depth;         /* recursion depth; 0 = camera rays only */
    int64_t samples;       /* a pixel: a whole square, at most SCENE_SAMPLES_MAX */
    int64_t integrator;    /* integrator_rule */
    int64_t layer;         /* layer_rule: which one the film shows, of an integrator that gives layers */
    int64_t lighting;      /* lighting_rule */
    int64_t weights;       /* weights_rule */
    int64_t transmission;  /* transmission_rule */
    int64_t beyond;        /* depth_limit_rule */
    int64_t radiance;      /* radiance_rule */
    int64_t shadows;       /* shadow_rule */
    double min_weight;     /* children with a lower throughput in every channel are not traced; 0: all are */
    int64_t paths;         /* of the path tracer, a pixel */
    int64_t roulette;      /* 1: the path tracer ends faint paths by chance */
    int64_t seed;          /* of everything that is drawn by chance */
    int64_t polarisation;  /* 1: a ray carries its Stokes vector */
    int64_t spectrum;      /* spectrum_rule */
    int64_t wavelengths;   /* of the spectral film, a camera ray */
    double lambda_nm;      /* at which indices are taken where there is no spectrum */
    double unit_m;         /* length of one scene unit in metres */
    int64_t threads;       /* 1..1024 */
    int64_t pool;          /* 1: threads started beforehand; 0: fresh ones for every frame */
    int64_t schedule;      /* schedule_rule */
    int64_t tile;          /* tile edge, pixels */
    int64_t pin;           /* pin_rule */
    int64_t accel;         /* hierarchy_kind */
    int64_t build_threads; /* that build hierarchies; 0: one a processing unit */
    int64_t keep;          /* 1: a mesh keeps its hierarchy; 0: every frame builds them anew */
    /* a moving mesh's hierarchy is built anew when its expected cost has grown by more than this factor */
    double rebuild;
    int64_t texturing; /* texturing_rule, of the rasteriser */
} render_settings;

static inline const integrator_traits *integrator_traits_of(const render_settings *r)
{
    return &integrator_table[r->integrator];
}

/* Both branches of each ray are followed. */
static inline bool follows_trees(const render_settings *r)
{
    return integrator_traits_of(r)->tree && r->lighting == LIGHTING_WHITTED;
}

/* All branches of each ray, for what looks into a scene; or a preview of triangles. */
static inline void trace_trees(render_settings *r)
{
    r->integrator = INTEGRATOR_WHITTED;
}

static inline void draw_triangles(render_settings *r)
{
    r->integrator = INTEGRATOR_ZBUFFER;
}

/* Threads that build hierarchies: render.build_threads, or one a processing unit. */
int scene_build_threads(const render_settings *r);

/* Are the shares of a clear surface the material's own constants, whatever its index? */
static inline bool scene_has_constant_shares(const render_settings *r)
{
    return r->weights == WEIGHTS_CONSTANT || r->transmission == TRANSMISSION_SIMPLE;
}

/* Do rays carry basic radiance, L / n^2? Only light that is bent changes its solid angle: under simple transmission
 * nothing is, nor in what is drawn with a depth buffer. */
static inline bool scene_has_basic_radiance(const render_settings *r)
{
    return r->radiance == RADIANCE_BASIC && r->transmission == TRANSMISSION_REFRACT && !integrator_traits_of(r)->drawn;
}
