/* The edits of `cuvette scene`, applied in the order of the command line. Errors are located at their option.
 * Ownership: arguments of the command line are borrowed. */
#pragma once

#include "scene/model/open.h"

typedef struct scene_edit scene_edit;

/* One option that edits a scene: name, placeholder of its value, help text, and function. */
struct scene_edit {
    const char *option; /* "--move" */
    int letter;         /* 0 for none */
    bool is_named;      /* the value is NAME=TEXT */
    const char *form;   /* "NAME=DX,DY,DZ" */
    const char *purpose;
    /* Without is_named, name is NULL and text is the whole value. */
    status (*apply)(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why);
};

extern const scene_edit scene_edits[];
extern const size_t scene_edit_count;

/* Applies one edit; errors are located at its option. */
status scene_edit_apply(scene *s, const scene_edit *edit, const char *text, diagnostic *why);
