/* Reads measured columns by cell and process, and computes the rates of smaller studies drawn from them. */
#include "study/summary/power_rates.h"
#include "base/number.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- tables of values --- */

typedef struct value_row {
    const char *cell;
    size_t process, line;
    double value;
} value_row;

/* Compares numbers by value, and other names as text. */
static int by_name(const char *a, const char *b)
{
    double x, y;
    if (number_parse_real(a, &x) && number_parse_real(b, &y) && x != y)
        return x < y ? -1 : 1;
    return strcmp(a, b);
}

static int by_place(const void *a, const void *b)
{
    const value_row *x = a, *y = b;
    const int cells = by_name(x->cell, y->cell);
    if (cells)
        return cells;
    if (x->process != y->process)
        return x->process < y->process ? -1 : 1;
    return x->line < y->line ? -1 : x->line > y->line;
}

/* The number of a process, in the order of first rows. The search begins with the latest, because rows of one process
 * are neighbours. */
static size_t process_of(const char *id, const char **ids, size_t *count)
{
    for (size_t i = *count; i-- > 0;)
        if (strcmp(ids[i], id) == 0)
            return i;
    ids[*count] = id;
    return (*count)++;
}

static bool counts(const csv *table, size_t row, double value)
{
    const int warmup = csv_column(table, "warmup"), marked = csv_column(table, "marked");
    return value > 0 && isfinite(value) && !(csv_field_real(table, row, warmup) > 0) &&
           !(csv_field_real(table, row, marked) > 0);
}

static status fill(value_cell *cell, const value_row *rows, size_t count, diagnostic *why)
{
    *cell = (value_cell){.name = rows->cell,
                         .values = calloc(count, sizeof *cell->values),
                         .start = calloc(count + 1, sizeof *cell->start),
                         .process = calloc(count, sizeof *cell->process)};
    if (!cell->values || !cell->start || !cell->process)
        return out_of_memory(why);
    size_t processes = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || rows[i].process != rows[i - 1].process) {
            cell->process[processes] = rows[i].process;
            cell->start[processes++] = i;
        }
        cell->values[i] = log(rows[i].value);
    }
    cell->start[processes] = count;
    cell->sample = (level_sample){cell->values, cell->start, processes};
    return STATUS_OK;
}

static status divide(value_table *t, value_row *rows, size_t count, diagnostic *why)
{
    qsort(rows, count, sizeof *rows, by_place);
    t->cells = calloc(count + 1, sizeof *t->cells);
    if (!t->cells)
        return out_of_memory(why);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && strcmp(rows[end].cell, rows[i].cell) == 0;)
            end++;
        TRY(fill(&t->cells[t->count++], rows + i, end - i, why));
    }
    return STATUS_OK;
}

static status find_columns(const char *path, const char *column, const csv *table, int found[3], diagnostic *why)
{
    const char *const names[] = {"cell", csv_column(table, "run") < 0 ? "process" : "run", column};
    for (int i = 0; i < 3; i++)
        if ((found[i] = csv_column(table, names[i])) < 0)
            return diagnose_at(why, path, STATUS_BAD_INPUT,
                               "use a file with the columns cell, run (or process) and the measured one",
                               "there is no column '%.64s'", names[i]);
    return STATUS_OK;
}

static status read_rows(const char *path, const char *column, value_table *t, diagnostic *why)
{
    int at[3];
    size_t count = 0, processes = 0;
    TRY(find_columns(path, column, t->file, at, why));
    value_row *rows = calloc(t->file->row_count + 1, sizeof *rows);
    const char **ids = calloc(t->file->row_count + 1, sizeof *ids);
    status code = rows && ids ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < t->file->row_count; i++) {
        const double value = csv_field_real(t->file, i, at[2]);
        if (counts(t->file, i, value))
            rows[count++] = (value_row){csv_field(t->file, i, at[0]),
                                        process_of(csv_field(t->file, i, at[1]), ids, &processes), i, value};
    }
    if (code == STATUS_OK && count == 0)
        code = diagnose_at(why, path, STATUS_BAD_INPUT, "give a column of positive numbers, such as wall_s",
                           "no row has a value of '%.64s'", column);
    THEN(code, divide(t, rows, count, why));
    free(ids);
    free(rows);
    return code;
}

