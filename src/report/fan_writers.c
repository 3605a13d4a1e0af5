/* Writes a fan of rays as CSV, one row per ray; as JSON; and as a drawing in its plane: the section of the solids, the
 * ray paths, the caustic and the mean focus. */
#include "base/cancel.h"
#include "base/csv.h"
#include "render/inspect/ray_line.h"
#include "report/diagram.h"
#include "report/json.h"
#include "report/trace_writers.h"
#include "scene/model/open.h"
#include "scene/model/scene.h"

/* --- CSV --- */

static void add_vector(csv_buffer *line, bool known, vec3 v)
{
    csv_real(line, known ? v.x : (double)NAN);
    csv_real(line, known ? v.y : (double)NAN);
    csv_real(line, known ? v.z : (double)NAN);
}

const char *fan_end_text(const fan_output *t, const fan_ray *ray)
{
    const ray_node *last = &t->f->node[ray->first + ray->count - 1];
    if (last->end == RAY_END_HIT)
        return scene_solid_name(t->s, last->hit.solid);
    return last->end == RAY_END_SKY ? "sky" : "cut";
}

status fan_write_csv(const fan_output *t, FILE *out, diagnostic *why)
{
    csv_buffer line = {0};
    fprintf(out,
            "ray,%s,interfaces,end,exit_x,exit_y,exit_z,direction_x,direction_y,direction_z,deviation_deg,weight,axis_"
            "at,axis_x,axis_y,axis_z\n",
            t->rule->spreads ? "offset_deg" : "offset");
    for (int i = 0; i < t->f->count && !cancel_asked(); i++) {
        const fan_ray *ray = &t->f->ray[i];
        csv_count(&line, i);
        csv_real(&line, ray->offset);
        csv_count(&line, (int64_t)ray->count - 1);
        csv_text(&line, fan_end_text(t, ray));
        add_vector(&line, ray->leaves, ray->exit_point);
        add_vector(&line, ray->leaves, ray->exit_direction);
        csv_real(&line, ray->leaves ? ray->deviation_deg : (double)NAN);
        csv_real(&line, ray->leaves ? ray->weight : (double)NAN);
        csv_real(&line, ray->crosses_axis ? ray->axis_at : (double)NAN);
        add_vector(&line, ray->crosses_axis, ray->axis_point);
        csv_end(&line);
    }
    const bool failed = line.failed, cancelled = cancel_asked();
    if (!failed && !cancelled)
        fwrite(line.text, 1, line.size, out);
    csv_buffer_free(&line);
    return failed ? out_of_memory(why) : cancelled ? cancel_check(why) : STATUS_OK;
}

/* --- JSON --- */

static json_t *point(vec3 p)
{
    return json_pack("[o,o,o]", json_of_real(p.x), json_of_real(p.y), json_of_real(p.z));
}

/* The starts of the segments of a path, and the end of the last one unless it leads into the sky or is cut. */
static json_t *path_points(const fan *f, const fan_ray *ray)
{
    const ray_node *node = &f->node[ray->first], *last = node + ray->count - 1;
    json_t *list = json_array();
    int bad = 0;
    for (size_t i = 0; i < ray->count; i++)
        bad |= json_array_append_new(list, point(node[i].origin));
    if (last->end == RAY_END_HIT)
        bad |= json_array_append_new(list, point(last->hit.point));
    return json_if(list, bad == 0);
}

/* The end of the last segment's line. */
static json_t *far_end(const fan *f, const fan_ray *ray)
{
    const ray_line line = ray_line_of(&f->node[ray->first + ray->count - 1]);
    double xyzw[4];
    ray_line_far_end(&line, xyzw);
    return json_pack("[o,o,o,o]", json_of_real(xyzw[0]), json_of_real(xyzw[1]), json_of_real(xyzw[2]),
                     json_of_real(xyzw[3]));
}

