/* Writes a section of a scene: the areas of the solids in a plane as JSON, or a drawing with the rays of the beams. */
#include "base/cancel.h"
#include "image/image.h"
#include "report/diagram.h"
#include "report/json.h"
#include "report/trace_writers.h"
#include "scene/model/edit/edit.h"
#include "scene/model/medium.h"
#include "scene/model/open.h"
#include "scene/model/scene.h"

#include <stdlib.h>

const char *const section_view_words[SECTION_VIEW_COUNT] = {"front", "top", "side"};

/* --- the plane --- */

/* The start of the first visible beam, or the centre of the first visible bounded solid. */
static vec3 usual_point(const scene *s)
{
    vec3 centre;
    double radius;
    for (size_t i = 0; i < s->beam_count; i++)
        if (s->beams[i].visible)
            return s->beams[i].position;
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && contents_ball(s, s->solids[i].name, &centre, &radius))
            return centre;
    return vec3_make(0, 0, 0);
}

/* A standing axis is drawn upwards, a lying one to the right. */
static void axes_along(vec3 axis, vec3 *right, vec3 *up)
{
    const bool stands = fabs(axis.y) > 0.5;
    const vec3 other = stands ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
    const double first = fabs(axis.x) >= fabs(axis.z) ? axis.x : axis.z;
    const vec3 along = vec3_scale(axis, (stands ? axis.y : first) < 0.0 ? -1.0 : 1.0);
    const vec3 across = vec3_normalize(vec3_sub(other, vec3_scale(along, vec3_dot(other, along))));
    *right = stands ? across : along;
    *up = stands ? along : across;
}

/* What the plane cuts, or all solids if it cuts none; and the starts of the beams. */
static diagram_box usual_extent(const scene *s, const section_plane *plane)
{
    const section_plane across = {
        .origin = plane->origin, .e_u = vec3_cross(plane->e_u, plane->e_v), .e_v = plane->e_u};
    diagram_box cut = DIAGRAM_BOX_EMPTY, all = DIAGRAM_BOX_EMPTY;
    for (size_t i = 0; i < s->solid_count; i++) {
        diagram_box depth = DIAGRAM_BOX_EMPTY;
        if (s->solids[i].visible)
            diagram_include_solid(&depth, &across, &s->solids[i]);
        if (diagram_box_is_empty(&depth))
            continue;
        diagram_include_solid(&all, plane, &s->solids[i]);
        if (depth.u0 <= 0.0 && depth.u1 >= 0.0)
            diagram_include_solid(&cut, plane, &s->solids[i]);
    }
    diagram_box box = diagram_box_is_empty(&cut) ? all : cut;
    for (size_t i = 0; i < s->beam_count; i++)
        if (s->beams[i].visible)
            diagram_include(&box, plane, s->beams[i].position);
    if (diagram_box_is_empty(&box))
        return (diagram_box){-1.0, 1.0, -1.0, 1.0};
    const double margin = 0.08 * fmax(box.u1 - box.u0, box.v1 - box.v0) + 1e-6;
    return (diagram_box){box.u0 - margin, box.u1 + margin, box.v0 - margin, box.v1 + margin};
}

status section_rule_resolve(const section_rule *rule, const scene *s, section_plane *out, diagnostic *why)
{
    static const double axes[SECTION_VIEW_COUNT][2][3] = {[SECTION_FRONT] = {{1, 0, 0}, {0, 1, 0}},
                                                          [SECTION_TOP] = {{1, 0, 0}, {0, 0, 1}},
                                                          [SECTION_SIDE] = {{0, 0, 1}, {0, 1, 0}}};
    const double(*const a)[3] = axes[rule->view];
    vec3 right = vec3_make(a[0][0], a[0][1], a[0][2]), up = vec3_make(a[1][0], a[1][1], a[1][2]);
    vec3 at = rule->has_at ? rule->at : usual_point(s);
    if (rule->through) {
        const int found = scene_find_solid(s, rule->through);
        if (found < 0)
            return diagnose(why, STATUS_BAD_INPUT, "name a solid of the scene", "there is no solid '%.80s'",
                            rule->through);
        const solid_shape *shape = &s->solids[found].shape;
        axes_along(mat3_apply(rotation_from_deg(shape->rotation_deg), vec3_make(0, 1, 0)), &right, &up);
        at = shape->position;
    }
    *out = diagram_plane(at, right, up);
    const diagram_box usual = rule->has_extent ? (diagram_box){0} : usual_extent(s, out);
    const double *given = rule->extent;
    out->u0 = rule->has_extent ? given[0] : usual.u0, out->u1 = rule->has_extent ? given[1] : usual.u1;
    out->v0 = rule->has_extent ? given[2] : usual.v0, out->v1 = rule->has_extent ? given[3] : usual.v1;
    if (out->u1 - out->u0 > 0.0 && out->v1 - out->v0 > 0.0 && isfinite(out->u1 - out->u0) &&
        isfinite(out->v1 - out->v0))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "give U0,U1,V0,V1 with U0 below U1 and V0 below V1",
                    "the section's extent is empty");
}

