/* Tracing of photons. A ray's sample key is the photon's number, with its wavelength; its throughput is the remaining
 * fraction of the photon's initial power. With polarisation its Stokes vector is the vector of an analyser on the
 * reversed path: the transmittance between two ends does not depend on the direction, and a linearly polarised lamp
 * acts as the analyser that transmits its field (Stokes and Helmholtz reversion; Chandrasekhar, Radiative Transfer,
 * 1950, section 13). */
#include "render/caustics/emission.h"

#include "render/shade/rough.h"
#include "render/shade/shading.h"
#include <stdlib.h>

/* Branches with a smaller fraction of the photon's power are followed at random. */
#define LEAST_PHOTON 0.02
/* The radius of a disc as a fraction of the lamp's blur in undeflected light, since a lens may make the lamp's image
 * smaller. */
#define BLUR_FRACTION 0.1

typedef struct photon_work {
    photon_list *found;
    double passed[ROW], bent[ROW]; /* as in the queue, up to the hits, by ray of the batch */
    const int *list;               /* numbers of the gathered rays in the batch */
} photon_work;

static photon_work *work_of(tracer *t)
{
    return t->worker_data;
}

static bool begin(tracer *t)
{
    if (!t->worker_data)
        t->worker_data = calloc(1, sizeof(photon_work));
    return t->worker_data != NULL;
}

static void end(void *work)
{
    free(work);
}

static camera_sampling sampling(const render_settings *r)
{
    (void)r;
    return (camera_sampling){.rays = 1, .points = 1, .rays_per_point = 1};
}

static int64_t number_of(int64_t sample_key)
{
    return sample_key & (((int64_t)1 << 50) - 1);
}

void photon_integrator_emit(tracer *t, int64_t first, int64_t end, photon_list *found)
{
    const photon_frame *f = t->target.state;
    ray_queue *q = &t->queues.waiting[0];
    work_of(t)->found = found;
    for (int64_t i = first; i < end; i++) {
        emitted_ray r;
        if (!emission_ray(f->from, i, &r))
            continue;
        const int at = q->count++;
        q->ox[at] = r.origin.x, q->oy[at] = r.origin.y, q->oz[at] = r.origin.z;
        q->dx[at] = r.direction.x, q->dy[at] = r.direction.y, q->dz[at] = r.direction.z;
        q->wr[at] = q->wg[at] = q->wb[at] = 1.0;
        q->start[at] = FACE_NONE, q->inside[at] = r.inside;
        q->sample_key[at] = r.wavelength < 0 ? i : sample_key_with_wavelength(i, r.wavelength);
        q->sq[at] = r.q, q->su[at] = r.u, q->sv[at] = 0.0;
        q->passed[at] = q->bent[at] = 0.0;
    }
}

static void intersect(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays)
{
    intersect_nearest(t, q, first, depth, rays);
    photon_work *w = work_of(t);
    for (int i = 0; i < rays->count; i++) {
        w->passed[i] = q->passed[first + i] + t->batch.hits.t[i];
        w->bent[i] = depth > 0 ? q->bent[first + i] + t->batch.hits.t[i] : 0.0;
    }
}

static void leave(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    (void)t, (void)q, (void)first, (void)list, (void)count;
}

static void place(tracer *t, const int *list)
{
    work_of(t)->list = list;
}

/* Stores the photons of the gathered group. Photons of lamps are stored only after a mirror or a clear solid, because
 * shadow rays supply direct light; photons of beams always. */
static void arrive(tracer *t, int depth)
{
    photon_frame *f = t->target.state;
    photon_work *w = work_of(t);
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        emitted_ray r;
        if (!emission_ray(f->from, number_of(g->sample_key[k]), &r) || (depth == 0 && !r.of_beam))
            continue;
        atomic_fetch_add_explicit(&f->arrived[r.target], 1, memory_order_relaxed);
        if (f->is_pilot)
            continue;
        const double passed = w->passed[w->list[k]], bent = w->bent[w->list[k]],
                     falls = r.falls ? 1.0 : passed * passed;
        const photon one = {.position = {g->points.px[k], g->points.py[k], g->points.pz[k]},
                            .normal = {(float)g->points.nx[k], (float)g->points.ny[k], (float)g->points.nz[k]},
                            .flux = {(float)(g->wr[k] * r.power.x * falls), (float)(g->wg[k] * r.power.y * falls),
                                     (float)(g->wb[k] * r.power.z * falls)},
                            .radius =
                                r.of_beam ? 0.0F : (float)(BLUR_FRACTION * r.lamp_radius * bent / (passed - bent)),
                            .wavelength = r.of_line ? photon_of_line(r.wavelength) : r.wavelength};
        if (!photon_list_add(w->found, &one))
            atomic_store(&f->out_of_memory, true);
    }
}

