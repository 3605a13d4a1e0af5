/* The parts of scene_check that concern one object, so that a reader can say where in a file the trouble is. Pure. */
#ifndef CUVETTE_SCENE_MODEL_CHECK_H
#define CUVETTE_SCENE_MODEL_CHECK_H

#include "scene/model/light.h"
#include "scene/model/mesh_entry.h"
#include "scene/model/open.h"
#include "scene/model/solids.h"

/* Letters, digits, _ and -, a letter or _ first, at most SCENE_NAME_MAX, and not a word that paths or scene
 * files use. */
status check_name(const char *name, diagnostic *why);

/* Is the name free among the scene's meshes, textures, lights, materials and solids? */
status check_name_is_free(const scene *s, const char *name, diagnostic *why);

status check_render(const scene *s, diagnostic *why);
status check_light(const scene *s, const light *lamp, diagnostic *why);
status check_camera(const scene *s, diagnostic *why);
status check_background(const scene *s, diagnostic *why);
status check_mesh(const mesh_entry *m, diagnostic *why);
status check_texture(const texture_entry *t, diagnostic *why);
status check_solid(const scene *s, const solid *owner, diagnostic *why);

/* Numbers of lights, materials and primitives. */
status check_limits(const scene *s, diagnostic *why);

#endif
