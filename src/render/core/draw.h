/* What is drawn by chance: a function of the seed, the pixel, the sample, the depth and the purpose, so that a picture
 * does not depend on who draws when (design, decision 5). Pure. */
#pragma once

#include "base/random.h"
#include "render/core/sample_key.h"
#include "scene/model/light.h"
#include <assert.h>

/* These numbers are part of every image and never change. A new purpose counts on from DRAW_NEXT: those from DRAW_LIGHT
 * on are the lights', one each. */
enum {
    DRAW_WAVELENGTH = 0,
    DRAW_BRANCH = 1,
    DRAW_DIRECTION = 2,
    DRAW_ROULETTE = 3,
    DRAW_LIGHT = 4,
    DRAW_NEXT = 0x1000
};
static_assert(DRAW_LIGHT + SCENE_LIGHTS_MAX <= DRAW_NEXT, "lights draw by numbers of their own");

static inline random_words draw(int64_t seed, int64_t sample_key, int depth, int purpose)
{
    return random_at((uint64_t)seed, (uint32_t)sample_key_pixel(sample_key), (uint32_t)sample_key_sample(sample_key),
                     (uint32_t)depth, (uint32_t)purpose);
}
