/* The common part of all commands on a scene: SCENE, --set and its short forms, the instruction set. Diagnostics name
 * the option. Ownership: reading the command line allocates, scene_input_release frees; arguments of the command line
 * are borrowed. */
#pragma once

#include "cli/options.h"
#include "job/job.h"
#include "lint/lint.h"
#include "render/inspect/probe.h"
#include "scene/model/open.h"

typedef struct scene_change {
    const char *option; /* "set" */
    const char *path;   /* "render.depth"; NULL if the text is PATH=VALUE */
    const char *text;
} scene_change;

typedef struct scene_input {
    const char *path;   /* NULL: not given */
    const char *output; /* value of OPTION_OUTPUT; NULL: not given, or the command has its own option */
    scene_change *changes;
    size_t count;
    bool from_beginning; /* ignore time_s of slimes: they start at rest, as an animation needs them */
} scene_input;

/* Options of these commands, whose request must start with the scene_input. */
#define OPTION_SET(example)                                                                                       \
    {                                                                                                             \
        "set", 's', "PATH=VALUE", "set a parameter, such as " example "; may be repeated", .store = option_change \
    }
#define OPTION_OUTPUT(purpose)                                                         \
    {                                                                                  \
        "output", 'o', "FILE", purpose, OPTION_FILLS(option_text, scene_input, output) \
    }
#define OPTION_DEPTH                                                                                           \
    {                                                                                                          \
        "depth", 0, "N", "short for --set render.depth=N", .store = option_change, .parameter = "render.depth" \
    }
#define OPTION_LAMBDA                                                                                         \
    {                                                                                                         \
        "lambda", 0, "NM", "wavelength of refractive indices and spectral absorption; sets render.lambda_nm", \
            .store = option_change, .parameter = "render.lambda_nm"                                           \
    }
/* The memory that the process may use, for all commands that load or render; it is not stored in a request. */
#define OPTION_MEMORY                                                                                  \
    {                                                                                                  \
        "memory-limit", 0, "SIZE", "refuse work that needs more memory than SIZE, such as 500M or 4G", \
            .store = option_memory                                                                     \
    }
status option_memory(const command_option *o, void *request, const char *value, diagnostic *why);
status option_change(const command_option *o, void *request, const char *value, diagnostic *why);

/* Creates a probe of the scene, at one wavelength if --lambda is given. */
status scene_input_probe(const scene_input *input, const scene *s, isa level, probe **out, diagnostic *why);

/* The one argument of these commands, SCENE. */
#define SCENE_WORD(command, others)                                                             \
    .arguments_at = offsetof(scene_input, path), .argument_limit = 1,                           \
    .excess_remedy = command " takes one scene; use " others "--set PATH=VALUE for parameters", \
    .excess = "unexpected argument '%.128s'"

/* A command on a scene. It parses the command line into the request, reads the scene, loads its files unless `unloaded`
 * is set, and runs. Each check may be NULL. The file of OPTION_OUTPUT is checked: its folder must exist, and the scene
 * must not read it. */
typedef struct scene_command {
    const char *name; /* "render" */
    command_form form;
    status (*check)(void *request, diagnostic *why); /* checks the request */
    status (*check_scene)(void *request, const scene *s,
                          diagnostic *why); /* checks the scene before its files are read */
    bool unloaded;
    status (*run)(void *request, scene *s, isa level, diagnostic *why);
} scene_command;

status scene_command_run(const scene_command *command, int argc, char **argv, void *request, diagnostic *why);

/* The first half of scene_command_run: parses and checks the command line. The caller calls scene_input_release, also
 * after an error. */
status scene_command_read(const scene_command *command, int argc, char **argv, void *request, diagnostic *why);
void scene_input_release(scene_input *input);

/* Reads the scene, applies the changes of the command line and checks it; does not load its files. */
status scene_input_read(const scene_input *input, scene **out, diagnostic *why);

/* scene_load with a progress line while slimes are simulated; ends after a Ctrl-C. */
status scene_input_load(scene *s, diagnostic *why);

/* Notes for commands that trace ray trees, which have all branches and one wavelength: the scene is rendered with
 * another integrator or spectrally, or a medium was not measured at the wavelength. */
void scene_input_note_tree(const scene_input *input, const scene *s);

/* Prints notes for commands that show beams: a medium was not measured at a beam's wavelength. */
void scene_input_note_beams(const scene *s);

/* Prints the hints on likely mistakes in the scene (lint/lint.h) on standard error. */
void scene_input_note_hints(const scene *s);

/* Prints all notes of the linter (lint/lint.h) on a loaded scene. */
status scene_input_lint(const scene *s, isa level, diagnostic *why);

/* Prints the notes on a rendered frame (job/account.h). */
void scene_input_note_frame(const job_account *frame);

/* isa_choose; diagnostics name the environment. */
status scene_input_isa(isa *level, diagnostic *why);

/* Creates a job that ends at SIGINT and SIGTERM. measured: as in job_settings. After scene_input_distribute, which a
 * program calls once at its start, the job distributes its frames over processes. */
void scene_input_distribute(const job_distribution *sharing);
status scene_input_job(bool measured, job **out, diagnostic *why);

/* --- notes on parameters that are set but have no effect (lint/lint.h), one line each on standard error --- */

/* A place that already has a note of the linter gets no second one. Everything is borrowed. */

/* Notes on the changes of the command line. s: the changed scene. */
void scene_input_note_inert(const scene *s, const scene_input *input);

/* Further notes on the command line that need the rendered frame. If a note needs a second frame for comparison, the
 * job renders it, unless the first one took a second or more. */
void scene_input_note_inert_frame(const scene_input *input, job *frame_job, const job_account *frame);

/* Prints a note if one PATH=VALUE has no effect. */
void scene_input_note_inert_assignment(const scene *s, const char *assignment);