/* --- JSON --- */

/* Lines bend by at most this fraction of the longer side between points: a tenth of a pixel of a page. */
#define TOLERANCE 1e-4

static status cut_plane(const section_output *t, section *cut, diagnostic *why)
{
    TRY(section_cut(t->p, &t->plane, t->cells, cut, why));
    return section_simplify(cut, TOLERANCE * fmax(t->plane.u1 - t->plane.u0, t->plane.v1 - t->plane.v0), why);
}

static void write_reals(FILE *out, const char *key, const double *value, int count)
{
    fprintf(out, ",\"%s\":[", key);
    for (int i = 0; i < count; i++) {
        fputs(i ? "," : "", out);
        json_write_real(out, value[i]);
    }
    fputc(']', out);
}

static void write_point(FILE *out, section_point at)
{
    fputc('[', out);
    json_write_real(out, at.u);
    fputc(',', out);
    json_write_real(out, at.v);
    fputc(']', out);
}

static void write_rings(FILE *out, const section *cut, const section_step *steps, size_t count)
{
    fputs(",\"rings\":[", out);
    for (size_t i = 0; i < count; i++) {
        const section_line *line = &cut->line[steps[i].line];
        fputs(!steps[i].starts_ring ? "" : i ? "],[" : "[", out);
        for (size_t k = steps[i].starts_ring ? 0 : 1; k < line->count; k++) {
            fputs(k ? "," : "", out);
            write_point(out, cut->point[line->first + (steps[i].backwards ? line->count - 1 - k : k)]);
        }
    }
    fputs("]]", out);
}

static bool write_area(const section_output *t, const section *cut, int i, const section_step *steps, size_t count,
                       bool first, FILE *out)
{
    const solid *one = &t->s->solids[i];
    const bool opaque = material_is_opaque(&one->surface);
    const double color[3] = {srgb_encode(one->surface.color.x), srgb_encode(one->surface.color.y),
                             srgb_encode(one->surface.color.z)};
    fprintf(out, "%s{\"solid\":", first ? "" : ",");
    bool good = json_write_text(out, one->name);
    fputs(",\"medium\":", out);
    good &= json_write_text(out, probe_medium_name(t->p, i));
    fprintf(out, ",\"opaque\":%s,\"n\":", opaque ? "true" : "false");
    json_write_real(out, opaque ? (double)NAN : diagram_index(t->s, i));
    write_reals(out, "color", color, 3);
    write_rings(out, cut, steps, count);
    fputc('}', out);
    return good;
}

static status write_areas(const section_output *t, const section *cut, FILE *out, diagnostic *why)
{
    section_step *steps = calloc(cut->line_count + 1, sizeof *steps);
    bool *present = calloc(t->s->solid_count + 1, sizeof *present), first = true;
    status code = steps && present ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; i < cut->line_count && code == STATUS_OK; i++) {
        const int sides[2] = {cut->line[i].a, cut->line[i].b};
        for (int k = 0; k < 2; k++)
            if (sides[k] >= 0)
                present[sides[k]] = true;
    }
    for (int i = 0; i < (int)t->s->solid_count && code == STATUS_OK; i++) {
        size_t count = 0;
        if (!present[i])
            continue;
        code = section_area(cut, i, steps, &count, why);
        if (code == STATUS_OK && count && !write_area(t, cut, i, steps, count, first, out))
            code = out_of_memory(why);
        first = first && count == 0;
    }
    free(steps);
    free(present);
    return code;
}

