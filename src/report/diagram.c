/* Draws a diagram: window, media, axes, rays and marks. */
#include "report/diagram.h"
#include "base/number.h"
#include "geometry/shapes/shape.h"
#include "image/image.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include "scene/model/solids.h"
#include <stdlib.h>
#include <string.h>

/* --- window --- */

void diagram_include(diagram_box *box, const section_plane *plane, vec3 p)
{
    const section_point at = section_project(plane, p);
    box->u0 = fmin(box->u0, at.u), box->u1 = fmax(box->u1, at.u);
    box->v0 = fmin(box->v0, at.v), box->v1 = fmax(box->v1, at.v);
}

bool diagram_box_is_empty(const diagram_box *box)
{
    return box->u0 > box->u1;
}

void diagram_include_solid(diagram_box *box, const section_plane *plane, const solid *one)
{
    const solid_shape *shape = &one->shape;
    const shape_rule *rule = shape_of(shape);
    if (rule->unbounded || rule->triangles || one->points[0])
        return;
    const bounds3 b = shape_extent_of(shape).box;
    const mat3 rotation = rotation_from_deg(shape->rotation_deg);
    for (int k = 0; k < 8; k++) {
        const vec3 corner =
            vec3_make(k & 1 ? b.high.x : b.low.x, k & 2 ? b.high.y : b.low.y, k & 4 ? b.high.z : b.low.z);
        diagram_include(box, plane, vec3_add(shape->position, mat3_apply(rotation, corner)));
    }
}

section_plane diagram_plane(vec3 point, vec3 e_u, vec3 e_v)
{
    const vec3 n = vec3_cross(e_u, e_v);
    return (section_plane){.origin = vec3_scale(n, vec3_dot(n, point)), .e_u = e_u, .e_v = e_v};
}

/* Sets the window: the box with a margin of 4 %, widened to the aspect ratio of the frame. */
static void fit(diagram *d, const diagram_box *box)
{
    const double margin = 0.04 * fmax(box->u1 - box->u0, box->v1 - box->v0) + 1e-9;
    const double width = box->u1 - box->u0 + 2.0 * margin, height = box->v1 - box->v0 + 2.0 * margin;
    d->scale = fmin(d->frame.width / width, d->frame.height / height);
    const double u = 0.5 * (box->u0 + box->u1), v = 0.5 * (box->v0 + box->v1);
    d->plane.u0 = u - 0.5 * d->frame.width / d->scale, d->plane.u1 = u + 0.5 * d->frame.width / d->scale;
    d->plane.v0 = v - 0.5 * d->frame.height / d->scale, d->plane.v1 = v + 0.5 * d->frame.height / d->scale;
}

static double x_of(const diagram *d, double u)
{
    return d->frame.left + (u - d->plane.u0) * d->scale;
}

static double y_of(const diagram *d, double v)
{
    return d->frame.top + (d->plane.v1 - v) * d->scale;
}

/* --- media --- */

double diagram_index(const scene *s, int i)
{
    index_law law;
    if (material_index_law(&s->solids[i].surface, s->solids[i].name, &law, NULL) != STATUS_OK)
        return 1.0;
    return index_law_at(&law, s->render.lambda_nm);
}

static bool is_opaque(const scene *s, int i)
{
    return material_is_opaque(&s->solids[i].surface);
}

/* Opaque solids have a pale tone of their colour; the blue of transparent ones deepens with their refractive index. */
static void write_fill(FILE *out, const scene *s, int i)
{
    if (is_opaque(s, i)) {
        const vec3 c = s->solids[i].surface.color;
        const double tones[3] = {srgb_encode(c.x), srgb_encode(c.y), srgb_encode(c.z)};
        int byte[3];
        for (int k = 0; k < 3; k++)
            byte[k] = (int)(255.0 * (0.62 + 0.38 * tones[k]) + 0.5);
        fprintf(out, "fill=\"#%02x%02x%02x\"", (unsigned)byte[0], (unsigned)byte[1], (unsigned)byte[2]);
        return;
    }
    const double power = fabs(diagram_index(s, i) - 1.0);
    fprintf(out, "fill=\"#56b4e9\" fill-opacity=\"%.3f\"", power < 0.8 ? 0.06 + 0.5 * power : 0.46);
}

