/* Tests of the plan of a study's figure: kind, lines and panels, linked parameters, environments, scales, captions. The
 * summary is made by hand. */
#include "plot_fixture.h"

/* --- kinds --- */

/* Panels are within the page and do not overlap. */
static void check_panels(const plot_plan *p)
{
    for (size_t i = 0; i < p->panel_count; i++) {
        const plot_panel *one = &p->panels[i];
        assert_true(!one->used || (0 <= one->left && one->left < one->right && one->right <= 1 && 0 <= one->bottom &&
                                   one->bottom < one->top && one->top <= 1));
        for (size_t k = 0; k < i && one->used; k++) {
            const plot_panel *other = &p->panels[k];
            assert_true(!other->used || one->right <= other->left || other->right <= one->left ||
                        one->top <= other->bottom || other->top <= one->bottom);
        }
    }
}

static void check_kind(const fixture *f, const char *grid, plot_kind kind, const char *along, const char *by,
                       size_t panels)
{
    study *s = study_of(f, grid);
    plot_plan p = full_plan(s, &plain, 0);
    draw(f, &p);
    assert_int_equal(p.kind, kind);
    assert_string_equal(p.along ? p.along->name : "", along);
    assert_string_equal(p.by ? p.by->name : "", by);
    assert_int_equal(p.panel_count, panels);
    check_panels(&p);
    plot_plan_free(&p);
    study_destroy(s);
}

static void the_grid_gives_the_kind(void **state)
{
    const fixture *f = *state;
    check_kind(f, "[{render.depth: [0, 1, 2]}]", PLOT_LINES, "render.depth", "", 1);
    check_kind(f, "[{render.depth: [0, 1]}]", PLOT_LINES, "render.depth", "", 1);
    check_kind(f, "[{render.depth: [0, 1, 2]}, {render.schedule: [rows, tiles]}]", PLOT_LINES, "render.depth",
               "render.schedule", 1);
    check_kind(f, "[{render.depth: [0, 1, 2]}, {ball.ior: [1.1, 1.2, 1.3, 1.4]}]", PLOT_HEAT, "ball.ior", "", 1);
    check_kind(f, "[{render.depth: [0, 1]}, {ball.ior: [1.1, 1.2]}]", PLOT_LINES, "ball.ior", "render.depth", 1);
    check_kind(f, "[{render.schedule: [rows, tiles, dynamic]}]", PLOT_DOTS, "render.schedule", "", 1);
    check_kind(f, "[{render.schedule: [rows, tiles, dynamic]}, {render.depth: [1, 2]}]", PLOT_DOTS, "render.schedule",
               "render.depth", 1);
    check_kind(
        f, "[{render.depth: [0, 1, 2]}, {render.schedule: [rows, tiles, dynamic]}, {render.shadows: [off, opaque]}]",
        PLOT_LINES, "render.depth", "render.schedule", 2);
}

static void many_panels_are_within_the_page(void **state)
{
    const fixture *f = *state;
    study *s =
        study_of(f, "[{render.depth: [0, 1, 2, 3]}, {render.samples: [1, 4, 9, 16]}, {render.seed: [1, 2, 3, 4]}, "
                    "{render.tile: [8, 16, 32, 64]}]");
    plot_plan p = full_plan(s, &plain, 0);
    draw(f, &p);
    assert_true(p.panel_count >= 6);
    check_panels(&p);
    plot_plan_free(&p);
    study_destroy(s);
}

static void parameters_set_together_count_once(void **state)
{
    const fixture *f = *state;
    check_kind(
        f,
        "[{name: a, points: [{render.depth: 1, render.width: 10, render.shadows: off}, {render.depth: 2, render.width: "
        "20, render.shadows: off}, {render.depth: 3, render.width: 40, render.shadows: opaque}]}]",
        PLOT_LINES, "render.depth", "", 1);
    /* Two independent ones, and a third that has a value for each pair */
    check_kind(f,
               "[{name: a, points: [{render.seed: 1, render.depth: 1, render.schedule: rows}, {render.seed: 2, "
               "render.depth: 2, "
               "render.schedule: rows}, {render.seed: 3, render.depth: 3, render.schedule: rows}, {render.seed: 4, "
               "render.depth: 1, render.schedule: tiles}, {render.seed: 5, render.depth: 2, render.schedule: tiles}, "
               "{render.seed: 6, render.depth: 3, render.schedule: tiles}]}]",
               PLOT_LINES, "render.depth", "render.schedule", 1);
    /* The one of more values determines the other, a number or not */
    check_kind(
        f,
        "[{name: a, points: [{render.depth: 1, render.schedule: rows}, {render.depth: 1, render.schedule: tiles}, "
        "{render.depth: 2, render.schedule: dynamic}]}]",
        PLOT_DOTS, "render.schedule", "", 1);
    /* Not determined by each other: both count */
    check_kind(
        f,
        "[{name: a, points: [{render.depth: 1, render.schedule: rows}, {render.depth: 2, render.schedule: rows}, "
        "{render.depth: 3, render.schedule: tiles}, {render.depth: 1, render.schedule: tiles}]}]",
        PLOT_LINES, "render.depth", "render.schedule", 1);
}

