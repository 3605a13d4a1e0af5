/* The z-buffer preview: the surfaces that the depth buffer (render/zbuffer) shows at the tracer's camera rays are
 * shaded as if they had been traced. Its pre-pass projects the triangles into the image; each tile is rasterised
 * before its rays start. */
#include "base/lanes.h"
#include "render/shade/exposure.h"
#include "render/shade/kernels.h"
#include "render/shade/media.h"
#include "render/shade/shading.h"
#include "render/tracer/tracer.h"
#include "render/zbuffer/zbuffer_private.h"
#include <stdlib.h>
#include <string.h>

/* One worker's data: a square of the depth buffer, and for each ray of the batch its grid point and the triangle
 * there. */
typedef struct raster_work {
    zbuffer_square square;
    int x[ROW], y[ROW];
    uint32_t number[ROW];
    bool straight[ROW];               /* it hits a curved surface along the undeflected view */
    double vx[ROW], vy[ROW], vz[ROW]; /* direction of the undeflected view, in a frame with layers */
    double ex[ROW], ey[ROW], ez[ROW]; /* origin of the undeflected view, with parallel rays */
    vec3 at[ROW];                     /* of the gathered group: points of affine texture lookup */
} raster_work;

static bool begin(tracer *t)
{
    if (!t->worker_data && !(t->worker_data = calloc(1, sizeof(raster_work))))
        return false;
    zbuffer_square_begin(&((raster_work *)t->worker_data)->square);
    return true;
}

static void end(void *work)
{
    if (work)
        zbuffer_square_release(&((raster_work *)work)->square);
    free(work);
}

static void draw_tile(tracer *t, const image_tile *tile)
{
    zbuffer_draw(t->target.state, tile, &((raster_work *)t->worker_data)->square);
}

/* The grid point of a ray. */
static size_t point_of(const zbuffer *z, int64_t sample_key, int *x, int *y)
{
    /* 32-bit divisions are faster. */
    const uint32_t pixel = (uint32_t)sample_key_pixel(sample_key), sample = (uint32_t)sample_key_sample(sample_key);
    const uint32_t points = (uint32_t)z->points, width = (uint32_t)z->frame_plan->render.width;
    const uint32_t row = pixel / width, line = points == 1 ? 0 : sample / points;
    *x = (int)((pixel - row * width) * points + sample - line * points);
    *y = (int)(row * points + line);
    return (size_t)*y * (size_t)z->width + (size_t)*x;
}

typedef struct raster_hit {
    double t, u, v;
    bool leaving;
} raster_hit;

static raster_hit hit_plane(const primitive *p, vec3 eye, vec3 d)
{
    const vec3 n = vec3_make(p->rotation.row[0].y, p->rotation.row[1].y, p->rotation.row[2].y);
    const double along = vec3_dot(n, d);
    return (raster_hit){.t = vec3_dot(n, vec3_sub(p->origin, eye)) / along, .leaving = along > 0.0};
}

/* Barycentric weights of the ray's hit: equal to interpolating u / w, v / w and 1 / w over the image (Heckbert and
 * Moreton, "Interpolation for polygon texture mapping and shading", 1991), but computed from the ray because corners
 * may be behind the camera (Moller and Trumbore, JGT 2(1), 1997). A ray that misses because corners were rounded hits
 * the nearest edge. */
static raster_hit hit_triangle(const rasterised_part *p, const screen_triangle *s, vec3 eye, vec3 d)
{
    const mesh_triangle tri = p->at.triangles->triangles[s->triangle];
    const vec3 o = vec3_sub(instance_set_origin(&p->at, s->copy), eye);
    const vec3 a = zbuffer_vertex(&p->at, o, tri.corner[0]);
    const vec3 ab = vec3_sub(zbuffer_vertex(&p->at, o, tri.corner[1]), a),
               ac = vec3_sub(zbuffer_vertex(&p->at, o, tri.corner[2]), a);
    const vec3 h = vec3_cross(d, ac), q = vec3_cross(ab, a);
    const double size = vec3_dot(ab, h);
    double u = -vec3_dot(a, h) / size, v = vec3_dot(d, q) / size;
    if (!(fabs(u) < 1e6 && fabs(v) < 1e6)) /* seen edge-on: the weights are rounding noise, so use the centre */
        u = v = 1.0 / 3.0;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) {
        const double w = greater(1.0 - u - v, 0.0);
        u = greater(u, 0.0), v = greater(v, 0.0);
        const double sum = w + u + v;
        u /= sum, v /= sum;
    }
    const vec3 at = vec3_add(a, vec3_add(vec3_scale(ab, u), vec3_scale(ac, v)));
    return (raster_hit){vec3_dot(at, d), u, v, size < 0.0};
}

