/* The report's listing 3, lines 95 to 122: threads that are started for a frame and own one block of columns each. */
#include "report.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct block {
    pthread_t thread;
    const room *in;
    const setting *of;
    rgb *pixels;
    int begin, end; /* columns */
    tally counted;
} block;

/* Renders column by column. Counts are on the thread's own stack until it ends. */
static void *render_block(void *argument)
{
    block *b = argument;
    tally counted = {0};
    const int width = b->of->width, height = b->of->height, shorter = width > height ? height : width;
    for (int x = b->begin; x < b->end; x++)
        for (int y = 0; y < height; y++) {
            const float u = (float)(2 * x + 1 - width) / (float)shorter,
                        v = (float)(height - 2 * y - 1) / (float)shorter;
            b->pixels[(size_t)y * (size_t)width + (size_t)x] = room_pixel(b->in, u, v, &counted);
        }
    b->counted = counted;
    return NULL;
}

static void tally_add(tally *sum, const tally *more)
{
    sum->camera += more->camera;
    sum->secondary += more->secondary;
    sum->shadow += more->shadow;
    sum->sky += more->sky;
    for (int i = 0; i < SHAPE_COUNT; i++)
        sum->first_hits[i] += more->first_hits[i];
    if (tally_rays(more) > sum->busiest)
        sum->busiest = tally_rays(more);
    if (more->sky > sum->busiest_sky)
        sum->busiest_sky = more->sky;
}

void room_frame(const room *in, const setting *of, rgb *pixels, tally *counted)
{
    const int columns = (of->width + of->threads - 1) / of->threads;
    block *blocks = allocate((size_t)of->threads * sizeof *blocks);
    for (int i = 0; i < of->threads; i++) {
        /* If there are more threads than columns, the last ones have none; the listing starts them nevertheless. */
        const int begin = i * columns < of->width ? i * columns : of->width;
        const int end = begin + columns < of->width ? begin + columns : of->width;
        blocks[i] = (block){.in = in, .of = of, .pixels = pixels, .begin = begin, .end = end};
        const int failed = pthread_create(&blocks[i].thread, NULL, render_block, &blocks[i]);
        if (failed) {
            fprintf(stderr, "report: thread %d of %d does not start (%s); set fewer with -t\n", i + 1, of->threads,
                    strerror(failed));
            exit(1);
        }
    }
    for (int i = 0; i < of->threads; i++) {
        pthread_join(blocks[i].thread, NULL);
        tally_add(counted, &blocks[i].counted);
    }
    free(blocks);
}
