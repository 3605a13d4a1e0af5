/* Theory of the rod in the picture: whether the camera's ray through a point of the picture meets the rod behind the
 * wall of a filled vessel. Upright surfaces leave n d_y of a ray as it is, d_y the upward part of its unit direction.
 * Seen from above, a ray therefore bends at the circles as a flat one whose indices are sqrt(n^2 - (n d_y)^2): Snell's
 * law with the part along y taken off both sides. Exact. Pure; scalars only. */
#pragma once

#include "realism/setup.h"
#include "realism/view.h"

typedef struct level_section {
    view eye;
    theory_shells shells;
    double x, z;                     /* of the axis */
    double corner_x[4], corner_z[4]; /* of the rod, from the axis */
} level_section;

/* NULL, or why theory has no answer for this scene. */
const char *level_section_read(const scene *s, const setup *at, level_section *out);

/* The same without vessel and liquid. */
level_section level_section_bare(const level_section *c);

bool level_section_sees_rod(const level_section *c, double px, double py);

/* Where in the picture's line py the vessel begins and ends, around the axis at px. */
void level_section_range(const level_section *c, double px, double py, double range[2]);

/* Does the ray stay between the two heights up to the rod's far side? */
bool level_section_stays(const level_section *c, double px, double py, double low, double high);
