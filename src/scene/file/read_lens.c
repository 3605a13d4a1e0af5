/* Reads the section lens_systems (read_lens.h):
 *
 *   lens_systems: {NAME: {file: PATH, glasses: PATH or [PATH, ...], position: [X, Y, Z], rotation: [X, Y, Z],
 *                  scale: S, priority: P, mount: SWITCH, screen: SWITCH}, ...}
 *
 * Instead of the file, `surfaces` may give a list of maps with the columns of a .csv lens file, next to the keys of
 * such a file (f_number, field_deg, ...). They become the text of such a file, so that there is one reader. */
#include "scene/file/read_lens.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/data/document.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { GLASS_FILES_MAX = 16, PLACE_KEYS = 9 };
static const char *const place_words[PLACE_KEYS] = {"file",  "surfaces", "glasses", "position", "rotation",
                                                    "scale", "priority", "mount",   "screen"};

typedef struct system_reader {
    const document *file;
    const lens_access *access;
    scene *s;
    const node *map;
    const char *name;
    char *glass[GLASS_FILES_MAX]; /* relative to the working folder */
    const char *relative[GLASS_FILES_MAX];
    size_t glasses;
    diagnostic *why;
} system_reader;

static status wrong(const system_reader *r, const node *at, const char *remedy, const char *what, const char *key)
{
    return node_error(r->file, at, r->why, remedy, "lens_systems: %.60s.%s %s", r->name, key, what);
}

/* --- numbers --- */

static status read_numbers(const system_reader *r, const char *key, size_t count, double *out)
{
    const node *n = node_get(r->map, key);
    for (size_t i = 0; n && i < count; i++) {
        const node *item = count == 1 ? n : n->kind == NODE_LIST && n->count == count ? n->items[i] : NULL;
        if (!item || item->kind != NODE_SCALAR || !number_parse_real(item->text, &out[i]))
            return wrong(r, n, count == 1 ? "give a number" : "give 3 numbers, such as [0, 0, 0]", "is not a number",
                         key);
    }
    return STATUS_OK;
}

static status read_switch(const system_reader *r, const char *key, bool *out)
{
    static const char *const words[] = {"off", "on", "no", "yes", "false", "true"};
    const node *n = node_get(r->map, key);
    if (!n)
        return STATUS_OK;
    for (size_t i = 0; n->kind == NODE_SCALAR && i < sizeof words / sizeof *words; i++)
        if (strcasecmp(n->text, words[i]) == 0) {
            *out = i % 2 == 1;
            return STATUS_OK;
        }
    return wrong(r, n, "give on or off", "is not a switch", key);
}

static status read_place(const system_reader *r, lens_placement *at)
{
    double p[3] = {0}, turn[3] = {0}, scale = 1.0, priority = 0.0;
    TRY(read_numbers(r, "position", 3, p));
    TRY(read_numbers(r, "rotation", 3, turn));
    TRY(read_numbers(r, "scale", 1, &scale));
    TRY(read_numbers(r, "priority", 1, &priority));
    TRY(read_switch(r, "mount", &at->mount));
    TRY(read_switch(r, "screen", &at->screen));
    if (!(scale > 0.0 && scale <= 1e6))
        return wrong(r, node_get(r->map, "scale"), "give a number above 0", "is out of range", "scale");
    if (!(priority >= -1e5 && priority <= 1e5))
        return wrong(r, node_get(r->map, "priority"), "give an integer from -100000 to 100000", "is out of range",
                     "priority");
    at->position = vec3_make(p[0], p[1], p[2]);
    at->rotation_deg = vec3_make(turn[0], turn[1], turn[2]);
    at->scale = scale;
    at->priority = (int64_t)priority;
    return STATUS_OK;
}

/* --- files --- */

static status check_access(const system_reader *r, const node *at, const char *key)
{
    return r->access->allowed ? STATUS_OK
                              : wrong(r, at, "write the scene with its solids first: cuvette scene FILE -o NEW.yaml",
                                      "names a file, which a scene without its own file cannot read", key);
}

static status add_glass_file(system_reader *r, const node *n)
{
    if (n->kind != NODE_SCALAR || !n->text[0] || r->glasses == GLASS_FILES_MAX)
        return wrong(r, n, "give the path of an .agf file, or a list of at most 16", "is not a file", "glasses");
    TRY(check_access(r, n, "glasses"));
    r->relative[r->glasses] = n->text;
    r->glass[r->glasses] = scene_file_path(r->s, n->text);
    return r->glass[r->glasses++] ? STATUS_OK : out_of_memory(r->why);
}

