/* Conversion between numbers and text, independent of the locale. Pure; no allocation. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { NUMBER_TEXT_MAX = 32 };

/* Parses a complete text as a decimal number (no hex, no NaN, no infinity, no surrounding blanks), with '.' as the
 * decimal point whatever LC_NUMERIC is. False if it is not a number or overflows. */
bool number_parse_real(const char *text, double *value);

/* Reads a decimal number at *at (sign, digits with a point among them or around them, exponent), rounds it to the
 * nearest double, and moves *at past it. The text may go on with anything, but must end in a character that is not
 * part of a number. False, with *at unchanged: no number is there, or it is not finite. */
bool number_scan(const char **at, double *value);

/* Parses a complete text as a decimal integer; false if it is not one or does not fit. "4.0" is not an integer. */
bool number_parse_int(const char *text, int64_t *value);

/* The shortest of printf's %.15g, %.16g, %.17g that reads back as the same double ("0.1", "1e-09", "inf", "nan");
 * returns text. */
char *number_format(double value, char text[NUMBER_TEXT_MAX]);

/* The same for finite values, rounded to 1 to 17 digits, without trailing zeros. */
char *number_format_digits(double value, int digits, char text[NUMBER_TEXT_MAX]);

/* The value with the digits that its uncertainty allows: half, the half-width of its interval, is shown with two digits
 * if they are 10 to 29, otherwise with one (after the rule of the Particle Data Group). Four significant digits if half
 * is not above 0 or not finite, or |value| is above 1e15. */
char *number_format_within(double value, double half, char text[NUMBER_TEXT_MAX]);
