/* Theory of the rod in the image: whether the camera ray through a point of the image hits the rod behind the wall of a
 * filled vessel. Vertical surfaces preserve n d_y of a ray, d_y the vertical component of its unit direction. Seen from
 * above, a ray therefore refracts at the circles like a ray in the plane with the indices sqrt(n^2 - (n d_y)^2):
 * Snell's law without the component along y. Exact. Pure; scalars only. */
#pragma once

#include "realism/setup.h"
#include "realism/view.h"

typedef struct level_section {
    view eye;
    theory_shells shells;
    double x, z;                     /* of the axis */
    double corner_x[4], corner_z[4]; /* of the rod, relative to the axis */
} level_section;

/* NULL, or the reason why theory does not apply to this scene. */
const char *level_section_read(const scene *s, const setup *at, level_section *out);

/* The same without vessel and liquid. */
level_section level_section_bare(const level_section *c);

bool level_section_sees_rod(const level_section *c, double px, double py);

/* Of an edge seen at px: change of the distance of the ray from the rod's corner there, scene units per px. */
double level_section_slope(const level_section *c, double px, double py);

/* The horizontal bounds of the vessel in image line py, around the axis at px. */
void level_section_range(const level_section *c, double px, double py, double range[2]);

/* Whether the ray stays between the two heights up to the rod's far side. */
bool level_section_stays(const level_section *c, double px, double py, double low, double high);
