/* The render plan: a scene prepared for tracing, with solids in order of priority, materials and refractive indices by
 * priority index, and the camera frame. It is built once per frame and then read by all workers. Ownership: plan_build
 * allocates, plan_destroy releases; it borrows the scene's materials, meshes and sky, and the names of objects. */
#pragma once

#include "geometry/hierarchy/hierarchy.h"
#include "geometry/mesh/mesh.h"
#include "geometry/scene_geometry.h"
#include "optics/crystal.h"
#include "render/plan/layered_table.h"
#include "render/plan/lights.h"
#include "render/plan/rough_energy.h"
#include "render/plan/sampling.h"
#include "render/plan/schedule.h"
#include "render/plan/sky.h"
#include "render/plan/spectra.h"
#include "scene/model/camera.h"
#include "scene/model/face_materials.h"
#include "scene/model/lights.h"
#include "scene/model/material.h"
#include "scene/model/medium.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/solids.h"
#include "scene/model/view_settings.h"

/* What a sheet, a polarising filter or wave plate, does to light that passes it. */
typedef struct region_sheet {
    sheet_kind kind;
    vec3 axis; /* in the world, of any length */
    double pass, block;
    double retardance_deg, birefringence;
} region_sheet;

typedef struct region_scatter {
    vec3 per_unit;    /* scattering coefficient by channel, 1 / scene unit; not for spectral films */
    double asymmetry; /* of the phase function, optics/phase_function.h */
} region_scatter;

/* The maximum number of lamps whose scattered light is sampled along each ray (render/shade/media.h). */
enum { AIRLIGHTS_MAX = 8 };

/* The maximum number of boxes, one per solid whose medium scatters; if there are more such solids, one box holds
 * all. */
enum { SCATTER_BOXES_MAX = 8 };

typedef struct scatter_plan {
    bool by_channel; /* the channels of some medium differ */
    int box_count, lamp_count, lamps[AIRLIGHTS_MAX];
    bounds3 boxes[SCATTER_BOXES_MAX];
    region_scatter region[]; /* by priority index */
} scatter_plan;

/* The shading materials of a region: one for each slot of its mesh, or one for all faces. */
typedef struct region_materials {
    int count;
    shading_material *mat;
    const int *end_slots; /* by face of its primitive: the slot; borrowed; NULL: a mesh, or one material */
    bool borrowed;        /* mat belongs to another region of the same material */
    shading_rule shading;
} region_materials;

typedef struct own_tree {
    const mesh *of; /* borrowed */
    hierarchy *tree;
} own_tree;

