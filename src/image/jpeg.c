/* JPEG through libjpeg-turbo. Everything that must survive a longjmp is in a job, which belongs to a function that does
 * not call setjmp; the function that does has no modified local variables. */
#include "base/cancel.h"
#include "base/status.h"
#include "image/codec.h"
#include <errno.h>
#include <jerror.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <jpeglib.h>

/* Fast: for images that are replaced soon; about a third of the bytes and of the time. */
enum { QUALITY = 92, QUALITY_FAST = 80, SCANS_MAX = 500 };

typedef struct jpeg_job {
    struct jpeg_error_mgr errors; /* first, so that cinfo->err points to the job */
    struct jpeg_progress_mgr progress;
    jmp_buf escape;
    char message[JMSG_LENGTH_MAX];
    unsigned char *row;
    float *rgb; /* writing: one row, linear */
    image *img;
    image_values values;
    codec_color color;
    codec_tables tables;
    unsigned char *profile;
    status code;
    diagnostic *why;
} jpeg_job;

static _Noreturn void on_error(j_common_ptr cinfo)
{
    jpeg_job *job = (jpeg_job *)cinfo->err;
    cinfo->err->format_message(cinfo, job->message);
    longjmp(job->escape, 1);
}

/* libjpeg reports damage as a warning and invents the missing pixels: here it is an error, unless no pixel is
 * affected. */
static void on_message(j_common_ptr cinfo, int level)
{
    int message = cinfo->err->msg_code;
    bool harmless = message == JWRN_EXTRANEOUS_DATA || message == JWRN_JFIF_MAJOR || message == JWRN_ADOBE_XFORM;
    if (level < 0 && !harmless)
        on_error(cinfo);
}

static void no_output(j_common_ptr cinfo)
{
    (void)cinfo;
}

/* libjpeg processes an image inside single calls, and reports progress after each row of blocks. */
static void leave_if_cancelled(j_common_ptr cinfo)
{
    if (cancel_asked())
        longjmp(((jpeg_job *)cinfo->err)->escape, 1);
}

static bool no_memory(const jpeg_job *job)
{
    return job->errors.msg_code == JERR_OUT_OF_MEMORY;
}

static void prepare(jpeg_job *job)
{
    jpeg_std_error(&job->errors);
    job->errors.error_exit = on_error;
    job->errors.emit_message = on_message;
    job->errors.output_message = no_output;
    job->progress.progress_monitor = leave_if_cancelled;
}

/* ---- writing ---- */

static void write_rows(jpeg_job *job, struct jpeg_compress_struct *cinfo, const image_rows *rows, bool fast,
                       FILE *stream)
{
    jpeg_create_compress(cinfo);
    cinfo->progress = &job->progress;
    jpeg_stdio_dest(cinfo, stream);
    cinfo->image_width = (JDIMENSION)rows->width;
    cinfo->image_height = (JDIMENSION)rows->height;
    cinfo->input_components = 3;
    cinfo->in_color_space = JCS_RGB;
    jpeg_set_defaults(cinfo);
    jpeg_set_quality(cinfo, fast ? QUALITY_FAST : QUALITY, TRUE);
    cinfo->dct_method = JDCT_ISLOW; /* integers: the same bytes with and without SIMD */
    cinfo->optimize_coding = !fast;
    if (!fast) /* 4:4:4; libjpeg's default is 4:2:0 */
        cinfo->comp_info[0].h_samp_factor = cinfo->comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(cinfo, TRUE);
    codec_bytes bytes;
    codec_bytes_prepare(&bytes);
    while (cinfo->next_scanline < cinfo->image_height) {
        rows->read(rows->of, (int)cinfo->next_scanline, job->rgb);
        codec_bytes_encode(&bytes, job->rgb, (size_t)rows->width * 3, job->row);
        JSAMPROW row = job->row;
        jpeg_write_scanlines(cinfo, &row, 1);
    }
    jpeg_finish_compress(cinfo);
}

static bool write_guarded(jpeg_job *job, struct jpeg_compress_struct *cinfo, const image_rows *rows, bool fast,
                          FILE *stream)
{
    if (setjmp(job->escape))
        return false;
    write_rows(job, cinfo, rows, fast, stream);
    return true;
}

status codec_jpeg_write(const image_rows *rows, FILE *stream, bool fast, diagnostic *why)
{
    if (rows->width > JPEG_MAX_DIMENSION || rows->height > JPEG_MAX_DIMENSION)
        return diagnose(why, STATUS_BAD_INPUT, "write a PNG instead", "a JPEG image has at most %ld pixels per side",
                        JPEG_MAX_DIMENSION);
    struct jpeg_compress_struct cinfo = {0};
    jpeg_job job = {0};
    status code = STATUS_FAILURE;
    prepare(&job);
    cinfo.err = &job.errors;
    job.row = malloc((size_t)rows->width * 3);
    job.rgb = malloc((size_t)rows->width * 3 * sizeof *job.rgb);
    if (!job.row || !job.rgb)
        out_of_memory(why);
    else if (write_guarded(&job, &cinfo, rows, fast, stream))
        code = STATUS_OK;
    else if (cancel_asked())
        code = cancel_check(why);
    else if (no_memory(&job))
        out_of_memory(why);
    else
        system_error(why, code, NULL, "cannot write the JPEG file", errno, "write a PNG instead");
    jpeg_destroy_compress(&cinfo);
    free(job.row);
    free(job.rgb);
    return code;
}

