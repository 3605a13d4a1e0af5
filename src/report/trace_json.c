/* A ray tree as JSON. */
#include "base/cancel.h"
#include "image/codec.h"
#include "render/inspect/ray_line.h"
#include "report/json.h"
#include "report/trace_writers.h"
#include "scene/model/camera.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"

#include <math.h>

static void write_list(FILE *out, const char *key, const double *values, int count)
{
    fprintf(out, ",\"%s\":[", key);
    for (int k = 0; k < count; k++) {
        fputs(k ? "," : "", out);
        json_write_real(out, values[k]);
    }
    fputc(']', out);
}

static void write_vector(FILE *out, const char *key, vec3 v)
{
    write_list(out, key, (const double[]){v.x, v.y, v.z}, 3);
}

static void write_number(FILE *out, const char *key, double value)
{
    fprintf(out, ",\"%s\":", key);
    json_write_real(out, value);
}

static bool write_word(FILE *out, const char *key, const char *text)
{
    fprintf(out, "\"%s\":", key);
    return json_write_text(out, text);
}

static bool write_medium(const traced *t, FILE *out, const char *key, int medium, double n)
{
    fprintf(out, ",\"%s\":{", key);
    bool good = write_word(out, "medium", probe_medium_name(t->p, medium));
    write_number(out, "n", n);
    fputc('}', out);
    return good;
}

/* The bytes with which the image shows a radiance. */
static void write_bytes(FILE *out, const char *key, const scene *s, const double radiance[3])
{
    const image_tone tone = camera_tone(s);
    float rgb[3] = {(float)radiance[0], (float)radiance[1], (float)radiance[2]};
    image_tone_apply(&tone, rgb, 1);
    fprintf(out, ",\"%s\":[%u,%u,%u]", key, codec_quantize(rgb[0], 255), codec_quantize(rgb[1], 255),
            codec_quantize(rgb[2], 255));
}

/* The factor of radiance at the refraction, for each value of render.radiance. */
static void write_factors(FILE *out, const ray_hit *h)
{
    write_number(out, "T", h->T);
    fputs(",\"radiance_factor\":{\"classic\":", out);
    json_write_real(out, h->gain_classic);
    write_number(out, "basic", h->gain_basic);
    fputc('}', out);
}

/* Both sides of Snell's law, and the angles; null behind a surface that no ray passes. */
static void write_snell(FILE *out, const ray_hit *h)
{
    const bool passes = !h->opaque && !h->tir;
    fputs(",\"snell\":{\"incidence_deg\":", out);
    json_write_real(out, trace_angle_deg(h->cos_i));
    write_number(out, "n_sin_i", h->n_from * sqrt(fmax(0.0, 1.0 - h->cos_i * h->cos_i)));
    write_number(out, "refraction_deg", passes ? trace_angle_deg(h->cos_t) : NAN);
    write_number(out, "n_sin_t", passes ? h->n_to * sqrt(fmax(0.0, 1.0 - h->cos_t * h->cos_t)) : NAN);
    fputc('}', out);
}

static bool write_hit(const traced *t, FILE *out, const ray_hit *h)
{
    fputc('{', out);
    bool good = write_word(out, "solid", scene_solid_name(t->s, h->solid));
    fputc(',', out);
    good = write_word(out, "surface", probe_face_name(t->p, h)) && good;
    write_number(out, "t", h->t);
    write_vector(out, "point", h->point);
    write_vector(out, "normal", h->normal);
    good = write_medium(t, out, "from", h->from, h->n_from) && good;
    good = write_medium(t, out, "to", h->to, h->n_to) && good;
    write_number(out, "cos_i", h->cos_i);
    write_number(out, "cos_t", h->cos_t);
    write_number(out, "R_s", h->R_s);
    write_number(out, "R_p", h->R_p);
    write_number(out, "R", h->R);
    fprintf(out, ",\"tir\":%s", h->tir ? "true" : "false");
    write_number(out, "path_length", h->path_length_m);
    write_list(out, "transmittance", h->transmittance, 3);
    write_number(out, "error_bound", h->error_bound);
    fprintf(out, ",\"opaque\":%s", h->opaque ? "true" : "false");
    if (h->face_solid != h->solid) {
        fputc(',', out);
        good = write_word(out, "surface_of", scene_solid_name(t->s, h->face_solid)) && good;
    }
    write_factors(out, h);
    if (t->for_page)
        write_snell(out, h);
    fputc('}', out);
    return good;
}

