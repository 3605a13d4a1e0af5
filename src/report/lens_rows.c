/* The report of a lens as text, CSV and JSON. */
#include "report/param_rows.h"

#include "report/json.h"
#include "report/report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- tables --- */

static bool same_key(const lens_row *a, const lens_row *b)
{
    return a->surface == b->surface && a->field == b->field && a->lambda_nm == b->lambda_nm &&
           (a->x == b->x || (isnan(a->x) && isnan(b->x)));
}

static int column_of(lens_table *t, const lens_row *row)
{
    for (int i = 0; i < t->columns; i++)
        if (strcmp(t->quantity[i], row->quantity) == 0)
            return i;
    if (t->columns == LENS_COLUMNS_MAX)
        return -1;
    t->quantity[t->columns] = row->quantity;
    t->unit[t->columns] = row->unit;
    return t->columns++;
}

status lens_table_make(const lens_report *r, const lens_section *section, lens_table *out, diagnostic *why)
{
    *out = (lens_table){.section = section, .key = calloc(r->count + 1, sizeof *out->key)};
    out->value = malloc((r->count + 1) * LENS_COLUMNS_MAX * sizeof *out->value);
    if (!out->key || !out->value) {
        lens_table_release(out);
        return out_of_memory(why);
    }
    for (size_t i = 0; i < r->count; i++) {
        const lens_row *row = &r->row[i];
        if (strcmp(row->section, section->name) != 0)
            continue;
        if (out->count == 0 || !same_key(row, &out->key[out->count - 1])) {
            for (int k = 0; k < LENS_COLUMNS_MAX; k++)
                out->value[out->count * LENS_COLUMNS_MAX + (size_t)k] = NAN;
            out->key[out->count++] = *row;
        }
        const int column = column_of(out, row);
        if (column >= 0)
            out->value[(out->count - 1) * LENS_COLUMNS_MAX + (size_t)column] = row->value;
        out->has_surface |= row->surface != 0;
        out->has_field |= row->field != 0;
        out->has_lambda |= row->lambda_nm != 0.0;
        out->has_x |= !isnan(row->x);
    }
    return STATUS_OK;
}

void lens_table_release(lens_table *t)
{
    free(t->key);
    free(t->value);
    *t = (lens_table){0};
}

/* --- CSV --- */

static void write_number(FILE *out, bool present, double value)
{
    if (present && !isnan(value))
        fprintf(out, "%.17g,", value);
    else
        fputs("NA,", out);
}

void lens_write_csv(const lens_report *r, FILE *out)
{
    fputs("section,surface,field,lambda_nm,x,quantity,value,unit\n", out);
    for (size_t i = 0; i < r->count; i++) {
        const lens_row *row = &r->row[i];
        fprintf(out, "%s,", row->section);
        write_number(out, row->surface != 0, row->surface);
        write_number(out, row->field != 0, row->field);
        write_number(out, row->lambda_nm != 0.0, row->lambda_nm);
        write_number(out, true, row->x);
        fprintf(out, "%s,", row->quantity);
        write_number(out, true, row->value);
        fprintf(out, "%s\n", row->unit);
    }
}

/* --- JSON --- */

typedef double key_value(const lens_row *key);
static double key_surface(const lens_row *key)
{
    return key->surface ? (double)key->surface : NAN;
}
static double key_field(const lens_row *key)
{
    return key->field ? (double)key->field : NAN;
}
static double key_lambda(const lens_row *key)
{
    return key->lambda_nm;
}
static double key_x(const lens_row *key)
{
    return key->x;
}

static bool add_keys(json_t *o, const char *name, const lens_table *t, bool present, key_value *value)
{
    json_t *list = json_array();
    bool good = list != NULL;
    for (size_t i = 0; good && present && i < t->count; i++)
        good = json_array_append_new(list, json_of_real(value(&t->key[i]))) == 0;
    if (!present) {
        json_decref(list);
        return good;
    }
    return good ? json_object_set_new(o, name, list) == 0 : (json_decref(list), false);
}

/* One value for a section without keys, otherwise a list with one for each record. */
static json_t *column_values(const lens_table *t, int column)
{
    if (t->section->single)
        return json_of_real(t->value[column]);
    json_t *list = json_array();
    bool good = list != NULL;
    for (size_t i = 0; good && i < t->count; i++)
        good = json_array_append_new(list, json_of_real(t->value[i * LENS_COLUMNS_MAX + (size_t)column])) == 0;
    return json_if(list, good);
}

static json_t *section_object(const lens_table *t)
{
    json_t *o = json_object(), *units = json_object(), *values = json_object();
    const bool many = !t->section->single;
    bool good = o && units && values;
    good = good && json_object_set_new(o, "meaning", json_string(t->section->meaning)) == 0;
    good = good && (t->section->x[0] == 0 || json_object_set_new(o, "x", json_string(t->section->x)) == 0);
    good = good && add_keys(values, "surface", t, many && t->has_surface, key_surface);
    good = good && add_keys(values, "field", t, many && t->has_field, key_field);
    good = good && add_keys(values, "lambda_nm", t, many && t->has_lambda, key_lambda);
    good = good && add_keys(values, "x", t, many && t->has_x, key_x);
    for (int i = 0; good && i < t->columns; i++) {
        good = json_object_set_new(values, t->quantity[i], column_values(t, i)) == 0;
        good = good && json_object_set_new(units, t->quantity[i], json_string(t->unit[i])) == 0;
    }
    good = json_object_set_new(o, "units", units) == 0 && good;
    good = json_object_set_new(o, "values", values) == 0 && good;
    return json_if(o, good);
}

