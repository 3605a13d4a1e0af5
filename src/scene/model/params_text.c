/* Values and ranges of rows as text. */
#include "base/number.h"
#include "base/text.h"
#include "scene/model/params_value.h"
#include "scene/model/material.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_vector(const param *row)
{
    return row->type == PARAM_VECTOR || row->type == PARAM_COLOR;
}

/* "> 0, at most 179", "0..1" */
static void interval_text(const param *row, char *text, size_t size)
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    number_format(row->lowest, low);
    number_format(row->highest, high);
    snprintf(text, size, row->above_lowest ? "> %s, at most %s" : "%s..%s", low, high);
}

static void choice_text(const param *row, char *text, size_t size)
{
    int used = snprintf(text, size, "one of: ");
    for (size_t i = 0; row->choices[i] && used >= 0 && (size_t)used < size; i++)
        used += snprintf(text + used, size - (size_t)used, "%s%s", i ? ", " : "", row->choices[i]);
}

static char *element_range_text(const param *row, bool one_element, char *text, size_t size)
{
    char interval[2 * NUMBER_TEXT_MAX + 16];
    interval_text(row, interval, sizeof interval);
    if (row->choices)
        choice_text(row, text, size);
    else if (row->type == PARAM_PATH)
        snprintf(text, size, "path of a file");
    else if (row->type == PARAM_WORD)
        snprintf(text, size, "name of a %s", row->name);
    else if (row->type == PARAM_LIST && !one_element)
        snprintf(text, size, "a list of at most %d numbers, each %s", (int)NUMBER_LIST_MAX, interval);
    else if (is_vector(row) && !one_element)
        snprintf(text, size, "3 numbers, each %s", interval);
    else
        snprintf(text, size, "%s %s%s%s", row->type == PARAM_INT ? "integer" : "number", interval,
                 row->automatic ? ", or " : "", row->automatic ? row->automatic : "");
    return text;
}

char *param_range_text(const param *row, char *text, size_t size)
{
    return element_range_text(row, false, text, size);
}

char *param_remedy(const param *row, bool one_element, char *text, size_t size)
{
    char range[400];
    element_range_text(row, one_element, range, sizeof range);
    bool several = row->choices || (is_vector(row) && !one_element) || range[0] == 'a';
    snprintf(text, size, "give %s%s", several ? "" : range[0] == 'i' ? "an " : "a ", range);
    return text;
}

static double element_of(const vec3 *v, int element)
{
    return element == 0 ? v->x : element == 1 ? v->y : v->z;
}

static char *vector_text(const vec3 *v)
{
    char x[NUMBER_TEXT_MAX], y[NUMBER_TEXT_MAX], z[NUMBER_TEXT_MAX];
    return text_format("%s,%s,%s", number_format(v->x, x), number_format(v->y, y), number_format(v->z, z));
}

/* "[]", "[1,2.5]" */
static char *list_text(const number_list *list)
{
    char *text = strdup("[");
    for (int64_t i = 0; text && i < list->count; i++) {
        char number[NUMBER_TEXT_MAX];
        char *longer = text_format("%s%s%s", text, i ? "," : "", number_format(list->value[i], number));
        free(text);
        text = longer;
    }
    char *whole = text ? text_format("%s]", text) : NULL;
    free(text);
    return whole;
}

char *param_value_text(const param *row, int element, const void *field)
{
    char number[NUMBER_TEXT_MAX];
    switch (row->type) {
    case PARAM_INT: {
        const int64_t value = *(const int64_t *)field;
        return row->automatic && value == row->automatic_value ? strdup(row->automatic)
                                                               : text_format("%lld", (long long)value);
    }
    case PARAM_CHOICE: return strdup(row->choices[*(const int64_t *)field]);
    case PARAM_REAL: return strdup(number_format(*(const double *)field, number));
    case PARAM_VECTOR:
    case PARAM_COLOR: {
        vec3 v = *(const vec3 *)field;
        return element < 0 ? vector_text(&v) : strdup(number_format(element_of(&v, element), number));
    }
    case PARAM_LIST: return list_text(field);
    case PARAM_PATH: return strdup(*(char *const *)field ? *(char *const *)field : "");
    case PARAM_WORD: return strdup(field);
    }
    return NULL;
}

static char *canonical_text(const param *row, const char *given)
{
    param_value value;
    if (param_value_parse(row, -1, row->name, given, &value, NULL) != STATUS_OK)
        return NULL;
    char *text = param_value_text(row, -1, &value);
    if (row->type == PARAM_PATH)
        free(value.path);
    return text;
}

char *param_default_text(const param *row)
{
    return canonical_text(row, row->fallback);
}

char *param_first_default_text(const param *row)
{
    return canonical_text(row, row->first_default ? row->first_default : row->fallback);
}
