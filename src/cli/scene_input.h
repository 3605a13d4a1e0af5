/* What commands that work on a scene share: SCENE, --set and its short forms, the instruction set. Mistakes are
 * located at the option that made them. Ownership: scene_input_prepare gives memory, scene_input_release takes it;
 * words of the command line are borrowed. */
#ifndef CUVETTE_CLI_SCENE_INPUT_H
#define CUVETTE_CLI_SCENE_INPUT_H

#include "job/job.h"
#include "lint/lint.h"
#include "scene/model/open.h"

typedef struct scene_change {
    const char *option; /* "--set" */
    const char *path;   /* "render.depth"; NULL where the text is PATH=VALUE */
    const char *text;
} scene_change;

typedef struct scene_input {
    const char *command; /* "render" */
    const char *path;    /* NULL until it is named */
    scene_change *changes;
    size_t count;
    bool from_beginning; /* a slime's time_s does not count: it moves from its beginning on */
} scene_input;

/* Room for as many changes as the command line has words. */
status scene_input_prepare(scene_input *input, const char *command, int argc, diagnostic *why);
void scene_input_release(scene_input *input);

/* Takes the argument SCENE; STATUS_BAD_INPUT when there is one already. */
status scene_input_name(scene_input *input, const char *argument, diagnostic *why);

/* Takes --set PATH=VALUE (path NULL), or an option that stands for one. */
void scene_input_change(scene_input *input, const char *option, const char *path, const char *text);

/* STATUS_BAD_INPUT when no scene was named. */
status scene_input_check(const scene_input *input, diagnostic *why);

/* The scene as the command line changes it, checked; its pictures are not loaded. */
status scene_input_read(const scene_input *input, scene **out, diagnostic *why);

/* scene_load, with a line of progress while slimes move, and heard when it shall stop. */
status scene_input_load(scene *s, diagnostic *why);

/* Notes where the scene's picture is made of random paths or is spectral, since a tree of rays has all branches and
 * one wavelength; and where a medium was not measured at that. */
void scene_input_note_tree(const scene *s);

/* Notes on what looks wrong in the scene (scene/model/hints.h), on standard error. */
void scene_input_note_hints(const scene *s);

/* All notes of the linter (lint/lint.h) on a loaded scene; those whose place varies are left out. varies may be
 * NULL. */
status scene_input_lint(const scene *s, isa level, const lint_filter *varies, diagnostic *why);

/* isa_choose, located. */
status scene_input_isa(isa *level, diagnostic *why);

/* A job that ends at SIGINT and SIGTERM. measured: as in job_settings. */
status scene_input_job(bool measured, job **out, diagnostic *why);

#endif
