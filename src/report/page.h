/* A self-contained page (HTML): the image, its rays with their numbers, the scene and the command, in one file that
 * opens without a server or network and runs no scripts, but those of the laboratory if it holds that. `cuvette
 * render` and the laboratory open its scene again (scene/file/shared.h), unless the scene reads files. Errors of the
 * stream stay in the stream. Ownership: everything is borrowed. */
#pragma once

#include "base/isa.h"
#include "image/image.h"
#include "scene/model/open.h"
#include <stdint.h>
#include <stdio.h>

typedef struct report_page_content {
    const scene *s; /* loaded */
    isa level;
    image_rows rows; /* the image, without texts */
    int bits;        /* of its PNG */
    uint64_t film_hash;
    const char *command; /* that rendered it */
    const char *live;    /* page_live_write; NULL: without the laboratory. A scene that reads files is always without */
} report_page_content;

/* The rays are those of the visible beams, or the ray tree of the middle pixel if there are none. STATUS_BAD_INPUT for
 * a tree that probe_pixel refuses, and for beams beyond the limits of beams_each_ray. */
status report_page_write(const report_page_content *page, FILE *out, diagnostic *why);