typedef struct photon_branch {
    bool refracted, polarised; /* polarised: it has the Stokes vector of the surface's branch */
    vec3 direction, left;      /* left: the branch's fraction of the photon's power, by channel */
} photon_branch;

static double power_of(const photon_branch *b)
{
    return fmax(b->left.x, fmax(b->left.y, b->left.z));
}

static vec3 power_left(const tracer *t, int k, vec3 fraction)
{
    const group *g = &t->surface.gathered;
    return vec3_make(g->wr[k] * fraction.x, g->wg[k] * fraction.y, g->wb[k] * fraction.z);
}

static vec3 direction_of(const tracer *t, int k, bool refracted)
{
    const branch_group *b = &t->surface.branches;
    return refracted ? vec3_make(b->tx[k], b->ty[k], b->tz[k]) : vec3_make(b->rx[k], b->ry[k], b->rz[k]);
}

static bool has_branch(const tracer *t, int k, bool refracted)
{
    return (refracted ? t->surface.branches.refract[k] : t->surface.branches.reflect[k]) > 0.0;
}

/* A branch of record k; passing: the fraction of it that other facets do not mask, 1 for a smooth surface. */
static photon_branch branch_of(const tracer *t, int k, bool refracted, double passing)
{
    photon_branch one = {.refracted = refracted, .polarised = true};
    if (!has_branch(t, k, refracted))
        return one;
    one.direction = direction_of(t, k, refracted);
    one.left = power_left(t, k, vec3_scale(layered_weight(t, k, !refracted), passing));
    return one;
}

/* The fraction of a branch that other facets do not mask. */
static double passing_of(tracer *t, int k, bool refracted, const rough_surface *r)
{
    return has_branch(t, k, refracted)
               ? rough_masking(t, r, k, rough_in_frame(r, k, direction_of(t, k, refracted)), refracted)
               : 0.0;
}

/* Computes both branches of record k at its facet; or, with the probability that other facets mask the light, one
 * branch for light that leaves after further facets. */
static void meet_facet(tracer *t, int k, int depth, const rough_surface *r, photon_branch both[2])
{
    const photon_frame *f = t->target.state;
    const branch_group *b = &t->surface.branches;
    const double back = passing_of(t, k, false, r), on = passing_of(t, k, true, r);
    double masked = 0.0;
    if (r->finish) {
        const double clear = t->surface.mat->surface.transparency;
        masked = r->opaque ? 1.0 - back : b->reflect[k] * (1.0 - back) + b->refract[k] / clear * (1.0 - on);
        double chance;
        const unit_pair place = emission_further(f->from, number_of(t->surface.gathered.sample_key[k]), depth, &chance);
        if (chance < masked) {
            const further_light l = rough_draw_further(t, r, k, chance / masked, place);
            both[0] =
                (photon_branch){.refracted = l.refracted, .direction = l.direction, .left = power_left(t, k, l.factor)};
            both[1] = (photon_branch){.refracted = !l.refracted};
            return;
        }
    }
    both[0] = branch_of(t, k, false, back / (1.0 - masked));
    both[1] = branch_of(t, k, true, on / (1.0 - masked));
}

