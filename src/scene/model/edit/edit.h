/* Changes to a scene beyond the value of one parameter: adding, removing, moving, rotating and renaming objects. New
 * objects have the defaults of a scene file; scene_set then changes them. Between edits a scene may be invalid (a cup
 * with a hollow that is too wide, for example): scene_check reports that at the end. Ownership: the scene stays the
 * caller's; names are copied. An index is valid until an object is removed; pointers to objects until one is added.
 * Errors: STATUS_BAD_INPUT with the reason, the scene is then unchanged. */
#pragma once

#include "base/vec3.h"
#include "geometry/solid.h"
#include "scene/model/params.h"

/* Appends an object to its section: scene_add for all groups except solids. The name must be valid and unused
 * (scene/model/check.h), and the limits of a scene apply. index may be NULL. */
status scene_add(scene *s, param_group group, const char *name, size_t *index, diagnostic *why);
status scene_add_solid(scene *s, const char *name, shape_kind shape, size_t *index, diagnostic *why);

/* Assigns a material to the solid: it gets the material's values, and its own values are discarded. NULL or "" removes
 * the material and restores the defaults. */
status scene_assign_material(scene *s, const char *solid_name, const char *material_name, diagnostic *why);

/* Sets a parameter like scene_set, and also the properties of a solid that are not parameters: NAME.material (as
 * scene_assign_material) and NAME.shape. */
status scene_put(scene *s, const char *path, const char *value, diagnostic *why);

/* "plane, cylinder or mesh", with the conjunction "or"; returns text. */
char *scene_shape_words(const char *conjunction, char *text, size_t size);
/* The shape with that name. */
status scene_shape_named(const char *word, shape_kind *out, diagnostic *why);

status scene_set_title(scene *s, const char *title, diagnostic *why);

/* Removes an object by name. A material, mesh or texture in use is refused, with its user. "camera", "background" and
 * "render" always exist: removing one restores its defaults. */
status scene_remove(scene *s, const char *name, diagnostic *why);

/* Renames an object; references to it follow. */
status scene_rename(scene *s, const char *name, const char *new_name, diagnostic *why);

/* Groups of objects, by a name that no object of the scene has: `all` is all solids, lights and beams, `solids` the
 * solids, `lights` the lights and beams, and words are joined by '+': `all+camera` is the scene with its camera.
 * All move by the same vector; all rotate about the origin of the scene, including a camera's roll. If one of them
 * would leave its range, none is changed. */
typedef struct scene_parts {
    bool solids, lights, beams, camera;
} scene_parts;

/* Whether it is the name of a group. An object of that name has precedence. */
bool scene_parts_named(const scene *s, const char *name, scene_parts *out);

/* Multiplies all lengths by a factor: for one solid or light in place, or for many objects (see scene_parts) about the
 * origin. With all solids, the lengths in their materials are scaled, and render.unit_m is divided by the factor, so
 * that lengths in metres and absorption stay the same. */
status scene_scale(scene *s, const char *name, double factor, diagnostic *why);

/* Moves a solid, a light, "camera", or many objects, by delta in scene units. The target of an aimed camera or
 * spotlight moves as well, so its direction stays the same. */
status scene_move(scene *s, const char *name, vec3 delta, diagnostic *why);

/* Rotates a solid, a spotlight or "camera" in place, or many objects about the origin: about the world's x axis, then
 * y, then z (rotation_from_deg), in addition to its current rotation. For the camera the viewing direction is rotated;
 * its image stays upright, and it remains aimed by target or by angles as before. */
status scene_turn(scene *s, const char *name, vec3 degrees, diagnostic *why);

/* Aims the camera at a point. */
status scene_look_at(scene *s, vec3 target, diagnostic *why);

/* --- objects that belong together ---
 *
 * What is inside a solid goes with it: the liquid and the rod of a vessel. These are the solids and lights whose centre
 * is in the solid's bounding box and that are smaller than it, so that the liquid does not take the vessel along. */

typedef struct contents {
    const char **name; /* borrowed from the scene */
    size_t count;
} contents;

/* Fills out, which contents_clear frees; empty for a light or an unbounded solid. */
status contents_find(const scene *s, const char *container, contents *out, diagnostic *why);
void contents_clear(contents *c);

/* A ball around the object, and whether it is known: not for an unbounded solid. */
bool contents_ball(const scene *s, const char *name, vec3 *centre, double *radius);

/* Objects that are changed together, as one rigid body about the position of the first. Names other than of the first
 * may repeat; each is changed once. */
typedef struct object_list {
    const char *first, **others;
    size_t count; /* of the others */
} object_list;

/* scene_move, scene_turn and scene_scale for them. */
status scene_move_objects(scene *s, const object_list *of, vec3 by, diagnostic *why);
status scene_turn_objects(scene *s, const object_list *of, vec3 degrees, diagnostic *why);
status scene_scale_objects(scene *s, const object_list *of, double factor, diagnostic *why);
