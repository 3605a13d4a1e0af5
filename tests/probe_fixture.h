/* Scenes written line by line, and single rays traced through them, for tests that use render/inspect/probe.h. Each
 * call asserts that it succeeded. Ownership: stage_of creates, stage_close releases; a tree belongs to its stage and is
 * valid until its next ray. */
#pragma once

#include "scene/model/scene.h"
#include "optics/interface.h"
#include "quad.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"
#include <stdarg.h>

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define DEGREE 0.017453292519943295

typedef struct scene_text {
    char at[16384];
    size_t length;
} scene_text;

__attribute__((format(printf, 2, 3))) static inline void add(scene_text *t, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int n = vsnprintf(t->at + t->length, sizeof t->at - t->length, format, list);
    va_end(list);
    t->length += (size_t)n;
    assert_true(n >= 0 && t->length < sizeof t->at);
}

/* A sky of 1 in every channel, no lights; the solids follow, one a line, by add_clear. */
static inline scene_text scene_begin(double surrounding_ior, int depth)
{
    scene_text t = {.length = 0};
    add(&t, "background: {color: [1, 1, 1], ior: %.17g}\nrender: {depth: %d, width: 1, height: 1}\nsolids:\n",
        surrounding_ior, depth);
    return t;
}

/* A transparent solid; more: further keys, as "shape: sphere, radius: 2". */
static inline void add_clear(scene_text *t, const char *name, double ior, int priority, vec3 position,
                             vec3 rotation_deg, const char *more)
{
    add(t,
        "  %s: {transparency: 1, ior: %.17g, priority: %d, position: [%.17g, %.17g, %.17g], rotation: [%.17g, %.17g, "
        "%.17g], %s}\n",
        name, ior, priority, position.x, position.y, position.z, rotation_deg.x, rotation_deg.y, rotation_deg.z, more);
}

typedef struct stage {
    scene *setting;
    probe *probe;
    ray_tree tree;
} stage;

static inline void stage_look(stage *g)
{
    diagnostic why = {0};
    probe_destroy(g->probe);
    g->probe = NULL;
    worked(probe_create(g->setting, isa_best(), &g->probe, &why), &why);
}

static inline stage stage_of(const char *text, const char *assignments)
{
    stage g = {.setting = scene_from(text)};
    set_all(g.setting, assignments);
    stage_look(&g);
    return g;
}

static inline void stage_close(stage *g)
{
    ray_tree_release(&g->tree);
    probe_destroy(g->probe);
    scene_destroy(g->setting);
    memset(g, 0, sizeof *g);
}

static inline const ray_tree *stage_way(stage *g, vec3 origin, vec3 direction, int reflect_at)
{
    diagnostic why = {0};
    worked(probe_path(g->probe, origin, direction, reflect_at, &g->tree, &why), &why);
    return &g->tree;
}

static inline const ray_tree *stage_ray(stage *g, vec3 origin, vec3 direction)
{
    diagnostic why = {0};
    worked(probe_ray(g->probe, origin, direction, &g->tree, &why), &why);
    return &g->tree;
}

static inline const ray_tree *stage_pixel(stage *g, int x, int y)
{
    diagnostic why = {0};
    worked(probe_pixel(g->probe, x, y, &g->tree, &why), &why);
    return &g->tree;
}

/* The child of a kind, or NULL. */
static inline const ray_node *child_of(const ray_tree *tree, const ray_node *parent, ray_kind kind)
{
    for (int i = parent->first_child; i != RAY_NONE; i = tree->node[i].next)
        if (tree->node[i].kind == kind)
            return &tree->node[i];
    return NULL;
}

/* Sum of the throughput of all rays cut off by the depth limit or render.min_weight, in one channel. */
static inline double tree_cut(const ray_tree *tree, int channel)
{
    double sum = 0.0;
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == RAY_END_CUT_DEPTH || tree->node[i].end == RAY_END_CUT_WEIGHT)
            sum += tree->node[i].throughput[channel];
    return sum;
}

/* Power reflectances from the angles: Hecht, Optics, 5th ed., eqs. 4.42 and 4.43, squared; at normal incidence 4.47. */
typedef struct reflectance {
    double s, p, mean;
} reflectance;

static inline reflectance reflectance_of_angles(double angle_i, double n_from, double n_to)
{
    const double angle_t = asin(n_from / n_to * sin(angle_i)), minus = angle_i - angle_t, plus = angle_i + angle_t;
    const double normal = (n_from - n_to) / (n_from + n_to);
    const double s = plus < 1e-7 ? normal : sin(minus) / sin(plus), p = plus < 1e-7 ? normal : tan(minus) / tan(plus);
    return (reflectance){s * s, p * p, 0.5 * (s * s + p * p)};
}

/* Rotates from a frame with rotation_deg to the world's, in quadruple precision; rounded. */
static inline vec3 turned(vec3 local, vec3 rotation_deg)
{
    const quad3 v = quad3_turn(quad3_from(local), rotation_deg, 0);
    return vec3_make((double)v.x, (double)v.y, (double)v.z);
}

static inline double apart(vec3 a, vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}
