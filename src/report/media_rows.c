/* Prints the catalogues of media and metals as tables, one entry in detail, or all as JSON. */
#include "base/json_build.h"
#include "base/number.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "report/report.h"
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

/* --- media --- */

typedef struct spectral_line {
    const char *name;
    double lambda_nm;
} spectral_line;

static const spectral_line lines[] = {
    {"n_d", LINE_HELIUM_D_NM}, {"n_F", LINE_HYDROGEN_F_NM}, {"n_C", LINE_HYDROGEN_C_NM}, {"n_D", LINE_SODIUM_D_NM}};

enum { LINES_TABLE = 3, LINES_ALL = 4 }; /* the table has no column for the sodium line */

char *media_range_text(const medium *m, char text[MEDIA_RANGE_MAX])
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    const dispersion *law = &m->law;
    if (law->high_nm == 0.0)
        snprintf(text, MEDIA_RANGE_MAX, "-");
    else if (law->low_nm == law->high_nm)
        snprintf(text, MEDIA_RANGE_MAX, "%s", number_format(law->low_nm, low));
    else
        snprintf(text, MEDIA_RANGE_MAX, "%s..%s", number_format(law->low_nm, low), number_format(law->high_nm, high));
    return text;
}

static const char *temperature_text(const medium *m, char text[NUMBER_TEXT_MAX])
{
    return isnan(m->temperature_c) ? "room" : number_format(m->temperature_c, text);
}

static const char *reference_of(const medium *m)
{
    return m->relative_to_air ? "air" : "vacuum";
}

enum { CELLS_MAX = 192, TABLE_WIDTH = 79, AT_WIDTH = 9, LABEL_WIDTH = 16 };

/* Whether the terminal is too narrow for columns of range, temperature and reference, which are then written before the
 * source, in its column. */
static bool is_narrow(double at_nm, int columns)
{
    return columns && columns < TABLE_WIDTH + (at_nm > 0.0 ? AT_WIDTH : 0);
}

/* Appends a cell to the cells of a row. */
static void put(char cells[CELLS_MAX], const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(char cells[CELLS_MAX], const char *format, ...)
{
    const size_t used = strlen(cells);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(cells + used, CELLS_MAX - used, format, arguments);
    va_end(arguments);
}

static void put_indices(char cells[CELLS_MAX], const medium *m, double at_nm)
{
    const double abbe = dispersion_abbe_number(&m->law);
    put(cells, "%-12s", m->name);
    for (int i = 0; i < LINES_TABLE; i++) {
        const double lambda_nm = lines[i].lambda_nm;
        put(cells, "  %.5f%c", dispersion_index(&m->law, lambda_nm),
            dispersion_covers(&m->law, lambda_nm, lambda_nm) ? ' ' : '*');
    }
    if (isfinite(abbe))
        put(cells, "  %5.2f%c", abbe, dispersion_covers(&m->law, LINE_HYDROGEN_F_NM, LINE_HYDROGEN_C_NM) ? ' ' : '*');
    else
        put(cells, "  %5s ", "-");
    if (at_nm > 0.0 && dispersion_covers(&m->law, at_nm, at_nm))
        put(cells, "  %.5f", dispersion_index(&m->law, at_nm));
    else if (at_nm > 0.0)
        put(cells, "  %-7s", "-");
    put(cells, "  ");
}

static void print_row(FILE *stream, const medium *m, double at_nm, int columns)
{
    char text[NUMBER_TEXT_MAX], range[MEDIA_RANGE_MAX], cells[CELLS_MAX] = "";
    const char *temperature = temperature_text(m, text);
    media_range_text(m, range);
    put_indices(cells, m, at_nm);
    if (is_narrow(at_nm, columns)) {
        wrap_row(stream, columns, cells, "%s; %s; %s; %s", range, temperature, reference_of(m), m->source);
        return;
    }
    put(cells, "%-11s  %-4s  %-8s  ", range, temperature, reference_of(m));
    wrap_row(stream, columns, cells, "%s", m->source);
}

void media_rows_table(FILE *stream, double at_nm, int columns)
{
    char cells[CELLS_MAX] = "";
    put(cells, "%-12s  %-8s  %-8s  %-8s  %5s   ", "name", lines[0].name, lines[1].name, lines[2].name, "V_d");
    if (at_nm > 0.0)
        put(cells, "%-7s  ", "n_at");
    if (is_narrow(at_nm, columns)) {
        wrap_row(stream, columns, cells, "range_nm; T_C; relative; source");
    } else {
        put(cells, "%-11s  %-4s  %-8s  ", "range_nm", "T_C", "relative");
        wrap_row(stream, columns, cells, "source");
    }
    for (size_t i = 0; i < media_count(); i++)
        print_row(stream, media_at(i), at_nm, columns);
}

static const char *label(const char *name, char text[LABEL_WIDTH + 1])
{
    snprintf(text, LABEL_WIDTH + 1, "%-*s", LABEL_WIDTH, name);
    return text;
}

static void print_index(FILE *stream, const medium *m, const char *name, double lambda_nm, int columns)
{
    char at[NUMBER_TEXT_MAX], start[LABEL_WIDTH + 1], absolute[64] = "";
    if (m->relative_to_air)
        snprintf(absolute, sizeof absolute, ", relative to vacuum %.8f", medium_index(m, lambda_nm));
    wrap_row(stream, columns, label(name, start), "%.8f at %s nm%s%s", dispersion_index(&m->law, lambda_nm),
             number_format(lambda_nm, at), absolute,
             dispersion_covers(&m->law, lambda_nm, lambda_nm) ? "" : ", extrapolated");
}

static void print_law(FILE *stream, const dispersion *law, int columns)
{
    char start[LABEL_WIDTH + 1], all[DISPERSION_TERMS_MAX * NUMBER_TEXT_MAX] = "", text[NUMBER_TEXT_MAX];
    wrap_row(stream, columns, label("law", start), "%s: %s", dispersion_name(law->kind), dispersion_formula(law->kind));
    for (int i = 0; i < law->count; i++) {
        const size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i ? " " : "", number_format(law->coefficient[i], text));
    }
    wrap_row(stream, columns, label("coefficients", start), "%s", all);
}

