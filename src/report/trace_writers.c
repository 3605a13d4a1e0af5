/* Writes ray trees, and the ray trees of beams, as text and JSON. */
#include "report/trace_writers.h"
#include "base/cancel.h"
#include "base/elementary.h"
#include "image/codec.h"
#include "render/inspect/ray_line.h"
#include "report/json.h"
#include "scene/model/camera.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include <math.h>

/* --- text --- */

enum { INDENT_MAX = DEPTH_TREE_MAX + 1 };

static const char *const kind_words[] = {"camera", "reflect", "refract", "shadow"};
static const char *const end_words[] = {"hit", "sky", "cut_depth", "cut_weight", "lit", "blocked"};

/* One number if the channels are equal, otherwise three. */
static void write_channels(FILE *out, const double c[3])
{
    if (c[0] == c[1] && c[1] == c[2])
        fprintf(out, "%.6g", c[0]);
    else
        fprintf(out, "%.6g,%.6g,%.6g", c[0], c[1], c[2]);
}

const char *trace_kind_word(const ray_node *node)
{
    return kind_words[node->kind];
}

const char *trace_end_word(const ray_node *node)
{
    return end_words[node->end];
}

double trace_angle_deg(double cosine)
{
    return elementary_atan2_deg(sqrt(fmax(0.0, 1.0 - cosine * cosine)), cosine);
}

static void write_text_hit(const traced *t, FILE *out, const ray_hit *h)
{
    fprintf(out, "  %s %s  t %.9g", scene_solid_name(t->s, h->solid), probe_face_name(t->p, h), h->t);
    if (h->face_solid != h->solid)
        fprintf(out, " (a face of %s)", scene_solid_name(t->s, h->face_solid));
    if (h->opaque) {
        fprintf(out, "  %.4f deg, opaque, reflects %.6g", trace_angle_deg(h->cos_i), h->R);
    } else {
        fprintf(out, "  n %.6g to %.6g  %.4f deg to ", h->n_from, h->n_to, trace_angle_deg(h->cos_i));
        if (h->tir)
            fputs("none, TIR", out);
        else
            fprintf(out, "%.4f deg", trace_angle_deg(h->cos_t));
        fprintf(out, "  R_s %.6g R_p %.6g R %.6g T %.6g", h->R_s, h->R_p, h->R, h->T);
        if (!h->tir)
            fprintf(out, "  radiance x %.6g, basic x %.6g", h->gain_classic, h->gain_basic);
    }
    fputs("  transmits ", out);
    write_channels(out, h->transmittance);
}

static void write_text_line(const traced *t, FILE *out, const ray_node *node, int indent)
{
    fprintf(out, "%*s%s  depth %d  in %s n %.6g  weight ", 2 * indent, "", kind_words[node->kind], node->depth,
            probe_medium_name(t->p, node->medium), node->n);
    write_channels(out, node->throughput);
    if (node->light >= 0)
        fprintf(out, "  to %s at %.9g", scene_light_name(t->s, node->light), node->light_distance);
    fprintf(out, "  %s", end_words[node->end]);
    if (node->end == RAY_END_LIT)
        fprintf(out, ", transmittance %.6g", node->shadow_transmittance);
    if (node->end == RAY_END_HIT)
        write_text_hit(t, out, &node->hit);
    if (node->contribution[0] > 0.0 || node->contribution[1] > 0.0 || node->contribution[2] > 0.0) {
        fputs("  contributes ", out);
        write_channels(out, node->contribution);
    }
    fputc('\n', out);
}

/* The nodes are in depth-first order, so that each node is followed by its children. Indentation ends at the greatest
 * depth of a tree: the path of a beam can be so deep that most of its text would be spaces. */
static void write_text_rays(const traced *t, FILE *out)
{
    for (size_t i = 0; i < t->tree->count && !cancel_asked(); i++) {
        const ray_node *node = &t->tree->node[i];
        const int level = node->kind == RAY_SHADOW ? node->depth + 1 : node->depth;
        write_text_line(t, out, node, level < INDENT_MAX ? level : INDENT_MAX);
    }
}

/* What was not traced: nothing vanishes in silence. */
static void write_text_cut(FILE *out, const ray_cut *depth, const ray_cut *weight)
{
    fprintf(out, "cut by depth: %zu rays, weight %.6g; by least weight: %zu rays, weight %.6g\n", depth->rays,
            depth->weight, weight->rays, weight->weight);
}

