/* The progress of a study and the estimated time left: a line on a terminal, and callbacks (study_options). Without
 * both, every call does nothing. progress_begin gives (NULL if memory runs out), progress_end releases; study and
 * options are borrowed until then. */
#pragma once

#include "study/progress_index.h"

typedef struct progress_line progress_line;

progress_line *progress_begin(const study *s, const study_options *options);
/* Call before a cell is measured. Estimates the time left: the sum over the unfinished cells of the missing
 * repetitions, up to repetitions_max, times the mean time of the cell so far (of all cells if it has none). */
void progress_count(progress_line *line, size_t cell, const progress_index *done, const size_t *cells,
                    size_t cell_count);
/* All cells are measured; reported immediately. */
void progress_measured(progress_line *line, const progress_index *done, const size_t *cells, size_t cell_count);
/* From now on the kept files are made: file img (from 1) of images. */
void progress_images(progress_line *line, size_t cell, size_t img, size_t images);
/* Updates the display; share_done is the completed fraction of the frame. */
void progress_show(progress_line *line, double share_done);
/* The same while slimes move before a frame; share_done is the completed fraction of the motion. */
void progress_moving(progress_line *line, double share_done);
/* Erases the line before other text; the next update shows it again. NULL is allowed. */
void progress_erase_line(const progress_line *line);
void progress_end(progress_line *line);
