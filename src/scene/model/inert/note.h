/* A note: something of a scene that is allowed and still looks wrong, or that is set and does nothing. It says
 * where, what, and what to do about it, as a diagnostic does of an error. Ownership: values; a note holds its own
 * text. */
#pragma once

#include "scene/model/material.h"
#include <stddef.h>

enum { NOTE_PLACE_MAX = 2 * SCENE_NAME_MAX, NOTE_TEXT_MAX = 256, NOTE_LINE_MAX = 768 };

typedef struct scene_note {
    char place[NOTE_PLACE_MAX]; /* a parameter's path as --set takes it ("water.ior"), or an object's name */
    char text[NOTE_TEXT_MAX];   /* what looks wrong, no full stop */
    char remedy[NOTE_TEXT_MAX]; /* what to do, no full stop; "" when there is nothing to do */
} scene_note;

/* Who takes notes, one by one; a note is borrowed for the call. */
typedef void note_call(void *context, const scene_note *note);
typedef struct note_taker {
    note_call *take;
    void *context;
} note_taker;

/* Gives the taker a note. Its place is object.parameter, or the one of them that is not NULL. */
void note_give(const note_taker *taker, const char *object, const char *parameter, const char *remedy, const char *text,
               ...) __attribute__((format(printf, 5, 6)));

/* Writes "place: text; remedy" (parts that are absent are left out) into line, of NOTE_LINE_MAX at best; returns
 * line. */
char *note_line(const scene_note *note, char *line, size_t size);
