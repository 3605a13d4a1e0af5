#include "study/reference.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "study/grid.h"
#include "study/facts.h"
#include "study/quick.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

status reference_scene(const study *s, size_t cell, scene **out, diagnostic *why)
{
    status code = study_cell_scene(s, cell, out, why);
    if (code == STATUS_OK && (code = grid_set_point(*out, &s->reference, why)) != STATUS_OK) {
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
        scene_destroy(*out);
        *out = NULL;
    }
    if (code == STATUS_OK && s->quick)
        quick_frame(*out);
    return code;
}

static status check_cell(void *context, const study *s, size_t cell, scene *own, diagnostic *why)
{
    (void)context;
    scene *other = NULL;
    status code = reference_scene(s, cell, &other, why);
    THEN(code, grid_check_kept(s, &s->reference, other, why));
    if (code == STATUS_OK && (code = scene_check(other, why)) != STATUS_OK)
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
    if (code == STATUS_OK && (own->render.width != other->render.width || own->render.height != other->render.height)) {
        code = diagnose(why, STATUS_BAD_INPUT, "give them the same size",
                        "the reference has %" PRId64 "x%" PRId64 " pixels, the image of cell %zu %" PRId64 "x%" PRId64,
                        other->render.width, other->render.height, cell, own->render.width, own->render.height);
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
    }
    scene_destroy(other);
    return code;
}

status reference_check(const study *s, diagnostic *why)
{
    return s->reference.count ? grid_each_cell(s, check_cell, NULL, why) : STATUS_OK;
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

static uint64_t pixel_hash(const image *img)
{
    size_t count = (size_t)img->width * (size_t)img->height * 3;
    return hash_finish(hash_numbers(HASH_START, img->pixel, count, sizeof *img->pixel));
}

static status damaged(const char *path, diagnostic *why)
{
    return diagnose_at(why, path, STATUS_BAD_INPUT, "move it away: it will be rendered again",
                       "the reference is damaged");
}

static status load_facts(const char *path, const char *root, reference *out, uint64_t *pixels, diagnostic *why)
{
    json_t *facts;
    TRY(facts_read(path, root, &facts, why));
    const json_t *noise = json_object_get(facts, "noise_rms");
    facts_get_hash(facts, "film_hash", &out->film_hash);
    facts_get_hash(facts, "pixel_hash", pixels);
    out->noise_rms = json_is_number(noise) ? json_number_value(noise) : NAN;
    status code = noise ? STATUS_OK : damaged(path, why);
    json_decref(facts);
    return code;
}

status reference_load(const char *folder, const char *root, uint64_t scene_hash, reference *out, diagnostic *why)
{
    *out = (reference){.scene_hash = scene_hash};
    char *facts = file_path(folder, scene_hash, ".json"), *img = file_path(folder, scene_hash, ".pfm");
    uint64_t pixels = 0;
    status code = facts && img ? STATUS_OK : out_of_memory(why);
    /* The JSON file is written last: without it the image is ignored. */
    if (code == STATUS_OK && access(facts, F_OK) == 0 && access(img, F_OK) == 0) {
        code = load_facts(facts, root, out, &pixels, why);
        THEN(code, image_read_below(img, root, &out->img, NULL, why));
        if (code == STATUS_OK && pixel_hash(out->img) != pixels) {
            reference_release(out);
            code = damaged(img, why);
        }
    }
    free(facts);
    free(img);
    return code;
}

typedef struct visit_state {
    const scene *of;
    json_t *into;
} visit_state;

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    const visit_state *state = context;
    (void)row;
    return !scene_film_depends_on(state->of, path) || json_object_set_new(state->into, path, json_string(value)) == 0
               ? STATUS_OK
               : STATUS_FAILURE;
}

static status save_facts(const reference *of, const scene *setting, const char *path, diagnostic *why)
{
    json_t *params = json_object();
    visit_state state = {setting, params};
    status code = scene_each_param(setting, add_param, &state);
    json_t *facts = json_pack("{s:o, s:o, s:o, s:o}", "film_hash", facts_hash(of->film_hash), "noise_rms",
                              isnan(of->noise_rms) ? json_null() : json_real(of->noise_rms), "pixel_hash",
                              facts_hash(pixel_hash(of->img)), "parameters", params);
    code = code == STATUS_OK && facts ? facts_write(facts, 0, path, why) : out_of_memory(why);
    json_decref(facts);
    return code;
}

status reference_save(const study *s, const char *folder, const reference *of, const scene *setting, diagnostic *why)
{
    char *into = text_format("%s/references", folder);
    char *pfm = file_path(folder, of->scene_hash, ".pfm"), *png = file_path(folder, of->scene_hash, ".png");
    char *facts = file_path(folder, of->scene_hash, ".json");
    status code = into && pfm && png && facts ? file_make_directory(into, why) : out_of_memory(why);
    THEN(code, image_write(of->img, pfm, 8, why));
    if (code == STATUS_OK && s->keep_image)
        code = image_write(of->img, png, 8, why);
    THEN(code, save_facts(of, setting, facts, why));
    free(into);
    free(pfm);
    free(png);
    free(facts);
    return code;
}

void reference_release(reference *of)
{
    image_destroy(of->img);
    of->img = NULL;
}
