/* The line that shows on a terminal how far a study is and about how long it takes. Written only to the stream that
 * is given; with NULL every call does nothing. progress_begin gives (NULL when memory is out), progress_end
 * releases. */
#ifndef CUVETTE_STUDY_PROGRESS_H
#define CUVETTE_STUDY_PROGRESS_H

#include "study/ledger.h"

typedef struct progress_line progress_line;

progress_line *progress_begin(FILE *terminal, const study *s);
/* Reckons what is left: the repetitions that cells lack at most, at the mean time of theirs so far. */
void progress_count(progress_line *line, const study *s, const ledger *done, const size_t *cells, size_t cell_count);
/* From now on the kept pictures are made, this one (from 1) of how many. */
void progress_pictures(progress_line *line, size_t picture, size_t pictures);
/* Shows it; share_done is that of the frame. */
void progress_show(progress_line *line, double share_done);
/* The same while slimes move before a frame; share_done is that of their motion. */
void progress_moving(progress_line *line, double share_done);
void progress_end(progress_line *line);

#endif
