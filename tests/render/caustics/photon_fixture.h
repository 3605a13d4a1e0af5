/* The photon map of a plan, on one thread. Ownership: the caller destroys the caustics, then the plan. */
#pragma once

#include "render/frame/caustics.h"
#include "render/photons/photon_map.h"
#include "render_fixture.h"

static inline caustics *photons_of(plan *p)
{
    caustics *c = NULL;
    assert_int_equal(caustics_create(p, isa_best(), 1, &c, NULL), STATUS_OK);
    assert_non_null(c);
    for (int k = 0; k < CAUSTICS_STEPS; k++) {
        caustics_steps[k].parallel(c, 0);
        assert_int_equal(caustics_steps[k].serial(c, NULL), STATUS_OK);
    }
    return c;
}
