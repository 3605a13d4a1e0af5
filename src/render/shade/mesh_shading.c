/* Shading of rays that hit meshes: hit points, normals, and the removal of light that an interpolated normal would
 * transmit through the triangle. */
#include "render/shade/shading.h"

#include "render/shade/kernels.h"
#include "render/shade/rough.h"
#include <stdlib.h>

bool mesh_begin(tracer *t)
{
    if (t->target.frame_plan->geometry->meshes && !t->meshes && !(t->meshes = malloc(sizeof *t->meshes)))
        return false;
    t->batch.scratch.meshes = t->meshes ? &t->meshes->scratch : NULL;
    const bool counted = CUVETTE_COUNTERS && t->target.frame_plan->render.count_tests;
    if (t->meshes)
        t->meshes->scratch.counts = counted ? &t->account.counters.queries : NULL;
    return true;
}

void mesh_end(tracer *t)
{
    free(t->meshes);
}

static void copy_point(surface_batch *s, mesh_points *m, int to, int from)
{
    s->px[to] = s->px[from], s->py[to] = s->py[from], s->pz[to] = s->pz[from];
    s->nx[to] = s->nx[from], s->ny[to] = s->ny[from], s->nz[to] = s->nz[from];
    s->cos_i[to] = s->cos_i[from], s->error[to] = s->error[from], s->face[to] = s->face[from];
    m->gx[to] = m->gx[from], m->gy[to] = m->gy[from], m->gz[to] = m->gz[from];
}

void mesh_surface(tracer *t, int priority_index, const int *list)
{
    const plan *p = t->target.frame_plan;
    const shading_rule shading = p->shading_materials[priority_index].shading;
    group *g = &t->surface.gathered;
    mesh_work *w = t->meshes;
    for (int k = 0; k < g->count; k++)
        w->hits[k] = w->scratch.hit[list[k]];
    const ray_batch rays = {g->count, g->ox, g->oy, g->oz, g->dx, g->dy, g->dz, g->start, g->inside_before};
    t->geometry->mesh_surface(p->geometry->meshes, &rays, w->hits, shading == SHADING_SMOOTH, &g->points, &w->points);
    for (int k = 0; (t->surface.mat->img || t->surface.mat->glow_img) && k < g->count; k++)
        w->mapping[k] = instance_set_mapping(p->geometry->meshes, &w->hits[k]);
}

static vec3 vertex_color(const mesh *m, uint32_t vertex)
{
    const float *color = m->colors[vertex];
    return vec3_make((double)color[0], (double)color[1], (double)color[2]);
}

/* a + u (b - a) + v (c - a), within 0 to 1: rounding could leave it where a triangle ends. */
static double between(double a, double b, double c, const instance_hit *hit)
{
    const double value = a + hit->u * (b - a) + hit->v * (c - a);
    return value > 0.0 ? (value < 1.0 ? value : 1.0) : 0.0;
}

void mesh_tint(tracer *t)
{
    const plan *p = t->target.frame_plan;
    const instance_set *f = p->geometry->meshes;
    group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        const instance_hit *hit = &t->meshes->hits[k];
        const mesh *m = f->parts[f->by_primitive[mesh_face_primitive(hit->face)]].triangles;
        if (!m->colors)
            continue; /* another solid's mesh bounds the region */
        const uint32_t *corner = m->triangles[mesh_face_triangle(hit->face)].corner;
        const vec3 a = vertex_color(m, corner[0]), b = vertex_color(m, corner[1]), c = vertex_color(m, corner[2]);
        vec3 tint = vec3_make(between(a.x, b.x, c.x, hit), between(a.y, b.y, c.y, hit), between(a.z, b.z, c.z, hit));
        if (p->spectral)
            tint.x = tint.y = tint.z = spectra_tint(p->spectral, g->sample_key[k], tint);
        g->cr[k] *= tint.x, g->cg[k] *= tint.y, g->cb[k] *= tint.z;
    }
}

static vec3 geometric(const mesh_work *w, int k)
{
    return vec3_make(w->points.gx[k], w->points.gy[k], w->points.gz[k]);
}

vec3 mesh_face_normal(const tracer *t, int k)
{
    return geometric(t->meshes, k);
}

bool mesh_lets_out(const tracer *t, int k, vec3 direction)
{
    return !t->surface.on_mesh || vec3_dot(geometric(t->meshes, k), direction) > 0.0;
}

/* No light from behind a triangle reaches the ray's side, whatever the shading normal. */
void mesh_bound_light(tracer *t)
{
    lit_group *l = &t->surface.lit;
    for (int k = 0; k < t->surface.gathered.count; k++) {
        if (mesh_lets_out(t, k, vec3_make(l->lx[k], l->ly[k], l->lz[k])))
            continue;
        l->r[k] = l->g[k] = l->b[k] = 0.0;
        l->contributes[k] = 0;
    }
}

/* A reflected ray must stay on its side of the triangle, and a refracted one must leave it; if the interpolated normal
 * sends the refracted ray back, all light is reflected, as in total reflection. */