/* The origin of a ray's undeflected view. */
static vec3 eye_of(const tracer *t, int i)
{
    const zbuffer *z = t->target.state;
    const raster_work *w = t->worker_data;
    return z->frame_plan->view.parallel ? vec3_make(w->ex[i], w->ey[i], w->ez[i]) : z->frame_plan->view.eye;
}

/* The distance of the hit along the ray, computed from the triangle's plane of nearness; for hits that need neither
 * weights nor sides. */
static raster_hit hit_depth(const zbuffer *z, const screen_triangle *s, int x, int y, vec3 d)
{
    const double near = lesser(greater(s->a * (x + 0.5) + (s->b * (y + 0.5) + s->c), s->least), s->most);
    const camera_frame *view = &z->frame_plan->view;
    return (raster_hit){.t = view->parallel ? -near : 1.0 / (near * vec3_dot(view->forward, d))};
}

static void record_miss(tracer *t, int i)
{
    t->batch.hits.t[i] = HUGE_VAL;
    t->batch.hits.hit_primitive[i] = -1;
    t->batch.hits.surface[i] = 0;
}

static raster_hit hit_part(const zbuffer *z, const screen_triangle *s, vec3 eye, vec3 d)
{
    const rasterised_part *p = &z->parts[s->part];
    return p->plane ? hit_plane(&z->frame_plan->geometry->primitives[p->primitive], eye, d)
                    : hit_triangle(p, s, eye, d);
}

static void record_hit(tracer *t, int i, const screen_triangle *s, raster_hit m)
{
    const zbuffer *z = t->target.state;
    const rasterised_part *p = &z->parts[s->part];
    const primitive *surface = &z->frame_plan->geometry->primitives[p->primitive];
    hit_batch *h = &t->batch.hits;
    h->t[i] = m.t;
    h->hit_primitive[i] = p->primitive;
    h->surface[i] = h->after[i] = surface->priority_index;
    h->inside_before[i] = m.leaving ? (uint64_t)1 << p->primitive : 0;
    if (surface->rule)
        return;
    const int64_t face = mesh_face_number(p->primitive, s->copy, s->triangle);
    t->meshes->scratch.hit[i] = (instance_hit){m.t, m.u, m.v, face, m.leaving ? FACING_BACK : FACING_FRONT};
}

/* The undeflected view directions through the grid points of a batch whose rays may be refracted. */
static void undeflected_views(tracer *t, int count)
{
    const zbuffer *z = t->target.state;
    const camera_frame *view = &z->frame_plan->view;
    raster_work *w = t->worker_data;
    const double across = 1.0 / z->units_x, down = 1.0 / z->units_y;
    double u[ROW], v[ROW];
    for (int i = 0; i < count; i++) {
        u[i] = (w->x[i] + 0.5) * across - view->half_width;
        v[i] = view->half_height - (w->y[i] + 0.5) * down;
    }
    if (view->parallel)
        camera_chief_rays(t, count, u, v, (camera_rays_out){w->ex, w->ey, w->ez, w->vx, w->vy, w->vz});
    else
        t->sampling->camera_directions(view, count, u, v, w->vx, w->vy, w->vz);
}

/* The undeflected views of camera rays are the rays themselves. */
static void first_views(tracer *t, const ray_batch *rays)
{
    const size_t bytes = (size_t)rays->count * sizeof(double);
    raster_work *w = t->worker_data;
    memcpy(w->vx, rays->dx, bytes), memcpy(w->vy, rays->dy, bytes), memcpy(w->vz, rays->dz, bytes);
    memcpy(w->ex, rays->ox, bytes), memcpy(w->ey, rays->oy, bytes), memcpy(w->ez, rays->oz, bytes);
}

