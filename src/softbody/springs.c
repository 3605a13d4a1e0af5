/* The springs of a body: by vertex, at both ends, and once each in batches of LANES owners. */
#include "softbody/softbody_private.h"
#include <stdlib.h>
#include <string.h>

double *softbody_array(size_t count)
{
    const size_t bytes = (count * sizeof(double) / 64 + 1) * 64;
    double *array = aligned_alloc(64, bytes);
    if (array)
        memset(array, 0, bytes);
    return array;
}

/* --- by vertex: lists of springs and faces become arrays --- */

static bool make_slots(springs *s)
{
    const size_t count = (size_t)s->slots * s->stride;
    s->other = aligned_alloc(64, (count + 16) / 16 * 16 * sizeof *s->other);
    s->rest = softbody_array(count);
    s->stiffness = softbody_array(count);
    s->damping = softbody_array(count);
    s->row = malloc((count + 1) * sizeof *s->row);
    s->place = malloc((count + 1) * sizeof *s->place);
    for (size_t i = 0; s->other && s->row && s->place && i < count; i++) {
        s->other[i] = (int32_t)(i % s->stride);
        s->place[i] = NO_SPRING;
    }
    return s->other && s->row && s->place && s->rest && s->stiffness && s->damping;
}

/* A face seen from one of its corners: the next corner and the one after; whether the first has a spring already. */
typedef struct wedge {
    int32_t from, to;
    bool has_spring;
} wedge;
typedef struct rings {
    int *used;
    wedge *wedges;
} rings; /* by vertex: the number of its wedges, and room for ring_slots of them */

static int most(const int *used, size_t count)
{
    int largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = used[i] > largest ? used[i] : largest;
    return largest;
}

/* Sorts a vertex's wedges so that each starts where the previous one ends; false if they are not closed. */
static bool chain(wedge *wedges, int count)
{
    for (int i = 1; i < count; i++) {
        int k = i;
        while (k < count && wedges[k].from != wedges[i - 1].to)
            k++;
        if (k == count)
            return false;
        const wedge moved = wedges[k];
        wedges[k] = wedges[i];
        wedges[i] = moved;
    }
    return count == 0 || (count > 2 && wedges[count - 1].to == wedges[0].from);
}

static void rings_release(rings r)
{
    free(r.used);
    free(r.wedges);
}

/* Sorts each vertex's wedges. STATUS_BAD_INPUT if they are not closed. */
static status find_rings(springs *s, const softbody_net *net, rings *out, diagnostic *why)
{
    *out = (rings){.used = calloc(s->stride + 1, sizeof *out->used)};
    for (size_t i = 0; out->used && i < 3 * net->face_count; i++)
        out->used[net->faces[i / 3].corner[i % 3]]++;
    s->ring_slots = out->used ? most(out->used, s->stride) : 0;
    out->wedges = calloc((size_t)s->ring_slots * s->stride + 1, sizeof *out->wedges);
    if (!out->used || !out->wedges)
        return diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory for springs");
    memset(out->used, 0, s->stride * sizeof *out->used);
    for (size_t i = 0; i < 3 * net->face_count; i++) {
        const uint32_t *corner = net->faces[i / 3].corner, at = corner[i % 3];
        out->wedges[at * (size_t)s->ring_slots + (size_t)out->used[at]++] =
            (wedge){(int32_t)corner[(i + 1) % 3], (int32_t)corner[(i + 2) % 3], false};
    }
    for (size_t i = 0; i < s->count; i++)
        if (!chain(out->wedges + i * (size_t)s->ring_slots, out->used[i]))
            return diagnose(why, STATUS_BAD_INPUT, "use a closed surface, or no faces",
                            "the faces around mass %zu are not closed", i);
    return STATUS_OK;
}

static void fill_rings(springs *s, rings r)
{
    for (size_t i = 0; i < s->count; i++) {
        const wedge *ring = r.wedges + i * (size_t)s->ring_slots;
        for (int slot = 0; slot < s->ring_slots && r.used[i] > 0; slot++)
            s->other[(size_t)slot * s->stride + i] = ring[slot < r.used[i] ? slot : 0].from;
    }
}

/* The slot of a vertex for its next spring: the ring's slot of that neighbour unless it is in use, otherwise the next
 * after the ring. */