void mesh_bound_branches(tracer *t)
{
    branch_group *b = &t->surface.branches;
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        const vec3 n = geometric(t->meshes, k);
        if (b->refract[k] > 0.0 && !(vec3_dot(n, vec3_make(b->tx[k], b->ty[k], b->tz[k])) < 0.0)) {
            b->reflect[k] += b->refract[k];
            b->refract[k] = 0.0;
            layered_turn_back(t, k);
        }
        if (!(vec3_dot(n, vec3_make(b->rx[k], b->ry[k], b->rz[k])) > 0.0)) {
            const vec3 d = vec3_make(g->dx[k], g->dy[k], g->dz[k]),
                       r = vec3_sub(d, vec3_scale(n, 2.0 * vec3_dot(d, n)));
            b->rx[k] = r.x, b->ry[k] = r.y, b->rz[k] = r.z;
        }
    }
}

bool mesh_has_corner_light(const tracer *t, int priority_index)
{
    return t->surface.on_mesh && t->target.frame_plan->shading_materials[priority_index].shading == SHADING_GOURAUD;
}

/* Sets the corner group: the gathered group as if each ray hit one corner of its triangle. */
static void move_to_corner(tracer *t, int corner, const instanced_mesh *part)
{
    group *c = &t->meshes->corner;
    const group *g = &t->surface.gathered;
    const mesh_points *m = &t->meshes->points;
    for (int k = 0; k < g->count; k++) {
        const uint32_t vertex = m->corner[corner][k];
        const vec3 at = instance_set_vertex_point(part, mesh_face_copy(g->points.face[k]), vertex),
                   o = vec3_make(g->ox[k], g->oy[k], g->oz[k]);
        const vec3 side = geometric(t->meshes, k), to_corner = vec3_sub(at, o);
        vec3 n = instance_set_vertex_normal(part, vertex);
        n = vec3_dot(n, n) > 0.0 ? n : side;
        n = vec3_dot(n, side) < 0.0 ? vec3_scale(n, -1.0) : n;
        const double length = vec3_length(to_corner);
        const vec3 d = length > 0.0 ? vec3_scale(to_corner, 1.0 / length) : vec3_make(g->dx[k], g->dy[k], g->dz[k]);
        c->points.px[k] = at.x, c->points.py[k] = at.y, c->points.pz[k] = at.z;
        c->points.nx[k] = n.x, c->points.ny[k] = n.y, c->points.nz[k] = n.z;
        /* above 0, also at a corner that is seen from behind */
        c->points.cos_i[k] = -vec3_dot(d, n) > 1e-12 ? -vec3_dot(d, n) : 1e-12;
        c->dx[k] = d.x, c->dy[k] = d.y, c->dz[k] = d.z;
    }
}

/* Gouraud, "Continuous shading of curved surfaces" (1971): light at a triangle's corners, interpolated by the weights
 * of the point. Shadows are computed at the point itself. */
void mesh_corner_light(tracer *t, const material *m, const light *lamp, int priority_index)
{
    mesh_work *w = t->meshes;
    lit_group *l = &t->surface.lit;
    const group *g = &t->surface.gathered;
    const instance_set *f = t->target.frame_plan->geometry->meshes;
    const instanced_mesh *part =
        &f->parts[f->by_primitive[t->target.frame_plan->geometry->regions[priority_index].outside]];
    t->shade->direct(m, lamp, g, l); /* for the vectors to the light */
    for (int k = 0; k < g->count; k++)
        l->r[k] = l->g[k] = l->b[k] = 0.0;
    w->corner = *g;
    for (int corner = 0; corner < 3; corner++) {
        move_to_corner(t, corner, part);
        for (int k = g->count; k < g->padded; k++) {
            copy_point(&w->corner.points, &w->points, k, g->count - 1);
            w->corner.dx[k] = w->corner.dx[g->count - 1], w->corner.dy[k] = w->corner.dy[g->count - 1],
            w->corner.dz[k] = w->corner.dz[g->count - 1];
        }
        t->shade->direct(m, lamp, &w->corner, &w->corner_light);
        for (int k = 0; k < g->count; k++) {
            const double weight = w->points.weight[corner][k];
            l->r[k] += weight * w->corner_light.r[k], l->g[k] += weight * w->corner_light.g[k],
                l->b[k] += weight * w->corner_light.b[k];
        }
    }
    const double least = 0.5 / FILM_ONE;
    for (int k = 0; k < g->count; k++)
        l->contributes[k] = -(int64_t) !(l->r[k] < least && l->g[k] < least && l->b[k] < least);
}

static int slot_of(const tracer *t, int i)
{
    const instance_set *f = t->target.frame_plan->geometry->meshes;
    const int64_t face = t->meshes->scratch.hit[i].face;
    if (face == FACE_NONE)
        return 0;
    const mesh *m = f->parts[f->by_primitive[mesh_face_primitive(face)]].triangles;
    return m->slots ? m->slots[mesh_face_triangle(face)] : 0;
}

/* Moves the rays with the material slot of the first ray to the front of the list, and keeps the order of both parts;
 * returns their number. */
int mesh_next_material(const tracer *t, int *list, int count, int *slot)
{
    int others[BATCH], matching = 0, left = 0;
    *slot = slot_of(t, list[0]);
    for (int k = 0; k < count; k++)
        if (slot_of(t, list[k]) == *slot)
            list[matching++] = list[k];
        else
            others[left++] = list[k];
    for (int k = 0; k < left; k++)
        list[matching + k] = others[k];
    return matching;
}
