/* The rays of a page: collected from the probe, written as a drawing over the image and as a table. Ownership: zero a
 * page_rays before its first use; page_rays_release frees it. */
#pragma once

#include "render/inspect/beams.h"
#include <stdio.h>

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