void media_rows_details(FILE *stream, const medium *m, double at_nm, int columns)
{
    char text[NUMBER_TEXT_MAX], range[MEDIA_RANGE_MAX], start[LABEL_WIDTH + 1];
    const double abbe = dispersion_abbe_number(&m->law);
    wrap_row(stream, columns, label("name", start), "%s", m->name);
    wrap_row(stream, columns, label("medium", start), "%s", m->title);
    for (int i = 0; i < LINES_ALL; i++)
        print_index(stream, m, lines[i].name, lines[i].lambda_nm, columns);
    if (isfinite(abbe))
        wrap_row(stream, columns, label("V_d", start), "%.4f%s", abbe,
                 dispersion_covers(&m->law, LINE_HYDROGEN_F_NM, LINE_HYDROGEN_C_NM) ? "" : ", extrapolated");
    else
        wrap_row(stream, columns, label("V_d", start), "none: the index is constant");
    if (at_nm > 0.0)
        print_index(stream, m, "n_at", at_nm, columns);
    wrap_row(stream, columns, label("relative to", start), "%s", reference_of(m));
    wrap_row(stream, columns, label("range", start), "%s nm", media_range_text(m, range));
    wrap_row(stream, columns, label("temperature", start), "%s%s", temperature_text(m, text),
             isnan(m->temperature_c) ? "" : " C");
    print_law(stream, &m->law, columns);
    wrap_row(stream, columns, label("source", start), "%s", m->source);
    wrap_row(stream, columns, label("compared with", start), "%s", m->verified);
    if (m->note[0])
        wrap_row(stream, columns, label("note", start), "%s", m->note);
}

/* The indices at the spectral lines, as published or relative to vacuum (absolute). */
static json_t *indices_json(const medium *m, bool absolute)
{
    json_t *o = json_object();
    int bad = 0;
    for (int i = 0; i < LINES_ALL; i++) {
        const double lambda_nm = lines[i].lambda_nm;
        const double n = absolute ? medium_index(m, lambda_nm) : dispersion_index(&m->law, lambda_nm);
        bad |= json_object_set_new(o, lines[i].name, json_of_real(n));
    }
    bad |= absolute ? 0 : json_object_set_new(o, "V_d", json_of_real(dispersion_abbe_number(&m->law)));
    return json_if(o, bad == 0);
}

