/* bench_mesh - rays per second through the mesh hierarchies, for the rays of experiments/peers/mesh_rays.h: a camera of
 * 800 x 600 and, from each visible point, a ray to a point light.
 *  bench_mesh [-m sparse|dense|sphere|all] [-n N,...] [-a none|sphere|octant|bvh] [-k 1|128,...] [-r REPEATS]
 *  [-t BUILD_THREADS]
 * k: single rays, or batches of 128, tiles of 16 x 8 pixels. Times are CPU milliseconds per frame, medians. Prints a
 * row for each set and k; sum is over the triangles hit and the bits of t, so that equal sums mean equal hits. */
#include "../experiments/peers/mesh_rays.h"
#include "base/isa.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/mesh/mesh_generators.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { COLUMNS = MESH_RAYS_COLUMNS, ROWS = MESH_RAYS_ROWS };
enum { TILE_COLUMNS = MESH_RAYS_TILE_COLUMNS, TILE_ROWS = MESH_RAYS_TILE_ROWS, TILE = TILE_COLUMNS * TILE_ROWS };

static const hierarchy_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(hierarchy_kernels);

typedef struct tally {
    uint64_t hits, occluded, sum;
    double total_t;
} tally;

/* CPU time, so that other processes on the machine do not count. */
static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static vec3 exactly(const float v[3])
{
    return vec3_make((double)v[0], (double)v[1], (double)v[2]);
}

static mesh_ray camera_ray(int x, int y)
{
    float d[3];
    mesh_rays_direction(x, y, d);
    return (mesh_ray){exactly(mesh_rays_eye), exactly(d), 0.0, (double)INFINITY, TRIANGLE_NONE, FACING_ANY};
}

static mesh_ray shadow_ray(const mesh_ray *from, double t)
{
    const vec3 p = vec3_add(from->origin, vec3_scale(from->direction, t));
    return (mesh_ray){p, vec3_sub(exactly(mesh_rays_light), p), 1e-3, 1.0, TRIANGLE_NONE, FACING_ANY};
}

static void count_hit(tally *a, const mesh_hit *hit)
{
    uint64_t bits;
    memcpy(&bits, &hit->t, sizeof bits);
    a->hits++;
    a->total_t += hit->t;
    a->sum += (bits ^ (uint64_t)hit->triangle << 32) * 0x9e3779b97f4a7c15u;
}

static void tile_of_batches(const hierarchy_kernels *kernel, const hierarchy *h, int x0, int y0, tally *a)
{
    mesh_ray rays[TILE], shadows[TILE];
    mesh_hit hits[TILE];
    bool occluded[TILE];
    int lit = 0;
    for (int i = 0; i < TILE; i++)
        rays[i] = camera_ray(x0 + i % TILE_COLUMNS, y0 + i / TILE_COLUMNS);
    kernel->nearest_batch(h, rays, TILE, hits);
    for (int i = 0; i < TILE; i++)
        if (hits[i].triangle != TRIANGLE_NONE) {
            count_hit(a, &hits[i]);
            shadows[lit++] = shadow_ray(&rays[i], hits[i].t);
        }
    kernel->any_batch(h, shadows, lit, occluded);
    for (int i = 0; i < lit; i++)
        a->occluded += occluded[i];
}

static void tile_of_rays(const hierarchy_kernels *kernel, const hierarchy *h, int x0, int y0, tally *a)
{
    for (int i = 0; i < TILE; i++) {
        const mesh_ray ray = camera_ray(x0 + i % TILE_COLUMNS, y0 + i / TILE_COLUMNS);
        mesh_hit hit;
        kernel->nearest(h, &ray, &hit);
        if (hit.triangle == TRIANGLE_NONE)
            continue;
        count_hit(a, &hit);
        const mesh_ray shadow = shadow_ray(&ray, hit.t);
        a->occluded += kernel->any(h, &shadow);
    }
}

