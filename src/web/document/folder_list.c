/* Lists the files of the folder that the laboratory can open: classified by extension; scenes, hand scripts and optical
 * data, all YAML, by their keys; tables of lenses and of data by their header. Breadth-first, so that a large deep
 * folder cannot hide the files above it when a limit is reached. */
#include "base/array.h"
#include "base/json_build.h"
#include "base/status.h"
#include "base/text.h"
#include "scene/data/document.h"
#include "scene/lens/lens_prescription.h"
#include "web/document/folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { DEPTH_MAX = 3, ENTRIES_MAX = 50000, DOCUMENT_MAX = 1 << 20 };

typedef enum file_use {
    USE_SCENE,
    USE_MODEL,
    USE_IMAGE,
    USE_DATA,
    USE_LENS,
    USE_SCRIPT,
    USE_STUDY,
    USE_LESSON,
    USE_COUNT
} file_use;
static const char *const use_names[USE_COUNT] = {"scenes", "models",  "images",  "data",
                                                 "lenses", "scripts", "studies", "lessons"};

static const struct ending {
    const char *text;
    file_use use;
} endings[] = {
    {".yaml", USE_SCENE},    {".yml", USE_SCENE}, {".obj", USE_MODEL}, {".ply", USE_MODEL}, {".stl", USE_MODEL},
    {".gltf", USE_MODEL},    {".glb", USE_MODEL}, {".xyz", USE_MODEL}, {".png", USE_IMAGE}, {".jpg", USE_IMAGE},
    {".jpeg", USE_IMAGE},    {".pfm", USE_IMAGE}, {".bmp", USE_IMAGE}, {".hdr", USE_IMAGE}, {".exr", USE_IMAGE},
    {".agf", USE_DATA},      {".csv", USE_DATA},  {".tsv", USE_DATA},  {".txt", USE_DATA},  {".study", USE_STUDY},
    {".lesson", USE_LESSON}, {".zmx", USE_LENS},  {".dat", USE_LENS},
};

/* Names relative to the folder, owned. */
typedef struct names {
    char **name;
    size_t count, room;
} names;

typedef struct listing {
    const folder *root;
    names found[USE_COUNT], next; /* next: folders of the next level */
    json_t *unread;               /* errors of files whose kind had to be guessed; NULL: none */
    size_t files, entries;
    status code; /* not STATUS_OK: the list is incomplete, for the reason in *why */
    diagnostic *why;
} listing;

static void fail(listing *l, const diagnostic *reason)
{
    l->code = STATUS_FAILURE;
    if (l->why)
        *l->why = *reason;
}

static void fail_for_memory(listing *l)
{
    l->code = out_of_memory(l->why);
}

/* Whether the machine lacks memory or open files. An error of the file itself is shown when the file is opened. */
static bool is_shortage(const diagnostic *why)
{
    return strcmp(why->remedy, MEMORY_REMEDY) == 0 || strcmp(why->remedy, system_remedy(EMFILE)) == 0;
}

/* Takes ownership of the name. */
static void add_name(listing *l, names *list, char *name)
{
    if (!name || !GROW(list->name, list->room, list->count + 1)) {
        free(name);
        fail_for_memory(l);
        return;
    }
    list->name[list->count++] = name;
}

static void names_clear(names *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->name[i]);
    free(list->name);
    *list = (names){.name = NULL};
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void sort(const names *list)
{
    if (list->count > 1)
        qsort(list->name, list->count, sizeof *list->name, by_name);
}

static file_use use_by_ending(const char *name)
{
    const size_t length = strlen(name);
    const size_t packed = length > 3 && strcasecmp(name + length - 3, ".gz") == 0 ? 3 : 0;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const size_t size = strlen(endings[i].text) + packed;
        if (length >= size && strncasecmp(name + length - size, endings[i].text, size - packed) == 0 &&
            (!packed || (endings[i].use == USE_MODEL && strcmp(endings[i].text, ".xyz") != 0)))
            return endings[i].use;
    }
    return USE_COUNT;
}

static void note_unread(listing *l, const char *name, const diagnostic *why)
{
    json_t *one = json_object();
    json_add_as(&one, "file", json_string_nocheck(name));
    json_add_as(&one, "error", json_string_nocheck(why->what));
    if (!l->unread)
        l->unread = json_array();
    json_add(&l->unread, one);
    if (!l->unread)
        fail_for_memory(l);
}

/* Classifies a YAML file by its keys; a file that cannot be parsed is listed as a scene, so that opening it shows
 * the error. */
static file_use use_by_keys(listing *l, const char *name, const char *path)
{
    static const char *const scene_keys[] = {"solids",     "camera", "lights",    "render",
                                             "background", "meshes", "materials", "textures"};
    document *file;
    diagnostic why = {.what = ""};
    const status code = document_read_below(path, folder_real(l->root), &file, &why);
    if (code == STATUS_FAILURE && is_shortage(&why))
        fail(l, &why);
    else if (code == STATUS_FAILURE)
        note_unread(l, name, &why);
    if (code != STATUS_OK)
        return USE_SCENE;
    const node *root = document_root(file);
    file_use use = USE_COUNT;
    if (root->kind == NODE_MAP && node_get(root, "hands"))
        use = USE_SCRIPT;
    if (root->kind == NODE_MAP && node_get(root, "DATA"))
        use = USE_DATA;
    for (size_t i = 0; root->kind == NODE_MAP && use == USE_COUNT && i < sizeof scene_keys / sizeof *scene_keys; i++)
        use = node_get(root, scene_keys[i]) ? USE_SCENE : USE_COUNT;
    document_destroy(file);
    return use;
}

