/* A fan of rays as JSON: the points of each path, where neighbours cross, and the mean focus. */
#include "render/inspect/ray_line.h"
#include "report/fan_writers.h"
#include "report/json.h"

static json_t *point(vec3 p)
{
    return json_pack("[o,o,o]", json_of_real(p.x), json_of_real(p.y), json_of_real(p.z));
}

/* Where its segments begin, and where the last one ends, unless it leads into the sky or is cut. */
static json_t *path_points(const fan *f, const fan_ray *ray)
{
    const ray_node *node = &f->node[ray->first], *last = node + ray->count - 1;
    json_t *list = json_array();
    int bad = 0;
    for (size_t i = 0; i < ray->count; i++)
        bad |= json_array_append_new(list, point(node[i].origin));
    if (last->end == RAY_END_HIT)
        bad |= json_array_append_new(list, point(last->hit.point));
    return json_whole(list, bad == 0);
}

/* The end of the last segment's line. */
static json_t *far_end(const fan *f, const fan_ray *ray)
{
    const ray_line line = ray_line_of(&f->node[ray->first + ray->count - 1]);
    double xyzw[4];
    ray_line_far_end(&line, xyzw);
    return json_pack("[o,o,o,o]", json_of_real(xyzw[0]), json_of_real(xyzw[1]), json_of_real(xyzw[2]),
                     json_of_real(xyzw[3]));
}

static json_t *ray_json(const fanned *t, const fan_ray *ray)
{
    const double none = NAN;
    return json_pack("{s:o,s:I,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "offset", json_of_real(ray->offset), "interfaces",
                     (json_int_t)ray->count - 1, "end", json_of_text(fan_end_words(t, ray)), "deviation_deg",
                     json_of_real(ray->leaves ? ray->deviation_deg : none), "weight",
                     json_of_real(ray->leaves ? ray->weight : none), "axis_at",
                     json_of_real(ray->crosses_axis ? ray->axis_at : none), "direction",
                     ray->leaves ? point(ray->exit_direction) : json_null(), "points", path_points(t->f, ray),
                     "far_end", far_end(t->f, ray));
}

static json_t *focus_json(const fan *f)
{
    return f->has_focus ? json_pack("{s:o,s:o,s:b}", "at", point(f->focus), "rms", json_of_real(f->focus_rms),
                                    "virtual", (int)f->is_virtual)
                        : json_null();
}

json_t *fan_json(const fanned *t)
{
    const fan *f = t->f;
    json_t *rays = json_array(), *crossings = json_array();
    int bad = 0, left = 0;
    for (int i = 0; i < f->count; i++) {
        left += f->ray[i].leaves;
        bad |= json_array_append_new(rays, ray_json(t, &f->ray[i]));
    }
    for (int i = 0; i < f->crossing_count; i++)
        bad |= json_array_append_new(crossings,
                                     json_pack("{s:i,s:o}", "ray", f->crossing[i].ray, "at", point(f->crossing[i].at)));
    json_t *o = json_pack("{s:i,s:i,s:o,s:o,s:o,s:o}", "count", f->count, "followed", left, "axis", point(f->axis),
                          "focus", focus_json(f), "crossings", crossings, "rays", rays);
    return json_whole(o, bad == 0);
}
