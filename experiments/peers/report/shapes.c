/* The report's listings 1 (cylinder) and 2 (box), a plane, and the nearest hit of all shapes. */
#include "report.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* The listings' EPS, whose value they do not print. */
static const float epsilon = 1e-4f;

void *allocate(size_t bytes)
{
    void *memory = malloc(bytes);
    if (!memory) {
        fprintf(stderr, "report: memory is out (%zu bytes); set a smaller size or fewer threads\n", bytes);
        exit(1);
    }
    return memory;
}

/* A point on the heap, as in the listings. */
static vec3f *point(const ray *r, float t)
{
    vec3f *p = allocate(sizeof *p);
    *p = add(r->origin, scale(r->direction, t));
    return p;
}

/* True if the ray hits the plane of a cap within the cap. */
static bool cap_covers(const shape *s, const ray *r, float t)
{
    const vec3f p = add(sub(r->origin, s->position), scale(r->direction, t));
    return p.x * p.x + p.z * p.z - s->radius * s->radius < epsilon;
}

/* True if the point at t is in front of the origin and between the caps; false for NaN. */
static bool side_reaches(const shape *s, const ray *r, float t)
{
    return !(fabsf(r->origin.y + t * r->direction.y - s->position.y) > s->half_height) && t > 0.0f;
}

/* Listing 1. Both caps share one flag, the nearer one of their planes counts even behind the origin, and grazing rays
 * (a discriminant below epsilon) miss the side: as printed. */
static vec3f *cylinder_intersect(const shape *s, const ray *r)
{
    const vec3f o = r->origin, d = r->direction, p = s->position;
    const float top = (s->half_height - o.y + p.y) / (d.y + epsilon),
                base = (-s->half_height - o.y + p.y) / (d.y + epsilon);
    const bool capped = cap_covers(s, r, top) || cap_covers(s, r, base);
    const float a = d.x * d.x + d.z * d.z;
    const float b = o.x * d.x - d.x * p.x + o.z * d.z - d.z * p.z;
    const float c =
        o.x * o.x + p.x * p.x + o.z * o.z + p.z * p.z - 2.0f * (p.x * o.x + o.z * p.z) - s->radius * s->radius;
    const float discriminant = b * b - a * c, cap = least(top, base);
    if (discriminant < epsilon) {
        if (!capped)
            return NULL;
        if (side_reaches(s, r, cap))
            return point(r, cap);
    }
    const float near = (-b - sqrtf(discriminant)) / a, far = (-b + sqrtf(discriminant)) / a;
    const float side = near < 0.0f ? far : near;
    if (side_reaches(s, r, side))
        return point(r, side);
    return capped && side_reaches(s, r, cap) ? point(r, cap) : NULL;
}

/* The normal of the nearer of the two surfaces; the listings do not print it. */
static vec3f cylinder_normal(const shape *s, vec3f at)
{
    const vec3f d = sub(at, s->position);
    const float from_side = fabsf(sqrtf(d.x * d.x + d.z * d.z) - s->radius),
                from_cap = fabsf(fabsf(d.y) - s->half_height);
    return from_cap < from_side ? (vec3f){0.0f, d.y > 0.0f ? 1.0f : -1.0f, 0.0f} : unit((vec3f){d.x, 0.0f, d.z});
}

/* Listing 2. The nearer of the two points counts, even behind an origin within the box: as printed. */
static vec3f *box_intersect(const shape *s, const ray *r)
{
    const float origin[3] = {r->origin.x, r->origin.y, r->origin.z},
                direction[3] = {r->direction.x, r->direction.y, r->direction.z};
    const float low[3] = {s->low.x, s->low.y, s->low.z}, high[3] = {s->high.x, s->high.y, s->high.z};
    float near = -INFINITY, far = INFINITY;
    bool met = true;
    for (int i = 0; i < 3; i++) {
        if (direction[i] == 0.0f) {
            if (origin[i] < low[i] || origin[i] > high[i])
                met = false;
            continue;
        }
        const float a = (low[i] - origin[i]) / direction[i], b = (high[i] - origin[i]) / direction[i];
        near = most(near, least(a, b));
        far = least(far, most(a, b));
        if (near > far || far < 0.0f)
            met = false;
    }
    return met ? point(r, near) : NULL;
}

