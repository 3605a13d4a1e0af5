/* Collects the heaviest rays of a page, and writes them as SVG and as an HTML table. */
#include "base/array.h"
#include "image/image.h"
#include "render/inspect/ray_line.h"
#include "report/diagram.h"
#include "report/page.h"
#include "report/trace_writers.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>

/* --- collecting --- */

/* Rays with less than this fraction of the light are left out, as in the laboratory's drawing. */
#define LIGHTEST 0.002
/* At this number of collected rays, all but the heaviest are dropped. */
enum { COLLECTED_MAX = 8 * PAGE_RAYS_MAX };

typedef struct collector {
    page_rays *r;
    const scene *s;
    camera_frame view;
    image_frame frame;
} collector;

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

static void name_hit(const collector *c, page_ray *ray, const probe *p)
{
    const ray_hit *h = &ray->node.hit;
    snprintf(ray->from, sizeof ray->from, "%s", probe_medium_name(p, h->from));
    snprintf(ray->to, sizeof ray->to, "%s", h->opaque ? "" : probe_medium_name(p, h->to));
    snprintf(ray->surface, sizeof ray->surface, "%s: %s", scene_solid_name(c->s, h->solid), probe_face_name(p, h));
}

static page_ray *add(const collector *c, const ray_node *node, double weight, const probe *p)
{
    page_rays *r = c->r;
    if (r->count == COLLECTED_MAX)
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

static status add_beam_rays(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    const collector *c = context;
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
        snprintf(one->source, sizeof one->source, "%s %d", b->name, ray->number + 1);
    }
    return STATUS_OK;
}

static status add_tree(const collector *c, const ray_tree *tree, const probe *p, diagnostic *why)
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
            snprintf(one->source, sizeof one->source, "%s", scene_light_name(c->s, node->light));
    }
    return STATUS_OK;
}

static status collect_pixel(const collector *c, isa level, diagnostic *why)
{
    probe *p = NULL;
    ray_tree tree = {0};
    status code = probe_create(c->s, level, &p, why);
    c->r->x = c->frame.width / 2, c->r->y = c->frame.height / 2;
    THEN(code, probe_pixel(p, c->r->x, c->r->y, &tree, why));
    THEN(code, add_tree(c, &tree, p, why));
    c->r->lambda_nm = tree.lambda_nm;
    ray_tree_release(&tree);
    probe_destroy(p);
    return code;
}