static int slot_of(const springs *s, rings r, uint32_t at, uint32_t other, int *behind)
{
    wedge *ring = r.wedges + at * (size_t)s->ring_slots;
    for (int slot = 0; slot < r.used[at]; slot++) {
        if (ring[slot].from == (int32_t)other && !ring[slot].has_spring) {
            ring[slot].has_spring = true;
            return slot;
        }
    }
    return s->ring_slots + behind[at]++;
}

/* Assigns slots to every spring; fill: also writes the spring there. behind: the number of slots after the ring of each
 * vertex. */
static void assign_slots(springs *s, const softbody_net *net, rings r, int *behind, bool fill)
{
    memset(behind, 0, s->stride * sizeof *behind);
    for (size_t i = 0; i < (size_t)s->ring_slots * s->stride; i++)
        r.wedges[i].has_spring = false;
    for (size_t i = 0; i < 2 * net->spring_count; i++) {
        const softbody_spring *one = &net->springs[i / 2];
        const uint32_t at = one->end[i % 2], other = one->end[1 - i % 2];
        const size_t k = (size_t)slot_of(s, r, at, other, behind) * s->stride + at;
        if (!fill)
            continue;
        s->other[k] = (int32_t)other;
        s->place[k] = (uint32_t)(i / 2);
        s->rest[k] = one->rest;
        s->stiffness[k] = one->stiffness;
        s->damping[k] = one->damping;
    }
}

status springs_build(springs *s, const softbody_net *net, diagnostic *why)
{
    *s = (springs){.count = net->mass_count, .stride = (net->mass_count + LANES - 1) / LANES * LANES};
    rings r;
    int *count = calloc(s->stride + 1, sizeof *count);
    status code = find_rings(s, net, &r, why);
    if (code == STATUS_OK && count) {
        assign_slots(s, net, r, count, false);
        s->slots = s->ring_slots + most(count, s->stride);
        if (make_slots(s)) {
            fill_rings(s, r);
            assign_slots(s, net, r, count, true);
        } else {
            code = diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory for springs");
        }
    } else if (code == STATUS_OK) {
        code = out_of_memory(why);
    }
    rings_release(r);
    free(count);
    return code;
}

void springs_release(springs *s)
{
    free(s->other);
    free(s->row);
    free(s->place);
    free(s->rest);
    free(s->stiffness);
    free(s->damping);
}

/* --- in batches: each spring has an owner, and LANES owners share a batch --- */

/* Working memory while batches are built. */
typedef struct owners {
    uint8_t *end;    /* by spring: which of its ends owns it */
    uint32_t *owned; /* by mass: number of springs that it owns */
    uint32_t *place; /* by spring: its place in the batches */
} owners;

static void owners_release(owners o)
{
    free(o.end);
    free(o.owned);
    free(o.place);
}

/* Balances the springs among owners, as a batch takes as long as its busiest owner: springs move to the end that owns
 * fewer until no move helps. Each move lowers the sum of the squared numbers, so this ends. */
static void balance_owners(const softbody_net *net, owners o)
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

/* Computes first: where the springs of each LANES masses begin. */
static void measure_groups(spring_batches *t, size_t groups, owners o)
{
    for (size_t g = 0; g < groups; g++) {
        size_t owned = 0;
        for (size_t mass = LANES * g; mass < LANES * (g + 1); mass++)
            owned = o.owned[mass] > owned ? o.owned[mass] : owned;
        t->first[g + 1] = t->first[g] + LANES * owned;
    }
}

/* Of a group: the most springs that a mass owns, and how many masses own that many. */
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

/* Gathers the busiest masses in few groups: a spring moves to its other end if that becomes one of the busiest of its
 * group, and its group has at least as many of them. The sum of the squared numbers grows, so this ends. */
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

/* Stores each mass's springs in the order of its slots. */
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
    bool complete = t->first && o.end && o.owned && o.place && groups_busy;
    if (complete) {
        balance_owners(net, o);
        gather_busy(net, groups_busy, s->stride, o);
        measure_groups(t, groups, o);
        complete = t->first[groups] < NO_SPRING && make_places(t, t->first[groups]);
    }
    if (complete) {
        for (size_t i = 0; i < (size_t)s->slots * s->stride; i++)
            s->row[i] = STATE * s->other[i];
        place_springs(t, s, net, o);
        for (size_t i = 0; i < (size_t)s->slots * s->stride; i++)
            s->place[i] = s->place[i] == NO_SPRING ? (uint32_t)t->first[groups] : o.place[s->place[i]];
    }
    owners_release(o);
    free(groups_busy);
    return complete ? STATUS_OK : diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory for springs");
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
