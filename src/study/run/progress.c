/* The measured repetitions by cell, and their display. */
#include "base/build_id.h"
#include "base/array.h"
#include "base/hash.h"
#include "base/isa.h"
#include "measure/clock.h"
#include "measure/statistics.h"
#include "study/rows/row_files.h"
#include "study/rows/row_quantity.h"
#include "study/run/progress.h"
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

uint64_t progress_index_film(const progress_index *l, size_t cell, uint64_t build, uint64_t film_hash)
{
    const uint64_t *known = find_film(&l->cells[study_cell_film(l->s, cell)], build);
    return known ? *known : film_hash;
}

static status expect_film(progress_index *l, const progress_index_entry *entry, diagnostic *why)
{
    progress_index_cell *film = &l->cells[study_cell_film(l->s, entry->cell)];
    if (find_film(film, entry->build))
        return STATUS_OK;
    if (!room_for_one(&film->film, film->film_count, sizeof *film->film))
        return out_of_memory(why);
    film->film[film->film_count++] = (progress_index_expected){entry->build, entry->film_hash};
    return STATUS_OK;
}

status progress_index_add(progress_index *l, const progress_index_entry *entry, diagnostic *why)
{
    progress_index_cell *cell = &l->cells[entry->cell];
    const bool here = !l->environment[0] || strcmp(l->environment, entry->environment) == 0;
    const bool counts = here && !entry->of_other_shard;
    if (counts && !entry->warmup) {
        if (!room_for_one(&cell->wall_s, cell->counted, sizeof *cell->wall_s))
            return out_of_memory(why);
        cell->wall_s[cell->counted++] = entry->wall_s;
        cell->disturbed += entry->disturbed == NOISE_DISTURBED;
        cell->undisturbed += entry->disturbed == NOISE_UNDISTURBED;
        l->disturbed += entry->disturbed == NOISE_DISTURBED;
    }
    TRY(expect_film(l, entry, why));
    cell->rows++;
    if (entry->repetition >= cell->next_repetition)
        cell->next_repetition = entry->repetition + 1;
    const bool marked = entry->film_hash != progress_index_film(l, entry->cell, entry->build, entry->film_hash);
    cell->marked += marked;
    l->marked += marked;
    l->warmups += counts && entry->warmup;
    l->elsewhere += !here;
    if (!here)
        snprintf(l->last_environment, sizeof l->last_environment, "%s", entry->environment);
    l->rows++;
    return STATUS_OK;
}

/* The columns that the index reads, of one table. */
typedef struct index_columns {
    const csv *table;
    int film_hash, wall_s;
} index_columns;

/* Whether only the rows of one shard count, and this one is of another: after a merge rows.csv has those of all. */
static bool is_of_other_shard(const progress_index *l, const row_files *files, const row_ref *ref)
{
    if (l->shards <= 1)
        return false;
    const json_t *facts = ref->run >= 0 ? files->runs->entry[ref->run].facts : NULL;
    return json_integer_value(json_object_get(facts, "shard")) != l->shard ||
           json_integer_value(json_object_get(facts, "shards")) != l->shards;
}