static void the_user_chooses(void **state)
{
    const fixture *f = *state;
    study *s =
        study_of(f, "[{render.depth: [0, 1, 2]}, {ball.ior: [1.1, 1.2, 1.3]}, {render.schedule: [rows, tiles]}]");
    const char *const where[] = {"ball.ior=1.20", "render.schedule=tiles"};
    const plot_request r = {.x = "render.schedule", .by = "render.depth", .y = "rays_total"};
    plot_plan p = full_plan(s, &r, 0);
    draw(f, &p);
    assert_int_equal(p.kind, PLOT_DOTS);
    assert_string_equal(p.by->name, "render.depth");
    assert_int_equal(p.panel_count, 3);
    assert_string_equal(p.y.unit, "10⁶");
    assert_true(has_caption(&p, "no interval of this"));
    plot_plan_free(&p);
    const plot_request part = {.where = where, .where_count = 2};
    p = full_plan(s, &part, 0);
    draw(f, &p);
    assert_int_equal(p.kind, PLOT_LINES);
    assert_int_equal(p.point_count, 3);
    assert_true(has_caption(&p, "Only cells with ball.ior=1.20, render.schedule=tiles."));
    plot_plan_free(&p);
    const plot_request quantity = {.x = "rays_total", .by = "render.schedule"};
    p = full_plan(s, &quantity, 0);
    draw(f, &p);
    assert_string_equal(p.x_label, "rays_total / 10⁶");
    plot_plan_free(&p);
    study_destroy(s);
}

/* Twelve lines can be distinguished: they need no panels of their own. */
static void twelve_lines_share_a_panel(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.schedule: [rows, tiles]}, {render.seed: {from: 1, to: 12, steps: 12}}]");
    const plot_request r = {.x = "render.schedule"};
    plot_plan p = full_plan(s, &r, 0);
    draw(f, &p);
    assert_string_equal(p.by->name, "render.seed");
    assert_int_equal(p.panel_count, 1);
    plot_plan_free(&p);
    study_destroy(s);
}

static void wrong_choices_have_remedies(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.depth: [0, 1, 2]}, {render.schedule: [rows, tiles]}]");
    static const char *const nowhere[] = {"render.depth=7"}, *const no_path[] = {"render.width=7"},
                             *const no_condition[] = {"render.depth"};
    const struct {
        plot_request request;
        const char *what, *remedy;
    } wrong[] = {
        {{.y = "wal_s"}, "no column of numbers 'wal_s'", "did you mean"},
        {{.y = "render.depth"}, "no column of numbers", ""},
        {{.x = "render.dept"}, "no parameter 'render.dept'", "render.depth"},
        {{.by = "schedule"}, "no parameter 'schedule'", "render.schedule"},
        {{.x = "render.depth", .by = "render.depth"}, "the x axis already", "another"},
        {{.where = nowhere, .where_count = 1}, "no cell has render.depth=7", "0, 1, 2"},
        {{.where = no_path, .where_count = 1}, "no parameter 'render.width'", "render.depth"},
        {{.where = no_condition, .where_count = 1}, "not a condition", "PATH=VALUE"},
        {{.log = PLOT_LOG_X}, "positive values", "--where"},
        {{.x = "render.schedule", .log = PLOT_LOG_X}, "no scale", "--log y"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        plot_plan p = full_plan(s, &wrong[i].request, 0);
        refuse(f, &p, wrong[i].what, wrong[i].remedy);
    }
    study_destroy(s);
}

/* --- environments --- */

