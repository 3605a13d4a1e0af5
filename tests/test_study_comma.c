/* Tests of study/plan/read_grid.h: decimal commas in lists of an axis. */
#include "study_fixture.h"

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
        cmocka_unit_test(probable_slips_have_a_note),
        cmocka_unit_test(two_slips_have_two_notes),
        cmocka_unit_test(other_lists_have_none),
        cmocka_unit_test(equal_values_that_are_slips_have_the_remedy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
