/* The rays of a scene's beams, traced by the probe like the rays of `cuvette trace` and `cuvette fan`; screens that
 * they cross; and the beams drawn into an image. Ownership: everything that a visitor receives is borrowed for the
 * call; the caller owns a screen's bins and releases them with beam_screen_release. */
#pragma once

#include "image/image.h"
#include "render/inspect/probe.h"
#include "scene/model/lights.h"

typedef struct beam_ray {
    int beam;         /* index in the scene's beams */
    int field;        /* number of its field point, from 0, row by row */
    int number, rays; /* this ray's number, from 0, and the number of rays, equal for every wavelength and field */
    double lambda_nm;
    double power; /* at the ray's start: the beam's power divided by the numbers of its rays, wavelengths and fields */
} beam_ray;

/* Receives the tree of a ray, without shadow rays; for a beam without branches it is a path, each node the child of the
 * one before. Any status but STATUS_OK ends the visits. */
typedef status beam_visit(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why);

/* Visits all rays of the visible beams, in order of beam, field point, wavelength and number. Returns STATUS_BAD_INPUT
 * for a tree of more than PROBE_NODES_MAX rays; there is no limit of beams and rays. It can be cancelled at every ray.
 * rays: rays per beam, field point and wavelength; 0: each beam's number. The scene's files must be loaded. */
status beams_each_ray(const scene *s, isa level, int rays, beam_visit *visit, void *context, diagnostic *why);

/* The rays of a tree that were not traced, for one reason: RAY_END_CUT_DEPTH or RAY_END_CUT_WEIGHT. weight: the sum of
 * their fractions of the first ray's light. */
typedef struct ray_cut {
    size_t rays;
    double weight;
} ray_cut;

ray_cut ray_tree_cut(const ray_tree *tree, ray_end end);

/* The fraction of the ray's power at the start of a node: the mean of the channels of its throughput. */
double beam_fraction(const ray_node *node);
/* The fraction of the power at distance t from the node's start, not beyond its hit. */
double beam_fraction_at(const ray_node *node, double t);

/* The colour of a wavelength, linear sRGB in 0..1, the largest component 1; grey outside the visible range. */
void beam_wavelength_color(double lambda_nm, double rgb[3]);

/* The colour of a beam's lines: the beam's, or the wavelength's if the beam's is black. */
void beam_line_color(const beam *b, double lambda_nm, double rgb[3]);

/* --- screens --- */

/* A rectangle that bins the power of the beams' rays that cross it. It does not block them, and is not part of the
 * scene. The limits for all beams are a few seconds of work, for which the laboratory's image must wait. */
enum { SCREEN_BINS_MAX = 512, SCREEN_RAYS_MAX = 100000, SCREEN_ALL_RAYS_MAX = 1000000, SCREEN_SEGMENTS_MAX = 5000000 };

typedef struct beam_screen {
    vec3 centre, normal;
    double width, height;        /* scene units, along e_u (horizontal, or x for a horizontal screen) and e_v */
    int columns, rows;           /* of bins; 1 .. SCREEN_BINS_MAX */
    int rays_of_beam;            /* per wavelength, 1 .. SCREEN_RAYS_MAX; 0: the parameter `rays` of each beam */
    vec3 e_u, e_v;               /* results from here on */
    double *bin;                 /* power by bin, [row * columns + column], row 0 at the top (largest v) */
    double *color;               /* the same in linear sRGB, each wavelength in its colour: [3 * bin + channel] */
    double power;                /* of all beams */
    double received;             /* sum of the bins */
    size_t ray_count, hit_count; /* rays of the beams; crossings of the screen */
    size_t segment_count;        /* of the rays' trees */
} beam_screen;

status beam_screen_expose(const scene *s, isa level, beam_screen *screen, diagnostic *why);
void beam_screen_release(beam_screen *screen);

/* --- drawing: the rays' segments as lines, dimmed where an opaque solid hides them; the film is not touched --- */

/* Creates a copy of the scene with only its opaque solids, for the integrator aov: render it at the size of the image,
 * and pass its layer `depth` to beams_draw. The caller destroys it. */
status beams_hiding_scene(const scene *s, scene **out, diagnostic *why);

/* distance: from the camera to the first opaque surface by pixel; 0 if there is none. */
status beams_draw(const scene *s, isa level, const float *distance, image *img, diagnostic *why);