static status add_rows(progress_index *l, const row_files *files, diagnostic *why)
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
            build = hash_text(files->runs->entry[ref->run].here.fact[ENVIRONMENT_FACTS - 1]);
        last_run = ref->run;
        TRY(progress_index_add(
            l,
            &(progress_index_entry){.cell = ref->cell,
                                    .repetition = ref->repetition,
                                    .warmup = ref->warmup,
                                    .disturbed = row_noise_judge(&l->s->disturbed, &noise, ref),
                                    .film_hash = strtoull(csv_field(ref->table, ref->row, at.film_hash), NULL, 16),
                                    .build = build,
                                    .wall_s = csv_field_real(ref->table, ref->row, at.wall_s),
                                    .environment = ref->environment,
                                    .of_other_shard = is_of_other_shard(l, files, ref)},
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
    progress_index *l = calloc(1, sizeof *l);
    if (l) {
        l->s = s;
        l->cells = calloc(l->cell_count = study_cell_count(s), sizeof *l->cells);
        l->other_cells = files->other_cells;
        l->fault_count = files->fault_count;
        row_files_judge(files, &l->fault);
        snprintf(l->environment, sizeof l->environment, "%s", filter->environment);
        l->shard = filter->shard;
        l->shards = filter->shards;
    }
    const status code = l && l->cells ? add_rows(l, files, why) : out_of_memory(why);
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
    for (size_t i = 0; l->cells && i < l->cell_count; i++) {
        free(l->cells[i].wall_s);
        free(l->cells[i].film);
    }
    free(l->cells);
    free(l);
}

/* The part of the shard: repetitions shard, shard + shards, ... */
static long part_of(const progress_index *l, long repetitions)
{
    return l->shards > 1 ? (repetitions - l->shard + l->shards - 1) / l->shards : repetitions;
}

long progress_index_least(const progress_index *l)
{
    return part_of(l, l->s->repetitions_min);
}

long progress_index_most(const progress_index *l)
{
    return part_of(l, l->s->repetitions_max);
}

bool progress_index_cell_done(const progress_index *l, size_t cell)
{
    const study *s = l->s;
    const progress_index_cell *at = &l->cells[cell];
    if (at->counted >= (size_t)progress_index_most(l))
        return true;
    if (s->undisturbed > 0)
        return at->undisturbed >= (size_t)progress_index_least(l);
    if (at->counted < (size_t)progress_index_least(l) || s->relative_width <= 0)
        return false;
    summary walls = summarize(at->wall_s, at->counted); /* safe to sort in place */
    double width = summary_relative_width(&walls);
    return isfinite(width) && width < s->relative_width;
}

status study_status(const study *s, const char *results, study_progress *out, diagnostic *why)
{
    progress_index *l;
    run_environment here;
    isa level;
    TRY(isa_choose(&level, why));
    TRY(environment_read("", level, &here, why));
    TRY(progress_index_read(s, results, &(progress_index_filter){.environment = here.key}, &l, why));
    *out = (study_progress){.cells = l->cell_count,
                            .rows = l->rows - l->elsewhere,
                            .warmups = l->warmups,
                            .rows_marked = l->marked,
                            .rows_disturbed = l->disturbed,
                            .rows_elsewhere = l->elsewhere,
                            .rows_other_cells = l->other_cells,
                            .faults = l->fault_count,
                            .fault = l->fault};
    snprintf(out->environment, sizeof out->environment, "%s", here.key);
    for (size_t cell = 0; cell < l->cell_count; cell++)
        out->cells_done += progress_index_cell_done(l, cell);
    progress_index_destroy(l);
    return STATUS_OK;
}

/* --- display --- */

static const double refresh_s = 0.1;

struct progress_line {
    const study *s;
    const study_options *options;
    study_moment now; /* left_s: at the last call of progress_count */
    bool shown;
    double shown_s; /* 0: show the next update immediately */
};

progress_line *progress_begin(const study *s, const study_options *options)
{
    progress_line *line = calloc(1, sizeof *line);
    if (line)
        *line = (progress_line){.s = s, .options = options, .now.left_s = NAN};
    return line;
}

static bool is_watched(const progress_line *line)
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

static void count_frames(progress_line *line, const progress_index *done, const size_t *cells, size_t cell_count)
{
    study_moment *now = &line->now;
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
static void write_line(const progress_line *line, const char *more)
{
    const study_moment *now = &line->now;
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

static void show(progress_line *line, study_phase stage, double share_done, const char *more)
{
    const double now_s = clock_wall_s();
    if (!is_watched(line) || (line->shown_s > 0 && now_s - line->shown_s < refresh_s))
        return;
    line->shown = true;
    line->shown_s = now_s;
    line->now.stage = stage;
    line->now.share = share_done;
    if (line->options->progress) {
        write_line(line, more);
        fputs("\033[K", line->options->progress);
        fflush(line->options->progress);
    }
    if (line->options->progressed)
        line->options->progressed(line->options->context, &line->now);
}

void progress_count(progress_line *line, size_t cell, const progress_index *done, const size_t *cells,
                    size_t cell_count)
{
    line->now.cell = cell;
    if (!is_watched(line))
        return;
    count_frames(line, done, cells, cell_count);
    progress_show(line, 0); /* frames shorter than a tenth of a second do not report their progress */
}

void progress_measured(progress_line *line, const progress_index *done, const size_t *cells, size_t cell_count)
{
    if (!is_watched(line))
        return;
    count_frames(line, done, cells, cell_count);
    line->shown_s = 0;
    progress_show(line, 0);
}

void progress_images(progress_line *line, size_t cell, size_t img, size_t images)
{
    line->now.cell = cell;
    line->now.img = img;
    line->now.images = images;
    if (img == 1)
        line->shown_s = 0; /* kept files are not part of the estimate */
    progress_show(line, 0);
}

void progress_show(progress_line *line, double share_done)
{
    show(line, line->now.images ? STUDY_IMAGES : STUDY_MEASURING, share_done, "");
}

void progress_moving(progress_line *line, double share_done)
{
    char text[32];
    snprintf(text, sizeof text, ", moving: %d%%", (int)(100 * share_done));
    show(line, STUDY_MOVING, share_done, text);
}

void progress_erase_line(const progress_line *line)
{
    if (line && line->options->progress && line->shown) {
        fputs("\r\033[K", line->options->progress);
        fflush(line->options->progress);
    }
}

void progress_end(progress_line *line)
{
    progress_erase_line(line);
    free(line);
}
