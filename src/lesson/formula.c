/* Values of formulas in lessons: numbers, parameters of the scene, the lesson's own values, arithmetic. A descent over
 * the text, which is short; a formula is parsed whenever its value is needed. */
#include "base/number.h"
#include "lesson/lesson.h"
#include "scene/model/params.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NESTING_MAX = 40, WORD_MAX = 160 };

typedef struct parser {
    const char *at;
    const formula_names *names;
    int nesting;
    char what[256]; /* of the first error; "" for none */
} parser;

static double fail(parser *p, const char *what, const char *word)
{
    if (!p->what[0])
        snprintf(p->what, sizeof p->what, what, word);
    p->at += strlen(p->at);
    return NAN;
}

static char next(parser *p)
{
    while (*p->at == ' ')
        p->at++;
    return *p->at;
}

static bool take(parser *p, char c)
{
    if (next(p) != c)
        return false;
    p->at++;
    return true;
}

/* Angles are in degrees. */
static const struct {
    const char *name;
    double (*of)(double), before, after;
} functions[] = {
    {"sin", sin, M_PI / 180.0, 1.0},
    {"cos", cos, M_PI / 180.0, 1.0},
    {"tan", tan, M_PI / 180.0, 1.0},
    {"asin", asin, 1.0, 180.0 / M_PI},
    {"acos", acos, 1.0, 180.0 / M_PI},
    {"atan", atan, 1.0, 180.0 / M_PI},
    {"sqrt", sqrt, 1.0, 1.0},
    {"exp", exp, 1.0, 1.0},
    {"log", log, 1.0, 1.0},
};

static double sum(parser *p);
static double comparison(parser *p);

static double call(parser *p, const char *name)
{
    const double x = comparison(p);
    if (!take(p, ')'))
        return fail(p, "')' is missing%s", "");
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].of(x * functions[i].before) * functions[i].after;
    return fail(p, "unknown function '%.32s'", name);
}

/* A switch is 1 or 0. */
static double parameter(parser *p, const char *path)
{
    char *text = NULL;
    double x = NAN;
    diagnostic refused = {.what = ""};
    if (scene_get(p->names->s, path, &text, &refused) != STATUS_OK)
        return fail(p, "%.200s", refused.what);
    const bool on = strcmp(text, "on") == 0;
    if (!number_parse_real(text, &x) && (on || strcmp(text, "off") == 0))
        x = on;
    const bool word = isnan(x);
    free(text);
    return word ? fail(p, "'%.128s' is not a number", path) : x;
}

static double named(parser *p, const char *name)
{
    const formula_names *names = p->names;
    for (int i = 0; i < names->count; i++)
        if (strcmp(names->l->value[i].name, name) == 0)
            return names->values[i];
    if (strcmp(name, "theory") == 0)
        return names->theory;
    if (strcmp(name, "pi") == 0)
        return M_PI;
    return strchr(name, '.') ? parameter(p, name) : fail(p, "unknown name '%.64s'", name);
}

/* Of names: in every locale, and in any script. */
static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (unsigned char)c >= 0x80;
}

static double word(parser *p)
{
    char name[WORD_MAX];
    size_t n = 0;
    while (is_letter(*p->at) || (*p->at >= '0' && *p->at <= '9') || *p->at == '.') {
        if (n + 1 >= sizeof name)
            return fail(p, "a name is too long%s", "");
        name[n++] = *p->at++;
    }
    name[n] = 0;
    return take(p, '(') ? call(p, name) : named(p, name);
}

static double atom(parser *p)
{
    double x = NAN;
    const char c = next(p);
    if (take(p, '(')) {
        x = comparison(p);
        return take(p, ')') ? x : fail(p, "')' is missing%s", "");
    }
    if (is_letter(c))
        return word(p);
    return number_scan(&p->at, &x) ? x : fail(p, c ? "unexpected '%.8s'" : "the formula ends too early%s", p->at);
}

static double factor(parser *p)
{
    if (++p->nesting > NESTING_MAX)
        return fail(p, "the formula is nested too deeply%s", "");
    double x;
    if (take(p, '-'))
        x = -factor(p);
    else {
        x = atom(p);
        if (take(p, '^'))
            x = pow(x, factor(p));
    }
    p->nesting--;
    return x;
}

static double product(parser *p)
{
    double x = factor(p);
    for (;;)
        if (take(p, '*'))
            x *= factor(p);
        else if (take(p, '/'))
            x /= factor(p);
        else
            return x;
}

static double sum(parser *p)
{
    double x = product(p);
    for (;;)
        if (take(p, '+'))
            x += product(p);
        else if (take(p, '-'))
            x -= product(p);
        else
            return x;
}

/* 1 or 0. */
static double comparison(parser *p)
{
    const double x = sum(p);
    if (take(p, '<'))
        return x < sum(p);
    return take(p, '>') ? x > sum(p) : x;
}

status formula_value(const char *text, const formula_names *names, double *out, diagnostic *why)
{
    parser p = {.at = text, .names = names};
    *out = comparison(&p);
    if (next(&p))
        fail(&p, "unexpected '%.8s'", p.at);
    return p.what[0] ? diagnose(why, STATUS_BAD_INPUT,
                                "write numbers, parameters, values above, + - * / ^ < > and functions of degrees", "%s",
                                p.what)
                     : STATUS_OK;
}

/* Values that depend on `theory` are NaN while it is. */
status lesson_values(const lesson *l, const scene *s, double theory, double values[LESSON_VALUES_MAX], diagnostic *why)
{
    formula_names names = {.s = s, .l = l, .values = values, .theory = theory};
    for (; names.count < l->value_count; names.count++)
        TRY(formula_value(l->value[names.count].formula, &names, &values[names.count], why));
    return STATUS_OK;
}

status lesson_formula(const lesson *l, const scene *s, double theory, const char *formula, double *out, diagnostic *why)
{
    double values[LESSON_VALUES_MAX];
    TRY(lesson_values(l, s, theory, values, why));
    const formula_names names = {s, l, values, l->value_count, theory};
    return formula_value(formula, &names, out, why);
}
