/* An arrow behind a glass of water: solids named vessel, liquid and arrow (experiments/scenes/arrow.yaml). The eye is
 * at the camera's distance from the axis, on the level of the middle of the liquid. A line of sight near the axis meets
 * the arrow's plane behind the glass at a share of the place that it met without the glass; where the share is
 * negative, the arrow is seen turned around. */
#include "realism/metrics.h"

#include "scene/model/scene.h"
#include <math.h>

#define OFFSET 1e-4 /* from the axis, of the inner radius */

bool arrow_is_there(const scene *s)
{
    return scene_find_solid(s, "arrow") >= 0 && scene_find_solid(s, "vessel") >= 0 &&
           scene_find_solid(s, "liquid") >= 0;
}

/* Where the path, refracted by the glass, meets the plane: distance from the axis. */
static status place_of(trial *t, const setup *at, double eye, double offset, double behind, double *place,
                       diagnostic *why)
{
    const double sine = offset / eye;
    const vec3 from = vec3_make(at->x, (at->low + at->high) / 2.0, at->z - eye);
    TRY(probe_path(t->p, from, vec3_make(sine, 0.0, sqrt(1.0 - sine * sine)), -1, &t->tree, why));
    const ray_node *last = &t->tree.node[t->tree.count - 1];
    const double way = (at->z + behind - last->origin.z) / last->direction.z;
    *place = last->end == RAY_END_SKY ? last->origin.x + way * last->direction.x - at->x : NAN;
    return STATUS_OK;
}

status arrow_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    setup at;
    TRY(setup_read_glass(m->traced, &at, why));
    const vec3 from = m->traced->camera.position;
    const double eye = hypot(from.x - at.x, from.z - at.z), offset = OFFSET * at.inner;
    const theory_shells c = setup_shells(&at);
    if (eye <= at.outer)
        return diagnose(why, STATUS_BAD_INPUT, "move the camera away from the vessel", "the eye is inside 'vessel'");
    trial t;
    status code = trial_start(&t, arrange_vessel(m->traced, &at), m->level, why);
    for (int i = 11; i <= 100 && code == STATUS_OK; i++) {
        const double behind = 0.1 * i * at.outer, without = (eye + behind) * tan(asin(offset / eye));
        double place = NAN;
        code = place_of(&t, &at, eye, offset, behind, &place, why);
        curve_add(out, behind, place / without, theory_shells_place(&c, eye, behind, offset) / without);
    }
    trial_end(&t);
    return code;
}
