/* `cuvette study power`: how often smaller studies, drawn from measured rows, would mislead. */
#include "base/number.h"
#include "base/text.h"
#include "cli/options.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "study/summary/power_rates.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILES = 2, DESIGNS_MOST = 32 };

typedef struct request {
    const char *files[FILES], *column;
    char cells[2][64];
    design designs[DESIGNS_MOST];
    size_t design_count;
    double effect; /* fraction */
    int64_t draws, seed;
    int truth; /* power_truth */
    bool tsv;
} request;

static status parse_effect(const command_option *o, void *context, const char *value, diagnostic *why)
{
    double percent;
    (void)o;
    if (!number_parse_real(value, &percent) || percent <= 0 || percent > 1000)
        return options_wrong("--effect", value, why, "give a percentage, such as 5", "invalid percentage '%.64s'",
                             value);
    ((request *)context)->effect = percent / 100;
    return STATUS_OK;
}

static status parse_cells(const command_option *o, void *context, const char *value, diagnostic *why)
{
    request *r = context;
    (void)o;
    const char *comma = strchr(value, ',');
    const size_t first = comma ? (size_t)(comma - value) : 0;
    if (!first || first >= sizeof r->cells[0] || !comma[1] || strlen(comma + 1) >= sizeof r->cells[1])
        return options_wrong("--cells", value, why, "give two values of the column 'cell', such as 0,1",
                             "two cells are necessary");
    snprintf(r->cells[0], sizeof r->cells[0], "%.*s", (int)first, value);
    snprintf(r->cells[1], sizeof r->cells[1], "%s", comma + 1);
    return STATUS_OK;
}

static status parse_truth(const command_option *o, void *context, const char *value, diagnostic *why)
{
    static const char *const words[] = {"same", "larger", "smaller"}; /* the order of power_truth */
    (void)o;
    return options_choice("--truth", "truth", value, words, sizeof words / sizeof *words, &((request *)context)->truth,
                          why);
}

/* Reads "10", the repetitions in one process, or "3x10", 10 repetitions in each of 3 processes. */
static bool read_design(const char *text, design *out)
{
    char copy[32];
    int64_t processes = 1, repetitions;
    if (strlen(text) >= sizeof copy)
        return false;
    snprintf(copy, sizeof copy, "%s", text);
    char *cross = strchr(copy, 'x');
    if (cross)
        *cross = 0;
    if ((cross && !number_parse_int(copy, &processes)) || !number_parse_int(cross ? cross + 1 : copy, &repetitions))
        return false;
    *out = (design){(size_t)processes, (size_t)repetitions, DESIGN_APART};
    return processes >= 1 && processes <= 1000 && repetitions >= 1 && repetitions <= 1000;
}

static status parse_designs(const command_option *o, void *context, const char *value, diagnostic *why)
{
    request *r = context;
    (void)o;
    char text[512], *state = NULL;
    r->design_count = 0;
    bool good = strlen(value) < sizeof text;
    snprintf(text, sizeof text, "%s", value);
    for (char *one = strtok_r(text, ",", &state); good && one; one = strtok_r(NULL, ",", &state))
        good = r->design_count < DESIGNS_MOST && read_design(one, &r->designs[r->design_count++]);
    return good && r->design_count
               ? STATUS_OK
               : options_wrong("--designs", value, why,
                               "give repetitions, or processes x repetitions, such as 1,3,10,3x10", "invalid designs");
}

