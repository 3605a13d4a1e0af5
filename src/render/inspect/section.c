/* Cutting a section: media sampled on a grid and crossings on its edges, marching squares with junctions, lines from
 * pieces of boundary, areas from lines. */
#include "render/inspect/section.h"

#include "base/array.h"
#include "base/cancel.h"
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

/* A piece of boundary within one cell, between two crossings of the grid's edges. */
typedef struct piece {
    int end[2]; /* crossings, or junctions (from `edges` on) */
    int a, b;
    size_t first, count; /* points between the ends, in the section's point list */
    bool used;
} piece;

typedef struct cutter {
    const probe *p;
    const section_plane *plane;
    section *out;
    int nu, nv; /* grid points, including the frame of SECTION_EDGE around them */
    double du, dv;
    int *label;
    int edges;               /* number of edges; horizontal ones first */
    section_point *crossing; /* by edge, then by junction */
    int junctions, junction_capacity;
    int (*ends)[2]; /* by edge: the pieces that end on it, -1 for none */
    piece *pieces;
    size_t piece_count, piece_capacity;
    bool failed; /* out of memory */
} cutter;

/* --- the grid --- */

static int medium_at(const cutter *c, section_point at)
{
    return probe_medium_at(c->p, section_place(c->plane, at.u, at.v));
}

static section_point between(section_point a, section_point b, double fraction)
{
    return (section_point){a.u + (b.u - a.u) * fraction, a.v + (b.v - a.v) * fraction};
}

static section_point grid_point(const cutter *c, int i, int j)
{
    return (section_point){c->plane->u0 + (i - 1) * c->du, c->plane->v0 + (j - 1) * c->dv};
}

static int label(const cutter *c, int i, int j)
{
    return c->label[j * c->nu + i];
}

static int edge_across(const cutter *c, int i, int j)
{
    return j * (c->nu - 1) + i;
}

static int edge_up(const cutter *c, int i, int j)
{
    return c->nv * (c->nu - 1) + j * c->nu + i;
}

static void add_point(cutter *c, section_point at)
{
    section *s = c->out;
    c->failed |= !GROW(s->point, s->point_capacity, s->point_count + 1);
    if (!c->failed)
        s->point[s->point_count++] = at;
}

/* The end of a medium between a, which is in it, and b, which is not. */
static section_point bisect(const cutter *c, section_point a, section_point b, int medium)
{
    double low = 0.0, high = 1.0;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high);
        if (medium_at(c, between(a, b, middle)) == medium)
            low = middle;
        else
            high = middle;
    }
    return between(a, b, 0.5 * (low + high));
}

/* Computes the crossing on an edge; on an edge that leaves the window it is the grid point on the window's frame.
 * Bisection always starts from the lower medium, so that all edges across one thin layer find the same side of it. */
