/* Reads all row files of a study: turns lines into row_refs, verifies them and the chain of their checksums, and then
 * compares rows with each other (study/rows/row_check.c). */
#include "base/number.h"
#include "scene/model/open.h"
#include "study/plan/identity.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Maps identities of a study's cells to their numbers. If the grid is not known (study.identity is NULL), every
 * identity is a cell, and is the cell's number. */
typedef struct row_cell {
    uint64_t identity;
    size_t cell;
} row_cell;
typedef struct row_cells {
    bool any;
    row_cell *sorted;
    size_t count;
} row_cells;

/* What is known of the rows of a run while files are read. */
typedef struct row_chain {
    size_t rows, most;              /* in the current file; in any file */
    char last[RUN_ID], end[RUN_ID]; /* the last checksum in the current file; in the file with the most rows */
} row_chain;

typedef struct row_reader {
    const study *s;
    row_kind kind;
    row_files *files;
    row_cells cells;
    row_chain *chain; /* of each run */
} row_reader;

/* --- cells --- */

static int compare_cells(const void *a, const void *b)
{
    const row_cell *x = a, *y = b;
    return (x->identity > y->identity) - (x->identity < y->identity);
}

static status cells_create(const study *s, row_kind kind, row_cells *out, diagnostic *why)
{
    *out = (row_cells){.any = !s->identity, .count = s->identity ? study_cell_count(s) : 0};
    out->sorted = malloc((out->count + 1) * sizeof *out->sorted);
    if (!out->sorted)
        return out_of_memory(why);
    for (size_t i = 0; i < out->count; i++)
        out->sorted[i] = (row_cell){kind == COMPARE_ROWS ? identity_compared(s, s->identity[i]) : s->identity[i], i};
    qsort(out->sorted, out->count, sizeof *out->sorted, compare_cells);
    return STATUS_OK;
}

static void cells_free(row_cells *c)
{
    free(c->sorted);
    *c = (row_cells){0};
}

static bool find_cell(const row_cells *c, uint64_t identity, size_t *cell)
{
    if (c->any)
        *cell = (size_t)identity;
    if (c->any)
        return true;
    const row_cell wanted = {identity, 0};
    const row_cell *found = bsearch(&wanted, c->sorted, c->count, sizeof wanted, compare_cells);
    if (found)
        *cell = found->cell;
    return found != NULL;
}

/* --- rows of one table --- */

/* The columns that every reader needs, by index; -1: the table lacks it. */
typedef struct columns {
    int study, identity, run, checksum, cell, repetition, warmup, worker;
} columns;

typedef struct table_state {
    row_reader *r;
    const csv *table;
    const char *path;
    columns at;
    checksum_columns hashes;
    long last_run; /* of the previous row */
    bool gap;      /* the previous row is broken: its place in the chain is unknown */
    diagnostic *why;
} table_state;

static columns find_columns(const csv *t)
{
    return (columns){csv_column(t, "study"),    csv_column(t, "identity"), csv_column(t, "run"),
                     csv_column(t, "checksum"), csv_column(t, "cell"),     csv_column(t, "repetition"),
                     csv_column(t, "warmup"),   csv_column(t, "worker")};
}

static bool read_integer(const csv *t, size_t row, int column, int64_t highest, int64_t *out)
{
    return number_parse_int(csv_field(t, row, column), out) && *out >= 0 && *out <= highest;
}

/* The numbers that identify a row; false if one is damaged. */
static bool read_numbers(const table_state *st, size_t row, row_ref *ref, int64_t *cell)
{
    int64_t repetition = 0, warmup = 0, worker = 0;
    const row_kind kind = st->r->kind;
    if (!read_integer(st->table, row, st->at.cell, STUDY_CELLS_MAX, cell) ||
        (kind != COMPARE_ROWS && (!read_integer(st->table, row, st->at.repetition, INT32_MAX, &repetition) ||
                                  !read_integer(st->table, row, st->at.warmup, 1, &warmup))) ||
        (kind == WORKER_ROWS && !read_integer(st->table, row, st->at.worker, INT32_MAX, &worker)))
        return false;
    ref->repetition = (long)repetition;
    ref->warmup = warmup != 0;
    ref->worker = (long)worker;
    return true;
}

static bool parse_hash(const char *text, uint64_t *out)
{
    const bool is_hash = strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16;
    *out = is_hash ? strtoull(text, NULL, 16) : 0;
    return is_hash;
}

static status noted(const table_state *st, status code)
{
    return code == STATUS_OK ? code : out_of_memory(st->why);
}

