/* Reads script files through the tree of scene/data/document.h. The grammar is in the header. Required: hands; in each
 * entry time_s and one act; in a grab also towards and reach. hand_script_add checks the sequence of acts. */
#include "base/number.h"
#include "scene/assets/slime.h"
#include "scene/data/document.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define FAR 1e6          /* the limit of positions in scene files */
#define TIME_S_MAX 86400 /* the limit of a slime's time_s */

typedef struct script_reader {
    const document *file;
    hand_script *script;
    diagnostic *why;
} script_reader;

static const char *const acts[] = {[HAND_GRAB] = "grab", [HAND_MOVE] = "move", [HAND_RELEASE] = "release"};
enum { ACT_COUNT = sizeof acts / sizeof *acts };

static const char *kind_name(const node *n)
{
    return n->kind == NODE_LIST ? "a list" : n->kind == NODE_MAP ? "a map" : "a word";
}

/* Reads a finite number from low to high, without quotes; label is used in messages. */
static status read_number(const script_reader *r, const char *label, const node *n, double low, double high,
                          double *out)
{
    char remedy[128];
    snprintf(remedy, sizeof remedy, "give a number %.0f..%.0f", low, high);
    if (n->kind != NODE_SCALAR)
        return node_error(r->file, n, r->why, remedy, "%s is %s", label, kind_name(n));
    if (!number_parse_real(n->text, out))
        return node_error(r->file, n, r->why, strchr(n->text, ',') ? "a decimal comma? write 1.5" : remedy,
                          "%s: '%.80s' is not a finite number", label, n->text);
    if (n->quoted)
        return node_error(r->file, n, r->why, "remove the quotes", "%s is text, but must be a number", label);
    if (*out < low || *out > high)
        return node_error(r->file, n, r->why, remedy, "%s: %.80s is out of range", label, n->text);
    return STATUS_OK;
}

static status read_vector(const script_reader *r, const char *label, const node *n, vec3 *out)
{
    static const char remedy[] = "give three numbers, such as [0, 1, -6]";
    if (n->kind != NODE_LIST)
        return node_error(r->file, n, r->why, remedy, "%s is %s", label, kind_name(n));
    if (n->count != 3)
        return node_error(r->file, n, r->why, remedy, "%s: %zu value%s instead of 3", label, n->count,
                          n->count == 1 ? "" : "s");
    double value[3];
    for (int i = 0; i < 3; i++) {
        char element[32];
        snprintf(element, sizeof element, "%s.%c", label, "xyz"[i]);
        TRY(read_number(r, element, n->items[i], -FAR, FAR, &value[i]));
    }
    *out = vec3_make(value[0], value[1], value[2]);
    return STATUS_OK;
}

static status read_grab(const script_reader *r, const node *entry, hand_key *key)
{
    const node *grab = node_get(entry, "grab"), *towards = node_get(entry, "towards"),
               *reach = node_get(entry, "reach");
    status code = read_vector(r, "grab", grab, &key->origin);
    if (code == STATUS_OK && !towards)
        return node_error(r->file, entry, r->why, "add the direction of the grab ray, such as 'towards: [0, 0, 1]'",
                          "the grab has a starting point but no direction");
    if (code == STATUS_OK && !reach)
        return node_error(r->file, entry, r->why, "add the radius of the grab, such as 'reach: 0.3'",
                          "the grab has no reach");
    THEN(code, read_vector(r, "towards", towards, &key->direction));
    if (code == STATUS_OK && !(vec3_dot(key->direction, key->direction) > 0.0))
        return node_error(r->file, towards, r->why, "give three numbers, not all 0", "towards: the direction is zero");
    THEN(code, read_number(r, "reach", reach, 0.0, FAR, &key->reach));
    if (code == STATUS_OK && !(key->reach > 0.0))
        return node_error(r->file, reach, r->why, "give a length greater than 0", "reach: must be above 0");
    return code;
}

static status read_release(const script_reader *r, const node *value)
{
    static const char *const words[] = {"on", "yes", "true"};
    bool is_on = false;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        is_on |= value->kind == NODE_SCALAR && strcmp(value->text, words[i]) == 0;
    return is_on ? STATUS_OK
                 : node_error(r->file, value, r->why, "write 'release: on'", "the only value of release is on");
}