static status write_area(const diagram *d, int solid_index, section_step *steps, diagnostic *why)
{
    const section *cut = &d->cut;
    size_t count;
    const status code = section_area(cut, solid_index, steps, &count, why);
    if (code != STATUS_OK || count == 0)
        return code;
    fprintf(d->out, "<path ");
    write_fill(d->out, d->s, solid_index);
    fputs(" fill-rule=\"evenodd\" d=\"", d->out);
    for (size_t i = 0; i < count; i++) {
        const section_line *line = &cut->line[steps[i].line];
        fputs(steps[i].starts_ring && i > 0 ? "Z" : "", d->out);
        for (size_t k = steps[i].starts_ring ? 0 : 1; k < line->count; k++) {
            const size_t index = line->first + (steps[i].backwards ? line->count - 1 - k : k);
            const section_point at = cut->point[index];
            fprintf(d->out, "%s%.2f %.2f", k == 0 ? "M" : "L", x_of(d, at.u), y_of(d, at.v));
        }
    }
    fputs("Z\"/>\n", d->out);
    return STATUS_OK;
}

static void write_boundary(const diagram *d, const section_line *line)
{
    fputs("<path d=\"", d->out);
    for (size_t k = 0; k < line->count; k++) {
        const section_point at = d->cut.point[line->first + k];
        fprintf(d->out, "%s%.2f %.2f", k == 0 ? "M" : "L", x_of(d, at.u), y_of(d, at.v));
    }
    fputs("\"/>\n", d->out);
}

/* Fills the areas of the media and draws the boundaries between them. */
static status draw_media(diagram *d, diagnostic *why)
{
    section_step *steps = calloc(d->cut.line_count + 1, sizeof *steps);
    if (!steps)
        return out_of_memory(why);
    status code = STATUS_OK;
    fputs("<g>\n", d->out);
    for (int i = 0; i < (int)d->s->solid_count && code == STATUS_OK; i++)
        code = write_area(d, i, steps, why);
    fputs("</g>\n<g stroke=\"" SVG_INK "\" stroke-width=\"0.9\" stroke-opacity=\"0.65\">\n", d->out);
    for (size_t i = 0; i < d->cut.line_count; i++)
        if (d->cut.line[i].a != SECTION_EDGE)
            write_boundary(d, &d->cut.line[i]);
    fputs("</g>\n", d->out);
    free(steps);
    return code;
}

/* --- axes --- */

/* The smallest step of 1, 2 or 5 times a power of ten with at most `most` ticks. */
static double tick_step(double extent, double most)
{
    double power = 1e-6;
    while (power * 10.0 * most < extent)
        power *= 10.0;
    const double factors[] = {1.0, 2.0, 5.0, 10.0};
    for (int i = 0; i < 3; i++)
        if (factors[i] * power * most >= extent)
            return factors[i] * power;
    return factors[3] * power;
}

/* "x", or the components of a direction that is not a world axis. */
static void name_axis(vec3 e, char *text, size_t size)
{
    const double parts[3] = {e.x, e.y, e.z};
    for (int k = 0; k < 3; k++)
        if (fabs(parts[k]) > 1.0 - 1e-12) {
            snprintf(text, size, "%s%c", parts[k] < 0 ? "-" : "", "xyz"[k]);
            return;
        }
    double rounded[3];
    for (int k = 0; k < 3; k++)
        rounded[k] = floor(parts[k] * 1000.0 + 0.5) / 1000.0 + 0.0; /* + 0: no -0 */
    snprintf(text, size, "along (%.3f, %.3f, %.3f)", rounded[0], rounded[1], rounded[2]);
}

static void tick_text(double value, char text[NUMBER_TEXT_MAX])
{
    number_format_digits(value, 6, text);
    if (strcmp(text, "-0") == 0)
        strcpy(text, "0");
}

