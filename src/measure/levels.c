/* The hierarchical bootstrap of repetitions within processes, and intervals of medians; levels.h names the sources. */
#include "measure/levels.h"

#include "base/random.h"
#include "measure/statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t count_of(const level_sample *s, size_t process)
{
    return s->start[process + 1] - s->start[process];
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts in place. */
static double median_of(double *values, size_t count)
{
    qsort(values, count, sizeof *values, by_value);
    return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

double level_centre(const level_sample *s)
{
    enum { STACK = 512 };
    double sum = 0, room[STACK];
    for (size_t p = 0; p < s->processes; p++) {
        const size_t count = count_of(s, p);
        double *copy = count > STACK ? malloc(count * sizeof *copy) : room;
        if (!copy)
            return NAN;
        memcpy(copy, s->values + s->start[p], count * sizeof *copy);
        sum += median_of(copy, count);
        if (copy != room)
            free(copy);
    }
    return sum / (double)s->processes;
}

double level_difference(const level_sample *a, const level_sample *b, void *unused)
{
    (void)unused;
    return level_centre(b) - level_centre(a);
}

/* --- bootstrap --- */

/* 2000 resamples place the ends of a 95% interval within about half a percent of probability. */
enum { RESAMPLES = LEVEL_RESAMPLES, PERCENTILES_LEAST = 10 };

/* A resample; its array of values is large enough even if the longest process is drawn every time. */
typedef struct resample {
    const level_sample *original;
    double *values;
    size_t *start;
    level_sample drawn;
} resample;

static size_t longest(const level_sample *s)
{
    size_t most = 0;
    for (size_t p = 0; p < s->processes; p++)
        most = count_of(s, p) > most ? count_of(s, p) : most;
    return most;
}

static bool resample_create(const level_sample *original, resample *out)
{
    *out = (resample){.original = original};
    if (!original)
        return true;
    out->values = malloc((longest(original) * original->processes + 1) * sizeof *out->values);
    out->start = calloc(original->processes + 1, sizeof *out->start);
    out->drawn = (level_sample){out->values, out->start, original->processes};
    return out->values && out->start;
}

/* A random index below count; the other arguments are the key and the counter. */
static size_t draw(uint64_t seed, uint32_t round, uint32_t which, uint32_t process, uint32_t index, size_t count)
{
    const double unit = random_unit(random_at(seed, round, which, process, index).word[0]);
    return (size_t)(unit * (double)count);
}

static void draw_repetitions(resample *r, uint64_t seed, uint32_t round, uint32_t stream)
{
    const size_t count = count_of(r->original, 0);
    for (size_t i = 0; i < count; i++)
        r->values[i] = r->original->values[r->original->start[0] + draw(seed, round, stream, 0, (uint32_t)i, count)];
    r->start[1] = count;
}

/* Draws processes with all of their repetitions, or the repetitions of a single process. stream: equal for paired
 * samples. */
static void resample_draw(resample *r, uint64_t seed, uint32_t round, uint32_t stream)
{
    const level_sample *s = r->original;
    if (s->processes == 1) {
        draw_repetitions(r, seed, round, stream);
        return;
    }
    size_t at = 0;
    for (size_t p = 0; p < s->processes; p++) {
        const size_t from = draw(seed, round, stream, (uint32_t)p, 0, s->processes), count = count_of(s, from);
        memcpy(r->values + at, s->values + s->start[from], count * sizeof *r->values);
        r->start[p] = at;
        at += count;
    }
    r->start[s->processes] = at;
}

/* The quantile by linear interpolation between sorted values. */
static double quantile(const double *sorted, size_t count, double fraction)
{
    const double at = fmin(fmax(fraction, 0.0), 1.0) * (double)(count - 1);
    const size_t below = (size_t)at < count - 1 ? (size_t)at : count - 2;
    return sorted[below] + (at - (double)below) * (sorted[below + 1] - sorted[below]);
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* The number of independent draws of the smaller sample. */
static size_t draws_of(const level_sample *a, const level_sample *b)
{
    const size_t first = a->processes > 1 ? a->processes : count_of(a, 0);
    return b ? smaller(first, b->processes > 1 ? b->processes : count_of(b, 0)) : first;
}

static bool has_interval(const level_sample *a, const level_sample *b)
{
    const size_t values = b ? smaller(a->start[a->processes], b->start[b->processes]) : a->start[a->processes];
    const size_t processes = b ? smaller(a->processes, b->processes) : a->processes;
    return values >= 6 && processes != 2;
}

/* Resamples of few processes never leave the range of their values, which is too narrow an interval: three values of
 * one sign are no evidence. So the interval is Student's t with the bootstrap's standard error. */
static void set_symmetric(const double *values, double t, level_interval *out)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < RESAMPLES; i++)
        sum += values[i] - out->value;
    const double bias = sum / RESAMPLES;
    for (size_t i = 0; i < RESAMPLES; i++)
        squares += (values[i] - out->value - bias) * (values[i] - out->value - bias);
    const double half = t * sqrt(squares / (RESAMPLES - 1));
    out->low = out->value - half;
    out->high = out->value + half;
}

void level_set_interval(double *values, size_t draws, level_interval *out)
{
    const double n = (double)draws;
    const double z = student_quantile(0.975, n - 1) * sqrt(n / (n - 1)), tail = normal_below(-z);
    if (draws < PERCENTILES_LEAST) {
        set_symmetric(values, z, out);
        return;
    }
    qsort(values, RESAMPLES, sizeof *values, by_value);
    out->low = quantile(values, RESAMPLES, tail);
    out->high = quantile(values, RESAMPLES, 1.0 - tail);
}

status level_bootstrap(const level_sample *a, const level_sample *b, bool paired, level_statistic *statistic,
                       void *context, uint64_t seed, level_interval *out, diagnostic *why)
{
    *out = (level_interval){statistic(a, b, context), NAN, NAN};
    if (!has_interval(a, b))
        return STATUS_OK;
    resample first, second;
    double *values = malloc(RESAMPLES * sizeof *values);
    const bool has_first = resample_create(a, &first), has_second = resample_create(b, &second);
    const bool has_memory = has_first && has_second;
    for (uint32_t round = 0; values && has_memory && round < RESAMPLES; round++) {
        resample_draw(&first, seed, round, 0);
        if (b)
            resample_draw(&second, seed, round, paired && a->processes > 1 ? 0 : 1);
        values[round] = statistic(&first.drawn, b ? &second.drawn : NULL, context);
    }
    if (values && has_memory)
        level_set_interval(values, draws_of(a, b), out);
    free(values);
    free(first.values);
    free(first.start);
    free(second.values);
    free(second.start);
    return values && has_memory ? STATUS_OK : out_of_memory(why);
}

size_t level_draw(uint64_t seed, uint32_t round, uint32_t stream, uint32_t process, size_t count)
{
    return draw(seed, round, stream, process, 0, count);
}

/* --- median --- */

typedef struct labelled {
    double value;
    size_t process;
} labelled;

static int by_labelled_value(const void *a, const void *b)
{
    const labelled *x = a, *y = b;
    return (x->value > y->value) - (x->value < y->value);
}

/* The median of sorted values, each repeated as often as its process was drawn; total: the number with repeats. */
static double weighted_median(const labelled *sorted, const size_t *drawn, size_t total)
{
    size_t seen = 0, i = 0;
    for (; (seen += drawn[sorted[i].process]) < (total + 1) / 2; i++) {
    }
    const double lower = sorted[i].value;
    if (total % 2 == 1 || seen > total / 2)
        return lower;
    do
        i++;
    while (drawn[sorted[i].process] == 0);
    return 0.5 * (lower + sorted[i].value);
}

static void resample_medians(const level_sample *s, const labelled *sorted, uint64_t seed, size_t *drawn, double *out)
{
    for (uint32_t round = 0; round < RESAMPLES; round++) {
        size_t total = 0;
        memset(drawn, 0, s->processes * sizeof *drawn);
        for (size_t p = 0; p < s->processes; p++) {
            const size_t from = draw(seed, round, 0, (uint32_t)p, 0, s->processes);
            drawn[from]++;
            total += count_of(s, from);
        }
        out[round] = weighted_median(sorted, drawn, total);
    }
}

static status median_of_all(const level_sample *s, size_t count, level_interval *out, diagnostic *why)
{
    double *copy = malloc((count + 1) * sizeof *copy);
    if (!copy)
        return out_of_memory(why);
    memcpy(copy, s->values, count * sizeof *copy);
    const summary all = summarize(copy, count);
    *out = (level_interval){all.median, all.median_low, all.median_high};
    free(copy);
    return STATUS_OK;
}

/* The claimed range, or a wider one if a value is outside it. */
static level_range range_of(const level_sample *s, level_range claimed)
{
    double least = INFINITY, largest = -INFINITY;
    for (size_t i = 0; i < s->start[s->processes]; i++) {
        least = fmin(least, s->values[i]);
        largest = fmax(largest, s->values[i]);
    }
    if (claimed == LEVEL_REAL || least < 0)
        return LEVEL_REAL;
    if (claimed == LEVEL_POSITIVE && least > 0)
        return LEVEL_POSITIVE;
    return claimed == LEVEL_FRACTION && largest <= 1 ? LEVEL_FRACTION : LEVEL_NOT_NEGATIVE;
}

static void set_interval_within(level_range range, double *values, size_t draws, level_interval *out)
{
    if (range == LEVEL_POSITIVE && draws < PERCENTILES_LEAST) {
        level_interval logarithm = {log(out->value), NAN, NAN};
        for (size_t i = 0; i < RESAMPLES; i++)
            values[i] = log(values[i]);
        level_set_interval(values, draws, &logarithm);
        out->low = exp(logarithm.low);
        out->high = exp(logarithm.high);
        return;
    }
    level_set_interval(values, draws, out);
    if (range != LEVEL_REAL)
        out->low = fmax(out->low, 0);
    if (range == LEVEL_FRACTION)
        out->high = fmin(out->high, 1);
}

status level_median(const level_sample *s, level_range range, uint64_t seed, level_interval *out, diagnostic *why)
{
    const size_t count = s->processes ? s->start[s->processes] : 0;
    *out = (level_interval){NAN, NAN, NAN};
    if (count == 0)
        return STATUS_OK;
    TRY(median_of_all(s, count, out, why));
    if (s->processes < 3 || count < 6)
        return STATUS_OK;
    labelled *sorted = malloc(count * sizeof *sorted);
    size_t *drawn = malloc(s->processes * sizeof *drawn);
    double *medians = malloc(RESAMPLES * sizeof *medians);
    const bool has_memory = sorted && drawn && medians;
    if (has_memory) {
        for (size_t p = 0; p < s->processes; p++)
            for (size_t i = s->start[p]; i < s->start[p + 1]; i++)
                sorted[i] = (labelled){s->values[i], p};
        qsort(sorted, count, sizeof *sorted, by_labelled_value);
        resample_medians(s, sorted, seed, drawn, medians);
        set_interval_within(range_of(s, range), medians, s->processes, out);
    }
    free(medians);
    free(drawn);
    free(sorted);
    return has_memory ? STATUS_OK : out_of_memory(why);
}
