/* The axes of a diagram: ticks at round numbers, and names. */
#include "report/diagram_parts.h"
#include "base/number.h"
#include <string.h>

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

void diagram_axes(const diagram *d, const char *caption)
{
    const section_plane *w = &d->plane;
    const diagram_frame *f = &d->frame;
    const double bottom = f->top + f->height, step = tick_step(w->u1 - w->u0, f->width / 70.0);
    char text[NUMBER_TEXT_MAX], name[96];
    for (double k = ceil(w->u0 / step); k * step <= w->u1; k += 1.0) {
        const double x = diagram_x(d, k * step);
        svg_line(d->out, x, bottom, x, bottom + 4.0, "stroke=\"" SVG_INK "\" stroke-width=\"0.8\"");
        tick_text(k * step, text);
        svg_label(d->out, x, bottom + 16.0, "middle", SVG_INK, text);
    }
    for (double k = ceil(w->v0 / step); k * step <= w->v1; k += 1.0) {
        const double y = diagram_y(d, k * step);
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