static void draw_axes(const diagram *d, const char *caption)
{
    const section_plane *w = &d->plane;
    const diagram_frame *f = &d->frame;
    const double bottom = f->top + f->height, step = tick_step(w->u1 - w->u0, f->width / 70.0);
    char text[NUMBER_TEXT_MAX], name[96];
    for (double k = ceil(w->u0 / step); k * step <= w->u1; k += 1.0) {
        const double x = x_of(d, k * step);
        svg_line(d->out, x, bottom, x, bottom + 4.0, "stroke=\"" SVG_INK "\" stroke-width=\"0.8\"");
        tick_text(k * step, text);
        svg_label(d->out, x, bottom + 16.0, "middle", SVG_INK, text);
    }
    for (double k = ceil(w->v0 / step); k * step <= w->v1; k += 1.0) {
        const double y = y_of(d, k * step);
        svg_line(d->out, f->left - 4.0, y, f->left, y, "stroke=\"" SVG_INK "\" stroke-width=\"0.8\"");
        tick_text(k * step, text);
        svg_label(d->out, f->left - 7.0, y + 4.0, "end", SVG_INK, text);
    }
    fprintf(d->out, "<path d=\"M%.2f %.2fV%.2fH%.2f\" stroke=\"" SVG_INK "\" stroke-width=\"0.8\"/>\n", f->left, f->top,
            bottom, f->left + f->width);
    name_axis(w->e_u, name, sizeof name);
    svg_label(d->out, f->left + 0.5 * f->width, bottom + 33.0, "middle", SVG_INK, name);
    name_axis(w->e_v, name, sizeof name);
    fprintf(d->out, "<text transform=\"translate(%.2f %.2f) rotate(-90)\" text-anchor=\"middle\" fill=\"" SVG_INK "\">",
            f->left - 40.0, f->top + 0.5 * f->height);
    svg_escape(d->out, name);
    fputs("</text>\n", d->out);
    svg_label(d->out, f->left, f->top - 9.0, "start", SVG_INK, caption);
}

status diagram_begin(diagram *d, FILE *out, const probe *p, const scene *s, const section_plane *plane,
                     const diagram_box *box, const diagram_frame *frame, const char *caption, diagnostic *why)
{
    *d = (diagram){.out = out, .p = p, .s = s, .plane = *plane, .frame = *frame};
    fit(d, box);
    const double longer = frame->width > frame->height ? frame->width : frame->height;
    TRY(section_cut(p, &d->plane, (int)(longer / 1.5), &d->cut, why));
    TRY(section_simplify(&d->cut, 0.03 / d->scale, why)); /* pixels */
    TRY(draw_media(d, why));
    draw_axes(d, caption);
    return STATUS_OK;
}

void diagram_end(diagram *d)
{
    section_release(&d->cut);
}

/* --- rays and marks --- */

static double opacity_of(double weight)
{
    return 0.25 + 0.7 * sqrt(weight);
}

bool diagram_is_cut(const ray_node *node)
{
    return node->end == RAY_END_CUT_DEPTH || node->end == RAY_END_CUT_WEIGHT;
}

double diagram_weight(const ray_node *node)
{
    return (node->throughput[0] + node->throughput[1] + node->throughput[2]) / 3.0;
}

ray_line diagram_line_of(const diagram *d, const ray_node *node)
{
    ray_line line = ray_line_of(node);
    if (diagram_is_cut(node))
        line.end = 0.04 * hypot(d->plane.u1 - d->plane.u0, d->plane.v1 - d->plane.v0);
    return line;
}

/* The ends of the line in CSS pixels; false if nothing of it is visible. */
static bool line_ends(const diagram *d, const ray_line *line, double *length_px, section_point ends[2])
{
    if (!ray_line_projected(line, &d->plane, ends))
        return false;
    for (int k = 0; k < 2; k++)
        ends[k] = (section_point){x_of(d, ends[k].u), y_of(d, ends[k].v)};
    *length_px = hypot(ends[1].u - ends[0].u, ends[1].v - ends[0].v);
    return *length_px >= 0.02;
}

