/* Numbers as text, the same in every locale. Pure; no allocation. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { NUMBER_TEXT_MAX = 32 };

/* The whole of text as a decimal number (no hex, no NaN, no infinity, no blanks around it), '.' as the
 * decimal point whatever LC_NUMERIC says. False if it is not one, or overflows. */
bool number_parse_real(const char *text, double *value);

/* The whole of text as a decimal integer; false if it is not one or does not fit. "4.0" is not one. */
bool number_parse_int(const char *text, int64_t *value);

/* The shortest text of printf's %.15g, %.16g, %.17g that reads back as the same double ("0.1", "1e-09", "inf",
 * "nan"); returns text. */
char *number_format(double value, char text[NUMBER_TEXT_MAX]);

/* The same for finite values with that many digits, 1 to 17, rounded, no trailing zeros. */
char *number_format_digits(double value, int digits, char text[NUMBER_TEXT_MAX]);
