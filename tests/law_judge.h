/* The check whether a pair of scenes obeys its law: what is compared, and the tolerances. Ownership: a judge is created
 * by judge_open and freed by judge_close. */
#pragma once

#include "law_pairs.h"
#include "reversal_fixture.h"
#include "scene/model/scene.h"

typedef enum verdict { HELD, SKIPPED, BROKEN } verdict;

/* rays: the number compared for LAW_MOTION and LAW_REVERSAL; rays_left_out: rays with another sequence of interfaces
 * when displaced, and paths that cannot be reversed. difference: the largest one found. added_hits: hits of the solid
 * that the law added, by the second scene's counters. */
typedef struct judge {
    renderer *renderer;
    long rays, rays_left_out;
    double difference;
    uint64_t added_hits;
} judge;

static inline judge judge_open(void)
{
    judge j = {.rays = 0};
    diagnostic why = {0};
    worked(renderer_create(isa_best(), NULL, &j.renderer, &why), &why);
    return j;
}

static inline void judge_close(judge *j)
{
    renderer_destroy(j->renderer);
}

static inline scene *law_load(const law_scene *w)
{
    scene *s = scene_from(law_text(w).at);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    return s;
}

static inline render_result *law_render(judge *j, const scene *s)
{
    render_result *r = NULL;
    diagnostic why = {0};
    worked(renderer_render(j->renderer, s, NULL, &r, &why), &why);
    return r;
}

static inline void scale_vector(vec3 *v, double f)
{
    *v = vec3_scale(*v, f);
}

/* Scales all lengths, ignoring the ranges of a scene file. */
static inline void scale_lengths(scene *s, double f)
{
    s->render.unit_m /= f;
    scale_vector(&s->camera.position, f);
    scale_vector(&s->camera.target, f);
    s->camera.view_height *= f, s->camera.aperture *= f, s->camera.focus *= f;
    for (size_t i = 0; i < s->light_count; i++) {
        scale_vector(&s->lights[i].position, f);
        s->lights[i].reach *= f;
        s->lights[i].radius *= f, s->lights[i].width *= f, s->lights[i].height *= f;
        scale_vector(&s->lights[i].target, f);
    }
    for (size_t i = 0; i < s->beam_count; i++) {
        scale_vector(&s->beams[i].position, f);
        scale_vector(&s->beams[i].target, f);
        s->beams[i].width *= f;
        s->beams[i].power *= f * f; /* the same irradiance */
    }
    for (size_t i = 0; i < s->solid_count; i++) {
        solid_shape *shape = &s->solids[i].shape;
        scale_vector(&shape->position, f);
        scale_vector(&shape->size, f);
        scale_vector(&shape->scale, f);
        scale_vector(&shape->spacing, f);
        shape->radius *= f, shape->inner_radius *= f, shape->height *= f, shape->floor *= f;
        shape->tube_radius *= f, shape->top_radius *= f;
        shape->radius_1 *= f, shape->radius_2 *= f, shape->thickness *= f, shape->diameter *= f;
        for (int k = 0; k < 3; k++)
            shape->even_1[k] /= pow(f, 3 + 2 * k), shape->even_2[k] /= pow(f, 3 + 2 * k);
        shape->capillary_length *= f, shape->contact_radius *= f;
        s->solids[i].surface.checker *= f;
        s->solids[i].surface.tint_distance *= f;
    }
}

/* Does a segment of the line intersect a solid, in quadruple precision? For a mesh, a meniscus or an asphere, a ball
 * around it. */
static inline bool intersects(const law_solid *s, vec3 origin, vec3 direction, double length)
{
    const reference_line line = {quad3_from(origin), quad3_from(direction)};
    quad t[REFERENCE_CROSSINGS_MAX];
    if (s->mesh || s->shape.capillary_length > 0.0 || has_asphere(&s->shape)) {
        const ball around = ball_around(s);
        const vec3 to = vec3_sub(around.middle, origin);
        const double along = fmin(fmax(vec3_dot(to, direction), 0.0), length);
        return vec3_length(vec3_sub(to, vec3_scale(direction, along))) <= around.radius;
    }
    return solid_shape_contains(&s->shape, origin) ||
           (reference_events(&s->shape, &line, 0, t) > 0 && t[0] < (quad)length);
}