static json_t *extrapolated_json(const medium *m)
{
    json_t *list = json_array();
    for (int i = 0; list && i < LINES_ALL; i++)
        if (!dispersion_covers(&m->law, lines[i].lambda_nm, lines[i].lambda_nm))
            json_add(&list, json_string(lines[i].name));
    return list;
}

static json_t *coefficients_json(const dispersion *law)
{
    json_t *list = json_array();
    for (int i = 0; list && i < law->count; i++)
        json_add(&list, json_of_real(law->coefficient[i]));
    return list;
}

static json_t *at_json(const medium *m, double at_nm)
{
    const bool covered = dispersion_covers(&m->law, at_nm, at_nm);
    return json_pack("{s:o,s:o,s:o}", "lambda_nm", json_of_real(at_nm), "n",
                     json_of_real(covered ? dispersion_index(&m->law, at_nm) : (double)NAN), "n_absolute",
                     json_of_real(covered ? medium_index(m, at_nm) : (double)NAN));
}

static json_t *medium_json(const medium *m, double at_nm)
{
    json_t *o = json_object();
    int bad = json_object_set_new(o, "name", json_string(m->name));
    bad |= json_object_set_new(o, "title", json_string(m->title));
    bad |= json_object_update_new(o, indices_json(m, false));
    bad |= json_object_set_new(o, "absolute", indices_json(m, true));
    bad |= json_object_set_new(o, "extrapolated", extrapolated_json(m));
    bad |= at_nm > 0.0 ? json_object_set_new(o, "at", at_json(m, at_nm)) : 0;
    bad |= json_object_set_new(o, "relative_to", json_string(reference_of(m)));
    bad |= json_object_set_new(o, "low_nm", m->law.low_nm > 0.0 ? json_of_real(m->law.low_nm) : json_null());
    bad |= json_object_set_new(o, "high_nm", m->law.high_nm > 0.0 ? json_of_real(m->law.high_nm) : json_null());
    bad |= json_object_set_new(o, "temperature_c", json_of_real(m->temperature_c));
    bad |= json_object_set_new(o, "law", json_string(dispersion_name(m->law.kind)));
    bad |= json_object_set_new(o, "formula", json_string(dispersion_formula(m->law.kind)));
    bad |= json_object_set_new(o, "coefficients", coefficients_json(&m->law));
    bad |= json_object_set_new(o, "source", json_string(m->source));
    bad |= json_object_set_new(o, "verified", json_string(m->verified));
    bad |= json_object_set_new(o, "note", json_string(m->note));
    return json_if(o, bad == 0);
}

/* --- metals --- */

typedef struct metal_line {
    const char *name; /* of the spectral line */
    const char *n, *k, *R;
    double lambda_nm;
} metal_line;

static const metal_line metal_lines[] = {{"d", "n_d", "k_d", "R_d", LINE_HELIUM_D_NM},
                                         {"F", "n_F", "k_F", "R_F", LINE_HYDROGEN_F_NM},
                                         {"C", "n_C", "k_C", "R_C", LINE_HYDROGEN_C_NM},
                                         {"D", "n_D", "k_D", "R_D", LINE_SODIUM_D_NM}};

bool metal_covers(const metal *m, double lambda_nm)
{
    return dispersion_covers(&m->n, lambda_nm, lambda_nm);
}

char *metal_range_text(const metal *m, char text[METAL_RANGE_MAX])
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    snprintf(text, METAL_RANGE_MAX, "%s..%s", number_format(m->n.coefficient[0], low),
             number_format(m->n.coefficient[m->n.count - 2], high));
    return text;
}

/* Ends a row with its range and source: in columns, or in running text if the terminal is narrow. */
static void finish_row(FILE *stream, int columns, char cells[CELLS_MAX], const char *range, const char *source)
{
    enum { RANGE_WIDTH = 16, SOURCE_LEAST = 24 };
    const size_t used = strlen(cells);
    if (columns > 0 && (size_t)columns < used + RANGE_WIDTH + SOURCE_LEAST) {
        wrap_row(stream, columns, cells, "%s; %s", range, source);
        return;
    }
    snprintf(cells + used, CELLS_MAX - used, "%-*s", RANGE_WIDTH, range);
    wrap_row(stream, columns, cells, "%s", source);
}

