/* Writes faults of rows and their environments as text, and compares the films of two results folders. */
#include "study/summary/verify.h"
#include "study/rows/row_files.h"
#include <stdlib.h>
#include <string.h>

static const char *const kinds[] = {
    [ROW_TORN] = "torn",           [ROW_MARKED] = "marked",   [ROW_DAMAGED] = "damaged",
    [ROW_EDITED] = "edited",       [ROW_MISPLACED] = "moved", [ROW_MISSING] = "missing",
    [ROW_DUPLICATE] = "duplicate", [ROW_DIFFERS] = "differs", [ROW_UNKNOWN] = "unknown run",
};

static void put_issues(const row_files *files, FILE *out)
{
    for (size_t i = 0; i < files->issue_count; i++) {
        const row_issue *at = &files->issues[i];
        if (at->line)
            fprintf(out, "%s:%ld: %s: %s\n", at->path, at->line, kinds[at->fault], at->text);
        else
            fprintf(out, "%s: %s: %s\n", at->path, kinds[at->fault], at->text);
    }
}

static status put_environments(const row_files *files, FILE *out, diagnostic *why)
{
    row_environment_count *all;
    size_t count;
    TRY(row_environments_find(files, &all, &count, why));
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "environment %s: %zu rows", all[i].key, all[i].rows);
        for (int fact = 0; all[i].run && fact < ENVIRONMENT_FACTS; fact++)
            fprintf(out, "%s %s %s", fact ? "," : ":", environment_names[fact], all[i].run->environment.fact[fact]);
        fputc('\n', out);
    }
    free(all);
    return STATUS_OK;
}

status study_verify(const study *s, const char *results, FILE *out, study_verdict *verdict, diagnostic *why)
{
    *verdict = (study_verdict){0};
    size_t other = 0;
    for (row_kind kind = ROWS; kind <= COMPARE_ROWS; kind++) {
        row_files *files;
        TRY(row_files_read(s, results, kind, &files, why));
        put_issues(files, out);
        status code = kind == ROWS ? put_environments(files, out, why) : STATUS_OK;
        if (!verdict->first.what[0])
            row_files_judge(files, &verdict->first);
        verdict->rows += kind == ROWS ? files->row_count : 0;
        other += kind == ROWS ? files->other_cells : 0;
        verdict->faults += files->fault_count;
        row_files_destroy(files);
        if (code != STATUS_OK)
            return code;
    }
    fprintf(out, "%s: %zu rows, %zu faults", s->name, verdict->rows, verdict->faults);
    if (other)
        fprintf(out, ", %zu rows of cells that the study does not have", other);
    fputc('\n', out);
    return STATUS_OK;
}

void study_environment_difference(const study *s, const char *results, char *text, size_t size)
{
    row_files *files = NULL;
    run_environment present;
    isa level;
    text[0] = 0;
    if (isa_choose(&level, NULL) != STATUS_OK || row_files_read(s, results, ROWS, &files, NULL) != STATUS_OK)
        return;
    if (environment_read("", level, &present, NULL) != STATUS_OK) {
        row_files_destroy(files);
        return;
    }
    for (size_t i = files->row_count; i > 0 && !text[0]; i--)
        if (files->rows[i - 1].run >= 0)
            environment_difference(&present, &files->runs->entry[files->rows[i - 1].run].environment, text, size);
    row_files_destroy(files);
}

/* --- films of two folders --- */

static const char *const compared[] = {"film_hash",    "rays_total",  "rays_camera",  "rays_reflect",
                                       "rays_refract", "rays_shadow", "rays_by_depth"};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Whether films and counts agree; columns that a row of another version lacks are ignored. */
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

static void free_films(cell_films *films)
{
    free(films->first);
    free(films->agrees);
}

static int compare_texts(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static status compare_cells(const study *s, const cell_films *ours, const cell_films *theirs, study_films *out,
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
        if (!ours->first[cell] || !theirs->first[cell])
            continue;
        film[out->compared++] = row_field(ours->first[cell], "film_hash");
        if (ours->agrees[cell] && theirs->agrees[cell] && has_same(ours->first[cell], theirs->first[cell]))
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
    return files->runs->count > 0 ? files->runs->entry[0].environment.fact[ENVIRONMENT_CPU_MODEL] : "unknown";
}

status study_films_compare(const study *s, const char *results, const char *against, study_films *out, diagnostic *why)
{
    row_files *ours = NULL, *theirs = NULL;
    cell_films our_films = {NULL, NULL}, their_films = {NULL, NULL};
    *out = (study_films){.compared = 0};
    status code = row_files_read(s, results, ROWS, &ours, why);
    THEN(code, row_files_read(s, against, ROWS, &theirs, why));
    THEN(code, find_films(s, ours, &our_films, why));
    THEN(code, find_films(s, theirs, &their_films, why));
    THEN(code, compare_cells(s, &our_films, &their_films, out, why));
    if (code == STATUS_OK) {
        snprintf(out->processor, sizeof out->processor, "%s", processor_of(theirs));
        out->other_processor = strcmp(processor_of(ours), out->processor) != 0;
    }
    free_films(&our_films);
    free_films(&their_films);
    row_files_destroy(ours);
    row_files_destroy(theirs);
    return code;
}

void study_films_release(study_films *films)
{
    free(films->different);
    *films = (study_films){.compared = 0};
}
