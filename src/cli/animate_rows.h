/* The rows of a film, one a frame that was rendered, appended and flushed when its picture is there. results/README.md
 * is the dictionary of their columns. A file of rows is of one film. Ownership: animate_rows_open gives,
 * animate_rows_close releases. */
#ifndef CUVETTE_CLI_ANIMATE_ROWS_H
#define CUVETTE_CLI_ANIMATE_ROWS_H

#include "job/account.h"
#include "scene/motion/motion.h"

typedef struct animate_rows animate_rows;

/* Opens or makes the file. anew: the film's frames are all made again, so there may be no row yet. STATUS_BAD_INPUT for
 * rows of another film or of another kind, and where another process writes them. */
status animate_rows_open(const char *path, uint64_t definition, bool anew, animate_rows **out, diagnostic *why);
void animate_rows_close(animate_rows *rows); /* NULL is allowed */

/* Was there a row of that frame when the file was opened? */
bool animate_rows_have(const animate_rows *rows, int64_t frame);

/* One frame. Everything is borrowed. */
typedef struct animate_row {
    uint64_t definition;
    int64_t frame;
    double time_s;
    const job_account *made;
    scene_motion_report moved; /* since the frame before, or the beginning */
    const softbody *body;
} animate_row;

/* Nothing where the same row is there: a frame has one. STATUS_BAD_INPUT where that is of another picture. */
status animate_rows_add(animate_rows *rows, const animate_row *row, diagnostic *why);

#endif
