/* The value of one row of the table: to text, from text, and in the struct of its group. */
#include "base/number.h"
#include "base/text.h"
#include "optics/coating.h"
#include "optics/media.h"
#include "scene/model/material.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* --- to text --- */

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
    snprintf(text, size, row->above_lowest ? "> %s, at most %s%s" : "%s..%s%s", low, high,
             row->not_zero ? ", not 0" : "");
}

static void choice_text(const param *row, char *text, size_t size)
{
    int used = snprintf(text, size, "one of: ");
    for (size_t i = 0; row->choices[i] && used >= 0 && (size_t)used < size; i++)
        used += snprintf(text + used, size - (size_t)used, "%s%s", i ? ", " : "", row->choices[i]);
}

static void word_text(const param *row, char *text, size_t size)
{
    if (row->names)
        snprintf(text, size, strcmp(row->names, "data") == 0 ? "name of %s" : "name of a %s", row->names);
    else
        snprintf(text, size, "text of at most %d bytes", (int)SCENE_NAME_MAX);
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
        word_text(row, text, size);
    else if (row->type == PARAM_LAYERS)
        snprintf(text, size, "a design (cuvette media), or layers from outside to inside, as mgf2 99.7, ta2o5 550/2");
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

static double element_value(const vec3 *v, int element)
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
    char *closed = text ? text_format("%s]", text) : NULL;
    free(text);
    return closed;
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
        return element < 0 ? vector_text(&v) : strdup(number_format(element_value(&v, element), number));
    }
    case PARAM_LIST: return list_text(field);
    case PARAM_PATH: return strdup(*(char *const *)field ? *(char *const *)field : "");
    case PARAM_WORD: return strdup(field);
    case PARAM_LAYERS: return strdup(*(const char *)field ? field : "none");
    }
    return NULL;
}

/* Compares bits: 0 and -0 are different texts. */
static bool equal_numbers(const double *a, const double *b, size_t count)
{
    return memcmp(a, b, count * sizeof *a) == 0;
}

static bool equal_paths(char *const *a, char *const *b)
{
    return strcmp(*a ? *a : "", *b ? *b : "") == 0;
}

static bool equal_lists(const number_list *a, const number_list *b)
{
    return a->count == b->count && equal_numbers(a->value, b->value, (size_t)a->count);
}

/* Whether two fields of a row have the same text. A param_value is the field of its type. */
static bool fields_match(const param *row, const void *a, const void *b)
{
    switch (row->type) {
    case PARAM_INT:
    case PARAM_CHOICE: return *(const int64_t *)a == *(const int64_t *)b;
    case PARAM_REAL: return equal_numbers(a, b, 1);
    case PARAM_VECTOR:
    case PARAM_COLOR: return equal_numbers(a, b, 3);
    case PARAM_LIST: return equal_lists(a, b);
    case PARAM_PATH: return equal_paths(a, b);
    case PARAM_WORD:
    case PARAM_LAYERS: return strcmp(a, b) == 0;
    }
    return false;
}

bool param_values_match(const param *row, const void *one, const void *other)
{
    return fields_match(row, (const char *)one + row->offset, (const char *)other + row->offset);
}

/* --- from text --- */

/* How much of an invalid value a message repeats. */
#define SHOWN "%.60s"

