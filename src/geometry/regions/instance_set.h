/* The instance set of a scene geometry: every copy of every mesh, in a top-level hierarchy above the hierarchies of the
 * triangles (as in Embree or pbrt), so that a copy costs little memory and a ray visits all meshes in one traversal.
 *
 * A mesh's face is numbered by its primitive, copy and triangle (see mesh_face_number). Ownership: instance_set_build
 * creates, instance_set_destroy frees; meshes and their hierarchies are borrowed. */
#pragma once

#include "base/isa.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/primitives/primitive.h"
#include "geometry/rays.h"

/* One mesh solid: all its copies are one primitive. */
typedef struct instanced_mesh {
    const mesh *triangles;
    const hierarchy *tree;
    int primitive, priority_index;
    bool closed; /* it contains points; otherwise it is an open surface */
    bool turned, scaled;
    mat3 rotation; /* local frame to world */
    vec3 scale, origin;
    vec3 spacing;
    uint32_t copies[3];
    size_t first_instance;
    double reach; /* largest coordinate of the mesh in its own frame, after scaling */
} instanced_mesh;

typedef struct instance_set {
    int part_count;
    instanced_mesh *parts;
    size_t instance_count;
    mesh *proxies;                  /* one triangle spanning the bounds of each instance; NULL for a single instance */
    hierarchy *top;                 /* over the proxies */
    bounds3 world;                  /* of all instances, widened beyond the rounding error */
    uint64_t primitives;            /* sets of primitives: all meshes ... */
    uint64_t closed, open_surfaces; /* ... and separately the closed meshes and the open surfaces */
    int lowest;                     /* the lowest priority index of a mesh */
    uint64_t *closed_under;         /* by priority index: the closed meshes below it */
    int lowest_closed;              /* the lowest priority index of a closed mesh; INT_MAX for none */
    int by_primitive[PRIMITIVES_MAX]; /* index of the mesh, or -1 */
} instance_set;

/* A ray for the instance set: its range of t, its current medium, and what it looks for. */
typedef struct instance_ray {
    vec3 origin, direction;
    double t_min, t_max;
    double tie;           /* for cross: a front and a back of one mesh within this difference of t coincide ... */
    double tie_by_extent; /* ... plus this fraction of the mesh's extent */
    int64_t start;        /* the face that it starts on, at its origin or where it was continued; or FACE_NONE */
    int64_t before;       /* priority index of its current medium, which hides meshes below it */
    uint64_t inside;      /* primitives that contain its start */
    uint64_t wanted;      /* primitives that it looks for */
    query_counts *counts; /* where its queries are counted (hierarchy_count), or NULL; one for all rays of a batch */
} instance_ray;

/* A mesh's faces have bit 62 set, so that they never equal the face number of an analytic solid. */
#define MESH_FACE ((int64_t)1 << 62)
static inline int64_t mesh_face_number(int bit, uint32_t copy, uint32_t triangle)
{
    return MESH_FACE | (int64_t)bit << 54 | (int64_t)copy << 32 | (int64_t)triangle;
}
static inline bool is_mesh_face(int64_t face)
{
    return face > 0 && (face & MESH_FACE);
}
static inline int mesh_face_primitive(int64_t face)
{
    return (int)(face >> 54 & 0x3f);
}
static inline uint32_t mesh_face_copy(int64_t face)
{
    return (uint32_t)(face >> 32 & 0x3fffff);
}
static inline uint32_t mesh_face_triangle(int64_t face)
{
    return (uint32_t)(face & 0xffffffff);
}

/* The face's triangle in the solid's mesh, of which the part may be an operand (hierarchy_operands). */
static inline uint32_t instance_set_triangle(const instance_set *f, int64_t face)
{
    const uint32_t *numbers = f->parts[f->by_primitive[mesh_face_primitive(face)]].triangles->numbers;
    return numbers ? numbers[mesh_face_triangle(face)] : mesh_face_triangle(face);
}

/* Description of a mesh solid for instance_set_build. */
typedef struct instance_source {
    const solid_shape *shape;
    const hierarchy *tree;
    int primitive, priority_index;
    bool partial; /* an open surface, even if its mesh is closed */
} instance_source;

/* region_count: the highest priority index of the scene. */
status instance_set_build(const instance_source *sources, int count, int region_count, instance_set **out,
                          diagnostic *why);
void instance_set_destroy(instance_set *f);

/* Origin of a copy's frame in the world. */
vec3 instance_set_origin(const instanced_mesh *p, uint32_t copy);

/* A measure of the coordinates of the copy with that face, for error bounds: the largest coordinate of its origin, plus
 * the mesh's reach, which a rotated copy can exceed by a factor of up to sqrt(3). */
double instance_set_extent(const instance_set *f, int64_t face);

/* Texture coordinates at a hit, and their larger gradient per scene unit; 0 for a mesh without them. */
surface_mapping instance_set_mapping(const instance_set *f, const instance_hit *hit);

/* A vertex relative to its copy's origin, along the world's axes. */
static inline vec3 instance_set_vertex_offset(const instanced_mesh *p, uint32_t vertex)
{
    const vec3 v = p->triangles->vertices[vertex];
    const vec3 scaled = p->scaled ? vec3_make(v.x * p->scale.x, v.y * p->scale.y, v.z * p->scale.z) : v;
    return p->turned ? mat3_apply(p->rotation, scaled) : scaled;
}

/* A vertex's normal in the world (a unit vector; zero if the mesh has no normals), and its position. */
vec3 instance_set_vertex_normal(const instanced_mesh *p, uint32_t vertex);
vec3 instance_set_vertex_point(const instanced_mesh *p, uint32_t copy, uint32_t vertex);

typedef void instance_found(void *context, const instance_hit *hit);

/* The kernels, one set per instruction set. All sets return bit-identical results. */
typedef struct instance_kernels {
    /* The next relevant crossing: the exit of a mesh that the ray is in, the entry of one that it is not in and that
     * the medium does not hide, or either side of an open surface. */
    void (*nearest)(const instance_set *f, const instance_ray *rays, int count, instance_hit *hits);
    /* Writes for each ray whether any mesh of the wanted set blocks it. Closed meshes count as for nearest,
     * but also where a solid of higher priority hides them. */
    void (*any)(const instance_set *f, const instance_ray *rays, int count, bool *blocked);
    /* The set of primitives after all crossings of wanted meshes in t_min < t <= t_max; an open surface in between has
     * its bit set, too. */
    uint64_t (*cross)(const instance_set *f, const instance_ray *ray);
    /* Calls `found` for every crossing of wanted meshes in t_min < t <= t_max, hidden or not, in no particular
     * order. */
    void (*each)(const instance_set *f, const instance_ray *ray, instance_found *found, void *context);
} instance_kernels;

ISA_DECLARE(const instance_kernels, instance_kernels)