void metal_rows_table(FILE *stream, double at_nm, int columns)
{
    char cells[CELLS_MAX], range[METAL_RANGE_MAX];
    int used = snprintf(cells, sizeof cells, "%-12s", "metal");
    for (int i = 0; i < LINES_TABLE; i++)
        used += snprintf(cells + used, sizeof cells - (size_t)used, "  %-6s  %-6s", metal_lines[i].n, metal_lines[i].k);
    snprintf(cells + used, sizeof cells - (size_t)used, "  %-5s  %s", metal_lines[0].R,
             at_nm > 0.0 ? "n_at    k_at    " : "");
    finish_row(stream, columns, cells, "range_nm", "source");
    for (size_t k = 0; k < metals_count(); k++) {
        const metal *m = metals_at(k);
        used = snprintf(cells, sizeof cells, "%-12s", m->name);
        for (int i = 0; i < LINES_TABLE; i++) {
            const complex_pair index = metal_index(m, metal_lines[i].lambda_nm);
            used += snprintf(cells + used, sizeof cells - (size_t)used, "  %.4f  %.4f", index.re, index.im);
        }
        used += snprintf(cells + used, sizeof cells - (size_t)used, "  %.3f  ",
                         metal_reflectance(m, metal_lines[0].lambda_nm));
        const complex_pair at = metal_index(m, at_nm);
        if (at_nm > 0.0 && metal_covers(m, at_nm))
            snprintf(cells + used, sizeof cells - (size_t)used, "%.4f  %.4f  ", at.re, at.im);
        else if (at_nm > 0.0)
            snprintf(cells + used, sizeof cells - (size_t)used, "%-6s  %-6s  ", "-", "-");
        finish_row(stream, columns, cells, metal_range_text(m, range), m->source);
    }
}

static void print_metal_index(FILE *stream, const metal *m, const char *name, double lambda_nm, int columns)
{
    char at[NUMBER_TEXT_MAX], start[LABEL_WIDTH + 1];
    const complex_pair index = metal_index(m, lambda_nm);
    wrap_row(stream, columns, label(name, start), "%.4f + i %.4f at %s nm, R %.4f in vacuum", index.re, index.im,
             number_format(lambda_nm, at), metal_reflectance(m, lambda_nm));
}

void metal_rows_details(FILE *stream, const metal *m, double at_nm, int columns)
{
    char range[METAL_RANGE_MAX], start[LABEL_WIDTH + 1], a[NUMBER_TEXT_MAX], b[NUMBER_TEXT_MAX], c[NUMBER_TEXT_MAX];
    wrap_row(stream, columns, label("name", start), "%s", m->name);
    wrap_row(stream, columns, label("metal", start), "%s", m->title);
    for (int i = 0; i < LINES_ALL; i++)
        print_metal_index(stream, m, metal_lines[i].n, metal_lines[i].lambda_nm, columns);
    if (at_nm > 0.0)
        print_metal_index(stream, m, "n_at", at_nm, columns);
    wrap_row(stream, columns, label("relative to", start), "vacuum");
    wrap_row(stream, columns, label("range", start), "%s nm", metal_range_text(m, range));
    wrap_row(stream, columns, label("law", start), "linear between rows of wavelength in nm, n and k");
    for (int i = 0; i < m->n.count; i += 2)
        wrap_row(stream, columns, label("", start), "%-7s %-8s %s", number_format(m->n.coefficient[i], a),
                 number_format(m->n.coefficient[i + 1], b), number_format(m->k.coefficient[i + 1], c));
    wrap_row(stream, columns, label("source", start), "%s", m->source);
    wrap_row(stream, columns, label("compared with", start), "%s", m->verified);
    if (m->note[0])
        wrap_row(stream, columns, label("note", start), "%s", m->note);
}

