/* The rays of a page as SVG and as an HTML table. Line and row lead to each other by fragments; a line shows its
 * numbers below the image while it is pointed at, focused or chosen (report/page_style.h), so no script is needed. */
#include "report/page_rays.h"
#include "report/svg.h"
#include "report/trace_writers.h"

#include "image/image.h"
#include <math.h>

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
        svg_escape(out, ray->of);
        fprintf(out, ", %.6g nm%s%s", ray->lambda_nm, ray->node.depth > 0 ? ", " : "",
                ray->node.depth > 0 ? kind_words[ray->node.kind] : "");
    } else if (ray->node.kind == RAY_SHADOW) {
        fputs("to ", out);
        svg_escape(out, ray->of);
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
    fputs("\"><g clip-path=\"url(#image)\">", out);
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
