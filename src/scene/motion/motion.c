/* Attaches a simulation to the slimes of a scene, and moves them through time. */
#include "base/cancel.h"
#include "base/text.h"
#include "measure/clock.h"
#include "scene/assets/slime.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "scene/motion/motion_hands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- slimes, and the scene's data before the simulation --- */

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

/* All parameters of a slime except time_s, and the path of its script, as one text. NULL if memory runs out. */
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

static status remember(scene_motion *m, moving_slime *moving, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, moving);
    moving->name = strdup(entry->name);
    moving->parameters = motion_parameters(m->s, entry);
    if (!moving->name || !moving->parameters)
        return out_of_memory(why);
    save_original(&moving->original, entry);
    return STATUS_OK;
}

static void forget(moving_slime *moving)
{
    slime_destroy(&moving->x);
    mesh_release(moving->original.data);
    mesh_release(moving->surface);
    free(moving->name);
    free(moving->parameters);
}

/* --- surfaces --- */

/* Replaces the entry's surface by a new one: others may have references to the current one. */
static status make_surface(const scene_motion *m, const moving_slime *moving, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, moving);
    mesh *surface = NULL;
    TRY(softbody_surface(moving->x.body, &surface, why));
    mesh_entry_unload(entry);
    entry->data = surface;
    return STATUS_OK;
}

static void add_moves(hierarchy_update_counts *sum, const hierarchy_update_counts *more)
{
    sum->refitted += more->refitted;
    sum->rebuilt += more->rebuilt;
    sum->refit_s += more->refit_s;
    sum->build_s += more->build_s;
    sum->growth = sum->growth > more->growth ? sum->growth : more->growth;
}

static status move_surface(scene_motion *m, const moving_slime *moving, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, moving);
    if (!entry->data || mesh_reference_count(entry->data) > 1)
        return make_surface(m, moving, why);
    /* It may be changed: make_surface made the mesh, and the entry has the only reference. */
    status code = softbody_move_surface(moving->x.body, (mesh *)(uintptr_t)entry->data, why);
    hierarchy_update_counts moves = {.refitted = 0};
    THEN(code, hierarchy_update(entry->data, m->s->render.rebuild, scene_build_threads(&m->s->render), &moves, why));
    if (code != STATUS_OK) {
        mesh_entry_unload(entry); /* triangles and hierarchies would be inconsistent */
        return code;
    }
    add_moves(&m->last.hierarchies, &moves);
    return STATUS_OK;
}

static void update_entry(scene_motion *m, moving_slime *moving, double time_s)
{
    mesh_entry *entry = motion_entry(m, moving);
    moving->time_s = time_s;
    entry->time_s = time_s;
    entry->account = softbody_measure(moving->x.body);
    entry->motion_s = moving->x.motion_s;
}

/* --- scenes: attaching and leaving --- */

void scene_motion_leave(scene_motion *m)
{
    for (size_t i = 0; m->s && i < m->count; i++) {
        moving_slime *moving = &m->slimes[i];
        mesh_entry *entry = motion_entry(m, moving);
        moving->surface = entry->data;
        entry->data = NULL;
        restore_original(entry, &moving->original);
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
        moving_slime *moving = &m->slimes[m->count];
        *moving = (moving_slime){.entry = i};
        TRY(slime_create(m->s, &m->s->meshes[i], &moving->x, why));
        status code = remember(m, moving, why);
        if (code != STATUS_OK) {
            forget(moving);
            return code;
        }
        m->count++;
        code = make_surface(m, moving, why);
        if (code != STATUS_OK)
            return code;
        update_entry(m, moving, 0.0);
    }
    return scene_load(m->s, why); /* loads everything else */
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
        scene_motion_end(m); /* a surface at time 0 would pass for the surface at time_s */
        return code;
    }
    *out = m;
    return STATUS_OK;
}

/* Finds the mesh with the same name and parameters. */
static status find_equal(const scene *s, const moving_slime *moving, size_t *mesh_index, bool *found, diagnostic *why)
{
    *found = false;
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *entry = &s->meshes[i];
        if (entry->source != MESH_SLIME || strcmp(entry->name, moving->name) != 0)
            continue;
        char *parameters = motion_parameters(s, entry);
        if (!parameters)
            return out_of_memory(why);
        *mesh_index = i;
        *found = strcmp(parameters, moving->parameters) == 0;
        free(parameters);
        break;
    }
    return STATUS_OK;
}

static void attach(scene_motion *m, moving_slime *moving)
{
    mesh_entry *entry = motion_entry(m, moving);
    save_original(&moving->original, entry);
    mesh_entry_unload(entry);
    entry->data = moving->surface;
    moving->surface = NULL;
    update_entry(m, moving, moving->time_s);
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
        moving_slime *moving = &m->slimes[i];
        const bool had_surface = moving->surface != NULL;
        moving->entry = places[i];
        attach(m, moving);
        code = had_surface ? STATUS_OK : make_surface(m, moving, why);
    }
    return code;
}

/* --- time --- */

/* Progress of all slimes, which advance one after another. */
typedef struct slime_watch {
    const load_watch *watch;
    size_t index, count;
} slime_watch;

static void report_progress(void *context, double fraction)
{
    const slime_watch *w = context;
    w->watch->progress(w->watch->context, ((double)w->index + fraction) / (double)w->count);
}

static status advance_one(scene_motion *m, size_t i, double time_s, const load_watch *watch, diagnostic *why)
{
    moving_slime *moving = &m->slimes[i];
    const double motion_before_s = moving->x.motion_s;
    slime_watch progress = {watch, i, m->count};
    const status code = slime_advance(&moving->x, m->s, motion_entry(m, moving), time_s,
                                      watch ? &(load_watch){report_progress, &progress} : NULL, why);
    m->last.step_s += moving->x.motion_s - motion_before_s;
    return code;
}

static status show_one(scene_motion *m, moving_slime *moving, double time_s, bool surfaces, diagnostic *why)
{
    const mesh_entry *entry = motion_entry(m, moving);
    status code = STATUS_OK;
    if (surfaces) {
        const double begun_s = clock_wall_s();
        code = move_surface(m, moving, why);
        m->last.surface_s += clock_wall_s() - begun_s;
    }
    if (code == STATUS_OK) {
        update_entry(m, moving, time_s > entry->time_s ? time_s : entry->time_s); /* time does not go back */
        m->last.steps += entry->account.steps - moving->steps;
        moving->steps = entry->account.steps;
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
    cancel_token shield; /* a surface is moved completely or not at all, which takes little time */
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
