/* Errors of the public interface: statuses, diagnostics, NULL arguments, sizes of structs. */
#include "engine/engine_private.h"

#include <stdio.h>
#include <string.h>

#define TEXT_OF(number) #number
#define VERSION_TEXT(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

const char *cuvette_version(void)
{
    return VERSION_TEXT(CUVETTE_VERSION_MAJOR, CUVETTE_VERSION_MINOR, CUVETTE_VERSION_PATCH);
}

_Static_assert((int)CUVETTE_DIAGNOSTIC_TEXT_MAX == (int)DIAGNOSTIC_TEXT_MAX, "both text limits are equal");
_Static_assert(sizeof(((cuvette_diagnostic *)0)->what) == sizeof(((diagnostic *)0)->what), "texts are not truncated");
_Static_assert(sizeof(((cuvette_diagnostic *)0)->remedy) == sizeof(((diagnostic *)0)->remedy),
               "texts are not truncated");
_Static_assert(sizeof(((cuvette_diagnostic *)0)->file) == sizeof(((diagnostic *)0)->file), "texts are not truncated");

static void copy_out(const diagnostic *inner, cuvette_diagnostic *why)
{
    memcpy(why->file, inner->file, sizeof why->file);
    memcpy(why->what, inner->what, sizeof why->what);
    memcpy(why->remedy, inner->remedy, sizeof why->remedy);
    why->line = inner->line;
    why->column = inner->column;
}

cuvette_status engine_report(status code, const diagnostic *inner, cuvette_diagnostic *why)
{
    if (why && code != STATUS_OK)
        copy_out(inner, why);
    switch (code) {
    case STATUS_OK: return CUVETTE_OK;
    case STATUS_BAD_INPUT: return CUVETTE_BAD_INPUT;
    case STATUS_INTERRUPTED: return CUVETTE_CANCELLED;
    case STATUS_FAILURE: break;
    }
    return CUVETTE_FAILURE;
}

cuvette_status engine_missing(const char *name, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "pass the value that cuvette.h describes",
                                  "the argument '%s' is NULL", name),
                         &inner, why);
}

const char engine_list_end = 0;

cuvette_status engine_need(const char *names, const void *const *arguments, cuvette_diagnostic *why)
{
    char name[32];
    size_t missing = 0;
    while (arguments[missing] && arguments[missing] != &engine_list_end)
        missing++;
    if (arguments[missing])
        return CUVETTE_OK;
    for (; missing > 0; missing--)
        names += strcspn(names, ",") + strlen(", ");
    snprintf(name, sizeof name, "%.*s", (int)strcspn(names, ","), names);
    return engine_missing(strcmp(name, "s") == 0 ? "scene" : name, why);
}

cuvette_status engine_copy_struct(const void *content, size_t known, void *out, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    size_t size;
    memcpy(&size, out, sizeof size);
    if (size <= sizeof size || size > 65536)
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT,
                                      "set the struct's size field to its sizeof before the call",
                                      "the output struct has the invalid size %zu", size),
                             &inner, why);
    memset((char *)out + sizeof size, 0, size - sizeof size);
    memcpy((char *)out + sizeof size, (const char *)content + sizeof size, (size < known ? size : known) - sizeof size);
    return CUVETTE_OK;
}

char *cuvette_diagnostic_text(const cuvette_diagnostic *why, char *text, size_t size)
{
    if (!text || size == 0)
        return text;
    text[0] = '\0';
    if (!why)
        return text;
    diagnostic inner = {.line = why->line, .column = why->column};
    memcpy(inner.file, why->file, sizeof inner.file);
    memcpy(inner.what, why->what, sizeof inner.what);
    memcpy(inner.remedy, why->remedy, sizeof inner.remedy);
    return diagnostic_text(&inner, text, size);
}
