/* The catalogue of metals as a table, one metal in detail, or JSON. */
#include "report/metal_rows.h"
#include "base/json_build.h"
#include "base/number.h"
#include "report/json.h"
#include "report/wrap.h"
#include <math.h>
#include <string.h>

typedef struct metal_line {
    const char *name; /* of the line */
    const char *n, *k, *R;
    double lambda_nm;
} metal_line;

static const metal_line lines[] = {{"d", "n_d", "k_d", "R_d", LINE_HELIUM_D_NM},
                                   {"F", "n_F", "k_F", "R_F", LINE_HYDROGEN_F_NM},
                                   {"C", "n_C", "k_C", "R_C", LINE_HYDROGEN_C_NM},
                                   {"D", "n_D", "k_D", "R_D", LINE_SODIUM_D_NM}};
enum { LINES_TABLE = 3, LINES_ALL = 4, CELLS_MAX = 192, LABEL_WIDTH = 16 };

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

/* The range and source of a row: aligned, or on a narrow terminal in words. */
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
        used += snprintf(cells + used, sizeof cells - (size_t)used, "  %-6s  %-6s", lines[i].n, lines[i].k);
    snprintf(cells + used, sizeof cells - (size_t)used, "  %-5s  %s", lines[0].R,
             at_nm > 0.0 ? "n_at    k_at    " : "");
    finish_row(stream, columns, cells, "range_nm", "source");
    for (size_t k = 0; k < metals_count(); k++) {
        const metal *m = metals_at(k);
        used = snprintf(cells, sizeof cells, "%-12s", m->name);
        for (int i = 0; i < LINES_TABLE; i++) {
            const complex_pair index = metal_index(m, lines[i].lambda_nm);
            used += snprintf(cells + used, sizeof cells - (size_t)used, "  %.4f  %.4f", index.re, index.im);
        }
        used +=
            snprintf(cells + used, sizeof cells - (size_t)used, "  %.3f  ", metal_reflectance(m, lines[0].lambda_nm));
        const complex_pair at = metal_index(m, at_nm);
        if (at_nm > 0.0 && metal_covers(m, at_nm))
            snprintf(cells + used, sizeof cells - (size_t)used, "%.4f  %.4f  ", at.re, at.im);
        else if (at_nm > 0.0)
            snprintf(cells + used, sizeof cells - (size_t)used, "%-6s  %-6s  ", "-", "-");
        finish_row(stream, columns, cells, metal_range_text(m, range), m->source);
    }
}

static const char *label(const char *name, char text[LABEL_WIDTH + 1])
{
    snprintf(text, LABEL_WIDTH + 1, "%-*s", LABEL_WIDTH, name);
    return text;
}

static void print_index(FILE *stream, const metal *m, const char *name, double lambda_nm, int columns)
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
        print_index(stream, m, lines[i].n, lines[i].lambda_nm, columns);
    if (at_nm > 0.0)
        print_index(stream, m, "n_at", at_nm, columns);
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

static json_t *at_json(const metal *m, double at_nm)
{
    const bool covered = metal_covers(m, at_nm);
    const complex_pair index = metal_index(m, at_nm);
    return json_pack("{s:o,s:o,s:o}", "lambda_nm", json_of_real(at_nm), "n",
                     json_of_real(covered ? index.re : (double)NAN), "k",
                     json_of_real(covered ? index.im : (double)NAN));
}

json_t *metal_json(const metal *m, double at_nm)
{
    json_t *o = json_object();
    int bad = json_object_set_new(o, "name", json_string(m->name));
    bad |= json_object_set_new(o, "title", json_string(m->title));
    for (int i = 0; i < LINES_ALL; i++) {
        const complex_pair index = metal_index(m, lines[i].lambda_nm);
        bad |= json_object_set_new(o, lines[i].n, json_of_real(index.re));
        bad |= json_object_set_new(o, lines[i].k, json_of_real(index.im));
        bad |= json_object_set_new(o, lines[i].R, json_of_real(metal_reflectance(m, lines[i].lambda_nm)));
    }
    bad |= at_nm > 0.0 ? json_object_set_new(o, "at", at_json(m, at_nm)) : 0;
    bad |= json_object_set_new(o, "low_nm", json_of_real(m->n.coefficient[0]));
    bad |= json_object_set_new(o, "high_nm", json_of_real(m->n.coefficient[m->n.count - 2]));
    bad |= json_object_set_new(o, "points", points_json(m));
    bad |= json_object_set_new(o, "source", json_string(m->source));
    bad |= json_object_set_new(o, "verified", json_string(m->verified));
    bad |= json_object_set_new(o, "note", json_string(m->note));
    return json_whole(o, bad == 0);
}
