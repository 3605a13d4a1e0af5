/* Simulates the slime of a mesh entry up to its time, and makes its surface mesh. */
#include "scene/assets/slime.h"
#include "measure/clock.h"

#include <math.h>
#include <stdlib.h>

/* Locates an error of the body in the scene file, unless it is already located in the script. */
static status body_error(const scene *s, const mesh_entry *m, const diagnostic *bad, status code, diagnostic *why)
{
    if (bad->file[0] && bad->line > 0) {
        diagnostic_locate(why, bad->file, bad->line, bad->column);
        return diagnose(why, code, bad->remedy, "%s", bad->what);
    }
    return scene_file_error(s, m->name, m->path_line, m->path_column, bad, code, why);
}

status slime_read_script(const scene *s, const mesh_entry *m, hand_script **out, diagnostic *why)
{
    *out = NULL;
    if (!m->script_path[0])
        return STATUS_OK;
    char *path = scene_file_path(s, m->script_path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    const status code = script_read_below(path, scene_root(s), out, &bad);
    free(path);
    if (code != STATUS_OK && bad.line == 0) /* the script cannot be opened: the error is where the scene names it */
        return scene_file_error(s, m->name, m->script_line, m->script_column, &bad, code, why);
    return code == STATUS_OK ? code : body_error(s, m, &bad, code, why);
}

status slime_create(const scene *s, const mesh_entry *m, slime *out, diagnostic *why)
{
    *out = (slime){.body = NULL};
    const softbody_settings settings = slime_settings(m);
    hand_script *script;
    TRY(slime_read_script(s, m, &script, why));
    diagnostic bad = {.what = ""};
    softbody *body = NULL;
    status code = softbody_create(&settings, isa_best(), &body, &bad);
    if (code != STATUS_OK) {
        hand_script_destroy(script);
        return body_error(s, m, &bad, code, why);
    }
    if (script)
        code = softbody_follow(body, script, why);
    *out = (slime){.body = body, .script = script};
    if (code != STATUS_OK)
        slime_destroy(out);
    return code;
}

void slime_destroy(slime *x)
{
    softbody_destroy(x->body);
    hand_script_destroy(x->script);
    *x = (slime){.body = NULL};
}

static double steps_to(const mesh_entry *m, double time_s)
{
    return floor(time_s / m->slime.dt_s + 0.5); /* counted as by softbody_advance */
}

static status interrupted(const slime *x, const scene *s, const mesh_entry *m, double time_s, diagnostic *bad)
{
    return diagnose_at(bad, scene_path(s), STATUS_INTERRUPTED, "", "interrupted at %.6g s of %.6g s of simulated time",
                       x->steps * m->slime.dt_s, time_s);
}

/* Advances one step per call, so that progress is reported often, however long the motion is. */
static status advance_watched(slime *x, const scene *s, const mesh_entry *m, double time_s, const load_watch *watch,
                              diagnostic *bad)
{
    const double show_s = 0.01, first = x->steps, last = steps_to(m, time_s);
    double shown_s = clock_wall_s();
    for (; x->steps < last; x->steps += 1.0) {
        const status code = softbody_advance(x->body, (x->steps + 1.0) * m->slime.dt_s, bad);
        if (code == STATUS_INTERRUPTED)
            return interrupted(x, s, m, time_s, bad);
        if (code != STATUS_OK)
            return code;
        const double now_s = clock_wall_s();
        if (now_s - shown_s < show_s)
            continue;
        shown_s = now_s;
        watch->progress(watch->context, (x->steps + 1.0 - first) / (last - first));
    }
    return STATUS_OK;
}

status slime_advance(slime *x, const scene *s, const mesh_entry *m, double time_s, const load_watch *watch,
                     diagnostic *why)
{
    diagnostic bad = {.what = ""};
    const double begun_s = clock_wall_s();
    status code = watch ? advance_watched(x, s, m, time_s, watch, &bad) : STATUS_OK;
    if (code == STATUS_OK) {
        code = softbody_advance(x->body, time_s, &bad);
        x->steps = fmax(x->steps, code == STATUS_OK ? steps_to(m, time_s) : 0.0);
    }
    x->motion_s += clock_wall_s() - begun_s;
    if (code == STATUS_INTERRUPTED)
        return diagnose_at(why, bad.file, code, "", "%.80s: %s", m->name, bad.what);
    return code == STATUS_OK ? code : body_error(s, m, &bad, code, why);
}

static status make_surface_mesh(const slime *x, const scene *s, mesh_entry *m, diagnostic *why)
{
    diagnostic bad = {.what = ""};
    mesh *surface = NULL;
    const status code = softbody_surface(x->body, &surface, &bad);
    if (code != STATUS_OK)
        return body_error(s, m, &bad, code, why);
    m->data = surface;
    m->account = softbody_measure(x->body);
    m->motion_s = x->motion_s;
    return STATUS_OK;
}

status slime_make(const scene *s, mesh_entry *m, const load_watch *watch, diagnostic *why)
{
    slime x;
    TRY(slime_create(s, m, &x, why));
    status code = slime_advance(&x, s, m, m->time_s, watch, why);
    THEN(code, make_surface_mesh(&x, s, m, why));
    slime_destroy(&x);
    return code;
}
