/* Projection of triangles into the image: the polygon of a triangle that is in front of the camera, corners on the
 * grid, and the plane of nearness. Corners are homogeneous, so that the corners of a plane may be at infinity. */
#include "render/zbuffer/zbuffer_private.h"

#include "base/array.h"
#include "base/lanes.h"
#include <math.h>
#include <stdlib.h>

/* --- clipping --- */

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
    int outside = 0, kept = 0;
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
            polygon[kept++] = from[k];
        if (side[k] > 0.0 && side[next] < 0.0)
            polygon[kept++] = cut(&from[k], &from[next], side[k], side[next]);
        else if (side[k] < 0.0 && side[next] > 0.0)
            polygon[kept++] = cut(&from[next], &from[k], side[next], side[k]);
    }
    return kept;
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

/* --- projection --- */

/* The plane of nearness: 1 / depth of a triangle's plane is linear in the image (Blinn, "Hyperbolic interpolation",
 * 1992): N.r / N.P along the ray r = (x/z, y/z, 1); with parallel rays so is the depth, (N.P - N.(x, y, 0)) / N.z.
 * False if the plane is seen edge-on. corners: the triangle's, before clipping. */
static bool depth_plane(const zbuffer *z, const rasterised_part *p, const clip_corner *corners, screen_triangle *t)
{
    const vec3 a = vec3_make(corners[0].x, corners[0].y, corners[0].z),
               b = vec3_make(corners[1].x, corners[1].y, corners[1].z);
    const vec3 c = vec3_make(corners[2].x, corners[2].y, corners[2].z);
    const vec3 n = p->plane ? vec3_cross(b, c) : vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    const bool parallel = z->frame_plan->view.parallel;
    const double distance = vec3_dot(n, a), k = parallel ? n.z : distance, middle = parallel ? -distance : n.z;
    if (k == 0.0)
        return false;
    t->a = n.x / z->units_x / k;
    t->b = -n.y / z->units_y / k;
    t->c = (middle - 0.5 * z->width * n.x / z->units_x + 0.5 * z->height * n.y / z->units_y) / k;
    return isfinite(t->a) && isfinite(t->b) && isfinite(t->c);
}

static int32_t smallest3(const int32_t v[3])
{
    const int32_t m = v[0] < v[1] ? v[0] : v[1];
    return m < v[2] ? m : v[2];
}

static int32_t largest3(const int32_t v[3])
{
    const int32_t m = v[0] > v[1] ? v[0] : v[1];
    return m > v[2] ? m : v[2];
}

/* True if the triangle's box contains a grid point of the image. */
static bool may_show(const zbuffer *z, const screen_triangle *t)
{
    const int half = SUBPIXEL / 2;
    const int x0 = (smallest3(t->x) + half - 1) >> 12, x1 = (largest3(t->x) - half) >> 12;
    const int y0 = (smallest3(t->y) + half - 1) >> 12, y1 = (largest3(t->y) - half) >> 12;
    return x0 <= x1 && y0 <= y1 && x1 >= 0 && y1 >= 0 && x0 < z->width && y0 < z->height;
}

static void put_triangle(chunk *c, const zbuffer *z, screen_triangle *t)
{
    const int64_t area =
        (int64_t)(t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) - (int64_t)(t->y[1] - t->y[0]) * (t->x[2] - t->x[0]);
    if (area == 0 || !may_show(z, t))
        return;
    if (area < 0) {
        const int32_t x = t->x[1], y = t->y[1];
        t->x[1] = t->x[2], t->y[1] = t->y[2];
        t->x[2] = x, t->y[2] = y;
    }
    if (GROW(c->screen, c->capacity, c->screen_count + 1))
        c->screen[c->screen_count++] = *t;
    else
        c->screen_count = SIZE_MAX;
}

/* True if all corners are outside one edge of the image, or all are behind the camera. */
static bool is_off_screen(const zbuffer *z, const clip_corner *c)
{
    const double wide = 0.5 * z->width / z->units_x, high = 0.5 * z->height / z->units_y;
    bool left = true, right = true, below = true, above = true, behind = true;
    for (int k = 0; k < 3; k++) {
        const double w = zbuffer_divisor(z, &c[k]);
        left &= c[k].x<-wide * w, right &= c[k].x> wide * w;
        below &= c[k].y<-high * w, above &= c[k].y> high * w;
        behind &= c[k].z < 0.0;
    }
    return left || right || below || above || behind;
}

/* True if the normals at the corners differ; a mesh with flat shading is not curved. */
static bool is_curved(const zbuffer *z, const rasterised_part *p, uint32_t triangle)
{
    const mesh *m = p->at.triangles;
    if (p->plane || !m->normals ||
        (!p->tessellation && z->frame_plan->shading_materials[p->at.priority_index].shading == SHADING_FLAT))
        return false;
    const mesh_triangle tri = m->triangles[triangle];
    const vec3 n = m->normals[tri.corner[0]];
    const double least = 1.0 - 1e-9; /* the cosine of 4.5e-5 rad: equal up to the rounding of stored normals */
    return !(vec3_dot(n, m->normals[tri.corner[1]]) > least && vec3_dot(n, m->normals[tri.corner[2]]) > least);
}

static void project_triangle(const zbuffer *z, chunk *c, const rasterised_part *p, uint32_t copy, uint32_t triangle)
{
    clip_corner polygon[POLYGON_MAX];
    int32_t x[POLYGON_MAX], y[POLYGON_MAX];
    screen_triangle t = {.triangle = triangle, .copy = copy, .part = (uint16_t)c->part};
    zbuffer_corners(z, p, copy, triangle, polygon);
    if (is_off_screen(z, polygon) || !depth_plane(z, p, polygon, &t))
        return;
    t.curved = z->layered && is_curved(z, p, triangle);
    const int count = zbuffer_clip(z, p, polygon);
    t.least = HUGE_VAL, t.most = -HUGE_VAL;
    for (int k = 0; k < count; k++) {
        double across, down;
        zbuffer_place(z, &polygon[k], &across, &down);
        x[k] = (int32_t)floor(across * SUBPIXEL + 0.5), y[k] = (int32_t)floor(down * SUBPIXEL + 0.5);
        const double near = zbuffer_nearness(z, &polygon[k]);
        t.least = lesser(t.least, near), t.most = greater(t.most, near);
    }
    for (int k = 1; k + 1 < count && c->screen_count != SIZE_MAX; k++) {
        screen_triangle piece = t;
        const int at[3] = {0, k, k + 1};
        for (int j = 0; j < 3; j++)
            piece.x[j] = x[at[j]], piece.y[j] = y[at[j]];
        piece.piece = (uint8_t)k;
        put_triangle(c, z, &piece);
    }
}

void zbuffer_project(zbuffer *z)
{
    for (size_t k; (k = atomic_fetch_add_explicit(&z->next_chunk, 1, memory_order_relaxed)) < z->chunk_count;) {
        chunk *c = &z->chunks[k];
        const rasterised_part *p = &z->parts[c->part];
        const uint32_t number = zbuffer_part_triangles(p);
        for (int i = 0; i < c->count && c->screen_count != SIZE_MAX; i++) {
            const uint64_t at = c->first + (uint64_t)i;
            project_triangle(z, c, p, (uint32_t)(at / number), (uint32_t)(at % number));
        }
        if (c->screen_count == SIZE_MAX) {
            c->screen_count = 0;
            atomic_store(&z->out_of_memory, true);
        }
    }
}