static json_t *ray_json(const fan_output *t, const fan_ray *ray)
{
    const double none = NAN;
    return json_pack("{s:o,s:I,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "offset", json_of_real(ray->offset), "interfaces",
                     (json_int_t)ray->count - 1, "end", json_of_text(fan_end_text(t, ray)), "deviation_deg",
                     json_of_real(ray->leaves ? ray->deviation_deg : none), "weight",
                     json_of_real(ray->leaves ? ray->weight : none), "axis_at",
                     json_of_real(ray->crosses_axis ? ray->axis_at : none), "direction",
                     ray->leaves ? point(ray->exit_direction) : json_null(), "points", path_points(t->f, ray),
                     "far_end", far_end(t->f, ray));
}

static json_t *focus_json(const fan *f)
{
    return f->has_focus ? json_pack("{s:o,s:o,s:b}", "at", point(f->focus), "rms", json_of_real(f->focus_rms),
                                    "virtual", (int)f->is_virtual)
                        : json_null();
}

json_t *fan_json(const fan_output *t)
{
    const fan *f = t->f;
    json_t *rays = json_array(), *crossings = json_array();
    int bad = 0, leaving = 0;
    for (int i = 0; i < f->count; i++) {
        leaving += f->ray[i].leaves;
        bad |= json_array_append_new(rays, ray_json(t, &f->ray[i]));
    }
    for (int i = 0; i < f->crossing_count; i++)
        bad |= json_array_append_new(crossings,
                                     json_pack("{s:i,s:o}", "ray", f->crossing[i].ray, "at", point(f->crossing[i].at)));
    json_t *o = json_pack("{s:i,s:i,s:o,s:o,s:o,s:o}", "count", f->count, "followed", leaving, "axis", point(f->axis),
                          "focus", focus_json(f), "crossings", crossings, "rays", rays);
    return json_if(o, bad == 0);
}

/* --- drawing --- */

/* LIGHTEST: in complete ray trees, branches with a smaller weight are not drawn. FAR_OFF: points farther outside the
 * window than this fraction of its diagonal do not enlarge it. */
#define LIGHTEST 0.004
#define FAR_OFF 0.6

static const double outer_width = 960.0, least_height = 260.0, most_height = 760.0;

/* A horizontal plane is drawn with the axis to the right; any other with world +y upwards as far as the plane allows,
 * and the rays running to the right. */
static section_plane plane_of(const fan *f)
{
    const vec3 up = vec3_sub(vec3_make(0, 1, 0), vec3_scale(f->normal, f->normal.y));
    if (vec3_length(up) < 1e-6)
        return diagram_plane(f->from, f->axis, f->across);
    const vec3 e_v = vec3_normalize(up), e_u = vec3_cross(e_v, f->normal);
    return diagram_plane(f->from, vec3_dot(e_u, f->axis) < 0.0 ? vec3_scale(e_u, -1.0) : e_u, e_v);
}

static void include_near(diagram_box *box, const section_plane *plane, vec3 p)
{
    const double reach = FAR_OFF * hypot(box->u1 - box->u0, box->v1 - box->v0);
    const section_point at = section_project(plane, p);
    if (at.u > box->u0 - reach && at.u < box->u1 + reach && at.v > box->v0 - reach && at.v < box->v1 + reach)
        diagram_include(box, plane, p);
}

