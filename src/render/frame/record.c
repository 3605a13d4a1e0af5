/* Writers of a frame's files: images, maps, named layers, the timeline. */
#include "render/frame/record.h"

#include "base/cancel.h"
#include "base/file.h"
#include "base/number.h"
#include "image/heatmap.h"
#include "scene/file/shared.h"
#include "scene/model/camera.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void read_row(const void *context, int y, float *rgb)
{
    const film *f = context;
    film_read(f, 0, y, f->width, y + 1, rgb, 0);
}

static status write_with_scene(image_rows rows, const scene *s, const char *path, int bits, diagnostic *why)
{
    shared_texts texts = {.count = 0};
    if (s && image_format_of(path) == IMAGE_PNG)
        TRY(shared_texts_make(s, &texts, why));
    if (s)
        rows.tone = camera_tone(s);
    rows.texts = texts.item;
    rows.text_count = texts.count;
    const status code = image_write_rows(&rows, path, bits, why);
    free(texts.scene);
    return code;
}

status record_image(const film *f, const scene *s, const char *path, int bits, diagnostic *why)
{
    return write_with_scene((image_rows){.width = f->width, .height = f->height, .read = read_row, .of = f}, s, path,
                            bits, why);
}

status record_drawing(const image *img, const scene *s, const char *path, int bits, diagnostic *why)
{
    return write_with_scene(image_rows_of(img), s, path, bits, why);
}

static status image_of_values(const double *values, const film *f, image **out, diagnostic *why)
{
    status code = image_create(f->width, f->height, out, why);
    for (size_t i = 0; code == STATUS_OK && i < (size_t)f->width * (size_t)f->height && !cancel_asked_at(i); i++)
        for (size_t channel = 0; channel < 3; channel++)
            (*out)->pixel[i * 3 + channel] = (float)values[i];
    return code;
}

status record_map(const double *values, const film *f, const char *title, const char *path, diagnostic *why)
{
    image *img = NULL;
    status code = image_format_of(path) == IMAGE_PFM ? image_of_values(values, f, &img, why)
                                                     : heatmap_create(values, f->width, f->height, title, &img, why);
    THEN(code, image_write(img, path, 8, why));
    image_destroy(img);
    return code;
}

void record_noise_values(const render_result *result, double *values)
{
    const size_t pixels = (size_t)result->img->width * (size_t)result->img->height;
    for (size_t i = 0; i < pixels; i++) {
        const double *v = &result->variance[3 * i];
        values[i] = sqrt((v[0] + v[1] + v[2]) / 3.0);
    }
}

status record_noise(const render_result *result, const char *path, diagnostic *why)
{
    const size_t pixels = (size_t)result->img->width * (size_t)result->img->height;
    double *error = malloc((pixels + 1) * sizeof *error);
    if (!error)
        return out_of_memory(why);
    record_noise_values(result, error);
    status code = record_map(error, result->img, "standard error per pixel", path, why);
    free(error);
    return code;
}

char *record_layer_path(const char *prefix, int layer)
{
    const size_t size = strlen(prefix) + strlen(layer_words[layer]) + sizeof "-.pfm";
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s-%s.pfm", prefix, layer_words[layer]);
    return path;
}

static status record_layer(const float *values, int channels, const film *f, const char *path, diagnostic *why)
{
    image *img = NULL;
    status code = image_create(f->width, f->height, &img, why);
    for (size_t i = 0; code == STATUS_OK && i < 3 * (size_t)f->width * (size_t)f->height && !cancel_asked_at(i); i++)
        img->pixel[i] = values[channels == 3 ? i : i / 3];
    THEN(code, image_write(img, path, 8, why));
    image_destroy(img);
    return code;
}

status record_layers(const render_result *result, const char *prefix, diagnostic *why)
{
    status code = STATUS_OK;
    for (int i = 0; i < LAYER_COUNT && code == STATUS_OK; i++) {
        char *path = record_layer_path(prefix, i);
        code = path ? record_layer(result->layers->values[i], layer_channels[i], result->img, path, why)
                    : out_of_memory(why);
        free(path);
    }
    return code;
}

static void write_row_name(FILE *stream, int worker)
{
    fprintf(stream, ",\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":%d,\"args\":{\"name\":\"worker %d\"}}",
            worker, worker);
    fprintf(stream,
            ",\n{\"name\":\"thread_sort_index\",\"ph\":\"M\",\"pid\":1,\"tid\":%d,\"args\":{\"sort_index\":%d}}",
            worker, worker);
}

static void write_event(FILE *stream, const tile_event *e)
{
    char begin[NUMBER_TEXT_MAX], length[NUMBER_TEXT_MAX];
    number_format(e->begin_s * 1e6, begin);
    number_format((e->end_s - e->begin_s) * 1e6, length);
    fprintf(stream,
            ",\n{\"name\":\"tile %d,%d\",\"cat\":\"tile\",\"ph\":\"X\",\"ts\":%s,\"dur\":%s,\"pid\":1,\"tid\":%d,",
            e->x0, e->y0, begin, length, e->worker);
    fprintf(stream, "\"args\":{\"x0\":%d,\"y0\":%d,\"x1\":%d,\"y1\":%d}}", e->x0, e->y0, e->x1, e->y1);
}

status record_timeline(const render_result *result, const char *path, diagnostic *why)
{
    file_writer file;
    TRY(file_writer_open(&file, path, why));
    fputs("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n", file.stream);
    fputs("{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":1,\"tid\":0,\"args\":{\"name\":\"cuvette render\"}}",
          file.stream);
    for (int i = 0; i < result->worker_count; i++)
        write_row_name(file.stream, i);
    for (size_t i = 0; i < result->event_count; i++)
        write_event(file.stream, &result->events[i]);
    fputs("\n]}\n", file.stream);
    return file_writer_commit(&file, why);
}
