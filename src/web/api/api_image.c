/* API: the rendered image, and a self-contained page that shows it, as `cuvette render -o FILE.html` writes it. See
 * web/README.md. */
#include "base/cancel.h"
#include "base/text.h"
#include "job/job.h"
#include "report/page.h"
#include "scene/file/shared.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"
#include "web/api/api.h"
#include "web/session/studies.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add_number(http_reply *r, const char *name, uint64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    http_reply_header(r, name, text);
}

/* Keeps only characters that cannot end the quoted string of the header. */
static void name_download(http_reply *r, const char *name)
{
    char text[160], *end = text;
    end += snprintf(text, sizeof text, "attachment; filename=\"");
    for (const char *c = name; *c && end < text + sizeof text - 8; c++)
        *end++ = isalnum((unsigned char)*c) || strchr("._-", *c) ? *c : '_';
    snprintf(end, 2, "\"");
    http_reply_header(r, "Content-Disposition", text);
}

/* How a reply encodes the image. quick: as pages display it, encoded once for all requests. with_scene: a PNG that
 * carries its scene (scene/file/shared.h). */
typedef struct encoding {
    image_format format;
    const char *type;
    int bits;
    bool quick, with_scene;
} encoding;

static status encode_with_scene(const shared_image *img, int bits, unsigned char **bytes, size_t *size, diagnostic *why)
{
    shared_texts texts;
    TRY(shared_texts_make(img->rendered, &texts, why));
    image_rows rows = image_rows_of(img->linear);
    rows.texts = texts.item;
    rows.text_count = texts.count;
    const status code = image_encode_rows(&rows, IMAGE_PNG, bits, false, bytes, size, why);
    free(texts.scene);
    return code;
}

/* Encodes into memory owned by the reply. */
static status encode_copy(const shared_image *img, const encoding *e, unsigned char **bytes, size_t *size,
                          diagnostic *why)
{
    if (e->with_scene && img->rendered)
        return encode_with_scene(img, e->bits, bytes, size, why);
    if (!e->quick)
        return image_encode(img->linear, e->format, e->bits, false, bytes, size, why);
    const unsigned char *shared;
    status code = shared_image_encode(img, e->format, &shared, size, why);
    *bytes = code == STATUS_OK ? malloc(*size) : NULL;
    if (*bytes)
        memcpy(*bytes, shared, *size);
    else if (code == STATUS_OK)
        code = out_of_memory(why);
    return code;
}

/* Encodes an image; small images, such as those of a moving slime, do not wait for the semaphore. */
static status encode(lab *l, const shared_image *img, const encoding *e, unsigned char **bytes, size_t *size,
                     diagnostic *why)
{
    const double small = 1e6; /* pixels */
    if ((double)img->width * img->height <= small)
        return encode_copy(img, e, bytes, size, why);
    TRY(semaphore_acquire(l->heavy, why));
    status code = encode_copy(img, e, bytes, size, why);
    semaphore_release(l->heavy);
    return code;
}

static status reply_image(call *c, encoding e)
{
    const char *download = http_query_value(c->request, "download");
    const shared_image *img = NULL;
    unsigned char *bytes = NULL;
    size_t size;
    if (!api_read_bits(c, &e.bits))
        return api_refuse(c, 400, "unsupported bit depth", "use ?bits=8 or ?bits=16");
    e.with_scene = e.format == IMAGE_PNG && api_query_flag(c, "scene");
    e.quick = e.format == IMAGE_PNG ? e.bits == 8 : api_query_flag(c, "quick");
    if (api_query_flag(c, "wait") && api_wait_for_final(c, &img) != STATUS_OK) {
        c->refused = 409;
        return STATUS_INTERRUPTED;
    }
    if (!img && !(img = render_worker_newest(c->l->render_worker)))
        return api_refuse(c, 404, "no image is rendered yet", "add ?wait=1");
    const status code = encode(c->l, img, &e, &bytes, &size, &c->why);
    if (code == STATUS_OK) {
        api_send(c, e.type, bytes, size);
        add_number(c->reply, "X-Cuvette-Serial", img->serial);
        add_number(c->reply, "X-Cuvette-Generation", img->generation);
        add_number(c->reply, "X-Cuvette-Pass", (uint64_t)img->pass);
        add_number(c->reply, "X-Cuvette-Final", img->final);
        if (download)
            name_download(c->reply, download);
    }
    shared_image_release(img);
    return code;
}

status api_image_png(call *c)
{
    return reply_image(c, (encoding){.format = IMAGE_PNG, .type = "image/png"});
}

status api_image_jpeg(call *c)
{
    return reply_image(c, (encoding){.format = IMAGE_JPEG, .type = "image/jpeg"});
}

/* --- the final image once more, with the pixels of a display --- */

#define DISPLAY_LIMIT_S 20.0