static inline double length_of(const ray_node *n)
{
    return n->kind == RAY_SHADOW ? n->light_distance : n->end == RAY_END_HIT ? n->hit.t : HUGE_VAL;
}

static inline const law_solid *solid_numbered(const law_scene *w, int number)
{
    for (int i = 0; i < w->solid_count; i++)
        if (w->solid[i].number == number)
            return &w->solid[i];
    return NULL;
}

/* Does any ray of the first scene's image, traced by the Whitted integrator, cross all these solids? */
static inline bool some_ray_hits(const law_scene *w, const law_solid *const *solids, int count, int most_rays)
{
    stage g = {.setting = law_load(w)};
    g.setting->render.integrator = INTEGRATOR_WHITTED;
    stage_look(&g);
    bool found = false;
    int rays = 0;
    for (int y = 0; y < LAW_HEIGHT && !found && rays < most_rays; y++)
        for (int x = 0; x < LAW_WIDTH && !found && rays < most_rays; x++) {
            const ray_tree *tree = stage_pixel(&g, (x * 7) % LAW_WIDTH, (y * 5) % LAW_HEIGHT);
            for (size_t i = 0; i < tree->count && !found && rays < most_rays; i++, rays++) {
                int together = 0;
                for (int k = 0; k < count; k++)
                    together +=
                        intersects(solids[k], tree->node[i].origin, tree->node[i].direction, length_of(&tree->node[i]));
                found = together == count;
            }
        }
    stage_close(&g);
    return found;
}

/* Did a ray reach the part of the scene that the law changes? */
static inline bool law_was_tried(const law_pair *p)
{
    const law_solid *solids[2] = {solid_numbered(&p->b, LAW_ADDED), solid_numbered(&p->b, LAW_ADDED + 1)};
    return some_ray_hits(&p->a, solids, p->which == LAW_CUT ? 2 : 1, 400);
}

/* Largest difference of two films, relative to the larger value where that is above 1. */
static inline double film_apart(const film *a, const film *b)
{
    double most = 0.0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < 3; c++) {
                const double p = film_value(a, x, y, c), q = film_value(b, x, y, c);
                most = fmax(most, fabs(p - q) / fmax(1.0, fmax(p, q)));
            }
    return most;
}

static inline uint64_t hits_of_added(const scene *s, const render_result *r)
{
    char name[16];
    snprintf(name, sizeof name, "s%d", (int)LAW_ADDED);
    for (size_t i = 0; i < s->solid_count; i++)
        if (strcmp(s->solids[i].name, name) == 0)
            return r->counters.hits[i];
    return 0;
}

/* The change of the scene's pixels when the eye moves by a few roundings along each axis. */
static inline void add_swing(judge *j, const scene *s, const film *plain, double swing[LAW_WIDTH * LAW_HEIGHT * 3])
{
    static const vec3 displacements[] = {{2e-15, 0.0, 0.0}, {0.0, 2e-15, 0.0}, {0.0, 0.0, 2e-15}};
    for (size_t k = 0; k < COUNT(displacements); k++) {
        scene *other = scene_clone(s);
        assert_non_null(other);
        other->camera.position = vec3_add(other->camera.position, displacements[k]);
        render_result *r = law_render(j, other);
        for (int i = 0; i < LAW_WIDTH * LAW_HEIGHT * 3; i++) {
            const int x = i / 3 % LAW_WIDTH, y = i / 3 / LAW_WIDTH;
            swing[i] = fmax(swing[i], fabs(film_value(r->img, x, y, i % 3) - film_value(plain, x, y, i % 3)));
        }
        render_result_destroy(r);
        scene_destroy(other);
    }
}

