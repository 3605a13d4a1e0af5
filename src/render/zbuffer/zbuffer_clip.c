/* Clipping: the polygon of a triangle that is in front of the camera. Corners are homogeneous, so that those of a plane
 * may be at infinity. */
#include "render/zbuffer/zbuffer_private.h"

static clip_corner in_camera(const camera_frame *view, vec3 v, double h)
{
    return (clip_corner){
        .x = vec3_dot(view->right, v), .y = vec3_dot(view->up, v), .z = vec3_dot(view->forward, v), .h = h};
}

/* A triangle from the camera's foot point on the plane to the ends of two of its axes. */
static void plane_corners(const zbuffer *z, const primitive *p, uint32_t triangle, clip_corner out[3])
{
    const camera_frame *view = &z->frame_plan->view;
    const mat3 r = p->rotation;
    const vec3 across = vec3_make(r.row[0].x, r.row[1].x, r.row[2].x),
               up = vec3_make(r.row[0].y, r.row[1].y, r.row[2].y);
    const vec3 along = vec3_make(r.row[0].z, r.row[1].z, r.row[2].z);
    const vec3 ends[4] = {across, along, vec3_scale(across, -1.0), vec3_scale(along, -1.0)};
    out[0] = in_camera(view, vec3_scale(up, vec3_dot(up, vec3_sub(p->origin, view->eye))), 1.0);
    out[1] = in_camera(view, ends[triangle], 0.0);
    out[2] = in_camera(view, ends[(triangle + 1) % 4], 0.0);
}

void zbuffer_corners(const zbuffer *z, const rasterised_part *p, uint32_t copy, uint32_t triangle,
                     clip_corner out[POLYGON_MAX])
{
    if (p->plane) {
        plane_corners(z, &z->frame_plan->geometry->primitives[p->primitive], triangle, out);
    } else {
        const camera_frame *view = &z->frame_plan->view;
        const mesh_triangle tri = p->at.triangles->triangles[triangle];
        const vec3 o = vec3_sub(instance_set_origin(&p->at, copy), view->eye);
        for (int k = 0; k < 3; k++)
            out[k] = in_camera(view, zbuffer_vertex(&p->at, o, tri.corner[k]), 1.0);
    }
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            out[k].weight[j] = k == j ? 1.0 : 0.0;
}

/* Signed distance of a corner from a clip plane, positive inside: the near plane, and the four sides. */
static double side_of(const zbuffer *z, double nearest, const clip_corner *c, int plane)
{
    const double w = zbuffer_divisor(z, c);
    switch (plane) {
    case 0: return c->z - nearest * c->h;
    case 1: return z->reach_x * w + c->x;
    case 2: return z->reach_x * w - c->x;
    case 3: return z->reach_y * w + c->y;
    default: return z->reach_y * w - c->y;
    }
}

/* Always interpolates from the inner end, so that triangles with a common edge cut it at the same point. */
static clip_corner cut(const clip_corner *in, const clip_corner *out, double inner, double outer)
{
    const double t = inner / (inner - outer);
    clip_corner c = {in->x + t * (out->x - in->x),
                     in->y + t * (out->y - in->y),
                     in->z + t * (out->z - in->z),
                     in->h + t * (out->h - in->h),
                     {0}};
    for (int j = 0; j < 3; j++)
        c.weight[j] = in->weight[j] + t * (out->weight[j] - in->weight[j]);
    return c;
}

/* Clips at one plane: Sutherland and Hodgman, "Reentrant polygon clipping", CACM 17(1), 1974. */
static int clip_at(const zbuffer *z, double nearest, int plane, clip_corner *polygon, int count)
{
    clip_corner from[POLYGON_MAX];
    double side[POLYGON_MAX];
    int outside = 0, made = 0;
    for (int k = 0; k < count; k++) {
        side[k] = side_of(z, nearest, &polygon[k], plane);
        outside += !(side[k] >= 0.0);
    }
    if (outside == 0 || outside == count)
        return outside ? 0 : count;
    for (int k = 0; k < count; k++)
        from[k] = polygon[k];
    for (int k = 0; k < count; k++) {
        const int next = (k + 1) % count;
        if (side[k] >= 0.0)
            polygon[made++] = from[k];
        if (side[k] > 0.0 && side[next] < 0.0)
            polygon[made++] = cut(&from[k], &from[next], side[k], side[next]);
        else if (side[k] < 0.0 && side[next] > 0.0)
            polygon[made++] = cut(&from[next], &from[k], side[next], side[k]);
    }
    return made;
}

int zbuffer_clip(const zbuffer *z, const rasterised_part *p, clip_corner polygon[POLYGON_MAX])
{
    int count = 3;
    for (int plane = 0; plane < 5 && count >= 3; plane++)
        count = clip_at(z, p->nearest, plane, polygon, count);
    for (int k = 0; k < count; k++) { /* rejects directions across the view, a camera on a corner, and NaN */
        const clip_corner *c = &polygon[k];
        const double w = zbuffer_divisor(z, c);
        if (!(c->z > 0.0 && w > 0.0 && fabs(c->x) <= 1.001 * z->reach_x * w && fabs(c->y) <= 1.001 * z->reach_y * w))
            return 0;
    }
    return count >= 3 ? count : 0;
}

void zbuffer_place(const zbuffer *z, const clip_corner *c, double *x, double *y)
{
    const double inverse = 1.0 / zbuffer_divisor(z, c);
    *x = 0.5 * z->width + c->x * inverse * z->units_x;
    *y = 0.5 * z->height - c->y * inverse * z->units_y;
}
