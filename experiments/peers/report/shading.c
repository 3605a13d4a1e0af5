/* The report's listing 3: refraction, Phong's terms, and the recursion. Line numbers are the listing's. */
#include "report.h"

#include <stdlib.h>

/* The listing's constants; it prints the first two by name only, the third as a number. */
static const float global_illumination = 0.2f, epsilon = 1e-4f, step = 0.001f;
static const rgb sky = {0.53f, 0.75f, 0.92f};

static rgb rgb_scale(rgb a, float k)
{
    return (rgb){a.r * k, a.g * k, a.b * k};
}

static rgb rgb_add(rgb a, rgb b)
{
    return (rgb){a.r + b.r, a.g + b.g, a.b + b.b};
}

/* Lines 14 to 20. Total reflection returns a fixed direction. */
static vec3f refracted(vec3f incident, vec3f normal, float cosine, float from, float to)
{
    if (cosine < 0.0f)
        return refracted(incident, normal, -cosine, to, from);
    const float eta = from / to, sine = eta * sqrtf(most(0.0f, 1.0f - cosine * cosine));
    if (sine >= 1.0f)
        return (vec3f){-1.0f, 0.0f, 0.0f};
    return add(scale(incident, eta), scale(normal, eta * cosine - sqrtf(most(0.0f, 1.0f - sine * sine))));
}

/* The result of a step of the shadow ray. */
typedef enum passage { PASSAGE_ON, PASSAGE_LIT, PASSAGE_DARK } passage;

/* Lines 28 to 51: one cast of the shadow ray, and the effect of the blocker. Clear shapes attenuate and refract it; a
 * shape beyond the light blocks it, too. */
static passage shadow_step(const room *in, vec3f to_light, ray *shadow, const shape **leaving, float *passed)
{
    hit *blocker = room_cast(in, shadow);
    if (!blocker)
        return PASSAGE_LIT;
    const hit found = *blocker;
    free(blocker);
    const vec3f from_light = sub(found.position, in->light);
    if (dot(from_light, from_light) < epsilon)
        return PASSAGE_LIT;
    if (found.shape == *leaving) {
        if (dot(found.normal, to_light) <= 0.0f)
            return PASSAGE_DARK;
        shadow->origin = add(found.position, scale(to_light, step));
        return PASSAGE_ON;
    }
    const float transparency = found.shape->transparency * 0.9f;
    if (transparency <= 0.0f)
        return PASSAGE_DARK;
    *passed *= transparency;
    if (*passed < 0.01f)
        return PASSAGE_DARK;
    shadow->direction = unit(refracted(to_light, found.normal, dot(to_light, found.normal), found.shape->index, 1.0f));
    shadow->origin = add(found.position, scale(to_light, step));
    *leaving = found.shape;
    return PASSAGE_ON;
}

/* Lines 21 to 55. A shadow ray takes as many steps as the recursion has levels: at depth 0 none is cast. */
static float diffuse(const room *in, const hit *at, tally *counted)
{
    const vec3f to_light = unit(sub(in->light, at->position));
    ray shadow = {add(at->position, scale(to_light, step)), to_light};
    const shape *leaving = at->shape;
    float passed = 1.0f;
    passage end = PASSAGE_ON;
    for (int i = 0; i < in->depth && end == PASSAGE_ON; i++) {
        counted->shadow++;
        end = shadow_step(in, to_light, &shadow, &leaving, &passed);
    }
    if (end == PASSAGE_DARK)
        return global_illumination;
    return most(global_illumination, least(1.0f, dot(at->normal, to_light)) * passed);
}

/* Lines 56 to 60, which normalise the light's position instead of the difference. */
static float specular(const room *in, const hit *at)
{
    const vec3f from_light = unit(sub(at->position, unit(in->light)));
    const vec3f mirrored = sub(from_light, scale(at->normal, 2.0f * dot(from_light, at->normal)));
    return powf(most(0.0f, dot(mirrored, unit(sub(in->eye, at->position)))), 2.0f) * at->shape->reflectivity;
}

static rgb shade(const room *in, const hit *at, int limit, tally *counted);

/* Lines 76 to 83: one branch. Both are traced at every hit, also on opaque shapes, whatever their weight. */
static rgb branch(const room *in, const hit *at, vec3f direction, int limit, tally *counted)
{
    hit *next = NULL;
    if (limit > 0) {
        const ray r = {add(at->position, scale(direction, step)), direction};
        counted->secondary++;
        next = room_cast(in, &r);
    }
    if (!next) {
        counted->sky++;
        return sky;
    }
    const rgb color = shade(in, next, limit - 1, counted);
    free(next);
    return color;
}

/* Lines 61 to 86. */
static rgb shade(const room *in, const hit *at, int limit, tally *counted)
{
    const shape *s = at->shape;
    const float lit = diffuse(in, at, counted), gloss = specular(in, at);
    const float cosine = dot(at->ray.direction, at->normal);
    const vec3f mirrored = sub(at->ray.direction, scale(at->normal, 2.0f * cosine));
    const rgb reflection = branch(in, at, mirrored, limit, counted);
    const rgb refraction =
        branch(in, at, refracted(at->ray.direction, at->normal, cosine, s->index, at->index), limit, counted);
    const rgb mixed = rgb_add(rgb_scale(s->color, 1.0f - s->reflectivity), rgb_scale(reflection, s->reflectivity));
    const rgb local = rgb_add(rgb_scale(mixed, lit), (rgb){gloss, gloss, gloss});
    return rgb_add(rgb_add(local, rgb_scale(reflection, s->reflectivity * s->emission)),
                   rgb_scale(refraction, s->transparency));
}

/* Lines 87 to 94. The camera looks downwards by its pitch. */
rgb room_pixel(const room *in, float u, float v, tally *counted)
{
    const vec3f d = unit((vec3f){u, v, in->distance});
    const float c = cosf(in->pitch), s = sinf(in->pitch);
    const ray r = {in->eye, {d.x, d.y * c - d.z * s, d.y * s + d.z * c}};
    counted->camera++;
    hit *first = room_cast(in, &r);
    if (!first) {
        counted->sky++;
        return sky;
    }
    counted->first_hits[first->shape - in->shapes]++;
    const rgb color = shade(in, first, in->depth, counted);
    free(first);
    return color;
}
