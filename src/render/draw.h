/* What is drawn by chance: a function of the seed, the pixel, the sample, the depth and the purpose, so that a picture
 * does not depend on who draws when (design, decision 5). Pure. */
#ifndef CUVETTE_RENDER_DRAW_H
#define CUVETTE_RENDER_DRAW_H

#include "base/random.h"
#include "render/ticket.h"

enum { DRAW_WAVELENGTH, DRAW_BRANCH, DRAW_DIRECTION, DRAW_ROULETTE, DRAW_LIGHT /* and one more for each light */ };

static inline random_words draw(int64_t seed, int64_t ticket, int depth, int purpose)
{
    return random_at((uint64_t)seed, (uint32_t)ticket_pixel(ticket), (uint32_t)ticket_sample(ticket), (uint32_t)depth,
                     (uint32_t)purpose);
}

#endif
