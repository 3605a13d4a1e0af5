/* Ray trees as comma-separated values: a row for each ray of a pixel, a free ray or the beams. cuvette-trace(1)
 * describes the columns. */
#include "base/cancel.h"
#include "base/csv.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"

static const char header[] =
    "beam,field,number,lambda_nm,power,ray,parent,kind,depth,medium,n,origin_x,origin_y,origin_z,direction_x,"
    "direction_y,direction_z,weight,end,solid,surface,length,point_x,point_y,point_z,medium_behind,n_behind,"
    "incidence_deg,refraction_deg,R,T,transmittance\n";

static double mean(const double rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

static void add_point(csv_buffer *line, const vec3 *p)
{
    csv_real(line, p ? p->x : (double)NAN);
    csv_real(line, p ? p->y : (double)NAN);
    csv_real(line, p ? p->z : (double)NAN);
}

static void add_hit(csv_buffer *line, const traced *t, const ray_hit *h)
{
    const bool passes = !h->opaque && !h->tir;
    csv_text(line, scene_solid_name(t->s, h->solid));
    csv_text(line, probe_face_name(t->p, h));
    csv_real(line, h->t);
    add_point(line, &h->point);
    csv_text(line, h->opaque ? NULL : probe_medium_name(t->p, h->to));
    csv_real(line, h->opaque ? (double)NAN : h->n_to);
    csv_real(line, trace_angle_deg(h->cos_i));
    csv_real(line, passes ? trace_angle_deg(h->cos_t) : (double)NAN);
    csv_real(line, h->R);
    csv_real(line, h->T);
    csv_real(line, mean(h->transmittance));
}

/* What a ray without a surface has: a shadow ray ends at its light. */
static void add_no_hit(csv_buffer *line, const traced *t, const ray_node *node)
{
    const bool lit = node->kind == RAY_SHADOW && node->light >= 0;
    csv_text(line, lit ? scene_light_name(t->s, node->light) : NULL);
    csv_text(line, NULL);
    csv_real(line, lit ? node->light_distance : (double)NAN);
    for (int i = 0; i < 9; i++)
        csv_text(line, NULL);
    csv_real(line, node->kind == RAY_SHADOW ? node->shadow_transmittance : (double)NAN);
}

static void add_node(csv_buffer *line, const traced *t, const ray_node *node)
{
    csv_count(line, node - t->tree->node);
    csv_count(line, node->parent);
    csv_text(line, trace_kind_word(node));
    csv_count(line, node->depth);
    csv_text(line, probe_medium_name(t->p, node->medium));
    csv_real(line, node->n);
    add_point(line, &node->origin);
    add_point(line, &node->direction);
    csv_real(line, mean(node->throughput));
    csv_text(line, trace_end_word(node));
    if (node->end == RAY_END_HIT)
        add_hit(line, t, &node->hit);
    else
        add_no_hit(line, t, node);
    csv_end(line);
}

/* name: of the beam; NULL, with ray NULL, for the tree of a pixel or of a free ray. */
static status write_rows(const traced *t, const char *name, const beam_ray *ray, FILE *out, diagnostic *why)
{
    csv_buffer lines = {0};
    for (size_t i = 0; i < t->tree->count && !lines.failed && !cancel_asked(); i++) {
        csv_text(&lines, name);
        csv_count(&lines, ray ? ray->field : -1);
        csv_count(&lines, ray ? ray->number : -1);
        csv_real(&lines, ray ? ray->lambda_nm : t->tree->lambda_nm);
        csv_real(&lines, ray ? ray->power : (double)NAN);
        add_node(&lines, t, &t->tree->node[i]);
    }
    const bool failed = lines.failed;
    if (!failed && lines.size > 0)
        fwrite(lines.text, 1, lines.size, out);
    csv_buffer_free(&lines);
    return failed ? out_of_memory(why) : cancel_check(why);
}

status trace_write_csv(const traced *t, FILE *out, diagnostic *why)
{
    fputs(header, out);
    return write_rows(t, NULL, NULL, out, why);
}

typedef struct row_writer {
    const beam_output *beams;
    FILE *out;
} row_writer;

static status write_beam_rows(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    const row_writer *w = context;
    const scene *s = w->beams->s;
    return write_rows(&(traced){s, p, tree, w->beams->scene_path, false}, s->beams[ray->beam].name, ray, w->out, why);
}

status beams_write_csv(const beam_output *b, FILE *out, diagnostic *why)
{
    row_writer w = {b, out};
    fputs(header, out);
    return beams_each_ray(b->s, b->level, 0, write_beam_rows, &w, why);
}
