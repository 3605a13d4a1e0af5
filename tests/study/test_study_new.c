/* Tests of a new study's text, and of decimal commas in lists of an axis. */
#include "scene/model/open.h"
#include "scene/model/scene.h"
#include "study/plan/new_study.h"
#include "study_fixture.h"

/* A new study's text: it reads as what was given, each parameter has its meaning, and an error is located at
 * the option that causes it. */

static const char *const sets[] = {"render.samples=1"};

static new_study_order order_of(const char *const *axes, size_t count)
{
    return (new_study_order){.scene = "experiments/scenes/rod.yaml",
                             .axes = axes,
                             .sets = sets,
                             .axis_count = count,
                             .set_count = 1,
                             .repetitions = 6,
                             .warmups = 1};
}

static scene *rod(void)
{
    scene *s = NULL;
    assert_int_equal(scene_read("experiments/scenes/rod.yaml", &s, NULL), STATUS_OK);
    return s;
}

static const char *line_of(const char *text, const char *line)
{
    const char *at = strstr(text, line);
    if (!at || (at > text && at[-1] != '\n'))
        fail_msg("no line '%s' in:\n%s", line, text);
    return at + strlen(line);
}

static void the_text_reads_as_what_was_given(void **state)
{
    (void)state;
    static const char *const axes[] = {"render.depth=0,1,2", "liquid.ior=1..1.5:3"};
    const new_study_order order = order_of(axes, 2);
    scene *s = rod();
    char *text = NULL;
    study *read = NULL;
    assert_int_equal(new_study_compose(&order, s, &text, &read, NULL), STATUS_OK);
    assert_string_equal(read->name, "rod-depth");
    assert_int_equal(study_cell_count(read), 9);
    assert_int_equal(read->base->render.samples, 1);
    const char *at = line_of(text, "set: # in all cells\n  render.samples: 1\n\n");
    at = line_of(at, "grid: # 9 cells; the last axis runs fastest\n");
    /* the meaning, the range and the unit of each parameter precede it */
    at = line_of(
        at, "  # recursion depth; 0: camera rays only; unlimited: random paths only (integer 0..64, or unlimited)\n"
            "  - {render.depth: [0, 1, 2]}\n");
    assert_non_null(strstr(at, "(number > 0, at most 1000000000)\n  - {liquid.ior: {from: 1, to: 1.5, steps: 3}}\n"));
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1) { /* comments end between words */
        const size_t length = strcspn(line, "\n");
        assert_true(strncmp(line, "  # ", 4) != 0 || (length <= 100 && line[length - 1] != ' '));
    }
    assert_null(strstr(text, "treated as a perfec\n"));
    free(text);
    study_destroy(read);
    scene_destroy(s);
}

/* YAML's own characters in values are quoted. */
static void values_may_have_any_character(void **state)
{
    (void)state;
    char *path = "cell \"a\", \\b: 1", *written = NULL;
    char *values[] = {path, "plain"};
    const new_axis axis = {.path = "background.image", .values = values, .count = 2};
    scene *s = rod();
    const new_study made = {.name = "t", .scene_path = "t.yaml", .base = s, .axes = &axis, .axis_count = 1};
    size_t size = 0;
    FILE *out = open_memstream(&written, &size);
    new_study_write(&made, out);
    assert_int_equal(fclose(out), 0);
    assert_non_null(strstr(written, "  - {background.image: [\"cell \\\"a\\\", \\\\b: 1\", plain]}\n"));
    free(written);
    scene_destroy(s);
}

