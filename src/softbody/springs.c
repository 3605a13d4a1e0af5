/* Converts lists of springs and faces to arrays by vertex. */
#include "softbody/softbody_private.h"

#include <stdlib.h>
#include <string.h>

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
    bool taken;
} wedge;
typedef struct rings {
    int *used;
    wedge *wedges;
} rings; /* by vertex: the number of wedges, and ring_slots of them */

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
        const wedge *own = r.wedges + i * (size_t)s->ring_slots;
        for (int slot = 0; slot < s->ring_slots && r.used[i] > 0; slot++)
            s->other[(size_t)slot * s->stride + i] = own[slot < r.used[i] ? slot : 0].from;
    }
}

/* The slot of a vertex for its next spring: the ring's slot of that neighbour unless it is in use, otherwise the next
 * after the ring. */
static int slot_of(const springs *s, rings r, uint32_t at, uint32_t other, int *behind)
{
    wedge *own = r.wedges + at * (size_t)s->ring_slots;
    for (int slot = 0; slot < r.used[at]; slot++) {
        if (own[slot].from == (int32_t)other && !own[slot].taken) {
            own[slot].taken = true;
            return slot;
        }
    }
    return s->ring_slots + behind[at]++;
}

/* Assigns slots to every spring; fill: and writes them. behind: the number of slots after the ring of each vertex. */
static void assign_slots(springs *s, const softbody_net *net, rings r, int *behind, bool fill)
{
    memset(behind, 0, s->stride * sizeof *behind);
    for (size_t i = 0; i < (size_t)s->ring_slots * s->stride; i++)
        r.wedges[i].taken = false;
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