static json_t *points_json(const metal *m)
{
    json_t *list = json_array();
    for (int i = 0; list && i < m->n.count; i += 2)
        json_add(&list, json_pack("[o,o,o]", json_of_real(m->n.coefficient[i]), json_of_real(m->n.coefficient[i + 1]),
                                  json_of_real(m->k.coefficient[i + 1])));
    return list;
}

static json_t *metal_at_json(const metal *m, double at_nm)
{
    const bool covered = metal_covers(m, at_nm);
    const complex_pair index = metal_index(m, at_nm);
    return json_pack("{s:o,s:o,s:o}", "lambda_nm", json_of_real(at_nm), "n",
                     json_of_real(covered ? index.re : (double)NAN), "k",
                     json_of_real(covered ? index.im : (double)NAN));
}

static json_t *metal_json(const metal *m, double at_nm)
{
    json_t *o = json_object();
    int bad = json_object_set_new(o, "name", json_string(m->name));
    bad |= json_object_set_new(o, "title", json_string(m->title));
    for (int i = 0; i < LINES_ALL; i++) {
        const complex_pair index = metal_index(m, metal_lines[i].lambda_nm);
        bad |= json_object_set_new(o, metal_lines[i].n, json_of_real(index.re));
        bad |= json_object_set_new(o, metal_lines[i].k, json_of_real(index.im));
        bad |= json_object_set_new(o, metal_lines[i].R, json_of_real(metal_reflectance(m, metal_lines[i].lambda_nm)));
    }
    bad |= at_nm > 0.0 ? json_object_set_new(o, "at", metal_at_json(m, at_nm)) : 0;
    bad |= json_object_set_new(o, "low_nm", json_of_real(m->n.coefficient[0]));
    bad |= json_object_set_new(o, "high_nm", json_of_real(m->n.coefficient[m->n.count - 2]));
    bad |= json_object_set_new(o, "points", points_json(m));
    bad |= json_object_set_new(o, "source", json_string(m->source));
    bad |= json_object_set_new(o, "verified", json_string(m->verified));
    bad |= json_object_set_new(o, "note", json_string(m->note));
    return json_if(o, bad == 0);
}

/* --- coatings --- */

static const double coating_nm[] = {450.0, 500.0, 550.0, 600.0, 650.0};
enum { COATING_LINES = sizeof coating_nm / sizeof *coating_nm };

typedef struct coating_powers {
    double R, T;
} coating_powers;

/* Of unpolarised light at an angle from air, on bk7. */
static coating_powers coating_powers_at(const coating_design *d, double angle_deg, double lambda_nm)
{
    coating_layers layers;
    film_stack stack;
    thin_film films[FILMS_MAX];
    const double cosine = cos(angle_deg * 0.017453292519943295769), glass = medium_index(media_find("bk7"), lambda_nm);
    if (coating_parse(d->name, &layers, NULL) != STATUS_OK)
        return (coating_powers){(double)NAN, (double)NAN};
    film_stack_make((thin_film){{1.0, 0.0}, 0.0}, &layers, NULL, false, &stack);
    const int count = film_stack_films(&stack, lambda_nm, true, films);
    const sp_amplitudes a = multilayer_amplitudes(cosine, medium_index(media_at(0), lambda_nm), films, count,
                                                  complex_of(glass, 0.0), lambda_nm);
    return (coating_powers){0.5 * (complex_norm2(a.r_s) + complex_norm2(a.r_p)),
                            0.5 * (complex_norm2(a.t_s) + complex_norm2(a.t_p))};
}

void coating_rows_table(FILE *stream, double at_nm, int columns)
{
    char cells[CELLS_MAX] = "";
    put(cells, "%-18s", "name");
    for (int i = 0; i < COATING_LINES; i++)
        put(cells, "  R_%-4.0f", coating_nm[i]);
    put(cells, at_nm > 0.0 ? "  R_at  " : "");
    put(cells, "  ");
    wrap_row(stream, columns, cells, "coating");
    for (size_t k = 0; k < coating_designs_count(); k++) {
        const coating_design *d = coating_design_at(k);
        cells[0] = 0;
        put(cells, "%-18s", d->name);
        for (int i = 0; i < COATING_LINES; i++)
            put(cells, "  %.4f", coating_powers_at(d, 0.0, coating_nm[i]).R);
        if (at_nm > 0.0)
            put(cells, "  %.4f", coating_powers_at(d, 0.0, at_nm).R);
        put(cells, "  ");
        wrap_row(stream, columns, cells, "%s", d->title);
    }
}

