/* The JSON writer for values built with jansson. Reals have the fewest digits that read back the same, lists of scalars
 * are on one line, keys keep their order of insertion. Ownership: json_* return new references. */
#pragma once

#include "base/status.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* JSON null for a value that is not finite. */
json_t *json_of_real(double value);
/* JSON null for -1, which means that the kernel does not report the count. */
json_t *json_of_count(int64_t value);
/* In text that is not UTF-8, such as a file name, every byte above 127 becomes '?'. */
json_t *json_of_text(const char *text);

/* An object with "error" and "remedy", and "file", "line", "column" where known; NULL when out of memory. */
json_t *json_of_diagnostic(const diagnostic *why);

/* Returns value if good is true; otherwise frees it and returns NULL. */
json_t *json_if(json_t *value, bool good);

/* For output too large to build as a value: a quoted text (as json_of_text), and a real with 17 significant digits
 * (%.17g), null for one that is not finite. */
bool json_write_text(FILE *stream, const char *text);
void json_write_real(FILE *stream, double value);

/* Writes the value and a newline. Errors of the stream stay in the stream, where the caller checks them. */
status json_write(FILE *stream, const json_t *value, diagnostic *why);
/* json_put also frees the value; json_print does so and writes to standard output. */
status json_put(FILE *stream, json_t *value, diagnostic *why);
status json_print(json_t *value, diagnostic *why);
