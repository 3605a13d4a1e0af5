/* Lens systems as solids of a scene, and back. Each element is a solid of shape lens with its own medium; cemented
 * elements overlap, and the one with the higher priority has the true surface, so that no faces coincide.
 * Ownership: everything is copied. Errors: STATUS_BAD_INPUT with the remedy; the scene is then partly changed. */
#pragma once

#include "scene/lens/lens_files.h"
#include "scene/model/open.h"

/* Where and how a system is added to a scene. Its elements are NAME, NAME-2, NAME-3, ... in the order of the light;
 * all other solids follow NAME (scene/model/solids.h), so that the system moves and turns with it: NAME-stop,
 * NAME-hole-N for the holes of mirrors, NAME-mount-N and NAME-tube (rings that hold the elements, and the tube around
 * them), and NAME-screen at the image. */
typedef struct lens_placement {
    const char *name;
    vec3 position;     /* of the first vertex, scene units */
    vec3 rotation_deg; /* takes +y to the direction of the light; 0: upwards */
    double scale;      /* scene units per unit of the prescription */
    int64_t priority;  /* the lowest that its solids have */
    bool mount, screen;
    const lens_glasses *glasses; /* the files of glasses that the prescription names; their paths are relative to the
                                    scene's folder */
} lens_placement;

status lens_add_to_scene(scene *s, const lens_prescription *p, const lens_placement *at, diagnostic *why);

/* A new scene about a system named objective, whose light travels along +z from a chequered wall at the distance of
 * the object (50 focal lengths, if that is infinite): a camera behind the image that sees it through the exit pupil,
 * a beam for each field (objective-field-N) and a screen, both not visible. Lengths are in the prescription's unit. */
status lens_scene_create(const lens_prescription *p, const lens_glasses *glasses, scene **out, diagnostic *why);

/* Reads a system back from the solids of a scene: all solids of shape lens whose names begin with `name` (NULL or "":
 * all of the scene) must have one common axis, in the order of their positions along it. The stop is the cup
 * NAME-stop, or any cup with floor 0 on the axis that is named stop or ends in -stop; the image is at the solid that
 * ends in -screen, or at the paraxial focus. Lengths are in scene units; unit_mm is from render.unit_m. The scene's
 * data must be loaded (scene_load) for media of files. Fields, wavelengths and title are not in a scene's solids;
 * they are those of its beams named NAME-field-N, or the axis and render.lambda_nm. *at, unless at is NULL: the frame
 * of the system, and as its name that of the solid of its stop, NULL for none, borrowed. */
status lens_of_scene(const scene *s, const char *name, lens_prescription *out, lens_placement *at, diagnostic *why);
