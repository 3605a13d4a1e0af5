/* Ray queries: the caller's rays are traced in batches by the tracer's own kernels, and their hits are converted to the
 * scene's terms. */
#include "engine/engine_private.h"
#include "geometry/regions/solid_tree.h"

#include <math.h>
#include <string.h>

#define FAR_ORIGIN 1e6

/* A cuvette_start: word 0 is 1 if a hit filled it in; then follow the face and the set of primitives. */
static cuvette_start start_at(int64_t face, uint64_t inside)
{
    return (cuvette_start){{1, (uint64_t)face, inside, 0}};
}

/* True if the word is a set that a hit of this query can have. */
static bool is_set(const scene_geometry *a, uint64_t word)
{
    return !a->tree || set_table_knows(a->tree->sets, word);
}

/* True if the word is the number of an existing face. */
static bool is_face(const scene_geometry *a, uint64_t word)
{
    const int64_t face = (int64_t)word;
    if (!is_mesh_face(face))
        return word < (uint64_t)a->primitive_count * FACES_MAX;
    const int bit = mesh_face_primitive(face);
    const int part = a->meshes && bit < a->primitive_count ? a->meshes->by_primitive[bit] : -1;
    if (part < 0)
        return false;
    const instanced_mesh *p = &a->meshes->parts[part];
    return mesh_face_triangle(face) < p->triangles->triangle_count &&
           mesh_face_copy(face) < p->copies[0] * p->copies[1] * p->copies[2];
}

status engine_check_ray(const plan *p, const cuvette_ray *ray, size_t i, diagnostic *why)
{
    const double *o = ray->origin, *d = ray->direction;
    const char *what = NULL, *remedy = NULL;
    if (!(fabs(o[0]) <= FAR_ORIGIN && fabs(o[1]) <= FAR_ORIGIN && fabs(o[2]) <= FAR_ORIGIN))
        what = "starts too far away", remedy = "start within 1e6 scene units of 0,0,0";
    else if (!engine_is_finite(d) || (d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0))
        what = "has no direction", remedy = "use a finite direction that is not 0,0,0";
    else if (!(ray->reach >= 0.0))
        what = "has a negative reach", remedy = "use a distance above 0, or 0 for no limit";
    else if (p && (ray->start.word[0] > 1 || (ray->start.word[0] == 1 && !(is_face(p->geometry, ray->start.word[1]) &&
                                                                           is_set(p->geometry, ray->start.word[2])))))
        what = "has an invalid start", remedy = "copy it from a hit of this query, or zero it";
    if (!what)
        return STATUS_OK;
    return p ? diagnose(why, STATUS_BAD_INPUT, remedy, "ray %zu %s", i, what)
             : diagnose(why, STATUS_BAD_INPUT, remedy, "the ray %s", what);
}

vec3 engine_unit(const double *d)
{
    const vec3 v = engine_vector(d);
    if (fabs(vec3_dot(v, v) - 1.0) <= 0x1p-50)
        return v;
    const double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    return vec3_normalize(vec3_make(v.x / largest, v.y / largest, v.z / largest));
}

static void put_ray(const cuvette_query *q, query_buffers *b, int column, const cuvette_ray *ray, double length)
{
    const vec3 origin = engine_vector(ray->origin), d = vec3_scale(engine_unit(ray->direction), length);
    b->ox[column] = origin.x, b->oy[column] = origin.y, b->oz[column] = origin.z;
    b->dx[column] = d.x, b->dy[column] = d.y, b->dz[column] = d.z;
    b->start[column] = ray->start.word[0] ? (int64_t)ray->start.word[1] : FACE_NONE;
    b->inside[column] = ray->start.word[0] ? ray->start.word[2] : scene_geometry_inside(q->ready->geometry, origin);
}

static ray_batch view_of(const query_buffers *b, int count)
{
    return (ray_batch){count, b->ox, b->oy, b->oz, b->dx, b->dy, b->dz, b->start, b->inside};
}

