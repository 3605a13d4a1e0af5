/* A note: a part of a scene that is valid but suspicious, or a setting without effect. It has a place, a text and a
 * remedy, like a diagnostic. Ownership: values; a note contains its own text. */
#pragma once

#include "scene/model/material.h"
#include <stddef.h>

enum { NOTE_PLACE_MAX = 2 * SCENE_NAME_MAX, NOTE_TEXT_MAX = 256, NOTE_LINE_MAX = 768 };

typedef struct scene_note {
    char place[NOTE_PLACE_MAX]; /* a parameter's path as --set takes it ("water.ior"), or an object's name */
    char text[NOTE_TEXT_MAX];   /* the observation, no full stop */
    char remedy[NOTE_TEXT_MAX]; /* the remedy, no full stop; "" for none */
} scene_note;

/* A callback for notes; each note is borrowed for the call. */
typedef void note_call(void *context, const scene_note *note);
typedef struct note_taker {
    note_call *take;
    void *context;
} note_taker;

/* Passes a note to the callback. Its place is object.parameter, or whichever of them is not NULL. */
void note_give(const note_taker *taker, const char *object, const char *parameter, const char *remedy, const char *text,
               ...) __attribute__((format(printf, 5, 6)));

/* Writes "place: text; remedy" (missing parts are omitted) to line, at most NOTE_LINE_MAX; returns line. */
char *note_line(const scene_note *note, char *line, size_t size);