/* Attenuates a ray by the medium of the straight segment to a layer. */
static void dim(const plan *p, ray_queue *q, int at, int priority_index, double length)
{
    if (priority_index == 0 || !p->geometry->regions[priority_index].attenuates)
        return;
    const vec3 a = p->absorption[priority_index];
    q->wr[at] *= absorption_left(a.x * length), q->wg[at] *= absorption_left(a.y * length),
        q->wb[at] *= absorption_left(a.z * length);
}

static const rasterised_layer *layer_at(const zbuffer *z, uint32_t place)
{
    return &z->blocks[place / BLOCK_LAYERS][place % BLOCK_LAYERS];
}

static inline raster_hit hit_layer(const tracer *t, int i, const rasterised_layer *l)
{
    const zbuffer *z = t->target.state;
    const raster_work *w = t->worker_data;
    const screen_triangle *s = &z->triangles[l->number - 1];
    const vec3 view = vec3_make(w->vx[i], w->vy[i], w->vz[i]);
    raster_hit m = l->ends || !z->parts[s->part].tessellation ? hit_part(z, s, eye_of(t, i), view)
                                                              : hit_depth(z, s, w->x[i], w->y[i], view);
    m.leaving = l->ends ? m.leaving : l->leaving;
    return m;
}

/* Records the hit of ray `at` on the next interface of its point's list, at `place` or behind layers that are no
 * interface. The point is on the undeflected view. The ray keeps its direction, or at a curved surface gets the
 * direction of the view, and its origin is moved so that it meets the point. The position in the list is stored in
 * place of the ray's set of primitives. */
static void record_layer(tracer *t, ray_queue *q, int at, int i, uint32_t place)
{
    const zbuffer *z = t->target.state;
    const plan *p = z->frame_plan;
    const rasterised_layer *l = layer_at(z, place);
    raster_work *w = t->worker_data;
    const vec3 view = vec3_make(w->vx[i], w->vy[i], w->vz[i]), eye = eye_of(t, i);
    double passed = vec3_dot(vec3_sub(vec3_make(q->ox[at], q->oy[at], q->oz[at]), eye), view);
    w->straight[i] = false;
    for (; l->passed; l = layer_at(z, ++place)) {
        const double end = greater(hit_layer(t, i, l).t, passed);
        dim(p, q, at, l->before, end - passed);
        passed = end;
    }
    w->number[i] = l->number - 1;
    if (l->number == 0) {
        const double infinite_length = 1e100; /* finite, so that a coefficient of 0 gives 0 and not NaN */
        record_miss(t, i);
        dim(p, q, at, l->before, infinite_length);
        return;
    }
    raster_hit m = hit_layer(t, i, l);
    const vec3 point = vec3_add(eye, vec3_scale(view, m.t));
    const double length = greater(m.t - passed, 0.0);
    const screen_triangle *s = &z->triangles[l->number - 1];
    w->straight[i] = s->curved;
    if (s->curved)
        q->dx[at] = view.x, q->dy[at] = view.y, q->dz[at] = view.z;
    m.t = length;
    const vec3 origin = vec3_sub(point, vec3_scale(vec3_make(q->dx[at], q->dy[at], q->dz[at]), length));
    q->ox[at] = origin.x, q->oy[at] = origin.y, q->oz[at] = origin.z;
    record_hit(t, i, s, m);
    t->batch.hits.before[i] = l->before;
    t->batch.hits.after[i] = l->after;
    t->batch.hits.surface[i] = l->surface;
    t->batch.hits.inside_after[i] = place + 1;
    dim(p, q, at, l->before, length);
}

