/* Layers of clear solids: for each grid point the surfaces in front of the nearest opaque one, in order of depth
 * (Carpenter, "The A-buffer, an antialiased hidden surface method", SIGGRAPH 1984), reduced to the surfaces at which
 * the medium changes, by priority as for rays. */
#include "base/array.h"
#include "render/zbuffer/zbuffer_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Surfaces whose depths differ by less than this relative difference are in contact: the column enters or leaves their
 * regions in one step. */
#define IN_CONTACT 1e-9

void zbuffer_square_begin(zbuffer_square *s)
{
    s->block = NULL;
}

void zbuffer_square_release(zbuffer_square *s)
{
    free(s->fragments);
    free(s->column);
}

void zbuffer_add_fragment(zbuffer *z, zbuffer_square *s, int point, double nearness, uint32_t number)
{
    if (s->count == INT32_MAX || !GROW(s->fragments, s->capacity, s->count + 1)) {
        atomic_store(&z->out_of_memory, true);
        return;
    }
    s->fragments[s->count] = (rasterised_fragment){nearness, number, s->newest[point], z->triangles[number].part};
    s->newest[point] = (int32_t)s->count++;
}

static int compare_fragments(const void *a, const void *b)
{
    const rasterised_fragment *x = a, *y = b;
    if (x->nearness != y->nearness)
        return x->nearness > y->nearness ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

static void sort_fragments(rasterised_fragment *f, int count)
{
    if (count > 24) {
        qsort(f, (size_t)count, sizeof *f, compare_fragments);
        return;
    }
    for (int k = 1; k < count; k++) {
        const rasterised_fragment one = f[k];
        int at = k;
        for (; at > 0 && compare_fragments(&one, &f[at - 1]) < 0; at--)
            f[at] = f[at - 1];
        f[at] = one;
    }
}

static bool is_opaque(const zbuffer *z, const rasterised_fragment *f)
{
    return z->frame_plan->geometry->regions[z->parts[f->part].at.priority_index].opaque;
}

/* True if the fragment is in front of the opaque surface that is drawn without layers. Of two opaque surfaces the
 * nearer one is visible, however close they are; of two equally near, the one of higher priority, as without clear
 * solids. */
static bool is_in_front(const zbuffer *z, const rasterised_fragment *f, double nearness, uint32_t seen)
{
    if (!is_opaque(z, f))
        return f->nearness - nearness > IN_CONTACT * fabs(f->nearness);
    if (f->nearness != nearness)
        return f->nearness > nearness;
    return z->parts[f->part].at.priority_index > z->parts[z->triangles[seen - 1].part].at.priority_index;
}

/* Collects the point's fragments in front of its nearest opaque surface, nearest first; returns their number. */
static int collect(zbuffer *z, zbuffer_square *s, int point, uint32_t seen)
{
    int count = 0;
    for (int32_t k = s->newest[point]; k >= 0; k = s->fragments[k].next) {
        const rasterised_fragment *f = &s->fragments[k];
        if (!is_in_front(z, f, s->nearness[point], seen))
            continue;
        if (!GROW(s->column, s->column_capacity, (size_t)count + 1)) {
            atomic_store(&z->out_of_memory, true);
            return 0;
        }
        s->column[count++] = *f;
    }
    sort_fragments(s->column, count);
    return count;
}

typedef struct layer_list {
    int count;
    rasterised_layer layer[LAYERS_MAX];
} layer_list;

/* The region's bit in sets of regions: bit r - 1 for priority index r. The highest bit determines the medium. */
static uint64_t bit_of(const zbuffer *z, const rasterised_fragment *f)
{
    return (uint64_t)1 << (z->parts[f->part].at.priority_index - 1);
}

static int highest(uint64_t inside)
{
    return inside ? 64 - __builtin_clzll(inside) : 0;
}

/* Crosses the surfaces in contact at the front of the column: each surface enters or leaves its region, whatever the
 * facing of its triangle, so that near an outline, where front and back are equally near, their order does not matter.
 * The drawn outside and hollow of a cup bound its material. At most one of them is opaque. Returns their number. */
static int cross(const zbuffer *z, const rasterised_fragment *f, int count, uint64_t *inside)
{
    int n = 0;
    bool opaque = false;
    do {
        if (opaque && is_opaque(z, &f[n]))
            break;
        opaque |= is_opaque(z, &f[n]);
        const uint64_t bit = bit_of(z, &f[n]);
        *inside = z->open_surfaces & bit ? *inside | bit : *inside ^ bit;
        n++;
    } while (n < count && f[0].nearness - f[n].nearness <= IN_CONTACT * fabs(f[0].nearness));
    return n;
}

/* The layer for surfaces in contact, with the triangle of the region that owns the surface. */
static inline rasterised_layer layer_of(const zbuffer *z, const rasterised_fragment *f, int count, uint64_t inside,
                                        int before, int after)
{
    const int priority_index = scene_geometry_surface(z->frame_plan->geometry, before, after);
    const rasterised_fragment *c = f;
    for (int k = 1; k < count && z->parts[c->part].at.priority_index != priority_index; k++)
        c = z->parts[f[k].part].at.priority_index == priority_index ? &f[k] : c;
    const rasterised_part *p = &z->parts[c->part];
    return (rasterised_layer){.number = c->number + 1,
                              .before = (uint8_t)before,
                              .after = (uint8_t)after,
                              .surface = (uint8_t)priority_index,
                              .leaving = ((inside & bit_of(z, c)) != 0) != p->hollow,
                              .ends = z->frame_plan->geometry->regions[priority_index].opaque};
}

static bool absorb_equally(const plan *p, int before, int after)
{
    const vec3 a = p->absorption[before], b = p->absorption[after];
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Lists the layers of a point. Every layer except the last is a clear interface, limited in number by the depth limit,
 * or no interface; the last one ends the view. */
static void list_layers(const zbuffer *z, const rasterised_fragment *f, int count, uint32_t base, layer_list *l)
{
    const scene_geometry *g = z->frame_plan->geometry;
    const int most = (int)z->frame_plan->render.depth + 1;
    uint64_t inside = z->eye_inside;
    int before = highest(inside);
    int interfaces = 0;
    l->count = 0;
    for (int k = 0; k < count && interfaces < most;) {
        uint64_t behind = inside;
        const int crossed = cross(z, f + k, count - k, &behind), after = highest(behind);
        if (g->regions[before].medium != g->regions[after].medium) {
            l->layer[l->count++] = layer_of(z, f + k, crossed, inside, before, after);
            interfaces++;
            if (l->layer[l->count - 1].ends)
                return;
        } else if (l->count < LAYERS_MAX - most && !absorb_equally(z->frame_plan, before, after)) {
            l->layer[l->count] = layer_of(z, f + k, crossed, inside, before, after);
            l->layer[l->count++].passed = true;
        }
        inside = behind & ~z->open_surfaces;
        before = highest(inside);
        k += crossed;
    }
    if (interfaces < most) {
        const int after = base ? z->parts[z->triangles[base - 1].part].at.priority_index : before;
        l->layer[l->count++] = (rasterised_layer){.number = base,
                                                  .before = (uint8_t)before,
                                                  .after = (uint8_t)after,
                                                  .surface = (uint8_t)after,
                                                  .ends = true};
    }
}

/* Allocates a list in the worker's block, or in a new one. NULL when out of memory. */
static rasterised_layer *room_for(zbuffer *z, zbuffer_square *s, int count, uint32_t *place)
{
    if (!s->block || s->used + (uint32_t)count > BLOCK_LAYERS) {
        const uint32_t number = atomic_fetch_add(&z->next_block, 1);
        if (number >= BLOCKS_MAX || !(z->blocks[number] = malloc(BLOCK_LAYERS * sizeof(rasterised_layer))))
            return NULL;
        s->block = z->blocks[number];
        s->block_number = number;
        s->used = 0;
    }
    *place = s->block_number * BLOCK_LAYERS + s->used;
    s->used += (uint32_t)count;
    return s->block + s->used - count;
}

/* True if a single surface is visible, through the surrounding medium only. Then it does not matter whether its solid
 * is drawn as layers. */
static bool shows_one_surface(const zbuffer *z, const layer_list *l)
{
    const rasterised_layer *f = &l->layer[0];
    if (l->count != 1 || !f->ends || f->before != 0)
        return false;
    return f->number == 0 || z->parts[z->triangles[f->number - 1].part].at.priority_index == f->surface;
}

/* Resolves the visible surfaces at a point. */
static void resolve_point(zbuffer *z, zbuffer_square *s, int point, uint32_t *seen, size_t *listed)
{
    layer_list l;
    const int count = collect(z, s, point, *seen);
    list_layers(z, s->column, count, *seen, &l);
    if (shows_one_surface(z, &l)) {
        *seen = l.layer[0].number;
        return;
    }
    uint32_t place;
    rasterised_layer *to = room_for(z, s, l.count, &place);
    if (!to) {
        atomic_store(&z->out_of_memory, true);
        return;
    }
    memcpy(to, l.layer, (size_t)l.count * sizeof *to);
    *seen = SEEN_LAYERS | place;
    *listed += (size_t)l.count;
}

void zbuffer_resolve(zbuffer *z, int x0, int y0, int x1, int y1, zbuffer_square *s)
{
    size_t listed = 0;
    int point = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++, point++)
            if (s->newest[point] >= 0 || z->eye_inside)
                resolve_point(z, s, point, &z->seen[(size_t)y * (size_t)z->width + (size_t)x], &listed);
    atomic_fetch_add_explicit(&z->layer_count, listed, memory_order_relaxed);
}