/* A miss: only the medium at the origin is known. */
static cuvette_hit no_hit(const cuvette_query *q, int priority_index)
{
    cuvette_hit h;
    memset(&h, 0, sizeof h);
    h.distance = (double)INFINITY;
    h.solid = h.after = CUVETTE_OUTSIDE;
    h.triangle = -1;
    h.before = q->ready->geometry->regions[priority_index].solid;
    h.n_before = q->ready->ior[priority_index];
    return h;
}

static cuvette_hit hit_of(const cuvette_query *q, const query_buffers *b, int column, int k, int hit_primitive)
{
    const plan *p = q->ready;
    const hit_batch *hits = &b->hits;
    const surface_batch *s = &b->points;
    cuvette_hit h = no_hit(q, (int)hits->before[column]);
    const region *bounded = &p->geometry->regions[p->geometry->primitives[hit_primitive].priority_index];
    h.distance = hits->t[column];
    h.point[0] = s->px[k], h.point[1] = s->py[k], h.point[2] = s->pz[k];
    h.normal[0] = s->nx[k], h.normal[1] = s->ny[k], h.normal[2] = s->nz[k];
    h.error = s->error[k];
    h.solid = p->geometry->regions[hits->surface[column]].solid;
    h.after = p->geometry->regions[hits->after[column]].solid;
    h.n_after = p->ior[hits->after[column]];
    if (is_mesh_face(s->face[k])) {
        h.triangle = instance_set_triangle(p->geometry->meshes, s->face[k]);
        h.copy = (int32_t)mesh_face_copy(s->face[k]);
        h.slot = (int32_t)b->on_mesh.slot[k];
        h.u = b->on_mesh.weight[1][k], h.v = b->on_mesh.weight[2][k];
    } else {
        h.face = (int32_t)(s->face[k] % FACES_MAX) + (hit_primitive == bounded->hollow ? HOLLOW_FACES : 0);
    }
    h.reflected = start_at(s->face[k], hits->inside_before[column]);
    h.transmitted = start_at(s->face[k], hits->inside_after[column]);
    return h;
}

/* Reports the hits on one primitive, whose points are computed in one batch. */
static void report_hits(const cuvette_query *q, query_buffers *b, int hit_primitive, int count, cuvette_hit *out)
{
    for (int k = 0; k < count; k++) {
        const int i = b->list[k];
        b->gox[k] = b->ox[i], b->goy[k] = b->oy[i], b->goz[k] = b->oz[i];
        b->gdx[k] = b->dx[i], b->gdy[k] = b->dy[i], b->gdz[k] = b->dz[i];
        b->gstart[k] = b->start[i], b->ginside[k] = b->hits.inside_before[i], b->t[k] = b->hits.t[i];
    }
    const ray_batch rays = {count, b->gox, b->goy, b->goz, b->gdx, b->gdy, b->gdz, b->gstart, b->ginside};
    const scene_geometry *a = q->ready->geometry;
    if (!a->primitives[hit_primitive].rule) {
        for (int k = 0; k < count; k++)
            b->mesh_hits[k] = b->meshes.hit[b->list[k]];
        q->kernels->mesh_surface(a->meshes, &rays, b->mesh_hits, false, &b->points, &b->on_mesh);
    } else {
        q->kernels->surface(a, hit_primitive, &rays, b->t, &b->points);
    }
    for (int k = 0; k < count; k++)
        out[b->list[k]] = hit_of(q, b, b->list[k], k, hit_primitive);
}

static bool within(double distance, double reach)
{
    return reach == 0.0 || distance <= reach;
}

static void nearest_batch(const cuvette_query *q, query_buffers *b, const cuvette_ray *rays, int count,
                          cuvette_hit *hits)
{
    const scene_geometry *a = q->ready->geometry;
    for (int i = 0; i < count; i++)
        put_ray(q, b, i, &rays[i], 1.0);
    const ray_batch view = view_of(b, count);
    q->kernels->nearest(a, &view, &b->scratch, &b->hits);
    for (int i = 0; i < count; i++)
        if (b->hits.hit_primitive[i] < 0 || !within(b->hits.t[i], rays[i].reach)) {
            hits[i] = no_hit(q, scene_geometry_priority_index(a, b->inside[i]));
            b->hits.hit_primitive[i] = -1;
        }
    for (int first = 0; first < count; first++) {
        const int64_t hit_primitive = b->hits.hit_primitive[first];
        int listed = 0;
        for (int i = first; i < count && hit_primitive >= 0; i++) {
            if (b->hits.hit_primitive[i] == hit_primitive) {
                b->list[listed++] = i;
                b->hits.hit_primitive[i] = -1;
            }
        }
        if (listed > 0)
            report_hits(q, b, (int)hit_primitive, listed, hits);
    }
}

