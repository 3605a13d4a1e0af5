/* json_get FILE PATH...: the values at each path of a JSON file, one a line; "-" reads standard input, no path only
 * checks the file. Fails (1) when the file is not JSON, has a key twice, or lacks a path.
 *
 *   rays.camera  threads[0].tiles  params["render.depth"]     a value: text as it is, lists and objects as JSON
 *   threads[].rays                                            of every element
 *   traceEvents[ph=X].dur                                     of the elements whose ph is X
 *   first_hits@keys  rays_by_depth@length  hardware@type      about a value */
#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const types[] = {"object", "array", "string", "integer", "real", "true", "false", "null"};

/* A real with the fewest digits that read back as the same. */
static char *text_of(const json_t *value)
{
    char *text = NULL;
    if (json_is_string(value))
        return strdup(json_string_value(value));
    for (int digits = 15; digits <= 17; digits++) {
        free(text);
        text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION((size_t)digits));
        if (!json_is_real(value) || (text && strtod(text, NULL) == json_real_value(value)))
            break;
    }
    return text;
}

static bool print(const json_t *value)
{
    char *text = text_of(value);
    if (text)
        puts(text);
    free(text);
    return text != NULL;
}

static bool print_about(json_t *value, const char *what)
{
    const char *key;
    json_t *member;
    if (strcmp(what, "length") == 0)
        return printf("%zu\n", json_is_array(value) ? json_array_size(value) : json_object_size(value)) > 0;
    if (strcmp(what, "type") == 0)
        return puts(types[json_typeof(value)]) >= 0;
    if (strcmp(what, "keys") != 0 || !json_is_object(value))
        return false;
    json_object_foreach(value, key, member) puts(key);
    return true;
}

static bool fits(const json_t *element, const char *condition, size_t size)
{
    char name[64];
    const char *equals = memchr(condition, '=', size);
    if (!equals || (size_t)(equals - condition) >= sizeof name)
        return size == 0;
    snprintf(name, sizeof name, "%.*s", (int)(equals - condition), condition);
    const json_t *member = json_object_get(element, name);
    char *text = member ? text_of(member) : NULL;
    size_t length = size - (size_t)(equals + 1 - condition);
    bool same = text && strlen(text) == length && memcmp(text, equals + 1, length) == 0;
    free(text);
    return same;
}

static bool get(json_t *value, const char *path);

/* The part of a path after its '['. */
static bool get_element(json_t *value, const char *path)
{
    char *end;
    if (path[0] == '"') { /* ["a key with dots"] */
        const char *close = strstr(path + 1, "\"]");
        json_t *member = close ? json_object_getn(value, path + 1, (size_t)(close - path - 1)) : NULL;
        return member && get(member, close + 2);
    }
    size_t size = strcspn(path, "]"), index = strtoul(path, &end, 10);
    if (!path[size] || !json_is_array(value))
        return false;
    if (size > 0 && end == path + size)
        return get(json_array_get(value, index), end + 1);
    bool found = true;
    for (index = 0; index < json_array_size(value); index++)
        if (fits(json_array_get(value, index), path, size))
            found = get(json_array_get(value, index), path + size + 1) && found;
    return found;
}

static bool get(json_t *value, const char *path)
{
    if (!value || !path[0])
        return value && print(value);
    if (path[0] == '[')
        return get_element(value, path + 1);
    if (path[0] == '@')
        return print_about(value, path + 1);
    path += path[0] == '.';
    size_t size = strcspn(path, ".[@");
    return get(json_object_getn(value, path, size), path + size);
}

int main(int argc, char **argv)
{
    if (argc < 2)
        return 1;
    json_error_t error;
    const size_t flags = JSON_REJECT_DUPLICATES | JSON_DECODE_ANY;
    bool is_stdin = strcmp(argv[1], "-") == 0;
    json_t *root = is_stdin ? json_loadf(stdin, flags, &error) : json_load_file(argv[1], flags, &error);
    if (!root) {
        fprintf(stderr, "%s:%d:%d: %s\n", argv[1], error.line, error.column, error.text);
        return 1;
    }
    bool found = true;
    for (int i = 2; i < argc; i++)
        if (!get(root, argv[i])) {
            fprintf(stderr, "%s: nothing at %s\n", argv[1], argv[i]);
            found = false;
        }
    json_decref(root);
    return found ? 0 : 1;
}
