#include "study/identity.h"
#include "base/hash.h"
#include "scene/model/params.h"
#include "study/grid.h"
#include "study/meaning.h"
#include <stdlib.h>

static bool names_file(const study *s, const study_axis *axis)
{
    param_place at;
    for (size_t i = 0; i < axis->points[0].count; i++)
        if (param_place_find(s->base, axis->points[0].paths[i], &at, NULL) == STATUS_OK && at.row->type == PARAM_PATH)
            return true;
    return false;
}

/* Whether cells may differ in the files that they name. */
static bool files_vary(const study *s)
{
    for (size_t axis = 0; axis < s->axis_count; axis++)
        if (names_file(s, &s->axes[axis]))
            return true;
    return false;
}

typedef struct search {
    uint64_t *identity;
    bool loads;
    uint64_t files; /* of the base, unless they vary */
} search;

static status find_one(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    search *all = context;
    meaning said = {0};
    uint64_t files = all->files;
    if (all->loads) {
        scene_load_files(setting, NULL); /* a file that cannot be read has no contents; measuring reports it */
        files = HASH_START;
        TRY(grid_hash_files(&files, setting, why));
    }
    const status code = meaning_of_scene(&said, setting, false);
    const int64_t words[] = {(int64_t)meaning_hash(&said), (int64_t)files};
    meaning_free(&said);
    if (code != STATUS_OK)
        return out_of_memory(why);
    all->identity[cell] = hash_finish(hash_words(HASH_START, words, 2));
    (void)s;
    return STATUS_OK;
}

typedef struct numbered {
    uint64_t identity;
    size_t cell;
} numbered;

static int compare_numbered(const void *a, const void *b)
{
    const numbered *x = a, *y = b;
    if (x->identity != y->identity)
        return x->identity < y->identity ? -1 : 1;
    return (x->cell > y->cell) - (x->cell < y->cell);
}

/* Two cells have one identity if they differ only in values without any effect. Their axis values distinguish them. */
static status separate_equals(const study *s, uint64_t *identity, diagnostic *why)
{
    const size_t count = study_cell_count(s);
    numbered *sorted = malloc(count * sizeof *sorted);
    if (!sorted)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        sorted[i] = (numbered){identity[i], i};
    qsort(sorted, count, sizeof *sorted, compare_numbered);
    for (size_t i = 1; i < count; i++) {
        if (sorted[i].identity != sorted[i - 1].identity)
            continue;
        uint64_t hash = sorted[i].identity;
        for (size_t axis = 0; axis < s->axis_count; axis++)
            grid_hash_point(&hash, &s->axes[axis].points[study_cell_point(s, sorted[i].cell, axis)]);
        identity[sorted[i].cell] = hash_finish(hash);
    }
    free(sorted);
    return STATUS_OK;
}

status identities_find(const study *s, uint64_t **out, diagnostic *why)
{
    search all = {.loads = files_vary(s), .files = HASH_START};
    *out = NULL;
    if (!all.loads)
        TRY(grid_hash_files(&all.files, s->base, why));
    all.identity = calloc(study_cell_count(s), sizeof *all.identity);
    status code = all.identity ? grid_each_cell(s, find_one, &all, why) : out_of_memory(why);
    THEN(code, separate_equals(s, all.identity, why));
    if (code == STATUS_OK)
        *out = all.identity;
    else
        free(all.identity);
    return code;
}

size_t identity_cell(const study *s, uint64_t identity)
{
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        if (s->identity[cell] == identity)
            return cell;
    return study_cell_count(s);
}

uint64_t identity_compared(const study *s, uint64_t identity)
{
    const int64_t word = (int64_t)identity;
    uint64_t hash = hash_words(HASH_START, &word, 1);
    grid_hash_point(&hash, &s->reference);
    return hash_finish(hash);
}