status section_write_json(const section_output *t, FILE *out, diagnostic *why)
{
    const section_plane *w = &t->plane;
    const vec3 n = vec3_cross(w->e_u, w->e_v);
    section cut = {0};
    status code = cut_plane(t, &cut, why);
    if (code == STATUS_OK) {
        fputs("{\"schema\":1,\"scene\":", out);
        code = json_write_text(out, t->scene_path) ? STATUS_OK : out_of_memory(why);
        write_reals(out, "origin", (double[]){w->origin.x, w->origin.y, w->origin.z}, 3);
        write_reals(out, "right", (double[]){w->e_u.x, w->e_u.y, w->e_u.z}, 3);
        write_reals(out, "up", (double[]){w->e_v.x, w->e_v.y, w->e_v.z}, 3);
        write_reals(out, "normal", (double[]){n.x, n.y, n.z}, 3);
        write_reals(out, "extent", (double[]){w->u0, w->u1, w->v0, w->v1}, 4);
        fprintf(out, ",\"cells\":%d,\"unit_m\":", t->cells);
        json_write_real(out, t->s->render.unit_m);
        fputs(",\"areas\":[", out);
        THEN(code, write_areas(t, &cut, out, why));
        fputs("]}\n", out);
    }
    section_release(&cut);
    return code;
}

/* --- drawing --- */

#define LIGHTEST 0.004 /* fraction of a ray's power below which its branches are not drawn */
#define BRIGHTEST 0.35 /* luminance of a line on white paper */

static const double outer_width = 960.0, least_height = 260.0, most_height = 760.0;

typedef struct beam_drawing {
    const scene *s;
    const diagram *d;
} beam_drawing;

static void color_of(const beam *b, double lambda_nm, char text[8])
{
    double rgb[3];
    beam_line_color(b, lambda_nm, rgb);
    const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2],
                 dim = luminance > BRIGHTEST ? BRIGHTEST / luminance : 1.0;
    int byte[3];
    for (int k = 0; k < 3; k++)
        byte[k] = (int)(255.0 * srgb_encode(dim * rgb[k]) + 0.5) & 255;
    snprintf(text, 8, "#%02x%02x%02x", (unsigned)byte[0], (unsigned)byte[1], (unsigned)byte[2]);
}

static status draw_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    const beam_drawing *b = context;
    char color[8];
    (void)p, (void)why;
    color_of(&b->s->beams[ray->beam], ray->lambda_nm, color);
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (diagram_weight(node) < LIGHTEST)
            continue;
        const ray_line line = diagram_line_of(b->d, node);
        diagram_ray(b->d, &line, color, diagram_weight(node), diagram_is_cut(node) ? DIAGRAM_CUT : NULL);
        if (node->end == RAY_END_SKY)
            diagram_arrow(b->d, &line, color, diagram_weight(node));
    }
    return STATUS_OK;
}

static void write_caption(const section_plane *w, char *text, size_t size)
{
    const vec3 n = vec3_cross(w->e_u, w->e_v);
    snprintf(text, size, "section through (%.4g, %.4g, %.4g), normal (%.4g, %.4g, %.4g)", fan_shown(w->origin.x),
             fan_shown(w->origin.y), fan_shown(w->origin.z), fan_shown(n.x), fan_shown(n.y), fan_shown(n.z));
}

status section_write_drawing(const section_output *t, FILE *out, diagnostic *why)
{
    const section_plane *w = &t->plane;
    const diagram_box box = {w->u0, w->u1, w->v0, w->v1};
    const double width = outer_width - DIAGRAM_BEFORE - DIAGRAM_BEHIND, shape = (w->v1 - w->v0) / (w->u1 - w->u0);
    const double height = fmin(fmax(width * shape, least_height), most_height),
                 key = DIAGRAM_ABOVE + height + DIAGRAM_BELOW + 14.0;
    const double media = diagram_media_key(NULL, t->p, t->s, DIAGRAM_BEFORE, outer_width, key);
    const diagram_frame frame = {DIAGRAM_BEFORE, DIAGRAM_ABOVE, width, height};
    diagram d;
    char caption[160];
    svg_begin(out, outer_width, media + 14.0, t->s->title && t->s->title[0] ? t->s->title : NULL);
    write_caption(w, caption, sizeof caption);
    status code = diagram_begin(&d, out, t->p, t->s, w, &box, &frame, caption, why);
    THEN(code, beams_each_ray(t->s, t->level, 0, draw_ray, &(beam_drawing){t->s, &d}, why));
    THEN(code, cancel_check(why));
    diagram_end(&d);
    diagram_media_key(out, t->p, t->s, DIAGRAM_BEFORE, outer_width, key);
    svg_end(out);
    return code;
}