status page_rays_collect(page_rays *r, const scene *s, isa level, int width, int height, diagnostic *why)
{
    collector c = {r, s, camera_frame_of(s), image_frame_of(width, height, 0.0)};
    for (size_t i = 0; i < s->beam_count; i++)
        r->beams |= s->beams[i].visible != 0;
    TRY(r->beams ? beams_each_ray(s, level, 0, add_beam_rays, &c, why) : collect_pixel(&c, level, why));
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

/* --- writing ---
 *
 * A ray's line and row link to each other. A line shows its numbers below the image while it is under the pointer,
 * focused or chosen (PAGE_STYLE in report/page.c), so no script is needed. */

static const char *const kind_words[] = {"camera ray", "reflected", "refracted", "to a light"};

static const char *end_words(const ray_node *node)
{
    switch (node->end) {
    case RAY_END_SKY: return "background";
    case RAY_END_LIT: return "reaches the light";
    case RAY_END_BLOCKED: return "blocked";
    case RAY_END_HIT:
    case RAY_END_CUT_DEPTH:
    case RAY_END_CUT_WEIGHT: break;
    }
    return "";
}

static const char *line_class(const page_rays *r, const page_ray *ray)
{
    static const char *const classes[] = {"camera", "reflect", "refract", "shadow"};
    if (r->beams)
        return "beam";
    return ray->node.end == RAY_END_BLOCKED ? "blocked" : classes[ray->node.kind];
}

static void write_kind(const page_rays *r, const page_ray *ray, FILE *out)
{
    if (r->beams) {
        svg_escape(out, ray->source);
        fprintf(out, ", %.6g nm%s%s", ray->lambda_nm, ray->node.depth > 0 ? ", " : "",
                ray->node.depth > 0 ? kind_words[ray->node.kind] : "");
    } else if (ray->node.kind == RAY_SHADOW) {
        fputs("to ", out);
        svg_escape(out, ray->source);
    } else {
        fputs(kind_words[ray->node.kind], out);
    }
}

/* All numbers of a segment in one line. */
static void write_numbers(const page_rays *r, const page_ray *ray, size_t number, FILE *out)
{
    const ray_hit *h = &ray->node.hit;
    fprintf(out, "%zu: ", number);
    write_kind(r, ray, out);
    if (ray->node.end != RAY_END_HIT) {
        fprintf(out, ", in n = %.6g, %s", ray->node.n, end_words(&ray->node));
        return;
    }
    fputs(", ", out);
    svg_escape(out, ray->surface);
    if (h->opaque)
        fprintf(out, ", %.4f°, opaque, R = %.6g", trace_angle_deg(h->cos_i), h->R);
    else if (h->tir)
        fprintf(out, ", n %.6g → %.6g, %.4f°, total reflection", h->n_from, h->n_to, trace_angle_deg(h->cos_i));
    else
        fprintf(out, ", n %.6g → %.6g, %.4f° → %.4f°, R = %.6g, T = %.6g", h->n_from, h->n_to,
                trace_angle_deg(h->cos_i), trace_angle_deg(h->cos_t), h->R, h->T);
}

static void write_line(const page_rays *r, const page_ray *ray, const char *name, double width, FILE *out)
{
    fprintf(out, "<line class=\"%s\" x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke-width=\"%.2f\"", name,
            ray->ends[0].x, ray->ends[0].y, ray->ends[1].x, ray->ends[1].y, width);
    if (r->beams)
        fprintf(out, " stroke=\"rgb(%.0f %.0f %.0f)\"", 255.0 * srgb_encode(ray->rgb[0]),
                255.0 * srgb_encode(ray->rgb[1]), 255.0 * srgb_encode(ray->rgb[2]));
    fputs("/>", out);
}

static void write_segment(const page_rays *r, size_t at, int width, int height, FILE *out)
{
    const page_ray *ray = &r->ray[at];
    const double unit = width / 800.0, thick = unit * (1.4 + 1.6 * sqrt(fmin(1.0, ray->weight)));
    fprintf(out, "<a id=\"s%zu\" href=\"#r%zu\" aria-label=\"", at + 1, at + 1);
    write_numbers(r, ray, at + 1, out);
    /* Beams of several wavelengths add up where they coincide. */
    fprintf(out, "\"><g%s clip-path=\"url(#image)\">", r->beams ? " class=\"light\"" : "");
    write_line(r, ray, "halo", thick + 2.0 * unit, out);
    write_line(r, ray, line_class(r, ray), thick, out);
    write_line(r, ray, "near", 12.0 * unit, out);
    fprintf(out, "</g><g class=\"numbers\"><rect y=\"%d\" width=\"%d\" height=\"%.2f\"/><text x=\"%.2f\" y=\"%.2f\">",
            height, width, 30.0 * unit, 8.0 * unit, height + 20.0 * unit);
    write_numbers(r, ray, at + 1, out);
    fputs("</text></g></a>\n", out);
}

void page_rays_write_drawing(const page_rays *r, int width, int height, FILE *out)
{
    const double unit = width / 800.0;
    fprintf(out,
            "<svg viewBox=\"0 0 %d %.2f\" font-size=\"%.2f\" role=\"group\" aria-label=\"Rays over the image\">\n"
            "<clipPath id=\"image\"><rect width=\"%d\" height=\"%d\"/></clipPath>\n"
            "<text x=\"%.2f\" y=\"%.2f\">Point at a ray, or reach it with Tab, for its numbers.</text>\n",
            width, height + 30.0 * unit, 13.0 * unit, width, height, 8.0 * unit, height + 20.0 * unit);
    for (size_t i = 0; i < r->count; i++)
        if (r->ray[i].drawn)
            write_segment(r, i, width, height, out);
    fputs("</svg>\n", out);
}

static void write_text_cell(FILE *out, const char *text)
{
    fputs("<td>", out);
    svg_escape(out, text);
    fputs("</td>", out);
}

static void write_number_cell(FILE *out, bool has, const char *format, double value)
{
    char text[40] = "";
    if (has)
        snprintf(text, sizeof text, format, value);
    write_text_cell(out, text);
}

static void write_row(const page_rays *r, size_t at, FILE *out)
{
    const page_ray *ray = &r->ray[at];
    const ray_hit *h = &ray->node.hit;
    const bool hit = ray->node.end == RAY_END_HIT, passes = hit && !h->opaque && !h->tir;
    fprintf(out, "<tr id=\"r%zu\"><th scope=\"row\">", at + 1);
    if (ray->drawn)
        fprintf(out, "<a href=\"#s%zu\">%zu</a>", at + 1, at + 1);
    else
        fprintf(out, "%zu", at + 1);
    fputs("</th><td>", out);
    write_kind(r, ray, out);
    fprintf(out, "</td><td>%d</td>", ray->node.depth);
    write_text_cell(out, hit ? ray->surface : end_words(&ray->node));
    write_text_cell(out, ray->from);
    write_number_cell(out, true, "%.6g", hit ? h->n_from : ray->node.n);
    write_text_cell(out, ray->to);
    write_number_cell(out, hit && !h->opaque, "%.6g", h->n_to);
    write_number_cell(out, hit, "%.4f°", trace_angle_deg(h->cos_i));
    if (hit && h->tir)
        write_text_cell(out, "total reflection");
    else
        write_number_cell(out, passes, "%.4f°", trace_angle_deg(h->cos_t));
    write_number_cell(out, hit, "%.6g", h->R);
    write_number_cell(out, passes, "%.6g", h->T);
    write_number_cell(out, hit, "%.6g", h->path_length_m);
    write_number_cell(out, true, "%.6g", r->beams ? ray->power : ray->weight);
    fputs("</tr>\n", out);
}

void page_rays_write_table(const page_rays *r, FILE *out)
{
    fprintf(out,
            "<div class=\"frame\" tabindex=\"0\" role=\"region\" aria-label=\"Table of the rays\">\n<table>\n"
            "<thead><tr><th scope=\"col\">No.</th><th scope=\"col\">Ray</th><th scope=\"col\">Depth</th>"
            "<th scope=\"col\">Hits</th><th scope=\"col\">From</th><th scope=\"col\">n<sub>1</sub></th>"
            "<th scope=\"col\">To</th><th scope=\"col\">n<sub>2</sub></th><th scope=\"col\">Incidence</th>"
            "<th scope=\"col\">Refraction</th><th scope=\"col\">R</th><th scope=\"col\">T</th>"
            "<th scope=\"col\">Path, m</th><th scope=\"col\">%s</th></tr></thead>\n<tbody>\n",
            r->beams ? "Power" : "Weight");
    for (size_t i = 0; i < r->count; i++)
        write_row(r, i, out);
    fputs("</tbody>\n</table>\n</div>\n", out);
}
