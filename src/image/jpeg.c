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
    float *linear;
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

static bool choose_colors(jpeg_job *job, j_decompress_ptr cinfo)
{
    switch (cinfo->jpeg_color_space) {
    case JCS_GRAYSCALE: cinfo->out_color_space = JCS_GRAYSCALE; return true;
    case JCS_YCbCr:
    case JCS_RGB: cinfo->out_color_space = JCS_RGB; return true;
    default:
        job->code = diagnose(job->why, STATUS_BAD_INPUT, "convert it to RGB", "the JPEG file is neither grey nor RGB");
        return false;
    }
}

static bool allocate(jpeg_job *job, long long width, long long height, size_t file_bytes)
{
    job->code = codec_begin(width, height, file_bytes, 255, &job->img, &job->linear, job->why);
    if (job->code == STATUS_OK && !(job->row = malloc((size_t)width * 3)))
        job->code = out_of_memory(job->why);
    return job->code == STATUS_OK;
}

static bool read_rows(jpeg_job *job, j_decompress_ptr cinfo, const unsigned char *bytes, size_t size)
{
    jpeg_create_decompress(cinfo);
    job->progress.progress_monitor = limit_scans;
    cinfo->progress = &job->progress;
    jpeg_mem_src(cinfo, bytes, size);
    jpeg_read_header(cinfo, TRUE);
    if (!choose_colors(job, cinfo) || !allocate(job, cinfo->image_width, cinfo->image_height, size))
        return false;
    cinfo->dct_method = JDCT_ISLOW;
    jpeg_start_decompress(cinfo);
    size_t width = (size_t)job->img->width, channels = (size_t)cinfo->output_components;
    while (cinfo->output_scanline < cinfo->output_height) {
        float *pixel = job->img->pixel + cinfo->output_scanline * width * 3;
        JSAMPROW row = job->row;
        leave_if_cancelled((j_common_ptr)cinfo);
        jpeg_read_scanlines(cinfo, &row, 1);
        for (size_t i = 0; i < width * 3; i++)
            pixel[i] = job->linear[job->row[channels == 3 ? i : i / 3]];
    }
    jpeg_finish_decompress(cinfo); /* reads to the end of the image, which must exist */
    return true;
}

static void read_guarded(jpeg_job *job, j_decompress_ptr cinfo, const unsigned char *bytes, size_t size)
{
    if (setjmp(job->escape)) {
        job->code = cancel_check(job->why);
        if (job->code != STATUS_OK)
            return;
        job->code = no_memory(job)
                        ? out_of_memory(job->why)
                        : diagnose(job->why, STATUS_BAD_INPUT, "copy the file again, or save it again as JPEG",
                                   "the JPEG file is damaged: %s", job->message);
        return;
    }
    if (read_rows(job, cinfo, bytes, size))
        job->code = STATUS_OK;
}

status codec_jpeg_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why)
{
    struct jpeg_decompress_struct cinfo = {0};
    jpeg_job job = {.why = why, .code = STATUS_FAILURE};
    *out = NULL;
    prepare(&job);
    cinfo.err = &job.errors;
    read_guarded(&job, &cinfo, bytes, size);
    jpeg_destroy_decompress(&cinfo);
    free(job.row);
    free(job.linear);
    if (job.code != STATUS_OK) {
        image_destroy(job.img);
        return job.code;
    }
    *out = job.img;
    return STATUS_OK;
}
