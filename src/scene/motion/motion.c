#include "scene/motion/motion_private.h"

#include "base/cancel.h"
#include "measure/clock.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>

size_t motion_count_slimes(const scene *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        count += s->meshes[i].source == MESH_SLIME;
    return count;
}

bool scene_moves(const scene *s)
{
    return motion_count_slimes(s) > 0;
}

status motion_give_surface(const scene_motion *m, const moving_slime *one, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, one);
    mesh *surface = NULL;
    TRY(softbody_surface(one->x.body, &surface, why));
    mesh_entry_unload(entry);
    entry->data = surface;
    return STATUS_OK;
}

static void add_moves(hierarchy_moves *sum, const hierarchy_moves *more)
{
    sum->refitted += more->refitted;
    sum->rebuilt += more->rebuilt;
    sum->refit_s += more->refit_s;
    sum->build_s += more->build_s;
    sum->growth = sum->growth > more->growth ? sum->growth : more->growth;
}

static status move_surface(scene_motion *m, const moving_slime *one, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, one);
    if (!entry->data || mesh_owners(entry->data) > 1)
        return motion_give_surface(m, one, why);
    /* Made by motion_give_surface for this scene, its only owner. */
    status code = softbody_move_surface(one->x.body, (mesh *)(uintptr_t)entry->data, why);
    hierarchy_moves moves = {.refitted = 0};
    THEN(code, hierarchy_follow(entry->data, m->s->render.rebuild, scene_build_threads(&m->s->render), &moves, why));
    if (code != STATUS_OK) {
        mesh_entry_unload(entry); /* triangles and hierarchies would be inconsistent */
        return code;
    }
    add_moves(&m->last.hierarchies, &moves);
    return STATUS_OK;
}

void motion_take_account(scene_motion *m, moving_slime *one, double time_s)
{
    mesh_entry *entry = motion_entry(m, one);
    one->time_s = time_s;
    entry->time_s = time_s;
    entry->account = softbody_measure(one->x.body);
    entry->motion_s = one->x.motion_s;
}

static status begin(scene_motion *m, diagnostic *why)
{
    for (size_t i = 0; i < m->s->mesh_count; i++) {
        if (m->s->meshes[i].source != MESH_SLIME)
            continue;
        moving_slime *one = &m->slimes[m->count];
        *one = (moving_slime){.entry = i};
        TRY(slime_create(m->s, &m->s->meshes[i], &one->x, why));
        status code = motion_remember(m, one, why);
        if (code != STATUS_OK) {
            motion_forget(one);
            return code;
        }
        m->count++;
        code = motion_give_surface(m, one, why);
        if (code != STATUS_OK)
            return code;
        motion_take_account(m, one, 0.0);
    }
    return scene_load(m->s, why); /* all other slimes */
}

status scene_motion_create(scene *s, scene_motion **out, diagnostic *why)
{
    *out = NULL;
    const size_t count = motion_count_slimes(s);
    if (count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "add a mesh with 'generate: slime'", "nothing moves in this scene");
    scene_motion *m = calloc(1, sizeof *m);
    moving_slime *slimes = calloc(count, sizeof *slimes);
    if (!m || !slimes) {
        free(m);
        free(slimes);
        return out_of_memory(why);
    }
    m->s = s;
    m->slimes = slimes;
    const status code = begin(m, why);
    if (code != STATUS_OK) {
        scene_motion_end(m); /* a state at time 0 would be taken for another time */
        return code;
    }
    *out = m;
    return STATUS_OK;
}

void scene_motion_destroy(scene_motion *m)
{
    if (!m)
        return;
    for (size_t i = 0; i < m->count; i++)
        motion_forget(&m->slimes[i]);
    free(m->slimes);
    free(m);
}

/* Advances one of count slimes. */
typedef struct turn_watch {
    const load_watch *whole;
    size_t turn, count;
} turn_watch;

static void show_turn(void *context, double share_done)
{
    const turn_watch *w = context;
    w->whole->progress(w->whole->context, ((double)w->turn + share_done) / (double)w->count);
}

static status advance_one(scene_motion *m, size_t i, double time_s, const load_watch *watch, diagnostic *why)
{
    moving_slime *one = &m->slimes[i];
    const double motion_before_s = one->x.motion_s;
    turn_watch turn = {watch, i, m->count};
    const status code =
        slime_advance(&one->x, m->s, motion_entry(m, one), time_s, watch ? &(load_watch){show_turn, &turn} : NULL, why);
    m->last.step_s += one->x.motion_s - motion_before_s;
    return code;
}

static status show_one(scene_motion *m, moving_slime *one, double time_s, bool surfaces, diagnostic *why)
{
    const mesh_entry *entry = motion_entry(m, one);
    status code = STATUS_OK;
    if (surfaces) {
        const double begun_s = clock_wall_s();
        code = move_surface(m, one, why);
        m->last.skin_s += clock_wall_s() - begun_s;
    }
    if (code == STATUS_OK) {
        motion_take_account(m, one, time_s > entry->time_s ? time_s : entry->time_s); /* time does not go back */
        m->last.steps += entry->account.steps - one->steps;
        one->steps = entry->account.steps;
    }
    return code;
}

status scene_motion_advance_until(scene_motion *m, double time_s, bool surfaces, const load_watch *watch,
                                  diagnostic *why)
{
    m->last = (scene_motion_report){.steps = 0};
    for (size_t i = 0; i < m->count; i++)
        TRY(advance_one(m, i, time_s, watch, why));
    status code = STATUS_OK;
    cancel_token shield; /* surfaces stay whole, and follow quickly */
    cancel_shield(&shield);
    for (size_t i = 0; i < m->count && code == STATUS_OK; i++)
        code = show_one(m, &m->slimes[i], time_s, surfaces, why);
    cancel_end(&shield);
    return code;
}

status scene_motion_advance(scene_motion *m, double time_s, bool surfaces, diagnostic *why)
{
    return scene_motion_advance_until(m, time_s, surfaces, NULL, why);
}

scene_motion_report scene_motion_last(const scene_motion *m)
{
    return m->last;
}

size_t scene_motion_count(const scene_motion *m)
{
    return m->count;
}

softbody *scene_motion_body(const scene_motion *m, size_t i)
{
    return m->slimes[i].x.body;
}

size_t scene_motion_mesh(const scene_motion *m, size_t i)
{
    return m->slimes[i].entry;
}

double scene_motion_script_end_s(const scene_motion *m)
{
    double end_s = 0.0;
    for (size_t i = 0; i < m->count; i++) {
        const hand_script *script = m->slimes[i].x.script;
        end_s = fmax(end_s, script ? hand_script_end_s(script) : 0.0);
    }
    return end_s;
}

bool scene_motion_drop_scripts(scene_motion *m)
{
    bool any = false;
    for (size_t i = 0; i < m->count; i++) {
        slime *x = &m->slimes[i].x;
        any |= x->script && softbody_follow(x->body, NULL, NULL) == STATUS_OK;
        hand_script_destroy(x->script);
        x->script = NULL;
    }
    return any;
}
