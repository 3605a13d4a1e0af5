/* Tests of a study's figure as gnuplot draws it: the script, its data, and the whole path from the rows of a run. */
#include "base/file.h"
#include "plot_fixture.h"
#include "scene/model/scene.h"
#include <dirent.h>
#include <fcntl.h>

/* --- the scripts --- */

/* Gnuplot draws the script without a word. */
static void check_drawing(const fixture *f)
{
    char command[1500];
    if (system("gnuplot -e 'set terminal pngcairo' 2>/dev/null") != 0)
        return;
    snprintf(command, sizeof command, "gnuplot -d -e \"format = 'svg'\" '%s.gp' >'%s/said' 2>&1", base_in(f),
             f->folder);
    const int code = system(command);
    char *said = fixture_text(f, "said"), *drawn = fixture_text(f, "fig.svg");
    if (code != 0 || *said)
        fail_msg("gnuplot, status %d: %s", code, said);
    assert_non_null(strstr(drawn, "</svg>"));
    free(said);
    free(drawn);
}

/* The value of a parameter in a cell, as the study has it; *index: its place among the values. */
static const char *value_in(const study *s, size_t cell, const char *path, size_t *index)
{
    for (size_t a = 0; a < s->axis_count; a++) {
        const study_point *point = &s->axes[a].points[ *index = study_cell_point(s, cell, a)];
        for (size_t k = 0; k < point->count; k++)
            if (strcmp(point->paths[k], path) == 0)
                return point->values[k];
    }
    fail_msg("the study has no %s", path);
    return "";
}

/* The numbers of the data are those of full_plan: of row k of the summary first + step k, at the cell's value or place
 * on the axis. Published points have no cell. Returns the number of cells' lines. */
static size_t check_data(const fixture *f, const plot_plan *p, double first, double step, size_t cells)
{
    const bool heat = p->kind == PLOT_HEAT;
    char *data = fixture_text(f, "fig.tsv");
    assert_non_null(strstr(data, heat ? "# cell\tx\ty\tvalue\ttext\tcolor\tn\n" : "# cell\tx\tmedian\tlow\thigh\tn\n"));
    size_t lines = 0, environment = 0;
    for (char *rest = data, *line; (line = strsep(&rest, "\n"));) {
        if (strstr(line, "# environment = aaaabbbb"))
            environment = 1;
        if (line[0] == '#' || line[0] == '\0' || strncmp(line, "NA\t", 3) == 0)
            continue;
        double field[7];
        for (size_t i = 0; i < (heat ? 7 : 6); i++)
            field[i] = strtod(line, &line), line += *line == '\t';
        const size_t cell = (size_t)field[0], row = environment * cells + cell;
        const double wanted = first + step * (double)row;
        for (size_t i = heat ? 3 : 2; i < 5; i++)
            assert_true(fabs(field[i] - wanted) < 1e-9);
        assert_true(field[heat ? 6 : 5] == 10);
        size_t index = 0;
        const char *value = p->x.value < 0 ? value_in(p->s, cell, p->along->name, &index) : NULL;
        const double x = !value ? (double)cell + 1 : p->kind == PLOT_LINES ? strtod(value, NULL) : (double)index;
        assert_true(fabs(field[1] - x) < 1e-9);
        lines++;
    }
    free(data);
    return lines;
}

#define MEDIANS "Medians, n = 10; bars: 95 % interval of the median."
#define TIME_MS "set ylabel 'wall time / ms'"
#define LINE "using 2:3:4:5 with yerrorlines lt "
#define CELL(index) \
    "plot rows index " index " using 2:3:($2-0.5):($2+0.5):($3-0.5):($3+0.5):4 with boxxyerror lc palette notitle"
#define CELL_TEXT(index) "rows index " index " using 2:3:5:6 with labels font "

typedef struct figure {
    const char *grid;
    plot_request request;
    size_t environments, lines; /* of the data, without published ones */
    double first, step;
    const char *parts[12]; /* of the script: what a reader sees, and which columns are drawn */
} figure;

