/* A scene: render settings, camera, background, meshes, textures, optical data, lights, beams, materials, solids. Every
 * user-settable field is a row of the parameter table (scene/model/params.h), which is used by files, --set, studies
 * and manuals. Code that only passes scenes to others includes scene/model/open.h, which states ownership; the renderer
 * borrows a scene. */
#pragma once

#include "scene/model/lights.h"
#include "scene/model/names.h"
#include "scene/model/open.h"
#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/model/solids.h"
#include "scene/model/view_settings.h"

struct scene {
    char *path; /* the file that was read; "" if none */
    char *title;
    char *remarks; /* on files of lens systems, for notes: lines "NAME: REMARK"; NULL for none */
    render_settings render;
    struct camera camera;
    struct background background;
    mesh_entry *meshes;
    size_t mesh_count;
    texture_entry *textures;
    size_t texture_count;
    data_entry *data;
    size_t data_count;
    named_material *materials;
    size_t material_count;
    light *lights;
    size_t light_count;
    beam *beams;
    size_t beam_count;
    solid *solids;
    size_t solid_count;
    bool has_followers; /* something follows a solid, or has done so (scene_follow_leaders) */
    solid *new_solid;   /* with all defaults and without a name; NULL until the first solid is added */
    name_tally names;   /* of meshes, textures, data, materials, lights, beams and solids */
    load_limits limits; /* none by default; set by scene_limit */
};

/* Index of the solid with that name, or -1. */
int scene_find_solid(const scene *s, const char *name);

/* The mesh, or texture, with that name; NULL if there is none. */
const mesh_entry *scene_find_mesh(const scene *s, const char *name);
/* The mesh of a solid; NULL for shapes without triangles, or if the mesh does not exist. */
const mesh_entry *scene_mesh_of(const scene *s, const solid *owner);
/* The mesh at whose vertices a solid is repeated; NULL if it is not, or if the mesh does not exist. */
const mesh_entry *scene_points_of(const scene *s, const solid *owner);
/* The solid's shape, with the triangles of its mesh, or its points, if they are loaded. */
solid_shape scene_loaded_shape(const scene *s, const solid *owner);
const texture_entry *scene_find_texture(const scene *s, const char *name);
/* Sets what materials and lights refer to by name (index_data and others). Called when data are loaded, or a name or an
 * entry changes. */
void scene_follow_data(scene *s);

/* Whether a solid has its place from another one, and places those solids and beams that have: position, rotation and
 * scale. The scale of a mesh or of points, which is their own size, is not passed on. Called when a place, a name or a
 * leader changes. */
static inline bool solid_follows(const solid *owner)
{
    return owner->follows[0] != 0;
}
void scene_follow_leaders(scene *s);
/* Gives a solid or a beam that follows none the place that its parameters have. */
void solid_stand(solid *owner);
void beam_stand(beam *b);
/* The factor by which a beam's place is scaled, 1 if it follows none; NaN if its solid is not scaled evenly. */
double beam_scale(const scene *s, const beam *b);

/* The first light of kind sun, or NULL. */
const light *scene_sun(const scene *s);

/* The unit vector towards the background's sun: the first light of kind sun, else by the background's sun_elevation_deg
 * and sun_azimuth_deg. */
vec3 scene_to_sun(const scene *s);

/* --- the work that the parameters imply, for limits before anything is loaded or rendered: work.c --- */

/* The number of triangles of generated meshes; a mesh from a file counts as 12, because its size is unknown. */
double scene_planned_triangles(const scene *s);

/* The number of camera rays, times wavelengths. */
double scene_camera_rays(const render_settings *r);

/* An upper bound of the number of rays, without shadow rays. A level of a tree has at most twice the rays of the level
 * above it, and at most 1 / min_weight, because the weights of a level sum to at most 1. */
double scene_rays_bound(const render_settings *r);

/* The work of a slime: steps to its time_s, times masses. */
double slime_work(const mesh_entry *m);

/* The parts of scene_check for one object, so that a reader can locate an error in a file. Pure. */

/* Fails if an object of the scene has that name. */
status check_name_is_free(const scene *s, const char *name, diagnostic *why);

/* Checks one object and its references; index is 0 for render, camera and background. */
status check_object(const scene *s, param_group group, size_t index, diagnostic *why);

/* Fails if the scene has too many objects of a kind, or primitives. */
status check_limits(const scene *s, diagnostic *why);

/* Checks the image of a sky that was just read (image_check_light) and its brightness, replaces small negative
 * values by 0, notes that, and sets sky->brightest. path: for the diagnostic. */
status sky_take(background *sky, const char *path, diagnostic *bad);