/* Further keys of a ray, which follow those of the fixed schema. */
static bool write_extras(const traced *t, FILE *out, const ray_node *node)
{
    bool good = true;
    const ray_line line = ray_line_of(node);
    double far_end[4];
    if (scene_settings(t->s)->polarisation)
        write_list(out, "stokes", node->stokes, 4);
    if (node->kind == RAY_SHADOW && node->light >= 0) {
        fputc(',', out);
        good = write_word(out, "light", scene_light_name(t->s, node->light));
        write_number(out, "light_distance", node->light_distance);
    }
    write_list(out, "brought", node->brought, 3);
    if (node->kind == RAY_SHADOW)
        write_number(out, "let_through", node->let_through);
    ray_line_far_end(&line, far_end);
    write_list(out, "far_end", far_end, 4);
    return good;
}

/* Recurses over the levels of the tree, at most 65. */
bool trace_write_json_ray(const traced *t, FILE *out, int at)
{
    const ray_node *node = &t->tree->node[at];
    fprintf(out, "\n{\"kind\":\"%s\",\"depth\":%d", trace_kind_words[node->kind], node->depth);
    write_vector(out, "origin", node->origin);
    write_vector(out, "direction", node->direction);
    write_list(out, "throughput", node->throughput, 3);
    fputc(',', out);
    bool good = write_word(out, "medium", probe_medium_name(t->p, node->medium));
    write_number(out, "n", node->n);
    fputs(",\"hit\":", out);
    if (node->end == RAY_END_HIT)
        good = write_hit(t, out, &node->hit) && good;
    else
        fputs("null", out);
    fputs(",\"children\":[", out);
    for (int i = node->first_child; i != RAY_NONE && !cancel_asked(); i = t->tree->node[i].next) {
        good = trace_write_json_ray(t, out, i) && good;
        fputs(t->tree->node[i].next == RAY_NONE ? "" : ",", out);
    }
    fprintf(out, "],\"end\":\"%s\"", trace_end_words[node->end]);
    good = write_extras(t, out, node) && good;
    fputc('}', out);
    return good;
}

status trace_write_json(const traced *t, FILE *out, diagnostic *why)
{
    const ray_tree *tree = t->tree;
    fputs("{\"schema\":1,", out);
    bool good = write_word(out, "scene", t->scene_path);
    fprintf(out, ",\"depth\":%d", tree->depth_limit);
    write_list(out, "radiance", tree->radiance, 3);
    fputs(",\"root\":", out);
    good = trace_write_json_ray(t, out, 0) && good;
    if (tree->node[0].next != RAY_NONE) {
        fputs(",\"roots\":[", out);
        for (int i = 0; i != RAY_NONE; i = tree->node[i].next) {
            fputs(i ? "," : "", out);
            good = trace_write_json_ray(t, out, i) && good;
        }
        fputc(']', out);
    }
    write_number(out, "lambda_nm", tree->lambda_nm);
    if (t->for_page)
        write_bytes(out, "displayed", t->s, tree->radiance);
    fprintf(out, ",\"carries\":\"%s\"", scene_has_basic_radiance(scene_settings(t->s)) ? "basic" : "classic");
    fputs("}\n", out);
    TRY(cancel_check(why));
    return good ? STATUS_OK : diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory while writing JSON");
}