void diagram_ray(const diagram *d, const ray_line *line, const char *color, double weight, const char *dashes)
{
    section_point ends[2];
    double length_px;
    if (!line_ends(d, line, &length_px, ends))
        return;
    char stroke[192], dashed[64] = "";
    if (dashes)
        snprintf(dashed, sizeof dashed, " stroke-dasharray=\"%s\"", dashes);
    snprintf(stroke, sizeof stroke, "stroke=\"%s\" stroke-width=\"%.2f\" stroke-opacity=\"%.2f\"%s", color,
             0.6 + 1.2 * sqrt(weight), opacity_of(weight), dashed);
    svg_line(d->out, ends[0].u, ends[0].v, ends[1].u, ends[1].v, stroke);
}

bool diagram_shows(const diagram *d, vec3 at)
{
    const section_point p = section_project(&d->plane, at);
    return p.u >= d->plane.u0 && p.u <= d->plane.u1 && p.v >= d->plane.v0 && p.v <= d->plane.v1;
}

void diagram_arrow(const diagram *d, const ray_line *line, const char *color, double weight)
{
    section_point ends[2];
    double length_px;
    if (!line_ends(d, line, &length_px, ends) || length_px < 1.0)
        return;
    const double long_px = 4.0 + 3.0 * sqrt(weight), half_px = 0.36 * long_px;
    const double along_x = (ends[1].u - ends[0].u) / length_px, along_y = (ends[1].v - ends[0].v) / length_px;
    const double x = ends[1].u - long_px * along_x, y = ends[1].v - long_px * along_y;
    fprintf(d->out, "<path d=\"M%.2f %.2fL%.2f %.2fL%.2f %.2fZ\" fill=\"%s\" fill-opacity=\"%.2f\"/>\n", ends[1].u,
            ends[1].v, x - half_px * along_y, y + half_px * along_x, x + half_px * along_y, y - half_px * along_x,
            color, opacity_of(weight));
}

void diagram_dot(const diagram *d, vec3 at, double radius_px, const char *fill, const char *stroke)
{
    const section_point p = section_project(&d->plane, at);
    if (diagram_shows(d, at))
        fprintf(d->out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"%s\" stroke=\"%s\" stroke-width=\"1.2\"/>\n",
                x_of(d, p.u), y_of(d, p.v), radius_px, fill, stroke);
}

void diagram_cross(const diagram *d, vec3 at, double radius_px, const char *stroke)
{
    const section_point p = section_project(&d->plane, at);
    const double x = x_of(d, p.u), y = y_of(d, p.v), r = radius_px;
    if (diagram_shows(d, at))
        fprintf(d->out, "<path d=\"M%.2f %.2fL%.2f %.2fM%.2f %.2fL%.2f %.2f\" stroke=\"%s\" stroke-width=\"1.8\"/>\n",
                x - r, y - r, x + r, y + r, x - r, y + r, x + r, y - r, stroke);
}

/* --- legend of the media --- */

static void media_key_text(const probe *p, const scene *s, int i, char *text, size_t size)
{
    const char *name = s->solids[i].name, *substance = probe_medium_name(p, i);
    if (is_opaque(s, i))
        snprintf(text, size, "%s", name);
    else if (strcmp(substance, name) == 0)
        snprintf(text, size, "%s, n = %.6g", name, diagram_index(s, i));
    else
        snprintf(text, size, "%s (%s), n = %.6g", name, substance, diagram_index(s, i));
}

double diagram_media_key(FILE *out, const probe *p, const scene *s, double left, double right, double y)
{
    double x = left;
    for (int i = 0; i < (int)s->solid_count; i++) {
        char text[160];
        int letters = 0;
        if (!s->solids[i].visible)
            continue;
        media_key_text(p, s, i, text, sizeof text);
        for (const char *c = text; *c; c++)
            letters += ((unsigned char)*c & 0xc0) != 0x80;
        const double width = 39.0 + 6.9 * letters; /* estimated: 6.9 px per letter at font size 11 */
        if (x > left && x + width > right)
            x = left, y += DIAGRAM_ROW;
        if (out) {
            fprintf(out,
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"16\" height=\"10\" stroke=\"" SVG_INK
                    "\" stroke-width=\"0.9\" stroke-opacity=\"0.65\" ",
                    x, y - 9.0);
            write_fill(out, s, i);
            fputs("/>\n", out);
            svg_label(out, x + 21.0, y, "start", SVG_INK, text);
        }
        x += width;
    }
    return y;
}
