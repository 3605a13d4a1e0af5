/* The parts of `cuvette animate`: the request, the names of the frames, the definition of an animation, its progress
 * index, and its table of rows. Frames are written atomically, one file each. An interrupted animation can be resumed:
 * existing frames are not rendered again, but the motion is simulated again from the start, so that the frames are
 * bit-identical with those of an uninterrupted run. A video file always starts again. Ownership: arguments of the
 * command line are borrowed; *_create and *_parse allocate, *_release frees. Diagnostics name the option or the
 * file. */
#pragma once

#include "cli/scene_input.h"
#include "job/account.h"
#include "scene/motion/motion.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct animate_request {
    scene_input input;
    const char *output;        /* a pattern of frame names, "-", or a name that ends in .y4m */
    const char *script, *rows; /* NULL: not given */
    char *script_path;         /* script as an absolute path; owned */
    frame_times times;
    bool restart, json;
} animate_request;

status animate_request_parse(int argc, char **argv, animate_request *out, diagnostic *why);
void animate_request_release(animate_request *request);

bool animate_is_stream(const animate_request *request);
/* STATUS_BAD_INPUT if there are too many frames, or the last one is too late. */
status animate_check_length(const animate_request *request, diagnostic *why);

/* The names of an animation's frames: a pattern with exactly one integer conversion of printf, %d or %05d. */
typedef struct animate_names {
    const char *pattern;  /* borrowed */
    char *folder;         /* "." for a bare name */
    char *before, *after; /* the file name before and after the number */
    int digits;           /* minimum number of digits */
} animate_names;

status animate_names_parse(const char *pattern, animate_names *out, diagnostic *why);
void animate_names_release(animate_names *names);
/* The path of a frame, allocated; NULL when out of memory. */
char *animate_name(const animate_names *names, int64_t frame);

/* The definition of an animation: everything that changes its frames. parameters holds all parameters except those
 * without effect on the frames (param.performance_only, beams that do not light the scene), file names, and time_s of
 * slimes, plus frame rate and start; hash also covers the contents of the files. The duration is not part of the
 * definition. */
typedef struct animate_definition {
    json_t *parameters; /* text by path */
    uint64_t hash;
} animate_definition;

/* Requires that the scene's files have been loaded. */
status animate_define(const animate_request *request, const scene *s, animate_definition *out, diagnostic *why);
void animate_definition_release(animate_definition *d);

/* Checks the progress index, PATTERN.json, which records the definition of the frames next to it and their number.
 * STATUS_BAD_INPUT if the existing frames belong to another or an unknown animation; with restart, only if no index
 * lists them. count: number of frames of this animation. */
status animate_index_check(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why);
/* Creates the folder and the index if they are missing, and raises the number of frames in the index for a longer
 * animation. restart: removes the existing frames first. */
status animate_index_begin(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why);
/* The number of frames that a progress index records; -1 for a file that is not a progress index. */
int64_t animate_index_count(const char *path);

/* STATUS_BAD_INPUT if a file that the scene reads has the name of a frame or of the index. */
status animate_names_check(const animate_names *names, const scene *s, diagnostic *why);

/* STATUS_FAILURE if the missing frames cannot fit on the file system; prints a note if they may not fit. */
status animate_check_room(const animate_request *request, const animate_names *names, const scene *s, diagnostic *why);

/* The CSV table of an animation: one row per rendered frame, appended and flushed once the image is written.
 * results/README.md documents the columns. A file holds the rows of one animation. animate_rows_open allocates,
 * animate_rows_close frees. */
typedef struct animate_rows animate_rows;

/* Opens or creates the file. restart: all frames are rendered again, so the file must not have rows yet.
 * STATUS_BAD_INPUT for rows of another animation or with other columns, and while another process writes the file. */
status animate_rows_open(const char *path, uint64_t definition, bool restart, animate_rows **out, diagnostic *why);
void animate_rows_close(animate_rows *rows); /* NULL is allowed */

/* Returns whether the file had a row of that frame when it was opened. */
bool animate_rows_have(const animate_rows *rows, int64_t frame);

/* One frame. Everything is borrowed. */
typedef struct animate_row {
    uint64_t definition;
    int64_t frame;
    double time_s;
    const job_account *account;
    scene_motion_report motion; /* motion since the previous frame, or since the start */
    const softbody *body;
} animate_row;

/* Does nothing if the file has the same row already. STATUS_BAD_INPUT if the file's row of this frame has another film
 * hash. */
status animate_rows_add(animate_rows *rows, const animate_row *row, diagnostic *why);
