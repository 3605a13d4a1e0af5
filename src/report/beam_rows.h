/* Writers of the rays of a scene's beams, as text and JSON, and of what a screen receives. Errors of the stream stay in
 * the stream. Ownership: everything is borrowed. */
#pragma once

#include "render/inspect/beams.h"
#include <stdio.h>

typedef struct beamed {
    const scene *s;
    isa level;
    const char *scene_path;
    size_t segments_max; /* more rays of the trees than this are STATUS_BAD_INPUT; 0: no limit */
    bool for_page;       /* as of traced */
} beamed;

/* cuvette-trace(1) documents both. */
status beams_write_text(const beamed *b, FILE *out, diagnostic *why);
status beams_write_json(const beamed *b, FILE *out, diagnostic *why);

status beam_screen_write_json(const beam_screen *screen, FILE *out, diagnostic *why);
