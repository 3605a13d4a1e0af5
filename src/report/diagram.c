/* A diagram: window, rays, arrows and marks. */
#include "report/diagram_parts.h"

#include "geometry/shapes/shape.h"
#include "scene/model/solids.h"
#include <stdlib.h>

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
    if (rule->unbounded || rule->triangles)
        return;
    const bounds3 b = rule->extent(shape).box;
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
    const double room = 0.04 * fmax(box->u1 - box->u0, box->v1 - box->v0) + 1e-9;
    const double width = box->u1 - box->u0 + 2.0 * room, height = box->v1 - box->v0 + 2.0 * room;
    d->scale = fmin(d->frame.width / width, d->frame.height / height);
    const double u = 0.5 * (box->u0 + box->u1), v = 0.5 * (box->v0 + box->v1);
    d->plane.u0 = u - 0.5 * d->frame.width / d->scale, d->plane.u1 = u + 0.5 * d->frame.width / d->scale;
    d->plane.v0 = v - 0.5 * d->frame.height / d->scale, d->plane.v1 = v + 0.5 * d->frame.height / d->scale;
}

status diagram_begin(diagram *d, FILE *out, const probe *p, const scene *s, const section_plane *plane,
                     const diagram_box *box, const diagram_frame *frame, const char *caption, diagnostic *why)
{
    *d = (diagram){.out = out, .p = p, .s = s, .plane = *plane, .frame = *frame};
    fit(d, box);
    const double longer = frame->width > frame->height ? frame->width : frame->height;
    TRY(section_cut(p, &d->plane, (int)(longer / 1.5), &d->cut, why));
    TRY(diagram_media(d, why));
    diagram_axes(d, caption);
    return STATUS_OK;
}

void diagram_end(diagram *d)
{
    section_release(&d->cut);
    free(d->needed);
}

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

/* Where the line is in the drawing, CSS pixels; false where nothing of it can be seen. */
static bool line_ends(const diagram *d, const ray_line *line, double *length_px, section_point ends[2])
{
    if (!ray_line_projected(line, &d->plane, ends))
        return false;
    for (int k = 0; k < 2; k++)
        ends[k] = (section_point){diagram_x(d, ends[k].u), diagram_y(d, ends[k].v)};
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
                diagram_x(d, p.u), diagram_y(d, p.v), radius_px, fill, stroke);
}

void diagram_cross(const diagram *d, vec3 at, double radius_px, const char *stroke)
{
    const section_point p = section_project(&d->plane, at);
    const double x = diagram_x(d, p.u), y = diagram_y(d, p.v), r = radius_px;
    if (diagram_shows(d, at))
        fprintf(d->out, "<path d=\"M%.2f %.2fL%.2f %.2fM%.2f %.2fL%.2f %.2f\" stroke=\"%s\" stroke-width=\"1.8\"/>\n",
                x - r, y - r, x + r, y + r, x - r, y + r, x + r, y - r, stroke);
}
