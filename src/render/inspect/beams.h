/* The rays of a scene's beams, traced by the probe like those of `cuvette trace` and `cuvette fan`. Ownership:
 * everything that a visitor receives is borrowed for the call. */
#pragma once

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
double beam_share(const ray_node *node);
/* Share of the power at distance t from the node's start, not beyond its hit. */
double beam_share_at(const ray_node *node, double t);

/* The colour of a wavelength, linear sRGB in 0..1, the largest component 1; grey outside the visible range. */
void beam_wavelength_color(double lambda_nm, double rgb[3]);

/* The colour of a beam's lines: its own, or that of the wavelength if it is black. */
void beam_line_color(const beam *b, double lambda_nm, double rgb[3]);
