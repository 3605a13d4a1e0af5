#include "study/progress_index.h"
#include "base/grow.h"
#include "measure/statistics.h"
#include "study/row_files.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

status progress_index_add(progress_index *l, const progress_index_entry *entry, diagnostic *why)
{
    progress_index_cell *cell = &l->cells[entry->cell];
    if (!entry->warmup) {
        if (!room_for_one(&cell->wall_s, cell->counted, sizeof *cell->wall_s))
            return out_of_memory(why);
        cell->wall_s[cell->counted++] = entry->wall_s;
    }
    progress_index_cell *film = &l->cells[study_cell_film(l->s, entry->cell)];
    film->film_expected = progress_index_film(l, entry->cell, entry->film_hash);
    film->film_known = true;
    cell->rows++;
    if (entry->repetition >= cell->next_repetition)
        cell->next_repetition = entry->repetition + 1;
    bool marked = entry->film_hash != film->film_expected;
    cell->marked += marked;
    l->marked += marked;
    l->rows++;
    return STATUS_OK;
}

status progress_index_read(const study *s, const char *results, progress_index **out, diagnostic *why)
{
    *out = NULL;
    row_files *files;
    TRY(row_files_read(s, results, ROWS, &files, why));
    status code = STATUS_OK;
    progress_index *l = calloc(1, sizeof *l);
    if (l) {
        l->s = s;
        l->cells = calloc(l->cell_count = study_cell_count(s), sizeof *l->cells);
    }
    if (!l || !l->cells)
        code = out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        progress_index_entry entry = {.cell = ref->cell,
                                      .repetition = ref->repetition,
                                      .warmup = ref->warmup,
                                      .film_hash = strtoull(row_field(ref, "film_hash"), NULL, 16),
                                      .wall_s = row_field_real(ref, "wall_s")};
        code = progress_index_add(l, &entry, why);
    }
    row_files_destroy(files);
    if (code != STATUS_OK) {
        progress_index_destroy(l);
        return code;
    }
    *out = l;
    return STATUS_OK;
}

void progress_index_destroy(progress_index *l)
{
    if (!l)
        return;
    for (size_t i = 0; l->cells && i < l->cell_count; i++)
        free(l->cells[i].wall_s);
    free(l->cells);
    free(l);
}

uint64_t progress_index_film(const progress_index *l, size_t cell, uint64_t film_hash)
{
    const progress_index_cell *film = &l->cells[study_cell_film(l->s, cell)];
    return film->film_known ? film->film_expected : film_hash;
}

bool progress_index_cell_done(const progress_index *l, size_t cell)
{
    const study *s = l->s;
    const progress_index_cell *at = &l->cells[cell];
    if (at->counted >= (size_t)s->repetitions_max)
        return true;
    if (at->counted < (size_t)s->repetitions_min || s->relative_width <= 0)
        return false;
    summary walls = summarize(at->wall_s, at->counted); /* safe to sort in place */
    double width = summary_relative_width(&walls);
    return isfinite(width) && width < s->relative_width;
}

status study_status(const study *s, const char *results, study_progress *out, diagnostic *why)
{
    progress_index *l;
    TRY(progress_index_read(s, results, &l, why));
    *out = (study_progress){.cells = l->cell_count, .rows = l->rows, .rows_marked = l->marked};
    for (size_t cell = 0; cell < l->cell_count; cell++) {
        out->cells_done += progress_index_cell_done(l, cell);
        out->warmups += l->cells[cell].rows - l->cells[cell].counted;
    }
    progress_index_destroy(l);
    return STATUS_OK;
}
