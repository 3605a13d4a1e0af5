/* Notes on command-line and study parameters that have no effect on the image. */
#include "cli/inert_notes.h"
#include "cli/terminal.h"
#include "lint/lint.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <string.h>

enum { PATH_MAX_HERE = 200 };

/* Copies the path of a change: path, or the part of text before '='. */
static bool path_of(const char *path, const char *text, char out[PATH_MAX_HERE])
{
    const size_t length = path ? strlen(path) : strcspn(text, "=");
    if (length >= PATH_MAX_HERE)
        return false;
    memcpy(out, path ? path : text, length);
    out[length] = 0;
    return true;
}

typedef struct place_search {
    const char *place;
    bool found;
} place_search;

static void compare_place(void *context, const scene_note *note)
{
    place_search *x = context;
    x->found |= strcmp(x->place, note->place) == 0;
}

static bool is_hinted(const scene *s, const char *path)
{
    place_search x = {path, false};
    scene_hints(s, &(note_taker){compare_place, &x});
    return x.found;
}

static void print_note(const inert_answer *answer)
{
    char line[NOTE_LINE_MAX];
    terminal_note(note_line(&answer->note, line, sizeof line));
}

void inert_note_assignment(const scene *s, const char *assignment)
{
    char path[PATH_MAX_HERE];
    inert_answer answer;
    if (path_of(NULL, assignment, path) && inert_ask(s, path, NULL, &answer))
        print_note(&answer);
}

/* Returns whether a later option sets the same path. */
static bool is_set_again(const scene_input *input, size_t at, const char *path)
{
    char other[PATH_MAX_HERE];
    for (size_t i = at + 1; i < input->count; i++)
        if (path_of(input->changes[i].path, input->changes[i].text, other) && strcmp(path, other) == 0)
            return true;
    return false;
}

/* An animation sets time_s of its slimes, so that its value on the command line has no effect. */
static scene *in_motion(const scene *s)
{
    scene *moved = scene_clone(s);
    for (size_t i = 0; moved && i < moved->mesh_count; i++)
        if (moved->meshes[i].source == MESH_SLIME)
            moved->meshes[i].time_s = 1.0;
    return moved;
}

/* Notes the changes of the command line that have no effect; with a witness (a rendered frame), only the changes that
 * are checked by it. */
static void note_changes(const scene *s, const scene_input *input, const inert_witness *witness)
{
    for (size_t i = 0; i < input->count; i++) {
        char path[PATH_MAX_HERE];
        inert_answer answer;
        if (!path_of(input->changes[i].path, input->changes[i].text, path) || is_set_again(input, i, path))
            continue;
        const bool is_plain = inert_ask(s, path, NULL, &answer);
        if (witness ? !is_plain && inert_ask(s, path, witness, &answer) : is_plain && !is_hinted(s, path))
            print_note(&answer);
    }
}

void inert_note_changes(const scene *s, const scene_input *input)
{
    scene *moved = input->from_beginning ? in_motion(s) : NULL;
    note_changes(moved ? moved : s, input, NULL);
    scene_destroy(moved);
}

/* --- notes that need a rendered frame --- */

typedef struct frame_of {
    const job_account *frame;
    job *with;
} frame_of;

static bool is_same(void *context, const char *assignment)
{
    const double moment_s = 1.0;
    const frame_of *f = context;
    scene *s = f->frame->result->wall_s < moment_s ? scene_clone(f->frame->of) : NULL;
    job_account other = {.result = NULL};
    const bool rendered = s && scene_set_assignment(s, assignment, NULL) == STATUS_OK &&
                          scene_check(s, NULL) == STATUS_OK && job_load(f->with, s, NULL, NULL) == STATUS_OK &&
                          job_render(f->with, s, NULL, &other, NULL) == STATUS_OK;
    const bool same = rendered && job_account_hash(&other) == job_account_hash(f->frame);
    job_account_release(&other);
    scene_destroy(s);
    return same;
}

void inert_note_frame(const scene_input *input, job *with, const job_account *frame)
{
    frame_of f = {frame, with};
    note_changes(frame->of, input, &(inert_witness){&frame->result->counters, is_same, &f});
}
