/* What a ray knows of where it belongs, in one number: the pixel, and for films of more than one sample a pixel (spectral ones,
 * those of random paths) the sample too. An rgb film of Whitted's rays has the pixel alone. */
#ifndef CUVETTE_RENDER_TICKET_H
#define CUVETTE_RENDER_TICKET_H

#include <stdint.h>

/* The ray may meet a light that shines: it comes from the eye or from a mirror-like surface. */
#define TICKET_SEES_LIGHTS ((int64_t)1 << 62)

static inline int64_t ticket_make(int64_t pixel, int64_t sample)
{
    return pixel | sample << 32;
}

static inline int64_t ticket_pixel(int64_t ticket)
{
    return ticket & 0xffffffff;
}

static inline int64_t ticket_sample(int64_t ticket)
{
    return (ticket & ~TICKET_SEES_LIGHTS) >> 32;
}

#endif
