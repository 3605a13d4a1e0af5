/* Random paths that a depth limit ends. A path of a greater depth begins like that of a smaller one, with
 * the same random numbers: the difference of two images is what the deeper events bring, and nearly free of noise. */
#include "lint/lack.h"
#include "lint/parts.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>

/* The least depth of a doubling sequence whose image lacks little; the deepest image is at COUNTERS_DEPTH_MAX. *enough
 * is INT_MAX if none is. */
static status find_enough(probe_images *images, int depth, const probe_image *deepest, int *enough, diagnostic *why)
{
    const size_t pixels = probe_pixels(images);
    probe_image at = {.rgb = NULL};
    status code = STATUS_OK;
    for (*enough = 2 * depth + 2; *enough < COUNTERS_DEPTH_MAX && code == STATUS_OK; *enough *= 2) {
        code = probe_images_trace(images, *enough, &at, why);
        if (code == STATUS_OK && lack_of(pixels, &at, deepest).mean <= LACK_ACCEPTED)
            break;
    }
    *enough = *enough < COUNTERS_DEPTH_MAX ? *enough : COUNTERS_DEPTH_MAX;
    probe_image_free(&at);
    return code;
}

static status note_paths(const lint_room *room, probe_images *images, lack here, const probe_image *deepest,
                         diagnostic *why)
{
    const int depth = (int)images->depth;
    char remedy[NOTE_TEXT_MAX] = "set " REMEDY_WITHOUT_LIMIT;
    if (here.unknown <= LACK_ACCEPTED) {
        int enough;
        TRY(find_enough(images, depth, deepest, &enough, why));
        snprintf(remedy, sizeof remedy, "set render.depth=%d", enough);
    }
    note_give(room->taker, "render", "depth", remedy,
              "paths that end at a depth of %d could bring about %.3g %% of the image's light", depth,
              100.0 * fmin(here.mean, 1.0));
    return STATUS_OK;
}

static status examine(const lint_room *room, probe_images *images, probe_image at[2], diagnostic *why)
{
    const size_t pixels = probe_pixels(images);
    const int depth = (int)images->depth;
    TRY(probe_images_trace(images, depth, &at[0], why));
    if (lack_cut(pixels, &at[0]) == 0.0)
        return STATUS_OK;
    TRY(probe_images_trace(images, COUNTERS_DEPTH_MAX, &at[1], why));
    const lack here = lack_of(pixels, &at[0], &at[1]);
    if (probe_images_overflowed(images) || here.mean <= LACK_ACCEPTED + 2.0 * here.error)
        return STATUS_OK;
    return note_paths(room, images, here, &at[1], why);
}

status lint_path_depth(const lint_room *room, diagnostic *why)
{
    probe_images images;
    probe_image at[2] = {{.rgb = NULL}};
    if (room->made->render.depth > COUNTERS_DEPTH_MAX)
        return STATUS_OK;
    const status code =
        probe_images_begin(&images, room->made, room->level) ? examine(room, &images, at, why) : out_of_memory(why);
    probe_image_free(&at[0]);
    probe_image_free(&at[1]);
    probe_images_end(&images);
    return code;
}
