/* A table of texts with aligned columns, for a terminal or a reader. Nothing is kept. */
#pragma once

#include "base/status.h"
#include <stddef.h>
#include <stdio.h>

/* text[row * columns + column]; numbers are right-aligned. */
status aligned_table_print(FILE *out, char *const *text, size_t rows, size_t columns, diagnostic *why);
