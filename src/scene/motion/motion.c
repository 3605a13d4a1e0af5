/* A simulated scene: its slimes, attached to it, and moved through time. */
#include "base/cancel.h"
#include "base/text.h"
#include "measure/clock.h"
#include "scene/assets/script.h"
#include "scene/assets/slime.h"
#include "scene/model/params.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"
#include "scene/motion/motion_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- slimes, and what their scene had before --- */

static size_t count_slimes(const scene *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        count += s->meshes[i].source == MESH_SLIME;
    return count;
}

bool scene_moves(const scene *s)
{
    return count_slimes(s) > 0;
}

static bool affects_body(const param *row)
{
    return row->group == PARAM_MESH && row->offset != offsetof(mesh_entry, time_s);
}

/* All its parameters except time_s as one text, and the path of its script. NULL if memory runs out. */
static char *motion_parameters(const scene *s, const mesh_entry *entry)
{
    char *text = NULL, *script = scene_file_path(s, entry->script_path);
    text_writer writer;
    bool good = script && text_writer_open(&writer, NULL) == STATUS_OK;
    const bool begun = good;
    for (size_t i = 0; i < param_count() && good; i++) {
        const param *row = param_at(i);
        char *value = affects_body(row) ? param_value_text(row, -1, (const char *)entry + row->offset) : NULL;
        good = !affects_body(row) || (value && fprintf(writer.stream, "%s\n", value) >= 0);
        free(value);
    }
    good = good && (!entry->script_path[0] || fprintf(writer.stream, "%s\n", script) >= 0);
    free(script);
    if (begun)
        text_writer_end(&writer, good ? STATUS_OK : STATUS_FAILURE, &text, NULL, NULL);
    return text;
}

static void save_original(original_slime *original, mesh_entry *entry)
{
    *original = (original_slime){
        .time_s = entry->time_s, .data = entry->data, .account = entry->account, .motion_s = entry->motion_s};
    entry->data = NULL;
}

static void restore_original(mesh_entry *entry, original_slime *original)
{
    mesh_entry_unload(entry);
    entry->time_s = original->time_s;
    entry->data = original->data;
    entry->account = original->account;
    entry->motion_s = original->motion_s;
    *original = (original_slime){.data = NULL};
}

static status remember(scene_motion *m, moving_slime *one, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, one);
    one->name = strdup(entry->name);
    one->parameters = motion_parameters(m->s, entry);
    if (!one->name || !one->parameters)
        return out_of_memory(why);
    save_original(&one->original, entry);
    return STATUS_OK;
}

static void forget(moving_slime *one)
{
    slime_destroy(&one->x);
    mesh_release(one->original.data);
    mesh_release(one->surface);
    free(one->name);
    free(one->parameters);
}

/* --- surfaces --- */

/* Gives the entry a surface of its own, since the current one may be shared. */
static status make_surface(const scene_motion *m, const moving_slime *one, diagnostic *why)
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
        return make_surface(m, one, why);
    /* Made by make_surface for this scene, its only owner. */
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

static void update_entry(scene_motion *m, moving_slime *one, double time_s)
{
    mesh_entry *entry = motion_entry(m, one);
    one->time_s = time_s;
    entry->time_s = time_s;
    entry->account = softbody_measure(one->x.body);
    entry->motion_s = one->x.motion_s;
}

/* --- scenes: attaching and leaving --- */

void scene_motion_leave(scene_motion *m)
{
    for (size_t i = 0; m->s && i < m->count; i++) {
        moving_slime *one = &m->slimes[i];
        mesh_entry *entry = motion_entry(m, one);
        one->surface = entry->data;
        entry->data = NULL;
        restore_original(entry, &one->original);
    }
    m->s = NULL;
}

void scene_motion_destroy(scene_motion *m)
{
    if (!m)
        return;
    for (size_t i = 0; i < m->count; i++)
        forget(&m->slimes[i]);
    free(m->slimes);
    free(m);
}

void scene_motion_end(scene_motion *m)
{
    if (m) {
        scene_motion_leave(m);
        scene_motion_destroy(m);
    }
}

static status begin(scene_motion *m, diagnostic *why)
{
    for (size_t i = 0; i < m->s->mesh_count; i++) {
        if (m->s->meshes[i].source != MESH_SLIME)
            continue;
        moving_slime *one = &m->slimes[m->count];
        *one = (moving_slime){.entry = i};
        TRY(slime_create(m->s, &m->s->meshes[i], &one->x, why));
        status code = remember(m, one, why);
        if (code != STATUS_OK) {
            forget(one);
            return code;
        }
        m->count++;
        code = make_surface(m, one, why);
        if (code != STATUS_OK)
            return code;
        update_entry(m, one, 0.0);
    }
    return scene_load(m->s, why); /* all other slimes */
}

