/* Embree 3 as a reference for speed: its own hierarchy and triangle test, in single precision, one ray at a time. The
 * Makefile defines CUVETTE_EMBREE if Embree's header is present. Sides of triangles are determined from the mesh's own
 * corners and not from Embree's normal. */
#include "geometry/hierarchy_private.h"

#ifdef CUVETTE_EMBREE

#include "base/cancel.h"
#include <dlfcn.h>
#include <embree3/rtcore.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

/* Embree's functions, loaded when the first of its hierarchies is built: with the libraries that it needs in turn they
 * cost 5 ms at the start of a process. */
#define EACH_FUNCTION(X)                                                   \
    X(attachGeometry, rtcAttachGeometry)                                   \
    X(commitGeometry, rtcCommitGeometry)                                   \
    X(commitScene, rtcCommitScene)                                         \
    X(getDeviceError, rtcGetDeviceError)                                   \
    X(intersect1, rtcIntersect1)                                           \
    X(newDevice, rtcNewDevice)                                             \
    X(newGeometry, rtcNewGeometry)                                         \
    X(newScene, rtcNewScene)                                               \
    X(occluded1, rtcOccluded1)                                             \
    X(releaseDevice, rtcReleaseDevice)                                     \
    X(releaseGeometry, rtcReleaseGeometry)                                 \
    X(releaseScene, rtcReleaseScene)                                       \
    X(setDeviceMemoryMonitorFunction, rtcSetDeviceMemoryMonitorFunction)   \
    X(setNewGeometryBuffer, rtcSetNewGeometryBuffer)                       \
    X(setSceneProgressMonitorFunction, rtcSetSceneProgressMonitorFunction) \
    X(setSceneFlags, rtcSetSceneFlags)

static struct {
#define DECLARE(name, symbol) __typeof__(symbol) *name;
    EACH_FUNCTION(DECLARE)
} embree;

static bool loaded;

static void load(void)
{
    void *library = dlopen("libembree3.so.3", RTLD_NOW | RTLD_LOCAL);
    loaded = library != NULL;
#define FIND(name, symbol) loaded = loaded && (*(void **)&embree.name = dlsym(library, #symbol));
    EACH_FUNCTION(FIND)
}

typedef struct foreign {
    RTCDevice device;
    RTCScene scene;
} foreign;

/* A query, as Embree's filter needs it. */
typedef struct query {
    struct RTCIntersectContext context; /* first, so that Embree's pointer to it also points to the query */
    const hierarchy *h;
    const mesh_ray *ray;
    mesh_visit *visit; /* NULL except for QUERY_ALL */
    void *visited;
} query;

static int facing_of(const mesh *m, const mesh_ray *ray, uint32_t triangle)
{
    const uint32_t *corner = m->triangles[triangle].corner;
    vec3 a = m->vertices[corner[0]], b = m->vertices[corner[1]], c = m->vertices[corner[2]];
    vec3 normal = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    return vec3_dot(normal, ray->direction) < 0.0 ? FACING_FRONT : FACING_BACK;
}

/* Rejects hits on the ray's own triangle and on sides that the query excludes. For QUERY_ALL it reports each hit and
 * rejects it too, so that the search continues. Only single rays are traced, so that Embree passes one ray and one
 * hit. */
static void filter(const struct RTCFilterFunctionNArguments *p)
{
    const query *q = (const query *)p->context;
    const struct RTCRay *ray = (const struct RTCRay *)p->ray;
    const struct RTCHit *found = (const struct RTCHit *)p->hit;
    mesh_hit hit = {.t = (double)ray->tfar, .u = (double)found->u, .v = (double)found->v, .triangle = found->primID};
    hit.facing = facing_of(q->h->of, q->ray, hit.triangle);
    bool wanted = hit.triangle != q->ray->skip && (hit.facing & q->ray->facing);
    if (wanted && q->visit)
        q->visit(q->visited, &hit);
    if (!wanted || q->visit)
        p->valid[0] = 0;
}

static query start(const hierarchy *h, const mesh_ray *ray, struct RTCRay *out)
{
    query q = {.h = h, .ray = ray};
    rtcInitIntersectContext(&q.context);
    if (ray->skip != TRIANGLE_NONE || ray->facing != FACING_ANY)
        q.context.filter = filter;
    *out = (struct RTCRay){.org_x = (float)ray->origin.x,
                           .org_y = (float)ray->origin.y,
                           .org_z = (float)ray->origin.z,
                           .tnear = (float)(ray->t_min > 0.0 ? ray->t_min : 0.0),
                           .dir_x = (float)ray->direction.x,
                           .dir_y = (float)ray->direction.y,
                           .dir_z = (float)ray->direction.z,
                           .tfar = (float)ray->t_max,
                           .mask = ~0u};
    return q;
}

void hierarchy_embree_nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit)
{
    const foreign *f = h->foreign;
    struct RTCRayHit r;
    query q = start(h, ray, &r.ray);
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree.intersect1(f->scene, &q.context, &r);
    *hit = (mesh_hit){.triangle = TRIANGLE_NONE};
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    *hit = (mesh_hit){.t = (double)r.ray.tfar, .u = (double)r.hit.u, .v = (double)r.hit.v, .triangle = r.hit.primID};
    hit->facing = facing_of(h->of, ray, hit->triangle);
}