status trace_write_text(const traced *t, FILE *out, diagnostic *why)
{
    const ray_tree *tree = t->tree;
    write_text_rays(t, out);
    TRY(cancel_check(why));
    const ray_cut depth = ray_tree_cut(tree, RAY_END_CUT_DEPTH), weight = ray_tree_cut(tree, RAY_END_CUT_WEIGHT);
    if (depth.rays + weight.rays > 0)
        write_text_cut(out, &depth, &weight);
    fprintf(out, "radiance %.9g %.9g %.9g  rays %zu, depth limit %d, %.6g nm\n", tree->radiance[0], tree->radiance[1],
            tree->radiance[2], tree->count, tree->depth_limit, tree->lambda_nm);
    return STATUS_OK;
}

/* --- JSON --- */

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

/* The bytes of a radiance in the image. */
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

/* Both sides of Snell's law, and the angles; null if no ray is refracted. */
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

static void write_json_cut(FILE *out, const ray_cut *depth, const ray_cut *weight)
{
    fprintf(out, ",\"cut_depth\":{\"rays\":%zu", depth->rays);
    write_number(out, "weight", depth->weight);
    fprintf(out, "},\"cut_weight\":{\"rays\":%zu", weight->rays);
    write_number(out, "weight", weight->weight);
    fputc('}', out);
}

static bool write_json_hit(const traced *t, FILE *out, const ray_hit *h)
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
    write_list(out, "contribution", node->contribution, 3);
    if (node->kind == RAY_SHADOW)
        write_number(out, "shadow_transmittance", node->shadow_transmittance);
    ray_line_far_end(&line, far_end);
    write_list(out, "far_end", far_end, 4);
    return good;
}

/* Writes a ray up to the list of its children, which close_json_ray ends. */
static bool open_json_ray(const traced *t, FILE *out, const ray_node *node)
{
    fprintf(out, "\n{\"kind\":\"%s\",\"depth\":%d", kind_words[node->kind], node->depth);
    write_vector(out, "origin", node->origin);
    write_vector(out, "direction", node->direction);
    write_list(out, "throughput", node->throughput, 3);
    fputc(',', out);
    bool good = write_word(out, "medium", probe_medium_name(t->p, node->medium));
    write_number(out, "n", node->n);
    fputs(",\"hit\":", out);
    if (node->end == RAY_END_HIT)
        good = write_json_hit(t, out, &node->hit) && good;
    else
        fputs("null", out);
    fputs(",\"children\":[", out);
    return good;
}

static bool close_json_ray(const traced *t, FILE *out, const ray_node *node)
{
    fprintf(out, "],\"end\":\"%s\"", end_words[node->end]);
    const bool good = write_extras(t, out, node);
    fputc('}', out);
    return good;
}

/* Writes a ray and its descendants. A loop, not a recursion: a beam without branches has up to BEAM_DEPTH_MAX + 2
 * levels, too many for a small stack. */
static bool write_json_ray(const traced *t, FILE *out, int root)
{
    const ray_node *nodes = t->tree->node;
    bool good = true;
    for (int at = root; !cancel_asked();) {
        good = open_json_ray(t, out, &nodes[at]) && good;
        if (nodes[at].first_child != RAY_NONE) {
            at = nodes[at].first_child;
            continue;
        }
        good = close_json_ray(t, out, &nodes[at]) && good;
        while (at != root && nodes[at].next == RAY_NONE) {
            at = nodes[at].parent;
            good = close_json_ray(t, out, &nodes[at]) && good;
        }
        if (at == root)
            break;
        at = nodes[at].next;
        fputc(',', out);
    }
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
    good = write_json_ray(t, out, 0) && good;
    if (tree->node[0].next != RAY_NONE) {
        fputs(",\"roots\":[", out);
        for (int i = 0; i != RAY_NONE; i = tree->node[i].next) {
            fputs(i ? "," : "", out);
            good = write_json_ray(t, out, i) && good;
        }
        fputc(']', out);
    }
    write_number(out, "lambda_nm", tree->lambda_nm);
    if (t->for_page)
        write_bytes(out, "displayed", t->s, tree->radiance);
    const ray_cut depth = ray_tree_cut(tree, RAY_END_CUT_DEPTH), weight = ray_tree_cut(tree, RAY_END_CUT_WEIGHT);
    fprintf(out, ",\"carries\":\"%s\"", scene_has_basic_radiance(scene_settings(t->s)) ? "basic" : "classic");
    write_json_cut(out, &depth, &weight);
    fputs("}\n", out);
    TRY(cancel_check(why));
    return good ? STATUS_OK : diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory while writing JSON");
}