static void find_hits(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays)
{
    const zbuffer *z = t->target.state;
    raster_work *w = t->worker_data;
    uint32_t seen[ROW];
    for (int i = 0; i < rays->count; i++)
        seen[i] = z->seen[point_of(z, q->sample_key[first + i], &w->x[i], &w->y[i])];
    if (depth == 0)
        first_views(t, rays);
    else
        undeflected_views(t, rays->count);
    for (int i = 0; i < rays->count; i++) {
        t->batch.hits.before[i] = t->batch.hits.after[i] = 0;
        t->batch.hits.inside_before[i] = t->batch.hits.inside_after[i] = 0;
        if (t->meshes)
            t->meshes->scratch.hit[i].face = FACE_NONE;
        if (z->layered && seen[i] & SEEN_LAYERS) {
            record_layer(t, q, first + i, i, depth == 0 ? seen[i] & ~SEEN_LAYERS : (uint32_t)q->inside[first + i]);
            continue;
        }
        w->number[i] = seen[i] - 1;
        w->straight[i] = false;
        if (seen[i]) {
            const screen_triangle *s = &z->triangles[seen[i] - 1];
            record_hit(t, i, s, hit_part(z, s, eye_of(t, i), vec3_make(w->vx[i], w->vy[i], w->vz[i])));
        } else {
            record_miss(t, i);
        }
    }
}

/* The padding repeats the last ray, so that what is counted among all lanes can be corrected. */
static void repeat_last(group *g)
{
    const int last = g->count - 1;
    for (int k = g->count; k < g->padded; k++) {
        g->dx[k] = g->dx[last], g->dy[k] = g->dy[last], g->dz[k] = g->dz[last];
        g->points.cos_i[k] = g->points.cos_i[last];
    }
}

/* At a curved surface the undeflected view does not hit the point that a refracted ray would: where it leaves a ball
 * near its outline, the normal differs from the refracted ray's, and light that entered could not leave. The view is
 * therefore refracted there as if it had entered through a parallel surface: the tangential component follows from n
 * sin, which is the same in all layers. */
static void bend(tracer *t, const int *list)
{
    const raster_work *w = t->worker_data;
    const zbuffer *z = t->target.state;
    group *g = &t->surface.gathered;
    if (!z->layered || z->frame_plan->render.transmission == TRANSMISSION_SIMPLE)
        return;
    for (int k = 0; k < g->count; k++) {
        const double eta = z->eye_index / g->n_from[k], cosine = g->points.cos_i[k];
        if (!w->straight[list[k]] || eta == 1.0)
            continue;
        const vec3 n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]);
        const vec3 along = vec3_scale(vec3_add(vec3_make(g->dx[k], g->dy[k], g->dz[k]), vec3_scale(n, cosine)), eta);
        const double sine2 = vec3_dot(along, along);
        if (sine2 >= 1.0)
            continue;
        g->points.cos_i[k] = sqrt(1.0 - sine2);
        const vec3 d = vec3_sub(along, vec3_scale(n, g->points.cos_i[k]));
        g->dx[k] = d.x, g->dy[k] = d.y, g->dz[k] = d.z;
    }
    repeat_last(g);
}

/* Affine weights in the image, of the clipped polygon: they differ from the weights in space unless all corners are
 * equally far. */
static void straight_weights(const zbuffer *z, const screen_triangle *s, double x, double y, double weight[3])
{
    clip_corner polygon[POLYGON_MAX];
    zbuffer_corners(z, &z->parts[s->part], s->copy, s->triangle, polygon);
    zbuffer_clip(z, &z->parts[s->part], polygon);
    const clip_corner *corner[3] = {&polygon[0], &polygon[s->piece], &polygon[s->piece + 1]};
    double cx[3], cy[3], area[3];
    for (int k = 0; k < 3; k++)
        zbuffer_place(z, corner[k], &cx[k], &cy[k]);
    for (int k = 0; k < 3; k++) {
        const int b = (k + 1) % 3, c = (k + 2) % 3;
        area[k] = (cx[b] - x) * (cy[c] - y) - (cy[b] - y) * (cx[c] - x);
    }
    const double total = area[0] + area[1] + area[2];
    for (int j = 0; j < 3; j++) {
        weight[j] = 0.0;
        for (int k = 0; k < 3; k++)
            weight[j] += (total != 0.0 ? area[k] / total : 1.0 / 3.0) * corner[k]->weight[j];
    }
}

static void straighten_uv(tracer *t, const rasterised_part *p, const screen_triangle *s, const double weight[3], int k)
{
    const mesh *m = p->at.triangles;
    const mesh_triangle tri = m->triangles[s->triangle];
    double u = 0.0, v = 0.0;
    for (int j = 0; m->uvs && j < 3; j++)
        u += weight[j] * m->uvs[tri.corner[j]].u, v += weight[j] * m->uvs[tri.corner[j]].v;
    t->meshes->mapping[k].u = u, t->meshes->mapping[k].v = v;
}