/* cancels: the query's value when the call began. */
static status begin(const cuvette_query *q, unsigned cancels, const cuvette_ray *rays, size_t count,
                    query_buffers **out, diagnostic *why)
{
    for (size_t i = 0; i < count; i++) {
        if (i % 4096 == 0 && query_cancels(q) != cancels)
            return query_cancelled(why);
        TRY(engine_check_ray(q->ready, &rays[i], i, why));
    }
    *out = query_acquire_buffers(q);
    return *out ? STATUS_OK : out_of_memory(why);
}

cuvette_status cuvette_query_nearest(const cuvette_query *query, const cuvette_ray *rays, size_t count,
                                     cuvette_hit *hits, cuvette_diagnostic *why)
{
    ENGINE_CALL(query);
    if (count == 0)
        return CUVETTE_OK;
    ENGINE_NEED(rays, hits);
    query_buffers *b = NULL;
    const unsigned cancels = query_cancels(query);
    status code = begin(query, cancels, rays, count, &b, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    size_t i = 0;
    for (; i < count && query_cancels(query) == cancels; i += BATCH)
        nearest_batch(query, b, rays + i, count - i < BATCH ? (int)(count - i) : BATCH, hits + i);
    query_release_buffers(query, b);
    code = i < count ? query_cancelled(&inner) : STATUS_OK;
    return engine_report(code, &inner, why);
}

/* Tests a batch of rays that all have a reach, or all have none. ends: they have one, and end there as shadow rays end
 * at their light. */
static void occluded_batch(const cuvette_query *q, query_buffers *b, int count, bool ends, unsigned char *blocked)
{
    const ray_batch view = view_of(b, count);
    if (ends)
        q->kernels->shadow(q->ready->geometry, &view, 1, &b->scratch, b->transmitted);
    else
        q->kernels->nearest(q->ready->geometry, &view, &b->scratch, &b->hits);
    for (int i = 0; i < count; i++)
        blocked[b->caller_index[i]] = ends ? b->transmitted[i] == 0.0 : b->hits.hit_primitive[i] >= 0;
}

/* False if the query was cancelled meanwhile. */
static bool occluded(const cuvette_query *q, query_buffers *b, unsigned cancels, const cuvette_ray *rays, size_t count,
                     bool ends, unsigned char *blocked)
{
    int waiting = 0;
    for (size_t i = 0; i < count; i++) {
        if ((rays[i].reach > 0.0 && isfinite(rays[i].reach)) != ends)
            continue;
        put_ray(q, b, waiting, &rays[i], ends ? rays[i].reach : 1.0);
        b->caller_index[waiting++] = i;
        if (waiting == BATCH) {
            if (query_cancels(q) != cancels)
                return false;
            occluded_batch(q, b, waiting, ends, blocked);
            waiting = 0;
        }
    }
    if (waiting > 0)
        occluded_batch(q, b, waiting, ends, blocked);
    return true;
}

cuvette_status cuvette_query_occluded(const cuvette_query *query, const cuvette_ray *rays, size_t count,
                                      unsigned char *blocked, cuvette_diagnostic *why)
{
    ENGINE_CALL(query);
    if (count == 0)
        return CUVETTE_OK;
    ENGINE_NEED(rays, blocked);
    query_buffers *b = NULL;
    const unsigned cancels = query_cancels(query);
    status code = begin(query, cancels, rays, count, &b, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    const bool completed = occluded(query, b, cancels, rays, count, true, blocked) &&
                           occluded(query, b, cancels, rays, count, false, blocked);
    query_release_buffers(query, b);
    code = completed ? STATUS_OK : query_cancelled(&inner);
    return engine_report(code, &inner, why);
}
