/* Indexes the measured repetitions of a study by cell, and displays its progress. */
#include "study/run/progress.h"
#include "base/array.h"
#include "base/hash.h"
#include "base/installed.h"
#include "base/isa.h"
#include "measure/clock.h"
#include "measure/statistics.h"
#include "study/rows/row_files.h"
#include "study/rows/row_quantity.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t hash_text(const char *text)
{
    return hash_finish(hash_bytes(HASH_START, text, strlen(text) + 1));
}

uint64_t progress_index_build(void)
{
    return hash_text(build_id());
}

static const uint64_t *find_film(const progress_index_cell *film, uint64_t build)
{
    for (size_t i = 0; i < film->film_count; i++)
        if (film->film[i].build == build)
            return &film->film[i].film_hash;
    return NULL;
}

uint64_t progress_index_film(const progress_index *index, size_t cell, uint64_t build, uint64_t film_hash)
{
    const uint64_t *known = find_film(&index->cells[study_cell_film(index->s, cell)], build);
    return known ? *known : film_hash;
}

static status expect_film(progress_index *index, const progress_index_entry *entry, diagnostic *why)
{
    progress_index_cell *film = &index->cells[study_cell_film(index->s, entry->cell)];
    if (find_film(film, entry->build))
        return STATUS_OK;
    if (!room_for_one(&film->film, film->film_count, sizeof *film->film))
        return out_of_memory(why);
    film->film[film->film_count++] = (progress_index_expected){entry->build, entry->film_hash};
    return STATUS_OK;
}

status progress_index_add(progress_index *index, const progress_index_entry *entry, diagnostic *why)
{
    progress_index_cell *cell = &index->cells[entry->cell];
    const bool same_environment = !index->environment[0] || strcmp(index->environment, entry->environment) == 0;
    const bool counts = same_environment && !entry->of_other_shard;
    if (counts && !entry->warmup) {
        if (!room_for_one(&cell->wall_s, cell->counted, sizeof *cell->wall_s))
            return out_of_memory(why);
        cell->wall_s[cell->counted++] = entry->wall_s;
        cell->disturbed += entry->disturbed == NOISE_DISTURBED;
        cell->undisturbed += entry->disturbed == NOISE_UNDISTURBED;
        index->disturbed += entry->disturbed == NOISE_DISTURBED;
    }
    TRY(expect_film(index, entry, why));
    cell->rows++;
    if (entry->repetition >= cell->next_repetition)
        cell->next_repetition = entry->repetition + 1;
    const bool marked = entry->film_hash != progress_index_film(index, entry->cell, entry->build, entry->film_hash);
    cell->marked += marked;
    index->marked += marked;
    index->warmups += counts && entry->warmup;
    index->elsewhere += !same_environment;
    if (!same_environment)
        snprintf(index->last_environment, sizeof index->last_environment, "%s", entry->environment);
    index->rows++;
    return STATUS_OK;
}

/* The columns that the index reads, of one table. */
typedef struct index_columns {
    const csv *table;
    int film_hash, wall_s;
} index_columns;

/* Whether only rows of one shard count and this row is of another: a merged rows.csv has rows of all shards. */
static bool is_of_other_shard(const progress_index *index, const row_files *files, const row_ref *ref)
{
    if (index->shards <= 1)
        return false;
    const json_t *facts = ref->run >= 0 ? files->runs->entry[ref->run].facts : NULL;
    return json_integer_value(json_object_get(facts, "shard")) != index->shard ||
           json_integer_value(json_object_get(facts, "shards")) != index->shards;
}

static status add_rows(progress_index *index, const row_files *files, diagnostic *why)
{
    index_columns at = {.table = NULL};
    row_noise_columns noise = {.table = NULL};
    long last_run = -2;
    uint64_t build = 0;
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        if (ref->table != at.table)
            at = (index_columns){ref->table, csv_column(ref->table, "film_hash"), csv_column(ref->table, "wall_s")};
        if (ref->run < 0)
            build = hash_text(ref->environment);
        else if (ref->run != last_run)
            build = hash_text(files->runs->entry[ref->run].environment.fact[ENVIRONMENT_FACTS - 1]);
        last_run = ref->run;
        TRY(progress_index_add(
            index,
            &(progress_index_entry){.cell = ref->cell,
                                    .repetition = ref->repetition,
                                    .warmup = ref->warmup,
                                    .disturbed = row_noise_judge(&index->s->disturbed, &noise, ref),
                                    .film_hash = strtoull(csv_field(ref->table, ref->row, at.film_hash), NULL, 16),
                                    .build = build,
                                    .wall_s = csv_field_real(ref->table, ref->row, at.wall_s),
                                    .environment = ref->environment,
                                    .of_other_shard = is_of_other_shard(index, files, ref)},
            why));
    }
    return STATUS_OK;
}

