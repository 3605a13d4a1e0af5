/* Checks a folder of faulty files against expected.txt, which has the one line of error for each: "NAME:LINE:COLUMN:
 * what; remedy". */
#pragma once

#include "base/status.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

/* Reads a faulty file; asserts that nothing was created. */
typedef status read_bad_file(const char *path, diagnostic *why);

static inline void compare_bad_file(const char *folder, const char *expected, read_bad_file *read)
{
    char path[256], text[DIAGNOSTIC_TEXT_MAX], wanted[DIAGNOSTIC_TEXT_MAX];
    const int name = (int)strcspn(expected, ":");
    assert_true(snprintf(path, sizeof path, "%s%.*s", folder, name, expected) < (int)sizeof path);
    assert_true(snprintf(wanted, sizeof wanted, "%s%s", folder, expected) < (int)sizeof wanted);
    diagnostic why = {.what = ""};
    const status code = read(path, &why);
    if (code != STATUS_BAD_INPUT)
        print_error("%s: status %d\n", path, (int)code);
    assert_int_equal(code, STATUS_BAD_INPUT);
    assert_string_equal(diagnostic_text(&why, text, sizeof text), wanted);
    assert_true(why.line > 0 && why.column > 0);
    assert_null(strchr(text, '\n'));
    assert_int_equal(read(path, NULL), STATUS_BAD_INPUT);
}

static inline size_t count_bad_files(const char *folder)
{
    DIR *opened = opendir(folder);
    assert_non_null(opened);
    size_t count = 0;
    for (struct dirent *entry = readdir(opened); entry; entry = readdir(opened))
        count += strstr(entry->d_name, ".yaml") != NULL;
    closedir(opened);
    return count;
}

/* Asserts that every .yaml file of the folder (whose name ends in a slash) has its line, and that there are at least
 * `least` files. */
static inline void assert_bad_files(const char *folder, read_bad_file *read, size_t least)
{
    char path[256], line[DIAGNOSTIC_TEXT_MAX];
    assert_true(snprintf(path, sizeof path, "%sexpected.txt", folder) < (int)sizeof path);
    FILE *list = fopen(path, "r");
    assert_non_null(list);
    size_t count = 0;
    for (; fgets(line, sizeof line, list); count++) {
        line[strcspn(line, "\n")] = 0;
        compare_bad_file(folder, line, read);
    }
    fclose(list);
    assert_int_equal(count, count_bad_files(folder));
    assert_true(count >= least);
}
