/* The background of a diagram: media as areas, boundaries as lines, and their legend. */
#include "report/diagram_parts.h"
#include "scene/model/medium.h"
#include "image/image.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

/* Refractive index at render.lambda_nm; 1 where it is unknown. */
static double index_of(const scene *s, int i)
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
    const double power = fabs(index_of(s, i) - 1.0);
    fprintf(out, "fill=\"#56b4e9\" fill-opacity=\"%.3f\"", power < 0.8 ? 0.06 + 0.5 * power : 0.46);
}

static status write_area(const diagram *d, int of, section_step *steps, diagnostic *why)
{
    const section *cut = &d->cut;
    size_t count;
    const status code = section_area(cut, of, steps, &count, why);
    if (code != STATUS_OK || count == 0)
        return code;
    fprintf(d->out, "<path ");
    write_fill(d->out, d->s, of);
    fputs(" fill-rule=\"evenodd\" d=\"", d->out);
    for (size_t i = 0; i < count; i++) {
        const section_line *line = &cut->line[steps[i].line];
        fputs(steps[i].starts_ring && i > 0 ? "Z" : "", d->out);
        for (size_t k = steps[i].starts_ring ? 0 : 1; k < line->count; k++) {
            const size_t index = line->first + (steps[i].backwards ? line->count - 1 - k : k);
            const section_point at = cut->point[index];
            if (d->needed[index])
                fprintf(d->out, "%s%.2f %.2f", k == 0 ? "M" : "L", diagram_x(d, at.u), diagram_y(d, at.v));
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
        if (d->needed[line->first + k])
            fprintf(d->out, "%s%.2f %.2f", k == 0 ? "M" : "L", diagram_x(d, at.u), diagram_y(d, at.v));
    }
    fputs("\"/>\n", d->out);
}

/* Squared distance of p from the segment ab, in scene units squared. */
static double distance2(section_point p, section_point a, section_point b)
{
    const double du = b.u - a.u, dv = b.v - a.v, length2 = du * du + dv * dv;
    const double share = length2 > 0.0 ? ((p.u - a.u) * du + (p.v - a.v) * dv) / length2 : 0.0;
    const double within = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
    const double off_u = p.u - a.u - within * du, off_v = p.v - a.v - within * dv;
    return off_u * off_u + off_v * off_v;
}

/* Marks the points that the line needs within the tolerance (Douglas and Peucker 1973). */
static void mark_needed(diagram *d, size_t first, size_t last)
{
    const double tolerance = 0.03 / d->scale; /* pixels */
    size_t farthest = first;
    double most = tolerance * tolerance;
    d->needed[first] = d->needed[last] = true;
    for (size_t k = first + 1; k < last; k++) {
        const double off = distance2(d->cut.point[k], d->cut.point[first], d->cut.point[last]);
        if (off > most)
            most = off, farthest = k;
    }
    if (farthest == first)
        return;
    mark_needed(d, first, farthest);
    mark_needed(d, farthest, last);
}

status diagram_media(diagram *d, diagnostic *why)
{
    section_step *steps = calloc(d->cut.line_count + 1, sizeof *steps);
    d->needed = calloc(d->cut.point_count + 1, sizeof *d->needed);
    for (size_t i = 0; i < d->cut.line_count && d->needed; i++)
        mark_needed(d, d->cut.line[i].first, d->cut.line[i].first + d->cut.line[i].count - 1);
    if (!steps || !d->needed) {
        free(steps);
        return out_of_memory(why);
    }
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

static void key_words(const probe *p, const scene *s, int i, char *text, size_t size)
{
    const char *name = s->solids[i].name, *substance = probe_medium_name(p, i);
    if (is_opaque(s, i))
        snprintf(text, size, "%s", name);
    else if (strcmp(substance, name) == 0)
        snprintf(text, size, "%s, n = %.6g", name, index_of(s, i));
    else
        snprintf(text, size, "%s (%s), n = %.6g", name, substance, index_of(s, i));
}

double diagram_media_key(FILE *out, const probe *p, const scene *s, double left, double right, double y)
{
    double x = left;
    for (int i = 0; i < (int)s->solid_count; i++) {
        char text[160];
        int letters = 0;
        if (!s->solids[i].visible)
            continue;
        key_words(p, s, i, text, sizeof text);
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
