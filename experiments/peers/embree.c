/* embree - camera and shadow rays through the triangle sets of Cuvette's mesh bench, traced by Embree 3 on one thread.
 *   embree [-m sparse|dense|sphere] [-n TRIANGLES] [-k 1|16|1,16] [-r ROUNDS]
 * k: rays one at a time (rtcIntersect1, rtcOccluded1), or in packets of 16, squares of 4 x 4 pixels. The triangles are
 * Cuvette's own (geometry/mesh/mesh_generators.h), the rays those of mesh_rays.h. Prints a line for each k and round:
 * milliseconds of CPU time, and exact counts of hits and of shadow rays that are blocked. */
#include <embree3/rtcore.h>

#include "geometry/mesh/mesh_generators.h"
#include "mesh_rays.h"

#include <errno.h>
#include <stdalign.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    COLUMNS = MESH_RAYS_COLUMNS,
    ROWS = MESH_RAYS_ROWS,
    TILE_COLUMNS = MESH_RAYS_TILE_COLUMNS,
    TILE_ROWS = MESH_RAYS_TILE_ROWS
};
enum { SINGLE = 1, PACKET = 16, PACKET_EDGE = 4, ROUNDS_MAX = 10000 };
static const char usage[] = "embree [-m sparse|dense|sphere] [-n TRIANGLES] [-k 1|16|1,16] [-r ROUNDS]";

typedef struct order {
    const char *set;
    size_t triangles;
    int sizes[2], size_count, rounds;
} order;

typedef struct tally {
    unsigned long long hits, blocked;
    double total_t;
} tally;

/* CPU time, because wall time includes other processes. */
static double cpu_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static struct RTCIntersectContext coherent(void)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

/* --- one ray at a time --- */

