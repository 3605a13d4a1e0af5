/* Gives each spring an owner, and stores the springs in batches of LANES owners. */
#include "softbody/softbody_private.h"

#include <stdlib.h>
#include <string.h>

/* While batches are built. */
typedef struct owners {
    uint8_t *end;    /* by spring: which of its ends owns it */
    uint32_t *owned; /* by mass: how many it owns */
    uint32_t *place; /* by spring: its place in the batches */
} owners;

static void owners_release(owners o)
{
    free(o.end);
    free(o.owned);
    free(o.place);
}

/* A batch lasts as long as its busiest owner's: springs move to the end that owns fewer until no move makes it more
 * even. Each move lowers the sum of the squared numbers, so this ends. */
static void share_springs(const softbody_net *net, owners o)
{
    for (size_t i = 0; i < net->spring_count; i++)
        o.owned[net->springs[i].end[0]]++;
    for (bool moved = true; moved;) {
        moved = false;
        for (size_t i = 0; i < net->spring_count; i++) {
            const uint32_t owner = net->springs[i].end[o.end[i]], other = net->springs[i].end[1 - o.end[i]];
            if (o.owned[owner] <= o.owned[other] + 1)
                continue;
            o.owned[owner]--;
            o.owned[other]++;
            o.end[i] = 1 - o.end[i];
            moved = true;
        }
    }
}

/* Where the springs of each LANES masses begin. */
static void measure_groups(spring_batches *t, size_t groups, owners o)
{
    for (size_t g = 0; g < groups; g++) {
        size_t owned = 0;
        for (size_t mass = LANES * g; mass < LANES * (g + 1); mass++)
            owned = o.owned[mass] > owned ? o.owned[mass] : owned;
        t->first[g + 1] = t->first[g] + LANES * owned;
    }
}

/* The masses of each group that own as many springs as its busiest one. */
typedef struct busy {
    uint32_t most, masses;
} busy;

static void find_busy(busy *groups, size_t stride, owners o)
{
    memset(groups, 0, stride / LANES * sizeof *groups);
    for (size_t mass = 0; mass < stride; mass++) {
        busy *g = &groups[mass / LANES];
        if (o.owned[mass] > g->most)
            *g = (busy){o.owned[mass], 0};
        g->masses += o.owned[mass] == g->most;
    }
}

/* Gathers the busiest masses in few groups: a spring goes to its other end where that becomes one of its group's
 * busiest and such masses are not fewer there. The sum of the squared numbers grows, so this ends. */
static void gather_busy(const softbody_net *net, busy *groups, size_t stride, owners o)
{
    for (bool moved = true; moved;) {
        moved = false;
        find_busy(groups, stride, o);
        for (size_t i = 0; i < net->spring_count; i++) {
            const uint32_t owner = net->springs[i].end[o.end[i]], other = net->springs[i].end[1 - o.end[i]];
            busy *from = &groups[owner / LANES], *to = &groups[other / LANES];
            if (from == to || from->masses == 0 || o.owned[owner] < from->most || o.owned[other] + 1 != to->most ||
                from->masses > to->masses)
                continue;
            o.owned[owner]--;
            o.owned[other]++;
            o.end[i] = 1 - o.end[i];
            from->masses--;
            to->masses++;
            moved = true;
        }
    }
}

static bool make_places(spring_batches *t, size_t count)
{
    t->row = aligned_alloc(64, (count / 16 + 1) * 16 * sizeof *t->row);
    t->rest = softbody_array(count);
    t->stiffness = softbody_array(count);
    t->damping = softbody_array(count);
    t->pull = softbody_array(count + 1);
    return t->row && t->rest && t->stiffness && t->damping && t->pull;
}

/* Each mass's springs, in the order of its slots. */
static void place_springs(spring_batches *t, const springs *s, const softbody_net *net, owners o)
{
    for (size_t mass = 0; mass < s->stride; mass++) {
        size_t k = t->first[mass / LANES] + mass % LANES;
        for (int slot = 0; slot < s->slots; slot++) {
            const size_t from = (size_t)slot * s->stride + mass;
            const uint32_t spring = s->place[from];
            if (spring == NO_SPRING || net->springs[spring].end[o.end[spring]] != mass)
                continue;
            o.place[spring] = (uint32_t)k;
            t->row[k] = s->row[from];
            t->rest[k] = s->rest[from];
            t->stiffness[k] = s->stiffness[from];
            t->damping[k] = s->damping[from];
            k += LANES;
        }
        for (; k < t->first[mass / LANES + 1]; k += LANES)
            t->row[k] = STATE * (int32_t)mass;
    }
}

status batches_build(spring_batches *t, springs *s, const softbody_net *net, diagnostic *why)
{
    const size_t groups = s->stride / LANES;
    *t = (spring_batches){.first = calloc(groups + 1, sizeof *t->first)};
    const owners o = {.end = calloc(net->spring_count + 1, sizeof *o.end),
                      .owned = calloc(s->stride, sizeof *o.owned),
                      .place = calloc(net->spring_count + 1, sizeof *o.place)};
    busy *groups_busy = malloc((groups + 1) * sizeof *groups_busy);
    bool made = t->first && o.end && o.owned && o.place && groups_busy;
    if (made) {
        share_springs(net, o);
        gather_busy(net, groups_busy, s->stride, o);
        measure_groups(t, groups, o);
        made = t->first[groups] < NO_SPRING && make_places(t, t->first[groups]);
    }
    if (made) {
        for (size_t i = 0; i < (size_t)s->slots * s->stride; i++)
            s->row[i] = STATE * s->other[i];
        place_springs(t, s, net, o);
        for (size_t i = 0; i < (size_t)s->slots * s->stride; i++)
            s->place[i] = s->place[i] == NO_SPRING ? (uint32_t)t->first[groups] : o.place[s->place[i]];
    }
    owners_release(o);
    free(groups_busy);
    return made ? STATUS_OK : diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory for springs");
}

void batches_release(spring_batches *t)
{
    free(t->first);
    free(t->row);
    free(t->rest);
    free(t->stiffness);
    free(t->damping);
    free(t->pull);
}
