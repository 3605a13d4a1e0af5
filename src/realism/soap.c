/* Interference in a thin film: the solid named film1, a box with a film on it (experiments/scenes/soap.yaml), in the
 * camera's direction of view. Its reflectance at render.lambda_nm is traced for films of many thicknesses. */
#include "realism/metrics.h"

#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

bool soap_is_there(const scene *s)
{
    const int at = scene_find_solid(s, "film1");
    return at >= 0 && s->solids[at].visible && s->solids[at].shape.kind == SHAPE_BOX &&
           s->solids[at].surface.film_thickness_nm > 0.0;
}

/* A copy with film1 alone. */
static scene *film_alone(const scene *s, int film, double thickness_nm)
{
    scene *copy = scene_clone(s);
    for (size_t i = 0; copy && i < copy->solid_count; i++)
        copy->solids[i].visible = (int)i == film;
    if (copy) {
        copy->solids[film].surface.film_thickness_nm = thickness_nm;
        copy->render.spectrum = SPECTRUM_SPECTRAL; /* an rgb film has a table of colours, which is not read here */
        copy->render.wavelengths = 1;
    }
    return copy;
}

status soap_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    const scene *s = m->traced;
    const int film = scene_find_solid(s, "film1");
    const solid *one = &s->solids[film];
    const vec3 sight = vec3_normalize(vec3_sub(s->camera.target, s->camera.position)),
               normal = mat3_apply(rotation_from_deg(one->shape.rotation_deg), vec3_make(0.0, 0.0, 1.0));
    const index_law around = surrounding_index_law(&s->background);
    const double n = index_law_at(&around, s->render.lambda_nm), facing = vec3_dot(sight, normal),
                 behind = n * relative_index(s, film, s->render.lambda_nm), angle = acos(fmin(fabs(facing), 1.0));
    const vec3 face = vec3_sub(one->shape.position, vec3_scale(normal, copysign(0.5 * one->shape.size.z, facing)));
    status code = STATUS_OK;
    for (int i = 1; i <= 200 && code == STATUS_OK; i++) {
        const double thickness_nm = 5.0 * i;
        trial t;
        code = trial_start(&t, film_alone(s, film, thickness_nm), m->level, why);
        THEN(code, probe_path(t.p, vec3_sub(face, vec3_scale(sight, 2.0)), sight, -1, &t.tree, why));
        if (code == STATUS_OK)
            curve_add(out, thickness_nm, t.tree.node[0].hit.R,
                      theory_film(angle, n, one->surface.film_ior, behind, thickness_nm / s->render.lambda_nm));
        trial_end(&t);
    }
    return code;
}
