#include "study/accepted.h"
#include "base/hash.h"
#include "base/text.h"
#include "study/definition_v1.h"
#include "study/grid.h"
#include "study/manifest.h"
#include "study/meaning.h"
#include "study/read_grid.h"
#include "study/reference.h"
#include "scene/model/open.h"
#include "scene/file/document.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void accepted_start(accepted *a, const study *s, const char *folder)
{
    *a = (accepted){.s = s, .folder = folder};
}

static void accept(accepted *a, uint64_t definition)
{
    a->older[a->count++] = definition;
}

static status read_parts(study *s, const document *d, const void *scene_text, diagnostic *why)
{
    const node *root = document_root(d);
    const node *name = root && root->kind == NODE_MAP ? node_get(root, "study") : NULL;
    if (!name || name->kind != NODE_SCALAR)
        return diagnose(why, STATUS_BAD_INPUT, "", "it is not a study");
    s->name = strdup(name->text);
    status code =
        s->name ? scene_read_text(s->scene_path, scene_text, strlen(scene_text), &s->base, why) : out_of_memory(why);
    THEN(code, read_grid(s, d, node_get(root, "set"), node_get(root, "grid"), why));
    return code == STATUS_OK ? read_reference(s, d, node_get(root, "reference"), why) : code;
}

/* Builds a study from the texts recorded in a manifest. Its scene is placed in the folder of the current scene file, so
 * that relative file names resolve as before. Nothing is opened, loaded or checked beyond parsing; use it only for
 * meaning_of_study. */
static status recorded_study(const study *now, const char *text, const char *scene_text, study **out, diagnostic *why)
{
    *out = NULL;
    study *s = calloc(1, sizeof *s);
    if (s && (s->path = strdup(now->path)) && (s->scene_path = strdup(now->scene_path)))
        return study_parse(s, text, strlen(text), read_parts, scene_text, out, why);
    study_destroy(s);
    return out_of_memory(why);
}

/* Whether the recorded texts have the same meaning as the study. A difference is described in why_not. */
static bool means_the_same(accepted *a, const manifest_study *recorded)
{
    diagnostic why = {.what = ""};
    study *then = NULL;
    meaning there = {0}, here = {0};
    bool same = false;
    if (recorded_study(a->s, recorded->text, recorded->scene_text, &then, &why) != STATUS_OK)
        snprintf(a->why_not, sizeof a->why_not, "the manifest's study cannot be read by this program: %.200s",
                 why.what);
    else if (meaning_of_study(&there, then) == STATUS_OK && meaning_of_study(&here, a->s) == STATUS_OK)
        same = !meaning_difference(&there, &here, a->why_not, sizeof a->why_not);
    meaning_free(&there);
    meaning_free(&here);
    study_destroy(then);
    return same;
}

/* Whether the contents of the scene's files are unchanged. Their names alone do not show that. */
static bool files_are_the_same(accepted *a, const manifest_study *recorded)
{
    uint64_t now = HASH_START;
    grid_hash_files(&now, a->s->base);
    if (now == HASH_START || (recorded->has_files && recorded->files == now))
        return true;
    snprintf(a->why_not, sizeof a->why_not, "%s",
             recorded->has_files
                 ? "the contents of a mesh, texture, sky or script of the scene have changed"
                 : "the manifest does not record the contents of the scene's meshes, textures, sky and scripts");
    return false;
}

static void look_into_manifest(accepted *a, const char *path)
{
    manifest_study recorded;
    diagnostic why = {.what = ""};
    if (access(path, F_OK) != 0) {
        snprintf(a->why_not, sizeof a->why_not, "there is no manifest.json next to them that defines them");
        return;
    }
    if (manifest_read(path, scene_root(a->s->base), &recorded, &why) != STATUS_OK) {
        snprintf(a->why_not, sizeof a->why_not, "%.300s", why.what);
        return;
    }
    if (means_the_same(a, &recorded) && files_are_the_same(a, &recorded)) {
        accept(a, recorded.definition);
        snprintf(a->why_not, sizeof a->why_not,
                 "their fingerprint differs from that in the manifest.json next to them");
    }
    manifest_study_free(&recorded);
}

static void look(accepted *a)
{
    uint64_t earlier;
    a->looked = true;
    if (definition_v1(a->s, &earlier))
        accept(a, earlier);
    char *path = text_format("%s/manifest.json", a->folder);
    if (path)
        look_into_manifest(a, path);
    free(path);
}

static bool is(const accepted *a, const char *text, uint64_t definition, bool of_comparison)
{
    char own[17];
    snprintf(own, sizeof own, "%016" PRIx64, of_comparison ? reference_definition(a->s, definition) : definition);
    return strcmp(own, text) == 0;
}

bool accepted_has(accepted *a, const char *definition, bool of_comparison)
{
    if (is(a, definition, a->s->definition_hash, of_comparison))
        return true;
    if (!a->looked)
        look(a);
    for (size_t i = 0; i < a->count; i++)
        if (is(a, definition, a->older[i], of_comparison))
            return true;
    return false;
}

const char *accepted_why_not(const accepted *a)
{
    return a->why_not;
}
