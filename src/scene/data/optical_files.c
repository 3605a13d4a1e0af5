/* Reads files of optical data (optical_files.h). */
#include "scene/data/optical_files.h"

#include "base/array.h"
#include "base/file.h"
#include "base/lanes.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/data/document.h"
#include "scene/model/names.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define NM_PER_UM 1000.0

/* Points as the file lists them. */
typedef struct point_list {
    double *point;
    size_t count, room; /* points; room in numbers */
} point_list;

typedef struct optical_reader {
    const char *name;
    const optical_file_choice *of;
    long line;
    dispersion law;
    bool has_law;
    point_list first, second;
    diagnostic *why;
} optical_reader;

__attribute__((format(printf, 3, 4))) static status wrong(const optical_reader *r, const char *remedy, const char *what,
                                                          ...)
{
    char text[400];
    va_list list;
    va_start(list, what);
    vsnprintf(text, sizeof text, what, list);
    va_end(list);
    const status code = diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s", text);
    diagnostic_locate(r->why, r->name, r->line, 0);
    return code;
}

static status add_point(const optical_reader *r, point_list *to, double lambda_nm, double value)
{
    if (!GROW(to->point, to->room, 2 * to->count + 2))
        return out_of_memory(r->why);
    to->point[2 * to->count] = lambda_nm;
    to->point[2 * to->count++ + 1] = value;
    return STATUS_OK;
}