status value_table_read(const char *path, const char *column, value_table *out, diagnostic *why)
{
    *out = (value_table){.count = 0};
    status code = csv_read_any(path, NULL, &out->file, why);
    if (code == STATUS_OK && !out->file)
        code = diagnose_at(why, path, STATUS_BAD_INPUT, "give a CSV file, such as results/STUDY/rows.csv",
                           "there is no such file");
    if (code == STATUS_OK && out->file->torn)
        code =
            diagnose_at(why, path, STATUS_BAD_INPUT, "complete it, or remove it; if a study is writing the file, wait",
                        "the last line is incomplete");
    THEN(code, read_rows(path, column, out, why));
    if (code != STATUS_OK)
        value_table_release(out);
    return code;
}

void value_table_release(value_table *t)
{
    for (size_t i = 0; i < t->count; i++) {
        free(t->cells[i].values);
        free(t->cells[i].start);
        free(t->cells[i].process);
    }
    free(t->cells);
    csv_destroy(t->file);
    *t = (value_table){.count = 0};
}

/* The cell of that name, or NULL. */
static const value_cell *find_cell(const value_table *t, const char *name)
{
    for (size_t i = 0; i < t->count; i++)
        if (strcmp(t->cells[i].name, name) == 0)
            return &t->cells[i];
    return NULL;
}

/* Whether two cells of one table have the same processes. */
static bool have_same_processes(const value_cell *a, const value_cell *b)
{
    return a->sample.processes == b->sample.processes &&
           memcmp(a->process, b->process, a->sample.processes * sizeof *a->process) == 0;
}

/* --- rates --- */

typedef struct pair {
    const value_cell *a, *b;
    bool shared;
} pair;

static status find(const value_table *t, const char *name, const value_cell **out, diagnostic *why)
{
    *out = find_cell(t, name);
    return *out ? STATUS_OK
                : diagnose(why, STATUS_BAD_INPUT, "give two values of the column 'cell', such as 0,1",
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

/* Adds the rates of a pair for each order and design that can be drawn. p->shared: both cells have the same processes,
 * so that they can be drawn together. */
static status try_pair(const pair *p, const power_options *o, power_rates *out, diagnostic *why)
{
    level_interval ratio = {1, 1, 1};
    if (p->a != p->b)
        TRY(ratio_of(p, o->seed, &ratio, why));
    const design_population population = {&p->a->sample, &p->b->sample, p->shared};
    for (int order = 0; order < DESIGN_ORDERS; order++)
        for (size_t i = 0; i < o->design_count; i++) {
            power_rate rate = {.a = p->a->name, .b = p->b->name, .of = o->designs[i], .ratio = ratio};
            rate.of.order = (design_order)order;
            rate.truth = truth_of(o, &ratio);
            TRY(design_try(&population, &rate.of, ~0u, o->draws, o->effect, o->seed, &rate.tally, why));
            if (rate.tally.draws)
                out->rates[out->count++] = rate;
        }
    return STATUS_OK;
}

static bool same_design(const design *a, const design *b)
{
    return a->order == b->order && a->processes == b->processes && a->repetitions == b->repetitions;
}

/* Adds the sums over all pairs after their rates. What disturbs a process disturbs all its cells, so studies of several
 * cells are no more independent than studies of one cell. */
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
        p.shared = first == other && have_same_processes(p.a, p.b);
        return try_pair(&p, o, out, why);
    }
    bool common = false;
    for (size_t i = 0; i < first->count; i++) {
        const value_cell *b = find_cell(other, first->cells[i].name);
        const pair p = {&first->cells[i], b, first == other};
        common |= b != NULL;
        if (b)
            TRY(try_pair(&p, o, out, why));
    }
    if (!common)
        return diagnose(why, STATUS_BAD_INPUT, "choose a cell of each file with --cells, such as --cells 0,1",
                        "the two files have no cell of the same name");
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

static fraction_interval fraction_of(const power_rate *r, design_rule rule, size_t hits)
{
    const double draws = (double)r->tally.draws, trials = (double)r->tally.independent;
    return design_has_rule(&r->of, rule) ? binomial_interval((double)hits / draws * trials, trials)
                                         : (fraction_interval){NAN, NAN, NAN};
}

fraction_interval power_wrong_claims(const power_rate *r, design_rule rule)
{
    const design_tally *t = &r->tally;
    return fraction_of(r, rule, (r->truth <= 0 ? t->larger[rule] : 0) + (r->truth >= 0 ? t->smaller[rule] : 0));
}

fraction_interval power_no_claims(const power_rate *r, design_rule rule)
{
    return fraction_of(r, rule, r->tally.draws - r->tally.larger[rule] - r->tally.smaller[rule]);
}
