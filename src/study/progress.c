#include "study/progress.h"
#include "measure/clock.h"
#include <stdlib.h>

static const double refresh_s = 0.1;

struct progress_line {
    FILE *terminal;
    const char *name;
    size_t frames_done, frames_all;
    size_t picture, pictures; /* 0 while rows are measured */
    double left_s; /* of the frames to come, at the time of the last count; < 0 unknown */
    double shown_s;
};

progress_line *progress_begin(FILE *terminal, const study *s)
{
    progress_line *line = calloc(1, sizeof *line);
    if (line)
        *line = (progress_line){.terminal = terminal, .name = s->name, .left_s = -1};
    return line;
}

void progress_count(progress_line *line, const study *s, const ledger *done, const size_t *cells, size_t cell_count)
{
    if (!line->terminal)
        return;
    double known_s = 0, known_frames = 0;
    for (size_t i = 0; i < cell_count; i++) {
        const ledger_cell *cell = &done->cells[cells[i]];
        for (size_t k = 0; k < cell->counted; k++)
            known_s += cell->wall_s[k];
        known_frames += (double)cell->counted;
    }
    line->frames_done = line->frames_all = 0;
    line->left_s = known_frames > 0 ? 0 : -1;
    for (size_t i = 0; i < cell_count; i++) {
        const ledger_cell *cell = &done->cells[cells[i]];
        size_t lacking = ledger_cell_done(done, cells[i]) ? 0 : (size_t)s->repetitions_max - cell->counted;
        double mean_s = known_frames > 0 ? known_s / known_frames : 0;
        if (cell->counted) {
            mean_s = 0;
            for (size_t k = 0; k < cell->counted; k++)
                mean_s += cell->wall_s[k] / (double)cell->counted;
        }
        line->left_s += (double)lacking * mean_s;
        line->frames_done += cell->counted;
        line->frames_all += cell->counted + lacking;
    }
}

void progress_pictures(progress_line *line, size_t picture, size_t pictures)
{
    line->picture = picture;
    line->pictures = pictures;
}

static void write_line(const progress_line *line, double share_done, const char *more)
{
    if (line->pictures) {
        fprintf(line->terminal, "\r%s: pictures: %zu of %zu%s", line->name, line->picture, line->pictures, more);
        return;
    }
    double done = line->frames_all ? ((double)line->frames_done + share_done) / (double)line->frames_all : 1;
    fprintf(line->terminal, "\r%s: %zu of %zu frames, %d%%", line->name, line->frames_done, line->frames_all,
            (int)(100 * done));
    if (line->left_s >= 0)
        fprintf(line->terminal, ", about %ld s left", (long)(line->left_s + 0.5));
    fputs(more, line->terminal);
}

static void show(progress_line *line, double share_done, const char *more)
{
    double now_s = clock_wall_s();
    if (!line->terminal || now_s - line->shown_s < refresh_s)
        return;
    line->shown_s = now_s;
    write_line(line, share_done, more);
    fputs("\033[K", line->terminal);
    fflush(line->terminal);
}

void progress_show(progress_line *line, double share_done)
{
    show(line, share_done, "");
}

void progress_moving(progress_line *line, double share_done)
{
    char text[32];
    snprintf(text, sizeof text, ", moving: %d%%", (int)(100 * share_done));
    show(line, 0, text);
}

void progress_end(progress_line *line)
{
    if (!line)
        return;
    if (line->terminal && line->shown_s > 0) {
        fputs("\r\033[K", line->terminal);
        fflush(line->terminal);
    }
    free(line);
}
