/* A fan of rays as CSV, one row per ray. */
#include "base/cancel.h"
#include "report/fan_writers.h"
#include "base/csv.h"
#include "scene/model/open.h"

static void add_vector(csv_line *line, bool there, vec3 v)
{
    csv_real(line, there ? v.x : (double)NAN);
    csv_real(line, there ? v.y : (double)NAN);
    csv_real(line, there ? v.z : (double)NAN);
}

const char *fan_end_words(const fanned *t, const fan_ray *ray)
{
    const ray_node *last = &t->f->node[ray->first + ray->count - 1];
    if (last->end == RAY_END_HIT)
        return scene_solid_name(t->s, last->hit.solid);
    return last->end == RAY_END_SKY ? "sky" : "cut";
}

status fan_write_csv(const fanned *t, FILE *out, diagnostic *why)
{
    csv_line line = {0};
    fprintf(out,
            "ray,%s,interfaces,end,exit_x,exit_y,exit_z,direction_x,direction_y,direction_z,deviation_deg,weight,axis_"
            "at,axis_x,axis_y,axis_z\n",
            t->rule->spreads ? "offset_deg" : "offset");
    for (int i = 0; i < t->f->count && !cancel_asked(); i++) {
        const fan_ray *ray = &t->f->ray[i];
        csv_count(&line, i);
        csv_real(&line, ray->offset);
        csv_count(&line, (int64_t)ray->count - 1);
        csv_text(&line, fan_end_words(t, ray));
        add_vector(&line, ray->leaves, ray->exit_point);
        add_vector(&line, ray->leaves, ray->exit_direction);
        csv_real(&line, ray->leaves ? ray->deviation_deg : (double)NAN);
        csv_real(&line, ray->leaves ? ray->weight : (double)NAN);
        csv_real(&line, ray->crosses_axis ? ray->axis_at : (double)NAN);
        add_vector(&line, ray->crosses_axis, ray->axis_point);
        csv_end(&line);
    }
    const bool failed = line.failed, cancelled = cancel_asked();
    if (!failed && !cancelled)
        fwrite(line.text, 1, line.size, out);
    csv_line_free(&line);
    return failed ? out_of_memory(why) : cancelled ? cancel_check(why) : STATUS_OK;
}
