/* A self-contained page (HTML): the image, its rays with their numbers, the scene and the command, in one file that
 * opens without a server or network and runs no scripts except those of a laboratory that it may contain. `cuvette
 * render` and the laboratory open its scene again (scene/file/shared.h), unless the scene reads files. Errors of the
 * stream stay in the stream. Ownership: everything is borrowed. */
#pragma once

#include "base/isa.h"
#include "image/image.h"
#include "render/inspect/beams.h"
#include "scene/model/open.h"
#include <stdint.h>
#include <stdio.h>

typedef struct page_content {
    const scene *s; /* loaded */
    isa level;
    image_rows rows; /* the image, without texts */
    int bits;        /* per channel of the PNG */
    uint64_t film_hash;
    const char *command; /* the command that renders the image */
    const char *live;    /* from page_live_code, not used if the scene reads files; NULL: no laboratory */
} page_content;

/* The rays are those of the visible beams, or the ray tree of the middle pixel if there are none. STATUS_BAD_INPUT for
 * a tree that probe_pixel refuses, and for beams beyond the limits of beams_each_ray. */
status page_write_html(const page_content *page, FILE *out, diagnostic *why);

/* The laboratory within a page: live.html, which `make site` makes, compressed (zlib) as base64, and the script that
 * starts it with the page's scene. The caller frees results with free. */
#define PAGE_LIVE_FILE "live.html"

/* The path of live.html, the first that exists: $CUVETTE_LIVE (only this one if it is set); the folder of the running
 * program; ../share/cuvette or ../../share/cuvette relative to it, where `make install` puts it. NULL if there is none,
 * or, with errno ENOMEM, when out of memory. */
char *page_live_path(void);

/* The laboratory as base64. STATUS_BAD_INPUT if there is no live.html; the remedy says how to build it. */
status page_live_code(char **code, diagnostic *why);

/* The rays of a page: collected from the probe, written as a drawing over the image and as a table. Ownership: zero a
 * page_rays before its first use; page_rays_release frees it. */

enum { PAGE_RAYS_MAX = 300, PAGE_NAME_MAX = 64 };

typedef struct page_ray {
    ray_node node;
    vec3 ends[2];  /* of its line in the image, by ray_line_seen */
    bool drawn;    /* a part of the line is in the image */
    double weight; /* fraction of the light at its start */
    double rgb[3]; /* linear colour of a beam's line */
    double power, lambda_nm;
    char from[PAGE_NAME_MAX], to[PAGE_NAME_MAX], surface[2 * PAGE_NAME_MAX];
    char source[PAGE_NAME_MAX]; /* "BEAM NUMBER", or the light of a shadow ray */
    size_t place;               /* order of tracing */
} page_ray;

typedef struct page_rays {
    page_ray *ray; /* the heaviest, in the order of tracing */
    size_t count, capacity;
    size_t traced; /* rays, without those that depth or weight cut off */
    bool beams;
    int x, y; /* the pixel whose rays are shown, if there are no beams */
    double lambda_nm;
} page_rays;

status page_rays_collect(page_rays *r, const scene *s, isa level, int width, int height, diagnostic *why);
void page_rays_release(page_rays *r);

/* Each line of the drawing links to its row (#rN), each row to its line (#sN). */
void page_rays_write_drawing(const page_rays *r, int width, int height, FILE *out);
void page_rays_write_table(const page_rays *r, FILE *out);
