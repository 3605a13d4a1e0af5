/* One row's value: from text, to text, into and out of the struct that holds it. The rest of params.h is
 * built on it. Ownership: param_value_text gives fresh memory; a PARAM_PATH field owns its text. */
#pragma once

#include "scene/model/params.h"
#include "scene/model/material.h"

typedef union param_value {
    int64_t integer;
    double real;
    vec3 vector;
    number_list list;
    char *path;
    char word[SCENE_NAME_MAX + 1];
} param_value;

/* Parses and checks text; label names the parameter in messages. element -1 for the whole value, 0..2 for one
 * element of a vector or colour, which arrives in real. A path is fresh memory. */
status param_value_parse(const param *row, int element, const char *label, const char *text, param_value *out,
                         diagnostic *why);

/* Puts a value into its place; field is the address of the row's field. Takes over a path. */
void param_value_store(const param *row, int element, void *field, param_value value);

/* The value as text, or NULL when memory is out. */
char *param_value_text(const param *row, int element, const void *field);

/* "give an integer 0..64": what would be right for the row, or for one element of a vector; returns text. */
char *param_remedy(const param *row, bool one_element, char *text, size_t size);

/* The row's default, as param_value_text gives it; fresh memory, NULL when that is out. */
char *param_default_text(const param *row);

/* Gives every field of the group's rows in *base its default. Path fields must be NULL or text of their own. */
status param_set_defaults(param_group group, void *base, diagnostic *why);