static const command_option options[] = {
    {"column", 'c', "COLUMN", "measured column (default: wall_s)", OPTION_FILLS(option_text, request, column)},
    {"cells", 0, "A,B", "two cells with a difference, instead of each cell with itself", .store = parse_cells},
    {"truth", 0, "WORD", "what B is known to be: same, larger or smaller than A (default: as in all rows)",
     .store = parse_truth},
    {"designs", 0, "LIST",
     "studies to draw: R repetitions, or PxR, R in each of P processes (default: 1,3,10,3x1,10x1,3x10)",
     .store = parse_designs},
    {"effect", 'e', "PERCENT", "difference of the medians that the rule 'effect' counts as a difference (default: 5)",
     .store = parse_effect},
    {"draws", 0, "N", "studies to draw for each rate, 10 to 100000 (default: 400)",
     OPTION_FILLS(option_integer, request, draws), 10, 100000},
    {"seed", 0, "N", "seed of the draws (default: 1)", OPTION_FILLS(option_integer, request, seed), 0, INT64_MAX},
    {"tsv", 0, NULL, "print every rate with all digits, separated by tabs", OPTION_FILLS(option_flag, request, tsv)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "ROWS.csv [OTHER.csv]",
    .about =
        "How often would a study with fewer repetitions mislead? Studies of 1, 3, 10 .. repetitions are drawn from "
        "measured rows, and judged by rules that people use.\vEach cell is compared with itself: every claim of a "
        "difference is false. With two files, such as the rows of a quiet and of a loaded machine, each cell is "
        "compared with the cell of the same name in the other file. With --cells the claims with the wrong sign are "
        "counted, and the studies without a claim.\n"
        "Rules: sign (the larger median), effect (medians differ by more than --effect), t (Student's test), medians "
        "(95% intervals of the medians by order statistics are disjoint), processes (the same, resampled by process) "
        "and ratio (the interval of 'cuvette study compare').\n"
        "Sides are measured apart, in processes that take turns, or together in the same processes. For example:\n"
        "  cuvette study power results/threads/rows.csv --designs=1,3\n"
        "  cuvette study power results/pool/rows.csv --cells=1,6 --truth=larger",
    .arguments_at = offsetof(request, files),
    .argument_limit = FILES,
    .excess = "too many arguments: %s",
    .excess_remedy = "give one or two CSV files"};

/* --- output --- */

static void put_real(double value)
{
    char text[NUMBER_TEXT_MAX];
    printf("\t%s", isfinite(value) ? number_format_digits(value, 6, text) : "NA");
}

static void print_tsv(const power_rates *r)
{
    puts("cell_a\tcell_b\torder\tprocesses\trepetitions\trule\tdraws\tindependent\tratio\tratio_low\tratio_high\t"
         "larger\tsmaller\twrong\twrong_low\twrong_high\tsilent\tsilent_low\tsilent_high");
    for (size_t i = 0; i < r->count; i++)
        for (int rule = 0; rule < DESIGN_RULES; rule++) {
            const power_rate *p = &r->rates[i];
            const fraction_interval wrong = power_wrong_claims(p, (design_rule)rule),
                                    silent = power_no_claims(p, (design_rule)rule);
            if (isnan(wrong.share))
                continue;
            printf("%s\t%s\t%s\t%zu\t%zu\t%s\t%zu\t%zu", p->a ? p->a : "all", p->b ? p->b : "all",
                   design_order_text(p->of.order), p->of.processes, p->of.repetitions,
                   design_rule_text((design_rule)rule), p->tally.draws, p->tally.independent);
            const double values[] = {p->ratio.value,
                                     p->ratio.low,
                                     p->ratio.high,
                                     (double)p->tally.larger[rule],
                                     (double)p->tally.smaller[rule],
                                     wrong.share,
                                     wrong.low,
                                     wrong.high,
                                     silent.share,
                                     silent.low,
                                     silent.high};
            for (size_t k = 0; k < sizeof values / sizeof *values; k++)
                put_real(values[k]);
            putchar('\n');
        }
}

/* The percentage of studies with a wrong claim, "12 [4, 27]"; if the cells are known to differ, the percentages with a
 * wrong claim and without a claim, "12 / 30". */
static char *rate_text(const power_rate *r, design_rule rule)
{
    const fraction_interval wrong = power_wrong_claims(r, rule), silent = power_no_claims(r, rule);
    if (isnan(wrong.share))
        return strdup("");
    return r->truth ? text_format("%.0f / %.0f", 100 * wrong.share, 100 * silent.share)
                    : text_format("%.0f [%.0f, %.0f]", 100 * wrong.share, 100 * wrong.low, 100 * wrong.high);
}

enum { OWN_COLUMNS = 4, COLUMNS = OWN_COLUMNS + DESIGN_RULES };

static void put_line(const power_rate *r, char **text)
{
    text[0] = strdup(design_order_text(r->of.order));
    text[1] = text_format("%zu", r->of.processes);
    text[2] = text_format("%zu", r->of.repetitions);
    text[3] = text_format("%zu", r->tally.independent);
    for (int rule = 0; rule < DESIGN_RULES; rule++)
        text[OWN_COLUMNS + rule] = rate_text(r, (design_rule)rule);
}

/* Prints the lines over all pairs, or those of the only pair. */
static status print_table(const power_rates *r, diagnostic *why)
{
    static const char *const names[OWN_COLUMNS] = {"order", "processes", "repetitions", "independent"};
    char **text = calloc((r->count + 1) * COLUMNS, sizeof *text);
    size_t rows = 1;
    if (!text)
        return out_of_memory(why);
    for (int i = 0; i < COLUMNS; i++)
        text[i] = strdup(i < OWN_COLUMNS ? names[i] : design_rule_text((design_rule)(i - OWN_COLUMNS)));
    const bool has_sums = !r->rates[r->count - 1].a;
    for (size_t i = 0; i < r->count; i++)
        if (!has_sums || !r->rates[i].a)
            put_line(&r->rates[i], text + rows++ * COLUMNS);
    bool has_memory = true;
    for (size_t i = 0; i < rows * COLUMNS; i++)
        has_memory = has_memory && text[i];
    const status code = has_memory ? aligned_table_print(stdout, text, rows, COLUMNS, why) : out_of_memory(why);
    for (size_t i = 0; i < rows * COLUMNS; i++)
        free(text[i]);
    free(text);
    return code;
}

static status print_text(const power_rates *r, diagnostic *why)
{
    const power_rate *first = &r->rates[0];
    if (first->truth) {
        printf("Of cell %s and cell %s, whose ratio over all rows is %.3f", first->a, first->b, first->ratio.value);
        if (!isnan(first->ratio.low))
            printf(" [%.3f, %.3f]", first->ratio.low, first->ratio.high);
        puts(": studies in per cent that claim the opposite / make no claim.");
    } else
        puts("Studies in per cent that claim a difference where there is none, with the 95% interval.");
    return print_table(r, why);
}

static status make_and_print(const request *q, const value_table *first, const value_table *other, diagnostic *why)
{
    const power_options wanted = {.a = q->cells[0][0] ? q->cells[0] : NULL,
                                  .b = q->cells[1],
                                  .truth = (power_truth)q->truth,
                                  .designs = q->designs,
                                  .design_count = q->design_count,
                                  .draws = (size_t)q->draws,
                                  .effect = q->effect,
                                  .seed = (uint64_t)q->seed};
    power_rates rates;
    TRY(locate_failure(why, q->files[0], power_rates_make(first, other, &wanted, &rates, why)));
    status code = STATUS_OK;
    if (q->tsv)
        print_tsv(&rates);
    else
        code = print_text(&rates, why);
    power_rates_free(&rates);
    return code == STATUS_OK ? terminal_flush(why) : code;
}

status study_power(int argc, char **argv, diagnostic *why)
{
    request q = {.column = "wall_s", .effect = 0.05, .draws = 400, .seed = 1, .truth = POWER_OF_ALL_ROWS};
    value_table first, second = {.count = 0};
    const command_option designs = {.name = "designs"};
    TRY(parse_designs(&designs, &q, "1,3,10,3x1,10x1,3x10", why));
    TRY(command_form_read(&form, argc, argv, &q, why));
    if (!q.files[0])
        return options_wrong("study power", NULL, why, "give a CSV file, such as results/STUDY/rows.csv",
                             "no rows are given");
    if (q.truth != POWER_OF_ALL_ROWS && !q.cells[0][0])
        return options_wrong("--truth", NULL, why, "add --cells=A,B", "--truth compares two cells");
    TRY(value_table_read(q.files[0], q.column, &first, why));
    status code = q.files[1] ? value_table_read(q.files[1], q.column, &second, why) : STATUS_OK;
    THEN(code, make_and_print(&q, &first, q.files[1] ? &second : &first, why));
    value_table_release(&first);
    value_table_release(&second);
    return code;
}
