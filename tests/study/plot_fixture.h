/* Figures of summaries that are made by hand. */
#pragma once

#include "study/plot/plot.h"
#include "study_fixture.h"

typedef struct hand {
    int cell, n, marked;
    const char *environment, *value, *low, *high;
} hand;

/* A plan whose summary has these lines: paths and values as the study has them. */
static plot_plan plan_of(const study *s, const plot_request *request, const hand *lines, size_t count, bool environment)
{
    plot_plan p = {.s = s, .request = request};
    diagnostic why = {0};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    fputs("cell", out);
    fputs(environment ? "\tenvironment" : "", out);
    for (size_t a = 0; a < s->axis_count; a++)
        for (size_t i = 0; i < s->axes[a].points[0].count; i++)
            fprintf(out, "\t%s", s->axes[a].points[0].paths[i]);
    fputs(
        "\tn\twall_s_median\twall_s_low\twall_s_high\twall_s_mean\twall_s_min\twall_s_max\trays_total\tmarked\tothers_"
        "fraction\n",
        out);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "%d", lines[i].cell);
        if (environment)
            fprintf(out, "\t%s", lines[i].environment);
        for (size_t a = 0; a < s->axis_count; a++) {
            const study_point *point = &s->axes[a].points[study_cell_point(s, (size_t)lines[i].cell, a)];
            for (size_t k = 0; k < point->count; k++)
                fprintf(out, "\t%s", point->values[k]);
        }
        fprintf(out, "\t%d\t%s\t%s\t%s\t%s\t%s\t%s\t%d\t%d\t0.03\n", lines[i].n, lines[i].value, lines[i].low,
                lines[i].high, lines[i].value, lines[i].value, lines[i].value, 1000000 * (lines[i].cell + 1),
                lines[i].marked);
    }
    fclose(out);
    assert_int_equal(summary_table_split(text, &p.table, &why), STATUS_OK);
    return p;
}

/* A summary of every cell of the study in each of the environments, 10 rows each. */
static plot_plan full_plan(const study *s, const plot_request *request, size_t environments)
{
    static const char *const names[] = {"11112222", "aaaabbbb", "00000003"};
    const size_t cells = study_cell_count(s), count = cells * (environments ? environments : 1);
    hand *lines = calloc(count, sizeof *lines);
    char(*values)[32] = calloc(count, sizeof *values);
    for (size_t i = 0; i < count; i++) {
        snprintf(values[i], sizeof values[i], "%g", 0.1 + 0.01 * (double)(i + 1));
        lines[i] =
            (hand){(int)(i % cells), 10, 0, environments ? names[i / cells] : "", values[i], values[i], values[i]};
    }
    const plot_plan p = plan_of(s, request, lines, count, environments > 0);
    free(lines);
    free(values);
    return p;
}

static char *base_in(const fixture *f)
{
    static char path[400];
    fixture_path(f, "fig", path);
    return path;
}

static void draw(const fixture *f, plot_plan *p)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    if (plot_figure_write(p, base_in(f), &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
}

/* The error of a figure, whose remedy must contain this text. */
__attribute__((unused)) static void refuse(const fixture *f, plot_plan *p, const char *what, const char *remedy)
{
    diagnostic why = {0};
    assert_int_equal(plot_figure_write(p, base_in(f), &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s' lacks '%s', or '%s' lacks '%s'", why.what, what, why.remedy, remedy);
    plot_plan_free(p);
}

__attribute__((unused)) static bool has_caption(const plot_plan *p, const char *part)
{
    for (size_t i = 0; i < p->caption_count; i++)
        if (strstr(p->captions[i], part))
            return true;
    return false;
}

static const plot_request plain = {.results = "unused"};

static study *study_of(const fixture *f, const char *grid)
{
    char text[2000];
    snprintf(text, sizeof text, "study: test\nscene: scene.yaml\ngrid: %s\nrepetitions: 10\n", grid);
    return fixture_study(f, text);
}