static status issue(table_state *st, row_fault fault, size_t row, const char *text)
{
    return noted(st, row_files_add_issue(st->r->files, fault, st->path, (long)row + 2, "%s", text));
}

/* Verifies the place of a row in the chain of its run. */
static status follow_chain(table_state *st, size_t row, const row_ref *ref, uint32_t content, uint32_t chain)
{
    const char *text = csv_field(st->table, row, st->at.checksum);
    row_chain *run = &st->r->chain[ref->run];
    const char *previous = run->rows ? run->last : st->r->files->runs->entry[ref->run].id;
    const bool continues = checksum_chain(previous, content) == chain, in_order = ref->run >= st->last_run;
    snprintf(run->last, sizeof run->last, "%.16s", text);
    run->rows++;
    const bool excused = st->gap;
    st->gap = false;
    st->last_run = ref->run;
    if ((continues || excused) && in_order)
        return STATUS_OK;
    return issue(st, ROW_MISPLACED, row, "rows before this one were removed, inserted or moved");
}

/* Reads and verifies a row; *good: the row can be used. */
static status read_values(table_state *st, size_t row, row_ref *ref, uint64_t *identity, bool *good)
{
    char *const *fields = st->table->fields + row * st->table->column_count;
    uint32_t content = 0, chain = 0;
    int64_t cell;
    *good = false;
    if (!checksum_parse(csv_field(st->table, row, st->at.checksum), &content, &chain))
        return issue(st, ROW_EDITED, row, "the checksum of the row is damaged");
    const bool intact = checksum_content(&st->hashes, fields) == content;
    ref->run = runs_find(st->r->files->runs, csv_field(st->table, row, st->at.run));
    if (ref->run >= 0) {
        if (!intact) /* the next row is chained to the checksum that this row states */
            snprintf(st->r->chain[ref->run].last, RUN_ID, "%.16s", csv_field(st->table, row, st->at.checksum));
        st->r->chain[ref->run].rows += !intact;
    }
    if (!intact)
        return issue(st, ROW_EDITED, row, "the values do not agree with the row's checksum");
    if (!parse_hash(csv_field(st->table, row, st->at.identity), identity) || !read_numbers(st, row, ref, &cell))
        return issue(st, ROW_DAMAGED, row, "the row is damaged");
    *good = true;
    if (ref->run < 0)
        return noted(st, row_files_add_issue(st->r->files, ROW_UNKNOWN, st->path, (long)row + 2,
                                             "run %.16s is not in runs.json", csv_field(st->table, row, st->at.run)));
    memcpy(ref->environment, st->r->files->runs->entry[ref->run].environment.key, ENVIRONMENT_KEY);
    return follow_chain(st, row, ref, content, chain);
}

static status another_study(const table_state *st, size_t row)
{
    diagnostic_locate(st->why, st->path, (long)row + 2, 1);
    return diagnose(st->why, STATUS_BAD_INPUT,
                    st->r->kind == COMPARE_ROWS
                        ? "move this file away: the images will be compared again; nothing is measured again"
                        : "move this folder away, choose another with --results, or give the study another name",
                    "these rows belong to another study");
}

static status read_row(table_state *st, size_t row)
{
    row_reader *r = st->r;
    row_ref ref = {.table = st->table, .row = row, .run = -1, .environment = "unknown"};
    uint64_t identity = 0;
    bool good = false;
    if (st->table->broken[row]) {
        st->gap = true;
        return issue(st, ROW_DAMAGED, row, "the line is not a row of this file");
    }
    TRY(read_values(st, row, &ref, &identity, &good));
    if (good && strcmp(csv_field(st->table, row, st->at.study), r->s->name) != 0)
        return another_study(st, row);
    if (good && !find_cell(&r->cells, identity, &ref.cell))
        r->files->other_cells++;
    else if (good)
        r->files->rows[r->files->row_count++] = ref;
    return STATUS_OK;
}

/* Keeps each run's largest number of rows in a file, and the last checksum there, to compare with its seal. */
static void finish_table(row_reader *r)
{
    for (size_t i = 0; i < r->files->runs->count; i++) {
        row_chain *run = &r->chain[i];
        if (run->rows > run->most) {
            run->most = run->rows;
            memcpy(run->end, run->last, sizeof run->end);
        }
        run->rows = 0;
    }
}

