/* The order of a photon map: along Morton's curve, finest where most photons are. */
#include "base/cancel.h"
#include "render/photons/photon_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct photon_key {
    uint64_t code;
    const photon *source;
} photon_key;

/* The 21 bits of x at every third place (Morton, "A computer oriented geodetic data base", IBM, 1966). */
static uint64_t apart(uint64_t x)
{
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/* The region of most photons, since a few may be very far away. It does not depend on the photons' order. */
typedef struct middle {
    double centre[3], spread;
} middle;

/* The k-th smallest of n values, which are reordered (Hoare, "Algorithm 65: Find", CACM 4(7), 1961). */
static double find(double *value, size_t n, size_t k)
{
    size_t low = 0, high = n - 1;
    while (low < high) {
        const double pivot = value[low + (high - low) / 2];
        size_t i = low, j = high + 1;
        for (;; i++) {
            while (value[i] < pivot)
                i++;
            while (value[--j] > pivot)
                ;
            if (i >= j)
                break;
            const double swapped = value[i];
            value[i] = value[j], value[j] = swapped;
        }
        if (k <= j)
            high = j;
        else
            low = j + 1;
    }
    return value[k];
}

static double component(vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Medians of the coordinates, and of the distances from them. */
static middle middle_of(const photon_list *lists, size_t count, double *values, size_t n)
{
    middle m = {{0.0, 0.0, 0.0}, 1.0};
    for (int axis = 0; axis < 3; axis++) {
        size_t at = 0;
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < lists[i].count; k++)
                values[at++] = component(lists[i].list[k].position, axis);
        m.centre[axis] = find(values, n, n / 2);
    }
    size_t at = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < lists[i].count; k++, at++) {
            values[at] = 0.0;
            for (int axis = 0; axis < 3; axis++)
                values[at] = fmax(values[at], fabs(component(lists[i].list[k].position, axis) - m.centre[axis]));
        }
    const double spread = find(values, n, n / 2);
    m.spread = spread > 0.0 ? spread : 1.0;
    return m;
}

/* A coordinate in 0 .. 2^21 - 1, finest at the middle: t / (1 + |t|). */
static uint64_t cell(double x, double centre, double spread)
{
    const double t = (x - centre) / spread, c = 0.5 + 0.5 * t / (1.0 + fabs(t));
    return (uint64_t)(c * 2097151.0);
}

static uint64_t code_of(vec3 at, const middle *m)
{
    return apart(cell(at.x, m->centre[0], m->spread)) | apart(cell(at.y, m->centre[1], m->spread)) << 1 |
           apart(cell(at.z, m->centre[2], m->spread)) << 2;
}

static int sign(double a, double b)
{
    return (a > b) - (a < b);
}

/* A total order by values, not by bytes in memory: photons that compare equal are identical. */
static int compare(const void *a, const void *b)
{
    const photon_key *x = a, *y = b;
    if (x->code != y->code)
        return x->code < y->code ? -1 : 1;
    int order = 0;
    for (int i = 0; i < 3 && order == 0; i++)
        order = sign(component(x->source->position, i), component(y->source->position, i));
    for (int i = 0; i < 3 && order == 0; i++)
        order = sign((double)x->source->flux[i], (double)y->source->flux[i]);
    for (int i = 0; i < 3 && order == 0; i++)
        order = sign((double)x->source->normal[i], (double)y->source->normal[i]);
    order = order ? order : sign((double)x->source->radius, (double)y->source->radius);
    return order ? order : sign(x->source->wavelength, y->source->wavelength);
}

size_t photon_lists_total(const photon_list *lists, size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += lists[i].count;
    return sum;
}

/* --- sorting, by parts between which it can be cancelled --- */

enum { PARTS = 1 << 12, PART_SHIFT = 63 - 12 };

/* Keys in the order of their first 12 bits; end[i]: where part i ends. False when cancelled. */
static bool divide(const photon_list *lists, size_t count, const middle *m, photon_key *keys, size_t *end)
{
    memset(end, 0, PARTS * sizeof *end);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < lists[i].count; k++) {
            if (cancel_asked_at(k))
                return false;
            end[code_of(lists[i].list[k].position, m) >> PART_SHIFT]++;
        }
    for (size_t i = 0, sum = 0; i < PARTS; i++) { /* first the beginning of each part */
        const size_t begin = sum;
        sum += end[i];
        end[i] = begin;
    }
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < lists[i].count; k++) {
            if (cancel_asked_at(k))
                return false;
            const uint64_t code = code_of(lists[i].list[k].position, m);
            keys[end[code >> PART_SHIFT]++] = (photon_key){code, &lists[i].list[k]};
        }
    return true;
}

bool photon_order(const photon_list *lists, size_t count, photon *out)
{
    const size_t n = photon_lists_total(lists, count);
    if (n == 0)
        return true;
    photon_key *keys = malloc(n * sizeof *keys);
    size_t *end = malloc(PARTS * sizeof *end);
    bool done = keys && end;
    if (done) {
        const middle m = middle_of(lists, count, (double *)(void *)keys, n);
        done = divide(lists, count, &m, keys, end);
    }
    for (size_t i = 0, begin = 0; done && i < PARTS; begin = end[i++]) {
        qsort(keys + begin, end[i] - begin, sizeof *keys, compare);
        done = !cancel_asked();
    }
    for (size_t i = 0; done && i < n; i++) {
        out[i] = *keys[i].source;
        done = !cancel_asked_at(i);
    }
    free(end);
    free(keys);
    return done;
}
