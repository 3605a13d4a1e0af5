/* How far a study is and about how long it takes: as a line on a terminal, and for whoever asked to be told
 * (study_options). With neither every call does nothing. progress_begin gives (NULL when memory is out), progress_end
 * releases; study and options are borrowed in between. */
#pragma once

#include "study/progress_index.h"

typedef struct progress_line progress_line;

progress_line *progress_begin(const study *s, const study_options *options);
/* Before a cell is measured. Reckons what is left: the repetitions that cells lack at most, at the mean time of theirs
 * so far. */
void progress_count(progress_line *line, size_t cell, const progress_index *done, const size_t *cells,
                    size_t cell_count);
/* All of them are measured; told at once. */
void progress_measured(progress_line *line, const progress_index *done, const size_t *cells, size_t cell_count);
/* From now on the kept pictures are made, this one (from 1) of how many. */
void progress_images(progress_line *line, size_t cell, size_t img, size_t images);
/* Shows it; share_done is that of the frame. */
void progress_show(progress_line *line, double share_done);
/* The same while slimes move before a frame; share_done is that of their motion. */
void progress_moving(progress_line *line, double share_done);
void progress_end(progress_line *line);