static diagram_box box_of(const fan_output *t, const section_plane *plane)
{
    const fan *f = t->f;
    diagram_box box = DIAGRAM_BOX_EMPTY;
    diagram_include(&box, plane, t->rule->from);
    diagram_include(&box, plane, t->rule->to);
    for (int i = 0; i < f->count && !cancel_asked(); i++) {
        const ray_node *node = &f->node[f->ray[i].first];
        diagram_include(&box, plane, node->origin);
        for (size_t k = 1; k < f->ray[i].count; k++)
            include_near(&box, plane, node[k].origin);
        for (size_t k = 0; k < f->ray[i].count; k++)
            if (node[k].medium >= 0 && t->s->solids[node[k].medium].visible)
                diagram_include_solid(&box, plane, &t->s->solids[node[k].medium]);
    }
    const diagram_box rest = box;
    for (int i = 0; i < f->crossing_count; i++) {
        diagram_box grown = rest;
        include_near(&grown, plane, f->crossing[i].at);
        box.u0 = fmin(box.u0, grown.u0), box.u1 = fmax(box.u1, grown.u1);
        box.v0 = fmin(box.v0, grown.v0), box.v1 = fmax(box.v1, grown.v1);
    }
    if (f->has_focus)
        include_near(&box, plane, f->focus);
    return box;
}

/* Line weight factor: many rays are drawn thinner. */
static double crowding(const fan *f)
{
    return f->count > 20 ? sqrt(20.0 / f->count) : 1.0;
}

static void draw_segment(const diagram *d, const fan *f, const ray_node *node)
{
    static const char *const colors[] = {
        [RAY_CAMERA] = SVG_INK, [RAY_REFLECT] = SVG_VERMILLION, [RAY_REFRACT] = SVG_BLUE, [RAY_SHADOW] = SVG_GREY};
    const ray_line line = diagram_line_of(d, node);
    diagram_ray(d, &line, colors[node->kind], crowding(f) * diagram_weight(node),
                diagram_is_cut(node) ? DIAGRAM_CUT : NULL);
}

static status draw_tree(const diagram *d, const fan_output *t, const fan_ray *ray, diagnostic *why)
{
    const ray_node *first = &t->f->node[ray->first];
    ray_tree tree = {0};
    status result = probe_ray(t->p, first->origin, first->direction, &tree, why);
    for (size_t i = 0; i < tree.count && result == STATUS_OK; i++)
        if (tree.node[i].kind != RAY_SHADOW && diagram_weight(&tree.node[i]) >= LIGHTEST)
            draw_segment(d, t->f, &tree.node[i]);
    ray_tree_release(&tree);
    return result;
}

static status draw_rays(const diagram *d, const fan_output *t, diagnostic *why)
{
    status result = STATUS_OK;
    for (int i = 0; i < t->f->count && result == STATUS_OK; i++) {
        const fan_ray *ray = &t->f->ray[i];
        if (t->complete_trees)
            result = draw_tree(d, t, ray, why);
        for (size_t k = 0; k < ray->count && !t->complete_trees; k++)
            draw_segment(d, t->f, &t->f->node[ray->first + k]);
        THEN(result, cancel_check(why));
    }
    for (int i = 0; i < t->f->count && result == STATUS_OK; i++) {
        const fan_ray *ray = &t->f->ray[i];
        for (size_t k = 0; k < ray->count; k++) {
            const ray_node *node = &t->f->node[ray->first + k];
            if (node->end == RAY_END_HIT && node->hit.tir)
                diagram_dot(d, node->hit.point, 3.0, "none", SVG_PURPLE);
        }
    }
    return result;
}

/* The crossings of adjacent rays, and lines between crossings of successive pairs: the envelope of the rays. */
static void draw_caustic(const diagram *d, const fan *f)
{
    for (int i = 0; i + 1 < f->crossing_count && !cancel_asked(); i++) {
        const fan_crossing *a = &f->crossing[i], *b = &f->crossing[i + 1];
        const ray_line line = ray_line_between(a->at, b->at);
        if (b->ray == a->ray + 1 && diagram_shows(d, a->at) && diagram_shows(d, b->at))
            diagram_ray(d, &line, SVG_ORANGE, 0.5, NULL);
    }
    for (int i = 0; i < f->crossing_count && !cancel_asked(); i++)
        diagram_dot(d, f->crossing[i].at, 1.9, SVG_ORANGE, "none");
    if (f->has_focus)
        diagram_cross(d, f->focus, 5.0, SVG_VERMILLION);
}

