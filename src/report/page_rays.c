/* Collects the rays of a page, and keeps the heaviest. */
#include "report/page_rays.h"

#include "base/array.h"
#include "render/inspect/ray_line.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>

/* Rays with less than this share of the light are left out, as in the laboratory's drawing. */
#define LIGHTEST 0.002
/* The heaviest are sorted out whenever that many are held. */
enum { HELD = 8 * PAGE_RAYS_MAX };

typedef struct collecting {
    page_rays *r;
    const scene *s;
    camera_frame view;
    image_frame frame;
} collecting;

static int by_weight(const void *a, const void *b)
{
    const page_ray *x = a, *y = b;
    if (x->weight != y->weight)
        return x->weight > y->weight ? -1 : 1;
    return x->place < y->place ? -1 : x->place > y->place;
}

static int by_place(const void *a, const void *b)
{
    const page_ray *x = a, *y = b;
    return x->place < y->place ? -1 : x->place > y->place;
}

static void keep_heaviest(page_rays *r)
{
    if (r->count <= PAGE_RAYS_MAX)
        return;
    qsort(r->ray, r->count, sizeof *r->ray, by_weight);
    r->count = PAGE_RAYS_MAX;
}

static void name_hit(const collecting *c, page_ray *ray, const probe *p)
{
    const ray_hit *h = &ray->node.hit;
    snprintf(ray->from, sizeof ray->from, "%s", probe_medium_name(p, h->from));
    snprintf(ray->to, sizeof ray->to, "%s", h->opaque ? "" : probe_medium_name(p, h->to));
    snprintf(ray->surface, sizeof ray->surface, "%s: %s", scene_solid_name(c->s, h->solid), probe_face_name(p, h));
}

static page_ray *add(const collecting *c, const ray_node *node, double weight, const probe *p)
{
    page_rays *r = c->r;
    if (r->count == HELD)
        keep_heaviest(r);
    if (!GROW(r->ray, r->capacity, r->count + 1))
        return NULL;
    page_ray *ray = &r->ray[r->count++];
    *ray = (page_ray){.node = *node, .weight = weight, .place = r->traced};
    if (node->end == RAY_END_HIT)
        name_hit(c, ray, p);
    else
        snprintf(ray->from, sizeof ray->from, "%s", probe_medium_name(p, node->medium));
    const ray_line line = ray_line_of(node);
    ray->drawn = ray_line_seen(&line, &c->view, &c->frame, ray->ends);
    return ray;
}

static bool is_traced(const ray_node *node)
{
    return node->end != RAY_END_CUT_DEPTH && node->end != RAY_END_CUT_WEIGHT;
}

/* A shadow ray has the weight of its parent, because its own throughput is a radiance. */
static double weight_of(const ray_tree *tree, const ray_node *node)
{
    const double all = beam_fraction(&tree->node[0]);
    return beam_fraction(node->kind == RAY_SHADOW ? &tree->node[node->parent] : node) / (all > 0.0 ? all : 1.0);
}

static status take_beam_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    const collecting *c = context;
    const beam *b = &c->s->beams[ray->beam];
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        const double weight = weight_of(tree, node);
        if (!is_traced(node))
            continue;
        c->r->traced++;
        if (weight < LIGHTEST)
            continue;
        page_ray *one = add(c, node, weight, p);
        if (!one)
            return out_of_memory(why);
        one->power = ray->power * beam_fraction(node);
        one->lambda_nm = ray->lambda_nm;
        beam_line_color(b, ray->lambda_nm, one->rgb);
        snprintf(one->of, sizeof one->of, "%s %d", b->name, ray->number + 1);
    }
    return STATUS_OK;
}

static status take_tree(const collecting *c, const ray_tree *tree, const probe *p, diagnostic *why)
{
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (!is_traced(node))
            continue;
        c->r->traced++;
        const double weight = weight_of(tree, node);
        page_ray *one = weight < LIGHTEST ? NULL : add(c, node, weight, p);
        if (!one && weight >= LIGHTEST)
            return out_of_memory(why);
        if (one && node->kind == RAY_SHADOW)
            snprintf(one->of, sizeof one->of, "%s", scene_light_name(c->s, node->light));
    }
    return STATUS_OK;
}

static status collect_pixel(const collecting *c, isa level, diagnostic *why)
{
    probe *p = NULL;
    ray_tree tree = {0};
    status code = probe_create(c->s, level, &p, why);
    c->r->x = c->frame.width / 2, c->r->y = c->frame.height / 2;
    THEN(code, probe_pixel(p, c->r->x, c->r->y, &tree, why));
    THEN(code, take_tree(c, &tree, p, why));
    c->r->lambda_nm = tree.lambda_nm;
    ray_tree_release(&tree);
    probe_destroy(p);
    return code;
}

status page_rays_collect(page_rays *r, const scene *s, isa level, int width, int height, diagnostic *why)
{
    collecting c = {r, s, camera_frame_of(s), image_frame_of(width, height, 0.0)};
    for (size_t i = 0; i < s->beam_count; i++)
        r->beams |= s->beams[i].visible != 0;
    TRY(r->beams ? beams_each_ray(s, level, 0, take_beam_ray, &c, why) : collect_pixel(&c, level, why));
    keep_heaviest(r);
    if (r->count > 0)
        qsort(r->ray, r->count, sizeof *r->ray, by_place);
    return STATUS_OK;
}

void page_rays_release(page_rays *r)
{
    free(r->ray);
    *r = (page_rays){.ray = NULL};
}
