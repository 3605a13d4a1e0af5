#include "study/reference.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "study/grid.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FACTS_BYTES_MAX = 1 << 20 };

status reference_scene(const study *s, size_t cell, scene **out, diagnostic *why)
{
    status code = study_cell_scene(s, cell, out, why);
    if (code == STATUS_OK && (code = grid_set_point(*out, &s->reference, why)) != STATUS_OK) {
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}

static status check_cell(const study *s, size_t cell, diagnostic *why)
{
    scene *own = NULL, *other = NULL;
    status code = study_cell_scene(s, cell, &own, why);
    if (code == STATUS_OK)
        code = reference_scene(s, cell, &other, why);
    if (code == STATUS_OK)
        code = grid_check_kept(s, &s->reference, other, why);
    if (code == STATUS_OK && (code = scene_check(other, why)) != STATUS_OK)
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
    if (code == STATUS_OK && (own->render.width != other->render.width || own->render.height != other->render.height)) {
        code =
            diagnose(why, STATUS_BAD_INPUT, "let them have one size",
                     "the reference has %" PRId64 "x%" PRId64 " pixels, the picture of cell %zu %" PRId64 "x%" PRId64,
                     other->render.width, other->render.height, cell, own->render.width, own->render.height);
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
    }
    scene_destroy(own);
    scene_destroy(other);
    return code;
}

status reference_check(const study *s, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t cell = 0; code == STATUS_OK && s->reference.count && cell < study_cell_count(s); cell++)
        code = check_cell(s, cell, why);
    return code;
}

uint64_t reference_definition(const study *s, uint64_t definition)
{
    const int64_t word = (int64_t)definition;
    uint64_t hash = hash_words(HASH_START, &word, 1);
    grid_hash_point(&hash, &s->reference);
    return hash_finish(hash);
}

status reference_scene_hash(const scene *setting, uint64_t *hash)
{
    *hash = HASH_START;
    status code = grid_hash_scene(hash, setting, true);
    *hash = hash_finish(*hash);
    return code;
}

static char *file_path(const char *folder, uint64_t scene_hash, const char *ending)
{
    return text_format("%s/references/%016" PRIx64 "%s", folder, scene_hash, ending);
}

static uint64_t pixel_hash(const image *picture)
{
    size_t count = (size_t)picture->width * (size_t)picture->height * 3;
    return hash_finish(hash_bytes(HASH_START, picture->pixel, count * sizeof *picture->pixel));
}

static status damaged(const char *path, diagnostic *why)
{
    diagnostic_locate(why, path, 0, 0);
    return diagnose(why, STATUS_BAD_INPUT, "move it away: it is rendered again", "the reference is damaged");
}

/* 16 hex digits under a key; 0 when they are not there. */
static uint64_t get_hash(const json_t *facts, const char *key)
{
    const char *text = json_string_value(json_object_get(facts, key));
    return text ? strtoull(text, NULL, 16) : 0;
}

static status load_facts(const char *path, const char *root, reference *out, uint64_t *pixels, diagnostic *why)
{
    char *text;
    size_t size;
    status code = file_read_below(path, root, FACTS_BYTES_MAX, &text, &size, why);
    if (code != STATUS_OK)
        return code;
    json_t *facts = json_loadb(text, size, 0, NULL);
    free(text);
    const json_t *noise = json_object_get(facts, "noise_rms");
    out->film_hash = get_hash(facts, "film_hash");
    out->noise_rms = json_is_number(noise) ? json_number_value(noise) : NAN;
    *pixels = get_hash(facts, "pixel_hash");
    code = json_is_object(facts) && noise ? STATUS_OK : damaged(path, why);
    json_decref(facts);
    return code;
}

status reference_load(const char *folder, const char *root, uint64_t scene_hash, reference *out, diagnostic *why)
{
    *out = (reference){.scene_hash = scene_hash};
    char *facts = file_path(folder, scene_hash, ".json"), *picture = file_path(folder, scene_hash, ".pfm");
    uint64_t pixels = 0;
    status code = facts && picture ? STATUS_OK : out_of_memory(why);
    /* The facts are written last: without them the picture is not believed. */
    if (code == STATUS_OK && access(facts, F_OK) == 0 && access(picture, F_OK) == 0) {
        code = load_facts(facts, root, out, &pixels, why);
        if (code == STATUS_OK)
            code = image_read_below(picture, root, &out->picture, NULL, why);
        if (code == STATUS_OK && pixel_hash(out->picture) != pixels) {
            reference_release(out);
            code = damaged(picture, why);
        }
    }
    free(facts);
    free(picture);
    return code;
}

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    return row->is_how || json_object_set_new(context, path, json_string(value)) == 0 ? STATUS_OK : STATUS_FAILURE;
}

static json_t *hash_text(uint64_t value)
{
    return json_sprintf("%016" PRIx64, value);
}

static status save_facts(const reference *of, const scene *setting, const char *path, diagnostic *why)
{
    json_t *params = json_object();
    status code = scene_each_param(setting, add_param, params);
    json_t *facts = json_pack("{s:o, s:o, s:o, s:o}", "film_hash", hash_text(of->film_hash), "noise_rms",
                              isnan(of->noise_rms) ? json_null() : json_real(of->noise_rms), "pixel_hash",
                              hash_text(pixel_hash(of->picture)), "parameters", params);
    char *text = code == STATUS_OK && facts ? json_dumps(facts, JSON_INDENT(2)) : NULL;
    json_decref(facts);
    if (!text)
        return out_of_memory(why);
    file_writer writer;
    code = file_writer_open(&writer, path, why);
    if (code == STATUS_OK) {
        fprintf(writer.stream, "%s\n", text);
        code = file_writer_commit(&writer, why);
    }
    free(text);
    return code;
}

status reference_save(const study *s, const char *folder, const reference *of, const scene *setting, diagnostic *why)
{
    char *into = text_format("%s/references", folder);
    char *pfm = file_path(folder, of->scene_hash, ".pfm"), *png = file_path(folder, of->scene_hash, ".png");
    char *facts = file_path(folder, of->scene_hash, ".json");
    status code = into && pfm && png && facts ? file_make_directory(into, why) : out_of_memory(why);
    if (code == STATUS_OK)
        code = image_write(of->picture, pfm, 8, why);
    if (code == STATUS_OK && s->keep_image)
        code = image_write(of->picture, png, 8, why);
    if (code == STATUS_OK)
        code = save_facts(of, setting, facts, why);
    free(into);
    free(pfm);
    free(png);
    free(facts);
    return code;
}

void reference_release(reference *of)
{
    image_destroy(of->picture);
    of->picture = NULL;
}