/* ---- reading ---- */

/* A small progressive file can request many scans of a huge image. */
static void limit_scans(j_common_ptr cinfo)
{
    if (((j_decompress_ptr)cinfo)->input_scan_number > SCANS_MAX)
        ERREXIT(cinfo, JERR_BAD_PROGRESSION);
    leave_if_cancelled(cinfo);
}

/* ---- markers ---- */

enum { EXIF_MARKER = JPEG_APP0 + 1, PROFILE_MARKER = JPEG_APP0 + 2, MARKER_MOST = 0xFFFF };

/* The contents of a saved marker behind its name, a text that ends in zeros; NULL for another marker. */
static const unsigned char *contents_of(const struct jpeg_marker_struct *m, int marker, const char *name, size_t length,
                                        size_t *size)
{
    if (m->marker != marker || m->data_length < length || memcmp(m->data, name, length) != 0)
        return NULL;
    *size = m->data_length - length;
    return m->data + length;
}

static int orientation_of(j_decompress_ptr cinfo)
{
    size_t size;
    for (const struct jpeg_marker_struct *m = cinfo->marker_list; m; m = m->next) {
        const unsigned char *exif = contents_of(m, EXIF_MARKER, "Exif\0", 6, &size);
        if (exif)
            return codec_exif_orientation(exif, size);
    }
    return 1;
}

/* Joins the parts of the profile (ICC.1:2022, B.4): number, count, bytes. False: one is missing. */
static bool join_profile(const jpeg_job *job, j_decompress_ptr cinfo, size_t *used)
{
    size_t size;
    int count = 1;
    for (int number = 1; number <= count; number++) {
        const unsigned char *part = NULL;
        for (const struct jpeg_marker_struct *m = cinfo->marker_list; m && !part; m = m->next) {
            part = contents_of(m, PROFILE_MARKER, "ICC_PROFILE", 12, &size);
            part = part && size > 2 && part[0] == number ? part : NULL;
        }
        if (!part)
            return false;
        count = part[1];
        memcpy(job->profile + *used, part + 2, size - 2);
        *used += size - 2;
    }
    return true;
}

/* Reads the profile, if there is one. *reason: why it cannot be applied, else NULL. */
static bool read_profile(jpeg_job *job, j_decompress_ptr cinfo, const char **reason)
{
    size_t room = 0, size, used = 0;
    *reason = NULL;
    for (const struct jpeg_marker_struct *m = cinfo->marker_list; m; m = m->next)
        room += contents_of(m, PROFILE_MARKER, "ICC_PROFILE", 12, &size) ? size : 0;
    if (room == 0)
        return true;
    if (!(job->profile = malloc(room)))
        return false;
    *reason = join_profile(job, cinfo, &used) ? codec_color_of_icc(job->profile, used, &job->color) : "is damaged";
    return true;
}

/* ---- pixels ---- */

/* CMYK as such: the library turns YCCK into it. Its conversion to RGB is here, in store_row. */
static bool choose_colors(jpeg_job *job, j_decompress_ptr cinfo)
{
    switch (cinfo->jpeg_color_space) {
    case JCS_GRAYSCALE: cinfo->out_color_space = JCS_GRAYSCALE; return true;
    case JCS_YCbCr:
    case JCS_RGB: cinfo->out_color_space = JCS_RGB; return true;
    case JCS_YCCK:
    case JCS_CMYK: cinfo->out_color_space = JCS_CMYK; return true;
    default:
        job->code =
            diagnose(job->why, STATUS_BAD_INPUT, "convert it to RGB",
                     "the JPEG file has %d channels that are neither grey, RGB nor CMYK", cinfo->num_components);
        return false;
    }
}

static bool check_precision(jpeg_job *job, j_decompress_ptr cinfo)
{
    if (cinfo->data_precision != 8)
        job->code = diagnose(job->why, STATUS_BAD_INPUT, "convert it to 8 bits, or to PNG with 16",
                             "the JPEG file has %d bits per channel; only 8 are supported", cinfo->data_precision);
    else
        return true;
    return false;
}

/* CMYK without a profile: R = (1 - C) (1 - K), rounded to 8 bits. A file with Adobe's marker stores 1 - C, and so
 * on. */