status progress_index_read(const study *s, const char *results, const progress_index_filter *filter,
                           progress_index **out, diagnostic *why)
{
    *out = NULL;
    row_files *files;
    TRY(row_files_read(s, results, ROWS, &files, why));
    progress_index *index = calloc(1, sizeof *index);
    if (index) {
        index->s = s;
        index->cells = calloc(index->cell_count = study_cell_count(s), sizeof *index->cells);
        index->other_cells = files->other_cells;
        index->fault_count = files->fault_count;
        row_files_judge(files, &index->fault);
        snprintf(index->environment, sizeof index->environment, "%s", filter->environment);
        index->shard = filter->shard;
        index->shards = filter->shards;
    }
    const status code = index && index->cells ? add_rows(index, files, why) : out_of_memory(why);
    row_files_destroy(files);
    if (code != STATUS_OK) {
        progress_index_destroy(index);
        return code;
    }
    *out = index;
    return STATUS_OK;
}

void progress_index_destroy(progress_index *index)
{
    if (!index)
        return;
    for (size_t i = 0; index->cells && i < index->cell_count; i++) {
        free(index->cells[i].wall_s);
        free(index->cells[i].film);
    }
    free(index->cells);
    free(index);
}

/* How many of the repetitions the shard measures: those with the numbers shard, shard + shards, ... */
static long part_of(const progress_index *index, long repetitions)
{
    return index->shards > 1 ? (repetitions - index->shard + index->shards - 1) / index->shards : repetitions;
}

long progress_index_least(const progress_index *index)
{
    return part_of(index, index->s->repetitions_min);
}

long progress_index_most(const progress_index *index)
{
    return part_of(index, index->s->repetitions_max);
}

bool progress_index_cell_done(const progress_index *index, size_t cell)
{
    const study *s = index->s;
    const progress_index_cell *at = &index->cells[cell];
    if (at->counted >= (size_t)progress_index_most(index))
        return true;
    if (s->undisturbed > 0)
        return at->undisturbed >= (size_t)progress_index_least(index);
    if (at->counted < (size_t)progress_index_least(index) || s->relative_width <= 0)
        return false;
    summary walls = summarize(at->wall_s, at->counted); /* sorts wall_s in place: its order does not matter */
    double width = summary_relative_width(&walls);
    return isfinite(width) && width < s->relative_width;
}

status study_status(const study *s, const char *results, study_progress *out, diagnostic *why)
{
    progress_index *index;
    run_environment present;
    isa level;
    TRY(isa_choose(&level, why));
    TRY(environment_read("", level, &present, why));
    TRY(progress_index_read(s, results, &(progress_index_filter){.environment = present.key}, &index, why));
    *out = (study_progress){.cells = index->cell_count,
                            .rows = index->rows - index->elsewhere,
                            .warmups = index->warmups,
                            .rows_marked = index->marked,
                            .rows_disturbed = index->disturbed,
                            .rows_elsewhere = index->elsewhere,
                            .rows_other_cells = index->other_cells,
                            .faults = index->fault_count,
                            .fault = index->fault};
    snprintf(out->environment, sizeof out->environment, "%s", present.key);
    for (size_t cell = 0; cell < index->cell_count; cell++)
        out->cells_done += progress_index_cell_done(index, cell);
    progress_index_destroy(index);
    return STATUS_OK;
}

/* --- display --- */

static const double refresh_s = 0.1;

struct progress_display {
    const study *s;
    const study_options *options;
    study_frame_progress now; /* left_s: at the last call of progress_count */
    bool shown;
    double shown_s; /* 0: show the next update immediately */
};

progress_display *progress_begin(const study *s, const study_options *options)
{
    progress_display *line = calloc(1, sizeof *line);
    if (line)
        *line = (progress_display){.s = s, .options = options, .now.left_s = NAN};
    return line;
}

static bool is_watched(const progress_display *line)
{
    return line->options->progress || line->options->progressed;
}

static double sum(const double *values, size_t count)
{
    double total = 0;
    for (size_t i = 0; i < count; i++)
        total += values[i];
    return total;
}

