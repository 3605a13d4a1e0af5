/* A drawing of a ray tree with two panels: the plane of incidence of the first hit, and the view from above. */
#include "base/cancel.h"
#include "report/diagram.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"

/* Rays with less than this fraction of the root's weight are not drawn. */
#define LIGHTEST 0.002

typedef struct ray_style {
    const char *color, *words, *dashes;
} ray_style;

/* The styles of all kinds of rays; shadow rays that do not reach the light are `blocked`. */
static const ray_style styles[] = {
    [RAY_CAMERA] = {SVG_INK, "camera ray", NULL},
    [RAY_REFLECT] = {SVG_VERMILLION, "reflected", NULL},
    [RAY_REFRACT] = {SVG_BLUE, "refracted", NULL},
    [RAY_SHADOW] = {SVG_ORANGE, "to a light", "5,3"},
};
static const ray_style blocked = {SVG_GREY, "blocked", "5,3"};

/* A shadow ray has the weight of its parent, because its own throughput is a radiance. */
static double weight_of(const ray_tree *tree, const ray_node *node)
{
    const ray_node *weighted = node->kind == RAY_SHADOW ? &tree->node[node->parent] : node;
    const double weight = diagram_weight(weighted) / diagram_weight(&tree->node[0]);
    return weight < 1.0 ? weight : 1.0;
}

static vec3 along(const ray_node *node, double length)
{
    return vec3_add(node->origin, vec3_scale(node->direction, length));
}

static void include_solid(diagram_box *box, const section_plane *plane, const scene *s, int solid_index)
{
    if (solid_index >= 0 && s->solids[solid_index].visible)
        diagram_include_solid(box, plane, &s->solids[solid_index]);
}

/* Includes the solids that rays of the tree hit or pass through. */
static void include_hit_solids(diagram_box *box, const section_plane *plane, const traced *t)
{
    for (size_t i = 0; i < t->tree->count; i++) {
        const ray_node *node = &t->tree->node[i];
        include_solid(box, plane, t->s, node->medium);
        if (node->end == RAY_END_HIT) {
            include_solid(box, plane, t->s, node->hit.solid);
            include_solid(box, plane, t->s, node->hit.face_solid);
        }
    }
}

static double diagonal(const diagram_box *box)
{
    return diagram_box_is_empty(box) ? 0.0 : hypot(box->u1 - box->u0, box->v1 - box->v0);
}

/* The bounds of the drawing: the hit solids, the origin of the first ray unless it is far away, and nearby hits. */
static diagram_box box_of(const traced *t, const section_plane *plane)
{
    diagram_box box = DIAGRAM_BOX_EMPTY;
    const ray_tree *tree = t->tree;
    const ray_node *root = &tree->node[0];
    include_hit_solids(&box, plane, t);
    diagram_box wide = box;
    diagram_include(&wide, plane, root->origin);
    const double solids = diagonal(&box);
    if (solids == 0.0 || diagonal(&wide) < 5.0 * solids)
        box = wide;
    if (root->end == RAY_END_HIT)
        diagram_include(&box, plane, root->hit.point);
    const double reach = 0.25 * diagonal(&box);
    const diagram_box near = {box.u0 - reach, box.u1 + reach, box.v0 - reach, box.v1 + reach};
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (node->end != RAY_END_HIT || weight_of(tree, node) < LIGHTEST)
            continue;
        const section_point at = section_project(plane, node->hit.point);
        if (at.u > near.u0 && at.u < near.u1 && at.v > near.v0 && at.v < near.v1)
            diagram_include(&box, plane, node->hit.point);
    }
    const double out = 0.15 * diagonal(&box);
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == RAY_END_SKY && weight_of(tree, &tree->node[i]) > 0.01)
            diagram_include(&box, plane, along(&tree->node[i], out));
    if (diagonal(&box) == 0.0)
        diagram_include(&box, plane, along(root, 1.0));
    return box;
}

/* The plane of the root's direction and the first normal; without a hit, the vertical plane through the ray. v is the
 * projection of up, u points along the ray. */
static section_plane plane_of_incidence(const ray_tree *tree)
{
    const ray_node *root = &tree->node[0];
    const vec3 d = root->direction, up = vec3_make(0, 1, 0);
    vec3 n = root->end == RAY_END_HIT ? vec3_cross(d, root->hit.normal) : vec3_make(0, 0, 0);
    if (vec3_length(n) < 1e-6)
        n = vec3_cross(d, up);
    if (vec3_length(n) < 1e-6)
        n = vec3_make(0, 0, 1); /* straight up or down */
    n = vec3_normalize(n);
    vec3 e_v = vec3_sub(up, vec3_scale(n, n.y));
    e_v = vec3_length(e_v) < 1e-6 ? vec3_make(0, 0, 1) : vec3_normalize(e_v);
    vec3 e_u = vec3_cross(e_v, n);
    if (vec3_dot(e_u, d) < 0.0)
        e_u = vec3_scale(e_u, -1.0);
    return diagram_plane(root->end == RAY_END_HIT ? root->hit.point : root->origin, e_u, e_v);
}

/* Height of the horizontal section: the weighted mean height of the tree's segments. */
static double level_of(const ray_tree *tree)
{
    double sum = 0.0, weights = 0.0;
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (node->end != RAY_END_HIT || node->kind == RAY_SHADOW)
            continue;
        const double weight = weight_of(tree, node);
        sum += weight * 0.5 * (node->origin.y + node->hit.point.y);
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : tree->node[0].origin.y;
}

