/* Texture shading: texture coordinates of hit points, pixel footprints, and texture colours. */
#include "render/shade/shading.h"

#include "geometry/primitives/primitive.h"

/* Width of a pixel at the point, across the ray: camera rays spread by the pixel's angle, unless they are parallel. For
 * deeper rays the path from the camera is treated as straight, which ignores magnification by mirrors and lenses. */
static double pixel_width(const plan *p, vec3 point)
{
    return 2.0 * p->view.half_height / (double)p->render.height *
           camera_spread(&p->view, vec3_length(vec3_sub(point, p->view.eye)));
}

void texture_colors(tracer *t, const primitive *surface)
{
    const plan *p = t->target.frame_plan;
    group *g = &t->surface.gathered;
    const double size = t->surface.mat->surface.texture_size;
    double u[ROW], v[ROW], footprint[ROW];
    for (int k = 0; k < g->count; k++) {
        const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
        const surface_mapping m =
            t->surface.on_mesh ? t->meshes->mapping[k]
                               : primitive_mapping(surface, g->points.face[k],
                                                   t->surface.texture_at ? t->surface.texture_at[k] : point, size);
        /* An isotropic filter: at grazing incidence the footprint is limited to 20 pixel widths, or all would blur. */
        const double cosine = g->points.cos_i[k] > 0.05 ? g->points.cos_i[k] : 0.05;
        u[k] = m.u, v[k] = m.v;
        footprint[k] = pixel_width(p, point) / cosine * m.per_length;
    }
    t->shade->tint(t->surface.mat->img, g->count, u, v, footprint, g->cr, g->cg, g->cb);
}