/* Films equal within 1e-12. A pixel beyond that must vary as much when the eye moves by a rounding: a ray that hits a
 * surface at 89.9 degrees amplifies a rounding error a thousandfold. */
static inline bool alike_but_for_rounding(judge *j, const scene *s, const film *a, const film *b)
{
    double swing[LAW_WIDTH * LAW_HEIGHT * 3] = {0.0};
    if (film_apart(a, b) <= 1e-12)
        return true;
    add_swing(j, s, a, swing);
    bool alike = true;
    for (int i = 0; i < LAW_WIDTH * LAW_HEIGHT * 3; i++) {
        const int x = i / 3 % LAW_WIDTH, y = i / 3 / LAW_WIDTH;
        const double p = film_value(a, x, y, i % 3), q = film_value(b, x, y, i % 3);
        alike &= fabs(p - q) <= 1e-12 * fmax(1.0, fmax(p, q)) + fmin(2.0 * swing[i], 1e-9);
    }
    return alike;
}

/* exact: bit-identical. */
static inline verdict same_films(judge *j, const law_pair *p, bool exact)
{
    scene *s = law_load(&p->a), *t = law_load(&p->b);
    if (p->which == LAW_SCALE)
        scale_lengths(t, ldexp(1.0, p->exponent));
    render_result *x = law_render(j, s), *y = law_render(j, t);
    j->difference = film_apart(x->img, y->img);
    j->added_hits = hits_of_added(t, y);
    const bool same = exact ? film_hash(x->img) == film_hash(y->img) : alike_but_for_rounding(j, s, x->img, y->img);
    render_result_destroy(x);
    render_result_destroy(y);
    scene_destroy(s);
    scene_destroy(t);
    return same ? HELD : BROKEN;
}

static inline bool same_path(const ray_tree *a, const ray_tree *b)
{
    if (a->count != b->count)
        return false;
    for (size_t i = 0; i < a->count; i++) {
        const ray_node *p = &a->node[i], *q = &b->node[i];
        if (p->kind != q->kind || p->end != q->end || p->medium != q->medium || p->parent != q->parent)
            return false;
        if (p->end == RAY_END_HIT &&
            (p->hit.solid != q->hit.solid || p->hit.face_solid != q->hit.face_solid || p->hit.face != q->hit.face ||
             p->hit.from != q->hit.from || p->hit.to != q->hit.to))
            return false;
    }
    return true;
}

/* A ray of the first scene, the same ray displaced by 1e-12 of the scene, and the moved ray in the moved scene. */
static inline verdict same_radiance(judge *j, const law_pair *p)
{
    enum { RAYS = 12 };
    const double displacement = 1e-12 * 4.0;
    uint64_t seed = p->seed;
    stage a = {.setting = law_load(&p->a)}, b = {.setting = law_load(&p->b)};
    stage_look(&a);
    stage_look(&b);
    verdict result = HELD;
    for (int k = 0; k < RAYS && result == HELD; k++) {
        const double x = random_real(&seed, 0.0, LAW_WIDTH), y = random_real(&seed, 0.0, LAW_HEIGHT);
        const vec3 d = probe_camera_direction(a.probe, x, y), off = vec3_scale(random_direction(&seed), displacement);
        const ray_tree plain = *stage_ray(&a, p->a.eye, d);
        a.tree = (ray_tree){.count = 0};
        const ray_tree *displaced = stage_ray(&a, vec3_add(p->a.eye, off), d);
        const vec3 own = probe_camera_direction(b.probe, p->moved.mirrored ? LAW_WIDTH - x : x, y);
        if (vec3_length(vec3_sub(own, move_direction(&p->moved, d))) >
            1e-13) /* the camera and its roll move with the scene */
            result = BROKEN;
        const ray_tree *moved = stage_ray(&b, p->b.eye, own);
        const bool same = same_path(&plain, displaced);
        j->rays += same, j->rays_left_out += !same;
        for (int c = 0; c < 3 && same; c++) {
            const double L = plain.radiance[c],
                         allowed = 1e-9 * L + 10.0 * fabs(displaced->radiance[c] - L) + (double)plain.count / FILM_ONE;
            j->difference = fabs(moved->radiance[c] - L);
            if (!(j->difference <= allowed))
                result = BROKEN;
        }
        ray_tree owned = plain;
        ray_tree_release(&owned);
    }
    stage_close(&a);
    stage_close(&b);
    return result;
}

