/* bench_refit - the time of a hierarchy's refit compared with that of its build by one thread, for icospheres of levels
 * 2 to 7 whose vertices move before each. Wall time in milliseconds, medians.
 *  bench_refit [-l FIRST,LAST] [-r REPEATS]
 * Prints a row for each level. A repeat moves and refits the mesh FRAMES times, then rebuilds a hierarchy, so that
 * drift of the machine affects all equally. The first refit after a build finds the caches full of the build's data and
 * is reported separately, as cold_ms. cost_ratio is the refitted hierarchy's cost over that of one built for the same
 * positions, after a twist by one radian and a squash to 0.7. */
#include "geometry/mesh_generators.h"
#include "geometry/hierarchy.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { REPEATS_MAX = 99, FRAMES = 5 };

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_value);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* A squash along y and a twist about it. */
static void deform(const vec3 *from, size_t count, double phase, vec3 *to)
{
    for (size_t i = 0; i < count; i++) {
        const double angle = phase * from[i].y, c = cos(angle), s = sin(angle);
        to[i] =
            vec3_make(c * from[i].x - s * from[i].z, from[i].y * (1.0 - 0.3 * phase), s * from[i].x + c * from[i].z);
    }
}

typedef struct row {
    double move[REPEATS_MAX * FRAMES], refit[REPEATS_MAX * FRAMES], cold[REPEATS_MAX], build[REPEATS_MAX], cost_ratio;
} row;

static status move_and_refit(mesh *m, hierarchy *h, const vec3 *positions, double *move_s, double *refit_s,
                             diagnostic *why)
{
    const double begun = now_s();
    const status s = mesh_move(m, positions, NULL, why);
    const double moved = now_s();
    if (s != STATUS_OK)
        return s;
    if (!hierarchy_refit(h))
        return diagnose(why, STATUS_FAILURE, "", "a hierarchy could not be refitted");
    *move_s = moved - begun;
    *refit_s = now_s() - moved;
    return STATUS_OK;
}

static status once(mesh *m, hierarchy *h, const vec3 *positions, row *r, int repeat, diagnostic *why)
{
    double move_s;
    status s = move_and_refit(m, h, positions, &move_s, &r->cold[repeat], why);
    for (int i = repeat * FRAMES; s == STATUS_OK && i < (repeat + 1) * FRAMES; i++)
        s = move_and_refit(m, h, positions, &r->move[i], &r->refit[i], why);
    hierarchy *fresh = NULL;
    if (s == STATUS_OK)
        s = hierarchy_build(m, HIERARCHY_BVH, 1, &fresh, why);
    if (s != STATUS_OK)
        return s;
    r->build[repeat] = hierarchy_describe(fresh).build_s;
    r->cost_ratio = hierarchy_cost(h) / hierarchy_cost(fresh);
    hierarchy_destroy(fresh);
    return STATUS_OK;
}

static status bench(int level, int repeats, diagnostic *why)
{
    mesh *m = NULL;
    hierarchy *h = NULL;
    vec3 *rest = NULL, *positions = NULL;
    row r;
    status s = generate_icosphere(level, &m, why);
    if (s == STATUS_OK)
        s = hierarchy_build(m, HIERARCHY_BVH, 1, &h, why);
    if (s == STATUS_OK) {
        rest = malloc(m->vertex_count * sizeof *rest);
        positions = malloc(m->vertex_count * sizeof *positions);
        s = rest && positions ? STATUS_OK : diagnose(why, STATUS_FAILURE, "", "out of memory");
    }
    if (s == STATUS_OK)
        for (size_t i = 0; i < m->vertex_count; i++)
            rest[i] = m->vertices[i];
    for (int i = 0; s == STATUS_OK && i < repeats; i++) {
        deform(rest, m->vertex_count, (double)(i + 1) / (double)repeats, positions);
        s = once(m, h, positions, &r, i, why);
    }
    if (s == STATUS_OK) {
        const double move_s = median(r.move, repeats * FRAMES), refit_s = median(r.refit, repeats * FRAMES),
                     cold_s = median(r.cold, repeats), build_s = median(r.build, repeats);
        printf("%d\t%zu\t%.4f\t%.4f\t%.4f\t%.4f\t%.2f\t%.4f\n", level, m->triangle_count, 1e3 * move_s, 1e3 * refit_s,
               1e3 * cold_s, 1e3 * build_s, build_s / refit_s, r.cost_ratio);
        fflush(stdout);
    }
    free(positions);
    free(rest);
    hierarchy_destroy(h);
    mesh_release(m);
    return s;
}

int main(int count, char **words)
{
    int first = 2, last = 7, repeats = 15;
    for (int i = 1; i + 1 < count; i += 2)
        switch (words[i][1]) {
        case 'l':
            first = last = atoi(words[i + 1]);
            sscanf(words[i + 1], "%d,%d", &first, &last);
            break;
        case 'r': repeats = atoi(words[i + 1]); break;
        default:
            fprintf(stderr, "bench_refit: no option %s; see the head of tests/bench_refit.c\n", words[i]);
            return 2;
        }
    if (repeats < 1 || repeats > REPEATS_MAX || first < 0 || last > ICOSPHERE_LEVEL_MAX)
        return 2;
    printf("level\ttriangles\tmove_ms\trefit_ms\tcold_ms\tbuild_ms\tbuild/refit\tcost_ratio\n");
    for (int level = first; level <= last; level++) {
        diagnostic why = {0};
        char text[DIAGNOSTIC_TEXT_MAX];
        if (bench(level, repeats, &why) != STATUS_OK) {
            fprintf(stderr, "bench_refit: %s\n", diagnostic_text(&why, text, sizeof text));
            return 1;
        }
    }
    return 0;
}
