/* Russian roulette, the depth limit, and the queue of the next depth. */
#include "render/integrators/path_continue.h"

/* Below this depth every path continues; from it on faint paths end by Russian roulette. */
enum { ROULETTE_DEPTH = 3 };

/* Russian roulette (Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990): ends a faint path at
 * random; the survivors take over its weight. Deep paths take part whatever render.roulette is. */
static bool survives(const tracer *t, int k, int depth, vec3 *share)
{
    const render_settings *r = &t->target.frame_plan->render;
    const group *g = &t->surface.gathered;
    if (depth < (r->roulette ? ROULETTE_DEPTH : DEPTH_DEEP))
        return true;
    const int64_t paths = path_count(&t->target.frame_plan->draws, sample_key_pixel(g->sample_key[k]));
    /* of the weight with which paths begin, which an analyser halves */
    const double begins = t->target.frame_plan->analyser == ANALYSER_NONE ? 1.0 : 0.5;
    const double weight =
        fmax(g->wr[k] * share->x, fmax(g->wg[k] * share->y, g->wb[k] * share->z)) * ((double)paths / begins);
    const double odds = fmin(weight, roulette_odds_most(depth));
    if (odds >= 1.0)
        return true;
    if (path_draw(&t->target.frame_plan->draws, g->sample_key[k], depth, DRAW_ROULETTE).u >= odds)
        return false;
    *share = vec3_scale(*share, 1.0 / odds);
    return true;
}

static void cut(tracer *t, int k, const continuation *c)
{
    const group *g = &t->surface.gathered;
    const double r = g->wr[k] * c->share.x, gr = g->wg[k] * c->share.y, b = g->wb[k] * c->share.z;
    count_cut_by_depth(t, g->sample_key[k], r, gr, b);
    shading_expose_at_depth_limit(t, g->sample_key[k], c->direction, r, gr, b);
}

static void go_on(tracer *t, int k, int depth, const continuation *c)
{
    const group *g = &t->surface.gathered;
    ray_queue *q = tracer_queue_at(t, depth + 1);
    const int at = q->count++;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = c->direction.x, q->dy[at] = c->direction.y, q->dz[at] = c->direction.z;
    q->wr[at] = g->wr[k] * c->share.x, q->wg[at] = g->wg[k] * c->share.y, q->wb[at] = g->wb[k] * c->share.z;
    q->start[at] = g->points.face[k], q->inside[at] = c->inside;
    if (t->target.frame_plan->render.polarisation)
        q->sq[at] = c->q, q->su[at] = c->u, q->sv[at] = c->v;
    const bool photons = t->target.frame_plan->photons != NULL;
    const int64_t left_matte = g->sample_key[k] | (c->matte && photons ? SAMPLE_KEY_PHOTONS : 0);
    const bool meets_lights = c->specular_bounce && !(left_matte & SAMPLE_KEY_PHOTONS);
    q->sample_key[at] = (left_matte & ~SAMPLE_KEY_SPECULAR_BOUNCE) | (meets_lights ? SAMPLE_KEY_SPECULAR_BOUNCE : 0);
    COUNT(c->refracted ? t->account.counters.refract++ : t->account.counters.reflect++);
}

void path_continue(tracer *t, int k, int depth, continuation *c)
{
    if (depth == t->queues.depth_limit)
        cut(t, k, c);
    else if (survives(t, k, depth, &c->share))
        go_on(t, k, depth, c);
}