/* Every block of the data has cells of one environment: the values of full_plan distinguish them. */
static void check_blocks(const fixture *f, size_t cells)
{
    char *data = fixture_text(f, "fig.tsv");
    const bool heat = strstr(data, "color") != NULL;
    long known = -1;
    size_t lines = 0;
    for (char *rest = data, *line; (line = strsep(&rest, "\n"));) {
        double x, value, up;
        int cell;
        if (line[0] == '\0')
            known = -1;
        if (line[0] == '#' || line[0] == '\0')
            continue;
        char *copy = strdup(line);
        const int fields = sscanf(copy, "%d\t%lf\t%lf\t%lf", &cell, &x, &up, &value);
        free(copy);
        assert_true(fields >= 3);
        const double seen = heat ? value : up; /* in ms; of full_plan: 100 + 10 (i + 1) */
        const long environment = lround((seen - 100) / 10 - 1) / (long)cells;
        assert_int_equal(lround((seen - 100) / 10 - 1) % (long)cells, cell);
        if (known >= 0)
            assert_int_equal(environment, known);
        known = environment;
        lines++;
    }
    free(data);
    assert_int_equal(lines, 3 * cells);
}

static void environments_are_never_joined(void **state)
{
    const fixture *f = *state;
    static const char *const grids[] = {
        "[{render.depth: [0, 1, 2]}]",
        "[{render.depth: [0, 1, 2]}, {render.schedule: [rows, tiles]}]",
        "[{render.depth: [0, 1, 2]}, {ball.ior: [1.1, 1.2, 1.3]}]",
        "[{render.schedule: [rows, tiles, dynamic]}]",
        "[{name: a, points: [{render.depth: 1, render.width: 10}, {render.depth: 2, render.width: 20}]}]",
    };
    const plot_request requests[] = {plain, {.by = "render.depth"}, {.by = "render.schedule"}, {.x = "render.depth"}};
    for (size_t g = 0; g < sizeof grids / sizeof *grids; g++) {
        study *s = study_of(f, grids[g]);
        for (size_t r = 0; r < sizeof requests / sizeof *requests; r++) {
            plot_plan p = full_plan(s, &requests[r], 3);
            diagnostic why = {0};
            if (plot_figure_write(&p, base_in(f), &why) == STATUS_OK) { /* not every grid has these parameters */
                check_blocks(f, study_cell_count(s));
                assert_true(has_caption(&p, "3 environments, not joined: 11112222, aaaabbbb, 00000003."));
            } else {
                assert_int_not_equal(r, 0);
            }
            plot_plan_free(&p);
        }
        study_destroy(s);
    }
}

static void one_environment_is_named(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.depth: [0, 1, 2]}]");
    const hand lines[] = {
        {0, 9, 0, "0000beef", "1", "1", "1"}, {1, 0, 0, "NA", "NA", "NA", "NA"}, {2, 9, 0, "0000beef", "1", "1", "1"}};
    plot_plan p = plan_of(s, &plain, lines, 3, true);
    draw(f, &p);
    assert_null(p.by);
    assert_true(has_caption(&p, "Environment: 0000beef."));
    assert_true(has_caption(&p, "1 of 3 cells have no value of wall_s."));
    plot_plan_free(&p);
    study_destroy(s);
}

/* --- captions and scales --- */

static void captions_say_interval_or_range(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.depth: [0, 1, 2]}]");
    const struct {
        hand lines[3];
        const char *caption;
    } cases[] = {
        {{{0, 10, 0, "", "1", "0.9", "1.1"}, {1, 12, 0, "", "1", "0.9", "1.1"}, {2, 10, 0, "", "1", "0.9", "1.1"}},
         "Medians, n = 10 to 12; bars: 95 % interval of the median."},
        {{{0, 3, 0, "", "1", "NA", "NA"}, {1, 3, 0, "", "1", "NA", "NA"}, {2, 3, 0, "", "1", "NA", "NA"}},
         "Medians, n = 3; bars: range of the repetitions; fewer than 6 give no interval."},
        {{{0, 3, 0, "", "1", "NA", "NA"}, {1, 8, 0, "", "1", "0.9", "1.1"}, {2, 3, 0, "", "1", "NA", "NA"}},
         "95 % interval of the median if n ≥ 6, otherwise the range."},
        {{{0, 1, 0, "", "1", "NA", "NA"}, {1, 1, 0, "", "1", "NA", "NA"}, {2, 1, 0, "", "1", "NA", "NA"}},
         "n = 1: single measurements"},
        {{{0, 9, 2, "", "1", "1", "1"}, {1, 9, 1, "", "1", "1", "1"}, {2, 9, 0, "", "1", "1", "1"}},
         "Rows marked and left out: 3. Other processes: at most 3 % of the machine."},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        plot_plan p = plan_of(s, &plain, cases[i].lines, 3, false);
        draw(f, &p);
        char all[2000] = "";
        for (size_t k = 0; k < p.caption_count; k++)
            snprintf(all + strlen(all), sizeof all - strlen(all), "%s ", p.captions[k]);
        if (!strstr(all, cases[i].caption))
            fail_msg("'%s' is not in '%s'", cases[i].caption, all);
        plot_plan_free(&p);
    }
    const hand none[] = {{0, 0, 0, "", "NA", "NA", "NA"}};
    plot_plan p = plan_of(s, &plain, none, 1, false);
    refuse(f, &p, "no cell of test has a value of", "");
    study_destroy(s);
}

