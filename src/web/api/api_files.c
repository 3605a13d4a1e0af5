/* API: the files of the folder, opening and saving scenes, the media catalogue. */
#include "web/api/api.h"
#include "base/json_build.h"
#include "scene/model/open.h"
#include "report/json.h"
#include "report/media_rows.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The path from the scene's folder to the chosen folder; NULL when out of memory. */
static char *prefix_of(const lab *l)
{
    static const char any[] = "name";
    scene *s = scene_document_take(l->scene_document, NULL);
    char *path = NULL;
    const status code = s ? folder_path_from(l->files, any, scene_path(s), &path, NULL) : STATUS_FAILURE;
    scene_destroy(s);
    if (code == STATUS_OK)
        path[strlen(path) - strlen(any)] = 0;
    return path;
}

status api_files(call *c)
{
    json_t *all = NULL;
    char *prefix = prefix_of(c->l);
    status code = prefix ? STATUS_OK : out_of_memory(&c->why);
    THEN(code, folder_json(c->l->files, &all, &c->why));
    if (code == STATUS_OK)
        json_add_as(&all, "prefix", json_of_text(prefix));
    free(prefix);
    return code == STATUS_OK ? api_reply_json(c, all) : code;
}

status api_media(call *c)
{
    return api_reply_json(c, media_rows_json(NULL, NULL, 0.0));
}

/* --- opening --- */

/* Reads a scene; 404 for a valid name without a file. */
static status read_scene(call *c, const char *name, scene **out)
{
    const folder *files = c->l->files;
    char *path = NULL;
    status code = folder_path(files, name, true, &path, &c->why);
    if (code == STATUS_OK)
        code = scene_read_below(path, folder_real(files), out, &c->why);
    else if (code == STATUS_BAD_INPUT && folder_path(files, name, false, &path, NULL) == STATUS_OK)
        c->refused = 404;
    free(path);
    return code;
}

status api_open(call *c)
{
    const char *name = NULL, *link = NULL;
    bool fresh = false;
    scene *s = NULL;
    uint64_t generation = 0;
    if (!api_take_flag(c, "new", &fresh) || !api_take_text(c, "link", false, &link) ||
        !api_take_text(c, "file", !fresh && !link, &name))
        return STATUS_BAD_INPUT;
    if (fresh + (name != NULL) + (link != NULL) > 1)
        return api_refuse(c, 400, "'file', 'new' and 'link' cannot be combined", "give only one of them");
    if (link && !shared_is_link(link))
        return api_refuse(c, 400, "the link holds no scene", "give a link with #scene=CODE");
    TRY(fresh ? new_scene(&s, &c->why) : link ? shared_read_link(link, &s, &c->why) : read_scene(c, name, &s));
    lab_set_default_threads(c->l, s);
    const char *file = name && lab_is_scene_name(name) ? name : NULL; /* no saving into an image */
    status code = scene_document_open(c->l->scene_document, s, file, &generation, &c->why);
    return api_changed(c, code, generation);
}

/* --- saving --- */

/* Whether the file is the open scene document. */
static bool is_open(const call *c, const char *name)
{
    char *file = api_document_file(c);
    const bool same = file && strcmp(file, name) == 0;
    free(file);
    return same;
}

static status write_file(call *c, const char *name, const char *path)
{
    uint64_t generation = 0, version = 0;
    scene *s = scene_document_take_kept(c->l->scene_document, &generation, &version);
    if (s)
        lab_clear_default_threads(c->l, s);
    const status code = s ? scene_write(s, path, false, &c->why) : out_of_memory(&c->why);
    scene_destroy(s);
    if (code == STATUS_OK)
        scene_document_saved(c->l->scene_document, name, version);
    return api_changed(c, code, generation);
}

status api_save(call *c)
{
    const char *name = NULL;
    char *path = NULL;
    bool replace = false;
    if (!api_take_text(c, "file", true, &name) || !api_take_flag(c, "replace", &replace))
        return STATUS_BAD_INPUT;
    status code = folder_path(c->l->files, name, false, &path, &c->why);
    if (code == STATUS_OK && !lab_is_scene_name(name))
        code =
            diagnose(&c->why, STATUS_BAD_INPUT, "use a name that ends in .yaml and has no part that begins with a dot",
                     "'%.200s' is not a valid scene name", name);
    else if (code == STATUS_OK && !replace && access(path, F_OK) == 0 && !is_open(c, name))
        code = api_refuse(c, 409, "the file already exists", "choose another name, or set 'replace'");
    else if (code == STATUS_OK)
        code = write_file(c, name, path);
    free(path);
    return code;
}