/* Lines of values are as long as those of comments. */
static void long_lists_are_wrapped(void **state)
{
    (void)state;
    enum { VALUES = 60 };
    char texts[VALUES][16], *values[VALUES], *written = NULL;
    for (size_t i = 0; i < VALUES; i++) {
        snprintf(texts[i], sizeof texts[i], "1.%0*zu", (int)(3 + i % 7), i);
        values[i] = texts[i];
    }
    const new_axis axis = {.path = "liquid.ior", .values = values, .count = VALUES};
    scene *s = rod();
    const new_study made = {.name = "t", .scene_path = "t.yaml", .base = s, .axes = &axis, .axis_count = 1};
    size_t size = 0, lines = 0;
    FILE *out = open_memstream(&written, &size);
    new_study_write(&made, out);
    assert_int_equal(fclose(out), 0);
    for (const char *line = strstr(written, "  - {liquid.ior: ["); line && *line && *line != '\n';) {
        const size_t length = strcspn(line, "\n");
        assert_true(length <= 101 && (lines == 0 || strncmp(line, "      1.", 8) == 0)); /* 100, and a comma */
        lines++;
        line += length + 1;
        if (strncmp(line, "      ", 6) != 0)
            break;
    }
    assert_in_range(lines, 4, 8);
    free(written);
    scene_destroy(s);
}

/* Whatever the axis held before. */
static void a_refused_axis_is_empty(void **state)
{
    (void)state;
    new_axis axis;
    memset(&axis, 0x5a, sizeof axis);
    assert_int_equal(new_axis_parse("render.depth", &axis, NULL), STATUS_BAD_INPUT);
    assert_true(!axis.path && !axis.values && axis.count == 0);
    new_axis_release(&axis);
    memset(&axis, 0x5a, sizeof axis);
    assert_int_equal(new_axis_parse("render.depth=1,2", &axis, NULL), STATUS_OK);
    assert_true(axis.count == 2 && !axis.range);
    new_axis_release(&axis);
}

