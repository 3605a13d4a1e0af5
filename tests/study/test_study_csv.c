/* Tests of the CSV reader and writer: quoting, incomplete lines and damaged files. */
#include "base/csv.h"
#include "study/rows/table.h"
#include "study_fixture.h"

static void csv_fields_round_trip(void **state)
{
    const fixture *f = *state;
    csv_buffer line = {0};
    csv_text(&line, "name");
    csv_text(&line, "a,b");
    csv_text(&line, "say \"it\"");
    csv_end(&line);
    csv_text(&line, NULL);
    csv_real(&line, 0.1);
    csv_real(&line, NAN);
    csv_end(&line);
    csv_count(&line, -1);
    csv_count(&line, INT64_MAX);
    csv_hash(&line, 0xab);
    csv_end(&line);
    assert_false(line.failed);
    assert_string_equal(line.text,
                        "name,\"a,b\",\"say \"\"it\"\"\"\nNA,0.1,NA\nNA,9223372036854775807,00000000000000ab\n");
    fixture_write(f, "t.csv", line.text);
    csv_buffer_free(&line);
    char path[400];
    fixture_path(f, "t.csv", path);
    csv *sheet = NULL;
    assert_int_equal(csv_read(path, &sheet, NULL), STATUS_OK);
    assert_int_equal(sheet->column_count, 3);
    assert_int_equal(sheet->row_count, 2);
    assert_int_equal(csv_column(sheet, "a,b"), 1);
    assert_int_equal(csv_column(sheet, "say \"it\""), 2);
    assert_int_equal(csv_column(sheet, "b"), -1);
    assert_true(csv_field_real(sheet, 0, 1) == 0.1);
    assert_true(isnan(csv_field_real(sheet, 0, 0)));
    assert_true(isnan(csv_field_real(sheet, 0, -1)));
    assert_string_equal(csv_field(sheet, 1, 2), "00000000000000ab");
    csv_destroy(sheet);
}

static diagnostic reason; /* of rows_of */

/* Contents of the file -> number of rows, or -1 for an error, and its line. */
static int rows_of(const fixture *f, const char *text, long *line)
{
    char path[400];
    reason = (diagnostic){0};
    csv *sheet = NULL;
    fixture_write(f, "t.csv", text);
    fixture_path(f, "t.csv", path);
    status code = csv_read(path, &sheet, &reason);
    int rows = code == STATUS_OK ? (int)sheet->row_count : -1;
    if (line)
        *line = reason.line;
    csv_destroy(sheet);
    return rows;
}

/* The same sheet as people, spreadsheets and Python write it, and what it is in the form of this program. */
static void files_of_other_programs_are_read(void **state)
{
    const fixture *f = *state;
    static const char own[] = "a,b\n1,x\n2,y\n";
    static const char *const written[] = {own,
                                          "a,b\n1,x\n2,y",
                                          "a,b\r\n1,x\r\n2,y\r\n",
                                          "a,b\r\n1,x\r\n2,y",
                                          "\xEF\xBB\xBF"
                                          "a,b\n1,x\n2,y\n",
                                          "\xEF\xBB\xBF"
                                          "a,b\r\n1,x\r\n2,y",
                                          "a,b\n1,x\n2,y\n\n",
                                          "a,b\r\n1,x\r\n2,y\r\n\r\n\r\n"};
    char path[400];
    csv *sheet;
    fixture_path(f, "t.csv", path);
    for (size_t i = 0; i < sizeof written / sizeof *written; i++) {
        fixture_write(f, "t.csv", written[i]);
        assert_int_equal(csv_read_any(path, NULL, &sheet, NULL), STATUS_OK);
        assert_true(sheet->row_count == 2 && sheet->column_count == 2 && !sheet->torn);
        assert_true(csv_column(sheet, "a") == 0 && csv_column(sheet, "b") == 1);
        assert_string_equal(csv_field(sheet, 1, 1), "y");
        assert_string_equal(sheet->raw, own);
        assert_int_equal(sheet->mended, i > 0);
        csv_destroy(sheet);
    }
    fixture_write(f, "t.csv", "a,b\n1,x\n2");
    assert_int_equal(csv_read_any(path, NULL, &sheet, NULL), STATUS_OK);
    assert_true(sheet->row_count == 1 && sheet->torn);
    csv_destroy(sheet);
    fixture_write(f, "t.csv", "a,b"); /* the program was killed while it wrote the header */
    assert_int_equal(csv_read_any(path, NULL, &sheet, NULL), STATUS_OK);
    assert_true(sheet->row_count == 0 && !sheet->header && sheet->torn);
    csv_destroy(sheet);
    fixture_write(f, "t.csv", "a,b\n1,\"x\ry\"\n"); /* a carriage return within a line is a character */
    assert_int_equal(csv_read_any(path, NULL, &sheet, NULL), STATUS_OK);
    assert_string_equal(csv_field(sheet, 0, 1), "x\ry");
    csv_destroy(sheet);
}

