#include "study/power_rates.h"
#include <math.h>
#include <stdlib.h>

typedef struct pair {
    const value_cell *a, *b;
    bool shared;
} pair;

static status find(const value_table *t, const char *name, const value_cell **out, diagnostic *why)
{
    *out = value_table_find(t, name);
    return *out ? STATUS_OK
                : diagnose(why, STATUS_BAD_INPUT, "give names in its column cell, such as 0,1",
                           "the rows have no cell '%.64s'", name);
}

static status ratio_of(const pair *p, uint64_t seed, level_interval *out, diagnostic *why)
{
    const level_sample *a = &p->a->sample, *b = &p->b->sample;
    TRY(level_bootstrap(a, b, p->shared, level_difference, NULL, seed, out, why));
    *out = (level_interval){exp(out->value), exp(out->low), exp(out->high)};
    return STATUS_OK;
}

static int truth_of(const power_options *o, const level_interval *ratio)
{
    if (o->truth == POWER_LARGER || o->truth == POWER_SMALLER)
        return o->truth == POWER_LARGER ? 1 : -1;
    if (o->truth == POWER_SAME || !o->a)
        return 0;
    return ratio->value > 1 ? 1 : ratio->value < 1 ? -1 : 0;
}

/* Together is possible only for two cells of the same processes. */
static status try_pair(const pair *p, const power_options *o, power_rates *out, diagnostic *why)
{
    level_interval ratio = {1, 1, 1};
    if (p->a != p->b)
        TRY(ratio_of(p, o->seed, &ratio, why));
    const design_population of = {&p->a->sample, &p->b->sample, p->shared};
    for (int order = 0; order < DESIGN_ORDERS; order++)
        for (size_t i = 0; i < o->design_count; i++) {
            power_rate rate = {.a = p->a->name, .b = p->b->name, .of = o->designs[i], .ratio = ratio};
            rate.of.order = (design_order)order;
            rate.truth = truth_of(o, &ratio);
            TRY(design_try(&of, &rate.of, ~0u, o->draws, o->effect, o->seed, &rate.tally, why));
            if (rate.tally.draws)
                out->rates[out->count++] = rate;
        }
    return STATUS_OK;
}

static bool same_design(const design *a, const design *b)
{
    return a->order == b->order && a->processes == b->processes && a->repetitions == b->repetitions;
}

/* The sums over all pairs, after their rates. Cells of one process are disturbed together: their studies are not more
 * independent ones than those of one cell. */
static void add_sums(power_rates *r)
{
    const size_t pairs = r->count;
    for (size_t i = 0; i < pairs; i++) {
        power_rate *sum = &r->rates[pairs];
        while (sum < &r->rates[r->count] && !same_design(&sum->of, &r->rates[i].of))
            sum++;
        if (sum == &r->rates[r->count]) {
            r->count++;
            *sum = (power_rate){.of = r->rates[i].of, .ratio = {NAN, NAN, NAN}};
        }
        const design_tally *from = &r->rates[i].tally;
        sum->tally.draws += from->draws;
        if (from->independent > sum->tally.independent)
            sum->tally.independent = from->independent;
        for (int rule = 0; rule < DESIGN_RULES; rule++) {
            sum->tally.larger[rule] += from->larger[rule];
            sum->tally.smaller[rule] += from->smaller[rule];
        }
    }
}

static status try_all(const value_table *first, const value_table *other, const power_options *o, power_rates *out,
                      diagnostic *why)
{
    if (o->a) {
        pair p = {.shared = false};
        TRY(find(first, o->a, &p.a, why));
        TRY(find(other, o->b, &p.b, why));
        p.shared = first == other && value_cells_share(p.a, p.b);
        return try_pair(&p, o, out, why);
    }
    for (size_t i = 0; i < first->count; i++) {
        const value_cell *b = value_table_find(other, first->cells[i].name);
        const pair p = {&first->cells[i], b, first == other};
        if (b)
            TRY(try_pair(&p, o, out, why));
    }
    add_sums(out);
    return STATUS_OK;
}

status power_rates_make(const value_table *first, const value_table *other, const power_options *options,
                        power_rates *out, diagnostic *why)
{
    const size_t of_pair = options->design_count * DESIGN_ORDERS;
    *out = (power_rates){.rates = calloc((first->count + 1) * of_pair + 1, sizeof *out->rates)};
    status code = out->rates ? STATUS_OK : out_of_memory(why);
    THEN(code, try_all(first, other, options, out, why));
    if (code == STATUS_OK && out->count == 0)
        code = diagnose(why, STATUS_BAD_INPUT, "choose smaller designs, or measure in more processes",
                        "the rows have too few processes or repetitions for every design");
    if (code != STATUS_OK)
        power_rates_free(out);
    return code;
}

void power_rates_free(power_rates *r)
{
    free(r->rates);
    *r = (power_rates){.count = 0};
}

static share_interval share_of(const power_rate *r, design_rule rule, size_t hits)
{
    const double draws = (double)r->tally.draws, trials = (double)r->tally.independent;
    return design_has_rule(&r->of, rule) ? binomial_interval((double)hits / draws * trials, trials)
                                         : (share_interval){NAN, NAN, NAN};
}

share_interval power_wrong(const power_rate *r, design_rule rule)
{
    const design_tally *t = &r->tally;
    return share_of(r, rule, (r->truth <= 0 ? t->larger[rule] : 0) + (r->truth >= 0 ? t->smaller[rule] : 0));
}

share_interval power_silent(const power_rate *r, design_rule rule)
{
    return share_of(r, rule, r->tally.draws - r->tally.larger[rule] - r->tally.smaller[rule]);
}