/* The normal of the nearest of the six faces. */
static vec3f box_normal(const shape *s, vec3f at)
{
    const float from[6] = {fabsf(at.x - s->low.x),  fabsf(at.x - s->high.x), fabsf(at.y - s->low.y),
                           fabsf(at.y - s->high.y), fabsf(at.z - s->low.z),  fabsf(at.z - s->high.z)};
    int face = 0;
    for (int i = 1; i < 6; i++)
        if (from[i] < from[face])
            face = i;
    const float side = face % 2 ? 1.0f : -1.0f;
    return (vec3f){face / 2 == 0 ? side : 0.0f, face / 2 == 1 ? side : 0.0f, face / 2 == 2 ? side : 0.0f};
}

static vec3f *plane_intersect(const shape *s, const ray *r)
{
    const float t = (s->position.y - r->origin.y) / r->direction.y;
    return isfinite(t) && t > 0.0f ? point(r, t) : NULL;
}

static vec3f plane_normal(const shape *s, vec3f at)
{
    (void)s;
    (void)at;
    return (vec3f){0.0f, 1.0f, 0.0f};
}

/* The report's constant weights, for both clear shapes. Its vessel is a solid cylinder, and the liquid another cylinder
 * inside. */
static shape clear_cylinder(float base, float height, float radius, float index, rgb color)
{
    return (shape){.intersect = cylinder_intersect,
                   .normal = cylinder_normal,
                   .position = {0.0f, base + height / 2.0f, 0.0f},
                   .radius = radius,
                   .half_height = height / 2.0f,
                   .color = color,
                   .reflectivity = 0.1f,
                   .transparency = 0.9f,
                   .index = index,
                   .emission = 0.5f};
}

/* The lengths, eye and lamp of experiments/scenes/rod.yaml. */
void room_fill(room *out, const setting *of)
{
    *out = (room){.light = {4.0f, 7.0f, -5.0f}, .eye = {0.0f, 2.75f, -6.0f}, .depth = of->depth};
    out->pitch = atan2f(2.75f - 1.5f, 6.0f);
    out->distance = 1.0f / tanf(of->fov_deg * (float)M_PI / 360.0f);
    out->shapes[SHAPE_GROUND] =
        (shape){.intersect = plane_intersect, .normal = plane_normal, .color = {0.7f, 0.7f, 0.7f}, .index = 1.0f};
    out->shapes[SHAPE_VESSEL] = clear_cylinder(0.001f, 3.0f, 1.0f, of->glass_index, (rgb){0.2f, 0.2f, 0.25f});
    out->shapes[SHAPE_LIQUID] = clear_cylinder(0.101f, 1.9f, 0.9f, of->liquid_index, (rgb){0.1f, 0.15f, 0.3f});
    out->shapes[SHAPE_ROD] = (shape){.intersect = box_intersect,
                                     .normal = box_normal,
                                     .low = {0.075f, 0.601f, -0.125f},
                                     .high = {0.325f, 3.601f, 0.125f},
                                     .color = {0.85f, 0.15f, 0.1f},
                                     .reflectivity = 0.1f,
                                     .index = 1.0f};
}

hit *room_cast(const room *in, const ray *r)
{
    const shape *nearest = NULL;
    vec3f *where = NULL;
    float shortest = INFINITY;
    for (int i = 0; i < SHAPE_COUNT; i++) {
        vec3f *p = in->shapes[i].intersect(&in->shapes[i], r);
        if (!p)
            continue;
        const vec3f apart = sub(*p, r->origin);
        const float squared = dot(apart, apart);
        if (squared < shortest) {
            shortest = squared;
            nearest = &in->shapes[i];
            free(where);
            where = p;
        } else {
            free(p);
        }
    }
    if (!nearest)
        return NULL;
    hit *found = allocate(sizeof *found);
    *found = (hit){
        .ray = *r, .shape = nearest, .position = *where, .normal = nearest->normal(nearest, *where), .index = 1.0f};
    free(where);
    return found;
}
