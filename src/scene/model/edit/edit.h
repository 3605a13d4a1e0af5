/* Changes to a scene that are more than the value of one parameter: objects come and go, move, turn, change their
 * names. What is added has the defaults that a file gives it; scene_set then turns it into what is wanted. Between
 * edits a scene may be wrong as a whole (a cup whose hollow is too wide, say): scene_check says so at the end.
 * Ownership: the scene stays the caller's; names are copied. An index holds until something is removed; pointers to
 * objects hold until something is added. Errors: STATUS_BAD_INPUT with the reason, the scene is then as it was. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/params.h"

/* One more object at the end of its section. The name must be right and free (scene/model/check.h), the limits of a
 * scene hold. index may be NULL. */
/* A group that is not that of solids. */
status scene_add(scene *s, param_group group, const char *name, size_t *index, diagnostic *why);
status scene_add_solid(scene *s, const char *name, shape_kind shape, size_t *index, diagnostic *why);

/* The solid refers to that material from now on, and has its values; what the solid had for itself alone is gone. NULL
 * or "" takes the material away and leaves the defaults. */
status scene_give_material(scene *s, const char *solid_name, const char *material_name, diagnostic *why);

/* Sets a parameter as scene_set does, and also what a file says of a solid beside its parameters: NAME.material (as
 * scene_give_material) and NAME.shape. */
status scene_put(scene *s, const char *path, const char *value, diagnostic *why);

/* "plane, cylinder or mesh", with the conjunction "or"; returns text. */
char *scene_shape_words(const char *conjunction, char *text, size_t size);
/* The shape of that name. */
status scene_shape_named(const char *word, shape_kind *out, diagnostic *why);

status scene_set_title(scene *s, const char *title, diagnostic *why);

/* Removes an object by its name. A material, mesh or texture in use is refused, and by whom is said. A scene is never
 * without "camera", "background" and "render", which go back to their defaults. */
status scene_remove(scene *s, const char *name, diagnostic *why);

/* Gives an object another name; what refers to it goes on doing so. */
status scene_rename(scene *s, const char *name, const char *new_name, diagnostic *why);

/* Many objects at once, by a name that no object of the scene has: `all` is all solids and lights, `solids` and
 * `lights` are these alone, and words are joined by '+': `all+camera` is the whole scene with its camera. */
typedef struct scene_parts {
    bool solids, lights, camera;
} scene_parts;

/* Is it such a name? An object that is called so comes first. */
bool scene_parts_named(const scene *s, const char *name, scene_parts *out);

/* What scene_move and scene_turn do with such a name: all go by delta; all turn about the origin of the scene, a
 * camera with its roll. When one of them would leave its range, none is changed. */
status scene_move_parts(scene *s, scene_parts parts, vec3 delta, diagnostic *why);
status scene_turn_parts(scene *s, scene_parts parts, vec3 degrees, diagnostic *why);

/* All lengths times a factor: of one solid or light, where it stands; or of many objects (see scene_parts), about the
 * origin. With all solids their materials' lengths are scaled, and render.unit_m is divided by the factor: lengths in
 * metres, and what media absorb, stay. */
status scene_scale(scene *s, const char *name, double factor, diagnostic *why);

/* Moves a solid, a light, or "camera", or many objects, by delta in scene units. The target of an aimed camera or of a
 * cone of light moves with it: its direction holds. */
status scene_move(scene *s, const char *name, vec3 delta, diagnostic *why);

/* Turns a solid, a cone of light, or "camera", in place, or many objects about the origin: about the world's x axis,
 * then y, then z, right-hand rule, on top of how it stands already. Of the camera the direction is turned; its picture
 * stays upright, and what it was aimed by (target or angles) it is aimed by still. */
status scene_turn(scene *s, const char *name, vec3 degrees, diagnostic *why);

/* Aims the camera at a point. */
status scene_look_at(scene *s, vec3 target, diagnostic *why);
