/* Common parts of the readers of lens files: lines divided into words that know their columns. Private to this
 * folder. */
#pragma once

#include "scene/lens/lens_prescription.h"
#include "scene/model/params.h"

enum { LENS_WORDS_MAX = 64 };

typedef struct lens_reader {
    const char *name;
    const lens_glasses *glasses;
    lens_prescription *p;
    size_t room; /* of p->surface */
    long line;
    char *word[LENS_WORDS_MAX]; /* of the line; the text is changed */
    int column[LENS_WORDS_MAX], count;
    diagnostic *why;
} lens_reader;

/* STATUS_BAD_INPUT at a word of the line; word -1: at the line. */
status lens_wrong(const lens_reader *r, int word, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
/* Divides a line: at blanks, or at commas with the blanks around them removed. */
void lens_divide(lens_reader *r, char *line, bool commas);
/* Word i as a finite number; an error if it is missing or something else. */
status lens_number(const lens_reader *r, int i, const char *what, double *out);
/* Appends an empty surface, in air; NULL after an error. */
lens_surface *lens_append(lens_reader *r, status *code);
/* The medium of a word (lens_medium_parse), with its position. */
status lens_read_medium(const lens_reader *r, int i, const char *word, lens_medium *out);
/* Adds a remark to the prescription's note. */
void lens_note(lens_prescription *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

status lens_read_zmx(lens_reader *r, char *text);

/* Sets parameters of a scene by name, one after the other, until the first error. Private to this folder. */

typedef struct lens_target {
    scene *s;
    status code; /* of the first step that failed */
    diagnostic *why;
} lens_target;

/* Adds a solid, whose shape is a word of files. */
void lens_add_solid(lens_target *t, const char *shape, const char *name);
/* Sets NAME.ROW (scene_set_property). */
void lens_put(lens_target *t, const char *name, const char *row, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void lens_put_number(lens_target *t, const char *name, const char *row, double value);
/* Whether an object of the group has the name. */
bool lens_has(const scene *s, param_group group, const char *name);
