/* Parsing and formatting of numbers, independent of the locale. */
#include "base/number.h"

#include <errno.h>
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *skip_sign(const char *c)
{
    return *c == '+' || *c == '-' ? c + 1 : c;
}

static const char *skip_digits(const char *c)
{
    while (*c >= '0' && *c <= '9')
        c++;
    return c;
}

/* sign? (digits ('.' digits?)? | '.' digits) ([eE] sign? digits)?, and nothing after it. */
static bool is_decimal(const char *text)
{
    const char *integer = skip_sign(text), *c = skip_digits(integer);
    bool has_digits = c > integer;
    if (*c == '.') {
        const char *fraction = c + 1;
        c = skip_digits(fraction);
        has_digits = has_digits || c > fraction;
    }
    if (!has_digits)
        return false;
    if (*c == 'e' || *c == 'E') {
        const char *exponent = skip_sign(c + 1);
        c = skip_digits(exponent);
        if (c == exponent)
            return false;
    }
    return *c == 0;
}

/* glibc and musl return a constant for "C": nothing is allocated or has to be freed. */
static locale_t c_locale(void)
{
    return newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

bool number_parse_real(const char *text, double *value)
{
    if (!text || !is_decimal(text))
        return false;
    double parsed = strtod_l(text, NULL, c_locale());
    if (!isfinite(parsed))
        return false;
    *value = parsed;
    return true;
}

/* Moves *at past digits, and appends them to *digits while they fit. Returns how many there are; *left: how many of
 * them did not fit. */
static int scan_digits(const char **at, uint64_t *digits, int *left)
{
    const char *c = *at;
    uint64_t sum = *digits;
    for (; *c >= '0' && *c <= '9'; c++)
        if (sum < UINT64_C(1000000000000000000))
            sum = 10 * sum + (uint64_t)(*c - '0');
        else
            ++*left;
    const int count = (int)(c - *at);
    *at = c;
    *digits = sum;
    return count;
}

/* The error of the product a * b, exactly (Veltkamp's division of factors, Dekker, "A floating-point technique for
 * extending the available precision", 1971). */
static double product_error(double a, double b, double product)
{
    const double c = 134217729.0 * a, d = 134217729.0 * b, ah = c - (c - a), bh = d - (d - b), al = a - ah, bl = b - bh;
    return ((ah * bh - product) + ah * bl + al * bh) + al * bl;
}

/* digits times or divided by an exact power of ten, as a sum of two doubles with an error below 2^-100 of it. False if
 * that does not decide to which double the number is rounded. */
static bool scale(uint64_t digits, double power, bool divide, double *number)
{
    const double high = (double)digits, low = (double)(int64_t)(digits - (uint64_t)high);
    double first, second;
    if (divide) {
        first = high / power;
        const double product = first * power;
        second = ((high - product) - product_error(first, power, product) + low) / power;
    } else {
        first = high * power;
        second = product_error(high, power, first) + low * power;
    }
    const double margin = 0x1p-100 * first, above = first + (second + margin), below = first + (second - margin);
    *number = above;
    return !(below < above);
}

/* Up to 2^53, and with a power of ten up to 10^22, both factors are exact doubles, and one operation rounds once
 * (Clinger, "How to read floating point numbers accurately", 1990). */
bool number_scan(const char **at, double *value)
{
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const char *c = skip_sign(*at);
    uint64_t digits = 0;
    int left = 0, after = 0, exponent = 0;
    int count = scan_digits(&c, &digits, &left);
    if (*c == '.') {
        c++;
        after = scan_digits(&c, &digits, &left);
        count += after;
    }
    if (count == 0)
        return false;
    if (*c == 'e' || *c == 'E') {
        const char *first = skip_sign(c + 1), *end = first;
        for (; *end >= '0' && *end <= '9'; end++)
            exponent = exponent < 100000 ? 10 * exponent + (*end - '0') : exponent;
        if (end == first)
            return false;
        exponent = c[1] == '-' ? -exponent : exponent;
        c = end;
    }
    exponent -= after;
    const bool in_range = left == 0 && exponent >= -22 && exponent <= 22, exact = digits <= UINT64_C(1) << 53;
    double number = (double)digits;
    if (in_range && exact)
        number = exponent < 0 ? number / powers[-exponent] : number * powers[exponent];
    else if (digits != 0 && !(in_range && scale(digits, powers[abs(exponent)], exponent < 0, &number)))
        number = fabs(strtod_l(*at, NULL, c_locale()));
    if (!isfinite(number))
        return false;
    *value = **at == '-' ? -number : number;
    *at = c;
    return true;
}

bool number_parse_int(const char *text, int64_t *value)
{
    if (!text)
        return false;
    const char *digits = skip_sign(text), *end = skip_digits(digits);
    if (end == digits || *end)
        return false;
    int before = errno;
    errno = 0;
    long long parsed = strtoll(text, NULL, 10);
    bool fits = errno == 0;
    errno = before;
    if (fits)
        *value = parsed;
    return fits;
}

char *number_format_digits(double value, int digits, char text[NUMBER_TEXT_MAX])
{
    locale_t before = uselocale(c_locale());
    snprintf(text, NUMBER_TEXT_MAX, "%.*g", digits, value);
    uselocale(before);
    return text;
}

/* Writes digits / 10^decimals, which has at most 15 digits and does not end with a 0 after the point. */
static void put_decimal(bool negative, uint64_t digits, int decimals, char text[NUMBER_TEXT_MAX])
{
    char reversed[NUMBER_TEXT_MAX];
    int count = 0;
    for (; count < decimals; digits /= 10)
        reversed[count++] = (char)('0' + digits % 10);
    if (decimals > 0)
        reversed[count++] = '.';
    do
        reversed[count++] = (char)('0' + digits % 10);
    while ((digits /= 10) > 0);
    if (negative)
        *text++ = '-';
    while (count > 0)
        *text++ = reversed[--count];
    *text = 0;
}

/* The fast case of number_format: a decimal with at most 15 digits that %g writes without an exponent. n / 10^k with
 * both factors exact is correctly rounded, so that the text reads back as the value (Clinger, "How to Read Floating
 * Point Numbers Accurately", 1990), and the smallest k has no trailing zeros. False: another case. */
static bool format_decimal(double value, char text[NUMBER_TEXT_MAX])
{
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                    1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};
    const double size = fabs(value);
    if (!(size > 0.0))
        return strcpy(text, signbit(value) ? "-0" : "0");
    if (!(size >= 1e-4))
        return false;
    for (int k = 0; k < (int)(sizeof powers / sizeof *powers); k++) {
        const double digits = rint(size * powers[k]);
        if (!(digits < 1e15))
            return false;
        if (!(digits / powers[k] < size) && !(digits / powers[k] > size)) {
            put_decimal(value < 0.0, (uint64_t)digits, k, text);
            return true;
        }
    }
    return false;
}