static void count_frames(progress_display *line, const progress_index *done, const size_t *cells, size_t cell_count)
{
    study_frame_progress *now = &line->now;
    double known_s = 0;
    now->frames_done = now->frames_all = 0;
    for (size_t i = 0; i < cell_count; i++) {
        const progress_index_cell *cell = &done->cells[cells[i]];
        known_s += sum(cell->wall_s, cell->counted);
        now->frames_done += cell->counted;
    }
    const double mean_s = now->frames_done ? known_s / (double)now->frames_done : NAN;
    now->left_s = 0;
    for (size_t i = 0; i < cell_count; i++) {
        const progress_index_cell *cell = &done->cells[cells[i]];
        size_t lacking =
            progress_index_cell_done(done, cells[i]) ? 0 : (size_t)progress_index_most(done) - cell->counted;
        now->left_s +=
            (double)lacking * (cell->counted ? sum(cell->wall_s, cell->counted) / (double)cell->counted : mean_s);
        now->frames_all += cell->counted + lacking;
    }
}

/* On a narrow terminal the name of the study is cut first, then the end of the line. */
static void write_line(const progress_display *line, const char *more)
{
    const study_frame_progress *now = &line->now;
    char text[160];
    int length = 0;
    if (now->images) {
        length = snprintf(text, sizeof text, ": images: %zu of %zu%s", now->img, now->images, more);
    } else {
        const double fraction = now->stage == STUDY_MEASURING ? now->share : 0;
        const double done = now->frames_all ? ((double)now->frames_done + fraction) / (double)now->frames_all : 1;
        length = snprintf(text, sizeof text, ": %zu of %zu frames, %d%%", now->frames_done, now->frames_all,
                          (int)(100 * done));
        if (!isnan(now->left_s))
            length +=
                snprintf(text + length, sizeof text - (size_t)length, ", about %ld s left", (long)(now->left_s + 0.5));
        length += snprintf(text + length, sizeof text - (size_t)length, "%s", more);
    }
    const int columns = line->options->progress_columns, room = columns ? columns - 1 : 10000;
    const int name = length < room ? room - length : 0;
    fprintf(line->options->progress, "\r%.*s%.*s", name, line->s->name, room, text);
}

static void show(progress_display *line, study_phase stage, double fraction_done, const char *more)
{
    const double now_s = clock_wall_s();
    if (!is_watched(line) || (line->shown_s > 0 && now_s - line->shown_s < refresh_s))
        return;
    line->shown = true;
    line->shown_s = now_s;
    line->now.stage = stage;
    line->now.share = fraction_done;
    if (line->options->progress) {
        write_line(line, more);
        fputs("\033[K", line->options->progress);
        fflush(line->options->progress);
    }
    if (line->options->progressed)
        line->options->progressed(line->options->context, &line->now);
}

void progress_count(progress_display *line, size_t cell, const progress_index *done, const size_t *cells,
                    size_t cell_count)
{
    line->now.cell = cell;
    if (!is_watched(line))
        return;
    count_frames(line, done, cells, cell_count);
    progress_show(line, 0); /* frames shorter than a tenth of a second do not report their progress */
}

void progress_measured(progress_display *line, const progress_index *done, const size_t *cells, size_t cell_count)
{
    if (!is_watched(line))
        return;
    count_frames(line, done, cells, cell_count);
    line->shown_s = 0;
    progress_show(line, 0);
}

void progress_images(progress_display *line, size_t cell, size_t img, size_t images)
{
    line->now.cell = cell;
    line->now.img = img;
    line->now.images = images;
    if (img == 1)
        line->shown_s = 0; /* show it immediately: the estimate has ended, kept files are not part of it */
    progress_show(line, 0);
}

void progress_show(progress_display *line, double fraction_done)
{
    show(line, line->now.images ? STUDY_IMAGES : STUDY_MEASURING, fraction_done, "");
}

void progress_moving(progress_display *line, double fraction_done)
{
    char text[32];
    snprintf(text, sizeof text, ", moving: %d%%", (int)(100 * fraction_done));
    show(line, STUDY_MOVING, fraction_done, text);
}

void progress_erase_line(const progress_display *line)
{
    if (line && line->options->progress && line->shown) {
        fputs("\r\033[K", line->options->progress);
        fflush(line->options->progress);
    }
}

void progress_end(progress_display *line)
{
    progress_erase_line(line);
    free(line);
}
