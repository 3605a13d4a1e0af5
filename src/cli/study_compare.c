/* `cuvette study compare`: two runs, environments, cells or values of an axis. */
#include "base/number.h"
#include "base/text.h"
#include "cli/options.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "study/plan/grid.h"
#include "study/study.h"
#include "study/summary/contrast.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ARGUMENTS = 3 }; /* study, A, B */

typedef struct request {
    const char *arguments[ARGUMENTS];
    const char *results, *column;
    double detect, fail; /* fractions; fail below 0: not given */
    bool tsv, json;
} request;

static status parse_percent(const command_option *o, void *context, const char *value, diagnostic *why)
{
    double percent;
    const double least = strcmp(o->name, "detect") == 0 ? 0.001 : 0.0;
    if (!number_parse_real(value, &percent) || percent < least || percent > 1000)
        return options_wrong(o->name, value, why, "give a percentage, such as 3", "invalid percentage '%.64s'", value);
    *(double *)((char *)context + o->at) = percent / 100;
    return STATUS_OK;
}

static const command_option options[] = {
    {"results", 'r', "DIR", "folder of the results unless a side names one (default: results)",
     OPTION_FILLS(option_text, request, results)},
    {"column", 'c', "COLUMN", "column of rows.csv to compare (default: wall_s)",
     OPTION_FILLS(option_text, request, column)},
    {"detect", 'd', "PERCENT", "difference for which the necessary number of processes is printed (default: 3)",
     OPTION_FILLS(parse_percent, request, detect)},
    {"fail-if-slower", 0, "PERCENT",
     "exit status 1 if the interval of the ratio over all cells lies above 1 + PERCENT / 100, and 2 if there can be no "
     "verdict",
     OPTION_FILLS(parse_percent, request, fail)},
    {"tsv", 0, NULL, "print the table with all digits, separated by tabs", OPTION_FILLS(option_flag, request, tsv)},
    {"json", 0, NULL, "print JSON", OPTION_FILLS(option_flag, request, json)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "STUDY A B",
    .about =
        "Compare two sides of a study: the ratio B / A of wall times, its 95% interval, and a verdict.\vA side is a "
        "results folder, PATH=VALUE (cells with that value), cell=N, environment=KEY or run=ID, or several of them "
        "separated by commas. For example:\n"
        "  cuvette study compare experiments/threads.study render.threads=1 render.threads=2\n"
        "  cuvette study compare experiments/depth.study results results-against\n"
        "There is a verdict only if the sides alternated in at least 3 processes: see 'processes' in "
        "cuvette-study(5), and 'cuvette study run --against'.",
    .arguments_at = offsetof(request, arguments),
    .argument_limit = ARGUMENTS,
    .excess = "too many arguments: %s",
    .excess_remedy = "give a study file and two sides"};

/* --- table --- */

static bool is_shared(const study_side *side, size_t axis)
{
    return side->point[axis] == STUDY_SIDE_ANY;
}

static size_t put_shared(const study *s, const study_side *side, const contrast_line *line, char **text)
{
    size_t count = 0;
    for (size_t axis = 0; axis < s->axis_count; axis++)
        for (size_t i = 0; is_shared(side, axis) && i < s->axes[axis].points[0].count; i++) {
            const study_point *point = line ? &s->axes[axis].points[study_cell_point(s, line->a.cell, axis)] : NULL;
            text[count++] = strdup(point ? point->values[i] : s->axes[axis].points[0].paths[i]);
        }
    return count;
}

static char *ratio_text(const level_interval *ratio)
{
    char value[NUMBER_TEXT_MAX], low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    const double half = 0.5 * (ratio->high - ratio->low);
    if (isnan(ratio->value))
        return strdup("NA");
    number_format_within(ratio->value, half, value);
    return isnan(half) ? strdup(value)
                       : text_format("%s [%s, %s]", value, number_format_within(ratio->low, half, low),
                                     number_format_within(ratio->high, half, high));
}

static char *median_text(const contrast_half *half)
{
    char text[NUMBER_TEXT_MAX];
    return strdup(isnan(half->median) ? "NA" : number_format_digits(half->median, 4, text));
}

static char *verdict_text(const contrast_line *line)
{
    return line->reason == CONTRAST_CLEAR
               ? strdup(contrast_verdict_text(line->verdict))
               : text_format("%s: %s", contrast_verdict_text(line->verdict), contrast_reason_text(line->reason));
}

enum { OWN_COLUMNS = 6 };

/* Sets the texts of a line. line NULL: the header; of_cell false: the line over all cells. */
static void put_line(const study *s, const study_side *a, const contrast_line *line, bool of_cell, const char *column,
                     size_t shared, char **text)
{
    if (of_cell)
        put_shared(s, a, line, text);
    for (size_t i = 0; !of_cell && i < shared; i++)
        text[i] = strdup(i ? "" : "all");
    char **fields = text + shared;
    fields[0] = !line ? strdup("n") : text_format("%zu, %zu", line->a.count, line->b.count);
    fields[1] = !line ? strdup("processes") : text_format("%zu, %zu", line->a.processes, line->b.processes);
    fields[2] = !line ? text_format("A %s", column) : of_cell ? median_text(&line->a) : strdup("");
    fields[3] = !line ? text_format("B %s", column) : of_cell ? median_text(&line->b) : strdup("");
    fields[4] = !line ? strdup("B/A [95% interval]") : ratio_text(&line->ratio);
    fields[5] = !line ? strdup("verdict") : verdict_text(line);
}

static status print_table(const study *s, const study_side *a, const contrast *c, const char *column, diagnostic *why)
{
    char *names[STUDY_AXES_MAX * 64] = {NULL};
    size_t shared = put_shared(s, a, NULL, names);
    for (size_t i = 0; i < shared; i++)
        free(names[i]);
    const bool has_total = c->count > 1;
    const size_t columns = shared + OWN_COLUMNS, rows = 1 + c->count + has_total;
    char **text = calloc(rows * columns + 1, sizeof *text);
    if (!text)
        return out_of_memory(why);
    put_line(s, a, NULL, true, column, shared, text);
    for (size_t i = 0; i < c->count; i++)
        put_line(s, a, &c->lines[i], true, column, shared, text + (i + 1) * columns);
    if (has_total)
        put_line(s, a, &c->all, false, column, shared, text + (c->count + 1) * columns);
    bool has_memory = true;
    for (size_t i = 0; i < rows * columns; i++)
        has_memory = has_memory && text[i];
    const status code = has_memory ? aligned_table_print(stdout, text, rows, columns, why) : out_of_memory(why);
    for (size_t i = 0; i < rows * columns; i++)
        free(text[i]);
    free(text);
    return code;
}

/* --- text around the table --- */

static void print_side(char name, const study_side *side, const contrast *c, int which)
{
    printf("%c: %s", name, side->given);
    if (strcmp(side->given, side->results) != 0)
        printf(" in %s", side->results);
    printf(", environment %s", c->environment[which]);
    if (c->left_out[which])
        printf("; %zu rows of other environments are left out (choose one with environment=KEY)", c->left_out[which]);
    putchar('\n');
}

static bool has_reason(const contrast *c, contrast_reason reason)
{
    bool has = c->all.reason == reason;
    for (size_t i = 0; i < c->count; i++)
        has |= c->lines[i].reason == reason;
    return has;
}

static void print_advice(const study_side *a, const study_side *b, const contrast *c, double detect)
{
    const contrast_line *all = &c->all;
    const bool one_folder = strcmp(a->results, b->results) == 0 && !a->environment && !b->environment;
    if (has_reason(c, CONTRAST_NO_TURNS) || has_reason(c, CONTRAST_FEW))
        printf("For a verdict, A and B must alternate in fresh processes: %s.\n",
               one_folder ? "set processes: 8 in the study file, or run it with --processes=8, in one go"
                          : "measure with cuvette study run --against=PROGRAM --processes=8");
    if (all->reason == CONTRAST_NO_ROWS)
        return;
    if (all->pairs_needed)
        printf("%zu processes of each side find a difference of %g%% over all cells with 95%% probability.\n",
               all->pairs_needed, detect * 100);
    else
        printf("The number of processes that find a difference of %g%% is unknown, or above 10000.\n", detect * 100);
}

/* Prints whether both sides did the same work: times of unlike work do not compare speed. */
static void print_work(const contrast *c)
{
    if (c->compared == 0)
        puts("No cell has rows on both sides.");
    else if (c->same == c->compared)
        printf("The same work: films and ray counts are equal in all %zu cells with rows on both sides.\n",
               c->compared);
    else
        printf("Not the same work: films and ray counts are equal in %zu of %zu cells with rows on both sides.\n",
               c->same, c->compared);
}

static status print_text(const study *s, const request *r, const study_side *a, const study_side *b, const contrast *c,
                         diagnostic *why)
{
    print_side('A', a, c, 0);
    print_side('B', b, c, 1);
    print_work(c);
    TRY(print_table(s, a, c, r->column, why));
    print_advice(a, b, c, r->detect);
    printf("Films and ray counts are equal in %zu of %zu cells", c->same, c->compared);
    if (c->compared < c->count)
        printf("; %zu more have no rows on one side", c->count - c->compared);
    puts(".");
    return STATUS_OK;
}

static void put_real(double value)
{
    char text[NUMBER_TEXT_MAX];
    printf("\t%s", isfinite(value) ? number_format(value, text) : "NA");
}

static void print_tsv_line(const contrast_line *line, const char *const environments[2])
{
    const contrast_half *const halves[] = {&line->a, &line->b};
    for (int i = 0; i < 2; i++) {
        printf("\t%s\t%zu\t%zu", environments[i], halves[i]->count, halves[i]->processes);
        put_real(halves[i]->median);
    }
    put_real(line->ratio.value);
    put_real(line->ratio.low);
    put_real(line->ratio.high);
    printf("\t%s\t%s\t%d\t", contrast_verdict_text(line->verdict), contrast_reason_text(line->reason), line->alternate);
    if (line->pairs_needed)
        printf("%zu\n", line->pairs_needed);
    else
        puts("NA");
}

static void print_tsv(const study *s, const contrast *c)
{
    const char *const environments[] = {c->environment[0], c->environment[1]};
    size_t paths = 0;
    fputs("cell_a\tcell_b", stdout);
    grid_put_paths(s, stdout);
    while (study_grid_path(s, paths))
        paths++;
    puts("\tenvironment_a\tn_a\tprocesses_a\tmedian_a\tenvironment_b\tn_b\tprocesses_b\tmedian_b\tratio\tlow\thigh\t"
         "verdict\treason\talternate\tpairs_needed");
    for (size_t i = 0; i < c->count; i++) {
        printf("%zu\t%zu", c->lines[i].a.cell, c->lines[i].b.cell);
        grid_put_values(s, c->lines[i].a.cell, stdout);
        print_tsv_line(&c->lines[i], environments);
    }
    fputs("all\tall", stdout);
    for (size_t i = 0; i < paths; i++)
        fputs("\tNA", stdout);
    print_tsv_line(&c->all, environments);
}

/* --- command --- */

static status judge(const request *r, const contrast *c, const diagnostic *verdict, diagnostic *why)
{
    TRY(terminal_flush(why));
    if (verdict->what[0]) {
        *why = *verdict;
        return STATUS_FAILURE;
    }
    const contrast_reason reason = c->all.reason;
    if (r->fail >= 0 && reason != CONTRAST_CLEAR && reason != CONTRAST_INTERVAL)
        return diagnose(why, STATUS_BAD_INPUT,
                        "measure both sides in turn in fresh processes: cuvette-study(1), --against",
                        "--fail-if-slower cannot judge: %s", contrast_reason_text(reason));
    if (r->fail >= 0 && c->all.verdict == CONTRAST_SLOWER && c->all.ratio.low > 1 + r->fail)
        return diagnose(why, STATUS_FAILURE, "see the table", "B is slower than A by more than %g%%", r->fail * 100);
    return STATUS_OK;
}

static status compare(const study *s, const request *r, diagnostic *why)
{
    study_side a = {.text = NULL}, b = {.text = NULL};
    contrast *c = NULL;
    diagnostic verdict = {.what = ""};
    const contrast_options wanted = {.column = r->column, .detect = r->detect};
    status code = side_read(s, r->arguments[1], r->results, &a, why);
    THEN(code, side_read(s, r->arguments[2], r->results, &b, why));
    THEN(code, contrast_make(s, &a, &b, &wanted, &c, &verdict, why));
    if (code == STATUS_OK && r->json)
        code = json_print(contrast_json(s, c, SIZE_MAX), why);
    else if (code == STATUS_OK && r->tsv)
        print_tsv(s, c);
    else if (code == STATUS_OK)
        code = print_text(s, r, &a, &b, c, why);
    THEN(code, judge(r, c, &verdict, why));
    contrast_destroy(c);
    side_release(&a);
    side_release(&b);
    return code;
}

status study_compare(int argc, char **argv, diagnostic *why)
{
    request r = {.results = "results", .column = "wall_s", .detect = 0.03, .fail = -1};
    TRY(command_form_read(&form, argc, argv, &r, why));
    if (!r.arguments[ARGUMENTS - 1])
        return options_wrong("study compare", NULL, why,
                             "give a study file and two sides, such as results results-against",
                             "two sides of a study are necessary");
    study *s = NULL;
    TRY(study_read(r.arguments[0], &s, why));
    status code = study_follow_runs(s, r.results, why);
    THEN(code, compare(s, &r, why));
    study_destroy(s);
    return code;
}