static void trace_ray(RTCScene scene, int x, int y, tally *a)
{
    struct RTCIntersectContext context = coherent();
    float d[3];
    mesh_rays_direction(x, y, d);
    struct RTCRayHit r = {.ray = {.org_x = mesh_rays_eye[0],
                                  .org_y = mesh_rays_eye[1],
                                  .org_z = mesh_rays_eye[2],
                                  .dir_x = d[0],
                                  .dir_y = d[1],
                                  .dir_z = d[2],
                                  .tfar = INFINITY,
                                  .mask = ~0u},
                          .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    rtcIntersect1(scene, &context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    const float t = r.ray.tfar;
    struct RTCRay s = {.org_x = mesh_rays_eye[0] + t * d[0],
                       .org_y = mesh_rays_eye[1] + t * d[1],
                       .org_z = mesh_rays_eye[2] + t * d[2],
                       .tnear = mesh_rays_shadow_near,
                       .tfar = 1.0f,
                       .mask = ~0u};
    s.dir_x = mesh_rays_light[0] - s.org_x;
    s.dir_y = mesh_rays_light[1] - s.org_y;
    s.dir_z = mesh_rays_light[2] - s.org_z;
    rtcOccluded1(scene, &context, &s);
    a->hits++;
    a->total_t += (double)t;
    a->blocked += s.tfar < 0.0f; /* Embree sets tfar of a blocked ray to -infinity */
}

/* --- packets of 16 --- */

static void packet_of_camera_rays(int x, int y, struct RTCRayHit16 *r)
{
    for (int i = 0; i < PACKET; i++) {
        float d[3];
        mesh_rays_direction(x + i % PACKET_EDGE, y + i / PACKET_EDGE, d);
        r->ray.org_x[i] = mesh_rays_eye[0];
        r->ray.org_y[i] = mesh_rays_eye[1];
        r->ray.org_z[i] = mesh_rays_eye[2];
        r->ray.dir_x[i] = d[0];
        r->ray.dir_y[i] = d[1];
        r->ray.dir_z[i] = d[2];
        r->ray.tnear[i] = r->ray.time[i] = 0.0f;
        r->ray.tfar[i] = INFINITY;
        r->ray.mask[i] = ~0u;
        r->ray.id[i] = r->ray.flags[i] = 0;
        r->hit.geomID[i] = r->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
}

/* The shadow rays of the `valid` lanes; the other lanes hold arbitrary finite numbers. */
static void packet_of_shadow_rays(const struct RTCRayHit16 *r, const int *valid, struct RTCRay16 *s)
{
    for (int i = 0; i < PACKET; i++) {
        const float t = valid[i] ? r->ray.tfar[i] : 0.0f;
        s->org_x[i] = mesh_rays_eye[0] + t * r->ray.dir_x[i];
        s->org_y[i] = mesh_rays_eye[1] + t * r->ray.dir_y[i];
        s->org_z[i] = mesh_rays_eye[2] + t * r->ray.dir_z[i];
        s->dir_x[i] = mesh_rays_light[0] - s->org_x[i];
        s->dir_y[i] = mesh_rays_light[1] - s->org_y[i];
        s->dir_z[i] = mesh_rays_light[2] - s->org_z[i];
        s->tnear[i] = mesh_rays_shadow_near;
        s->tfar[i] = 1.0f;
        s->time[i] = 0.0f;
        s->mask[i] = ~0u;
        s->id[i] = s->flags[i] = 0;
    }
}

static void trace_packet(RTCScene scene, int x, int y, tally *a)
{
    struct RTCIntersectContext context = coherent();
    alignas(64) struct RTCRayHit16 r;
    alignas(64) struct RTCRay16 s;
    alignas(64) int valid[PACKET];
    int hits = 0;
    memset(valid, -1, sizeof valid);
    packet_of_camera_rays(x, y, &r);
    rtcIntersect16(valid, scene, &context, &r);
    for (int i = 0; i < PACKET; i++) {
        valid[i] = r.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? -1 : 0;
        hits -= valid[i];
        a->total_t += valid[i] ? (double)r.ray.tfar[i] : 0.0;
    }
    a->hits += (unsigned)hits;
    if (!hits)
        return;
    packet_of_shadow_rays(&r, valid, &s);
    rtcOccluded16(valid, scene, &context, &s);
    for (int i = 0; i < PACKET; i++)
        a->blocked += valid[i] && s.tfar[i] < 0.0f;
}

/* Traces in tiles as in Cuvette's bench, for both packet sizes, so that neighbouring rays share the caches. */
static tally frame(RTCScene scene, int size)
{
    const int step = size == SINGLE ? 1 : PACKET_EDGE;
    tally a = {0};
    for (int tile = 0; tile < COLUMNS * ROWS / (TILE_COLUMNS * TILE_ROWS); tile++) {
        const int x0 = tile % (COLUMNS / TILE_COLUMNS) * TILE_COLUMNS, y0 = tile / (COLUMNS / TILE_COLUMNS) * TILE_ROWS;
        for (int y = y0; y < y0 + TILE_ROWS; y += step)
            for (int x = x0; x < x0 + TILE_COLUMNS; x += step)
                (size == SINGLE ? trace_ray : trace_packet)(scene, x, y, &a);
    }
    return a;
}

/* --- the scene --- */

/* Copies the mesh to buffers that Embree owns. False when out of memory. */
static bool fill(RTCGeometry geometry, const mesh *m)
{
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                              m->vertex_count);
    unsigned *corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(unsigned), m->triangle_count);
    if (!vertices || !corners)
        return false;
    for (size_t i = 0; i < m->vertex_count; i++) {
        vertices[3 * i] = (float)m->vertices[i].x;
        vertices[3 * i + 1] = (float)m->vertices[i].y;
        vertices[3 * i + 2] = (float)m->vertices[i].z;
    }
    for (size_t i = 0; i < m->triangle_count; i++)
        memcpy(corners + 3 * i, m->triangles[i].corner, 3 * sizeof *corners);
    return true;
}

/* Builds the scene on one thread, with Embree's defaults. NULL on failure. */
static RTCScene build(RTCDevice device, const mesh *m)
{
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    bool built = scene && geometry && fill(geometry, m);
    if (built) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
        built = rtcGetDeviceError(device) == RTC_ERROR_NONE;
    }
    rtcReleaseGeometry(geometry);
    if (!built && scene)
        rtcReleaseScene(scene);
    return built ? scene : NULL;
}

