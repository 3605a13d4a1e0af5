/* The rays of a scene's beams, traced by the probe like those of `cuvette trace` and `cuvette fan`; screens that they
 * cross; and the beams drawn into an image. Ownership: everything that a visitor receives is borrowed for the call;
 * the caller owns a screen's bins and releases them with beam_screen_release. */
#pragma once

#include "image/image.h"
#include "render/inspect/probe.h"
#include "scene/model/lights.h"

typedef struct beam_ray {
    int beam;         /* index in the scene's beams */
    int number, rays; /* of this ray in its beam, from 0, and their count; for each wavelength the same */
    double lambda_nm;
    double power; /* at its start: the beam's power divided by its rays and wavelengths */
} beam_ray;

/* The tree of a ray without shadow rays; a path, each node the child of the one before, for a beam without branches.
 * Other than STATUS_OK ends the visit. */
typedef status beam_visit(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why);

/* Limits of all beams together, a few seconds of work: a laboratory's image waits meanwhile. */
enum { BEAMS_RAYS_MAX = 1000000, BEAMS_SEGMENTS_MAX = 5000000 };

/* Visits all rays of the visible beams by beam, wavelength and number. STATUS_BAD_INPUT beyond the limits. rays: a
 * number of rays for each beam instead of its own; 0: its own. The scene's files must be loaded. */
status beams_each_ray(const scene *s, isa level, int rays, beam_visit *visit, void *context, diagnostic *why);

/* Share of the ray's power at the start of a node: the mean of the channels of its throughput. */
double beam_fraction(const ray_node *node);
/* Share of the power at distance t from the node's start, not beyond its hit. */
double beam_fraction_at(const ray_node *node, double t);

/* The colour of a wavelength, linear sRGB in 0..1, the largest component 1; grey outside the visible range. */
void beam_wavelength_color(double lambda_nm, double rgb[3]);

/* The colour of a beam's lines: its own, or that of the wavelength if it is black. */
void beam_line_color(const beam *b, double lambda_nm, double rgb[3]);

/* --- screens --- */

/* A rectangle that bins the power of the beams' rays that cross it. It does not stop them, and does not belong to the
 * scene. */
enum { SCREEN_BINS_MAX = 512, SCREEN_RAYS_MAX = 100000 };

typedef struct beam_screen {
    vec3 centre, normal;
    double width, height;        /* scene units, along e_u (horizontal, or x for a horizontal screen) and e_v */
    int columns, rows;           /* of bins; 1 .. SCREEN_BINS_MAX */
    int rays_of_beam;            /* 1 .. SCREEN_RAYS_MAX for each beam and wavelength; 0: the beam's own number */
    vec3 e_u, e_v;               /* results from here on */
    double *bin;                 /* power by bin, [row * columns + column], row 0 at the top (largest v) */
    double *color;               /* the same in linear sRGB, each wavelength in its colour: [3 * bin + channel] */
    double power;                /* of all beams */
    double received;             /* sum of the bins */
    size_t ray_count, hit_count; /* rays of the beams; crossings of the screen */
} beam_screen;

status beam_screen_expose(const scene *s, isa level, beam_screen *screen, diagnostic *why);
void beam_screen_release(beam_screen *screen);

/* --- drawing: the rays' segments as lines, dimmed where an opaque solid hides them; the film is not touched --- */

/* A copy of the scene that shows only opaque solids, without beams, as the layer of distances (integrator aov): render
 * it with the same size, and pass its layer `depth` to beams_draw. The caller destroys it. */
status beams_hiding_scene(const scene *s, scene **out, diagnostic *why);

/* distance: from the camera to the first opaque surface by pixel, 0 where there is none. */
status beams_draw(const scene *s, isa level, const float *distance, image *img, diagnostic *why);
