/* How often a small study misleads: measured values are the population from which studies of one or a few repetitions
 * are drawn, and each is judged by rules that people use. A rule claims that b is larger than a, or smaller, or makes
 * no claim. Values are logarithms of times, so that differences are ratios. Ownership: samples are borrowed. */
#pragma once

#include "measure/levels.h"

typedef enum design_rule {
    DESIGN_SIGN,      /* the sign of the difference of the medians, however small */
    DESIGN_EFFECT,    /* the medians differ by more than a given fraction, such as 5% */
    DESIGN_T,         /* Student's two-sample t test at 5%, over all values as if independent */
    DESIGN_MEDIANS,   /* the 95% intervals of the medians by order statistics are disjoint, as if independent */
    DESIGN_PROCESSES, /* the intervals of level_median are disjoint: the rule of `make claims` */
    DESIGN_RATIO,     /* the interval of the ratio excludes 1, as in `cuvette study compare`; from 3 processes on */
    DESIGN_RULES
} design_rule;

/* When both sides are measured. */
typedef enum design_order {
    DESIGN_APART,    /* each in separate processes, at any time */
    DESIGN_TURNS,    /* each in separate processes that follow one another in pairs */
    DESIGN_TOGETHER, /* both in the same processes; only for two cells */
    DESIGN_ORDERS
} design_order;

typedef struct design {
    size_t processes, repetitions; /* processes per side, successive repetitions per process */
    design_order order;
} design;

/* "sign", ...; "apart", ... */
const char *design_rule_text(design_rule rule);
const char *design_order_text(design_order order);
/* Whether the rule can ever claim anything: an interval of the median needs 6 values, a t test 2, and the rule of
 * ratios 6 values and 3 processes. */
bool design_has_rule(const design *d, design_rule rule);

/* *claim: 1 if b is larger than a, -1 if it is smaller, 0 if the rule makes no claim. paired: process k of both are a
 * pair. effect: 0.05 for 5%. */
status design_claim(design_rule rule, const level_sample *a, const level_sample *b, bool paired, double effect,
                    uint64_t seed, int *claim, diagnostic *why);

/* All values of both sides. shared: process k of both is the same process; a and b may be one sample. Otherwise only
 * DESIGN_APART is possible. Processes are in the order of time. */
typedef struct design_population {
    const level_sample *a, *b;
    bool shared;
} design_population;

typedef struct design_tally {
    size_t draws;                                       /* 0: the population is too small */
    size_t larger[DESIGN_RULES], smaller[DESIGN_RULES]; /* claims */
    /* The number of studies without a common process into which the population can be divided: a rate is at least as
     * precise as the rate of that many independent studies, because the mean over draws is a U-statistic (Hoeffding,
     * Annals of Mathematical Statistics 19, 1948); more draws add nothing. */
    size_t independent;
} design_tally;

/* Draws studies without replacement. rules: bit k is rule k; others stay 0. */
status design_try(const design_population *population, const design *d, unsigned rules, size_t draws, double effect,
                  uint64_t seed, design_tally *out, diagnostic *why);
