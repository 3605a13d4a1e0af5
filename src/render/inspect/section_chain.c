/* Lines from pieces of boundary, and areas from lines. */
#include "base/array.h"
#include "render/inspect/section_private.h"

#include <stdlib.h>

/* Appends a piece's inner points, starting at its end number `from`. */
static void append_piece(cutter *c, const piece *one, int from)
{
    for (size_t k = 0; k < one->count; k++)
        section_add_point(c, c->out->point[one->first + (from == 0 ? k : one->count - 1 - k)]);
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
    section_add_point(c, c->crossing[at]);
    for (int i = (int)start; i >= 0 && !c->failed;) {
        piece *one = &c->pieces[i];
        const int first = one->end[0] == at ? 0 : 1;
        one->used = true;
        append_piece(c, one, first);
        at = one->end[1 - first];
        section_add_point(c, c->crossing[at]);
        if (at >= c->edges) {
            line->end[1] = at - c->edges;
            break;
        }
        const int next = c->at[at][0] == i ? c->at[at][1] : c->at[at][0];
        i = next >= 0 && !c->pieces[next].used ? next : -1;
    }
    line->count = s->point_count - line->first;
}

/* Lines between junctions first; the remaining pieces form closed lines. */
void section_chain_all(cutter *c)
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
