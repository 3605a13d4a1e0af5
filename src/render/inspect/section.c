/* The grid of a section: sampling of media and crossings on grid edges. */
#include "base/cancel.h"
#include "base/array.h"
#include "render/inspect/section_private.h"

#include <stdlib.h>
#include <string.h>

enum { BISECTIONS = 40 }; /* to 2^-40 of an edge */

section_point section_project(const section_plane *plane, vec3 p)
{
    const vec3 d = vec3_sub(p, plane->origin);
    return (section_point){vec3_dot(d, plane->e_u), vec3_dot(d, plane->e_v)};
}

vec3 section_place(const section_plane *plane, double u, double v)
{
    return vec3_add(plane->origin, vec3_add(vec3_scale(plane->e_u, u), vec3_scale(plane->e_v, v)));
}

void section_release(section *s)
{
    free(s->point);
    free(s->line);
    memset(s, 0, sizeof *s);
}

void section_add_point(cutter *c, section_point at)
{
    section *s = c->out;
    c->failed |= !GROW(s->point, s->point_capacity, s->point_count + 1);
    if (!c->failed)
        s->point[s->point_count++] = at;
}

section_point section_bisect(const cutter *c, section_point a, section_point b, int own)
{
    double low = 0.0, high = 1.0;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high);
        if (medium_at(c, between(a, b, middle)) == own)
            low = middle;
        else
            high = middle;
    }
    return between(a, b, 0.5 * (low + high));
}

/* Computes the crossing on an edge; on an edge that leaves the window it is the window's own point. Bisection always
 * starts from the lower medium, so that all edges across one thin layer find the same side of it. */
static void cross(cutter *c, int edge, int i, int j, int i2, int j2)
{
    const int a = label(c, i, j), b = label(c, i2, j2);
    if (a == b)
        return;
    const section_point p = grid_point(c, i, j), q = grid_point(c, i2, j2);
    if (a == SECTION_EDGE || b == SECTION_EDGE)
        c->crossing[edge] = a == SECTION_EDGE ? q : p;
    else
        c->crossing[edge] = a < b ? section_bisect(c, p, q, a) : section_bisect(c, q, p, b);
}

static bool prepare(cutter *c, int cells)
{
    const double width = c->plane->u1 - c->plane->u0, height = c->plane->v1 - c->plane->v0,
                 longer = width > height ? width : height;
    const int across = (int)ceil(cells * width / longer), up = (int)ceil(cells * height / longer);
    const int columns = across > 0 ? across : 1, rows = up > 0 ? up : 1;
    c->nu = columns + 3, c->nv = rows + 3;
    c->du = width / columns, c->dv = height / rows;
    c->edges = c->nv * (c->nu - 1) + c->nu * (c->nv - 1);
    c->junction_capacity = 64;
    c->label = malloc((size_t)c->nu * (size_t)c->nv * sizeof *c->label);
    c->crossing = calloc((size_t)(c->edges + c->junction_capacity), sizeof *c->crossing);
    c->at = malloc((size_t)c->edges * sizeof *c->at);
    if (!c->label || !c->crossing || !c->at)
        return false;
    memset(c->at, 0xff, (size_t)c->edges * sizeof *c->at);
    return true;
}

static void sample(cutter *c)
{
    for (int j = 0; j < c->nv && !cancel_asked(); j++)
        for (int i = 0; i < c->nu; i++) {
            const bool beyond = i == 0 || j == 0 || i == c->nu - 1 || j == c->nv - 1;
            c->label[j * c->nu + i] = beyond ? SECTION_EDGE : medium_at(c, grid_point(c, i, j));
        }
    for (int j = 0; j < c->nv && !cancel_asked(); j++)
        for (int i = 0; i < c->nu; i++) {
            if (i + 1 < c->nu)
                cross(c, edge_across(c, i, j), i, j, i + 1, j);
            if (j + 1 < c->nv)
                cross(c, edge_up(c, i, j), i, j, i, j + 1);
        }
}

status section_cut(const probe *p, const section_plane *plane, int cells, section *out, diagnostic *why)
{
    const double width = plane->u1 - plane->u0, height = plane->v1 - plane->v0;
    if (!(width > 0.0 && height > 0.0 && isfinite(width) && isfinite(height)) || cells < 2 || cells > SECTION_CELLS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "", "a section needs an extent, and 2 to %d cells",
                        (int)SECTION_CELLS_MAX);
    out->point_count = out->line_count = 0;
    cutter c = {.p = p, .plane = plane, .out = out};
    c.failed = !prepare(&c, cells);
    if (!c.failed)
        sample(&c);
    c.failed = c.failed || cancel_asked();
    for (int j = 0; j + 1 < c.nv && !c.failed; j++)
        for (int i = 0; i + 1 < c.nu && !c.failed; i++)
            section_march(&c, i, j);
    c.failed = c.failed || cancel_asked();
    section_chain_all(&c);
    free(c.label);
    free(c.crossing);
    free(c.at);
    free(c.pieces);
    return c.failed ? cancelled_or_out_of_memory(why) : STATUS_OK;
}
