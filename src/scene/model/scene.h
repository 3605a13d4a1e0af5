/* A scene as a person describes it: render settings, camera, background, lights, materials, solids.
 * Every field that may be turned is a row of the parameter table (scene/model/params.h), which is how files,
 * --set, studies and manuals reach it. Who only passes a scene on includes scene/model/open.h. Ownership: see there;
 * the renderer borrows a scene. */
#pragma once

#include "scene/model/light.h"
#include "scene/model/mesh_entry.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/solids.h"
#include "scene/model/view_settings.h"

struct scene {
    char *path; /* file it came from, "" if none */
    char *title;
    render_settings render;
    struct camera camera;
    struct background background;
    mesh_entry *meshes;
    size_t mesh_count;
    texture_entry *textures;
    size_t texture_count;
    named_material *materials;
    size_t material_count;
    light *lights;
    size_t light_count;
    solid *solids;
    size_t solid_count;
    load_limits limits; /* none by itself; set by scene_limit */
};

/* Index of the solid of that name, or -1. */
int scene_find_solid(const scene *s, const char *name);

/* The mesh or texture of that name; NULL if there is none. */
const mesh_entry *scene_find_mesh(const scene *s, const char *name);
/* The mesh that a solid shows; NULL if it is of a shape without triangles, or names none that is there. */
const mesh_entry *scene_mesh_of(const scene *s, const solid *owner);
/* The solid's shape with the triangles of its mesh, where they are loaded. */
solid_shape scene_loaded_shape(const scene *s, const solid *owner);
const texture_entry *scene_find_texture(const scene *s, const char *name);