static void store_row(const jpeg_job *job, const struct jpeg_decompress_struct *cinfo, float *pixel)
{
    const size_t width = (size_t)job->img->width;
    const unsigned char *row = job->row, flip = cinfo->saw_Adobe_marker ? 0 : 255;
    const float *const *of = (const float *const *)job->tables.of;
    if (cinfo->output_components == 4) {
        for (size_t i = 0; i < width; i++)
            for (size_t c = 0; c < 3; c++)
                pixel[3 * i + c] =
                    of[c][((unsigned)(row[4 * i + c] ^ flip) * (unsigned)(row[4 * i + 3] ^ flip) + 127) / 255];
        return;
    }
    const size_t channels = cinfo->output_components == 3;
    for (size_t i = 0; i < width; i++)
        for (size_t c = 0; c < 3; c++)
            pixel[3 * i + c] = of[c][row[channels ? 3 * i + c : i]];
}

static bool allocate(jpeg_job *job, j_decompress_ptr cinfo, size_t file_bytes)
{
    const char *reason = NULL;
    if (job->values == IMAGE_LIGHT && !read_profile(job, cinfo, &reason)) {
        job->code = out_of_memory(job->why);
        return false;
    }
    job->code = codec_begin(cinfo->image_width, cinfo->image_height, file_bytes, 255,
                            job->values == IMAGE_CODED ? NULL : &job->color, &job->img, &job->tables, job->why);
    if (job->code == STATUS_OK && !(job->row = malloc((size_t)cinfo->image_width * 4)))
        job->code = out_of_memory(job->why);
    if (job->code == STATUS_OK && reason)
        image_note(job->img->note, CODEC_PROFILE_NOTE, reason);
    return job->code == STATUS_OK;
}

static bool read_rows(jpeg_job *job, j_decompress_ptr cinfo, const unsigned char *bytes, size_t size)
{
    jpeg_create_decompress(cinfo);
    job->progress.progress_monitor = limit_scans;
    cinfo->progress = &job->progress;
    jpeg_mem_src(cinfo, bytes, size);
    jpeg_save_markers(cinfo, EXIF_MARKER, MARKER_MOST);
    jpeg_save_markers(cinfo, PROFILE_MARKER, MARKER_MOST);
    jpeg_read_header(cinfo, TRUE);
    if (!check_precision(job, cinfo) || !choose_colors(job, cinfo) || !allocate(job, cinfo, size))
        return false;
    cinfo->dct_method = JDCT_ISLOW;
    jpeg_start_decompress(cinfo);
    while (cinfo->output_scanline < cinfo->output_height) {
        float *pixel = job->img->pixel + (size_t)cinfo->output_scanline * (size_t)job->img->width * 3;
        JSAMPROW row = job->row;
        leave_if_cancelled((j_common_ptr)cinfo);
        jpeg_read_scanlines(cinfo, &row, 1);
        store_row(job, cinfo, pixel);
    }
    const int orientation = orientation_of(cinfo);
    jpeg_finish_decompress(cinfo); /* reads to the end of the image, which must exist */
    codec_color_apply(&job->color, 1.0, job->img);
    job->code = codec_orient(&job->img, orientation, job->why);
    return job->code == STATUS_OK;
}

/* What the library cannot read is not damaged. */
static status explain(const jpeg_job *job)
{
    const int code = job->errors.msg_code;
    if (code == JERR_BAD_PRECISION)
        return diagnose(job->why, STATUS_BAD_INPUT, "convert it to 8 bits, or to PNG with 16",
                        "the JPEG file has %d bits per channel; only 8 are supported", job->errors.msg_parm.i[0]);
    if (code == JERR_SOF_UNSUPPORTED)
        return diagnose(job->why, STATUS_BAD_INPUT, "convert it to a baseline or progressive JPEG, or to PNG",
                        "the JPEG file is lossless or hierarchical, which is not supported (SOF %d)",
                        job->errors.msg_parm.i[0] - 0xC0);
    if (code == JERR_ARITH_NOTIMPL)
        return diagnose(job->why, STATUS_BAD_INPUT, "convert it to a baseline or progressive JPEG, or to PNG",
                        "the JPEG file is coded arithmetically, which this build does not support");
    return diagnose(job->why, STATUS_BAD_INPUT, "copy the file again, or save it again as JPEG",
                    "the JPEG file is damaged: %s", job->message);
}

static void read_guarded(jpeg_job *job, j_decompress_ptr cinfo, const unsigned char *bytes, size_t size)
{
    if (setjmp(job->escape)) {
        job->code = cancel_check(job->why);
        if (job->code != STATUS_OK)
            return;
        job->code = no_memory(job) ? out_of_memory(job->why) : explain(job);
        return;
    }
    if (read_rows(job, cinfo, bytes, size))
        job->code = STATUS_OK;
}

status codec_jpeg_read(const unsigned char *bytes, size_t size, image_values values, image **out, diagnostic *why)
{
    struct jpeg_decompress_struct cinfo = {0};
    jpeg_job job = {.values = values, .why = why, .code = STATUS_FAILURE};
    *out = NULL;
    prepare(&job);
    cinfo.err = &job.errors;
    read_guarded(&job, &cinfo, bytes, size);
    jpeg_destroy_decompress(&cinfo);
    free(job.row);
    free(job.profile);
    codec_tables_free(&job.tables);
    if (job.code != STATUS_OK) {
        image_destroy(job.img);
        return job.code;
    }
    *out = job.img;
    return STATUS_OK;
}
