/* Draws small studies from measured values, without replacement, and counts what each rule claims about them. */
#include "measure/design.h"

#include "base/random.h"
#include "measure/statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVAL_VALUES = 6, RATIO_PROCESSES = 3 }; /* FEWEST_VALUES and FEWEST_PROCESSES of study/summary/contrast.c */

const char *design_rule_text(design_rule rule)
{
    static const char *const texts[] = {"sign", "effect", "t", "medians", "processes", "ratio"};
    return texts[rule];
}

const char *design_order_text(design_order order)
{
    static const char *const texts[] = {"apart", "turns", "together"};
    return texts[order];
}

bool design_has_rule(const design *d, design_rule rule)
{
    const size_t values = d->processes * d->repetitions;
    if (rule == DESIGN_T)
        return values >= 2;
    if (rule == DESIGN_RATIO)
        return values >= INTERVAL_VALUES && d->processes >= RATIO_PROCESSES;
    return rule == DESIGN_SIGN || rule == DESIGN_EFFECT || values >= INTERVAL_VALUES;
}

/* --- rules --- */

static status summarize_all(const level_sample *s, summary *out, diagnostic *why)
{
    const size_t count = s->start[s->processes];
    double *copy = malloc((count + 1) * sizeof *copy);
    if (!copy)
        return out_of_memory(why);
    memcpy(copy, s->values, count * sizeof *copy);
    *out = summarize(copy, count);
    free(copy);
    return STATUS_OK;
}

/* The two-sample t test with the pooled variance (Student, Biometrika 6, 1908). */
static int t_claim(const summary *a, const summary *b)
{
    if (a->count < 2 || b->count < 2)
        return 0;
    const double na = (double)a->count, nb = (double)b->count, difference = b->mean - a->mean;
    const double squares = (na - 1) * a->deviation * a->deviation + (nb - 1) * b->deviation * b->deviation;
    const double error = sqrt(squares / (na + nb - 2) * (1 / na + 1 / nb));
    if (!(fabs(difference) > student_t_975(a->count + b->count - 2) * error))
        return 0;
    return difference > 0 ? 1 : -1;
}

/* Comparisons with NaN are false: no interval, no claim. */
static int disjoint(double a_low, double a_high, double b_low, double b_high)
{
    return a_high < b_low ? 1 : b_high < a_low ? -1 : 0;
}

static status ratio_claim(const level_sample *a, const level_sample *b, bool paired, uint64_t seed, int *claim,
                          diagnostic *why)
{
    level_interval difference;
    if (a->processes < RATIO_PROCESSES || b->processes < RATIO_PROCESSES)
        return STATUS_OK;
    TRY(level_bootstrap(a, b, paired, level_difference, NULL, seed, &difference, why));
    *claim = difference.low > 0 ? 1 : difference.high < 0 ? -1 : 0;
    return STATUS_OK;
}

static status processes_claim(const level_sample *a, const level_sample *b, uint64_t seed, int *claim, diagnostic *why)
{
    level_interval ia, ib;
    TRY(level_median(a, LEVEL_REAL, seed, &ia, why));
    TRY(level_median(b, LEVEL_REAL, seed, &ib, why));
    *claim = disjoint(ia.low, ia.high, ib.low, ib.high);
    return STATUS_OK;
}

status design_claim(design_rule rule, const level_sample *a, const level_sample *b, bool paired, double effect,
                    uint64_t seed, int *claim, diagnostic *why)
{
    *claim = 0;
    if (rule == DESIGN_RATIO)
        return ratio_claim(a, b, paired, seed, claim, why);
    if (rule == DESIGN_PROCESSES)
        return processes_claim(a, b, seed, claim, why);
    summary sa, sb;
    TRY(summarize_all(a, &sa, why));
    TRY(summarize_all(b, &sb, why));
    const double difference = sb.median - sa.median, least = rule == DESIGN_EFFECT ? log1p(effect) : 0;
    if (rule == DESIGN_T)
        *claim = t_claim(&sa, &sb);
    else if (rule == DESIGN_MEDIANS)
        *claim = disjoint(sa.median_low, sa.median_high, sb.median_low, sb.median_high);
    else
        *claim = difference > least ? 1 : difference < -least ? -1 : 0;
    return STATUS_OK;
}

/* --- draws --- */

/* One side of the studies: the processes that have enough repetitions, and the values of the study drawn last. */
typedef struct side {
    const level_sample *population;
    size_t *eligible, count;
    double *values;
    size_t *start;
    level_sample drawn;
} side;

static size_t count_of(const level_sample *s, size_t process)
{
    return s->start[process + 1] - s->start[process];
}

static void side_free(side *s)
{
    free(s->eligible);
    free(s->values);
    free(s->start);
}

/* other: a sample that must also have enough repetitions in the same process, or NULL. */
static bool side_create(const level_sample *population, const level_sample *other, const design *d, side *out)
{
    *out = (side){.population = population,
                  .eligible = calloc(population->processes + 1, sizeof *out->eligible),
                  .values = calloc(d->processes * d->repetitions + 1, sizeof *out->values),
                  .start = calloc(d->processes + 1, sizeof *out->start)};
    if (!out->eligible || !out->values || !out->start)
        return false;
    for (size_t p = 0; p < population->processes; p++)
        if (count_of(population, p) >= d->repetitions && (!other || count_of(other, p) >= d->repetitions))
            out->eligible[out->count++] = p;
    for (size_t p = 0; p <= d->processes; p++)
        out->start[p] = p * d->repetitions;
    out->drawn = (level_sample){out->values, out->start, d->processes};
    return true;
}