/* "busy_s_max" is a time, whose unit follows its name. */
static void times_are_named_without_their_unit(void **state)
{
    (void)state;
    static const char *const names[][2] = {
        {"busy_s_max", "busy max"}, {"build_s", "build"}, {"wall_s_mean", "wall time, mean"}, {"cpu_s", "CPU time"}};
    const study none = {.name = (char *)"test"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text[100];
        plot_plan p = {.s = &none};
        plot_quantity q;
        snprintf(text, sizeof text, "cell\t%s\n0\t1.5\n", names[i][0]);
        char *table = strdup(text);
        assert_int_equal(summary_table_split(table, &p.table, NULL), STATUS_OK);
        assert_int_equal(plot_quantity_find(&p, "--y", names[i][0], &q, NULL), STATUS_OK);
        assert_string_equal(q.label, names[i][1]);
        assert_string_equal(q.unit, "s");
        summary_table_free(&p.table);
    }
}

/* Labels such as 0.0315 have six letters of 7 pixels. */
static void labels_below_1_have_room(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.depth: [0, 1, 2]}]");
    const plot_request r = {.y = "others_fraction"};
    plot_plan p = full_plan(s, &r, 0);
    draw(f, &p);
    assert_true(p.y.from > 0 && p.y.to < 0.05);
    assert_true(p.panels[0].left * p.width > 46 + 6 * 7 - 0.5);
    plot_plan_free(&p);
    study_destroy(s);
}

/* Cells of a heat map that are 36 pixels wide have room for their numbers. */
static void cells_of_36_pixels_have_numbers(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{ball.ior: {from: 1, to: 2, steps: 15}}, {render.depth: [0, 2, 4]}, "
                           "{render.schedule: [columns, rows, tiles, dynamic]}, {render.shadows: [off, opaque]}]");
    plot_plan p = full_plan(s, &plain, 0);
    draw(f, &p);
    assert_true(p.kind == PLOT_HEAT && p.panel_count == 8);
    const double width = (p.panels[0].right - p.panels[0].left) * p.width / 15;
    assert_true(width >= 36 && width < 37);
    char *script = fixture_text(f, "fig.gp");
    assert_int_equal(fixture_count(script, " with labels font "), 8);
    free(script);
    plot_plan_free(&p);
    study_destroy(s);
}

static void scales_follow_the_values(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.threads: [1, 2, 4, 8, 16]}]");
    plot_plan p = full_plan(s, &plain, 0);
    draw(f, &p);
    assert_true(p.x.log);
    assert_false(p.y.log);
    assert_string_equal(p.y.unit, "ms");
    plot_plan_free(&p);
    const plot_request none = {.log = PLOT_LOG_NONE}, both = {.log = PLOT_LOG_XY};
    p = full_plan(s, &none, 0);
    draw(f, &p);
    assert_false(p.x.log || p.y.log);
    plot_plan_free(&p);
    p = full_plan(s, &both, 0);
    draw(f, &p);
    assert_true(p.x.log && p.y.log);
    plot_plan_free(&p);
    study_destroy(s);
    s = study_of(f, "[{render.depth: [1, 2, 3, 4, 5, 6, 7, 8]}]");
    p = full_plan(s, &plain, 0);
    draw(f, &p);
    assert_false(p.x.log);
    plot_plan_free(&p);
    study_destroy(s);
    s = study_of(f, "[{render.lambda_nm: [500, 550, 600]}]"); /* a name with its unit needs no other */
    p = full_plan(s, &plain, 0);
    draw(f, &p);
    assert_string_equal(p.x_label, "render.lambda_nm");
    plot_plan_free(&p);
    study_destroy(s);
    s = study_of(f, "[{render.depth: [30, 31, 32, 33, 34]}]"); /* whole numbers near each other have a tic each */
    p = full_plan(s, &plain, 0);
    draw(f, &p);
    char *script = fixture_text(f, "fig.gp");
    assert_non_null(strstr(script, "set xtics 1\n"));
    free(script);
    plot_plan_free(&p);
    study_destroy(s);
}

