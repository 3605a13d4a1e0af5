/* What a scene's vessel, liquid and rod are, in the numbers that theory wants; and copies of a scene in which some of
 * its media stand in another arrangement. Ownership: arrange_* give a scene, or NULL when memory is out. */
#pragma once

#include "geometry/solid.h"
#include "realism/theory.h"
#include "scene/model/open.h"

typedef enum setup_medium { SETUP_OUTSIDE, SETUP_VESSEL, SETUP_LIQUID, SETUP_MEDIA } setup_medium;

typedef struct setup {
    int vessel, liquid, rod; /* indices in scene.solids; liquid is -1 for none */
    double n[SETUP_MEDIA];   /* at render.lambda_nm; of an empty vessel the liquid's is that of what is outside */
    double x, z;             /* of the axis */
    double outer, inner;     /* radii of the wall */
    double low, high; /* what is filled, y: from the floor to the liquid's surface, or of an empty vessel to its rim */
} setup;

/* STATUS_BAD_INPUT when a solid is missing or not as theory needs it. */
status setup_read(const scene *s, setup *out, diagnostic *why);

theory_shells setup_shells(const setup *at);

/* The shapes that closed forms are about, upright: a half-space below y; boxes and balls about their centre; a round
 * cylinder above the middle of its base. */
solid_shape ground_at(double y);
solid_shape box_at(vec3 position, vec3 size);
solid_shape ball_at(vec3 position, double radius);
solid_shape cylinder_at(vec3 position, double radius, double height);

/* Takes off what the closed forms know nothing of: clear solids' tints, and their coatings under Fresnel's weights. */
void arrange_bare(scene *s);

/* A bare copy without solids or lights in sight, and with settings that trace every ray of a way. What an interface
 * does with light (render.weights) and the media stay as they are. */
scene *arrange_empty(const scene *s);

/* The vessel with its liquid alone. */
scene *arrange_vessel(const scene *s, const setup *at);

/* A slab of the vessel's medium without absorption, and below y a surface that shines with radiance 1 under a black
 * sky.
 */
scene *arrange_shining(const scene *s, const setup *at, solid_shape slab, double y);

/* Two media that meet at y = 0, a ray coming from (0, *start_y, 0); one of them may be SETUP_OUTSIDE, none a missing
 * liquid. */
scene *arrange_interface(const scene *s, const setup *at, setup_medium from, setup_medium to, double *start_y);
