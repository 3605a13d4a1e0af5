#include "study/films.h"
#include "study/row_files.h"
#include <stdlib.h>
#include <string.h>

static const char *const compared[] = {"film_hash",    "rays_total",  "rays_camera",  "rays_reflect",
                                       "rays_refract", "rays_shadow", "rays_by_depth"};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Rows of other versions may lack some columns. */
static bool has_same(const row_ref *a, const row_ref *b)
{
    for (size_t i = 0; i < COUNT(compared); i++) {
        const char *x = row_field(a, compared[i]), *y = row_field(b, compared[i]);
        if (strcmp(x, y) != 0 && strcmp(x, "NA") != 0 && strcmp(y, "NA") != 0)
            return false;
    }
    return true;
}

/* The first row of each cell, and whether the others agree with it. */
typedef struct cell_films {
    const row_ref **first;
    bool *agrees;
} cell_films;

static status find_films(const study *s, const row_files *files, cell_films *out, diagnostic *why)
{
    const size_t count = study_cell_count(s);
    *out = (cell_films){calloc(count, sizeof *out->first), calloc(count, sizeof *out->agrees)};
    if (!out->first || !out->agrees)
        return out_of_memory(why);
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *row = &files->rows[i];
        const row_ref **first = &out->first[row->cell];
        out->agrees[row->cell] = *first ? out->agrees[row->cell] && has_same(*first, row) : true;
        *first = *first ? *first : row;
    }
    return STATUS_OK;
}

static void free_films(cell_films *of)
{
    free(of->first);
    free(of->agrees);
}

static int compare_texts(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static status compare_cells(const study *s, const cell_films *here, const cell_films *there, study_films *out,
                            diagnostic *why)
{
    const size_t count = study_cell_count(s);
    const char **film = malloc(count * sizeof *film);
    out->different = malloc(count * sizeof *out->different);
    if (!film || !out->different) {
        free(film);
        return out_of_memory(why);
    }
    for (size_t cell = 0; cell < count; cell++) {
        if (!here->first[cell] || !there->first[cell])
            continue;
        film[out->compared++] = row_field(here->first[cell], "film_hash");
        if (here->agrees[cell] && there->agrees[cell] && has_same(here->first[cell], there->first[cell]))
            out->same++;
        else
            out->different[out->different_count++] = cell;
    }
    qsort(film, out->compared, sizeof *film, compare_texts);
    for (size_t i = 0; i < out->compared; i++)
        out->distinct += i == 0 || strcmp(film[i - 1], film[i]) != 0;
    free(film);
    return STATUS_OK;
}

static const char *processor_of(const row_files *files)
{
    return files->runs->count > 0 ? files->runs->entry[0].here.fact[ENVIRONMENT_CPU_MODEL] : "unknown";
}

status study_films_compare(const study *s, const char *results, const char *against, study_films *out, diagnostic *why)
{
    row_files *ours = NULL, *theirs = NULL;
    cell_films here = {NULL, NULL}, there = {NULL, NULL};
    *out = (study_films){.compared = 0};
    status code = row_files_read(s, results, ROWS, &ours, why);
    THEN(code, row_files_read(s, against, ROWS, &theirs, why));
    THEN(code, find_films(s, ours, &here, why));
    THEN(code, find_films(s, theirs, &there, why));
    THEN(code, compare_cells(s, &here, &there, out, why));
    if (code == STATUS_OK) {
        snprintf(out->processor, sizeof out->processor, "%s", processor_of(theirs));
        out->other_processor = strcmp(processor_of(ours), out->processor) != 0;
    }
    free_films(&here);
    free_films(&there);
    row_files_destroy(ours);
    row_files_destroy(theirs);
    return code;
}

void study_films_release(study_films *films)
{
    free(films->different);
    *films = (study_films){.compared = 0};
}
