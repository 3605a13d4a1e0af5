/* A ray tree as indented text, one line per ray. */
#include "base/cancel.h"
#include "report/trace_writers.h"
#include "base/elementary.h"
#include "scene/model/open.h"
#include <math.h>

const char *const trace_kind_words[] = {"camera", "reflect", "refract", "shadow"};
const char *const trace_end_words[] = {"hit", "sky", "cut_depth", "cut_weight", "lit", "blocked"};

/* One number if the channels are equal, otherwise three. */
static void write_channels(FILE *out, const double c[3])
{
    if (c[0] == c[1] && c[1] == c[2])
        fprintf(out, "%.6g", c[0]);
    else
        fprintf(out, "%.6g,%.6g,%.6g", c[0], c[1], c[2]);
}

double trace_angle_deg(double cosine)
{
    return elementary_atan2_deg(sqrt(fmax(0.0, 1.0 - cosine * cosine)), cosine);
}

static void write_hit(const traced *t, FILE *out, const ray_hit *h)
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

static void write_line(const traced *t, FILE *out, const ray_node *node, int indent)
{
    fprintf(out, "%*s%s  depth %d  in %s n %.6g  weight ", 2 * indent, "", trace_kind_words[node->kind], node->depth,
            probe_medium_name(t->p, node->medium), node->n);
    write_channels(out, node->throughput);
    if (node->light >= 0)
        fprintf(out, "  to %s at %.9g", scene_light_name(t->s, node->light), node->light_distance);
    fprintf(out, "  %s", trace_end_words[node->end]);
    if (node->end == RAY_END_LIT)
        fprintf(out, ", transmittance %.6g", node->let_through);
    if (node->end == RAY_END_HIT)
        write_hit(t, out, &node->hit);
    if (node->brought[0] > 0.0 || node->brought[1] > 0.0 || node->brought[2] > 0.0) {
        fputs("  contributes ", out);
        write_channels(out, node->brought);
    }
    fputc('\n', out);
}

/* The nodes are in depth-first order, so that each node is followed by its children. */
void trace_write_text_rays(const traced *t, FILE *out)
{
    for (size_t i = 0; i < t->tree->count && !cancel_asked(); i++) {
        const ray_node *node = &t->tree->node[i];
        write_line(t, out, node, node->kind == RAY_SHADOW ? node->depth + 1 : node->depth);
    }
}

status trace_write_text(const traced *t, FILE *out, diagnostic *why)
{
    const ray_tree *tree = t->tree;
    trace_write_text_rays(t, out);
    TRY(cancel_check(why));
    fprintf(out, "radiance %.9g %.9g %.9g  rays %zu, depth limit %d, %.6g nm\n", tree->radiance[0], tree->radiance[1],
            tree->radiance[2], tree->count, tree->depth_limit, tree->lambda_nm);
    return STATUS_OK;
}