static void print_powers(FILE *stream, const coating_design *d, const char *name, double lambda_nm, int columns)
{
    char at[NUMBER_TEXT_MAX], start[LABEL_WIDTH + 1];
    const coating_powers ahead = coating_powers_at(d, 0.0, lambda_nm), aslant = coating_powers_at(d, 45.0, lambda_nm);
    wrap_row(stream, columns, label(name, start), "R %.5f and T %.5f at %s nm; at 45 degrees %.5f and %.5f", ahead.R,
             ahead.T, number_format(lambda_nm, at), aslant.R, aslant.T);
}

void coating_rows_details(FILE *stream, const coating_design *d, double at_nm, int columns)
{
    char start[LABEL_WIDTH + 1];
    wrap_row(stream, columns, label("name", start), "%s", d->name);
    wrap_row(stream, columns, label("coating", start), "%s", d->title);
    wrap_row(stream, columns, label("layers", start), "%s", d->layers);
    for (int i = 0; i < COATING_LINES; i++)
        print_powers(stream, d, i == 0 ? "on bk7 in air" : "", coating_nm[i], columns);
    if (at_nm > 0.0)
        print_powers(stream, d, "at", at_nm, columns);
    wrap_row(stream, columns, label("source", start), "%s", d->source);
}

static json_t *coating_at_json(const coating_design *d, double lambda_nm)
{
    const coating_powers p = coating_powers_at(d, 0.0, lambda_nm);
    return json_pack("{s:o,s:o,s:o}", "lambda_nm", json_of_real(lambda_nm), "R", json_of_real(p.R), "T",
                     json_of_real(p.T));
}

static json_t *coating_json(const coating_design *d, double at_nm)
{
    json_t *powers = json_array();
    for (int i = 0; i < COATING_LINES; i++)
        json_add(&powers, coating_at_json(d, coating_nm[i]));
    if (at_nm > 0.0)
        json_add(&powers, coating_at_json(d, at_nm));
    return json_pack("{s:s,s:s,s:s,s:o,s:s}", "name", d->name, "title", d->title, "layers", d->layers, "on_bk7", powers,
                     "source", d->source);
}

/* --- all --- */

json_t *media_rows_json(media_choice only, double at_nm)
{
    const bool all = !only.clear && !only.opaque && !only.coated;
    json_t *list = json_array(), *metals = json_array(), *coatings = json_array();
    for (size_t i = 0; i < media_count() && list; i++)
        if (all || only.clear == media_at(i))
            json_add(&list, medium_json(media_at(i), at_nm));
    for (size_t i = 0; i < metals_count() && metals; i++)
        if (all || only.opaque == metals_at(i))
            json_add(&metals, metal_json(metals_at(i), at_nm));
    for (size_t i = 0; i < coating_designs_count() && coatings; i++)
        if (all || only.coated == coating_design_at(i))
            json_add(&coatings, coating_json(coating_design_at(i), at_nm));
    if (list && metals && coatings)
        return json_pack("{s:i,s:o,s:o,s:o}", "schema", 1, "media", list, "metals", metals, "coatings", coatings);
    json_decref(list);
    json_decref(metals);
    json_decref(coatings);
    return NULL;
}

/* --- data from files --- */

static bool data_cover(const optical_data *d, double lambda_nm)
{
    double low_nm, high_nm;
    optical_data_range(d, &low_nm, &high_nm);
    return low_nm <= lambda_nm && lambda_nm <= high_nm;
}

/* A value or n, and k; nothing outside the range. */
static void print_data_at(FILE *stream, const optical_data *d, double lambda_nm, const char *name, int columns)
{
    char start[LABEL_WIDTH + 1], at[NUMBER_TEXT_MAX], value[NUMBER_TEXT_MAX], text[80] = "";
    if (!data_cover(d, lambda_nm))
        return;
    if (optical_data_has_first(d))
        snprintf(text, sizeof text, "%s", number_format_digits(optical_data_at(d, lambda_nm), 9, value));
    if (optical_data_points(d, true) > 0)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%sk = %s", *text ? ", " : "",
                 number_format_digits(optical_data_k(d, lambda_nm), 5, value));
    wrap_row(stream, columns, label(name, start), "%s at %s nm", text, number_format(lambda_nm, at));
}

