/* Marching squares with junctions: the pieces of boundary within one cell. */
#include "base/array.h"
#include "render/inspect/section_private.h"

#include <stdlib.h>

/* Largest number of halvings of a piece of boundary; a piece that deviates from a straight line by less than STRAIGHT
 * (share of a cell) is not halved. A junction is enclosed to 2^-JUNCTION_STEPS of a cell. */
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
    const section_point on = section_bisect(c, left, right, a);
    const double off_u = on.u - middle.u, off_v = on.v - middle.v;
    if (off_u * off_u + off_v * off_v < STRAIGHT * STRAIGHT * cell * cell)
        return;
    refine(c, from, on, a, b, halvings - 1);
    section_add_point(c, on);
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
            c->at[one->end[k]][c->at[one->end[k]][0] >= 0] = index;
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

/* The point where three media meet: repeatedly takes the quarter of the cell whose corners are in the most media. */
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

void section_march(cutter *c, int i, int j)
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
