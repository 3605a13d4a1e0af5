#include "study/recorded.h"
#include "scene/file/document.h"
#include "study/read_grid.h"
#include <stdlib.h>
#include <string.h>

static status read_parts(study *s, const document *d, const void *scene_text, diagnostic *why)
{
    const node *root = document_root(d);
    const node *name = root && root->kind == NODE_MAP ? node_get(root, "study") : NULL;
    if (!name || name->kind != NODE_SCALAR)
        return diagnose(why, STATUS_BAD_INPUT, "", "it is not a study");
    s->name = strdup(name->text);
    status code =
        s->name ? scene_read_text(s->scene_path, scene_text, strlen(scene_text), &s->base, why) : out_of_memory(why);
    if (code == STATUS_OK)
        code = read_grid(s, d, node_get(root, "set"), node_get(root, "grid"), why);
    return code == STATUS_OK ? read_reference(s, d, node_get(root, "reference"), why) : code;
}

status recorded_study(const study *now, const char *text, const char *scene_text, study **out, diagnostic *why)
{
    *out = NULL;
    study *s = calloc(1, sizeof *s);
    if (s && (s->path = strdup(now->path)) && (s->scene_path = strdup(now->scene_path)))
        return study_parse(s, text, strlen(text), read_parts, scene_text, out, why);
    study_destroy(s);
    return out_of_memory(why);
}
