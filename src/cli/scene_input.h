/* What commands that work on a scene share: SCENE, --set and its short forms, the instruction set. Mistakes are
 * located at the option that made them. Ownership: reading the command line gives memory, scene_input_release takes it;
 * words of the command line are borrowed. */
#pragma once

#include "cli/options.h"
#include "job/job.h"
#include "lint/lint.h"
#include "render/inspect/probe.h"
#include "scene/model/open.h"

typedef struct scene_change {
    const char *option; /* "set" */
    const char *path;   /* "render.depth"; NULL where the text is PATH=VALUE */
    const char *text;
} scene_change;

typedef struct scene_input {
    const char *path;   /* NULL until it is named */
    const char *output; /* of OPTION_OUTPUT; NULL: not said, or the command has another one */
    scene_change *changes;
    size_t count;
    bool from_beginning; /* a slime's time_s does not count: it moves from its beginning on */
} scene_input;

/* Options of such commands; the scene_input is what their requests begin with. */
#define OPTION_SET(example)                                                                                         \
    {                                                                                                               \
        "set", 's', "PATH=VALUE", "set a parameter, as " example "; may be given many times", .take = option_change \
    }
#define OPTION_OUTPUT(purpose)                                                         \
    {                                                                                  \
        "output", 'o', "FILE", purpose, OPTION_FILLS(option_text, scene_input, output) \
    }
#define OPTION_DEPTH                                                                                            \
    {                                                                                                           \
        "depth", 0, "N", "the same as --set render.depth=N", .take = option_change, .parameter = "render.depth" \
    }
#define OPTION_LAMBDA                                                                                            \
    {                                                                                                            \
        "lambda", 0, "NM", "one wavelength for indices and for absorption by wavelength; sets render.lambda_nm", \
            .take = option_change, .parameter = "render.lambda_nm"                                               \
    }
status option_change(const command_option *o, void *request, const char *value, diagnostic *why);

/* A probe of the scene, at one wavelength where --lambda was given. */
status scene_input_probe(const scene_input *input, const scene *s, isa level, probe **out, diagnostic *why);

/* The one word of their command line. */
#define SCENE_WORD(command)                                                              \
    .words_at = offsetof(scene_input, path), .words_most = 1,                            \
    .excess_remedy = command " takes one scene; a parameter is set by --set PATH=VALUE", \
    .excess = "'%.128s' is one too many"

/* A command on a scene: reads its command line into the request, then the scene and, unless it stays unloaded, its
 * files, and runs. Each check may be NULL. What OPTION_OUTPUT names is looked at: its folder, and that the scene does
 * not read it. */
typedef struct scene_command {
    const char *name; /* "render" */
    command_form form;
    status (*check)(void *request, diagnostic *why);                       /* of what is asked for */
    status (*check_scene)(void *request, const scene *s, diagnostic *why); /* before its files are read */
    bool unloaded;
    status (*run)(void *request, scene *s, isa level, diagnostic *why);
} scene_command;

status scene_command_run(const scene_command *command, int argc, char **argv, void *request, diagnostic *why);

/* Its first half, for those that go on otherwise: the command line, checked. scene_input_release, also after an
 * error. */
status scene_command_read(const scene_command *command, int argc, char **argv, void *request, diagnostic *why);
void scene_input_release(scene_input *input);

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