static void errors_are_located_at_their_option(void **state)
{
    (void)state;
    static const struct {
        const char *axes[2], *name, *where;
    } cases[] = {
        {{"render.depth=0,1", "render.depth=2,3"}, NULL, "--axis render.depth=2,3"},
        {{"render.depth=0,1", "liquid.ior=1,x"}, NULL, "--axis liquid.ior=1,x"},
        {{"render.depth=0,0", "liquid.ior=1,2"}, NULL, "--axis render.depth=0,0"},
        {{"render.depth=0,1", "liquid.ior=1,2"}, "a b", "--name a b"},
        {{"render.depth=0,1", "liquid.ior"}, NULL, "--axis liquid.ior"},
        {{"render.depth=0,1", "liquid.ior=1..2:0"}, NULL, "--axis liquid.ior=1..2:0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        new_study_order order = order_of(cases[i].axes, 2);
        order.name = cases[i].name;
        scene *s = rod();
        char *text = NULL;
        study *read = NULL;
        diagnostic why = {.line = 0};
        assert_int_equal(new_study_compose(&order, s, &text, &read, &why), STATUS_BAD_INPUT);
        assert_string_equal(why.file, cases[i].where);
        assert_int_equal(why.line, 0);
        assert_true(!text && !read);
        scene_destroy(s);
    }
}

static void an_error_in_a_setting_is_located_at_its_option(void **state)
{
    (void)state;
    static const char *const axes[] = {"render.depth=0,1"}, *const wrong[] = {"render.samples=1", "render.samples=x"};
    new_study_order order = order_of(axes, 1);
    order.sets = wrong, order.set_count = 2;
    scene *s = rod();
    char *text = NULL;
    study *read = NULL;
    diagnostic why = {.line = 0};
    assert_int_equal(new_study_compose(&order, s, &text, &read, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, "--set render.samples=x");
    scene_destroy(s);
}

/* Decimal commas in lists of an axis. */

typedef struct example {
    const char *list;
    int column;         /* 0: no note */
    const char *remedy; /* NULL: no note */
} example;

static void read_with(const char *list, study **out)
{
    char text[400];
    diagnostic why = {0};
    snprintf(text, sizeof text, "study: t\nscene: experiments/scenes/rod.yaml\ngrid:\n  - {lamp.intensity: %s}\n",
             list);
    if (study_read_text("t.study", text, strlen(text), out, &why) != STATUS_OK)
        fail_msg("%s: %s", list, why.what);
}

static void probable_slips_have_a_note(void **state)
{
    (void)state;
    static const example examples[] = {
        {"[1.3, 1,4]", 28, "did you mean 1.4?"}, /* by blanks, and by the order */
        {"[1.3, 1,4, 1.5]", 28, "did you mean 1.4?"},
        {"[1.3,1,4,1.5]", 27, "did you mean 1.4?"}, /* by the order alone */
        {"[1.3, 1, 4, 1.5]", 28, "did you mean 1.4?"},
        {"[1.0, 2,5, 3]", 28, "did you mean 2.5?"},     /* by blanks alone */
        {"[1, 50, 1.75, 2]", 23, "did you mean 1.50?"}, /* at the beginning */
        {"[2.5, 2,25, 1]", 28, "did you mean 2.25?"},   /* decreasing */
        {"[1.3, 1, 07]", 28, "did you mean 1.07?"},
        {"[0,1,5,2.5]", 25, "did you mean 1.5?"}, /* from 0 */
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        study *s;
        read_with(examples[i].list, &s);
        if (s->note_count != 1)
            fail_msg("%s: %zu notes", examples[i].list, s->note_count);
        assert_int_equal(s->notes[0].line, 4);
        if (s->notes[0].column != examples[i].column || strcmp(s->notes[0].note.remedy, examples[i].remedy) != 0)
            fail_msg("%s: column %ld, %s", examples[i].list, s->notes[0].column, s->notes[0].note.remedy);
        assert_string_equal(s->notes[0].note.place, "lamp.intensity");
        study_destroy(s);
    }
}

static void two_slips_have_two_notes(void **state)
{
    (void)state;
    study *s;
    read_with("[0.5, 1,2, 3,4, 5.5]", &s);
    assert_int_equal(s->note_count, 2);
    assert_string_equal(s->notes[0].note.text, "1 and 2 are two values");
    assert_string_equal(s->notes[1].note.remedy, "did you mean 3.4?");
    study_destroy(s);
}

static void other_lists_have_none(void **state)
{
    (void)state;
    static const char *const lists[] = {"[0, 1, 2, 4, 8]",
                                        "[0.5, 1, 2, 4]",
                                        "[0, 0.5, 1, 2]",
                                        "[4, 2, 1, 0.5]",
                                        "[1,2,3]",
                                        "[3, 1, 2]",
                                        "[1, 3,4]",
                                        "[1.5]",
                                        "[0.5,1,2]",
                                        "[1.5, 1.2, 1.4]",
                                        "[1.5, 1, 9, 0.5]",
                                        "[1.0, 1e1, 3]",
                                        "{from: 1, to: 2, steps: 3}"};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        study *s;
        read_with(lists[i], &s);
        if (s->note_count)
            fail_msg("%s: %s", lists[i], s->notes[0].note.remedy);
        study_destroy(s);
    }
}

/* With two slips in one decade, the first digits are equal: an error, which must not send its reader the wrong way. */
static void equal_values_that_are_slips_have_the_remedy(void **state)
{
    (void)state;
    const char *text = "study: t\nscene: experiments/scenes/rod.yaml\ngrid:\n  - {lamp.intensity: [1.2, 1,3, 1,4]}\n";
    study *s;
    diagnostic why = {0};
    assert_int_equal(study_read_text("t.study", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.remedy, "did you mean 1.3?");
    assert_int_equal(why.line, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_text_reads_as_what_was_given),
        cmocka_unit_test(values_may_have_any_character),
        cmocka_unit_test(long_lists_are_wrapped),
        cmocka_unit_test(a_refused_axis_is_empty),
        cmocka_unit_test(errors_are_located_at_their_option),
        cmocka_unit_test(an_error_in_a_setting_is_located_at_its_option),
        cmocka_unit_test(probable_slips_have_a_note),
        cmocka_unit_test(two_slips_have_two_notes),
        cmocka_unit_test(other_lists_have_none),
        cmocka_unit_test(equal_values_that_are_slips_have_the_remedy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
