/* The scene geometry: solids as the kernels see them, i.e. primitives, and regions ordered by priority. A region is one
 * primitive, or a convex primitive minus another convex one (a cup: its outside minus its hollow).
 *
 * A primitive that is not convex has several intervals ahead of a ray and so uses several rows of the scratch
 * (ray_scratch), in order. The entries after it in the list of primitives reserve these rows and hold nothing else;
 * their bits are never set in a ray's set.
 *
 * If a scene has many bounded solids, a hierarchy finds those that a ray may meet (geometry/regions/solid_tree.h); the
 * other primitives are direct: every batch of rays is tested against each of them.
 *
 * The medium at a point is the medium of the containing region with the highest priority index (0: the surrounding
 * medium). A ray carries the set of primitives that contain it: with one bit each if all are direct, otherwise as
 * geometry/regions/set_table.h describes. A closed mesh is a primitive too, though not convex; an open mesh is an open
 * surface and contains no points. An interface is a point of the ray where the medium changes: a boundary that a region
 * of higher priority hides, or that leads into an equal medium, is not an interface (Schmidt and Budge, "Simple Nested
 * Dielectrics in Ray Traced Images", JGT 7(2), 2002).
 *
 * A partial surface is there at some points only, or lets a part of the light through; the caller decides how much of
 * it is there at each crossing (surface_cover in rays.h). Where nothing of it is there, it is no interface. A partial
 * mesh is an open surface even if it is closed; another partial solid contains points, and is not opaque.
 *
 * Ownership: scene_geometry_build creates, scene_geometry_destroy frees; kernels borrow. The geometry is independent of
 * wavelength: for a medium it stores a number (equal numbers, equal refractive indices: no interface between them),
 * whether it is opaque, and whether it absorbs. */
#pragma once

#include "base/status.h"
#include "geometry/solid.h"
#include <stdbool.h>
#include <stdint.h>

enum {
    PRIMITIVES_MAX = 64, /* direct primitives: one bit each in a ray's set */
    FACES_MAX = 64,      /* a face's number is primitive * FACES_MAX + face; a power of two */
    HOLLOW_FACES = 8,    /* number of a hollow's first face among the faces of its solid */
    FACE_NONE = -1
};

/* The two sides of a lens (primitives/lens_kernel.c and asphere_kernel.c). */
typedef struct lens_sides {
    double curvature[2]; /* 1 / radius, signed; 0: flat */
    double conic[2];     /* conic constants; 0: spherical */
} lens_sides;

/* The files in primitives/ define each kind and the numbers of its faces. The faces of meshes are numbered differently:
 * see instance_set.h. */
typedef struct primitive {
    const struct primitive_rule *rule; /* rule of its kind (primitives/primitive.h); NULL for a mesh */
    bool turned;                       /* rotation is not the identity */
    mat3 rotation;                     /* local to world */
    vec3 origin;                       /* origin of the local frame in the world */
    double radius, m2;                 /* cylinder: x^2 + m2 z^2 <= radius^2; m2 is 1 for all others */
    double bottom, top;                /* local y; a cylinder's top may be infinite */
    union {
        vec3 half; /* box */
        lens_sides lens;
    };
    double second_radius; /* a second radius, for kinds that have one */
    int sides;            /* number of equal sides around the axis; 0 for none */
    const vec3 *normals;  /* of the sides; owned by the scene geometry */
    /* The surface of a liquid (capillary_profile), what the sides of a lens have besides conics (lens_details), or the
     * primitive that this one is when scaled (scaled_primitive); NULL for none. Owned by the scene geometry. */
    const void *details;
    int64_t first_face;
    int rows;           /* number of its scratch rows: the most intervals that a ray can have in it */
    int priority_index; /* of its region */
    double extent;      /* farthest finite coordinate from the world's origin, for error bounds */
} primitive;

/* A primitive in a frame that is scaled along its axes (primitives/scaled_kernel.c): at the origin, marked as turned by
 * the identity, as upright primitives read terms of the batch (ray_scratch) that do not apply in that frame. */
typedef struct scaled_primitive {
    vec3 scale, inverse; /* not 0; 1 / scale */
    primitive inner;
} scaled_primitive;

typedef struct region {
    int outside, hollow; /* primitives; hollow = -1 for none */
    int64_t medium;      /* equal numbers are equal media */
    bool opaque;
    double shadow_transmittance; /* fraction of the light that a shadow ray keeps at each interface; 0 if opaque */
    /* By material slot, for a mesh whose faces differ; shadow_transmittance is then the least of these. Borrowed, or
     * NULL. */
    const double *face_shadow_transmittance;
    const int *face_slots; /* by face of its primitive, instead of a mesh: the slot; borrowed, or NULL */
    bool attenuates;       /* its medium attenuates light along the path */
    bool reflects;         /* its reflectance depends on the angle: shadow rays record crossings (ray_crossings) */
    bool partial;          /* its surface is partial */
    int solid;             /* index of the solid it came from */
} region;