static void check_figure(const fixture *f, const figure *one)
{
    study *s = study_of(f, one->grid);
    plot_plan p = full_plan(s, &one->request, one->environments);
    draw(f, &p);
    assert_int_equal(check_data(f, &p, one->first, one->step, study_cell_count(s)), one->lines);
    char *script = fixture_text(f, "fig.gp");
    for (size_t i = 0; i < sizeof one->parts / sizeof *one->parts && one->parts[i]; i++)
        if (!strstr(script, one->parts[i]))
            fail_msg("the script of %s has no '%s'", one->grid, one->parts[i]);
    assert_non_null(strstr(script, "Rows marked and left out: 0. Other processes: at most 3 % of the machine."));
    assert_non_null(strstr(script, "set linetype 7 lc rgb grey")); /* plots/style.gp */
    free(script);
    check_drawing(f);
    plot_plan_free(&p);
    study_destroy(s);
}

static void lines_have_their_values_axes_and_captions(void **state)
{
    const fixture *f = *state;
    char published[400];
    fixture_path(f, "published.csv", published);
    fixture_write(f, "published.csv", "depth,cpu_s,source\n0,0.13,a book\n1,0.17,a book\n2,0.2,a paper\n");
    const figure figures[] = {
        {"[{render.depth: [0, 1, 2, 4, 8]}]",
         plain,
         0,
         5,
         110,
         10,
         {MEDIANS, "set xrange [-0.4:8.4]", "set yrange [108:152]", "set xlabel 'render.depth'", TIME_MS, LINE "1"}},
        {"[{render.depth: [0, 1, 2]}, {render.threads: [1, 2, 4, 8, 16, 32]}]",
         {.results = "unused", .x = "render.threads", .by = "render.depth"},
         2,
         36,
         110,
         10,
         {MEDIANS, "2 environments, not joined: 11112222, aaaabbbb.", "set logscale x\n", "set yrange [0:477.5]",
          "set key title 'render.depth'", "set title 'environment = 11112222'", "set title 'environment = aaaabbbb'",
          "set xtics ('1' 1, '2' 2, '4' 4, '8' 8, '16' 16, '32' 32)", "with linespoints lt 3 title '2'",
          "rows index 5 " LINE "3 notitle"}},
        {"[{render.depth: [0, 1, 2]}]",
         {.results = "unused", .published = published},
         0,
         3,
         110,
         10,
         {MEDIANS, "Published: cpu_s by depth.", "title 'measured'", "lt 7 pt 6 title 'published: a book'",
          "lt 7 pt 8 title 'published: a paper'", "rows index 0 " LINE "1 notitle",
          "rows index 1 using 2:3 with linespoints lt 7 pt 6 notitle"}},
        {"[{render.depth: [0, 1, 2]}]",
         {.results = "unused", .x = "rays_total", .log = PLOT_LOG_XY},
         0,
         3,
         110,
         10,
         {MEDIANS, "set logscale x\nset xtics (1, 1.5, 2, 2.5, 3)", "set logscale y\nset ytics (105, 110, 115, 120, ",
          "set xlabel 'rays_total / 10⁶'", TIME_MS, LINE "1"}},
        {"[{render.threads: [1, 4, 16, 64]}]",
         {.results = "unused", .log = PLOT_LOG_XY},
         0,
         4,
         110,
         10,
         {"set logscale x\n", "set logscale y\nset ytics (110, 120, 130, 140)",
          "set xtics ('1' 1, '4' 4, '16' 16, '64' 64)", LINE "1"}},
        {"[{render.depth: [0, 1, 2, 4]}, {render.seed: [1, 2, 3, 4, 5, 6, 7, 8]}]",
         {.results = "unused", .by = "render.seed"},
         0,
         32,
         110,
         10,
         {"eval \"set palette defined \".viridis", "set key title 'render.seed'", "set xtics 1\n",
          "lt 1 pt 1 lc palette frac 0.920 title '8'", "rows index 7 " LINE "1 pt 1 lc palette frac 0.920 notitle"}},
        {"[{render.depth: [0, 1, 2]}, {render.schedule: [rows, dynamic]}, {render.accel: [none, bvh]}]",
         plain,
         0,
         12,
         110,
         10,
         {MEDIANS, "set title 'render.schedule = rows'", "set title 'render.schedule = dynamic'",
          "set key title 'render.accel'", "set xtics ('0' 0, '1' 1, '2' 2)", "with linespoints lt 2 title 'bvh'",
          TIME_MS, "set ylabel ''", "rows index 3 " LINE "2 notitle"}},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        check_figure(f, &figures[i]);
}

static void dots_and_heat_maps_have_their_values_axes_and_captions(void **state)
{
    const fixture *f = *state;
    char words[400];
    fixture_path(f, "words.csv", words);
    fixture_write(f, "words.csv",
                  "integrator,cpu_s,source\npath,0.13,a book\nzbuffer,0.1,a book\nwhitted,0.12,a book\n");
    static const char *const one_depth[] = {"render.depth=0"};
    static const char no_interval[] = "Values of n = 10 repetitions; the summary has no interval of this quantity.",
                      interval[] = "Medians, n = 10; 95 % interval of the median, at most ±0 % of the value.";
    const figure figures[] = {
        {"[{render.integrator: [whitted, raycast, zbuffer, path]}]",
         plain,
         0,
         4,
         110,
         10,
         {MEDIANS, "set xrange [-0.5:3.5]", "set xlabel 'render.integrator'", TIME_MS,
          "set xtics ('whitted' 0, 'raycast' 1, 'zbuffer' 2, 'path' 3)",
          "rows index 0 using 2:3:4:5 with yerrorbars lt 1 notitle"}},
        {"[{render.integrator: [whitted, raycast, path]}]",
         {.results = "unused", .published = words},
         0,
         3,
         110,
         10,
         {"Published: cpu_s by integrator.", "with points lt 7 pt 6 title 'published: a book'",
          "rows index 0 using 2:3:4:5 with yerrorbars lt 1 notitle",
          "rows index 1 using 2:3 with points lt 7 pt 6 notitle"}},
        {"[{ball.ior: [1.0, 1.33, 1.5]}, {render.depth: [0, 2, 4]}]",
         {.results = "unused", .log = PLOT_LOG_Y, .y = "rays_total"},
         0,
         9,
         1,
         1,
         {no_interval, "set logscale cb\nset cbtics (1, 2, 5, 10)", "set cblabel 'rays_total / 10⁶'",
          "set xlabel 'render.depth'", "set ylabel 'ball.ior'", "set ytics ('1' 0, '1.33' 1, '1.5' 2)", CELL("0"),
          CELL_TEXT("0")}},
        {"[{ball.ior: [1.0, 1.33, 1.5, 2.4]}, {render.depth: [0, 2, 4]}]",
         plain,
         0,
         12,
         110,
         10,
         {interval, "set cbrange [104.5:225.5]", "set cblabel 'wall time / ms'", "set xlabel 'ball.ior'",
          "set ylabel 'render.depth'", "set xtics ('1' 0, '1.33' 1, '1.5' 2, '2.4' 3)",
          "set ytics ('0' 0, '2' 1, '4' 2)", CELL("0"), CELL_TEXT("0")}},
        {"[{ball.ior: [1.0, 1.33, 1.5]}, {render.depth: [0, 2, 4]}, {render.integrator: [whitted, raycast]}]",
         plain,
         0,
         18,
         110,
         10,
         {interval, "set title 'integrator = whitted'", "set title 'integrator = raycast'", CELL("0"), CELL("1"),
          CELL_TEXT("1")}},
        {"[{ball.ior: {from: 1, to: 2, steps: 41}}, {render.depth: [0, 2, 4]}, {render.integrator: [whitted, "
         "raycast]}]",
         plain,
         0,
         246,
         0.11,
         0.01,
         {"set cblabel 'wall time / s'", "set xtics rotate by 90 right", "set title 'render.integrator = raycast'",
          CELL("0") "\n", CELL("1") "\n"}},
        {"[{render.depth: [0, 1, 2]}, {render.threads: [1, 2, 4]}, {render.tile: [8, 16, 32]}]",
         {.results = "unused", .where = one_depth, .where_count = 1, .y = "rays_total"},
         0,
         9,
         1,
         1,
         {no_interval, "Only cells with render.depth=0.", "set cbrange [0.6:9.4]", "set xlabel 'render.tile / px'",
          "set ylabel 'render.threads'", CELL("0"), CELL_TEXT("0")}},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        check_figure(f, &figures[i]);
}

/* --- the whole path --- */

static void a_script_quotes_what_it_shows(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\ntitle: \"it's `x` {a_b} \\\\ \\\"q\\\"\"\nscene: scene.yaml\n"
                                "grid: [{render.depth: [0, 1]}]\nrepetitions: 2\n");
    diagnostic why = {0};
    fixture_run(f, s);
    const plot_request r = {.results = f->results};
    assert_int_equal(study_plot_write(s, &r, base_in(f), &why), STATUS_OK);
    char *script = fixture_text(f, "fig.gp");
    assert_non_null(strstr(script, "'it''s `x` {a_b} \\ \"q\"'"));
    assert_null(strstr(script, "load "));
    assert_null(strstr(script, f->folder));
    free(script);
    study_destroy(s);
}

static size_t count_files(const fixture *f)
{
    size_t count = 0;
    DIR *folder = opendir(f->folder);
    assert_non_null(folder);
    while (readdir(folder))
        count++;
    closedir(folder);
    return count;
}

/* A gnuplot that fails leaves no file, also in a process without a standard input, whose number the file then has. */
static void a_failed_figure_leaves_nothing(void **state)
{
    const fixture *f = *state;
    char bin[400], path[4096];
    const char *usual = getenv("PATH");
    fixture_write(f, "gnuplot", "#!/bin/sh\nexit 1\n");
    fixture_write(f, "fig.gp", "plot x\n");
    fixture_path(f, "gnuplot", bin);
    assert_int_equal(chmod(bin, 0755), 0);
    snprintf(path, sizeof path, "%s:%s", f->folder, usual);
    char *before = strdup(usual);
    assert_int_equal(setenv("PATH", path, 1), 0);
    const size_t files = count_files(f);
    const int input = fcntl(0, F_DUPFD_CLOEXEC, 3);
    close(0);
    diagnostic why = {0};
    const status code = study_plot_draw(base_in(f), "png", 60, &why);
    if (input >= 0) {
        assert_int_equal(dup2(input, 0), 0);
        close(input);
    }
    setenv("PATH", before, 1);
    free(before);
    assert_int_equal(code, STATUS_FAILURE);
    assert_non_null(strstr(why.what, "gnuplot failed"));
    assert_int_equal(count_files(f), files);
}

static void a_sheet_needs_images(void **state)
{
    const fixture *f = *state;
    study *s = study_of(f, "[{render.depth: [0, 1]}]");
    diagnostic why = {0};
    fixture_run(f, s);
    const plot_request r = {.results = f->results, .images = true};
    assert_int_equal(study_plot_write(s, &r, base_in(f), &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "keep: {image: on}"));
    study_destroy(s);
    s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\nrepetitions: 10\n"
                         "keep: {image: on}\n");
    fixture_run(f, s);
    assert_int_equal(study_plot_write(s, &r, base_in(f), &why), STATUS_OK);
    char *script = fixture_text(f, "fig.gp");
    assert_non_null(strstr(script, "here.'results/test/images/0001.png'"));
    assert_non_null(strstr(script, "'render.depth = 1'"));
    char caption[80];
    snprintf(caption, sizeof caption, "2 images of %d x %d pixels.", (int)s->base->render.width,
             (int)s->base->render.height);
    assert_non_null(strstr(script, caption));
    free(script);
    check_drawing(f);
    study_destroy(s);
}

