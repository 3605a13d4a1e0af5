/* recheck ROWS RUNS - makes rows that a test script has edited or removed consistent again: computes their checks, and
 * removes the number of rows from the list of runs. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static void require(bool good, const char *what)
{
    if (good)
        return;
    fprintf(stderr, "recheck: %s\n", what);
    exit(1);
}
#define assert_true(condition) require(condition, #condition)
#define assert_non_null(pointer) require((pointer) != NULL, #pointer)
#define assert_int_equal(a, b) require((a) == (b), #a)

#include "rows_fixture.h"

int main(int argc, char **argv)
{
    require(argc == 3, "usage: recheck ROWS RUNS");
    rows_recheck(argv[1]);
    rows_unseal(argv[2]);
    return 0;
}