static inline verdict reversible(judge *j, const law_pair *p)
{
    uint64_t seed = p->seed;
    stage g = {.setting = law_load(&p->a)};
    stage_look(&g);
    verdict result = HELD;
    for (int k = 0; k < 6 && result == HELD; k++) {
        const vec3 origin = random_point(&seed, k % 3 ? 3.0 : 0.8), target = random_point(&seed, 0.8);
        const reversal r = there_and_back(&g, origin, vec3_sub(target, origin), random_below(&seed, 12) - 4);
        j->rays += r.used, j->rays_left_out += !r.used;
        j->difference = r.unequal;
        if (r.used && !(r.same_surfaces && r.farthest <= 1e-9 && r.unequal <= 1e-9 && r.from_closed_form <= 1e-9 &&
                        r.direction <= 1e-9))
            result = BROKEN;
    }
    stage_close(&g);
    return result;
}

/* Skips the pair if the films differ because a ray did hit the added solid. */
static inline verdict unmet_changes_nothing(judge *j, const law_pair *p)
{
    const law_solid *added = solid_numbered(&p->b, LAW_ADDED);
    const verdict result = same_films(j, p, true);
    return result == BROKEN && (j->added_hits > 0 || some_ray_hits(&p->a, &added, 1, INT_MAX)) ? SKIPPED : result;
}

static inline verdict law_judge(judge *j, const law_pair *p)
{
    switch (p->which) {
    case LAW_UNMET: return unmet_changes_nothing(j, p);
    case LAW_ORDER:
    case LAW_SCALE: return same_films(j, p, true);
    case LAW_MOTION: return same_radiance(j, p);
    case LAW_REVERSAL: return reversible(j, p);
    /* absorption over a segment in two parts is a product of two exponentials, with one more rounding */
    case LAW_SAME: return same_films(j, p, vec3_dot(p->a.outside_absorb_per_m, p->a.outside_absorb_per_m) == 0.0);
    case LAW_CUT:
    case LAW_FILL: return same_films(j, p, false);
    case LAW_COUNT: break;
    }
    return SKIPPED;
}

static inline void remove_solid(law_scene *w, int number)
{
    int remaining = 0, removed = -1;
    for (int i = 0; i < w->solid_count; i++)
        if (w->solid[i].number == number)
            removed = i;
        else
            w->solid[remaining++] = w->solid[i];
    if (removed < 0)
        return;
    int order = 0;
    for (int i = 0; i < w->solid_count; i++) {
        const int at = w->material_order[i];
        if (at != removed)
            w->material_order[order++] = at - (at > removed);
    }
    w->solid_count = remaining;
}

/* Reduces a fault to as few solids as possible, without removing the law's own, and without lights and beams if they
 * are not needed. */
static inline law_pair law_shrink(judge *j, law_pair p)
{
    for (bool smaller = true; smaller;) {
        smaller = false;
        for (int number = 0; number < LAW_SOLIDS_MAX; number++) {
            law_pair q = p;
            remove_solid(&q.a, number);
            remove_solid(&q.b, number);
            if (q.a.solid_count < p.a.solid_count && q.a.solid_count > 0 && law_judge(j, &q) == BROKEN)
                p = q, smaller = true;
        }
        law_pair q = p;
        q.a.beam.kind = q.b.beam.kind = NULL;
        if (p.a.beam.kind && law_judge(j, &q) == BROKEN)
            p = q, smaller = true;
        q = p;
        q.a.light_count = q.b.light_count = 0;
        if (p.a.light_count > 0 && law_judge(j, &q) == BROKEN)
            p = q, smaller = true;
    }
    law_judge(j, &p);
    return p;
}
