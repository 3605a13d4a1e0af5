/* Polarising filters and wave plates: what a passage through a transparent solid does to light. Plain functions; they
 * borrow what they are given. */
#pragma once

#include "scene/model/material.h"
#include "scene/model/render_settings.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef enum sheet_kind {
    SHEET_NONE,
    SHEET_POLARISER,
    SHEET_CIRCULAR_LEFT,
    SHEET_CIRCULAR_RIGHT,
    SHEET_RETARDER
} sheet_kind;

bool sheet_is_polariser(const material *m);
/* Has a polariser or a wave plate an axis, on which its light depends? */
bool sheet_has_axis(const material *m);
bool sheet_retards(const material *m);

/* Whether light that passes the solid, if any does, changes: a polariser's without polarisation too, where it is a grey
 * filter. Not in the depth buffer. */
bool sheet_acts(const material *m, const render_settings *r);
/* Whether it acts differently by wavelength. */
bool sheet_disperses(const material *m, const render_settings *r);

/* STATUS_BAD_INPUT if its axis has no direction. */
status sheet_check(const material *m, const char *label, diagnostic *why);
