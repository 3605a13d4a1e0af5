/* Groups: photons that are close together in a sample's cell of the image are seen as one, so that a cell with
 * thousands costs much less (lightcuts do so for lamps: Walter and others, SIGGRAPH 2005). A group has the flux, centre
 * and variance of its photons. A disc of radius r has the variance r^2 / 8 in each direction, and a photon a distance d
 * from the centre adds d^2 / 2. */
#include "render/caustics/photon_tree.h"

#include "base/cancel.h"
#include <stdlib.h>

/* The least cosine between normals of a group. */
#define FLAT 0.98

static double power_of(const photon *one)
{
    return (double)one->flux[0] + (double)one->flux[1] + (double)one->flux[2];
}

static bool are_a_group(const photon_group *list, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (!(list[k].one.radius > 0.0F) || list[k].one.wavelength != list->one.wavelength ||
            photon_cosine(&list[k].one, &list->one) < FLAT)
            return false;
    return true;
}

static photon_group joined(const photon_group *list, size_t count)
{
    photon_group sum = list[0];
    double flux[3] = {0.0, 0.0, 0.0}, all = 0.0, disc2 = 0.0, spread2 = 0.0;
    vec3 off = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < count; k++) {
        const photon *one = &list[k].one;
        const double power = power_of(one);
        const vec3 from_first = vec3_sub(one->position, list->one.position);
        all += power, disc2 += power * (double)list[k].disc2;
        off = vec3_add(off, vec3_scale(from_first, power));
        spread2 += power * ((double)list[k].spread2 + vec3_dot(from_first, from_first));
        for (int c = 0; c < 3; c++)
            flux[c] += (double)one->flux[c];
    }
    sum.one.radius = 0.0F;
    if (!(all > 0.0) || !are_a_group(list, count))
        return sum;
    off = vec3_scale(off, 1.0 / all);
    sum.one.position = vec3_add(list->one.position, off);
    sum.disc2 = (float)(disc2 / all);
    sum.spread2 = (float)fmax(spread2 / all - vec3_dot(off, off), 0.0);
    sum.one.radius = sqrtf(sum.disc2 + 4.0F * sum.spread2);
    for (int c = 0; c < 3; c++)
        sum.one.flux[c] = (float)flux[c];
    return sum;
}

static photon_group group_of(const photon_map *m, int level, size_t box)
{
    photon_group children[PHOTON_WIDE] = {{{{0.0, 0.0, 0.0}, {0.0F}, {0.0F}, 0.0F, 0}, 0.0F, 0.0F}};
    const size_t first = photon_box_first(box), count = photon_box_end(m, level, box) - first;
    for (size_t k = 0; k < count; k++) {
        const photon *one = &m->photons[level > 0 ? 0 : first + k];
        children[k] =
            level > 0 ? m->group[level - 1][first + k] : (photon_group){*one, one->radius * one->radius, 0.0F};
    }
    return joined(children, count);
}

bool photon_groups_make(photon_map *m)
{
    for (int k = 0; k < m->levels; k++) {
        if (!(m->group[k] = calloc(m->boxes[k], sizeof(photon_group))))
            return false;
        for (size_t b = 0; b < m->boxes[k]; b++) {
            if (cancel_asked_at(b))
                return false;
            m->group[k][b] = group_of(m, k, b);
        }
    }
    return true;
}