/* Appends the usable rows of a table to r->files, which has room, and issues about the others. */
static status read_table(row_reader *r, const csv *table, const char *path, diagnostic *why)
{
    table_state st = {.r = r, .table = table, .path = path, .at = find_columns(table), .why = why};
    status code = checksum_columns_create(table->header, table->column_count, &st.hashes, why);
    for (size_t row = 0; code == STATUS_OK && row < table->row_count; row++)
        code = read_row(&st, row);
    if (code == STATUS_OK && table->size > table->complete_size &&
        row_files_add_issue(r->files, ROW_TORN, path, (long)table->row_count + 2,
                            "an incomplete line: the process was killed; the next run moves it away") != STATUS_OK)
        code = out_of_memory(why);
    finish_table(r);
    checksum_columns_free(&st.hashes);
    return code;
}

/* Adds issues for rows missing at the end of runs, after all tables were read. */
static status read_seals(row_reader *r, diagnostic *why)
{
    const run_list *runs = r->files->runs;
    const char *stem = row_file_stem(r->kind);
    for (size_t i = 0; i < runs->count; i++) {
        run_seal seal;
        const row_chain *run = &r->chain[i];
        status code = STATUS_OK;
        if (!runs->entry[i].key_is_right)
            code = row_files_add_issue(r->files, ROW_UNKNOWN, "runs.json", 0,
                                       "the environment of run %.16s does not agree with its key", runs->entry[i].id);
        if (code == STATUS_OK && runs_seal(&runs->entry[i], stem, &seal) && seal.rows > 0 &&
            (run->most < seal.rows || strcmp(run->end, seal.checksum) != 0))
            code = row_files_add_issue(r->files, ROW_MISSING, stem, 0, "run %.16s wrote %zu rows, %zu are there%s",
                                       runs->entry[i].id, seal.rows, run->most,
                                       run->most < seal.rows ? "" : ", but the last one is different");
        if (code != STATUS_OK)
            return out_of_memory(why);
    }
    return STATUS_OK;
}

/* --- all tables --- */

static status open_files(row_files *files, const study *s, const char *folder, row_kind kind, diagnostic *why)
{
    status code = row_files_list(folder, kind, &files->paths, &files->count, why);
    files->tables = calloc(files->count + 1, sizeof(csv *));
    if (code == STATUS_OK && !files->tables)
        code = out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++)
        code = csv_read_rows(files->paths[i], scene_root(s->base), &files->tables[i], why);
    return code;
}

static status read_tables(row_reader *r, diagnostic *why)
{
    row_files *files = r->files;
    size_t total = 0;
    for (size_t i = 0; i < files->count; i++)
        total += files->tables[i] ? files->tables[i]->row_count : 0;
    files->rows = malloc((total + 1) * sizeof *files->rows);
    r->chain = calloc(files->runs->count + 1, sizeof *r->chain);
    status code = files->rows && r->chain ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++) {
        if (!files->tables[i] || !files->tables[i]->header)
            continue;
        code = row_check_columns(files->tables[i], files->paths[i], r->kind, why);
        THEN(code, read_table(r, files->tables[i], files->paths[i], why));
    }
    THEN(code, read_seals(r, why));
    free(r->chain);
    return code;
}

static status read_rows(row_files *files, const study *s, const char *folder, row_kind kind, diagnostic *why)
{
    row_reader r = {.s = s, .kind = kind, .files = files};
    status code = runs_read(folder, scene_root(s->base), &files->runs, why);
    THEN(code, cells_create(s, kind, &r.cells, why));
    THEN(code, read_tables(&r, why));
    cells_free(&r.cells);
    return code;
}

static status load(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why)
{
    *out = NULL;
    row_files *files = calloc(1, sizeof *files);
    char *folder = study_folder(s, results);
    status code = files && folder ? open_files(files, s, folder, kind, why) : out_of_memory(why);
    THEN(code, read_rows(files, s, folder, kind, why));
    free(folder);
    if (code != STATUS_OK) {
        row_files_destroy(files);
        return code;
    }
    *out = files;
    return STATUS_OK;
}

status row_files_read(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why)
{
    status code = load(s, results, kind, out, why);
    row_files *rows = NULL;
    if (code == STATUS_OK && kind == WORKER_ROWS && (code = load(s, results, ROWS, &rows, why)) == STATUS_OK)
        code = row_check_drop_orphans(*out, rows, why);
    row_files_destroy(rows);
    THEN(code, row_check_drop_twins(*out, why));
    if (code == STATUS_OK && kind == ROWS)
        code = row_check_quantities(*out, why);
    if (code != STATUS_OK) {
        row_files_destroy(*out);
        *out = NULL;
    }
    return code;
}
