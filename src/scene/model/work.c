/* Estimates the work of a scene from its parameters (work.h). */
#include "scene/model/scene.h"

#include <math.h>

static double triangles_of(const mesh_entry *m)
{
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE:
    case MESH_DENSE:
    case MESH_SPHERE: return (double)m->count;
    case MESH_ICOSPHERE:
    case MESH_SLIME: return 20.0 * pow(4.0, (double)m->level);
    case MESH_TORUS: return 2.0 * (double)m->around * (double)m->tube;
    case MESH_LATHE: return (double)m->around * ((double)m->profile.count - 2.0); /* two numbers per point */
    case MESH_TERRAIN: /* the heights; if it has a bottom, also 4 for the walls and 2 for the bottom per cell of the
                          edge */
        return 2.0 * (double)m->around * (double)m->tube + (m->depth > 0.0 ? 6.0 * (double)(m->around + m->tube) : 0.0);
    case MESH_BOX:
    case MESH_FILE:
    case MESH_ARRAYS: break;
    }
    return 12.0;
}

double scene_planned_triangles(const scene *s)
{
    double triangles = 0.0;
    for (size_t i = 0; i < s->mesh_count; i++)
        triangles += triangles_of(&s->meshes[i]);
    return triangles;
}

double scene_camera_rays(const render_settings *r)
{
    const double rays =
        integrator_traits_of(r)->by_chance ? fmax((double)r->paths, (double)r->samples) : (double)r->samples;
    const double wavelengths = r->spectrum == SPECTRUM_SPECTRAL ? (double)r->wavelengths : 1.0;
    return (double)r->width * (double)r->height * rays * wavelengths;
}

double scene_rays_bound(const render_settings *r)
{
    const double levels = (double)r->depth + 1.0;
    const double tree = fmin(exp2(levels), r->min_weight > 0.0 ? levels / r->min_weight : INFINITY);
    return scene_camera_rays(r) * (integrator_traits_of(r)->by_chance ? levels : tree);
}

double slime_work(const mesh_entry *m)
{
    const double steps = floor(m->time_s / m->slime.dt_s + 0.5); /* counted as by softbody_advance */
    return steps * (10.0 * pow(4.0, (double)m->level) + 2.0);
}