static int by_wavelength(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the points by wavelength; those with equal wavelengths, as where two measurements meet, become their mean. */
static void arrange(point_list *l)
{
    size_t kept = 0;
    if (l->count > 0)
        qsort(l->point, l->count, 2 * sizeof *l->point, by_wavelength);
    for (size_t i = 0, equal; i < l->count; i += equal) {
        const double lambda_nm = l->point[2 * i];
        double sum = 0.0;
        for (equal = 0; i + equal < l->count && l->point[2 * (i + equal)] == lambda_nm; equal++)
            sum += l->point[2 * (i + equal) + 1];
        l->point[2 * kept] = lambda_nm;
        l->point[2 * kept++ + 1] = equal > 1 ? sum / (double)equal : l->point[2 * i + 1];
    }
    l->count = kept;
}

/* A negative k is the noise of a measurement. */
static void raise_k(point_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        l->point[2 * i + 1] = l->point[2 * i + 1] < 0.0 ? 0.0 : l->point[2 * i + 1];
}

/* Up to `most` numbers, separated by blanks; -1 if there are more or something else. */
static int numbers_in(const char *text, double *number, int most)
{
    int count = 0;
    for (;;) {
        text += strspn(text, " \t\r\n,");
        if (!*text)
            return count;
        if (count == most || !number_scan(&text, &number[count]) || (*text && !strchr(" \t\r\n,", *text)))
            return -1;
        count++;
    }
}

/* --- refractiveindex.info --- */

/* The kind of the numbered formula, and how its coefficients become those of the kind. M. N. Polyanskiy,
 * "Refractiveindex.info database of optical constants", Sci. Data 11, 94 (2024). */
static status set_formula(optical_reader *r, int number, double *c, int count)
{
    static const struct {
        dispersion_kind kind;
        int least;
    } of[] = {
        [1] = {DISPERSION_SELLMEIER_FROM, 1}, [2] = {DISPERSION_SELLMEIER_FROM, 1}, [3] = {DISPERSION_POLYNOMIAL, 1},
        [4] = {DISPERSION_TWO_RESONANCES, 9}, [5] = {DISPERSION_CAUCHY_POWERS, 1},  [6] = {DISPERSION_GAS_FROM, 1},
        [7] = {DISPERSION_HERZBERGER, 6},     [8] = {DISPERSION_RETRO, 4},          [9] = {DISPERSION_EXOTIC, 6}};
    dispersion *law = &r->law;
    if (number < 1 || number > 9)
        return wrong(r, "use formulas 1 to 9", "formula %d is unknown", number);
    for (; count < of[number].least; count++)
        c[count] = 0.0;
    for (int i = 2; number == 1 && i < count; i += 2) /* lengths C instead of their squares */
        c[i] *= c[i];
    law->kind = of[number].kind;
    law->count = count;
    memcpy(law->coefficient, c, (size_t)count * sizeof *c);
    r->has_law = true;
    diagnostic bad = {.what = ""};
    const status code = dispersion_check_numbers(law, &bad);
    return code == STATUS_OK ? code : wrong(r, bad.remedy, "%s", bad.what);
}

static status read_formula(optical_reader *r, const node *block, int number)
{
    const node *list = node_get(block, "coefficients"), *range = node_get(block, "wavelength_range");
    double c[DISPERSION_TERMS_MAX], ends[2];
    r->line = block->line;
    const int count = list && list->text ? numbers_in(list->text, c, DISPERSION_TERMS_MAX) : -1;
    if (count < 1 || !range || !range->text || numbers_in(range->text, ends, 2) != 2)
        return wrong(r, "give coefficients and wavelength_range: LOW HIGH, in um",
                     "its formula lacks coefficients or a range of wavelengths");
    r->law.low_nm = fmin(ends[0], ends[1]) * NM_PER_UM, r->law.high_nm = fmax(ends[0], ends[1]) * NM_PER_UM;
    return set_formula(r, number, c, count);
}

/* Lines of a wavelength and n, k or both. */
static status read_tabulated(optical_reader *r, const node *block, const char *what)
{
    const node *data = node_get(block, "data");
    const bool both = strcmp(what, "nk") == 0;
    if (!data || !data->text)
        return wrong(r, "give lines of numbers", "its table has no data");
    point_list *first = strcmp(what, "k") == 0 ? &r->second : &r->first;
    r->line = data->line;
    for (const char *at = data->text; *at;) {
        const char *end = strchrnul(at, '\n');
        double number[3];
        char *line = strndup(at, (size_t)(end - at));
        if (!line)
            return out_of_memory(r->why);
        r->line++;
        const int count = numbers_in(line, number, 3);
        free(line);
        at = *end ? end + 1 : end;
        if (count == 0)
            continue;
        if (count != 2 + both)
            return wrong(r, both ? "give a wavelength, n and k" : "give a wavelength and a value",
                         "a line of its table has not %d numbers", 2 + both);
        TRY(add_point(r, first, number[0] * NM_PER_UM, number[1]));
        if (both)
            TRY(add_point(r, &r->second, number[0] * NM_PER_UM, number[2]));
    }
    return STATUS_OK;
}

static status read_block(optical_reader *r, const node *block)
{
    const node *type = node_get(block, "type");
    const char *word = type && type->text ? type->text : "";
    r->line = block->line;
    if (strncmp(word, "formula ", 8) == 0)
        return read_formula(r, block, atoi(word + 8));
    if (strcmp(word, "tabulated n") == 0 || strcmp(word, "tabulated k") == 0 || strcmp(word, "tabulated nk") == 0)
        return read_tabulated(r, block, word + strlen("tabulated "));
    return STATUS_OK; /* such as tabulated n2, the nonlinear index */
}

static status read_database(optical_reader *r, const char *text, size_t size)
{
    document *d;
    TRY(document_parse(r->name, text, size, &d, r->why));
    const node *data = document_root(d)->kind == NODE_MAP ? node_get(document_root(d), "DATA") : NULL;
    r->line = document_root(d)->line;
    status code = data && data->kind == NODE_LIST
                      ? STATUS_OK
                      : wrong(r, "give a list DATA with a type, as the files of refractiveindex.info do",
                              "this is not a file of refractiveindex.info");
    for (size_t i = 0; code == STATUS_OK && i < data->count; i++)
        code = data->items[i]->kind == NODE_MAP ? read_block(r, data->items[i]) : STATUS_OK;
    if (code == STATUS_OK && !r->has_law && r->first.count == 0 && r->second.count == 0)
        code = wrong(r, "use another data set", "it has neither n nor k");
    document_destroy(d);
    return code;
}

/* --- glass catalogues --- */

/* One of the 13 formulas of the AGF format as a law, from its coefficients. Zemax, OpticStudio User Guide, "Glass
 * dispersion formulas". */
static status set_glass_formula(optical_reader *r, int number, const double *c)
{
    static const double powers[][9] = {[1] = {0, 2, -2, -4, -6, -8},
                                       [10] = {0, 2, -2, -4, -6, -8, -10, -12},
                                       [12] = {0, 2, -2, -4, -6, -8, 4, 6},
                                       [13] = {0, 2, 4, -2, -4, -6, -8, -10, -12}};
    static const int terms[] = {[1] = 6, [2] = 3, [6] = 4, [10] = 8, [11] = 5, [12] = 8, [13] = 9};
    double a[DISPERSION_TERMS_MAX] = {0};
    switch (number) {
    case 1:
    case 10:
    case 12:
    case 13:
        a[0] = c[0];
        for (int i = 1; i < terms[number]; i++)
            a[2 * i - 1] = c[i], a[2 * i] = powers[number][i];
        return set_formula(r, 3, a, 2 * terms[number] - 1);
    case 2:
    case 6:
    case 11:
        memcpy(a + 1, c, 2 * (size_t)terms[number] * sizeof *c);
        return set_formula(r, 2, a, 2 * terms[number] + 1);
    case 3: memcpy(a, c, 6 * sizeof *c); return set_formula(r, 7, a, 6);
    case 4: return set_formula(r, 4, (double[16]){1.0 + c[0], c[1], 2, c[2], 2, c[3], 0, c[4], 2}, 9);
    case 5: return set_formula(r, 5, (double[16]){c[0], c[1], -1, c[2], -3.5}, 5);
    case 7: return set_formula(r, 4, (double[16]){c[0], c[1], 0, c[2], 1, 0, 0, 0, 0, -c[3], 2}, 11);
    case 8: return set_formula(r, 4, (double[16]){c[0], c[1], 2, c[2], 1, 0, 0, 0, 0, -c[3], 2}, 11);
    case 9: return set_formula(r, 4, (double[16]){c[0], c[1], 2, c[2], 1, c[3], 2, c[4], 1}, 9);
    default: return wrong(r, "use a formula from 1 to 13", "the glass has the unknown formula %d", number);
    }
}

/* A glass in a catalogue, by its lines. */
typedef struct glass_lines {
    int formula;
    double c[10], ends[2];
    int terms;
    bool in_c, has_ends;
} glass_lines;

/* IT: wavelength in um, internal transmittance, thickness in mm. By the law of Beer and Lambert, T = exp(-4 pi k d /
 * lambda). */
static status read_transmittance(optical_reader *r, const char *text)
{
    enum { LEAST = 3 };
    const double ln_2 = 0.69314718055994530942, four_pi = 12.566370614359172954;
    double n[4];
    if (numbers_in(text, n, 4) < LEAST || !(n[0] > 0.0 && n[2] > 0.0) || !(n[1] > 0.0))
        return STATUS_OK; /* not measured, or too little to measure */
    const double lambda_nm = n[0] * NM_PER_UM, thickness_nm = n[2] * 1e6;
    const double k = -ln_2 * elementary_log2_inline(fmin(n[1], 1.0)) * lambda_nm / (four_pi * thickness_nm);
    if (r->second.count > 0 && r->second.point[2 * r->second.count - 2] == lambda_nm) {
        r->second.point[2 * r->second.count - 1] = k; /* a thicker sample comes later */
        return STATUS_OK;
    }
    return add_point(r, &r->second, lambda_nm, fmax(k, 0.0));
}

/* The numbers of CD may go on in the next lines. */
static void read_coefficients(glass_lines *g, const char *text)
{
    const int room = 10 - g->terms, read = room > 0 ? numbers_in(text, g->c + g->terms, room) : 0;
    g->in_c = read >= 0;
    g->terms += read > 0 ? read : 0;
}

static status read_glass_line(optical_reader *r, glass_lines *g, const char *line)
{
    const bool is_word = isupper((unsigned char)line[0]) && isupper((unsigned char)line[1]);
    if (strncmp(line, "CD ", 3) == 0)
        memset(g->c, 0, sizeof g->c), g->terms = 0, read_coefficients(g, line + 3);
    else if (g->in_c && !is_word)
        read_coefficients(g, line);
    else
        g->in_c = false;
    if (strncmp(line, "LD ", 3) == 0)
        g->has_ends = numbers_in(line + 3, g->ends, 2) == 2;
    return strncmp(line, "IT ", 3) == 0 ? read_transmittance(r, line + 3) : STATUS_OK;
}

static status end_glass(optical_reader *r, const glass_lines *g, const char *name)
{
    if (g->terms == 0 || !g->has_ends)
        return wrong(r, "give lines CD and LD", "the glass %.60s lacks coefficients or a range of wavelengths", name);
    r->law.low_nm = g->ends[0] * NM_PER_UM, r->law.high_nm = g->ends[1] * NM_PER_UM;
    return set_glass_formula(r, g->formula, g->c);
}

/* The glasses' names, for suggestions. */
typedef struct name_list {
    char **name;
    size_t count, room;
} name_list;

static status no_glass(const optical_reader *r, const name_list *names)
{
    char remedy[300];
    if (!*r->of->glass)
        return wrong(r, "give glass: NAME", "the catalogue has %zu glasses", names->count);
    suggest_key(r->of->glass, (const char *const *)names->name, names->count, remedy, sizeof remedy);
    return wrong(r, remedy, "the catalogue has no glass '%.60s'", r->of->glass);
}

/* The name in a line "NM name formula ..."; false if there is none. */
static bool glass_name(const char *line, char name[64], int *formula)
{
    return sscanf(line, "NM %63s %d", name, formula) == 2;
}

static status scan_catalogue(optical_reader *r, char *text, name_list *names)
{
    glass_lines g = {0};
    char name[64] = "", chosen[64] = "";
    bool inside = false;
    status code = STATUS_OK;
    char *rest = text;
    for (char *line = strsep(&rest, "\n"); line && code == STATUS_OK; line = strsep(&rest, "\n")) {
        int formula = 0;
        r->line++;
        if (!glass_name(line, name, &formula)) {
            code = inside ? read_glass_line(r, &g, line) : STATUS_OK;
            continue;
        }
        if (!GROW(names->name, names->room, names->count + 1) || !(names->name[names->count] = strdup(name)))
            return out_of_memory(r->why);
        names->count++;
        inside = !*chosen && (strcasecmp(name, r->of->glass) == 0 || !*r->of->glass);
        if (inside)
            g.formula = formula, memcpy(chosen, name, sizeof chosen);
    }
    if (code == STATUS_OK && (!*chosen || (!*r->of->glass && names->count > 1)))
        return no_glass(r, names);
    return code == STATUS_OK ? end_glass(r, &g, chosen) : code;
}

static status read_catalogue(optical_reader *r, char *text)
{
    name_list names = {0};
    const status code = scan_catalogue(r, text, &names);
    for (size_t i = 0; i < names.count; i++)
        free(names.name[i]);
    free(names.name);
    return code;
}

/* --- tables of numbers --- */

enum { CELLS_MAX = 64, CELL_BYTES = 64 };

/* A line divided into cells without quotes and surrounding blanks. */
typedef struct table_line {
    char cell[CELLS_MAX][CELL_BYTES];
    int count;
} table_line;

typedef struct table_reader {
    optical_reader *r;
    table_line header, line;
    int column, k; /* of the quantity and of k; -1: none */
    bool of_k;     /* a second header has begun the table of k */
    size_t rows;
} table_reader;

static void add_cell(table_line *l, const char *from, size_t length, bool decimal_comma)
{
    while (length > 0 && strchr(" \t\"'", from[length - 1]))
        length--;
    while (length > 0 && strchr(" \t\"'", *from))
        from++, length--;
    if (l->count == CELLS_MAX)
        return;
    char *to = l->cell[l->count++];
    snprintf(to, CELL_BYTES, "%.*s", (int)length, from);
    for (char *c = decimal_comma ? strchr(to, ',') : NULL; c; c = NULL)
        *c = '.';
}

static void divide(const char *text, table_line *l)
{
    const char *between = strchr(text, ';') ? ";" : strchr(text, '\t') ? "\t" : strchr(text, ',') ? "," : " ";
    const bool blanks = *between == ' ', tabs = *between == '\t';
    l->count = 0;
    if (blanks || tabs)
        text += strspn(text, " ");
    while (*text) {
        const size_t length = strcspn(text, between);
        add_cell(l, text, length, *between != ',');
        text += length;
        if (*text)
            text += blanks ? strspn(text, " ") : 1;
    }
}

static bool is_number(const char *cell, double *value)
{
    const char *at = cell;
    return number_scan(&at, value) && (!*at || strcmp(at, "%") == 0);
}

/* The column of a name, or of a number from 2; -1 if there is none. */
static int column_named(const table_line *header, const char *name)
{
    int64_t number;
    if (number_parse_int(name, &number))
        return number >= 2 && number <= CELLS_MAX ? (int)number - 1 : -1;
    for (int i = 0; i < header->count; i++)
        if (strcasecmp(header->cell[i], name) == 0)
            return i;
    return -1;
}

static bool says_k(const char *header)
{
    return strcasecmp(header, "k") == 0 || strcasecmp(header, "kappa") == 0 || strcasecmp(header, "extinction") == 0;
}

/* Chooses the columns when the first row of numbers is there. */
static status begin_table(table_reader *t)
{
    const char *name = t->r->of->column;
    const bool headed = t->header.count >= 2;
    t->column = *name ? column_named(&t->header, name) : 1;
    if (t->column < 1 || t->column >= t->line.count)
        return *name ? wrong(t->r, headed ? "give a column of its header, or a number from 2" : "give a number from 2",
                             "it has no column '%.60s'", name)
                     : wrong(t->r, "give lines of a wavelength and a value", "it has fewer than two columns");
    t->k = -1;
    if (*name || t->line.count < 3)
        return STATUS_OK;
    if (headed ? t->header.count > 2 && says_k(t->header.cell[2]) : t->line.count == 3)
        t->k = 2;
    return STATUS_OK;
}

static status read_row(table_reader *t, double lambda)
{
    double value, k;
    if (t->rows++ == 0)
        TRY(begin_table(t));
    const int needed = t->k > t->column ? t->k : t->column;
    if (t->line.count <= needed || !is_number(t->line.cell[t->column], &value) ||
        (t->k > 0 && !is_number(t->line.cell[t->k], &k)))
        return wrong(t->r, "give a number in each row", "column %d has no number here", t->column + 1);
    TRY(add_point(t->r, t->of_k ? &t->r->second : &t->r->first, lambda, value * (t->of_k ? 1.0 : t->r->of->scale)));
    return t->k > 0 ? add_point(t->r, &t->r->second, lambda, k) : STATUS_OK;
}

static status read_line(table_reader *t, const char *text)
{
    double lambda;
    t->r->line++;
    if (*text == '#')
        return STATUS_OK;
    divide(text, &t->line);
    if (t->line.count == 0)
        return STATUS_OK;
    if (is_number(t->line.cell[0], &lambda))
        return read_row(t, lambda);
    if (t->rows == 0) {
        t->header = t->line;
        return STATUS_OK;
    }
    if (t->line.count >= 2 && says_k(t->line.cell[1]) && !t->of_k && t->r->second.count == 0) {
        t->of_k = true;
        return STATUS_OK;
    }
    return strncmp(text, ">>>", 3) == 0
               ? STATUS_OK /* the end mark of a spectrometer */
               : wrong(t->r, "give lines of numbers", "'%.40s' is not a number", t->line.cell[0]);
}

/* Whether the wavelengths are in um. */
static bool in_um(const table_reader *t)
{
    const char *unit = t->header.count > 0 ? t->header.cell[0] : "";
    if (strcasestr(unit, "nm") || strcasestr(unit, "nano"))
        return false;
    if (strcasestr(unit, "um") || strcasestr(unit, "\xc2\xb5m") || strcasestr(unit, "\xce\xbcm") ||
        strcasestr(unit, "micro"))
        return true;
    bool below = true;
    for (size_t i = 0; i < t->r->first.count; i++)
        below &= t->r->first.point[2 * i] < 100.0;
    return below;
}

static void to_nm(point_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        l->point[2 * i] *= NM_PER_UM;
}

static status read_table(optical_reader *r, char *text)
{
    table_reader *t = calloc(1, sizeof *t);
    status code = t ? STATUS_OK : out_of_memory(r->why);
    if (t)
        t->r = r;
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0)
        text += 3;
    for (char *line = strsep(&text, "\n"); line && code == STATUS_OK; line = strsep(&text, "\n"))
        code = read_line(t, line);
    if (code == STATUS_OK && r->first.count == 0)
        code = wrong(r, "give lines of a wavelength and a value", "it has no row of numbers");
    if (code == STATUS_OK && in_um(t))
        to_nm(&r->first), to_nm(&r->second);
    free(t);
    return code;
}