/* Where a region comes from: the source, and which of the solids that its shape stands for (solid_shape_copy). */
typedef struct region_origin {
    uint32_t source, copy;
} region_origin;

typedef struct scene_geometry {
    int primitive_count;
    primitive *primitives;          /* the direct ones first */
    int direct_count;               /* at most PRIMITIVES_MAX */
    int *direct_regions;            /* the priority indices of their regions, ascending ... */
    int direct_region_count;        /* ... and how many */
    const struct solid_view *outer; /* in a view's geometry: the view, for the scene's numbers; else NULL */
    struct solid_tree *tree;        /* for the other primitives; NULL if all are direct */
    int region_count;               /* priority indices 1 .. region_count */
    int highest_transparent;        /* the highest priority index of a region that is not opaque; 0 for none */
    region *regions;                /* [0] is the surrounding medium */
    solid_shape *shapes;            /* by source; their points are borrowed */
    region_origin *origins;         /* by priority index; [0] is unused */
    double extent;                  /* the largest extent of a primitive */
    uint64_t further;               /* bits of rows for further intervals of the primitive before them */
    uint64_t opaque_regions;        /* bit r - 1: the region of priority index r is opaque; 0 with a tree */
    bool distinct;                  /* no two regions have equal media, and none has the surrounding medium */
    bool attenuates;                /* a region or the surrounding medium attenuates */
    bool partial;                   /* some region is partial */
    struct instance_set *meshes;    /* all meshes; NULL without meshes */
    vec3 *normals;                  /* of all primitives with sides */
    int normal_count;
    char *details; /* of all primitives that have some */
    size_t detail_bytes;
} scene_geometry;

/* Whether a region reduces the light along a shadow ray. With solid_shadows every region does. */
static inline bool region_casts_shadow(const region *b, bool solid_shadows)
{
    return b->opaque || solid_shadows || b->shadow_transmittance < 1.0 || b->attenuates || b->reflects || b->partial;
}

/* The shape of a region, without points. */
static inline solid_shape scene_geometry_shape(const scene_geometry *g, int priority_index)
{
    const region_origin from = g->origins[priority_index];
    return solid_shape_copy(&g->shapes[from.source], from.copy);
}

/* Description of a solid for scene_geometry_build, which has a region for each of its points. */
typedef struct region_source {
    const solid_shape *shape;
    const struct hierarchy *tree; /* over the triangles of a mesh; borrowed, like the mesh */
    int64_t priority;             /* the higher priority wins; of equal ones the earlier in the list */
    int64_t medium;
    int64_t further_media; /* copy i > 0 of the shape's solids has the medium further_media + i; 0: all have `medium` */
    bool opaque;
    double shadow_transmittance;
    const double *face_shadow_transmittance; /* by material slot; borrowed, or NULL */
    const int *face_slots;                   /* by face, for a primitive; borrowed, or NULL */
    bool attenuates, reflects, partial;
    int solid;
} region_source;

/* Which solids a hierarchy finds. The hits, and so the film, are the same with each. */
typedef enum tree_use {
    TREE_IF_MANY,     /* all bounded ones without triangles, if there are enough that this is faster */
    TREE_IF_TOO_MANY, /* only if there are more primitives than bits */
    TREE_ALWAYS
} tree_use;

/* outside_medium is the surrounding medium. STATUS_BAD_INPUT for more than PRIMITIVES_MAX planes and meshes. */
status scene_geometry_build(const region_source *sources, int count, int64_t outside_medium, tree_use use,
                            scene_geometry **out, diagnostic *why);
void scene_geometry_destroy(scene_geometry *g);

/* Declares that the surrounding medium absorbs: the media of every shadow ray are then recorded. */
void scene_geometry_surroundings_absorb(scene_geometry *g);

/* The set of primitives that contain a point, by the primitives' own definitions (surfaces included). */
uint64_t scene_geometry_inside(const scene_geometry *g, vec3 point);

/* Whether the primitive is in the set; false for -1. */
bool scene_geometry_set_has(const scene_geometry *g, uint64_t set, int p);

/* Whether memory ran out for a set of this geometry. Results since then are wrong. */
bool scene_geometry_failed(const scene_geometry *g);

/* The priority index of the region that owns the interface between two media: an opaque region if either is opaque (the
 * one after, if both are), otherwise the one with the higher priority index. */
int scene_geometry_surface(const scene_geometry *g, int before, int after);

/* The priority index of the medium for a set of primitives. */
int scene_geometry_priority_index(const scene_geometry *g, uint64_t inside);
