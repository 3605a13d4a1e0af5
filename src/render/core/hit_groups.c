/* Groups of rays that are shaded together. */
#include "render/core/hit_groups.h"

/* The batch's rays by group, as lists linked through the rays. */
typedef struct linked_groups {
    int count;
    int hit_primitive[BATCH], priority_index[BATCH];
    int16_t head[BATCH], tail[BATCH], size[BATCH];
    int16_t next_same[BATCH]; /* another group of the same primitive, on another surface; -1 for none */
    int16_t next_ray[BATCH];
} linked_groups;

static int new_group(linked_groups *l, int hit_primitive, int priority_index, int ray)
{
    const int g = l->count++;
    l->hit_primitive[g] = hit_primitive;
    l->priority_index[g] = priority_index;
    l->head[g] = l->tail[g] = (int16_t)ray;
    l->size[g] = 1;
    l->next_same[g] = -1;
    return g;
}

static void append(linked_groups *l, int g, int ray)
{
    l->next_ray[l->tail[g]] = (int16_t)ray;
    l->tail[g] = (int16_t)ray;
    l->size[g]++;
}

/* Adds a ray to its group; returns the group. */
static int add_ray(linked_groups *l, int16_t *marks, int hit_primitive, int priority_index, int ray)
{
    int g = marks[hit_primitive];
    if (g < 0)
        return marks[hit_primitive] = (int16_t)new_group(l, hit_primitive, priority_index, ray);
    while (l->priority_index[g] != priority_index && l->next_same[g] >= 0)
        g = l->next_same[g];
    if (l->priority_index[g] != priority_index)
        return l->next_same[g] = (int16_t)new_group(l, hit_primitive, priority_index, ray);
    append(l, g, ray);
    return g;
}

static void write_group(const linked_groups *l, int g, hit_groups *out, int *written)
{
    out->group[out->count++] = (hit_group){l->hit_primitive[g], l->priority_index[g], *written, l->size[g]};
    for (int n = 0, ray = l->head[g]; n < l->size[g]; n++, ray = l->next_ray[ray])
        out->list[(*written)++] = ray;
}

/* Writes the groups so that those that look alike are neighbours: each group is linked to the next of its kind. */
static void write_groups(const linked_groups *l, const int *alike, int16_t *alike_marks, hit_groups *out)
{
    int16_t next[BATCH], last[BATCH];
    int written = 0;
    out->count = 0;
    for (int g = 0; g < l->count; g++) {
        int16_t *mark = &alike_marks[alike[l->priority_index[g]]];
        next[g] = -1;
        if (*mark < 0)
            *mark = (int16_t)g;
        else
            next[last[*mark]] = (int16_t)g;
        last[*mark] = (int16_t)g;
    }
    for (int g = 0; g < l->count; g++) {
        int16_t *mark = &alike_marks[alike[l->priority_index[g]]];
        if (*mark != g)
            continue;
        for (int k = g; k >= 0; k = next[k])
            write_group(l, k, out, &written);
        *mark = -1;
    }
}

void hit_groups_make(const hit_batch *hits, int count, const int *alike, int16_t *marks, int16_t *alike_marks,
                     hit_groups *out)
{
    linked_groups l;
    l.count = 0;
    out->missed = 0;
    for (int i = 0, g = -1; i < count; i++) {
        const int64_t p = hits->hit_primitive[i], surface = hits->surface[i];
        if (p < 0)
            out->miss[out->missed++] = i;
        else if (g >= 0 && l.hit_primitive[g] == p && l.priority_index[g] == surface) /* as neighbours often do */
            append(&l, g, i);
        else
            g = add_ray(&l, marks, (int)p, (int)surface, i);
    }
    for (int g = 0; g < l.count; g++)
        marks[l.hit_primitive[g]] = -1;
    write_groups(&l, alike, alike_marks, out);
}
