/* The meshes of an arrangement together: every copy of every mesh, in a hierarchy of their own above the hierarchies of
 * their triangles, so that a copy costs little and a ray looks at all of them on one way down.
 *
 * A mesh's face is numbered by its primitive, copy and triangle: see mesh_face_number. Ownership: instance_set_build
 * gives, instance_set_destroy releases; meshes and their hierarchies are borrowed. */
#pragma once

#include "geometry/hierarchy.h"
#include "geometry/rays.h"

/* One mesh solid: all its copies are one primitive. */
typedef struct instanced_mesh {
    const mesh *triangles;
    const hierarchy *tree;
    int primitive, priority_index;
    bool closed; /* it contains points; else it is a skin */
    bool turned, scaled;
    mat3 rotation; /* its frame to the world */
    vec3 scale, origin;
    vec3 spacing;
    uint32_t copies[3];
    size_t first_instance;
    double reach; /* largest coordinate of the mesh in its frame, scaled */
} instanced_mesh;

typedef struct instance_set {
    int part_count;
    instanced_mesh *parts;
    size_t instance_count;
    mesh *proxies;          /* a triangle that spans the bounds of each instance; NULL when there is but one instance */
    hierarchy *top;         /* over these */
    uint64_t primitives;    /* sets: of all meshes ... */
    uint64_t closed, skins; /* ... and of either kind */
    int lowest;             /* rank of the lowest mesh */
    uint64_t closed_under[PRIMITIVES_MAX + 1]; /* by rank: the closed meshes of lower ones */
    int lowest_closed;                         /* rank of the lowest closed mesh; INT_MAX for none */
    int by_primitive[PRIMITIVES_MAX];          /* part, or -1 */
} instance_set;

/* Where a ray is in the order of media, and which stretch of it is asked about. */
typedef struct instance_ray {
    vec3 origin, direction;
    double t_min, t_max;
    double tie;           /* of cross: a front and a back of one mesh that are no farther apart are at one place ... */
    double tie_by_extent; /* ... and this share of the mesh's extent is added to it */
    int64_t start;        /* face that it starts on, at its origin or where it was passed on; or FACE_NONE */
    int64_t before;       /* rank of the medium that it is in: meshes under it are hidden */
    uint64_t inside;      /* primitives that it is in */
    uint64_t wanted;      /* primitives that it looks for */
} instance_ray;

/* A mesh's faces have bit 62 set, so that no analytic solid's face number is one of them. */
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

/* What instance_set_build wants to know of a mesh solid. */
typedef struct instance_source {
    const solid_shape *shape;
    const hierarchy *tree;
    int primitive, priority_index;
} instance_source;

status instance_set_build(const instance_source *sources, int count, instance_set **out, diagnostic *why);
void instance_set_destroy(instance_set *f);

/* Origin of a copy's frame in the world. */
vec3 instance_set_origin(const instanced_mesh *p, uint32_t copy);

/* How far the copy with that face reaches from the world's origin at most: a bound on each of its coordinates. */
double instance_set_extent(const instance_set *f, int64_t face);

/* The set of meshes that contain a point, by the side of the nearest surface in a fixed direction. */
uint64_t instance_set_inside(const instance_set *f, vec3 point);

/* Points on meshes, for what looks at surfaces. */
typedef struct mesh_points {
    double gx[ROW], gy[ROW], gz[ROW]; /* geometric normal, a unit vector against the ray */
    double tu[ROW], tv[ROW];          /* texture coordinates; 0 where a mesh has none */
    double uv_per_length[ROW];        /* how far they run in one scene unit */
    int64_t slot[ROW];
    double weight[3][ROW];   /* of the triangle's corners */
    uint32_t corner[3][ROW]; /* its vertices */
} mesh_points;

/* The points that rays hit: position, error bound, face, and a normal, which is the interpolated one where `smooth`
 * says so and the mesh has any, bent so that neither the reflection nor the surface is seen from behind (see
 * instance_set_surface.c). */
void instance_set_surface(const instance_set *f, const ray_batch *rays, const instance_hit *hits, bool smooth,
                          surface_batch *points, mesh_points *more);

/* A vertex's normal in the world, of the part (a unit vector; zero where the mesh has no normals), and its place. */
vec3 instance_set_vertex_normal(const instanced_mesh *p, uint32_t vertex);
vec3 instance_set_vertex_point(const instanced_mesh *p, uint32_t copy, uint32_t vertex);

typedef void instance_found(void *context, const instance_hit *hit);

/* The kernels, one set for each instruction set; the same bits from all. */
typedef struct instance_kernels {
    /* The next crossing that matters: of a mesh that the ray is in, where it leaves; of one that it is not in and that
     * the medium does not hide, where it enters; of a skin, either side. */
    void (*nearest)(const instance_set *f, const instance_ray *rays, int count, instance_hit *hits);
    /* Is anything of the wanted set in the way? Closed meshes as above, whatever hides them. */
    void (*any)(const instance_set *f, const instance_ray *rays, int count, bool *blocked);
    /* The set behind all crossings of wanted meshes in t_min < t <= t_max; bits of skins that were crossed are set. */
    uint64_t (*cross)(const instance_set *f, const instance_ray *ray);
    /* Calls found for every crossing of wanted meshes in t_min < t <= t_max, whatever hides them, in no order. */
    void (*each)(const instance_set *f, const instance_ray *ray, instance_found *found, void *context);
} instance_kernels;

extern const instance_kernels instance_kernels_sse2, instance_kernels_avx2, instance_kernels_avx512;