/* Finds the only act of an entry. */
static status find_act(const script_reader *r, const node *entry, hand_act *out)
{
    int found = -1;
    for (int i = 0; i < ACT_COUNT; i++) {
        const node *act = node_get(entry, acts[i]);
        if (act && found >= 0)
            return node_error(r->file, act, r->why, "write one entry for each, with the same time_s",
                              "one entry has both %s and %s", acts[found], acts[i]);
        found = act ? i : found;
    }
    if (found < 0)
        return node_error(r->file, entry, r->why, "add one of grab, move and release",
                          "the entry has no grab, move or release");
    static const char *const grab_keys[] = {"towards", "reach"};
    for (size_t i = 0; i < 2 && found != HAND_GRAB; i++) {
        const node *stray = node_get(entry, grab_keys[i]);
        if (stray)
            return node_error(r->file, stray, r->why, "remove it", "%s is part of a grab, not of a %s", grab_keys[i],
                              acts[found]);
    }
    *out = (hand_act)found;
    return STATUS_OK;
}

static status read_act(const script_reader *r, const node *entry, hand_key *key)
{
    switch (key->act) {
    case HAND_GRAB: return read_grab(r, entry, key);
    case HAND_MOVE: return read_vector(r, "move", node_get(entry, "move"), &key->by);
    case HAND_RELEASE: break;
    }
    return read_release(r, node_get(entry, "release"));
}

static status read_key(const script_reader *r, const char *hand, const node *entry)
{
    static const char *const keys[] = {"time_s", "grab", "towards", "reach", "move", "release"};
    if (entry->kind != NODE_MAP)
        return node_error(r->file, entry, r->why, "write entries such as '- {time_s: 1.5, move: [0, 1, 0]}'",
                          "an entry of %.80s is not a map", hand);
    TRY(node_check_keys(r->file, entry, keys, sizeof keys / sizeof *keys, r->why));
    hand_key key = {.line = entry->line, .column = entry->column};
    const node *time = node_get(entry, "time_s");
    if (!time)
        return node_error(r->file, entry, r->why, "add the time in seconds, such as 'time_s: 0.5'",
                          "the entry has no time_s");
    TRY(read_number(r, "time_s", time, 0.0, TIME_S_MAX, &key.time_s));
    TRY(find_act(r, entry, &key.act));
    TRY(read_act(r, entry, &key));
    status code = hand_script_add(r->script, hand, &key, r->why);
    if (code == STATUS_BAD_INPUT)
        diagnostic_locate(r->why, document_name(r->file), entry->line, entry->column);
    return code;
}

static status read_hand(const script_reader *r, const node *name, const node *track)
{
    if (track->kind != NODE_LIST || track->count == 0)
        return node_error(r->file, track->kind == NODE_LIST ? track : name, r->why,
                          "add a list of entries below it, such as '- {time_s: 0.5, grab: ...}'",
                          "%.80s is not a list of entries", name->text);
    if (strlen(name->text) > HAND_NAME_MAX)
        return node_error(r->file, name, r->why, "use at most 63 bytes", "'%.80s' is not a valid name of a hand",
                          name->text);
    for (size_t i = 0; i < track->count; i++)
        TRY(read_key(r, name->text, track->items[i]));
    return STATUS_OK;
}

static status read_script(const script_reader *r)
{
    static const char *const keys[] = {"title", "hands"};
    const node *root = document_root(r->file);
    if (root->kind != NODE_MAP)
        return node_error(r->file, root, r->why,
                          "begin with 'hands:' and, on the next line, the indented name of a hand",
                          "this is not a script");
    TRY(node_check_keys(r->file, root, keys, sizeof keys / sizeof *keys, r->why));
    const node *title = node_get(root, "title"), *hands = node_get(root, "hands");
    if (title && (title->kind != NODE_SCALAR || !title->text[0]))
        return node_error(r->file, title, r->why, "write some words, or omit it", "title is %s",
                          title->kind == NODE_SCALAR ? "empty" : kind_name(title));
    if (!hands || hands->kind != NODE_MAP || hands->count == 0)
        return node_error(r->file, hands ? hands : root, r->why,
                          "write hands: and below it a name with a list of entries", "the script has no hands");
    for (size_t i = 0; i < hands->count; i++)
        TRY(read_hand(r, hands->keys[i], hands->items[i]));
    return STATUS_OK;
}

static status build_and_release(document *file, hand_script **out, diagnostic *why)
{
    script_reader r = {.file = file, .script = hand_script_create(document_name(file)), .why = why};
    const status code = r.script ? read_script(&r) : out_of_memory(why);
    document_destroy(file);
    if (code != STATUS_OK) {
        hand_script_destroy(r.script);
        return code;
    }
    *out = r.script;
    return STATUS_OK;
}

status script_read_below(const char *path, const char *root, hand_script **out, diagnostic *why)
{
    *out = NULL;
    document *file;
    TRY(document_read_below(path, root, &file, why));
    return build_and_release(file, out, why);
}

status script_read_text(const char *name, const char *text, size_t size, hand_script **out, diagnostic *why)
{
    *out = NULL;
    document *file;
    TRY(document_parse(name, text, size, &file, why));
    return build_and_release(file, out, why);
}