static size_t count_words(const char *const *words)
{
    size_t count = 0;
    while (words && words[count])
        count++;
    return count;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static status wrong(const param *row, bool one_element, diagnostic *why, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* An error with the row's range as its remedy. */
static status wrong(const param *row, bool one_element, diagnostic *why, const char *what, ...)
{
    char text[300], remedy[420];
    va_list arguments;
    va_start(arguments, what);
    if (vsnprintf(text, sizeof text, what, arguments) < 0)
        text[0] = 0;
    va_end(arguments);
    return diagnose(why, STATUS_BAD_INPUT, param_remedy(row, one_element, remedy, sizeof remedy), "%s", text);
}

static bool in_range(const param *row, double value)
{
    return value <= row->highest && (row->above_lowest ? value > row->lowest : value >= row->lowest) &&
           !(row->not_zero && value == 0.0);
}

/* Reports a text that is not a number; the remedy depends on a decimal comma or a unit after the digits. */
static status not_a_number(const param *row, const char *label, const char *text, diagnostic *why)
{
    const char *digits = text + strspn(text, "+-."), *rest = digits + strspn(digits, "0123456789.eE+-");
    bool comma = rest > digits && *rest == ',';
    bool unit =
        rest > digits && *rest && rest[strspn(rest, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")] == 0;
    if (!comma && !unit)
        return wrong(row, true, why, "%s: '" SHOWN "' is not a finite number", label, text);
    char remedy[120];
    if (comma && strchr(rest + 1, ','))
        snprintf(remedy, sizeof remedy, "give one number");
    else if (comma)
        snprintf(remedy, sizeof remedy, "a decimal comma? write 1.5");
    else
        snprintf(remedy, sizeof remedy, "write only the number%s%s", row->unit[0] ? ", in " : "", row->unit);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s: '" SHOWN "' is not a finite number", label, text);
}

static status parse_real(const param *row, const char *label, const char *text, double *out, diagnostic *why)
{
    double value;
    if (!number_parse_real(text, &value))
        return not_a_number(row, label, text, why);
    if (!in_range(row, value))
        return wrong(row, true, why, "%s: " SHOWN " is out of range", label, text);
    *out = value;
    return STATUS_OK;
}

static bool is_switch(const param *row)
{
    return count_words(row->choices) == 2 && strcmp(row->choices[0], "off") == 0 && strcmp(row->choices[1], "on") == 0;
}

/* Accepts YAML's words for off and on, in upper or lower case. */
static bool choose_switch(const char *text, int64_t *index)
{
    static const char *const words[] = {"off", "on", "no", "yes", "false", "true"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcasecmp(words[i], text) == 0) {
            *index = i % 2;
            return true;
        }
    }
    return false;
}

static bool choose(const param *row, const char *text, int64_t *index)
{
    for (int64_t i = 0; row->choices[i]; i++) {
        if (strcmp(row->choices[i], text) == 0) {
            *index = i;
            return true;
        }
    }
    return false;
}

static status parse_choice(const param *row, const char *label, const char *text, int64_t *out, diagnostic *why)
{
    const bool is_medium = strcmp(row->name, "medium") == 0;
    if (choose(row, text, out) || (is_switch(row) && choose_switch(text, out)) ||
        (is_medium && choose(row, media_usual_name(text), out)))
        return STATUS_OK;
    /* No suggestion for a switch: off and on are equally near in spelling, and are opposites. */
    const char *nearest = is_switch(row) ? NULL : text_nearest(text, row->choices, count_words(row->choices));
    if (nearest) {
        char range[400], remedy[460];
        snprintf(remedy, sizeof remedy, "did you mean '%s'? %s%s", nearest, is_medium ? "" : "It is ",
                 is_medium ? "cuvette media lists the names" : param_range_text(row, range, sizeof range));
        return diagnose(why, STATUS_BAD_INPUT, remedy, "%s: '" SHOWN "' is not one of the choices", label, text);
    }
    if (is_medium)
        return diagnose(why, STATUS_BAD_INPUT,
                        "give a name of the catalogue (cuvette media), or a file, as {file: schott.agf, glass: NAME}",
                        "%s: '" SHOWN "' is not one of the choices", label, text);
    return wrong(row, false, why, "%s: '" SHOWN "' is not one of the choices", label, text);
}

static status parse_integer(const param *row, const char *label, const char *text, int64_t *out, diagnostic *why)
{
    int64_t value, index;
    if (row->automatic && strcmp(text, row->automatic) == 0) {
        *out = row->automatic_value;
        return STATUS_OK;
    }
    if (!number_parse_int(text, &value))
        return wrong(row, false, why, "%s: '" SHOWN "' is not an integer", label, text);
    char plain[NUMBER_TEXT_MAX];
    snprintf(plain, sizeof plain, "%lld", (long long)value);
    if (!in_range(row, (double)value) || (row->choices && !choose(row, plain, &index)))
        return wrong(row, false, why, "%s: " SHOWN " is out of range", label, text);
    *out = value;
    return STATUS_OK;
}

/* Splits "0,1,2" or "[0, 1, 2]" in place; returns the number of parts; parts[] has the first `room` of them. */
static size_t split_numbers(char *text, char **parts, size_t room)
{
    size_t length = strlen(text), count = 0;
    if (length >= 2 && text[0] == '[' && text[length - 1] == ']') {
        text[length - 1] = 0;
        text++;
    }
    for (char *next = text; next; count++) {
        char *part = next, *comma = strchr(part, ',');
        next = comma ? comma + 1 : NULL;
        if (comma)
            *comma = 0;
        while (is_blank(*part))
            part++;
        char *end = part + strlen(part);
        while (end > part && is_blank(end[-1]))
            *--end = 0;
        if (count < room)
            parts[count] = part;
    }
    return count;
}

static status parse_vector(const param *row, const char *label, char *text, vec3 *out, diagnostic *why)
{
    char *parts[3];
    double values[3];
    size_t count = split_numbers(text, parts, 3);
    if (count != 3)
        return wrong(row, false, why, "%s: %zu value%s instead of 3", label, count, count == 1 ? "" : "s");
    for (int i = 0; i < 3; i++) {
        char element[160];
        if (number_parse_real(parts[i], &values[i]) && in_range(row, values[i]))
            continue;
        snprintf(element, sizeof element, "%s.%c", label, (row->type == PARAM_COLOR ? "rgb" : "xyz")[i]);
        TRY(parse_real(row, element, parts[i], &values[i], why));
    }
    *out = vec3_make(values[0], values[1], values[2]);
    return STATUS_OK;
}

static status parse_list(const param *row, const char *label, char *text, number_list *out, diagnostic *why)
{
    char *parts[NUMBER_LIST_MAX];
    size_t count = split_numbers(text, parts, NUMBER_LIST_MAX);
    if (count == 1 && !*parts[0])
        count = 0;
    if (count > NUMBER_LIST_MAX)
        return wrong(row, false, why, "%s: %zu numbers are too many", label, count);
    *out = (number_list){.count = (int64_t)count};
    for (size_t i = 0; i < count; i++)
        TRY(parse_real(row, label, parts[i], &out->value[i], why));
    return STATUS_OK;
}

static status parse_path(const param *row, const char *label, char *text, char **out, diagnostic *why)
{
    enum { PATH_LIMIT = 4095 };
    if (strlen(text) > PATH_LIMIT)
        return wrong(row, false, why, "%s: the path is longer than %d bytes", label, PATH_LIMIT);
    for (const char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            return wrong(row, false, why, "%s: the path contains a control character", label);
    *out = strdup(text);
    return *out ? STATUS_OK : out_of_memory(why);
}

/* Parses the name of another object, or "". */
static status parse_word(const param *row, const char *label, const char *text, char word[SCENE_NAME_MAX + 1],
                         diagnostic *why)
{
    if (strlen(text) > SCENE_NAME_MAX)
        return wrong(row, false, why, "%s: the name is longer than %d bytes", label, (int)SCENE_NAME_MAX);
    if (*text && row->names)
        TRY(check_name(text, why));
    for (const char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            return wrong(row, false, why, "%s: the text has a control character", label);
    strcpy(word, text);
    return STATUS_OK;
}

/* Copies a text with single blanks, and one after each comma; false if it is too long. */
static bool copy_spaced(const char *text, char out[COATING_MAX + 1])
{
    size_t length = 0;
    bool blank = false;
    for (; *text; text++) {
        const bool after_comma = length > 0 && out[length - 1] == ',';
        if (is_blank(*text)) {
            blank = true;
            continue;
        }
        if ((blank || after_comma) && length > 0 && *text != ',' && *text != ')' && out[length - 1] != '(')
            out[length++] = ' ';
        blank = false;
        if (length + 2 > COATING_MAX)
            return false;
        out[length++] = *text;
    }
    out[length] = 0;
    return true;
}

/* A coating without brackets around it; none is the empty text. */
static status parse_layers(const char *label, char *text, char layers[COATING_MAX + 1], diagnostic *why)
{
    coating_layers unused;
    diagnostic bad = {.what = ""};
    const size_t length = strlen(text);
    if (length >= 2 && text[0] == '[' && text[length - 1] == ']') {
        text[length - 1] = 0;
        text++;
    }
    if (strcmp(text, "none") == 0)
        text += strlen(text);
    const status code = *text ? coating_parse(text, &unused, &bad) : STATUS_OK;
    if (code != STATUS_OK)
        return diagnose(why, code, bad.remedy, "%s: %s", label, bad.what);
    if (!copy_spaced(text, layers))
        return diagnose(why, STATUS_BAD_INPUT, "write fewer layers, or repeat them, as 10x(...)",
                        "%s: the coating is longer than %d bytes", label, (int)COATING_MAX);
    return STATUS_OK;
}

/* text is a trimmed copy, which the parsers may modify. */
static status parse_trimmed(const param *row, int element, const char *label, char *text, param_value *out,
                            diagnostic *why)
{
    if (!*text && row->type != PARAM_PATH && row->type != PARAM_LIST && row->type != PARAM_WORD &&
        row->type != PARAM_LAYERS)
        return wrong(row, element >= 0, why, "%s has no value", label);
    if (element >= 0)
        return parse_real(row, label, text, &out->real, why);
    switch (row->type) {
    case PARAM_INT: return parse_integer(row, label, text, &out->integer, why);
    case PARAM_REAL: return parse_real(row, label, text, &out->real, why);
    case PARAM_CHOICE: return parse_choice(row, label, text, &out->integer, why);
    case PARAM_VECTOR:
    case PARAM_COLOR: return parse_vector(row, label, text, &out->vector, why);
    case PARAM_LIST: return parse_list(row, label, text, &out->list, why);
    case PARAM_PATH: return parse_path(row, label, text, &out->path, why);
    case PARAM_WORD: return parse_word(row, label, text, out->word, why);
    case PARAM_LAYERS: return parse_layers(label, text, out->layers, why);
    }
    return STATUS_FAILURE;
}

status param_value_parse(const param *row, int element, const char *label, const char *text, param_value *out,
                         diagnostic *why)
{
    while (is_blank(*text))
        text++;
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1]))
        length--;
    char *copy = strndup(text, length);
    if (!copy)
        return out_of_memory(why);
    status code = parse_trimmed(row, element, label, copy, out, why);
    free(copy);
    return code;
}

static double *element_of(vec3 *v, int element)
{
    return element == 0 ? &v->x : element == 1 ? &v->y : &v->z;
}

void param_value_store(const param *row, int element, void *field, param_value value)
{
    switch (row->type) {
    case PARAM_INT:
    case PARAM_CHOICE: *(int64_t *)field = value.integer; break;
    case PARAM_REAL: *(double *)field = value.real; break;
    case PARAM_VECTOR:
    case PARAM_COLOR:
        if (element >= 0)
            *element_of(field, element) = value.real;
        else
            *(vec3 *)field = value.vector;
        break;
    case PARAM_LIST: *(number_list *)field = value.list; break;
    case PARAM_WORD: strcpy(field, value.word); break;
    case PARAM_LAYERS: strcpy(field, value.layers); break;
    case PARAM_PATH:
        free(*(char **)field);
        *(char **)field = value.path;
        break;
    }
}

status param_set_defaults(param_group group, void *base, diagnostic *why)
{
    for (size_t i = 0; i < param_count(); i++) {
        const param *row = param_at(i);
        if (row->group != group)
            continue;
        param_value value;
        TRY(param_value_parse(row, -1, row->name, row->fallback, &value, why));
        param_value_store(row, -1, (char *)base + row->offset, value);
    }
    return STATUS_OK;
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

static const char *first_default(const param *row)
{
    return row->first_default ? row->first_default : row->fallback;
}

char *param_first_default_text(const param *row)
{
    return canonical_text(row, first_default(row));
}

/* --- defaults as values --- */

struct param_defaults {
    size_t count;
    param_value value[]; /* by row */
};

void param_first_defaults_destroy(param_defaults *old)
{
    for (size_t i = 0; old && i < old->count; i++)
        if (param_at(i)->type == PARAM_PATH)
            free(old->value[i].path);
    free(old);
}

param_defaults *param_first_defaults_create(void)
{
    param_defaults *made = calloc(1, sizeof *made + param_count() * sizeof *made->value);
    for (size_t i = 0; made && i < param_count(); i++) {
        const param *row = param_at(i);
        if (param_value_parse(row, -1, row->name, first_default(row), &made->value[i], NULL) != STATUS_OK) {
            param_first_defaults_destroy(made);
            return NULL;
        }
        made->count++;
    }
    return made;
}

bool param_defaults_hold(const param_defaults *d, const param *row, const void *field)
{
    return fields_match(row, field, &d->value[row - param_at(0)]);
}