static bool bench(const order *o, const mesh *m)
{
    RTCDevice device = rtcNewDevice("threads=1");
    const double begun = cpu_s();
    RTCScene scene = device ? build(device, m) : NULL;
    const double build_s = cpu_s() - begun;
    if (!scene) {
        fprintf(stderr, "embree: Embree builds nothing of %zu triangles (error %d); set fewer with -n\n",
                m->triangle_count, (int)rtcGetDeviceError(device));
        if (device)
            rtcReleaseDevice(device);
        return false;
    }
    printf("round\tset\ttriangles\tbuild_ms\tk\thits\tblocked\tcpu_ms\tmean_t\n");
    for (int round = 0; round < o->rounds; round++)
        for (int i = 0; i < o->size_count; i++) {
            const double start = cpu_s();
            const tally a = frame(scene, o->sizes[i]);
            printf("%d\t%s\t%zu\t%.2f\t%d\t%llu\t%llu\t%.3f\t%.6f\n", round, o->set, m->triangle_count, 1e3 * build_s,
                   o->sizes[i], a.hits, a.blocked, 1e3 * (cpu_s() - start), a.hits ? a.total_t / (double)a.hits : 0.0);
            fflush(stdout);
        }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    return true;
}

/* --- options --- */

static bool read_count(const char *text, long high, long *out)
{
    char *end;
    errno = 0;
    *out = strtol(text, &end, 10);
    return end != text && !*end && !errno && *out >= 1 && *out <= high;
}

static bool read_sizes(const char *text, order *o)
{
    static const struct {
        const char *text;
        int count, sizes[2];
    } known[] = {{"1", 1, {SINGLE}}, {"16", 1, {PACKET}}, {"1,16", 2, {SINGLE, PACKET}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(text, known[i].text)) {
            o->size_count = known[i].count;
            memcpy(o->sizes, known[i].sizes, sizeof o->sizes);
            return true;
        }
    return false;
}

/* False for a value that is out of range, or for an unknown option. */
static bool read_option(int option, const char *text, order *o)
{
    long value;
    switch (option) {
    case 'm': o->set = text; return !strcmp(text, "sparse") || !strcmp(text, "dense") || !strcmp(text, "sphere");
    case 'n':
        if (!read_count(text, MESH_TRIANGLES_MAX, &value))
            return false;
        o->triangles = (size_t)value;
        return true;
    case 'r':
        if (!read_count(text, ROUNDS_MAX, &value))
            return false;
        o->rounds = (int)value;
        return true;
    case 'k': return read_sizes(text, o);
    default: return false;
    }
}

int main(int count, char **words)
{
    order o = {.set = "sparse", .triangles = 10000, .sizes = {SINGLE, PACKET}, .size_count = 2, .rounds = 1};
    opterr = 0;
    for (int option; (option = getopt(count, words, "m:n:k:r:")) != -1;)
        if (!read_option(option, optarg, &o)) {
            if (option == '?')
                fprintf(stderr, "embree: option '-%c' is unknown or has no value; usage: %s\n", optopt, usage);
            else
                fprintf(stderr, "embree: '%s' is no value of -%c; usage: %s\n", optarg, option, usage);
            return 2;
        }
    if (optind < count) {
        fprintf(stderr, "embree: unexpected argument '%s'; usage: %s\n", words[optind], usage);
        return 2;
    }
    mesh *m = NULL;
    diagnostic why = {0};
    char text[DIAGNOSTIC_TEXT_MAX];
    if ((!strcmp(o.set, "sparse")  ? generate_sparse_soup
         : !strcmp(o.set, "dense") ? generate_dense_soup
                                   : generate_sphere)(o.triangles, &m, &why) != STATUS_OK) {
        fprintf(stderr, "embree: %s\n", diagnostic_text(&why, text, sizeof text));
        return 1;
    }
    const bool done = bench(&o, m);
    mesh_release(m);
    return done ? 0 : 1;
}