/* The images of a cell are the same in every environment, and so is a missing one. */
static void a_sheet_counts_a_missing_image_once(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1, 2]}]\nrepetitions: 1\n"
                                "keep: {image: on}\n");
    const plot_request r = {.results = f->results, .images = true};
    const hand lines[] = {{0, 1, 0, "11112222", "1", "1", "1"}, {0, 1, 0, "aaaabbbb", "1", "1", "1"},
                          {1, 1, 0, "11112222", "1", "1", "1"}, {1, 1, 0, "aaaabbbb", "1", "1", "1"},
                          {2, 1, 0, "11112222", "1", "1", "1"}, {2, 1, 0, "aaaabbbb", "1", "1", "1"}};
    fixture_run(f, s);
    for (int cell = 0; cell < 2; cell++) {
        char path[600];
        snprintf(path, sizeof path, "%s/test/images/%04d.png", f->results, cell);
        assert_int_equal(remove(path), 0);
    }
    plot_plan p = plan_of(s, &r, lines, 6, true);
    assert_int_equal(plot_sheet_write(&p, base_in(f), NULL), STATUS_OK);
    plot_plan_free(&p);
    char *script = fixture_text(f, "fig.gp");
    assert_non_null(strstr(script, "2 of 3 cells have no kept image."));
    free(script);
    study_destroy(s);
}

#define CASE(function) cmocka_unit_test_setup_teardown(function, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(lines_have_their_values_axes_and_captions),
        CASE(dots_and_heat_maps_have_their_values_axes_and_captions),
        CASE(a_script_quotes_what_it_shows),
        CASE(a_sheet_needs_images),
        CASE(a_sheet_counts_a_missing_image_once),
        CASE(a_failed_figure_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
