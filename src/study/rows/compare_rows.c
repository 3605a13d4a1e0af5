/* Stores reference images, compares each cell with its reference, and writes the rows of compare.csv. */
#include "study/rows/compare_rows.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"
#include "study/plan/identity.h"
#include "study/rows/facts.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

/* --- stored references --- */

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
        THEN(code, image_read_below(img, root, IMAGE_LIGHT, &out->img, NULL, why));
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
    const scene *s;
    json_t *params;
} visit_state;

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    const visit_state *state = context;
    (void)row;
    return !scene_film_depends_on(state->s, path) || json_object_set_new(state->params, path, json_string(value)) == 0
               ? STATUS_OK
               : STATUS_FAILURE;
}

static status save_facts(const reference *stored, const scene *setting, const char *path, diagnostic *why)
{
    json_t *params = json_object();
    visit_state state = {setting, params};
    status code = scene_each_param(setting, add_param, &state);
    json_t *facts = json_pack("{s:o, s:o, s:o, s:o}", "film_hash", facts_hash(stored->film_hash), "noise_rms",
                              isnan(stored->noise_rms) ? json_null() : json_real(stored->noise_rms), "pixel_hash",
                              facts_hash(pixel_hash(stored->img)), "parameters", params);
    code = code == STATUS_OK && facts ? facts_write(facts, 0, path, why) : out_of_memory(why);
    json_decref(facts);
    return code;
}

status reference_save(const study *s, const char *folder, const reference *stored, const scene *setting,
                      diagnostic *why)
{
    char *references = text_format("%s/references", folder);
    char *pfm = file_path(folder, stored->scene_hash, ".pfm"), *png = file_path(folder, stored->scene_hash, ".png");
    char *facts = file_path(folder, stored->scene_hash, ".json");
    status code = references && pfm && png && facts ? file_make_directory(references, why) : out_of_memory(why);
    THEN(code, image_write(stored->img, pfm, 8, why));
    if (code == STATUS_OK && s->keep_image)
        code = image_write(stored->img, png, 8, why);
    THEN(code, save_facts(stored, setting, facts, why));
    free(references);
    free(pfm);
    free(png);
    free(facts);
    return code;
}

void reference_release(reference *stored)
{
    image_destroy(stored->img);
    stored->img = NULL;
}

/* --- rows --- */

/* The root mean square over all channels of all pixels, linear and not clamped. */
static double difference_rms(const image *a, const image *b)
{
    size_t count = (size_t)a->width * (size_t)a->height * 3;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double difference = (double)a->pixel[i] - (double)b->pixel[i];
        sum += difference * difference;
    }
    return sqrt(sum / (double)count);
}

status compare_row_measure(compare_row *row, const render_result *frame, diagnostic *why)
{
    image *img = NULL;
    status code = film_image(frame->img, &img, why);
    THEN(code, image_compare(img, row->cell_reference->img, &row->difference, why));
    if (code == STATUS_OK) {
        row->error_rms = difference_rms(img, row->cell_reference->img);
        row->film_hash = film_hash(frame->img);
        row->noise_rms = render_noise_rms(frame);
    }
    image_destroy(img);
    return code;
}

/* The columns of compare.csv. The last macro argument uses line and r (the row). */
#define COMPARE_COLUMNS(X)                                                                                           \
    X("study", "", "name of the study", csv_text(line, r->s->name))                                                  \
    X("identity", "", "hash of the cell's identity in rows.csv and of the reference's parameters, 16 hex digits",    \
      csv_hash(line, identity_compared(r->s, r->s->identity[r->cell])))                                              \
    X("cell", "", "number of the grid point when it was compared, the last axis fastest",                            \
      csv_count(line, (int64_t)r->cell))                                                                             \
    X("<axis>", "of the parameter", "value of each parameter of the grid, in its order",                             \
      row_put_axes(line, r->s, r->setting))                                                                          \
    X("reference", "", "hash of the reference's scene, 16 hex digits; names its files in references/",               \
      csv_hash(line, r->cell_reference->scene_hash))                                                                 \
    X("reference_film", "", "hash of the reference's film", csv_hash(line, r->cell_reference->film_hash))            \
    X("film_hash", "", "hash of the cell's film", csv_hash(line, r->film_hash))                                      \
    X("mse", "", "mean squared difference of the sRGB-encoded channels, values clamped to 0..1",                     \
      csv_real(line, r->difference.mse))                                                                             \
    X("psnr_db", "dB", "10 log10(1 / mse); NA if mse is 0",                                                          \
      csv_real(line, isfinite(r->difference.psnr_db) ? r->difference.psnr_db : NAN))                                 \
    X("ssim", "", "mean structural similarity of the luma, 1 for equal images", csv_real(line, r->difference.ssim))  \
    X("flip", "", "mean FLIP error at 67 pixels per degree, 0 for equal images", csv_real(line, r->difference.flip)) \
    X("largest", "", "largest difference in any encoded channel, 0..1", csv_real(line, r->difference.largest))       \
    X("differing_fraction", "", "fraction of the pixels whose 8-bit encodings differ, 0..1",                         \
      csv_real(line, r->difference.differing_fraction))                                                              \
    X("error_rms", "radiance",                                                                                       \
      "root mean square of film minus reference, over all pixels and channels, linear, not clamped; 1 is white",     \
      csv_real(line, r->error_rms))                                                                                  \
    X("noise_rms", "radiance", "noise_rms of the cell's frame, as in rows.csv", csv_real(line, r->noise_rms))        \
    X("reference_noise_rms", "radiance", "noise_rms of the reference", csv_real(line, r->cell_reference->noise_rms)) \
    ROW_ORIGIN(X)

#define DESCRIBE(name, unit, meaning, put) visit(context, &(row_column){name, unit, meaning});
#define PUT(name, unit, meaning, put) put;

void compare_each_column(row_column_visitor *visit, void *context)
{
    COMPARE_COLUMNS(DESCRIBE)
}

const char *const compare_summary_columns[] = {
    "reference", "mse", "psnr_db", "ssim", "flip", "largest", "differing_fraction", "error_rms", "reference_noise_rms"};
const size_t compare_summary_column_count = sizeof compare_summary_columns / sizeof compare_summary_columns[0];

void compare_row_write(csv_buffer *line, const compare_row *r)
{
    COMPARE_COLUMNS(PUT)
    csv_end(line);
}