static status read_glasses(system_reader *r)
{
    const node *n = node_get(r->map, "glasses");
    if (n && n->kind != NODE_LIST)
        return add_glass_file(r, n);
    for (size_t i = 0; n && i < n->count; i++)
        TRY(add_glass_file(r, n->items[i]));
    return STATUS_OK;
}

static status read_file(const system_reader *r, const node *n, const lens_glasses *glasses, lens_prescription *out)
{
    if (n->kind != NODE_SCALAR || !n->text[0])
        return wrong(r, n, "give the path of a .zmx, .dat or .csv file", "is not a file", "file");
    TRY(check_access(r, n, "file"));
    char *path = scene_file_path(r->s, n->text);
    if (!path)
        return out_of_memory(r->why);
    diagnostic bad = {.what = ""};
    const status code = lens_file_read(path, glasses, out, &bad);
    free(path);
    return code == STATUS_OK ? code : scene_file_error(r->s, r->name, n->line, n->column, &bad, code, r->why);
}

/* --- surfaces --- */

/* The nodes by the lines of the text that is made of them. */
typedef struct table_text {
    FILE *out;
    const node *line[LENS_SURFACES_MAX + 64];
    size_t lines;
} table_text;

static void end_line(table_text *t, const node *of)
{
    fputc('\n', t->out);
    if (t->lines < sizeof t->line / sizeof *t->line)
        t->line[t->lines++] = of;
}

/* A cell must not divide the line. */
static status put_cell(const system_reader *r, table_text *t, const node *value)
{
    if (value->kind != NODE_SCALAR || strpbrk(value->text, ",\n\r"))
        return node_error(r->file, value, r->why, "give one number or word", "this is not a number or a word");
    const bool off = !value->quoted && (strcasecmp(value->text, "off") == 0 || strcasecmp(value->text, "no") == 0 ||
                                        strcasecmp(value->text, "false") == 0);
    fputs(off ? "0" : value->text, t->out);
    return STATUS_OK;
}

static status put_keys(const system_reader *r, table_text *t)
{
    for (size_t i = 0; i < r->map->count; i++) {
        const node *value = r->map->items[i];
        bool is_place = false;
        for (int k = 0; k < PLACE_KEYS; k++)
            is_place |= strcmp(r->map->keys[i]->text, place_words[k]) == 0;
        if (is_place)
            continue;
        fputs(r->map->keys[i]->text, t->out);
        for (size_t k = 0; k < (value->kind == NODE_LIST ? value->count : 1); k++) {
            fputc(',', t->out);
            TRY(put_cell(r, t, value->kind == NODE_LIST ? value->items[k] : value));
        }
        end_line(t, value);
    }
    return STATUS_OK;
}

static status put_surface(const system_reader *r, table_text *t, const node *of)
{
    if (of->kind != NODE_MAP)
        return node_error(r->file, of, r->why, "write {radius: R, thickness: T, medium: NAME, ...}",
                          "a surface is not a map");
    TRY(node_check_keys(r->file, of, lens_column_words, LENS_COLUMNS, r->why));
    for (size_t c = 0; c < LENS_COLUMNS; c++) {
        const node *value = node_get(of, lens_column_words[c]);
        if (c > 0)
            fputc(',', t->out);
        if (value)
            TRY(put_cell(r, t, value));
    }
    end_line(t, of);
    return STATUS_OK;
}

static status put_table(const system_reader *r, table_text *t, const node *list)
{
    TRY(put_keys(r, t));
    for (size_t c = 0; c < LENS_COLUMNS; c++)
        fprintf(t->out, "%s%s", c > 0 ? "," : "", lens_column_words[c]);
    end_line(t, list);
    for (size_t i = 0; i < list->count; i++)
        TRY(put_surface(r, t, list->items[i]));
    return STATUS_OK;
}

static status read_table(const system_reader *r, const node *list, const lens_glasses *glasses, lens_prescription *out)
{
    text_writer writer;
    table_text t = {.lines = 0};
    char *text;
    size_t size;
    if (list->kind != NODE_LIST || list->count > LENS_SURFACES_MAX)
        return wrong(r, list, "give a list of at most 200 surfaces", "is not a list of surfaces", "surfaces");
    TRY(text_writer_open(&writer, r->why));
    t.out = writer.stream;
    TRY(text_writer_end(&writer, put_table(r, &t, list), &text, &size, r->why));
    diagnostic bad = {.what = ""};
    const status code = lens_file_parse("surfaces.csv", text, size, glasses, out, &bad);
    free(text);
    if (code == STATUS_OK)
        return code;
    const node *at = bad.line >= 1 && (size_t)bad.line <= t.lines ? t.line[bad.line - 1] : list;
    return node_error(r->file, at, r->why, bad.remedy, "%.60s: %s", r->name, bad.what);
}

