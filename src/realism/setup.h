/* The vessel, liquid, rod and camera of a scene as the numbers that theory needs; and copies of a scene with some of
 * its media in other solids. Ownership: arrange_* return a new scene, or NULL if memory runs out. */
#pragma once

#include "geometry/solid.h"
#include "realism/theory.h"
#include "scene/model/open.h"

typedef enum setup_medium { SETUP_OUTSIDE, SETUP_VESSEL, SETUP_LIQUID, SETUP_MEDIA } setup_medium;

typedef struct setup {
    int vessel, liquid, rod; /* indices in scene.solids; liquid is -1 for none */
    double n[SETUP_MEDIA];   /* at render.lambda_nm; without a liquid, the liquid's equals the surroundings' */
    double x, z;             /* position of the axis */
    double outer, inner;     /* outer and inner radius of the wall; the liquid can make it thinner */
    double low, high; /* the filled range of y: from the floor to the liquid's surface, or for an empty vessel to its
                         rim */
} setup;

/* STATUS_BAD_INPUT if a solid is missing or not as theory requires. setup_read_glass requires a liquid but no rod (rod
 * is -1). */
status setup_read(const scene *s, setup *out, diagnostic *why);
status setup_read_glass(const scene *s, setup *out, diagnostic *why);

theory_shells setup_shells(const setup *at);

/* Upright shapes for the closed forms: a half-space below y; boxes and spheres about their centre; a round cylinder
 * above the centre of its base. */
solid_shape ground_at(double y);
solid_shape box_at(vec3 position, vec3 size);
solid_shape ball_at(vec3 position, double radius);
solid_shape cylinder_at(vec3 position, double radius, double height);

/* Removes what the closed forms do not cover from all transparent solids: tints, thin films, polarisers and wave
 * plates, and, under Fresnel weights, coatings. */
void arrange_bare(scene *s);

/* A copy, made bare as above, without visible solids or lights, and with settings that trace every ray of a path. The
 * camera is a pinhole without roll, and the surroundings do not absorb. The behaviour of interfaces (render.weights)
 * and the media are unchanged. */
scene *arrange_empty(const scene *s);

/* A copy in which only the vessel and its liquid are visible. */
scene *arrange_vessel(const scene *s, const setup *at);

/* A copy with a slab of the vessel's medium without absorption and, below y, a surface that emits radiance 1; the sky
 * is black. */
scene *arrange_shining(const scene *s, const setup *at, solid_shape slab, double y);

/* A copy with two media that meet at y = 0, for a ray from (0, *start_y, 0). One of them may be SETUP_OUTSIDE; the
 * liquid must exist if it is one of them. */
scene *arrange_interface(const scene *s, const setup *at, setup_medium from, setup_medium to, double *start_y);

/* --- the camera --- */

/* The camera in scalars: direction of an image point, and projection of a scene point. Pinhole geometry, independent of
 * render/plan/plan.c. Image coordinates start at the top left corner, px; lengths in scene units. Pure. */
typedef struct view {
    double x, y, z;       /* of the camera */
    double yaw, pitch;    /* radians: 0 along +z, towards +x; up */
    double roll;          /* radians: the camera's right side down */
    double width, height; /* px */
    double focal_px;      /* focal length in px: size of a slope of 1 at the centre of the image */
} view;

view view_of(const scene *s);

/* Unit direction through a point of the image. */
typedef struct sight {
    double x, y, z;
} sight;
sight view_through(const view *v, double px, double py);

/* Projection of a scene point; false behind the camera. */
bool view_place(const view *v, double x, double y, double z, double *px, double *py);
