#include "scene/file/read_entries.h"
#include "scene/model/params_path.h"
#include "scene/model/params_value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status read_located(const scene_reader *r, const node *at, status code)
{
    if (code != STATUS_OK)
        diagnostic_locate(r->why, document_name(r->file), at->line, at->column);
    return code;
}

static bool is_empty(const node *n)
{
    return n->kind == NODE_SCALAR && !n->quoted && !n->text[0];
}

status read_expect_map(const scene_reader *r, const node *n, const char *name)
{
    if (n->kind == NODE_MAP || is_empty(n))
        return STATUS_OK;
    return node_error(r->file, n, r->why, "write indented lines 'key: value' below it",
                      "%.80s is not a map of keys and values", name);
}

status read_expect_word(const scene_reader *r, const node *n, const char *name)
{
    if (n->kind == NODE_SCALAR && n->text[0])
        return STATUS_OK;
    return node_error(r->file, n, r->why, "give one word", "%.80s is not a word", name);
}

static status check_value_kind(const scene_reader *r, const param *row, const char *path, const node *value)
{
    bool vector = row->type == PARAM_VECTOR || row->type == PARAM_COLOR || row->type == PARAM_LIST;
    bool number = row->type == PARAM_INT || row->type == PARAM_REAL;
    char remedy[420];
    param_remedy(row, false, remedy, sizeof remedy);
    if (value->kind == NODE_MAP || (value->kind == NODE_LIST && !vector))
        return node_error(r->file, value, r->why, remedy, "%.150s is a %s", path,
                          value->kind == NODE_MAP ? "map" : "list");
    if (value->quoted && number)
        return node_error(r->file, value, r->why, "remove the quotes", "%.150s is a text, but must be a number", path);
    return STATUS_OK;
}

static status read_value(const scene_reader *r, const char *path, const param *row, const node *value)
{
    TRY(check_value_kind(r, row, path, value));
    char *text = node_value_text(value);
    if (!text && node_is_value(value))
        return out_of_memory(r->why);
    if (!text)
        return node_error(r->file, value, r->why, row->type == PARAM_LIST ? "give plain numbers" : "give 3 numbers",
                          "%.150s contains something other than plain numbers", path);
    status code = read_located(r, value, scene_set(r->scene, path, text, r->why));
    free(text);
    return code;
}

status read_entries(const scene_reader *r, const char *name, param_group group, const node *map)
{
    for (size_t i = 0; i < map->count; i++) {
        const char *key = map->keys[i]->text;
        const param *row = param_find(group, key);
        if (!row)
            continue;
        char path[2 * SCENE_NAME_MAX + 2];
        snprintf(path, sizeof path, "%s.%s", name, key);
        param_place unused;
        TRY(read_located(r, map->keys[i], param_place_find(r->scene, path, &unused, r->why)));
        TRY(read_value(r, path, row, map->items[i]));
    }
    return STATUS_OK;
}

status read_one_medium(const scene_reader *r, const node *map)
{
    const node *ior = node_get(map, "ior"), *medium = node_get(map, "medium");
    if (ior && medium && strcmp(medium->text ? medium->text : "", "ior") != 0)
        return node_error(r->file, ior, r->why, "keep either the ior or the medium",
                          "both an ior and a medium are given");
    return STATUS_OK;
}

status read_check_keys(const scene_reader *r, param_group group, const node *map)
{
    enum { ROOM = 128 };
    const char *words[ROOM];
    size_t count = 0;
    if (group == PARAM_SOLID) {
        words[count++] = "shape";
        words[count++] = "material";
    }
    for (size_t i = 0; i < param_count() && count < ROOM; i++) {
        const param *row = param_at(i);
        if (row->group == group || (group == PARAM_SOLID && row->group == PARAM_MATERIAL))
            words[count++] = row->name;
    }
    return node_check_keys(r->file, map, words, count, r->why);
}
