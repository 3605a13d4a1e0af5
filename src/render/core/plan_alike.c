/* Regions whose hits may be shaded together: they have one material of equal parameters, without a texture or a
 * checker, which lie in each solid's own frame. */
#include "render/core/plan.h"

#include <stdlib.h>
#include <string.h>

typedef struct looks {
    const shading_material *mat;
    int priority_index;
    bool opaque;
} looks;

static int compare_materials(const looks *a, const looks *b)
{
    const int order = memcmp(&a->mat->surface, &b->mat->surface, sizeof a->mat->surface);
    return order ? order : (int)a->opaque - (int)b->opaque;
}

static int compare_looks(const void *one, const void *other)
{
    const looks *a = one, *b = other;
    const int order = compare_materials(a, b);
    return order ? order : a->priority_index - b->priority_index;
}

bool plan_is_plain(const plan *p, int priority_index)
{
    const region_materials *m = &p->shading_materials[priority_index];
    return m->count == 1 && !m->mat->img && !(m->mat->surface.checker > 0.0) && !p->spectral;
}

bool plan_find_alike(plan *p)
{
    const int regions = p->geometry->region_count;
    looks *all = calloc((size_t)regions + 1, sizeof *all);
    p->alike = calloc((size_t)regions + 1, sizeof *p->alike);
    if (!all || !p->alike) {
        free(all);
        return false;
    }
    int count = 0;
    for (int r = 1; r <= regions; r++) {
        p->alike[r] = r;
        if (plan_is_plain(p, r))
            all[count++] = (looks){p->shading_materials[r].mat, r, p->geometry->regions[r].opaque};
    }
    qsort(all, (size_t)count, sizeof *all, compare_looks);
    for (int k = 1; k < count; k++)
        if (compare_materials(&all[k - 1], &all[k]) == 0)
            p->alike[all[k].priority_index] = p->alike[all[k - 1].priority_index];
    free(all);
    return true;
}