json_t *lens_json(const lens_report *r, const char *title)
{
    json_t *o = json_object(), *all = json_object();
    bool good = o && all;
    good = good && json_object_set_new(o, "schema", json_integer(1)) == 0;
    good = good && json_object_set_new(o, "lens", json_of_text(title)) == 0;
    for (size_t i = 0; good && lens_section_at(i)->name; i++) {
        lens_table t;
        good = lens_table_make(r, lens_section_at(i), &t, NULL) == STATUS_OK;
        if (good && t.count)
            good = json_object_set_new(all, t.section->name, section_object(&t)) == 0;
        if (good)
            lens_table_release(&t);
    }
    good = json_object_set_new(o, "sections", all) == 0 && good;
    return json_if(o, good);
}

/* --- text --- */

static void write_title(const lens_table *t, int columns, FILE *out)
{
    char start[64];
    snprintf(start, sizeof start, "%s: ", t->section->name);
    fputc('\n', out);
    wrap_row(out, columns ? columns : 120, start, "%s", t->section->meaning);
}

/* Less than a femtometre is rounding, as of rays that should meet the axis. */
static double plain(double value, const char *unit)
{
    return strcmp(unit, "mm") == 0 && fabs(value) < 1e-12 ? 0.0 : value;
}

/* One line for each quantity. */
static void write_list(const lens_table *t, FILE *out)
{
    for (int i = 0; i < t->columns; i++)
        if (isnan(t->value[i]))
            fprintf(out, "  %-22s %14s\n", t->quantity[i], "-");
        else
            fprintf(out, "  %-22s %14.8g %s\n", t->quantity[i], plain(t->value[i], t->unit[i]) + 0.0, t->unit[i]);
}

static void write_cell(FILE *out, double value, const char *format)
{
    if (isnan(value))
        fprintf(out, " %12s", "-");
    else
        fprintf(out, format, value + 0.0);
}

static int x_wide(const lens_table *t)
{
    const int name = (int)strlen(t->section->x);
    return name > 12 ? name : 12;
}

static void write_heads(const lens_table *t, FILE *out)
{
    fputs(t->has_surface ? "  surface" : " ", out);
    fputs(t->has_field ? "  field" : "", out);
    fputs(t->has_lambda ? "  lambda_nm" : "", out);
    if (t->has_x)
        fprintf(out, " %*s", x_wide(t), t->section->x);
    for (int i = 0; i < t->columns; i++)
        fprintf(out, " %*s", strlen(t->quantity[i]) > 12 ? (int)strlen(t->quantity[i]) : 12, t->quantity[i]);
    fputc('\n', out);
    fprintf(out, "%*s", 1 + (t->has_surface ? 8 : 0) + (t->has_field ? 7 : 0) + (t->has_lambda ? 11 : 0), "");
    if (t->has_x)
        fprintf(out, " %*s", x_wide(t), "");
    for (int i = 0; i < t->columns; i++)
        fprintf(out, " %*s", strlen(t->quantity[i]) > 12 ? (int)strlen(t->quantity[i]) : 12, t->unit[i]);
    fputc('\n', out);
}

static void write_record(const lens_table *t, size_t at, FILE *out)
{
    const lens_row *key = &t->key[at];
    fputc(' ', out);
    if (t->has_surface)
        fprintf(out, " %7d", key->surface);
    if (t->has_field)
        fprintf(out, " %6d", key->field);
    if (t->has_lambda && key->lambda_nm == 0.0)
        fprintf(out, " %10s", "all");
    else if (t->has_lambda)
        fprintf(out, " %10.6g", key->lambda_nm);
    if (t->has_x) {
        fprintf(out, "%*s", x_wide(t) - 12, "");
        write_cell(out, key->x, " %12.6g");
    }
    for (int i = 0; i < t->columns; i++) {
        const double value = t->value[at * LENS_COLUMNS_MAX + (size_t)i];
        const int wide = (int)strlen(t->quantity[i]);
        if (wide > 12)
            fprintf(out, "%*s", wide - 12, "");
        write_cell(out, plain(value, t->unit[i]), " %12.6g");
    }
    fputc('\n', out);
}

static bool same_curve(const lens_row *a, const lens_row *b)
{
    return a->surface == b->surface && a->field == b->field && a->lambda_nm == b->lambda_nm;
}

/* Of long curves every so manieth record is written; CSV and JSON have all. */
static void write_table(const lens_table *t, FILE *out)
{
    const size_t every = (size_t)(t->section->every ? t->section->every : 1);
    write_heads(t, out);
    for (size_t i = 0, first = 0; i < t->count; i++) {
        first = same_curve(&t->key[i], &t->key[first]) ? first : i;
        if ((i - first) % every == 0)
            write_record(t, i, out);
    }
}

status lens_write_text(const lens_report *r, const char *title, int columns, FILE *out, diagnostic *why)
{
    fprintf(out, "%s\n", title);
    for (size_t i = 0; lens_section_at(i)->name; i++) {
        lens_table t;
        TRY(lens_table_make(r, lens_section_at(i), &t, why));
        if (t.count && t.section->every >= 0) {
            write_title(&t, columns, out);
            if (t.section->single)
                write_list(&t, out);
            else
                write_table(&t, out);
        }
        lens_table_release(&t);
    }
    fputs("\nimages by cuvette have no diffraction; wavefront, encircled and mtf-diffraction have\n", out);
    return STATUS_OK;
}