char *number_format(double value, char text[NUMBER_TEXT_MAX])
{
    if (isnan(value) || isinf(value))
        return strcpy(text, isnan(value) ? "nan" : value < 0 ? "-inf" : "inf");
    if (format_decimal(value, text))
        return text;
    /* 15 digits always survive in a normal double and 17 always identify it, so the first text that reads back is the
     * shortest; %g drops trailing zeros. Subnormal numbers hold fewer digits. */
    for (int digits = fabs(value) < DBL_MIN ? 1 : 15; digits <= 17; digits++) {
        number_format_digits(value, digits, text);
        double back = strtod_l(text, NULL, c_locale());
        if (!(back < value) && !(back > value))
            break;
    }
    return text;
}

char *number_format_within(double value, double half, char text[NUMBER_TEXT_MAX])
{
    if (!isfinite(value))
        return number_format(value, text);
    if (!(half > 0) || isinf(half) || fabs(value) > 1e15)
        return number_format_digits(value, 4, text);
    const double exponent = floor(log10(half));
    const bool two = half / pow(10.0, exponent) < 2.95;
    const int decimals = (two ? 1 : 0) - (int)exponent;
    const double unit = pow(10.0, -(double)decimals);
    if (decimals > 14)
        return number_format(value, text);
    locale_t before = uselocale(c_locale());
    snprintf(text, NUMBER_TEXT_MAX, "%.*f", decimals > 0 ? decimals : 0,
             decimals < 0 ? round(value / unit) * unit : value);
    uselocale(before);
    /* only 0 is written as 0 */
    double shown = 0;
    if (value != 0 && (!number_parse_real(text, &shown) || shown == 0))
        return number_format_digits(value, 2, text);
    return text;
}
