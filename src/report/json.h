/* JSON out: jansson builds the value, this writes it. Reals get the fewest digits that read back the same, lists of
 * plain values stand on one line, keys keep the order they were put in. Ownership: json_* return new references. */
#pragma once

#include "base/status.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* NULL (the JSON one) for what is not finite. */
json_t *json_of_real(double value);
/* null for -1, which stands for "the kernel does not say". */
json_t *json_of_count(int64_t value);
/* Text that is not UTF-8, such as a file's name, gets '?' for its odd bytes. */
json_t *json_of_text(const char *text);

/* {"error", "remedy"}, and "file", "line", "column" where there are any; NULL when memory is out. */
json_t *json_of_diagnostic(const diagnostic *why);

/* The value where it is whole; else NULL, and it is released. */
json_t *json_whole(json_t *value, bool whole);

/* For what is too large to build first: a text in quotes (as json_of_text), and a real with 17 significant digits,
 * printf's %.17g; null for what is not finite. */
bool json_write_text(FILE *stream, const char *text);
void json_write_real(FILE *stream, double value);

/* Writes the value and a newline. Errors of the stream are left in the stream. */
status json_write(FILE *stream, const json_t *value, diagnostic *why);
/* The same, and releases the value; json_print: to standard output. */
status json_put(FILE *stream, json_t *value, diagnostic *why);
status json_print(json_t *value, diagnostic *why);
