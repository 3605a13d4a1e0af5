/* Derives the range and step of a parameter's slider from its range, default and value (params.h). */
#include "base/number.h"
#include "scene/model/params.h"

#include <math.h>
#include <string.h>

/* The largest magnitude of a value's numbers, and its least number; a word for an automatic value has none. */
typedef struct extent {
    double size, least;
} extent;

static extent extent_of(const char *text)
{
    static const char between[] = ",[] ";
    extent e = {0, INFINITY};
    for (const char *at = text ? text + strspn(text, between) : ""; *at; at += strspn(at, between)) {
        char one[NUMBER_TEXT_MAX] = "";
        double x;
        const size_t length = strcspn(at, between);
        if (length < sizeof one && number_parse_real(memcpy(one, at, length), &x))
            e = (extent){fmax(e.size, fabs(x)), fmin(e.least, x)};
        at += length;
    }
    return e;
}

/* The power of ten at or below x > 0, correctly rounded for the sizes that parameters have. */
static double decade_below(double x)
{
    double up = 1, down = 1;
    while (10 * up <= x)
        up *= 10;
    while (1 / down > x)
        down *= 10;
    return up / down;
}

static double nice_above(double x)
{
    static const double nice[] = {1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
    const double power = decade_below(x);
    size_t i = 0;
    while (i + 1 < sizeof nice / sizeof *nice && nice[i] * power < x * (1 - 1e-12))
        i++;
    return nice[i] * power;
}

static double step_of(const param *row, double span)
{
    const double steps = 400; /* minimum number of steps, except for integers */
    return row->type == PARAM_INT ? 1 : decade_below(span / steps);
}

/* A slider from 0 over five decades, for values of unknown size. */
static param_slider from_zero(const param *row, double highest)
{
    const bool integer = row->type == PARAM_INT;
    return (param_slider){0, highest, integer ? 1 : 0, integer ? 1 : 1e-5 * highest};
}

/* The least value of a slider that begins at the lower bound; if the bound is excluded, one step above it, or the least
 * given value if that is nearer. */
static double lowest_of(const param *row, double step, extent all)
{
    return row->above_lowest ? row->lowest + fmin(step, all.least - row->lowest) : row->lowest;
}

/* The declared slider, widened until it contains the values. */
static param_slider declared(const param *row, extent all)
{
    param_slider s = row->slider;
    if (all.size > s.highest) {
        s.highest = fmin(row->highest, nice_above(2 * all.size));
        s.lowest = s.lowest < 0 ? -s.highest : s.lowest;
        s.log_from = s.log_from > 0 ? 1e-5 * s.highest : 0;
    }
    if (s.lowest >= 0 && all.least < s.lowest)
        s.lowest = row->lowest >= 0 ? lowest_of(row, s.step, all) : all.least < 0 ? -s.highest : all.least;
    return s;
}

static param_slider decades(const param *row, double usual, double size)
{
    const double low = fmax(row->lowest, fmin(usual, size) / 100), high = fmin(row->highest, 100 * fmax(usual, size));
    return (param_slider){low, high, row->type == PARAM_INT ? 1 : 0, low};
}

static param_slider linear(const param *row, double low, double high, extent all)
{
    const double step = step_of(row, high - low);
    return (param_slider){low <= row->lowest ? lowest_of(row, step, all) : low, high, step, 0};
}

bool param_has_slider(const param *row)
{
    return row->type == PARAM_INT || row->type == PARAM_REAL || row->type == PARAM_VECTOR || row->type == PARAM_COLOR;
}

param_slider param_slider_of(const param *row, const char *initial, const char *value)
{
    const double wide = 1000, room = 2.5;
    const extent usual = extent_of(row->fallback), first = extent_of(initial), now = extent_of(value);
    const extent all = {fmax(first.size, now.size), fmin(first.least, now.least)};
    if (row->slider.lowest < row->slider.highest)
        return declared(row, all);
    if (row->slider.log_from > 0)
        return decades(row, usual.size, now.size);
    if (row->highest - row->lowest <= wide)
        return linear(row, row->lowest, row->highest, all);
    const double size = fmax(usual.size, all.size);
    if (row->lowest == 0 && size == 0)
        return from_zero(row, fmin(row->highest, 100));
    const double least = row->type == PARAM_INT ? 16 : 1e-3,
                 high = fmin(row->highest, nice_above(fmax(room * size, least)));
    return linear(row, fmax(row->lowest, row->lowest < 0 ? -high : 0), high, all);
}
