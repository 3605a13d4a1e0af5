/* Changes to a scene beyond the value of one parameter: adding, removing, moving, rotating and renaming objects. New
 * objects have the defaults of a scene file; scene_set then changes them. Between edits a scene may be invalid (a cup
 * with a hollow that is too wide, for example); scene_check reports this at the end. Ownership: names are copied. An
 * index is valid until an object is removed, a pointer to an object until one is added. Errors: STATUS_BAD_INPUT with
 * the reason; the scene is then unchanged. */
#pragma once

#include "base/vec3.h"
#include "geometry/solid.h"
#include "scene/model/params.h"

/* Append an object to its section; scene_add_solid is for solids. The name must be valid and unused
 * (scene/model/scene.h), and the limits of a scene apply. index may be NULL. */
status scene_add(scene *s, param_group group, const char *name, size_t *index, diagnostic *why);
status scene_add_solid(scene *s, const char *name, shape_kind shape, size_t *index, diagnostic *why);

/* Assigns a material to a solid, whose surface parameters are replaced. NULL or "" removes the material and restores
 * the defaults. */
status scene_assign_material(scene *s, const char *solid_name, const char *material_name, diagnostic *why);

/* Sets a parameter like scene_set, and also the properties of a solid that are not parameters: NAME.material (as
 * scene_assign_material) and NAME.shape. */
status scene_set_property(scene *s, const char *path, const char *value, diagnostic *why);

/* Writes the names of the shapes: "plane, cylinder or mesh", with the conjunction "or"; returns text. */
char *scene_shape_words(const char *conjunction, char *text, size_t size);
/* The shape with that name. */
status scene_shape_named(const char *word, shape_kind *out, diagnostic *why);

status scene_set_title(scene *s, const char *title, diagnostic *why);

/* Removes an object by name. It refuses a material, mesh or texture in use, and names the user. "camera", "background"
 * and "render" always exist: removing one restores its defaults. */
status scene_remove(scene *s, const char *name, diagnostic *why);

/* Renames an object; references to it follow. */
status scene_rename(scene *s, const char *name, const char *new_name, diagnostic *why);

/* Groups of objects, by a name that no object of the scene has: `all` is all solids, lights and beams, `solids` the
 * solids, `lights` the lights and beams, and '+' joins words: `all+camera` is the scene with its camera. The objects
 * move by the same vector, or rotate about the scene's origin, including the camera's roll. If one of them would leave
 * its range, none is changed. */
typedef struct scene_parts {
    bool solids, lights, beams, camera;
} scene_parts;

/* Whether `name` is a group. An object of that name has precedence. */
bool scene_parts_named(const scene *s, const char *name, scene_parts *out);

/* Multiplies all lengths by a factor: of one solid or light in place, or of a group (scene_parts) about the origin. If
 * the group has all solids, the lengths in their materials are scaled, and render.unit_m is divided by the factor, so
 * that lengths in metres and absorption stay the same. */
status scene_scale(scene *s, const char *name, double factor, diagnostic *why);

/* Moves a solid, a light, a beam, "camera" or a group by delta in scene units. The target of an aimed camera, a
 * spotlight or a beam moves as well, so that its direction stays the same. */
status scene_move(scene *s, const char *name, vec3 delta, diagnostic *why);

/* Rotates a solid, a spotlight, a beam or "camera" in place, or a group about the origin: about the world's x axis,
 * then y, then z (rotation_from_deg), in addition to the current rotation. The camera's viewing direction is rotated;
 * its image stays upright, and it remains aimed by target or by angles as before. */
status scene_turn(scene *s, const char *name, vec3 degrees, diagnostic *why);

/* Aims the camera at a point. */
status scene_look_at(scene *s, vec3 target, diagnostic *why);

/* --- the contents of a solid ---
 *
 * The contents of a solid move with it: the liquid and the rod of a vessel. They are the solids and lights whose centre
 * is in the solid's bounding box and that are smaller than the solid: the vessel is not among its liquid's contents. */

typedef struct contents {
    const char **name; /* borrowed from the scene */
    size_t count;
} contents;

/* Fills out, which contents_clear frees; empty for a light or an unbounded solid. */
status contents_find(const scene *s, const char *container, contents *out, diagnostic *why);
void contents_clear(contents *c);

/* A ball around a solid; false for an unbounded solid and for other objects. */
bool contents_ball(const scene *s, const char *name, vec3 *centre, double *radius);

/* Objects that are edited as one rigid body about the position of the first. Names may repeat; each object is changed
 * once. */
typedef struct object_list {
    const char *first, **others;
    size_t count; /* of the others */
} object_list;

/* scene_move, scene_turn and scene_scale for such a list. */
status scene_move_objects(scene *s, const object_list *of, vec3 by, diagnostic *why);
status scene_turn_objects(scene *s, const object_list *of, vec3 degrees, diagnostic *why);
status scene_scale_objects(scene *s, const object_list *of, double factor, diagnostic *why);

/* --- parts (edit_place.c) ---
 *
 * Moves and rotates one object or the camera, for edit_parts.c and contents.c. Private to this folder. Errors as in
 * scene/model/edit/edit.h. */

/* Finds an object by name. The remedy of the error also lists the names of groups. */
status edit_find(const scene *s, const char *name, param_place *at, diagnostic *why);

/* Sets a vector parameter by its path, which checks its range. */
status edit_set_vector(scene *s, const char *name, const char *row, vec3 v, diagnostic *why);

/* scene_move and scene_turn for one object or "camera". */
status edit_move(scene *s, const char *name, vec3 delta, diagnostic *why);
status edit_turn(scene *s, const char *name, vec3 degrees, diagnostic *why);
/* Fails for angles that are not finite or too large; name is used in the message. */
status edit_check_angles(const char *name, vec3 degrees, diagnostic *why);

/* Undoes a failed edit of values: restores those of the clone that was made before the edit. */
void edit_restore(scene *s, const scene *before);