static void cross(cutter *c, int edge, int i, int j, int i2, int j2)
{
    const int a = label(c, i, j), b = label(c, i2, j2);
    if (a == b)
        return;
    const section_point p = grid_point(c, i, j), q = grid_point(c, i2, j2);
    if (a == SECTION_EDGE || b == SECTION_EDGE)
        c->crossing[edge] = a == SECTION_EDGE ? q : p;
    else
        c->crossing[edge] = a < b ? bisect(c, p, q, a) : bisect(c, q, p, b);
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
    c->ends = malloc((size_t)c->edges * sizeof *c->ends);
    if (!c->label || !c->crossing || !c->ends)
        return false;
    memset(c->ends, 0xff, (size_t)c->edges * sizeof *c->ends);
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

/* --- marching squares: the pieces of boundary within one cell --- */

/* Largest number of halvings of a piece of boundary; a piece that deviates from a straight line by less than STRAIGHT
 * (fraction of a cell) is not halved. A junction is enclosed to 2^-JUNCTION_STEPS of a cell. */
enum { HALVINGS = 9, JUNCTION_STEPS = 12 };
#define STRAIGHT 1e-4

/* Adds the points of the boundary between media a (on the left in the direction from `from` to `to`) and b, without
 * both ends. */
static void refine(cutter *c, section_point from, section_point to, int a, int b, int halvings)
{
    const double du = to.u - from.u, dv = to.v - from.v, length2 = du * du + dv * dv;
    const double cell = c->du > c->dv ? c->du : c->dv;
    if (halvings == 0 || length2 < STRAIGHT * STRAIGHT * cell * cell)
        return;
    const section_point middle = between(from, to, 0.5);
    /* A boundary that bulges by up to a semicircle (half of its chord) is between these two points. */
    const section_point left = {middle.u - 0.7 * dv, middle.v + 0.7 * du},
                        right = {middle.u + 0.7 * dv, middle.v - 0.7 * du};
    if (medium_at(c, left) != a || medium_at(c, right) != b)
        return;
    const section_point on = bisect(c, left, right, a);
    const double off_u = on.u - middle.u, off_v = on.v - middle.v;
    if (off_u * off_u + off_v * off_v < STRAIGHT * STRAIGHT * cell * cell)
        return;
    refine(c, from, on, a, b, halvings - 1);
    add_point(c, on);
    refine(c, on, to, a, b, halvings - 1);
}

/* Adds the piece of boundary between two crossings of a cell, or a crossing and a junction. */
static void add_piece(cutter *c, int from, int to, int a, int b)
{
    c->failed |= !GROW(c->pieces, c->piece_capacity, c->piece_count + 1);
    if (c->failed)
        return;
    const int index = (int)c->piece_count++;
    piece *one = &c->pieces[index];
    *one = (piece){.end = {from, to}, .a = a < b ? a : b, .b = a < b ? b : a, .first = c->out->point_count};
    if (one->a != SECTION_EDGE)
        refine(c, c->crossing[from], c->crossing[to], a, b, HALVINGS);
    one->count = c->out->point_count - one->first;
    for (int k = 0; k < 2; k++)
        if (one->end[k] < c->edges)
            c->ends[one->end[k]][c->ends[one->end[k]][0] >= 0] = index;
}

static int add_junction(cutter *c, section_point at)
{
    if (c->junctions == c->junction_capacity) {
        const int capacity = 2 * c->junction_capacity;
        section_point *more = realloc(c->crossing, (size_t)(c->edges + capacity) * sizeof *more);
        c->failed |= !more;
        if (!more)
            return 0;
        c->crossing = more;
        c->junction_capacity = capacity;
    }
    c->crossing[c->edges + c->junctions] = at;
    return c->edges + c->junctions++;
}

static int distinct(const int *media)
{
    int count = 1;
    for (int k = 1; k < 4; k++) {
        bool is_new = true;
        for (int m = 0; m < k; m++)
            is_new &= media[m] != media[k];
        count += is_new;
    }
    return count;
}

/* The point where three media meet: repeatedly selects the quarter of the cell whose corners are in the largest number
 * of media. */
static section_point meeting_point(const cutter *c, int i, int j)
{
    section_point low = grid_point(c, i, j);
    double du = c->du, dv = c->dv;
    for (int step = 0; step < JUNCTION_STEPS; step++) {
        int seen[3][3], best = 0, most = 0;
        for (int k = 0; k < 9; k++)
            seen[k / 3][k % 3] = medium_at(c, (section_point){low.u + 0.5 * du * (k % 3), low.v + 0.5 * dv * (k / 3)});
        for (int k = 0; k < 4; k++) {
            const int x = k % 2, y = k / 2,
                      corners[4] = {seen[y][x], seen[y][x + 1], seen[y + 1][x + 1], seen[y + 1][x]};
            if (distinct(corners) > most)
                most = distinct(corners), best = k;
        }
        du *= 0.5, dv *= 0.5;
        low.u += du * (best % 2), low.v += dv * (best / 2);
    }
    return (section_point){low.u + 0.5 * du, low.v + 0.5 * dv};
}

/* Joins all crossings of a cell in a junction. Corners 0 .. 3 are counterclockwise, and side k is between corners k and
 * k + 1. A boundary that enters through side k has the medium of corner k on its left. */
static void join_all(cutter *c, int i, int j, const int *side, const int *corner)
{
    section_point at = {0.0, 0.0};
    bool framed = false, found = false;
    for (int k = 0; k < 4; k++)
        framed |= corner[k] == SECTION_EDGE;
    for (int k = 0; k < 4 && framed; k++) {
        const int a = corner[k], b = corner[(k + 1) % 4];
        if (a != b && a != SECTION_EDGE && b != SECTION_EDGE)
            at = c->crossing[side[k]], found = true;
    }
    const int junction = add_junction(c, found ? at : meeting_point(c, i, j));
    for (int k = 0; k < 4 && !c->failed; k++)
        if (corner[k] != corner[(k + 1) % 4])
            add_piece(c, side[k], junction, corner[k], corner[(k + 1) % 4]);
}

/* Four crossings: the medium in the middle connects two opposite corners of the same medium, otherwise all boundaries
 * meet. */
static void part_corners(cutter *c, int i, int j, const int *side, const int *corner)
{
    const section_point low = grid_point(c, i, j);
    const int middle = medium_at(c, (section_point){low.u + 0.5 * c->du, low.v + 0.5 * c->dv});
    for (int k = 0; k < 2; k++) {
        if (corner[k] != corner[k + 2] || corner[k] != middle)
            continue;
        for (int m = k + 1; m < 4 + k; m += 2) /* cuts off corner m */
            add_piece(c, side[m - 1], side[m % 4], middle, corner[m % 4]);
        return;
    }
    join_all(c, i, j, side, corner);
}

static void march(cutter *c, int i, int j)
{
    const int corner[4] = {label(c, i, j), label(c, i + 1, j), label(c, i + 1, j + 1), label(c, i, j + 1)};
    const int side[4] = {edge_across(c, i, j), edge_up(c, i + 1, j), edge_across(c, i, j + 1), edge_up(c, i, j)};
    int cut[4], count = 0;
    for (int k = 0; k < 4; k++)
        if (corner[k] != corner[(k + 1) % 4])
            cut[count++] = k;
    if (count == 0)
        return;
    if (count == 4)
        part_corners(c, i, j, side, corner);
    else if (count == 3)
        join_all(c, i, j, side, corner);
    else
        add_piece(c, side[cut[0]], side[cut[1]], corner[cut[0]], corner[(cut[0] + 1) % 4]);
}

/* --- lines from pieces, and areas from lines --- */

/* Appends a piece's inner points, starting at its end number `from`. */
static void append_piece(cutter *c, const piece *one, int from)
{
    for (size_t k = 0; k < one->count; k++)
        add_point(c, c->out->point[one->first + (from == 0 ? k : one->count - 1 - k)]);
}

/* Follows pieces from an end to a junction, or once around, and joins them into one line. */
static void chain(cutter *c, size_t start, int from)
{
    section *s = c->out;
    c->failed |= !GROW(s->line, s->line_capacity, s->line_count + 1);
    if (c->failed)
        return;
    section_line *line = &s->line[s->line_count++];
    *line = (section_line){.first = s->point_count, .a = c->pieces[start].a, .b = c->pieces[start].b, .end = {-1, -1}};
    int at = c->pieces[start].end[from];
    if (at >= c->edges)
        line->end[0] = at - c->edges;
    add_point(c, c->crossing[at]);
    for (int i = (int)start; i >= 0 && !c->failed;) {
        piece *one = &c->pieces[i];
        const int first = one->end[0] == at ? 0 : 1;
        one->used = true;
        append_piece(c, one, first);
        at = one->end[1 - first];
        add_point(c, c->crossing[at]);
        if (at >= c->edges) {
            line->end[1] = at - c->edges;
            break;
        }
        const int next = c->ends[at][0] == i ? c->ends[at][1] : c->ends[at][0];
        i = next >= 0 && !c->pieces[next].used ? next : -1;
    }
    line->count = s->point_count - line->first;
}

/* Lines between junctions first; the remaining pieces form closed lines. */
static void chain_all(cutter *c)
{
    for (size_t i = 0; i < c->piece_count && !c->failed; i++)
        for (int k = 0; k < 2; k++)
            if (!c->pieces[i].used && c->pieces[i].end[k] >= c->edges)
                chain(c, i, k);
    for (size_t i = 0; i < c->piece_count && !c->failed; i++)
        if (!c->pieces[i].used)
            chain(c, i, 0);
}

static bool bounds(const section_line *line, int medium)
{
    return line->a == medium || line->b == medium;
}

/* An unused line of the medium at a junction; line_count when there is none. */
static size_t line_at(const section *s, int medium, int junction, const bool *used)
{
    for (size_t i = 0; i < s->line_count; i++)
        if (!used[i] && bounds(&s->line[i], medium) && (s->line[i].end[0] == junction || s->line[i].end[1] == junction))
            return i;
    return s->line_count;
}

status section_area(const section *s, int medium, section_step *out, size_t *count, diagnostic *why)
{
    *count = 0;
    bool *used = calloc(s->line_count + 1, sizeof *used);
    if (!used)
        return out_of_memory(why);
    for (size_t i = 0; i < s->line_count; i++) {
        if (used[i] || !bounds(&s->line[i], medium))
            continue;
        size_t at = i;
        int junction = s->line[i].end[0];
        for (bool first = true; at < s->line_count; first = false) {
            const bool backwards = s->line[at].end[0] != junction;
            used[at] = true;
            out[(*count)++] = (section_step){at, backwards, first};
            junction = s->line[at].end[backwards ? 0 : 1];
            at = junction < 0 ? s->line_count : line_at(s, medium, junction, used);
        }
    }
    free(used);
    return STATUS_OK;
}

status section_cut(const probe *p, const section_plane *plane, int cells, section *out, diagnostic *why)
{
    const double width = plane->u1 - plane->u0, height = plane->v1 - plane->v0;
    if (!(width > 0.0 && height > 0.0 && isfinite(width) && isfinite(height)) || cells < 2 || cells > SECTION_CELLS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "set an extent above 0, and 2 to 4096 cells",
                        "the section's extent or its number of cells (%d) is out of range", cells);
    out->point_count = out->line_count = 0;
    cutter c = {.p = p, .plane = plane, .out = out};
    c.failed = !prepare(&c, cells);
    if (!c.failed)
        sample(&c);
    c.failed = c.failed || cancel_asked();
    for (int j = 0; j + 1 < c.nv && !c.failed; j++)
        for (int i = 0; i + 1 < c.nu && !c.failed; i++)
            march(&c, i, j);
    c.failed = c.failed || cancel_asked();
    chain_all(&c);
    free(c.label);
    free(c.crossing);
    free(c.ends);
    free(c.pieces);
    return c.failed ? cancelled_or_out_of_memory(why) : STATUS_OK;
}

/* Squared distance of p from the segment ab, in scene units squared. */
static double distance2(section_point p, section_point a, section_point b)
{
    const double du = b.u - a.u, dv = b.v - a.v, length2 = du * du + dv * dv;
    const double fraction = length2 > 0.0 ? ((p.u - a.u) * du + (p.v - a.v) * dv) / length2 : 0.0;
    const double within = fraction < 0.0 ? 0.0 : fraction > 1.0 ? 1.0 : fraction;
    const double off_u = p.u - a.u - within * du, off_v = p.v - a.v - within * dv;
    return off_u * off_u + off_v * off_v;
}

/* Marks the points between first and last that the line needs. */
static void mark_needed(const section *s, double tolerance, size_t first, size_t last, bool *needed)
{
    size_t farthest = first;
    double most = tolerance * tolerance;
    needed[first] = needed[last] = true;
    for (size_t k = first + 1; k < last; k++) {
        const double off = distance2(s->point[k], s->point[first], s->point[last]);
        if (off > most)
            most = off, farthest = k;
    }
    if (farthest == first)
        return;
    mark_needed(s, tolerance, first, farthest, needed);
    mark_needed(s, tolerance, farthest, last, needed);
}

status section_simplify(section *s, double tolerance, diagnostic *why)
{
    bool *needed = calloc(s->point_count + 1, sizeof *needed);
    if (!needed)
        return out_of_memory(why);
    size_t kept = 0;
    for (size_t i = 0; i < s->line_count; i++) {
        section_line *line = &s->line[i];
        const size_t first = line->first, end = first + line->count;
        mark_needed(s, tolerance, first, end - 1, needed);
        line->first = kept;
        for (size_t k = first; k < end; k++)
            if (needed[k])
                s->point[kept++] = s->point[k];
        line->count = kept - line->first;
    }
    s->point_count = kept;
    free(needed);
    return STATUS_OK;
}
