#include "study/progress.h"
#include "measure/clock.h"
#include <math.h>
#include <stdlib.h>

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

/* The name of the study gives way if the terminal is narrow, then the end of the line. */
static void write_line(const progress_line *line, const char *more)
{
    const study_moment *now = &line->now;
    char text[160];
    int length = 0;
    if (now->images) {
        length = snprintf(text, sizeof text, ": images: %zu of %zu%s", now->img, now->images, more);
    } else {
        const double share = now->stage == STUDY_MEASURING ? now->share : 0;
        const double done = now->frames_all ? ((double)now->frames_done + share) / (double)now->frames_all : 1;
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
