/* Texture shading: texture coordinates of hit points, pixel footprints, and texture colours. */
#include "render/shade/shading.h"

#include "geometry/primitives/primitive.h"

/* Width of a pixel at the point, across the ray: camera rays spread by the pixel's angle. For deeper rays the path from
 * the camera is treated as straight, which ignores magnification by mirrors and lenses. */
static double pixel_width(const plan *p, vec3 point)
{
    return 2.0 * p->view.half_height / (double)p->render.height * vec3_length(vec3_sub(point, p->view.eye));
}

void texture_colors(tracer *t, const primitive *surface)
{
    const plan *p = t->target.frame_plan;
    group *g = &t->surface.gathered;
    const double size = t->surface.mat->surface.texture_size;
    for (int k = 0; k < g->count; k++) {
        const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
        const surface_mapping m =
            t->surface.on_mesh ? (surface_mapping){t->meshes->points.tu[k], t->meshes->points.tv[k],
                                                   t->meshes->points.uv_per_length[k]}
                               : primitive_mapping(surface, g->points.face[k],
                                                   t->surface.texture_at ? t->surface.texture_at[k] : point, size);
        /* An isotropic filter: at grazing incidence the footprint is limited to 20 pixel widths, or all would blur. */
        const double cosine = g->points.cos_i[k] > 0.05 ? g->points.cos_i[k] : 0.05;
        const vec3 c = texture_sample(t->surface.mat->img, m.u, m.v, pixel_width(p, point) / cosine * m.per_length);
        g->cr[k] *= c.x, g->cg[k] *= c.y, g->cb[k] *= c.z;
    }
}