static void enqueue_branch(tracer *t, int k, int depth, const photon_branch *b)
{
    const photon_work *w = work_of(t);
    const group *g = &t->surface.gathered;
    const vec3 direction = b->direction, left = b->left;
    const bool refracted = b->refracted;
    ray_queue *q = tracer_queue_at(t, depth + 1);
    const int at = q->count++;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = direction.x, q->dy[at] = direction.y, q->dz[at] = direction.z;
    q->wr[at] = left.x, q->wg[at] = left.y, q->wb[at] = left.z;
    q->start[at] = g->points.face[k], q->sample_key[at] = g->sample_key[k];
    q->inside[at] = refracted ? g->inside_after[k] : g->inside_before[k];
    q->passed[at] = w->passed[w->list[k]], q->bent[at] = w->bent[w->list[k]];
    if (t->target.frame_plan->render.polarisation) {
        const polar_group *p = &t->surface.polar;
        q->sq[at] = refracted ? p->tq[k] : p->rq[k], q->su[at] = refracted ? p->tu[k] : p->ru[k];
        q->sv[at] = refracted ? p->tv[k] : p->rv[k];
        if (!b->polarised)
            q->sq[at] = q->su[at] = q->sv[at] = 0.0;
    }
    COUNT(refracted ? t->account.counters.refract++ : t->account.counters.reflect++);
}

/* Enqueues a branch with its fraction of the power; a faint branch ends at random. */
static void follow(tracer *t, int k, int depth, photon_branch *b)
{
    const photon_frame *f = t->target.state;
    const double power = power_of(b);
    if (!(power > 0.0))
        return;
    if (power < LEAST_PHOTON) {
        const int64_t number = number_of(t->surface.gathered.sample_key[k]);
        if (emission_chance(f->from, number, depth, b->refracted) * LEAST_PHOTON >= power)
            return;
        b->left = vec3_scale(b->left, LEAST_PHOTON / power);
    }
    enqueue_branch(t, k, depth, b);
}

/* Enqueues one branch of a deep photon, chosen in proportion to power, with the power of both; a faint photon ends at
 * random. */
static void follow_one(tracer *t, int k, int depth, photon_branch both[2])
{
    const photon_frame *f = t->target.state;
    const double first = power_of(&both[0]), power = first + power_of(&both[1]);
    if (!(power > 0.0))
        return;
    const unit_pair s = emission_roulette(f->from, number_of(t->surface.gathered.sample_key[k]), depth);
    const double odds = fmin(power / LEAST_PHOTON, roulette_odds_most(depth));
    if (s.u >= odds)
        return;
    photon_branch *chosen = &both[s.v * power >= first];
    chosen->left = vec3_scale(chosen->left, power / power_of(chosen) / fmin(odds, 1.0));
    enqueue_branch(t, k, depth, chosen);
}

/* Computes the branches of photons at facets of a rough surface, one facet per photon. */
static void meet_facets(tracer *t, double alpha, bool opaque, int depth, rough_surface *r)
{
    const photon_frame *f = t->target.state;
    const group *g = &t->surface.gathered;
    rough_begin(t, alpha, opaque, r);
    for (int k = 0; k < g->count; k++) {
        const unit_pair s = emission_facet(f->from, number_of(g->sample_key[k]), depth);
        r->m[k] = ggx_sample_normal(alpha, r->i[k], s.u, s.v);
    }
    rough_branches(t, r);
    if (!opaque)
        COUNT(t->account.counters.total_internal += (uint64_t)t->surface.branches.total);
}

static void shade(tracer *t, int depth, int priority_index)
{
    const material *m = &t->surface.mat->surface;
    const bool opaque = surface_is_opaque(t, priority_index);
    if (opaque && m->diffuse > 0.0 && (depth > 0 || t->target.frame_plan->beam_count > 0))
        arrive(t, depth);
    if (opaque && !surface_reflects(t))
        return;
    const double alpha = rough_alpha(t);
    rough_surface rough;
    if (alpha > 0.0)
        meet_facets(t, alpha, opaque, depth, &rough);
    else
        shading_branches(t, opaque);
    for (int k = 0; k < t->surface.gathered.count; k++) {
        photon_branch both[2];
        if (alpha > 0.0)
            meet_facet(t, k, depth, &rough, both);
        else
            both[0] = branch_of(t, k, false, 1.0), both[1] = branch_of(t, k, true, 1.0);
        if (depth >= DEPTH_DEEP - 1) {
            follow_one(t, k, depth, both);
            continue;
        }
        follow(t, k, depth, &both[0]);
        follow(t, k, depth, &both[1]);
    }
}

const integrator integrator_of_photons = {.cover = COVER_CHANCE,
                                          .traced = true,
                                          .needs_sample_number = true,
                                          .sampling = sampling,
                                          .begin = begin,
                                          .end = end,
                                          .intersect = intersect,
                                          .background = leave,
                                          .place = place,
                                          .shade = shade};
