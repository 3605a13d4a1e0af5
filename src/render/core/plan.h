/* A scene made ready for tracing: solids in order of rank, materials and indices by rank, the camera's frame. Built
 * once a frame, then read by all workers. Ownership: plan_build gives, plan_destroy releases; it borrows the scene's
 * lights and sky. */
#pragma once

#include "geometry/scene_geometry.h"
#include "geometry/hierarchy.h"
#include "render/core/mesh_report.h"
#include "render/shade/light_cone.h"
#include "render/shade/spectra.h"
#include "scene/model/camera.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/light.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/solids.h"
#include "scene/model/view_settings.h"

/* By a mesh's slots, or one for all. */
typedef struct region_materials {
    int count;
    shading_material *mat;
    shading_rule shading;
} region_materials;

typedef struct plan {
    scene_geometry *geometry;
    const material **materials;          /* by rank; [0] is NULL */
    region_materials *shading_materials; /* by rank; [0] is empty */
    hierarchy **own_trees;               /* of a plan that does not keep them with the meshes; by solid */
    size_t own_tree_count;
    double **shadow_transmittance; /* by solid: of its faces by slot, or NULL; as many as own_trees */
    mesh_report meshes;
    material *mirrors; /* by solid: clear materials whose index makes them mirrors, as opaque ones */
    double *ior;       /* by rank; [0] is the surrounding medium's; at render.lambda_nm */
    index_law *laws;   /* by rank: what ior was taken from */
    vec3 *absorption;  /* by rank: Beer and Lambert's coefficients and tints, by channel, in 1 / scene unit */
    spectra *spectral; /* of a spectral film, else NULL */
    camera_frame view;
    uint64_t eye_inside;       /* the set of primitives that the camera stands in */
    int camera_priority_index; /* and the medium there */
    bool basic;                /* rays carry basic radiance: see radiance.c */
    render_settings render;
    /* every solid blocks a light: it is asked for, or what comes through is found by random paths */
    bool solid_shadows;
    const background *sky;
    vec3 sky_mean; /* over all directions; worked out where render.beyond is mean */
    const light *lights;
    light_cone *cones; /* by light; of a point light it means nothing */
    int light_count;
} plan;

/* scene_load must have been called. */
status plan_build(const scene *s, plan **out, diagnostic *why);
void plan_destroy(plan *p);

/* Fills *out for a body of that solid, whose own surface is that material; false when memory is out. For plan.c. */
bool region_materials_make(const scene *s, const solid *owner, const material *surface, region_materials *out);
/* What a shadow ray keeps at its surface: the least, and by slot where faces differ, else NULL; *by_slot is the
 * caller's. False when memory is out. */
bool region_shadow_transmittance(const scene *s, const solid *owner, double *least, double **by_slot);
