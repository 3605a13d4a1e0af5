/* Random draws: a pure function of the seed, pixel, sample, depth and purpose, so that an image does not depend on
 * which worker draws when. */
#pragma once

#include "base/random.h"
#include "render/core/sample_key.h"
#include "scene/model/lights.h"
#include <assert.h>

/* These numbers affect every image and must never change. New purposes are numbered from DRAW_NEXT, below 2^16; each
 * light has its own number from DRAW_LIGHT on. */
enum {
    DRAW_WAVELENGTH = 0,
    DRAW_BRANCH = 1,
    DRAW_DIRECTION = 2,
    DRAW_ROULETTE = 3,
    DRAW_LIGHT = 4,
    DRAW_PIXEL = 0x1000,
    DRAW_PHOTON = 0x1001, /* and the next one */
    DRAW_LENS = 0x1003,
    DRAW_FACET = 0x1004,       /* of a rough surface */
    DRAW_FACET_LIGHT = 0x1005, /* on its side; the next one: on the other */
    DRAW_FLIGHT = 0x1007,      /* of a ray in a medium that scatters */
    DRAW_PHASE = 0x1008,       /* its direction afterwards */
    DRAW_AIRLIGHT = 0x1009,    /* from there on, each light has its own number */
    DRAW_FURTHER =
        DRAW_AIRLIGHT + SCENE_LIGHTS_MAX, /* whether light meets further facets; the next one: its direction */
    DRAW_PHOTON_END = DRAW_FURTHER + 2,   /* Russian roulette of deep photons, and their branch */
    DRAW_NEXT
};
static_assert(DRAW_LIGHT + SCENE_LIGHTS_MAX <= DRAW_PIXEL,
              "the lights' numbers must not overlap those of the next purpose");

static inline random_words draw(int64_t seed, int64_t sample_key, int depth, int purpose)
{
    return random_at((uint64_t)seed, (uint32_t)sample_key_pixel(sample_key), (uint32_t)sample_key_sample(sample_key),
                     (uint32_t)depth, (uint32_t)purpose);
}