/* Sets the points of affine texture lookup. An infinite plane has no affine interpolation, because its corners are at
 * infinity. */
static void straighten(tracer *t, const int *list)
{
    const zbuffer *z = t->target.state;
    const surface_batch *points = &t->surface.gathered.points;
    raster_work *w = t->worker_data;
    for (int k = 0; k < t->surface.gathered.count; k++) {
        const int i = list[k];
        const screen_triangle *s = &z->triangles[w->number[i]];
        const rasterised_part *p = &z->parts[s->part];
        w->at[k] = vec3_make(points->px[k], points->py[k], points->pz[k]);
        if (p->plane)
            continue;
        double weight[3];
        straight_weights(z, s, w->x[i] + 0.5, w->y[i] + 0.5, weight);
        if (t->surface.on_mesh) {
            straighten_uv(t, p, s, weight, k);
            continue;
        }
        const mesh_triangle tri = p->at.triangles->triangles[s->triangle];
        vec3 at = vec3_make(0.0, 0.0, 0.0);
        for (int j = 0; j < 3; j++)
            at = vec3_add(at, vec3_scale(instance_set_vertex_point(&p->at, s->copy, tri.corner[j]), weight[j]));
        w->at[k] = at;
    }
}

static void place(tracer *t, const int *list)
{
    raster_work *w = t->worker_data;
    bend(t, list);
    if (t->target.frame_plan->render.texturing != TEXTURING_AFFINE ||
        (!t->surface.mat->img && !t->surface.mat->glow_img))
        return;
    straighten(t, list);
    t->surface.texture_at = w->at;
}

/* A clear surface adds the sky radiance of the reflected direction and continues to the next layer with the remaining
 * weight. */
static void branch(tracer *t, int depth)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    shading_branches(t, false);
    if (depth == t->queues.depth_limit) {
        cut_branches(t);
        return;
    }
    for (int i = 0; i < g->count; i++)
        if (b->reflect[i] > 0.0)
            shading_expose_sky(t, g->sample_key[i], vec3_make(b->rx[i], b->ry[i], b->rz[i]), g->wr[i] * b->reflect[i],
                               g->wg[i] * b->reflect[i], g->wb[i] * b->reflect[i]);
    enqueue_children(t, depth + 1, b->tx, b->ty, b->tz, b->refract, g->inside_after);
}

static void shade(tracer *t, int depth, int priority_index)
{
    const render_settings *r = &t->target.frame_plan->render;
    local_light(t, priority_index, light_terms_of(r));
    if (r->lighting == LIGHTING_WHITTED && !surface_is_opaque(t, priority_index))
        branch(t, depth);
}

static status prepare(const plan *p, void **frame, diagnostic *why)
{
    zbuffer *z = NULL;
    const status code = zbuffer_create(p, &z, why);
    *frame = z;
    return code;
}

static void project(void *frame)
{
    zbuffer_project(frame);
}

static status sort(void *frame, diagnostic *why)
{
    return zbuffer_sort(frame, why);
}

static status finish(void *frame, mesh_report *report, diagnostic *why)
{
    report->drawn = zbuffer_triangles(frame);
    report->raster_bytes = zbuffer_bytes(frame);
    return zbuffer_failed(frame) ? diagnose(why, STATUS_FAILURE, "render a smaller image or fewer clear solids",
                                            "out of memory for the layers of clear solids")
                                 : STATUS_OK;
}

static void release(void *frame)
{
    zbuffer_destroy(frame);
}

static const integrator_step steps[] = {{project, sort}, {NULL, NULL}};

const integrator integrator_of_zbuffer = {.by_solid = true,
                                          .needs_sample_number = true,
                                          .sampling = camera_samples,
                                          .prepare = prepare,
                                          .steps = steps,
                                          .finish = finish,
                                          .release = release,
                                          .begin = begin,
                                          .end = end,
                                          .tile = draw_tile,
                                          .intersect = find_hits,
                                          .background = background_sky,
                                          .place = place,
                                          .shade = shade};