static void published_numbers_have_the_unit_of_the_axis(void **state)
{
    const fixture *f = *state;
    char path[400];
    study *s = study_of(f, "[{render.depth: [0, 1, 2]}]");
    fixture_path(f, "published.csv", path);
    fixture_write(f, "published.csv",
                  "depth,cpu_s,source,machine\n0,0.1,\"a, b\",old\n1,0.2,\"a, b\",old\n9,0.3,c,old\n");
    const plot_request r = {.published = path};
    plot_plan p = full_plan(s, &r, 0);
    draw(f, &p);
    assert_int_equal(p.published.count, 3);
    assert_int_equal(p.published.series_count, 2);
    assert_true(fabs(p.published.y[1] - 200) < 1e-9); /* ms, as the measured values */
    assert_true(p.x.to > 9);
    assert_true(has_caption(&p, "Published: cpu_s by depth, machine: old."));
    plot_plan_free(&p);
    study_destroy(s);
    /* The published blocks of the data follow the measured ones, here of one value and of two. */
    s = study_of(f, "[{render.depth: [0, 1]}, {render.threads: [1, 2]}]");
    static const hand lines[] = {
        {0, 10, 0, "", "0.1", "0.1", "0.1"}, {1, 10, 0, "", "0.1", "0.1", "0.1"}, {3, 10, 0, "", "0.1", "0.1", "0.1"}};
    const plot_request by = {.published = path, .x = "render.depth"};
    p = plan_of(s, &by, lines, 3, false);
    draw(f, &p);
    char *script = fixture_text(f, "fig.gp"), *data = fixture_text(f, "fig.tsv");
    assert_non_null(strstr(script, "rows index 2 using 2:3 with linespoints lt 7 pt 6 notitle"));
    assert_non_null(strstr(script, "rows index 3 using 2:3 with linespoints lt 7 pt 8 notitle"));
    assert_int_equal(fixture_count(data, "\n\n\n"), 3);
    free(script);
    free(data);
    plot_plan_free(&p);
    study_destroy(s);
    s = study_of(f, "[{render.depth: [0, 1, 2]}]");
    fixture_write(f, "published.csv", "threads,cpu_s\n0,0.1\n");
    p = full_plan(s, &r, 0);
    refuse(f, &p, "no column for 'render.depth'", "threads, cpu_s");
    fixture_write(f, "published.csv", "cpu_s,depth\n0.3,1\n"); /* in any order of columns */
    p = full_plan(s, &r, 0);
    draw(f, &p);
    assert_true(p.published.count == 1 && fabs(p.published.y[0] - 300) < 1e-9 && p.published.x[0] == 1);
    plot_plan_free(&p);
    fixture_write(f, "published.csv", "depth,cpu_s\nx,NA\n");
    p = full_plan(s, &r, 0);
    refuse(f, &p, "no row has numbers", "CSV");
    study_destroy(s);
}

static void six_sources_of_published_numbers_are_shown(void **state)
{
    const fixture *f = *state;
    char path[400];
    study *s = study_of(f, "[{render.depth: [0, 1, 2]}]");
    fixture_path(f, "published.csv", path);
    fixture_write(f, "published.csv", "depth,cpu_s,source\n0,1,a\n0,2,b\n0,3,c\n0,4,d\n0,5,e\n0,6,f\n1,6,f\n");
    const plot_request r = {.published = path};
    plot_plan p = full_plan(s, &r, 0);
    draw(f, &p);
    assert_true(p.published.count == 7 && p.published.series_count == 6);
    plot_plan_free(&p);
    fixture_write(f, "published.csv", "depth,cpu_s,source\n0,1,a\n0,2,b\n0,3,c\n0,4,d\n0,5,e\n0,6,f\n0,7,g\n");
    p = full_plan(s, &r, 0);
    refuse(f, &p, "more than 6 values", "at most six");
    study_destroy(s);
}

#define CASE(function) cmocka_unit_test_setup_teardown(function, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(the_grid_gives_the_kind),
        CASE(many_panels_are_within_the_page),
        CASE(parameters_set_together_count_once),
        CASE(the_user_chooses),
        CASE(wrong_choices_have_remedies),
        CASE(environments_are_never_joined),
        CASE(one_environment_is_named),
        CASE(captions_say_interval_or_range),
        CASE(scales_follow_the_values),
        CASE(published_numbers_have_the_unit_of_the_axis),
        CASE(six_sources_of_published_numbers_are_shown),
        CASE(twelve_lines_share_a_panel),
        cmocka_unit_test(times_are_named_without_their_unit),
        CASE(labels_below_1_have_room),
        CASE(cells_of_36_pixels_have_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
