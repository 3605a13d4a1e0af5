/* Tests of the append-only table file: incomplete ends, locks, full disks and unwritable paths. */
#include "base/os_process.h"
#include "study/rows/table.h"
#include "study_fixture.h"
#include <fcntl.h>
#include <sys/resource.h>

static const char header[] = "a,b\n";

static table *open_table(const fixture *f)
{
    char path[400], message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    table *t = NULL;
    fixture_path(f, "rows.csv", path);
    if (table_open(path, header, &t, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return t;
}

static void append(table *t, const char *line)
{
    assert_int_equal(table_append(t, line, strlen(line), NULL), STATUS_OK);
}

static void expect(const fixture *f, const char *name, const char *text)
{
    char *there = fixture_text(f, name);
    assert_string_equal(there, text);
    free(there);
}

static void rows_are_appended(void **state)
{
    const fixture *f = *state;
    table *t = open_table(f);
    expect(f, "rows.csv", "a,b\n");
    append(t, "1,2\n");
    append(t, "3,4\n5,6\n");
    table_close(t);
    t = open_table(f);
    append(t, "7,8\n");
    table_close(t);
    expect(f, "rows.csv", "a,b\n1,2\n3,4\n5,6\n7,8\n");
    assert_false(fixture_has(f, "rows.torn.csv"));
}

static void incomplete_rows_are_moved_to_the_torn_file(void **state)
{
    const fixture *f = *state;
    fixture_write(f, "rows.csv", "a,b\n1,2\n3,");
    table_close(open_table(f));
    expect(f, "rows.csv", "a,b\n1,2\n");
    expect(f, "rows.torn.csv", "3,\n");
    fixture_write(f, "rows.csv", "a,b\n1,2\n5");
    table *t = open_table(f);
    append(t, "5,6\n");
    table_close(t);
    expect(f, "rows.csv", "a,b\n1,2\n5,6\n");
    expect(f, "rows.torn.csv", "3,\n5\n");
}

static void incomplete_headers_are_rewritten(void **state)
{
    const fixture *f = *state;
    fixture_write(f, "rows.csv", "a,");
    table_close(open_table(f));
    expect(f, "rows.csv", "a,b\n");
    expect(f, "rows.torn.csv", "a,\n");
}

/* Longer than the blocks in which the end is searched. */
static void long_incomplete_ends_are_moved_to_the_torn_file(void **state)
{
    const fixture *f = *state;
    char *text = malloc(20000);
    strcpy(text, "a,b\n1,2\n");
    memset(text + 8, 'x', 15000);
    text[15008] = 0;
    fixture_write(f, "rows.csv", text);
    table_close(open_table(f));
    expect(f, "rows.csv", "a,b\n1,2\n");
    strcat(text, "\n");
    expect(f, "rows.torn.csv", text + 8);
    free(text);
}

static void complete_lines_can_be_moved_to_the_torn_file(void **state)
{
    const fixture *f = *state;
    table *t = open_table(f);
    append(t, "1,2\n3,4\n");
    assert_int_equal(table_set_aside(t, 8, NULL), STATUS_OK);
    assert_int_equal(table_set_aside(t, 8, NULL), STATUS_OK);
    append(t, "5,6\n");
    table_close(t);
    expect(f, "rows.csv", "a,b\n1,2\n5,6\n");
    expect(f, "rows.torn.csv", "3,4\n");
}

/* In a process without a standard input the file may have its number. */
static void any_descriptor_is_closed(void **state)
{
    const fixture *f = *state;
    const int input = fcntl(0, F_DUPFD_CLOEXEC, 3);
    close(0);
    table_close(open_table(f));
    const bool closed = fcntl(0, F_GETFD) == -1;
    if (input >= 0) {
        assert_int_equal(dup2(input, 0), 0);
        close(input);
    }
    assert_true(closed);
}

static void one_writer_at_a_time(void **state)
{
    const fixture *f = *state;
    char path[400];
    diagnostic why = {0};
    table *t = open_table(f), *second = NULL;
    fixture_path(f, "rows.csv", path);
    assert_int_equal(table_open(path, header, &second, &why), STATUS_BAD_INPUT);
    assert_null(second);
    assert_non_null(strstr(why.what, "another process"));
    assert_string_equal(why.file, path);
    table_close(t);
    table_close(open_table(f));
}

/* A file size limit simulates a full disk: a write is short, then fails. */
static void a_full_disk_leaves_only_complete_lines(void **state)
{
    const fixture *f = *state;
    struct rlimit before, small;
    diagnostic why = {0};
    table *t = open_table(f);
    append(t, "1,2\n");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    os_signals_as_errors();
    small = before;
    small.rlim_cur = 11;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    status code = table_append(t, "33,44\n", 6, &why);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(code, STATUS_FAILURE);
    assert_non_null(strstr(why.remedy, "limit on file size"));
    expect(f, "rows.csv", "a,b\n1,2\n");
    append(t, "33,44\n");
    table_close(t);
    expect(f, "rows.csv", "a,b\n1,2\n33,44\n");
}

static void unwritable_paths_are_reported(void **state)
{
    const fixture *f = *state;
    static const char *const places[] = {"scene.yaml/rows.csv", "nowhere/rows.csv"};
    for (size_t i = 0; i < 2; i++) {
        char path[400];
        diagnostic why = {0};
        table *t = NULL;
        fixture_path(f, places[i], path);
        assert_int_equal(table_open(path, header, &t, &why), STATUS_FAILURE);
        assert_null(t);
        assert_string_equal(why.file, path);
        assert_true(why.what[0] && why.remedy[0]);
    }
    table_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(rows_are_appended, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(incomplete_rows_are_moved_to_the_torn_file, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(incomplete_headers_are_rewritten, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(long_incomplete_ends_are_moved_to_the_torn_file, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(complete_lines_can_be_moved_to_the_torn_file, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(any_descriptor_is_closed, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(one_writer_at_a_time, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_full_disk_leaves_only_complete_lines, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(unwritable_paths_are_reported, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("table", tests, NULL, NULL);
}