bool hierarchy_embree_any(const hierarchy *h, const mesh_ray *ray)
{
    const foreign *f = h->foreign;
    struct RTCRay r;
    query q = start(h, ray, &r);
    embree.occluded1(f->scene, &q.context, &r);
    return r.tfar < 0.0f; /* Embree marks a hit by a negative tfar */
}

void hierarchy_embree_all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context)
{
    const foreign *f = h->foreign;
    struct RTCRayHit r;
    query q = start(h, ray, &r.ray);
    q.context.filter = filter;
    q.visit = visit;
    q.visited = context;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree.intersect1(f->scene, &q.context, &r);
}

/* Copies the mesh into Embree's own buffers. */
static bool fill(const mesh *m, RTCGeometry g)
{
    float *v = embree.setNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                           m->vertex_count);
    uint32_t *corner = embree.setNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                   sizeof m->triangles[0], m->triangle_count);
    if (!v || !corner)
        return false;
    for (size_t i = 0; i < m->vertex_count && !cancel_asked_at(i); i++) {
        v[3 * i] = (float)m->vertices[i].x;
        v[3 * i + 1] = (float)m->vertices[i].y;
        v[3 * i + 2] = (float)m->vertices[i].z;
    }
    for (size_t i = 0; i < m->triangle_count && !cancel_asked_at(i); i++)
        for (size_t k = 0; k < 3; k++)
            corner[3 * i + k] = m->triangles[i].corner[k];
    return !cancel_asked();
}

static bool count_bytes(void *bytes, ssize_t more, bool after)
{
    (void)after;
    __atomic_fetch_add((size_t *)bytes, (size_t)more, __ATOMIC_RELAXED);
    return true;
}

/* On any of Embree's threads. */
static bool goes_on(void *token, double share)
{
    (void)share;
    cancel_follow(token);
    return !cancel_asked();
}

static bool commit(const hierarchy *h, foreign *f)
{
    f->scene = embree.newScene(f->device);
    RTCGeometry g = embree.newGeometry(f->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    bool filled = f->scene && g && (h->of->triangle_count == 0 || fill(h->of, g));
    if (filled && h->of->triangle_count > 0) {
        embree.commitGeometry(g);
        embree.attachGeometry(f->scene, g);
    }
    if (g)
        embree.releaseGeometry(g);
    if (filled) {
        embree.setSceneFlags(f->scene, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
        embree.setSceneProgressMonitorFunction(f->scene, goes_on, cancel_current());
        embree.commitScene(f->scene);
        embree.setSceneProgressMonitorFunction(f->scene, NULL, NULL);
    }
    return filled && embree.getDeviceError(f->device) == RTC_ERROR_NONE;
}

status hierarchy_build_embree(hierarchy *h, int threads, diagnostic *why)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    char config[32];
    pthread_once(&once, load);
    if (!loaded)
        return diagnose(why, STATUS_BAD_INPUT, "install libembree3-3 or choose another hierarchy",
                        "Embree's library cannot be loaded");
    snprintf(config, sizeof config, "threads=%d", threads);
    foreign *f = calloc(1, sizeof *f);
    h->foreign = f;
    if (!f)
        return out_of_memory(why);
    f->device = embree.newDevice(config);
    if (!f->device)
        return diagnose(why, STATUS_FAILURE, "choose another hierarchy", "Embree cannot create a device (error %d)",
                        (int)embree.getDeviceError(NULL));
    size_t bytes = 0;
    embree.setDeviceMemoryMonitorFunction(f->device, count_bytes, &bytes);
    bool built = commit(h, f);
    embree.setDeviceMemoryMonitorFunction(f->device, NULL, NULL);
    if (!built && cancel_asked())
        return cancel_check(why);
    if (!built)
        return diagnose(why, STATUS_FAILURE, "choose another hierarchy", "Embree cannot build its hierarchy");
    h->report.bytes = sizeof *h + bytes;
    return STATUS_OK;
}

void hierarchy_embree_destroy(hierarchy *h)
{
    foreign *f = h->foreign;
    if (f && f->scene)
        embree.releaseScene(f->scene);
    if (f && f->device)
        embree.releaseDevice(f->device);
    free(f);
    h->foreign = NULL;
}

#else

void hierarchy_embree_nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit)
{
    (void)h, (void)ray;
    *hit = (mesh_hit){.triangle = TRIANGLE_NONE};
}

bool hierarchy_embree_any(const hierarchy *h, const mesh_ray *ray)
{
    (void)h, (void)ray;
    return false;
}

void hierarchy_embree_all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context)
{
    (void)h, (void)ray, (void)visit, (void)context;
}

status hierarchy_build_embree(hierarchy *h, int threads, diagnostic *why)
{
    (void)h, (void)threads;
    return diagnose(why, STATUS_BAD_INPUT, "install libembree-dev and build again",
                    "this program was built without Embree");
}

void hierarchy_embree_destroy(hierarchy *h)
{
    h->foreign = NULL;
}

#endif