typedef struct plan {
    scene_geometry *geometry;
    /* Surface keys: priority indices, and beyond them further numbers for the slots 1 .. END_SLOTS - 1 of regions whose
     * faces differ (face_materials.h), from first_key[priority index] on. */
    int *first_key;                      /* by priority index; 0: the region has one material. NULL: all have */
    size_t key_count;                    /* priority indices and further keys */
    index_law *end_laws;                 /* of opaque materials of parts of surfaces; by key */
    int (*end_slots)[FACES_MAX];         /* by solid: region_materials.end_slots; NULL: none has any */
    const material **materials;          /* by surface key; [0] is NULL */
    region_materials *shading_materials; /* by priority index; [0] is empty */
    int *shading_class;  /* by surface key: the first region of its class; a class may be shaded as one group */
    own_tree *own_trees; /* hierarchies that the plan owns because the meshes do not keep them */
    size_t own_tree_count, own_tree_room;
    double **shadow_transmittance; /* by solid: of its faces by slot, or NULL */
    size_t solid_count;
    mesh_report meshes;
    material *substitutes;  /* by solid: see material_of */
    double *ior;            /* refractive indices at render.lambda_nm, by surface key; [0]: the surrounding medium */
    index_law *solid_laws;  /* by solid, then the surrounding medium's */
    const index_law **laws; /* by surface key: the source of ior; in solid_laws */
    vec3 *absorption;       /* by priority index: Beer-Lambert coefficients and tints, by channel, in 1 / scene unit */
    spectra *spectral;      /* for a spectral film, else NULL */
    layered_plan *layered;  /* metals and thin films; NULL if there are none */
    bool polarised_shadows; /* some lamp is polarised, and shadow rays may pass through sheets */
    region_sheet *sheets;   /* by priority index: polarisers and wave plates; NULL if there are none */
    optical_medium *crystals; /* by priority index; NULL if there are none */
    scatter_plan *scatter;    /* media that scatter; NULL if there are none */
    bool rough;               /* some surfaces are rough: see render/shade/rough.h */
    rough_energy *energy;     /* light between facets of rough surfaces, with render.energy_compensation; else NULL */
    camera_frame view;
    uint64_t eye_inside;    /* the set of primitives that contain the camera */
    analyser_kind analyser; /* of camera rays; ANALYSER_NONE without polarisation */
    vec3 analyser_axis;     /* of a linear analyser */
    bool starts_vary;       /* camera rays start on an area, so that different primitives may contain their origins */
    int camera_priority_index; /* of the medium at the camera */
    bool basic;                /* rays carry basic radiance (L / n^2): see radiance.c */
    render_settings render;
    path_sampling draws; /* of random paths */
    /* every solid blocks light: either render settings require it, or random paths find the transmitted light */
    bool solid_shadows;
    const struct photon_map *photons; /* borrowed: light that mirrors and clear solids deflect; NULL: none */
    const background *sky;            /* the scene's, or own_sky */
    background own_sky;
    struct rain *rain;  /* what rain adds to the sky, or NULL */
    vec3 sky_mean;      /* over all directions; computed if render.beyond is mean */
    light *lights;      /* the scene's, with the colours of their spectra; names are borrowed */
    light_cone *cones;  /* by light; undefined for a point light */
    lamp_shape *shapes; /* by light; defined for discs and rectangles */
    int light_count;
    beam *beams; /* those that light the scene; names are borrowed */
    int beam_count;
    bool has_sun; /* some light is a sun; suns are at sun_distance from the origin, and without radius and reach */
    double sun_distance; /* far beyond all solids and other lights */
} plan;

/* Call scene_load first. */
status plan_build(const scene *s, plan **out, diagnostic *why);
void plan_destroy(plan *p);

/* The surface key of a slot of a region. */
static inline int plan_surface_key(const plan *p, int priority_index, int slot)
{
    return slot > 0 && p->first_key && p->first_key[priority_index] ? p->first_key[priority_index] + slot - 1
                                                                    : priority_index;
}

/* Whether the region has one material of equal values everywhere: no texture, no checker, and no spectral film. */
bool plan_is_plain(const plan *p, int priority_index);

/* --- plan_materials.c, for plan.c; each returns false when out of memory --- */

/* Fills p->shading_class from the shading materials. */
bool plan_find_shading_classes(plan *p);

/* Fills *out with the shading materials of a region of the solid `owner`, with `surface` as the solid's own surface. A
 * region borrows those of an earlier one with the same unchanged material, or of the same solid. shared: by material,
 * then by solid; NULL at first. */
bool region_materials_make(const scene *s, const solid *owner, const material *surface, shading_material **shared,
                           region_materials *out);
/* The fraction of a shadow ray that a solid's surface transmits: sets *least to the minimum over its faces, and
 * *by_slot to the fraction per slot if faces differ, else to NULL; the caller frees *by_slot. */
bool region_shadow_transmittance(const scene *s, const solid *owner, double *least, double **by_slot);
/* Tables by priority index of sheets, of crystals (n_o is not set) and of scattering media. They set *out to NULL if
 * the frame has none; the caller frees *out. */
bool sheet_list_create(const scene *s, const scene_geometry *geometry, region_sheet **out);
bool crystal_list_create(const scene *s, const scene_geometry *geometry, optical_medium **out);
bool scatter_plan_create(const scene *s, const scene_geometry *geometry, scatter_plan **out);