static tally frame(const hierarchy_kernels *kernel, const hierarchy *h, int k)
{
    tally a = {0};
    for (int y = 0; y < ROWS; y += TILE_ROWS)
        for (int x = 0; x < COLUMNS; x += TILE_COLUMNS)
            (k == 1 ? tile_of_rays : tile_of_batches)(kernel, h, x, y, &a);
    return a;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool bench(const char *mode, size_t count, hierarchy_kind kind, const char *sizes, int repeats, int threads)
{
    mesh *m = NULL;
    hierarchy *h = NULL;
    diagnostic why = {0};
    isa level = ISA_BASE;
    char text[DIAGNOSTIC_TEXT_MAX];
    status s = isa_choose(&level, &why);
    if (s == STATUS_OK)
        s = (!strcmp(mode, "sparse")  ? generate_sparse_soup
             : !strcmp(mode, "dense") ? generate_dense_soup
                                      : generate_sphere)(count, &m, &why);
    if (s == STATUS_OK)
        s = hierarchy_build(m, kind, threads, &h, &why);
    if (s != STATUS_OK)
        fprintf(stderr, "bench_mesh: %s\n", diagnostic_text(&why, text, sizeof text));
    for (const char *k = sizes; s == STATUS_OK && k; k = strchr(k, ',') ? strchr(k, ',') + 1 : NULL) {
        double seconds[99];
        tally a = {0};
        for (int i = 0; i < repeats; i++) {
            const double begun = now_s();
            a = frame(kernels[level], h, atoi(k));
            seconds[i] = now_s() - begun;
        }
        qsort(seconds, (size_t)repeats, sizeof *seconds, by_value);
        const double median = seconds[repeats / 2];
        const hierarchy_report r = hierarchy_describe(h);
        printf("%s\t%zu\t%.2f\t%d\t%d\t%.1f\t%llu\t%llu\t%.2f\t%.3f\t%016llx\t%.6f\n", mode, m->triangle_count,
               1e3 * r.build_s, r.threads, atoi(k), (double)r.bytes / (double)m->triangle_count,
               (unsigned long long)a.hits, (unsigned long long)a.occluded, 1e3 * median,
               ((double)COLUMNS * ROWS + (double)a.hits) / median / 1e6, (unsigned long long)a.sum,
               a.hits ? a.total_t / (double)a.hits : 0.0);
        fflush(stdout);
    }
    hierarchy_destroy(h);
    mesh_release(m);
    return s == STATUS_OK;
}

int main(int count, char **words)
{
    static const char *const kind_names[] = {"none", "sphere", "octant", "bvh"}, *const modes[] = {"sparse", "dense",
                                                                                                   "sphere"};
    const char *mode = "all", *numbers = "10000,50000,1000000", *kind = "bvh", *sizes = "1,128";
    int repeats = 7, threads = 1, chosen = 0;
    for (int i = 1; i + 1 < count; i += 2)
        switch (words[i][1]) {
        case 'm': mode = words[i + 1]; break;
        case 'n': numbers = words[i + 1]; break;
        case 'a': kind = words[i + 1]; break;
        case 'k': sizes = words[i + 1]; break;
        case 'r': repeats = atoi(words[i + 1]); break;
        case 't': threads = atoi(words[i + 1]); break;
        default: fprintf(stderr, "bench_mesh: no option %s; see the head of bench_mesh.c\n", words[i]); return 2;
        }
    while (chosen < HIERARCHY_KIND_COUNT && strcmp(kind, kind_names[chosen]) != 0)
        chosen++;
    if (chosen == HIERARCHY_KIND_COUNT || repeats < 1 || repeats > 99)
        return 2;
    printf("mode\ttris\tbuild_ms\tthreads\tk\tbytes/tri\thits\toccl\tcpu_ms\tMrays/s\tsum\tmean_t\n");
    for (int i = 0; i < 3; i++)
        if (!strcmp(mode, "all") || !strcmp(mode, modes[i]))
            for (const char *n = numbers; n; n = strchr(n, ',') ? strchr(n, ',') + 1 : NULL)
                if (!bench(modes[i], strtoul(n, NULL, 10), (hierarchy_kind)chosen, sizes, repeats, threads))
                    return 1;
    return 0;
}
