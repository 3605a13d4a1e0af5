/* The kernels of camera rays, compiled once for each instruction set. */
#include "render/camera/camera_kernels.h"

#include "base/lanes.h"
#include "base/isa.h"
#include <math.h>

static void directions(const camera_frame *view, int count, const double *u, const double *v, double *restrict dx,
                       double *restrict dy, double *restrict dz)
{
    const camera_frame f = *view;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const vec3 d = camera_toward(&f, u[i], v[i]);
        dx[i] = d.x;
        dy[i] = d.y;
        dz[i] = d.z;
    }
}

/* Uniform over the lens's disc: the area within a radius grows as its square. */
static void rays(const camera_frame *view, int count, const double *u, const double *v, lens_points lens,
                 camera_rays_out out)
{
    const camera_frame f = *view;
    const double *area = lens.area, *turn = lens.turn;
    double *restrict ox = out.ox, *restrict oy = out.oy, *restrict oz = out.oz;
    double *restrict dx = out.dx, *restrict dy = out.dy, *restrict dz = out.dz;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        const double radius = f.lens_radius * sqrt(area[i]);
        double sine, cosine;
        elementary_sincos_turn_inline(turn[i], &sine, &cosine);
        const camera_ray r = camera_ray_through(&f, u[i], v[i], radius * cosine, radius * sine);
        ox[i] = r.origin.x, oy[i] = r.origin.y, oz[i] = r.origin.z;
        dx[i] = r.direction.x, dy[i] = r.direction.y, dz[i] = r.direction.z;
    }
}

const camera_kernels KERNEL(camera_kernels) = {directions, rays};
