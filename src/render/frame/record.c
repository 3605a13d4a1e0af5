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

/* ---- the image ---- */

static void read_row(const void *context, int y, float *rgb)
{
    const film *f = context;
    film_read(f, 0, y, f->width, y + 1, rgb, 0);
}

static status write_with_scene(image_rows rows, const record_more *more, const scene *s, const char *path, int bits,
                               diagnostic *why)
{
    const image_format format = image_format_of(path);
    shared_texts texts = {.count = 0};
    image_text all[IMAGE_TEXTS_MAX];
    if (s && (format == IMAGE_PNG || format == IMAGE_EXR))
        TRY(shared_texts_make(s, &texts, why));
    if (s)
        rows.tone = camera_tone(s);
    rows.texts = all;
    for (int i = 0; i < texts.count; i++)
        all[rows.text_count++] = texts.item[i];
    for (int i = 0; more && i < more->text_count; i++)
        all[rows.text_count++] = more->texts[i];
    const status code = image_write_rows(&rows, path, bits, why);
    free(texts.scene);
    return code;
}

static float float_of(const void *of, size_t pixel)
{
    return ((const float *)of)[pixel];
}

static float float_of_three(const void *of, size_t pixel)
{
    return ((const float *)of)[3 * pixel];
}

static float double_of(const void *of, size_t pixel)
{
    return (float)((const double *)of)[pixel];
}

static float root_of_three(const void *of, size_t pixel)
{
    return (float)sqrt(((const double *)of)[3 * pixel]);
}

/* The names of what a result has in addition to the film, as other programs split them: layer, point, one letter. */
static const char *const layer_names[LAYER_COUNT][3] = {
    [LAYER_NORMAL] = {"normal.X", "normal.Y", "normal.Z"},
    [LAYER_ALBEDO] = {"albedo.R", "albedo.G", "albedo.B"},
    [LAYER_DEPTH] = {"depth.Z"},
    [LAYER_SOLID] = {"solid.V"},
    [LAYER_MATERIAL] = {"material.V"},
    [LAYER_POSITION] = {"position.X", "position.Y", "position.Z"},
};
static const char *const noise_names[][3] = {
    [FILM_RGB] = {"noise.R", "noise.G", "noise.B"}, [FILM_XYZ] = {"noise.X", "noise.Y", "noise.Z"}};

/* Returns their number. */
static int list_channels(const render_result *result, image_channel list[IMAGE_CHANNELS_MAX])
{
    const struct {
        const char *name;
        const double *values;
    } maps[] = {{"rays.V", result->pixel_rays}, {"time.V", result->pixel_ns}, {"cut.V", result->pixel_cut}};
    int count = 0;
    for (int i = 0; i < LAYER_COUNT && result->layers; i++)
        for (int k = 0; k < layer_channels[i]; k++)
            list[count++] = (image_channel){layer_names[i][k], layer_channels[i] == 3 ? float_of_three : float_of,
                                            result->layers->values[i] + k};
    for (int k = 0; k < 3 && result->variance; k++)
        list[count++] = (image_channel){noise_names[result->img->space][k], root_of_three, result->variance + k};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i].values)
            list[count++] = (image_channel){maps[i].name, double_of, maps[i].values};
    return count;
}

status record_image(const render_result *result, const record_more *more, const scene *s, const char *path, int bits,
                    diagnostic *why)
{
    const film *f = result->img;
    image_channel channels[IMAGE_CHANNELS_MAX];
    image_rows rows = {.width = f->width, .height = f->height, .read = read_row, .of = f, .channels = channels};
    if (image_format_of(path) != IMAGE_EXR)
        return write_with_scene(rows, NULL, s, path, bits, why);
    rows.channel_count = list_channels(result, channels);
    for (int i = 0; more && i < more->count; i++)
        channels[rows.channel_count++] = more->channels[i];
    return write_with_scene(rows, more, s, path, bits, why);
}

status record_drawing(const image *img, const scene *s, const char *path, int bits, diagnostic *why)
{
    return write_with_scene(image_rows_of(img), NULL, s, path, bits, why);
}

/* ---- maps ---- */

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
    const image_channel grey = {"Y", double_of, values};
    if (image_format_of(path) == IMAGE_EXR)
        return image_write_rows(
            &(image_rows){.width = f->width, .height = f->height, .channels = &grey, .channel_count = 1}, path, 8, why);
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