static status render_display(const final_question *q, int width, unsigned char **bytes, size_t *size, diagnostic *why)
{
    job *j = NULL;
    job_account account = {.result = NULL};
    image *linear = NULL;
    scene *s = scene_clone(q->final->rendered);
    if (!s)
        return out_of_memory(why);
    s->render.height = (s->render.height * width + s->render.width / 2) / s->render.width;
    s->render.width = width;
    status code = job_create(&(job_settings){.level = &q->l->settings.level, .time_s = DISPLAY_LIMIT_S}, &j, why);
    THEN(code, job_render(j, s, NULL, &account, why));
    THEN(code, film_image(account.result->img, &linear, why));
    if (code == STATUS_OK) {
        linear->tone = camera_tone(s);
        code = image_encode(linear, IMAGE_PNG, 8, true, bytes, size, why);
    }
    image_destroy(linear);
    job_account_release(&account);
    job_destroy(j);
    scene_destroy(s);
    return code;
}

/* ?width: from that of the image to four times that. */
static bool read_width(call *c, const shared_image *final, int *width)
{
    const char *text = http_query_value(c->request, "width");
    char *end = NULL;
    const long value = text ? strtol(text, &end, 10) : 0;
    const double pixels = (double)value * (double)value * final->height / final->width;
    *width = (int)value;
    return text && *end == '\0' && value >= final->width && value <= 4L * final->width && pixels <= DOCUMENT_PIXELS_MAX;
}

status api_display(call *c)
{
    const shared_image *final = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0;
    int width;
    if (studies_runs(c->l->studies, NULL))
        return api_reply_json(c, json_object()); /* a frame would disturb it */
    if (api_wait_for_final(c, &final) != STATUS_OK)
        return api_reply_json(c, json_object());
    final_question q = {c->l, final};
    status code = read_width(c, final, &width)
                      ? semaphore_acquire(c->l->heavy, &c->why)
                      : api_refuse(c, 400, "invalid width", "give one to four times the width of the image");
    if (code == STATUS_OK) {
        cancel_token token = {.ask = api_is_obsolete, .context = &q};
        cancel_begin(&token);
        code = render_display(&q, width, &bytes, &size, &c->why);
        cancel_end(&token);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_INTERRUPTED)
        code = api_reply_json(c, json_object());
    else if (code == STATUS_OK) {
        api_send(c, "image/png", bytes, size);
        add_number(c->reply, "X-Cuvette-Serial", final->serial);
    }
    shared_image_release(final);
    return code;
}

/* --- the page --- */

/* ?live=0: without the laboratory; ?live=empty: with a place for it, which the caller fills; otherwise with the
 * laboratory if the program has it. */
static status load_laboratory(call *c, char **laboratory)
{
    const char *choice = http_query_value(c->request, "live");
    diagnostic missing = {.line = 0};
    *laboratory = NULL;
    if (choice && strcmp(choice, "0") == 0)
        return STATUS_OK;
    if (choice && strcmp(choice, "empty") == 0)
        return (*laboratory = strdup("")) ? STATUS_OK : out_of_memory(&c->why);
    const status code = page_live_code(laboratory, &missing);
    if (code == STATUS_FAILURE)
        c->why = missing;
    return code == STATUS_BAD_INPUT ? STATUS_OK : code;
}

static status write_page(call *c, const shared_image *img, const char *command, const char *laboratory, char **bytes,
                         size_t *size)
{
    const page_content page = {.s = img->rendered,
                               .level = c->l->settings.level,
                               .rows = image_rows_of(img->linear),
                               .bits = 8,
                               .film_hash = img->film_hash,
                               .command = command,
                               .live = laboratory};
    text_writer writer;
    TRY(semaphore_acquire(c->l->heavy, &c->why));
    status code = text_writer_open(&writer, &c->why);
    if (code == STATUS_OK)
        code = text_writer_end(&writer, page_write_html(&page, writer.stream, &c->why), bytes, size, &c->why);
    semaphore_release(c->l->heavy);
    return code;
}

status api_page(call *c)
{
    const shared_image *img = NULL;
    char *command = NULL, *bytes = NULL, *laboratory = NULL, *file = api_document_file(c);
    size_t size = 0;
    bool complete;
    status code = file ? STATUS_OK : out_of_memory(&c->why);
    if (code == STATUS_OK && api_wait_for_final(c, &img) != STATUS_OK) {
        c->refused = 409;
        code = STATUS_INTERRUPTED;
    }
    THEN(code, command_line(c->l->files, *file ? file : NULL, img->rendered, c->l->settings.threads, &command,
                            &complete, &c->why));
    THEN(code, load_laboratory(c, &laboratory));
    THEN(code, write_page(c, img, command, laboratory, &bytes, &size));
    shared_image_release(img);
    free(laboratory);
    free(command);
    free(file);
    return code == STATUS_OK ? api_send(c, "text/html; charset=utf-8", bytes, size) : code;
}
