#include "study/facts.h"
#include "base/file.h"
#include "base/json_build.h"
#include "base/text.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

json_t *facts_hash(uint64_t value)
{
    return json_sprintf("%016" PRIx64, value);
}

bool facts_get_hash(const json_t *facts, const char *key, uint64_t *out)
{
    const char *text = json_string_value(json_object_get(facts, key));
    const bool is_one = text && strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16;
    *out = is_one ? strtoull(text, NULL, 16) : 0;
    return is_one;
}

status facts_read(const char *path, const char *root, json_t **out, diagnostic *why)
{
    enum { FACTS_BYTES_MAX = 64 << 20 };
    char *text;
    size_t size;
    *out = NULL;
    TRY(file_read_below(path, root, FACTS_BYTES_MAX, &text, &size, why));
    json_error_t error;
    bool no_memory;
    *out = json_parse(text, size, 0, &error, &no_memory);
    free(text);
    if (!no_memory)
        return STATUS_OK;
    diagnostic_locate(why, path, 0, 0);
    return out_of_memory(why);
}

status facts_write(const json_t *facts, size_t flags, const char *path, diagnostic *why)
{
    /* jansson writes reals independently of the locale. */
    char *text = json_text(facts, JSON_INDENT(2) | flags), *line = text ? text_format("%s\n", text) : NULL;
    const status code = line ? file_write(path, line, why) : out_of_memory(why);
    free(line);
    free(text);
    return code;
}
