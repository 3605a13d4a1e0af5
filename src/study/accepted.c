#include "study/accepted.h"
#include "base/hash.h"
#include "base/text.h"
#include "study/definition_v1.h"
#include "study/grid.h"
#include "study/identity.h"
#include "study/manifest.h"
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

void accepted_end(accepted *a)
{
    study_destroy(a->recorded);
    free(a->recorded_identity);
    a->recorded = NULL;
    a->recorded_identity = NULL;
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
 * its identities and its reference. */
static status recorded_study(const study *now, const char *text, const char *scene_text, study **out, diagnostic *why)
{
    *out = NULL;
    study *s = calloc(1, sizeof *s);
    if (s && (s->path = strdup(now->path)) && (s->scene_path = strdup(now->scene_path)))
        return study_parse(s, text, strlen(text), read_parts, scene_text, out, why);
    study_destroy(s);
    return out_of_memory(why);
}

/* Whether the contents of the scene's files are unchanged. Their names alone do not show that. */
static status compare_files(accepted *a, const manifest_study *recorded, bool *same, diagnostic *why)
{
    uint64_t now = HASH_START;
    TRY(grid_hash_files(&now, a->s->base, why));
    *same = now == HASH_START || (recorded->has_files && recorded->files == now);
    if (*same)
        return STATUS_OK;
    snprintf(a->why_not, sizeof a->why_not, "%s",
             recorded->has_files
                 ? "the contents of a mesh, texture, sky or script of the scene have changed"
                 : "the manifest does not record the contents of the scene's meshes, textures, sky and scripts");
    return STATUS_OK;
}

/* A manifest that cannot be used is a reason why the rows are not known; a machine that cannot read it is not. */
static status refuse(accepted *a, status code, const char *reason, const diagnostic *refused, diagnostic *why)
{
    if (code == STATUS_BAD_INPUT) {
        snprintf(a->why_not, sizeof a->why_not, "%s%.300s", reason, refused->what);
        return STATUS_OK;
    }
    if (why)
        *why = *refused;
    return code;
}

/* Reads the recorded study and the identities of its cells. */
static status look_into_texts(accepted *a, const manifest_study *m, diagnostic *why)
{
    diagnostic refused = {.what = ""};
    uint64_t files = HASH_START;
    status code = grid_hash_files(&files, a->s->base, &refused);
    THEN(code, recorded_study(a->s, m->text, m->scene_text, &a->recorded, &refused));
    THEN(code, identities_with_files(a->recorded, files, &a->recorded_identity, &refused));
    a->recorded_definition = m->definition;
    if (code != STATUS_OK)
        return refuse(a, code, "the manifest's study cannot be read by this program: ", &refused, why);
    snprintf(a->why_not, sizeof a->why_not, "their fingerprint differs from that in the manifest.json next to them");
    return STATUS_OK;
}

static status look_into_manifest(accepted *a, const char *path, diagnostic *why)
{
    manifest_study recorded;
    diagnostic refused = {.what = ""};
    bool same = false;
    if (access(path, F_OK) != 0) {
        snprintf(a->why_not, sizeof a->why_not, "there is no manifest.json next to them that defines them");
        return STATUS_OK;
    }
    status code = manifest_read(path, scene_root(a->s->base), &recorded, &refused);
    if (code != STATUS_OK)
        return refuse(a, code, "", &refused, why);
    code = compare_files(a, &recorded, &same, why);
    if (same)
        code = look_into_texts(a, &recorded, why);
    manifest_study_free(&recorded);
    return code;
}

static status look(accepted *a, diagnostic *why)
{
    a->looked = true;
    TRY(definition_v1(a->s, &a->has_v1, &a->v1, why));
    char *path = text_format("%s/manifest.json", a->folder);
    const status code = path ? look_into_manifest(a, path, why) : out_of_memory(why);
    free(path);
    return code;
}

static bool is(const study *s, const char *text, uint64_t definition, bool of_comparison)
{
    char own[17];
    snprintf(own, sizeof own, "%016" PRIx64, of_comparison ? reference_definition(s, definition) : definition);
    return strcmp(own, text) == 0;
}

static bool take(const study *s, const uint64_t *identity, size_t cell, bool of_comparison, uint64_t *out)
{
    if (cell >= study_cell_count(s))
        return false;
    *out = of_comparison ? identity_compared(s, identity[cell]) : identity[cell];
    return true;
}

status accepted_identity(accepted *a, const char *definition, size_t cell, bool of_comparison, uint64_t *identity,
                         bool *known, diagnostic *why)
{
    bool is_own = is(a->s, definition, a->s->definition_hash, of_comparison);
    if (!is_own && !a->looked)
        TRY(look(a, why));
    is_own |= a->has_v1 && is(a->s, definition, a->v1, of_comparison);
    if (is_own)
        *known = take(a->s, a->s->identity, cell, of_comparison, identity);
    else
        *known = a->recorded_identity && is(a->recorded, definition, a->recorded_definition, of_comparison) &&
                 take(a->recorded, a->recorded_identity, cell, of_comparison, identity);
    return STATUS_OK;
}

const char *accepted_why_not(const accepted *a)
{
    return a->why_not;
}
