/* Lamps of the random scenes that not every law can change: polarised ones with sheets before them, and beams. Each
 * from a separate stream of numbers, so that scenes stay as they are otherwise. Ownership: values. */
#pragma once

#include "law_scene.h"

/* Where polarisation is traced: sheets on some clear solids, and polarised lights. */
static inline void polarise(law_scene *w, uint64_t seed)
{
    static const char *const kinds[] = {"polariser", "retarder", "circular_left", "circular_right"};
    uint64_t own = seed ^ 0x6d616c75u; /* "malu" */
    if (!law_settings_have(w, "polarisation"))
        return;
    for (int i = 0; i < w->light_count; i++) {
        w->light[i].polarised = random_below(&own, 3) ? random_real(&own, 0.0, 1.0) : 0.0;
        w->light[i].polarisation_deg = random_real(&own, -180.0, 180.0);
    }
    for (int i = 0; i < w->solid_count; i++) {
        law_solid *s = &w->solid[i];
        const int kind = random_below(&own, 8);
        s->sheet_axis = random_direction(&own);
        if (!s->opaque && s->extraordinary_ior == 0.0 && kind < (int)COUNT(kinds))
            s->sheet = kinds[kind];
    }
}

/* Towards the middle of the scene, or past it. */
static inline void add_beam(law_scene *w, uint64_t seed)
{
    static const char *const kinds[] = {"pencil", "fan", "sheet", "bundle"}, *const profiles[] = {"uniform",
                                                                                                  "gaussian"};
    uint64_t own = seed ^ 0x6c617365u; /* "lase" */
    if (!law_settings_have(w, "caustics") || random_below(&own, 4) == 0)
        return;
    w->beam = (law_beam){.kind = kinds[random_below(&own, 4)],
                         .profile = profiles[random_below(&own, 2)],
                         .position = random_point(&own, 4.0),
                         .target = random_point(&own, 0.5),
                         .angle_deg = random_real(&own, 0.5, 60.0),
                         .width = random_real(&own, 0.05, 1.0)};
}