/* The view from above, or from the side if the plane of incidence is horizontal. */
static section_plane other_plane(const ray_tree *tree, const section_plane *incidence, char *caption, size_t size)
{
    const vec3 d = tree->node[0].direction;
    if (fabs(incidence->e_u.y) + fabs(incidence->e_v.y) > 1e-9) {
        const double level = level_of(tree);
        snprintf(caption, size, "from above; section at y = %.4g", level);
        return diagram_plane(vec3_make(0, level, 0), vec3_make(1, 0, 0), vec3_make(0, 0, 1));
    }
    snprintf(caption, size, "from the side; vertical section along the ray");
    return diagram_plane(tree->node[0].origin, vec3_normalize(vec3_make(d.x, 0, d.z)), vec3_make(0, 1, 0));
}

static void draw_node(const diagram *d, const ray_tree *tree, const ray_node *node)
{
    const double weight = weight_of(tree, node);
    const ray_style *style = node->end == RAY_END_BLOCKED ? &blocked : &styles[node->kind];
    if (weight < LIGHTEST)
        return;
    const ray_line line = diagram_line_of(d, node);
    diagram_ray(d, &line, style->color, node->kind == RAY_SHADOW ? 0.3 * weight : weight,
                diagram_is_cut(node) ? DIAGRAM_CUT : style->dashes);
    if (node->end == RAY_END_SKY)
        diagram_arrow(d, &line, style->color, weight);
}

/* Draws shadow rays first and the camera ray last, on top of the others. */
static void draw_tree(const diagram *d, const ray_tree *tree)
{
    const ray_kind order[] = {RAY_SHADOW, RAY_REFLECT, RAY_REFRACT, RAY_CAMERA};
    for (int k = 0; k < 4; k++)
        for (size_t i = 0; i < tree->count && !cancel_asked_at(i); i++)
            if (tree->node[i].kind == order[k])
                draw_node(d, tree, &tree->node[i]);
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (node->end == RAY_END_HIT && node->hit.tir && weight_of(tree, node) >= LIGHTEST)
            diagram_dot(d, node->hit.point, 3.5, "none", SVG_PURPLE);
    }
    if (tree->node[0].end == RAY_END_HIT)
        diagram_dot(d, tree->node[0].hit.point, 2.2, SVG_INK, "none");
}

static status draw_view(const traced *t, FILE *out, const section_plane *plane, const diagram_frame *frame,
                        const char *caption, diagnostic *why)
{
    diagram d;
    const diagram_box box = box_of(t, plane);
    status result = diagram_begin(&d, out, t->p, t->s, plane, &box, frame, caption, why);
    if (result == STATUS_OK)
        draw_tree(&d, t->tree);
    THEN(result, cancel_check(why));
    diagram_end(&d);
    return result;
}

static void draw_key(FILE *out, double left, double y)
{
    double x = left;
    for (int k = RAY_CAMERA; k <= RAY_SHADOW; k++)
        x = svg_key(out, x, y, styles[k].color, styles[k].dashes, styles[k].words, 112.0);
    x = svg_key(out, x, y, blocked.color, blocked.dashes, blocked.words, 96.0);
    x = svg_key(out, x, y, SVG_GREY, DIAGRAM_CUT, "not traced (cut)", 138.0);
    fprintf(out, "<path d=\"M%.2f %.2fl7 2.5l-7 2.5z\" fill=\"" SVG_GREY "\"/>\n", x, y - 6.5);
    svg_label(out, x + 13.0, y, "start", SVG_INK, "to the sky");
    x += 92.0;
    fprintf(out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"3.5\" stroke=\"" SVG_PURPLE "\" stroke-width=\"1.2\"/>\n",
            x + 4.0, y - 4.0);
    svg_label(out, x + 13.0, y, "start", SVG_INK, "total internal reflection");
}

static size_t count_drawn(const ray_tree *tree)
{
    size_t drawn = 0;
    for (size_t i = 0; i < tree->count; i++)
        drawn += weight_of(tree, &tree->node[i]) >= LIGHTEST;
    return drawn;
}

status trace_write_drawing(const traced *t, FILE *out, diagnostic *why)
{
    const double side = 470.0, full = DIAGRAM_BEFORE + side + DIAGRAM_BEHIND,
                 foot = DIAGRAM_ABOVE + side + DIAGRAM_BELOW;
    char caption[160];
    const double media = diagram_media_key(NULL, t->p, t->s, DIAGRAM_BEFORE, 2.0 * full, foot + 36.0);
    svg_begin(out, 2.0 * full, media + 32.0, t->s->title && t->s->title[0] ? t->s->title : NULL);
    const section_plane incidence = plane_of_incidence(t->tree);
    const diagram_frame first = {DIAGRAM_BEFORE, DIAGRAM_ABOVE, side, side};
    status result = draw_view(t, out, &incidence, &first,
                              t->tree->node[0].end == RAY_END_HIT ? "plane of incidence of the first hit"
                                                                  : "vertical plane through the ray",
                              why);
    const section_plane other = other_plane(t->tree, &incidence, caption, sizeof caption);
    const diagram_frame second = {full + DIAGRAM_BEFORE, DIAGRAM_ABOVE, side, side};
    THEN(result, draw_view(t, out, &other, &second, caption, why));
    draw_key(out, DIAGRAM_BEFORE, foot + 14.0);
    diagram_media_key(out, t->p, t->s, DIAGRAM_BEFORE, 2.0 * full, foot + 36.0);
    snprintf(caption, sizeof caption,
             "rays: %zu, depth limit %d, %.6g nm; fainter lines have less weight; %zu below %g of the first ray's are "
             "omitted",
             t->tree->count, t->tree->depth_limit, t->tree->lambda_nm, t->tree->count - count_drawn(t->tree), LIGHTEST);
    svg_label(out, DIAGRAM_BEFORE, media + 22.0, "start", SVG_GREY, caption);
    svg_end(out);
    return result;
}