/* --- any file --- */

static bool ends_in(const char *name, const char *ending)
{
    const size_t a = strlen(name), b = strlen(ending);
    return a >= b && strcasecmp(name + a - b, ending) == 0;
}

static status read_text(optical_reader *r, const char *text, size_t size)
{
    if (ends_in(r->name, ".yml") || ends_in(r->name, ".yaml"))
        return read_database(r, text, size);
    char *plain = text_narrow(text, size);
    if (!plain)
        return out_of_memory(r->why);
    const status code = ends_in(r->name, ".agf") ? read_catalogue(r, plain) : read_table(r, plain);
    free(plain);
    return code;
}

status optical_file_parse(const char *name, const char *text, size_t size, const optical_file_choice *of,
                          const optical_data **out, diagnostic *why)
{
    optical_reader r = {.name = name, .of = of, .why = why};
    *out = NULL;
    status code = read_text(&r, text, size);
    if (code == STATUS_OK) {
        arrange(&r.first), arrange(&r.second), raise_k(&r.second);
        code = optical_data_create(r.has_law ? &r.law : NULL, (optical_curve){r.first.point, r.first.count},
                                   (optical_curve){r.second.point, r.second.count}, out, why);
        if (code != STATUS_OK)
            diagnostic_locate(why, name, 0, 0);
    }
    free(r.first.point);
    free(r.second.point);
    return code;
}

status optical_file_read(const char *path, const char *root, const optical_file_choice *of, const optical_data **out,
                         diagnostic *why)
{
    enum { BYTES_MAX = 1 << 26 };
    char *text;
    size_t size;
    *out = NULL;
    TRY(file_read_below(path, root, BYTES_MAX, &text, &size, why));
    const status code = optical_file_parse(path, text, size, of, out, why);
    free(text);
    return code;
}
