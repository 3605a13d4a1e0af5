/* The rays of beams as text and JSON: the rows of trace_writers.h, by beam and ray. */
#include "report/beam_rows.h"
#include "image/codec.h"
#include "report/json.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"

static const char *const kind_words[] = {"pencil", "fan", "sheet", "bundle"};

typedef struct beam_writer {
    const beamed *of;
    FILE *out;
    int beam; /* that is open; -1: none */
    size_t segments;
    bool short_of_memory;
} beam_writer;

static status count_segments(beam_writer *w, const ray_tree *tree, diagnostic *why)
{
    w->segments += tree->count;
    if (w->of->segments_max == 0 || w->segments <= w->of->segments_max)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "lower 'rays', 'wavelengths' or 'depth' of a beam, or raise its 'min_share'",
                    "the beams have more than %zu segments", w->of->segments_max);
}

static status write_text_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    beam_writer *w = context;
    const beam *b = &w->of->s->beams[ray->beam];
    TRY(count_segments(w, tree, why));
    fprintf(w->out, "%s: %s, ray %d of %d, %.6g nm, power %.6g\n", b->name, kind_words[b->kind], ray->number + 1,
            ray->rays, ray->lambda_nm, ray->power);
    trace_write_text_rays(&(traced){w->of->s, p, tree, w->of->scene_path, false}, w->out);
    return STATUS_OK;
}

status beams_write_text(const beamed *b, FILE *out, diagnostic *why)
{
    beam_writer w = {.of = b, .out = out, .beam = -1};
    return beams_each_ray(b->s, b->level, 0, write_text_ray, &w, why);
}

static void write_color(FILE *out, const char *key, const double rgb[3])
{
    fprintf(out, ",\"%s\":[", key);
    for (int k = 0; k < 3; k++) {
        fputs(k ? "," : "", out);
        json_write_real(out, rgb[k]);
    }
    fputc(']', out);
}

static void write_number(FILE *out, const char *key, double value)
{
    fprintf(out, ",\"%s\":", key);
    json_write_real(out, value);
}

static void close_beam(beam_writer *w)
{
    fputs(w->beam >= 0 ? "]}" : "", w->out);
}

static status write_json_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    beam_writer *w = context;
    const beam *b = &w->of->s->beams[ray->beam];
    TRY(count_segments(w, tree, why));
    if (w->beam != ray->beam) {
        close_beam(w);
        fputs(w->beam >= 0 ? ",\n{\"name\":" : "{\"name\":", w->out);
        w->short_of_memory |= !json_write_text(w->out, b->name);
        fprintf(w->out, ",\"kind\":\"%s\"", kind_words[b->kind]);
        write_number(w->out, "power", b->power);
        fputs(",\"rays\":[", w->out);
    } else {
        fputc(',', w->out);
    }
    w->beam = ray->beam;
    fprintf(w->out, "{\"number\":%d", ray->number);
    write_number(w->out, "lambda_nm", ray->lambda_nm);
    write_number(w->out, "power", ray->power);
    double rgb[3];
    beam_line_color(b, ray->lambda_nm, rgb);
    write_color(w->out, "color", rgb);
    if (w->of->for_page)
        fprintf(w->out, ",\"displayed\":[%u,%u,%u]", codec_quantize((float)rgb[0], 255),
                codec_quantize((float)rgb[1], 255), codec_quantize((float)rgb[2], 255));
    fputs(",\"root\":", w->out);
    w->short_of_memory |=
        !trace_write_json_ray(&(traced){w->of->s, p, tree, w->of->scene_path, w->of->for_page}, w->out, 0);
    fputc('}', w->out);
    return STATUS_OK;
}

status beams_write_json(const beamed *b, FILE *out, diagnostic *why)
{
    beam_writer w = {.of = b, .out = out, .beam = -1};
    fputs("{\"schema\":1,\"scene\":", out);
    w.short_of_memory = !json_write_text(out, b->scene_path);
    fputs(",\"beams\":[", out);
    TRY(beams_each_ray(b->s, b->level, 0, write_json_ray, &w, why));
    close_beam(&w);
    fprintf(out, "],\"segments\":%zu}\n", w.segments);
    return w.short_of_memory ? out_of_memory(why) : STATUS_OK;
}

status beam_screen_write_json(const beam_screen *screen, FILE *out, diagnostic *why)
{
    (void)why;
    fprintf(out, "{\"schema\":1,\"columns\":%d,\"rows\":%d,\"rays\":%zu,\"hits\":%zu", screen->columns, screen->rows,
            screen->ray_count, screen->hit_count);
    write_number(out, "power", screen->power);
    write_number(out, "received", screen->received);
    fputs(",\"bins\":[", out);
    for (int i = 0; i < screen->columns * screen->rows; i++) {
        fputs(i ? "," : "", out);
        json_write_real(out, screen->bin[i]);
    }
    fputs("],\"color\":[", out);
    for (int i = 0; i < 3 * screen->columns * screen->rows; i++) {
        fputs(i ? "," : "", out);
        json_write_real(out, screen->color[i]);
    }
    fputs("]}\n", out);
    return STATUS_OK;
}
