/* The edits of `cuvette scene`, in the order in which the command line has them. Mistakes are located at the option
 * that made them. Ownership: words of the command line are borrowed. */
#pragma once

#include "scene/model/open.h"

typedef struct scene_edit scene_edit;

/* One option that changes a scene: its name, the form of its value, what it is for, and how it is done. */
struct scene_edit {
    const char *option; /* "--move" */
    int letter;         /* 0 for none */
    bool is_named;      /* its value is NAME=TEXT */
    const char *form;   /* "NAME=DX,DY,DZ" */
    const char *purpose;
    /* name is NULL, and text the whole value, where it is not named. */
    status (*apply)(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why);
};

extern const scene_edit scene_edits[];
extern const size_t scene_edit_count;

/* Does one edit, and locates what is wrong with it. */
status scene_edit_apply(scene *s, const scene_edit *edit, const char *text, diagnostic *why);
