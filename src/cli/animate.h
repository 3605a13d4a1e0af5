/* What the parts of `cuvette animate` share: what is asked for, the names of the frames, what the film is made of, and
 * the film itself. Frames appear whole or not at all, one file each; a film that was stopped goes on: frames that are
 * there are not rendered again, the motion is computed anew up to where they end, and so the frames are, to the bit,
 * those of a run that nobody stopped. A stream (YUV4MPEG2) begins anew. Ownership: words of the command line are
 * borrowed; *_create and *_parse give, *_release takes. Errors are located. */
#pragma once

#include "cli/scene_input.h"
#include "job/account.h"
#include "scene/motion/motion.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* Frame k, from 0, shows start_s + k fps_den / fps_num. */
typedef struct animate_request {
    scene_input input;
    const char *output;         /* a pattern, "-", or a name that ends in .y4m */
    const char *script, *rows;  /* NULL: not said */
    char *script_path;          /* script as an absolute path; owned */
    double start_s, duration_s; /* duration_s < 0: not said */
    bool restart, json;
    int64_t fps_num, fps_den; /* in lowest terms */
} animate_request;

status animate_request_parse(int argc, char **argv, animate_request *out, diagnostic *why);
void animate_request_release(animate_request *request);

bool animate_is_stream(const animate_request *request);
/* How many frames there are: duration_s times frames a second, rounded, at least 1. */
int64_t animate_count(const animate_request *request);
/* STATUS_BAD_INPUT where these are too many, or end too late. */
status animate_check_length(const animate_request *request, diagnostic *why);
double animate_time_s(const animate_request *request, int64_t frame);

/* The names of a film's frames: a pattern with exactly one integer in the form of printf, %d or %05d. */
typedef struct animate_names {
    const char *pattern;  /* borrowed */
    char *folder;         /* "." for none */
    char *before, *after; /* of the name in it, around the number */
    int digits;           /* least number of digits */
} animate_names;

status animate_names_parse(const char *pattern, animate_names *out, diagnostic *why);
void animate_names_release(animate_names *names);
/* The path of a frame; fresh memory, NULL when that is out. */
char *animate_name(const animate_names *names, int64_t frame);
/* Which frame's name that is in its folder, or -1. */
int64_t animate_name_frame(const animate_names *names, const char *name);

/* All that changes the film's frames, by its path: parameters but for those that are how a frame is computed
 * (param.performance_only) and for names of files, frames a second and start; and a fingerprint of these and of what
 * the files hold. Its length does not count. */
typedef struct animate_definition {
    json_t *parameters; /* text by path */
    uint64_t hash;
} animate_definition;

/* The scene's files have been loaded. */
status animate_define(const animate_request *request, const scene *s, animate_definition *out, diagnostic *why);
void animate_definition_release(animate_definition *d);

/* Time of the last key of all scripts of the scene's slimes; *any: there is one. */
status animate_script_end_s(const scene *s, bool *any, double *end_s, diagnostic *why);

/* The ledger beside the frames, PATTERN.json, says of which film they are and how many it has. STATUS_BAD_INPUT where
 * the frames there are of another film or of an unknown one; restart: of a film that the ledger does not know of.
 * count: frames of this one. */
status animate_index_check(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why);
/* Makes folder and ledger where they are not there; a longer film is written into it. restart: removes what frames are
 * there first. */
status animate_index_begin(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why);
/* How many frames a ledger says that its film has; -1 for what is no ledger. */
int64_t animate_index_count(const char *path);

/* STATUS_BAD_INPUT for files named as frames that are none of the film's known ones (known < 0: there is no ledger, and
 * it has none), and where another film's ledger has names of the first frames of this one, as many as are known or
 * wanted. */
status animate_folder_check(const animate_names *names, int64_t known, int64_t wanted, diagnostic *why);
/* Removes all frames. */
status animate_folder_clear(const animate_names *names, diagnostic *why);
/* STATUS_BAD_INPUT where a file that the scene reads has a frame's name, or the ledger's. */
status animate_names_check(const animate_names *names, const scene *s, diagnostic *why);

/* The rows of a film, one a frame that was rendered, appended and flushed when its picture is there. results/README.md
 * is the dictionary of their columns. A file of rows is of one film. animate_rows_open gives, animate_rows_close
 * releases. */
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

/* What came of it. */
typedef struct animate_account {
    int64_t rendered, kept;
    double wall_s;         /* of the renders */
    double step_s, skin_s; /* of all motion, that of kept frames too */
    double simulated_s;
    uint64_t steps;
} animate_account;

/* The film, frame by frame. names is NULL for a stream. STATUS_INTERRUPTED after a signal: the frames that are there
 * are whole. */
status animate_film(const animate_request *request, const animate_names *names, const animate_definition *d, job *with,
                    scene *s, scene_motion *motion, animate_account *account, diagnostic *why);