/* Rows are what the program wrote: another form is named. */
static void rows_in_another_form_are_named(void **state)
{
    const fixture *f = *state;
    char path[400];
    csv *sheet;
    diagnostic why = {0};
    fixture_path(f, "t.csv", path);
    fixture_write(f, "t.csv", "a,b\r\n1,x\r\n");
    assert_int_equal(csv_read_rows(path, NULL, &sheet, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "CR LF"));
    fixture_write(f, "t.csv",
                  "\xEF\xBB\xBF"
                  "a,b\n1,x\n");
    assert_int_equal(csv_read_rows(path, NULL, &sheet, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "byte order mark"));
}

/* A power cut can leave a line of which parts were never written; an earlier line like that is damage. */
static void a_last_line_with_unwritten_parts_is_incomplete(void **state)
{
    (void)state;
    static const char torn[] = "a,b\n1,2\n\0\0,4\n", header[] = "a\0b\n", inside[] = "a,b\n\0,2\n3,4\n";
    assert_int_equal(csv_complete_size("", 0), 0);
    assert_int_equal(csv_complete_size("a,b", 3), 0);
    assert_int_equal(csv_complete_size("a,b\n1,2\n3", 9), 8);
    assert_int_equal(csv_complete_size(torn, sizeof torn - 1), 8);
    assert_int_equal(csv_complete_size(header, sizeof header - 1), 0);
    assert_int_equal(csv_complete_size(inside, sizeof inside - 1), sizeof inside - 1);
}

static void only_complete_lines_are_rows(void **state)
{
    const fixture *f = *state;
    assert_int_equal(rows_of(f, "", NULL), 0);
    assert_int_equal(rows_of(f, "a,b", NULL), 0);
    assert_int_equal(rows_of(f, "a,b\n", NULL), 0);
    assert_int_equal(rows_of(f, "a,b\n1,2\n3,4", NULL), 1);
    assert_int_equal(rows_of(f, "a,b\n1,2\n3,\"4", NULL), 1);
    assert_int_equal(rows_of(f, "a,b\n,\n\"\",\"x,y\"\n", NULL), 2);
}

static void damaged_rows_are_located(void **state)
{
    const fixture *f = *state;
    long line;
    assert_int_equal(rows_of(f, "a,b\n1,2\n3\n", &line), -1);
    assert_int_equal(line, 3);
    assert_string_equal(reason.what, "the row is damaged");
    assert_int_equal(rows_of(f, "a,b\n1,2,3\n", &line), -1);
    assert_int_equal(line, 2);
    assert_int_equal(rows_of(f, "a,b\n1,\"2\n", &line), -1);
    assert_int_equal(rows_of(f, "a,b\n1,2\"\n", &line), -1);
    assert_int_equal(rows_of(f, "a,b\n\"1\"2,3\n", &line), -1);
    assert_int_equal(rows_of(f, "a,\"b\n1,2\n", &line), -1);
    assert_int_equal(line, 1);
    assert_string_equal(reason.what, "the header is damaged");
    assert_null(strstr(reason.remedy, "remove"));
}

static void zero_bytes_are_reported_as_damage(void **state)
{
    const fixture *f = *state;
    char path[400];
    fixture_path(f, "t.csv", path);
    FILE *file = fopen(path, "w");
    fwrite("a,b\n\0\0\0\0\n1,2\n", 1, 13, file); /* not the last line, which a power cut can have left */
    fclose(file);
    csv *sheet = NULL;
    assert_int_equal(csv_read(path, &sheet, NULL), STATUS_BAD_INPUT);
    assert_null(sheet);
}

static void a_missing_file_gives_no_table(void **state)
{
    (void)state;
    csv *sheet = (csv *)1;
    assert_int_equal(csv_read("/nowhere/t.csv", &sheet, NULL), STATUS_OK);
    assert_null(sheet);
}

/* Fields move to the columns of their names; a line of another number of fields is refused, and nothing follows. */
static void rows_move_to_another_header(void **state)
{
    (void)state;
    csv_layout *l = NULL;
    csv_buffer out = {0};
    diagnostic why = {0};
    assert_int_equal(csv_layout_create("a,b,c\n", "c,d,a\n", &l, &why), STATUS_OK);
    static const char lines[] = "1,2,3\n4,5,\"x,y\"\n";
    assert_int_equal(csv_layout_place(l, lines, strlen(lines), &out, &why), STATUS_OK);
    assert_string_equal(out.text, "3,NA,1\n\"x,y\",NA,4\n");
    assert_int_not_equal(csv_layout_place(l, "1,2\n", 4, &out, &why), STATUS_OK);
    assert_int_not_equal(csv_layout_place(l, "1,2,3,4\n", 8, &out, &why), STATUS_OK);
    csv_buffer_free(&out);
    csv_layout_destroy(l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(csv_fields_round_trip, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(files_of_other_programs_are_read, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(rows_in_another_form_are_named, fixture_setup, fixture_teardown),
        cmocka_unit_test(a_last_line_with_unwritten_parts_is_incomplete),
        cmocka_unit_test_setup_teardown(only_complete_lines_are_rows, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(damaged_rows_are_located, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(zero_bytes_are_reported_as_damage, fixture_setup, fixture_teardown),
        cmocka_unit_test(a_missing_file_gives_no_table),
        cmocka_unit_test(rows_move_to_another_header),
    };
    return cmocka_run_group_tests_name("csv", tests, NULL, NULL);
}