/* The counters of the random numbers for one choice of one study. */
typedef struct stream {
    uint64_t seed;
    uint32_t draw, purpose;
} stream;

static size_t below(const stream *s, uint32_t index, size_t count)
{
    const double unit = random_unit(random_at(s->seed, s->draw, s->purpose, index, 0).word[0]);
    return (size_t)(unit * (double)count);
}

/* The first wanted elements become a random choice: Durstenfeld, Algorithm 235, 1964. */
static void choose(const stream *s, size_t *list, size_t count, size_t wanted)
{
    for (size_t i = 0; i < wanted; i++) {
        const size_t other = i + below(s, (uint32_t)i, count - i), kept = list[i];
        list[i] = list[other];
        list[other] = kept;
    }
}

/* Copies successive repetitions of a process, from a random one on. */
static void draw_block(const stream *first, side *s, const design *d, size_t k, size_t process)
{
    const size_t spare = count_of(s->population, process) - d->repetitions;
    const size_t from = s->population->start[process] + below(first, (uint32_t)k, spare + 1);
    memcpy(s->values + s->start[k], s->population->values + from, d->repetitions * sizeof *s->values);
}

enum { CHOICE_A, CHOICE_B, BLOCK_A, BLOCK_B, SWAP };

static void draw_apart(const design *d, bool shared, uint64_t seed, uint32_t draw, side *a, side *b, size_t *list)
{
    stream choice = {seed, draw, CHOICE_A}, block_a = {seed, draw, BLOCK_A}, block_b = {seed, draw, BLOCK_B};
    memcpy(list, a->eligible, a->count * sizeof *list);
    choose(&choice, list, a->count, shared ? 2 * d->processes : d->processes);
    for (size_t k = 0; k < d->processes; k++)
        draw_block(&block_a, a, d, k, list[k]);
    if (!shared) {
        choice.purpose = CHOICE_B;
        memcpy(list, b->eligible, b->count * sizeof *list);
        choose(&choice, list, b->count, d->processes);
    }
    for (size_t k = 0; k < d->processes; k++)
        draw_block(&block_b, b, d, k, list[shared ? d->processes + k : k]);
}

static void draw_in_turn(const design *d, uint64_t seed, uint32_t draw, side *a, side *b, size_t *list)
{
    stream choice = {seed, draw, CHOICE_A}, swap = {seed, draw, SWAP};
    stream block_a = {seed, draw, BLOCK_A}, block_b = {seed, draw, BLOCK_B};
    const bool together = d->order == DESIGN_TOGETHER;
    const size_t groups = together ? a->count : a->count / 2;
    for (size_t i = 0; i < groups; i++)
        list[i] = i;
    choose(&choice, list, groups, d->processes);
    for (size_t k = 0; k < d->processes; k++) {
        const size_t first = together ? 0 : below(&swap, (uint32_t)k, 2);
        draw_block(&block_a, a, d, k, a->eligible[together ? list[k] : 2 * list[k] + first]);
        draw_block(together ? &block_a : &block_b, b, d, k, a->eligible[together ? list[k] : 2 * list[k] + 1 - first]);
    }
}

static size_t independent_studies(const design_population *population, const design *d, const side *a, const side *b)
{
    const size_t fewer = a->count < b->count ? a->count : b->count;
    if (!population->shared)
        return d->order == DESIGN_APART ? fewer / d->processes : 0;
    if (d->order == DESIGN_TOGETHER)
        return population->a == population->b ? 0 : a->count / d->processes;
    return a->count / 2 / d->processes;
}

static status judge(const design *d, unsigned rules, double effect, uint64_t seed, const side *a, const side *b,
                    design_tally *out, diagnostic *why)
{
    for (int rule = 0; rule < DESIGN_RULES; rule++) {
        int claim = 0;
        if (!(rules >> rule & 1) || !design_has_rule(d, (design_rule)rule))
            continue;
        TRY(design_claim((design_rule)rule, &a->drawn, &b->drawn, d->order != DESIGN_APART, effect, seed, &claim, why));
        out->larger[rule] += claim > 0;
        out->smaller[rule] += claim < 0;
    }
    return STATUS_OK;
}

status design_try(const design_population *population, const design *d, unsigned rules, size_t draws, double effect,
                  uint64_t seed, design_tally *out, diagnostic *why)
{
    *out = (design_tally){.draws = 0};
    side a = {.population = NULL}, b = {.population = NULL};
    size_t *list = calloc(population->a->processes + population->b->processes + 1, sizeof *list);
    const bool has_a = side_create(population->a, population->shared ? population->b : NULL, d, &a);
    const bool has_b = side_create(population->b, population->shared ? population->a : NULL, d, &b);
    status code = list && has_a && has_b ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK)
        out->independent = independent_studies(population, d, &a, &b);
    for (uint32_t draw = 0; code == STATUS_OK && out->independent > 0 && draw < draws; draw++) {
        if (d->order == DESIGN_APART)
            draw_apart(d, population->shared, seed, draw, &a, &b, list);
        else
            draw_in_turn(d, seed, draw, &a, &b, list);
        code = judge(d, rules, effect, seed + draw, &a, &b, out, why);
        out->draws++;
    }
    side_free(&a);
    side_free(&b);
    free(list);
    return code;
}