status scene_motion_create(scene *s, scene_motion **out, diagnostic *why)
{
    *out = NULL;
    const size_t count = count_slimes(s);
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

/* Index of the mesh with the same name and parameters. */
static status find_equal(const scene *s, const moving_slime *one, size_t *mesh_index, bool *found, diagnostic *why)
{
    *found = false;
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *entry = &s->meshes[i];
        if (entry->source != MESH_SLIME || strcmp(entry->name, one->name) != 0)
            continue;
        char *parameters = motion_parameters(s, entry);
        if (!parameters)
            return out_of_memory(why);
        *mesh_index = i;
        *found = strcmp(parameters, one->parameters) == 0;
        free(parameters);
        break;
    }
    return STATUS_OK;
}

static void attach(scene_motion *m, moving_slime *one)
{
    mesh_entry *entry = motion_entry(m, one);
    save_original(&one->original, entry);
    mesh_entry_unload(entry);
    entry->data = one->surface;
    one->surface = NULL;
    update_entry(m, one, one->time_s);
}

status scene_motion_join(scene_motion *m, scene *s, bool *joined, diagnostic *why)
{
    *joined = count_slimes(s) == m->count;
    size_t places[SCENE_MESHES_MAX];
    status code = STATUS_OK;
    for (size_t i = 0; i < m->count && *joined && code == STATUS_OK; i++)
        code = find_equal(s, &m->slimes[i], &places[i], joined, why);
    if (code != STATUS_OK || !*joined) {
        *joined = false;
        return code;
    }
    scene_motion_leave(m);
    m->s = s;
    for (size_t i = 0; i < m->count && code == STATUS_OK; i++) {
        moving_slime *one = &m->slimes[i];
        const bool had_surface = one->surface != NULL;
        one->entry = places[i];
        attach(m, one);
        code = had_surface ? STATUS_OK : make_surface(m, one, why);
    }
    return code;
}

/* --- time --- */

/* Advances one of count slimes. */
typedef struct turn_watch {
    const load_watch *watch;
    size_t turn, count;
} turn_watch;

static void show_turn(void *context, double fraction)
{
    const turn_watch *w = context;
    w->watch->progress(w->watch->context, ((double)w->turn + fraction) / (double)w->count);
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
        update_entry(m, one, time_s > entry->time_s ? time_s : entry->time_s); /* time does not go back */
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
    cancel_token shield; /* a surface is moved completely or not at all; that takes little time */
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

/* --- the times of frames --- */

int64_t frame_times_count(const frame_times *t)
{
    return (int64_t)fmax(1, round(t->duration_s * (double)t->fps_num / (double)t->fps_den));
}

double frame_times_at(const frame_times *t, int64_t frame)
{
    return t->start_s + (double)(frame * t->fps_den) / (double)t->fps_num;
}

/* *end_s: the latest key time of all scripts of the scene's slimes; *any: whether any slime has a script. */
static status find_script_end(const scene *s, bool *any, double *end_s, diagnostic *why)
{
    *any = false;
    *end_s = 0;
    status result = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && result == STATUS_OK; i++) {
        hand_script *script = NULL;
        if (s->meshes[i].source == MESH_SLIME)
            result = slime_read_script(s, &s->meshes[i], &script, why);
        if (script) {
            *any = true;
            *end_s = fmax(*end_s, hand_script_end_s(script));
        }
        hand_script_destroy(script);
    }
    return result;
}

status frame_times_choose(frame_times *t, const scene *s, diagnostic *why)
{
    const double rest_s = 2, without_script_s = 4;
    bool any;
    double end_s;
    TRY(find_script_end(s, &any, &end_s, why));
    if (t->duration_s < 0)
        t->duration_s = any ? fmax(0, end_s + rest_s - t->start_s) : without_script_s;
    return STATUS_OK;
}

status frame_times_check_end(const frame_times *t, const scene *s, diagnostic *why)
{
    status result = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && result == STATUS_OK; i++)
        if (s->meshes[i].source == MESH_SLIME)
            result = slime_check_end(&s->meshes[i], t->start_s + t->duration_s, why);
    return result;
}