static void draw_key(const fan_output *t, FILE *out, double left, double y)
{
    const fan *f = t->f;
    char text[200];
    double x = svg_key(out, left, y, SVG_INK, NULL, "incoming", 104.0);
    x = svg_key(out, x, y, SVG_BLUE, NULL, "refracted", 106.0);
    x = svg_key(out, x, y, SVG_VERMILLION, NULL, "reflected", 106.0);
    fprintf(out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"2\" fill=\"" SVG_ORANGE "\"/>\n", x + 4.0, y - 4.0);
    svg_label(out, x + 12.0, y, "start", SVG_INK, "crossings (caustic)");
    x += 196.0;
    fprintf(out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"3\" stroke=\"" SVG_PURPLE "\" stroke-width=\"1.2\"/>\n", x + 4.0,
            y - 4.0);
    svg_label(out, x + 13.0, y, "start", SVG_INK, "total internal reflection");
    if (!f->has_focus)
        return;
    fprintf(out, "<path d=\"M%.2f %.2fl8 8m0 -8l-8 8\" stroke=\"" SVG_VERMILLION "\" stroke-width=\"1.8\"/>\n",
            left + 4.0, y + DIAGRAM_ROW - 8.0);
    snprintf(text, sizeof text, "mean focus%s: %.4g, %.4g, %.4g; rms distance %.3g", f->is_virtual ? " (virtual)" : "",
             fan_shown(f->focus.x), fan_shown(f->focus.y), fan_shown(f->focus.z), f->focus_rms);
    svg_label(out, left + 21.0, y + DIAGRAM_ROW, "start", SVG_INK, text);
}

static void write_caption(const fan_output *t, char *text, size_t size)
{
    const fan_rule *r = t->rule;
    char shape[64];
    snprintf(shape, sizeof shape, r->spreads ? "a fan of %.6g degrees" : "a beam %.6g wide",
             r->spreads ? r->spread_deg : r->width);
    snprintf(text, size, "%d rays, %s, from (%.4g, %.4g, %.4g) towards (%.4g, %.4g, %.4g); %.6g nm", r->rays, shape,
             r->from.x, r->from.y, r->from.z, r->to.x, r->to.y, r->to.z, t->s->render.lambda_nm);
}

status fan_write_drawing(const fan_output *t, FILE *out, diagnostic *why)
{
    const section_plane plane = plane_of(t->f);
    const diagram_box box = box_of(t, &plane);
    const double width = outer_width - DIAGRAM_BEFORE - DIAGRAM_BEHIND,
                 shape = (box.v1 - box.v0) / fmax(box.u1 - box.u0, 1e-9);
    const double height = fmin(fmax(width * (shape + 0.04), least_height), most_height),
                 foot = DIAGRAM_ABOVE + height + DIAGRAM_BELOW;
    const double key = foot + 14.0, first = key + DIAGRAM_ROW * (t->f->has_focus ? 2.0 : 1.0);
    const double media = diagram_media_key(NULL, t->p, t->s, DIAGRAM_BEFORE, outer_width, first);
    const diagram_frame frame = {DIAGRAM_BEFORE, DIAGRAM_ABOVE, width, height};
    diagram d;
    char caption[256];
    svg_begin(out, outer_width, media + 14.0, t->s->title && t->s->title[0] ? t->s->title : NULL);
    write_caption(t, caption, sizeof caption);
    status result = diagram_begin(&d, out, t->p, t->s, &plane, &box, &frame, caption, why);
    THEN(result, draw_rays(&d, t, why));
    if (result == STATUS_OK)
        draw_caustic(&d, t->f);
    THEN(result, cancel_check(why));
    diagram_end(&d);
    draw_key(t, out, DIAGRAM_BEFORE, key);
    diagram_media_key(out, t->p, t->s, DIAGRAM_BEFORE, outer_width, first);
    svg_end(out);
    return result;
}
