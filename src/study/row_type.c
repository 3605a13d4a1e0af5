#include "study/row_type.h"
#include "base/number.h"
#include "job/quantities.h"
#include <stdlib.h>
#include <string.h>

typedef enum column_type { ANY, COUNTED, SWITCH, REAL, POSITIVE, HASHED, LISTED, TIME } column_type;

static const struct {
    const char *name;
    column_type type;
} own[] = {{"cell", COUNTED},      {"repetition", COUNTED},   {"warmup", SWITCH},    {"order", COUNTED},
           {"time_utc", TIME},     {"film_expected", HASHED}, {"marked", SWITCH},    {"disturbed", SWITCH},
           {"definition", HASHED}, {"worker", COUNTED},       {"film_hash", HASHED}, {"wall_s", POSITIVE}};

static column_type type_of_quantity(const quantity *q)
{
    switch (q->type) {
    case QUANTITY_COUNT:
    case QUANTITY_NUMBER: return COUNTED;
    case QUANTITY_TRUTH: return SWITCH;
    case QUANTITY_REAL: return strcmp(q->unit, "s") == 0 || strcmp(q->unit, "rays") == 0 ? POSITIVE : REAL;
    case QUANTITY_HASH: return HASHED;
    case QUANTITY_DEPTHS: return LISTED;
    case QUANTITY_COLOR:
    case QUANTITY_WORD:
    case QUANTITY_SOLIDS: break;
    }
    return ANY;
}

static column_type type_of(const char *name, row_kind kind)
{
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strcmp(own[i].name, name) == 0)
            return own[i].type;
    if (strncmp(name, "first_hits.", 11) == 0 || strncmp(name, "hits.", 5) == 0)
        return COUNTED;
    const quantity *q = kind == ROWS ? frame_quantity(name) : NULL;
    for (size_t i = 0; kind == WORKER_ROWS && i < worker_quantity_count; i++)
        if (strcmp(worker_quantities[i].name, name) == 0)
            q = &worker_quantities[i];
    return q && q->column ? type_of_quantity(q) : ANY;
}

status row_types_create(char *const *names, size_t count, row_kind kind, row_types *out, diagnostic *why)
{
    *out = (row_types){malloc(count + 1), count};
    if (!out->type)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        out->type[i] = (unsigned char)type_of(names[i], kind);
    return STATUS_OK;
}

void row_types_free(row_types *t)
{
    free(t->type);
    *t = (row_types){0};
}

static bool is_list(const char *text)
{
    return text[0] && text[strspn(text, "0123456789;")] == 0 && text[0] != ';' && text[strlen(text) - 1] != ';';
}

static bool fits(column_type type, const char *text)
{
    int64_t count;
    double real;
    if (type == ANY || strcmp(text, "NA") == 0)
        return true;
    switch (type) {
    case COUNTED: return number_parse_int(text, &count) && count >= 0;
    case SWITCH: return strcmp(text, "0") == 0 || strcmp(text, "1") == 0;
    case REAL: return number_parse_real(text, &real);
    case POSITIVE: return number_parse_real(text, &real) && real >= 0;
    case HASHED: return strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16;
    case LISTED: return is_list(text);
    case TIME: return strlen(text) >= 20 && strspn(text, "0123456789-:.TZ") == strlen(text);
    case ANY: break;
    }
    return true;
}

bool row_types_fit(const row_types *t, char *const *fields, size_t *column)
{
    for (*column = 0; *column < t->count; ++*column)
        if (!fits((column_type)t->type[*column], fields[*column]))
            return false;
    return true;
}
