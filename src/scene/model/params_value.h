/* The value of one row: from text, to text, and in the struct of its group. Basis of params.h. Ownership:
 * param_value_text returns newly allocated text; a PARAM_PATH field owns its text. */
#pragma once

#include "scene/model/material.h"
#include "scene/model/params.h"

typedef union param_value {
    int64_t integer;
    double real;
    vec3 vector;
    number_list list;
    char *path;
    char word[SCENE_NAME_MAX + 1];
    char layers[COATING_MAX + 1];
} param_value;

/* Parses and checks text; label is the parameter in messages. element -1 for the whole value, 0..2 for one element of a
 * vector or colour, which is returned in real. A path is newly allocated. */
status param_value_parse(const param *row, int element, const char *label, const char *text, param_value *out,
                         diagnostic *why);

/* Stores a value; field is the address of the row's field. Takes ownership of a path. */
void param_value_store(const param *row, int element, void *field, param_value value);

/* The value as text, or NULL if memory runs out. */
char *param_value_text(const param *row, int element, const void *field);

/* Writes the remedy for an invalid value, such as "give an integer 0..64", for the row or for one element of a vector.
 * Returns text. */
char *param_remedy(const param *row, bool one_element, char *text, size_t size);

/* The row's default in the form of param_value_text. Newly allocated; NULL if memory runs out. */
char *param_default_text(const param *row);
/* Likewise, the row's first default (param.first_default). */
char *param_first_default_text(const param *row);

/* The first defaults of all rows, parsed once for callers that compare many values. NULL if memory runs out; the caller
 * destroys it. */
param_defaults *param_first_defaults_create(void);
void param_first_defaults_destroy(param_defaults *old);
/* Whether the row's field has the row's default: exactly if param_value_text is the same for both. */
bool param_defaults_hold(const param_defaults *d, const param *row, const void *field);

/* Sets every field of the group's rows in *base to its default. Path fields must be NULL or owned text. */
status param_set_defaults(param_group group, void *base, diagnostic *why);