/* A table of a lens has the columns radius and thickness (scene/lens/lens_prescription.h). */
static file_use use_of_table(const char *path)
{
    char text[4096];
    FILE *f = fopen(path, "re");
    const size_t size = f ? fread(text, 1, sizeof text - 1, f) : 0;
    if (f)
        fclose(f);
    text[size] = 0;
    return strstr(text, "radius") && strstr(text, "thickness") ? USE_LENS : USE_DATA;
}

/* USE_COUNT: a file that is not listed. A link counts if it leads to a file inside the folder. */
static file_use use_of(listing *l, const char *name)
{
    file_use use = use_by_ending(name);
    char *path = NULL;
    struct stat about;
    if (use == USE_COUNT)
        return use;
    diagnostic why = {.what = ""};
    const status code = folder_path(l->root, name, true, &path, &why);
    if (code == STATUS_FAILURE)
        fail(l, &why);
    if (code != STATUS_OK)
        return USE_COUNT;
    if (use == USE_SCENE)
        use = stat(path, &about) == 0 && about.st_size <= DOCUMENT_MAX ? use_by_keys(l, name, path) : USE_COUNT;
    else if (use == USE_DATA && lens_file_named(name))
        use = use_of_table(path);
    free(path);
    return use;
}

/* Takes ownership of the name. */
static void classify_file(listing *l, char *name)
{
    const file_use use = use_of(l, name);
    if (use == USE_COUNT) {
        free(name);
        return;
    }
    l->files++;
    add_name(l, &l->found[use], name);
}

/* Whether the name is UTF-8; JSON cannot hold other names. */
static bool is_text(listing *l, const char *name)
{
    json_t *text = json_text_or_null(name);
    const bool valid = json_is_string(text);
    if (!text)
        fail_for_memory(l);
    json_decref(text);
    return valid;
}

/* Joins a folder's name, "" for the chosen folder, and a name in it. */
static char *join_path(const char *parent, const char *name)
{
    return text_format("%s%s%s", parent, *parent ? "/" : "", name);
}

/* Takes ownership of the name. Links to folders are not followed, so that no file is listed twice. */
static void visit_entry(listing *l, char *name)
{
    struct stat about;
    char *path = join_path(folder_root(l->root), name);
    const bool is_folder = path && lstat(path, &about) == 0 && S_ISDIR(about.st_mode);
    if (!path)
        fail_for_memory(l);
    free(path);
    if (is_folder)
        add_name(l, &l->next, name);
    else
        classify_file(l, name);
}

/* Reads all names of a folder before it visits any, so that the limit does not depend on the order of readdir. */
static void visit_folder(listing *l, const char *name)
{
    char *path = join_path(folder_root(l->root), name);
    DIR *d = path ? opendir(path) : NULL;
    diagnostic why = {.what = ""};
    if (!path)
        fail_for_memory(l);
    else if (!d && system_error(&why, STATUS_BAD_INPUT, path, "cannot be listed", errno, "") == STATUS_FAILURE)
        fail(l, &why); /* a lack of memory or open files must not look like an empty folder */
    free(path);
    names found = {.name = NULL};
    for (const struct dirent *e; d && l->code == STATUS_OK && l->entries < ENTRIES_MAX && (e = readdir(d));
         l->entries++)
        if (e->d_name[0] != '.' && is_text(l, e->d_name))
            add_name(l, &found, join_path(name, e->d_name));
    if (d)
        closedir(d);
    sort(&found);
    for (size_t i = 0; i < found.count && l->files < FOLDER_FILES_MAX; i++) {
        visit_entry(l, found.name[i]);
        found.name[i] = NULL;
    }
    names_clear(&found);
}

static json_t *listing_json(const listing *l)
{
    json_t *all = json_object();
    json_add_as(&all, "folder", json_string_nocheck(folder_title(l->root)));
    for (int use = 0; use < USE_COUNT; use++) {
        json_t *list = json_array();
        sort(&l->found[use]);
        for (size_t i = 0; i < l->found[use].count; i++)
            json_add(&list, json_string(l->found[use].name[i]));
        json_add_as(&all, use_names[use], list);
    }
    if (l->unread)
        json_add_as(&all, "unread", json_incref(l->unread));
    return all;
}

status folder_json(const folder *f, json_t **out, diagnostic *why)
{
    listing l = {.root = f, .why = why};
    visit_folder(&l, "");
    for (int depth = 1; depth <= DEPTH_MAX; depth++) {
        names level = l.next;
        l.next = (names){.name = NULL};
        for (size_t i = 0; i < level.count && l.files < FOLDER_FILES_MAX; i++)
            visit_folder(&l, level.name[i]);
        names_clear(&level);
    }
    *out = l.code == STATUS_OK ? listing_json(&l) : NULL;
    json_decref(l.unread);
    names_clear(&l.next);
    for (int use = 0; use < USE_COUNT; use++)
        names_clear(&l.found[use]);
    return *out || l.code != STATUS_OK ? l.code : out_of_memory(why);
}
