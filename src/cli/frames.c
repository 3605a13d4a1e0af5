#include "cli/frames.h"
#include "cli/terminal.h"
#include <stdlib.h>

typedef struct stage {
    progress_line line;
    size_t frame, frames; /* now, of how many */
} stage;

static bool show_progress(void *context, double share_done)
{
    stage *now = context;
    if (now->line.enabled)
        progress_draw(&now->line, ((double)now->frame + share_done) / (double)now->frames);
    return !terminal_stop_asked();
}

/* Takes the new result in place of the old one, if it may. */
static status keep(frames *out, render_result *result, status ended, diagnostic *why)
{
    if (ended == STATUS_INTERRUPTED && out->result) {
        render_result_destroy(result); /* a whole frame says more than a part of one */
        return ended;
    }
    if (ended == STATUS_OK && out->result && film_hash(result->picture) != film_hash(out->result->picture)) {
        render_result_destroy(result);
        return diagnose(why, STATUS_FAILURE, "report this as a bug, with the scene", "two frames of one scene differ");
    }
    render_result_destroy(out->result);
    out->result = result;
    return ended;
}

static status render_one(renderer *r, const scene *s, const render_options *options, frames *out, diagnostic *why)
{
    render_result *result = NULL;
    status ended = renderer_render(r, s, options, &result, why);
    if (!result)
        return ended;
    double wall_s = result->wall_s, cpu_s = result->cpu_s;
    ended = keep(out, result, ended, why);
    if (ended == STATUS_OK) {
        out->wall_s[out->count] = wall_s;
        out->cpu_s[out->count] = cpu_s;
    }
    return ended;
}

/* The maps of one further frame go to the result of the last measured one, whose times stay undisturbed. */
static status add_maps(renderer *r, const scene *s, const render_options *options, frames *out, diagnostic *why)
{
    render_result *result = NULL;
    status ended = renderer_render(r, s, options, &result, why);
    if (ended == STATUS_OK) {
        render_result swapped = *out->result;
        out->result->pixel_rays = result->pixel_rays;
        out->result->pixel_ns = result->pixel_ns;
        out->result->events = result->events;
        out->result->event_count = result->event_count;
        result->pixel_rays = swapped.pixel_rays;
        result->pixel_ns = swapped.pixel_ns;
        result->events = swapped.events;
        result->event_count = swapped.event_count;
    }
    render_result_destroy(result);
    return ended;
}

static status render_all(renderer *r, const scene *s, size_t count, const render_options *wanted,
                         const hardware_counter *counter, frames *out, diagnostic *why)
{
    bool extra = count > 1 && (wanted->pixel_rays || wanted->pixel_time || wanted->timeline);
    stage now = {.frames = count + extra};
    render_options bare = {.progress = show_progress, .context = &now};
    render_options full = *wanted;
    full.progress = show_progress;
    full.context = &now;
    progress_start(&now.line, "rendering");
    usage before = usage_now();
    hardware_counts counts_before = hardware_counter_read(counter);
    status ended = STATUS_OK;
    for (; ended == STATUS_OK && out->count < count; now.frame++) {
        ended = render_one(r, s, count > 1 ? &bare : &full, out, why);
        out->count += ended == STATUS_OK;
    }
    out->hardware = hardware_counts_since(counter, &counts_before);
    out->spent = usage_since(&before);
    if (ended == STATUS_OK && extra)
        ended = add_maps(r, s, &full, out, why);
    progress_erase(&now.line);
    out->whole = ended == STATUS_OK;
    return ended;
}

status frames_render(const scene *s, isa level, size_t count, const render_options *options, frames *out,
                     diagnostic *why)
{
    *out = (frames){.wall_s = calloc(count + 1, sizeof(double)), .cpu_s = calloc(count + 1, sizeof(double))};
    if (!out->wall_s || !out->cpu_s)
        return out_of_memory(why);
    hardware_counter *counter = hardware_counter_create(); /* before the pool: it counts threads that start after it */
    topology *machine = NULL;
    renderer *r = NULL;
    status ended = topology_create(&machine, why);
    if (ended == STATUS_OK)
        ended = renderer_create(level, machine, &r, why);
    if (ended == STATUS_OK)
        ended = renderer_prepare(r, s, why);
    if (ended == STATUS_OK)
        ended = render_all(r, s, count, options, counter, out, why);
    renderer_destroy(r);
    topology_destroy(machine);
    hardware_counter_destroy(counter);
    return ended;
}

void frames_release(frames *f)
{
    render_result_destroy(f->result);
    free(f->wall_s);
    free(f->cpu_s);
    *f = (frames){0};
}