/* NaN unless d, F and C are within the range. */
static double data_abbe_number(const optical_data *d)
{
    if (!optical_data_has_first(d) || !data_cover(d, LINE_HYDROGEN_F_NM) || !data_cover(d, LINE_HYDROGEN_C_NM))
        return (double)NAN;
    return (optical_data_at(d, LINE_HELIUM_D_NM) - 1.0) /
           (optical_data_at(d, LINE_HYDROGEN_F_NM) - optical_data_at(d, LINE_HYDROGEN_C_NM));
}

void data_rows_details(FILE *stream, const char *file, const optical_data *d, double at_nm, int columns)
{
    char start[LABEL_WIDTH + 1], low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    double low_nm, high_nm;
    optical_data_range(d, &low_nm, &high_nm);
    wrap_row(stream, columns, label("file", start), "%s", file);
    /* A table alone may be of anything. */
    const bool is_index = optical_data_law(d) || optical_data_points(d, true) > 0;
    for (int i = 0; i < LINES_ALL; i++)
        print_data_at(stream, d, lines[i].lambda_nm, lines[i].name + (is_index ? 0 : strlen("n_")), columns);
    if (is_index && isfinite(data_abbe_number(d)))
        wrap_row(stream, columns, label("V_d", start), "%.4f", data_abbe_number(d));
    if (at_nm > 0.0)
        print_data_at(stream, d, at_nm, is_index ? "n_at" : "at", columns);
    wrap_row(stream, columns, label("range", start), "%s..%s nm", number_format_digits(low_nm, 9, low),
             number_format_digits(high_nm, 9, high));
    if (optical_data_law(d))
        print_law(stream, optical_data_law(d), columns);
    else if (optical_data_has_first(d))
        wrap_row(stream, columns, label("points", start), "%zu", optical_data_points(d, false));
    if (optical_data_points(d, true) > 0)
        wrap_row(stream, columns, label("points of k", start), "%zu", optical_data_points(d, true));
}

static json_t *data_at_json(const optical_data *d, double lambda_nm)
{
    const bool covered = data_cover(d, lambda_nm);
    return json_pack(
        "{s:o,s:o,s:o}", "lambda_nm", json_of_real(lambda_nm), "n",
        json_of_real(covered && optical_data_has_first(d) ? optical_data_at(d, lambda_nm) : (double)NAN), "k",
        json_of_real(covered && optical_data_points(d, true) > 0 ? optical_data_k(d, lambda_nm) : (double)NAN));
}

json_t *data_rows_json(const char *file, const optical_data *d, double at_nm)
{
    double low_nm, high_nm;
    optical_data_range(d, &low_nm, &high_nm);
    const dispersion *law = optical_data_law(d);
    json_t *o = json_object();
    int bad = json_object_set_new(o, "file", json_of_text(file));
    for (int i = 0; i < LINES_ALL; i++)
        bad |= json_object_set_new(o, lines[i].name, data_at_json(d, lines[i].lambda_nm));
    bad |= json_object_set_new(o, "V_d", json_of_real(data_abbe_number(d)));
    bad |= at_nm > 0.0 ? json_object_set_new(o, "at", data_at_json(d, at_nm)) : 0;
    bad |= json_object_set_new(o, "low_nm", json_of_real(low_nm));
    bad |= json_object_set_new(o, "high_nm", json_of_real(high_nm));
    bad |= json_object_set_new(o, "law", law ? json_string(dispersion_name(law->kind)) : json_null());
    bad |= json_object_set_new(o, "coefficients", law ? coefficients_json(law) : json_null());
    bad |= json_object_set_new(o, "points", json_integer((json_int_t)optical_data_points(d, false)));
    bad |= json_object_set_new(o, "points_of_k", json_integer((json_int_t)optical_data_points(d, true)));
    return json_if(o, bad == 0);
}
