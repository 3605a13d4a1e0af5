/* The JSON writer, and the conversion of reals, texts and diagnostics to jansson values. */
#include "report/json.h"
#include "base/cancel.h"
#include "base/json_build.h"
#include "base/number.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *json_of_real(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_of_count(int64_t value)
{
    return value == -1 ? json_null() : json_integer(value);
}

json_t *json_of_text(const char *text)
{
    json_t *value = json_string(text);
    if (value)
        return value;
    char *plain = strdup(text);
    for (char *c = plain; c && *c; c++)
        if ((unsigned char)*c >= 0x80)
            *c = '?';
    value = plain ? json_string(plain) : NULL;
    free(plain);
    return value;
}

static void write_real(FILE *stream, double value)
{
    char text[NUMBER_TEXT_MAX];
    number_format(value, text);
    /* ".0" keeps a real from reading back as an integer. */
    fprintf(stream, "%s%s", text, strpbrk(text, ".e") ? "" : ".0");
}

static bool write_value(FILE *stream, const json_t *value, int indent);

static bool write_text(FILE *stream, const char *text)
{
    json_t *value = json_string(text);
    char *quoted = value ? json_text(value, JSON_ENCODE_ANY) : NULL;
    json_decref(value);
    if (quoted)
        fputs(quoted, stream);
    free(quoted);
    return quoted != NULL;
}

json_t *json_of_diagnostic(const diagnostic *why)
{
    json_t *object = json_pack("{s:o, s:o}", "error", json_of_text(why->what), "remedy", json_of_text(why->remedy));
    if (object && why->file[0])
        json_add_as(&object, "file", json_of_text(why->file));
    if (object && why->line > 0)
        json_add_as(&object, "line", json_integer(why->line));
    if (object && why->column > 0)
        json_add_as(&object, "column", json_integer(why->column));
    return object;
}

bool json_write_text(FILE *stream, const char *text)
{
    json_t *value = json_of_text(text);
    bool good = value && write_text(stream, json_string_value(value));
    json_decref(value);
    return good;
}

void json_write_real(FILE *stream, double value)
{
    char text[NUMBER_TEXT_MAX];
    const bool is_digit = value >= 0.0 && value <= 9.0 && floor(value) == value && !signbit(value);
    if (is_digit) /* zeros and ones dominate large ray trees; this needs a tenth of the time of printf */
        fputc('0' + (int)value, stream);
    else
        fputs(isfinite(value) ? number_format_digits(value, 17, text) : "null", stream);
}

static bool is_flat(const json_t *list)
{
    size_t i;
    json_t *item;
    json_array_foreach(list, i, item) if (json_is_array(item) || json_is_object(item)) return false;
    return true;
}

static bool write_list(FILE *stream, const json_t *list, int indent)
{
    size_t i;
    json_t *item;
    bool flat = is_flat(list), good = true;
    fputc('[', stream);
    json_array_foreach(list, i, item)
    {
        fputs(i ? "," : "", stream);
        if (flat)
            fputs(i ? " " : "", stream);
        else
            fprintf(stream, "\n%*s", indent + 2, "");
        good = write_value(stream, item, indent + 2) && good;
    }
    if (!flat)
        fprintf(stream, "\n%*s", indent, "");
    fputc(']', stream);
    return good;
}

static bool write_object(FILE *stream, json_t *object, int indent)
{
    const char *key;
    json_t *value;
    bool good = true, first = true;
    fputc('{', stream);
    json_object_foreach(object, key, value)
    {
        fprintf(stream, "%s\n%*s", first ? "" : ",", indent + 2, "");
        good = write_text(stream, key) && good;
        fputs(": ", stream);
        good = write_value(stream, value, indent + 2) && good;
        first = false;
    }
    if (!first)
        fprintf(stream, "\n%*s", indent, "");
    fputc('}', stream);
    return good;
}

static bool write_value(FILE *stream, const json_t *value, int indent)
{
    if (cancel_asked())
        return false;
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        /* jansson iterates only over non-const objects; the object is not modified */
        return write_object(stream, (json_t *)(uintptr_t)value, indent);
    case JSON_ARRAY: return write_list(stream, value, indent);
    case JSON_STRING: return write_text(stream, json_string_value(value));
    case JSON_INTEGER: fprintf(stream, "%" JSON_INTEGER_FORMAT, json_integer_value(value)); return true;
    case JSON_REAL: write_real(stream, json_real_value(value)); return true;
    case JSON_TRUE: fputs("true", stream); return true;
    case JSON_FALSE: fputs("false", stream); return true;
    case JSON_NULL: fputs("null", stream); return true;
    }
    return false;
}

status json_write(FILE *stream, const json_t *value, diagnostic *why)
{
    bool good = value && write_value(stream, value, 0);
    fputc('\n', stream);
    TRY(cancel_check(why));
    return good ? STATUS_OK : diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory while writing JSON");
}

status json_put(FILE *stream, json_t *value, diagnostic *why)
{
    const status result = json_write(stream, value, why);
    json_decref(value);
    return result;
}

status json_print(json_t *value, diagnostic *why)
{
    return json_put(stdout, value, why);
}

json_t *json_if(json_t *value, bool good)
{
    if (good)
        return value;
    json_decref(value);
    return NULL;
}