/* --- beams --- */

static const char *const beam_kind_words[] = {"pencil", "fan", "sheet", "bundle"};

typedef struct beam_writer {
    const beam_output *beams;
    FILE *out;
    int beam; /* the beam whose JSON object is open; -1: none */
    size_t segments;
    ray_cut depth, weight; /* of all rays so far; weights in units of power */
    bool short_of_memory;
} beam_writer;

static void add_cut(ray_cut *sum, const ray_tree *tree, ray_end end, double power)
{
    const ray_cut cut = ray_tree_cut(tree, end);
    sum->rays += cut.rays;
    sum->weight += power * cut.weight;
}

static status count_segments(beam_writer *w, const beam_ray *ray, const ray_tree *tree, diagnostic *why)
{
    w->segments += tree->count;
    add_cut(&w->depth, tree, RAY_END_CUT_DEPTH, ray->power);
    add_cut(&w->weight, tree, RAY_END_CUT_WEIGHT, ray->power);
    if (w->beams->segments_max == 0 || w->segments <= w->beams->segments_max)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT,
                    "lower 'rays', 'wavelengths' or 'depth' of a beam, or raise its 'min_fraction'",
                    "the beams have more than %zu segments", w->beams->segments_max);
}

static status write_beam_text(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    beam_writer *w = context;
    const beam *b = &w->beams->s->beams[ray->beam];
    TRY(count_segments(w, ray, tree, why));
    fprintf(w->out, "%s: %s, ", b->name, beam_kind_words[b->kind]);
    if (beam_fields(b) > 1)
        fprintf(w->out, "field point %d (of %d), ", ray->field, beam_fields(b));
    fprintf(w->out, "ray %d (of %d), %.6g nm, power %.6g\n", ray->number, ray->rays, ray->lambda_nm, ray->power);
    write_text_rays(&(traced){w->beams->s, p, tree, w->beams->scene_path, false}, w->out);
    return STATUS_OK;
}

status beams_write_text(const beam_output *b, FILE *out, diagnostic *why)
{
    beam_writer w = {.beams = b, .out = out, .beam = -1};
    TRY(beams_each_ray(b->s, b->level, 0, write_beam_text, &w, why));
    if (w.depth.rays + w.weight.rays > 0)
        write_text_cut(out, &w.depth, &w.weight);
    return STATUS_OK;
}

static void close_beam(beam_writer *w)
{
    fputs(w->beam >= 0 ? "]}" : "", w->out);
}

static status write_beam_json(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    beam_writer *w = context;
    const beam *b = &w->beams->s->beams[ray->beam];
    TRY(count_segments(w, ray, tree, why));
    if (w->beam != ray->beam) {
        close_beam(w);
        fputs(w->beam >= 0 ? ",\n{\"name\":" : "{\"name\":", w->out);
        w->short_of_memory |= !json_write_text(w->out, b->name);
        fprintf(w->out, ",\"kind\":\"%s\"", beam_kind_words[b->kind]);
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
    write_list(w->out, "color", rgb, 3);
    if (w->beams->for_page)
        fprintf(w->out, ",\"displayed\":[%u,%u,%u]", codec_quantize((float)rgb[0], 255),
                codec_quantize((float)rgb[1], 255), codec_quantize((float)rgb[2], 255));
    fputs(",\"root\":", w->out);
    w->short_of_memory |=
        !write_json_ray(&(traced){w->beams->s, p, tree, w->beams->scene_path, w->beams->for_page}, w->out, 0);
    fprintf(w->out, ",\"field\":%d}", ray->field);
    return STATUS_OK;
}

status beams_write_json(const beam_output *b, FILE *out, diagnostic *why)
{
    beam_writer w = {.beams = b, .out = out, .beam = -1};
    fputs("{\"schema\":1,\"scene\":", out);
    w.short_of_memory = !json_write_text(out, b->scene_path);
    fputs(",\"beams\":[", out);
    TRY(beams_each_ray(b->s, b->level, 0, write_beam_json, &w, why));
    close_beam(&w);
    fprintf(out, "],\"segments\":%zu", w.segments);
    write_json_cut(out, &w.depth, &w.weight);
    fputs("}\n", out);
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