/* --- the section --- */

static status check_keys(const system_reader *r)
{
    const char *words[PLACE_KEYS + LENS_SCENE_KEYS];
    size_t count = 0;
    for (size_t i = 0; i < PLACE_KEYS; i++)
        words[count++] = place_words[i];
    for (size_t i = 0; i < LENS_SCENE_KEYS; i++)
        words[count++] = lens_key_words[i];
    TRY(node_check_keys(r->file, r->map, words, count, r->why));
    const node *table = node_get(r->map, "surfaces");
    if (!table == !node_get(r->map, "file"))
        return node_error(r->file, table ? table : r->map, r->why, "give one of them: file: PATH, or surfaces: [...]",
                          "lens_systems: %.60s has %s", r->name,
                          table ? "both a file and surfaces" : "neither a file nor surfaces");
    for (size_t i = 0; !table && i < r->map->count; i++)
        for (size_t k = 0; k < LENS_SCENE_KEYS; k++)
            if (strcmp(r->map->keys[i]->text, lens_key_words[k]) == 0)
                return wrong(r, r->map->keys[i], "set it in the lens file", "is given by the lens file",
                             lens_key_words[k]);
    return STATUS_OK;
}

/* Adds each part of the note to the scene's remarks. */
static status add_remarks(const system_reader *r, char *note)
{
    for (char *part = note; part && *part;) {
        char *end = strstr(part, "; ");
        if (end)
            *end = 0;
        char *all = text_format("%s%s: %s\n", r->s->remarks ? r->s->remarks : "", r->name, part);
        if (!all)
            return out_of_memory(r->why);
        free(r->s->remarks);
        r->s->remarks = all;
        part = end ? end + 2 : NULL;
    }
    return STATUS_OK;
}

static status read_system(system_reader *r, const node *key)
{
    lens_placement at = {.name = r->name, .mount = false, .screen = true};
    lens_prescription p = lens_prescription_empty();
    TRY(check_keys(r));
    TRY(read_place(r, &at));
    TRY(read_glasses(r));
    const lens_glasses there = {(const char *const *)r->glass, r->glasses, r->access->root, r->s},
                       written = {.file = r->relative, .count = r->glasses};
    const node *table = node_get(r->map, "surfaces");
    TRY(table ? read_table(r, table, &there, &p) : read_file(r, node_get(r->map, "file"), &there, &p));
    at.glasses = &written;
    status code = lens_add_to_scene(r->s, &p, &at, r->why);
    if (code != STATUS_OK)
        diagnostic_locate(r->why, document_name(r->file), key->line, key->column);
    THEN(code, add_remarks(r, p.note));
    lens_prescription_release(&p);
    return code;
}

/* Indices of prescriptions are relative to air: the scene is in air, unless its background names its surroundings. */
static status put_in_air(const document *file, scene *s, diagnostic *why)
{
    const node *around = node_get(document_root(file), "background");
    const bool named = around && around->kind == NODE_MAP && (node_get(around, "medium") || node_get(around, "ior"));
    return named ? STATUS_OK : scene_set(s, "background.medium", "air", why);
}

status read_lens_systems(const document *file, const lens_access *access, scene *s, const node *map, diagnostic *why)
{
    if (map->kind != NODE_MAP)
        return node_error(file, map, why, "write NAME: {file: PATH} below it", "lens_systems is not a map");
    TRY(put_in_air(file, s, why));
    for (size_t i = 0; i < map->count; i++) {
        system_reader r = {
            .file = file, .access = access, .s = s, .map = map->items[i], .name = map->keys[i]->text, .why = why};
        if (r.map->kind != NODE_MAP)
            return node_error(file, r.map, why, "write {file: PATH, position: [X, Y, Z]}",
                              "lens_systems: %.60s is not a map", r.name);
        status code = check_name(r.name, why);
        if (code != STATUS_OK)
            diagnostic_locate(why, document_name(file), map->keys[i]->line, map->keys[i]->column);
        THEN(code, read_system(&r, map->keys[i]));
        for (size_t k = 0; k < r.glasses; k++)
            free(r.glass[k]);
        TRY(code);
    }
    return STATUS_OK;
}
