/* An engine and a scene of the programs that test cuvette.h. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "cuvette.h"

static void fine(cuvette_status code, const cuvette_diagnostic *why)
{
    char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
    if (code != CUVETTE_OK)
        fail_msg("%d: %s", (int)code, cuvette_diagnostic_text(why, text, sizeof text));
}

__attribute__((unused)) static cuvette_engine *make_engine(void)
{
    cuvette_diagnostic why;
    cuvette_engine *engine;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    return engine;
}

__attribute__((unused)) static void turn(cuvette_scene *s, const char *path, const char *value)
{
    cuvette_diagnostic why;
    fine(cuvette_scene_set(s, path, value, &why), &why);
}

/* The rod, width pixels wide. */
__attribute__((unused)) static cuvette_scene *rod(int width, int depth, int threads)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_read("experiments/scenes/rod.yaml", &s, &why), &why);
    fine(cuvette_scene_set_int(s, "render.width", width, &why), &why);
    fine(cuvette_scene_set_int(s, "render.height", width * 3 / 4, &why), &why);
    fine(cuvette_scene_set_int(s, "render.depth", depth, &why), &why);
    fine(cuvette_scene_set_int(s, "render.threads", threads, &why), &why);
    return s;
}

__attribute__((unused)) static uint64_t hash_of(cuvette_engine *engine, const cuvette_scene *s)
{
    cuvette_diagnostic why;
    cuvette_frame *frame;
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    const uint64_t hash = cuvette_frame_hash(frame);
    cuvette_frame_destroy(frame);
    return hash;
}
