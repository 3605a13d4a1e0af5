#include "study/compare_rows.h"
#include "study/identity.h"
#include <math.h>

/* Over all channels of all pixels, linear and not clamped. */
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
    THEN(code, image_compare(img, row->against->img, &row->difference, why));
    if (code == STATUS_OK) {
        row->error_rms = difference_rms(img, row->against->img);
        row->film_hash = film_hash(frame->img);
        row->noise_rms = render_noise_rms(frame);
    }
    image_destroy(img);
    return code;
}

/* In the last one: line, r (the row). */
#define COMPARE_COLUMNS(X)                                                                                             \
    X("study", "", "name of the study", csv_text(line, r->of->name))                                                   \
    X("identity", "", "hash of the cell's identity in rows.csv and of the reference's parameters, 16 hex digits",      \
      csv_hash(line, identity_compared(r->of, r->of->identity[r->cell])))                                              \
    X("cell", "", "number of the grid point when it was compared, the last axis fastest",                              \
      csv_count(line, (int64_t)r->cell))                                                                               \
    X("<axis>", "of the parameter", "value of each parameter of the grid, in its order",                               \
      row_put_axes(line, r->of, r->setting))                                                                           \
    X("reference", "", "fingerprint of the reference's scene, 16 hex digits: its files in references/",                \
      csv_hash(line, r->against->scene_hash))                                                                          \
    X("reference_film", "", "fingerprint of the reference's film", csv_hash(line, r->against->film_hash))              \
    X("film_hash", "", "fingerprint of the cell's film", csv_hash(line, r->film_hash))                                 \
    X("mse", "", "mean squared difference of the sRGB-encoded channels, values clamped to 0..1",                       \
      csv_real(line, r->difference.mse))                                                                               \
    X("psnr_db", "dB", "10 log10(1 / mse); NA where mse is 0",                                                         \
      csv_real(line, isfinite(r->difference.psnr_db) ? r->difference.psnr_db : NAN))                                   \
    X("ssim", "", "mean structural similarity of the luma, 1 for equal images", csv_real(line, r->difference.ssim))    \
    X("flip", "", "mean FLIP error at 67 pixels per degree, 0 for equal images", csv_real(line, r->difference.flip))   \
    X("largest", "", "largest difference in any encoded channel, 0..1", csv_real(line, r->difference.largest))         \
    X("differing_share", "", "share of the pixels whose 8-bit encodings differ, 0..1",                                 \
      csv_real(line, r->difference.differing_share))                                                                   \
    X("error_rms", "radiance",                                                                                         \
      "root of the mean square of film less reference, over all pixels and channels, linear, not clamped; 1 is white", \
      csv_real(line, r->error_rms))                                                                                    \
    X("noise_rms", "radiance", "as in rows.csv", csv_real(line, r->noise_rms))                                         \
    X("reference_noise_rms", "radiance", "the same of the reference", csv_real(line, r->against->noise_rms))           \
    ROW_ORIGIN(X)

#define DESCRIBE(name, unit, meaning, put) take(context, &(row_column){name, unit, meaning});
#define PUT(name, unit, meaning, put) put;

void compare_each_column(row_column_taker *take, void *context)
{
    COMPARE_COLUMNS(DESCRIBE)
}

const char *const compare_shown[] = {
    "reference", "mse", "psnr_db", "ssim", "flip", "largest", "differing_share", "error_rms", "reference_noise_rms"};
const size_t compare_shown_count = sizeof compare_shown / sizeof compare_shown[0];

void compare_row_write(csv_line *line, const compare_row *r)
{
    COMPARE_COLUMNS(PUT)
    csv_end(line);
}
