/* Reads lens files: tables (.dat of pbrt, .csv); lens_zmx.c reads those of Zemax (lens_prescription.h).
 *
 * A .csv file: lines beginning with # are comments. Lines KEY, VALUE ... come first, then the header, then a line
 * for each surface. Keys: title; unit_mm; object_distance; one of pupil, f_number and object_na; field_deg or
 * field_height with a list; wavelength_nm with a list, the primary one first; image_diameter; image_radius;
 * coating, of all faces of glass in air; vdx, vdy, vcx and vcy, vignetting factors with a number for each field.
 * Columns: radius (0, empty or inf: flat), thickness, medium (lens_medium_parse, or mirror), diameter, conic, a4
 * ... a20, a1, a2, a3, a5 ... a15, form (round, biconic or toric) with radius_x and conic_x, stop (any text but
 * 0), hole, chamfer, name, tilt_x and tilt_y (degrees, of a flat mirror that folds the axis); all but radius and
 * thickness may be missing. */
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/lens/lens_prescription.h"
#include "scene/lens/lens_reader.h"
#include "scene/model/names.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { LENS_BYTES_MAX = 1 << 24, GLASS_BYTES_MAX = 1 << 26, TILT_MAX = 80 };

/* --- .dat --- */

static status read_dat_row(lens_reader *r, bool *has_stop)
{
    double n, diameter;
    status code = STATUS_OK;
    lens_surface *s = lens_append(r, &code);
    if (!s)
        return code;
    TRY(lens_number(r, 0, "the radius", &s->radius));
    TRY(lens_number(r, 1, "the thickness", &s->thickness));
    TRY(lens_number(r, 2, "the index", &n));
    TRY(lens_number(r, 3, "the diameter", &diameter));
    if (r->count > 5)
        return lens_wrong(r, 5, "give radius, thickness, index, diameter and V", "the line has %d numbers", r->count);
    double V = 0.0;
    if (r->count > 4)
        TRY(lens_number(r, 4, "the Abbe number", &V));
    if (n != 0.0 && !(n >= 1.0 && n <= 10.0))
        return lens_wrong(r, 2, "give the index after the surface, 1 or 0 for air", "the index %g is out of range", n);
    if (!(diameter >= 0.0) || V < 0.0)
        return lens_wrong(r, diameter >= 0.0 ? 4 : 3, "give a diameter, not a negative number",
                          "a number below 0 is out of range");
    s->diameter = diameter;
    s->medium = n > 1.0 ? lens_medium_of_numbers(n, V) : s->medium;
    if (s->radius == 0.0 && n <= 1.0 && !*has_stop)
        r->p->stop = (int)r->p->count - 1, *has_stop = true;
    return STATUS_OK;
}

static status read_dat(lens_reader *r, char *text)
{
    bool has_stop = false;
    while (text) {
        char *line = strsep(&text, "\n");
        r->line++;
        line += strspn(line, " \t");
        if (*line == '#') {
            if (!r->p->title[0])
                snprintf(r->p->title, sizeof r->p->title, "%.*s", 120, line + 1 + strspn(line + 1, "# \t"));
            continue;
        }
        char *comment = strchr(line, '#');
        if (comment)
            *comment = 0;
        lens_divide(r, line, false);
        if (r->count > 1 || (r->count == 1 && r->p->count > 0)) /* a single number before the table is f */
            TRY(read_dat_row(r, &has_stop));
    }
    return STATUS_OK;
}

/* --- .csv --- */

typedef enum lens_column {
    COLUMN_RADIUS,
    COLUMN_THICKNESS,
    COLUMN_MEDIUM,
    COLUMN_DIAMETER,
    COLUMN_CONIC,
    COLUMN_STOP,
    COLUMN_HOLE,
    COLUMN_NAME,
    COLUMN_TILT_X,
    COLUMN_TILT_Y,
    COLUMN_EVEN,
    COLUMN_ODD = COLUMN_EVEN + LENS_EVEN_TERMS,
    COLUMN_FORM = COLUMN_ODD + LENS_ODD_TERMS,
    COLUMN_RADIUS_X,
    COLUMN_CONIC_X,
    COLUMN_CHAMFER
} lens_column;
const char *const lens_column_words[LENS_COLUMNS] = {
    "radius", "thickness", "medium", "diameter", "conic", "stop", "hole", "name",     "tilt_x",  "tilt_y", "a4",
    "a6",     "a8",        "a10",    "a12",      "a14",   "a16",  "a18",  "a20",      "a1",      "a2",     "a3",
    "a5",     "a7",        "a9",     "a11",      "a13",   "a15",  "form", "radius_x", "conic_x", "chamfer"};

const char *const lens_key_words[LENS_KEYS] = {"title",
                                               "unit_mm",
                                               "object_distance",
                                               "pupil",
                                               "f_number",
                                               "object_na",
                                               "field_deg",
                                               "field_height",
                                               "wavelength_nm",
                                               "image_diameter",
                                               "image_radius",
                                               "coating",
                                               "vdx",
                                               "vdy",
                                               "vcx",
                                               "vcy"};

static int index_of(const char *word, const char *const *words, int count)
{
    for (int i = 0; i < count; i++)
        if (strcasecmp(word, words[i]) == 0)
            return i;
    return -1;
}

static status unknown(const lens_reader *r, int at, const char *what, const char *const *words, size_t count)
{
    char remedy[300];
    suggest_key(r->word[at], words, count, remedy, sizeof remedy);
    return lens_wrong(r, at, remedy, "unknown %s '%.40s'", what, r->word[at]);
}

static status read_positive(const lens_reader *r, const char *what, double *out)
{
    double value;
    TRY(lens_number(r, 1, what, &value));
    if (!(value > 0.0))
        return lens_wrong(r, 1, "give a number above 0", "%s %g is out of range", what, value);
    *out = value;
    return STATUS_OK;
}

static status read_fields(const lens_reader *r, bool heights)
{
    lens_prescription *p = r->p;
    if (r->count - 1 > LENS_LIST_MAX || r->count < 2)
        return lens_wrong(r, 0, "give 1 to 24 fields", "%d fields", r->count - 1);
    p->field_kind = heights ? LENS_FIELD_OBJECT : LENS_FIELD_ANGLE;
    p->field_count = (size_t)(r->count - 1);
    for (int i = 1; i < r->count; i++) {
        double value;
        TRY(lens_number(r, i, "a field", &value));
        if (!heights && fabs(value) > 180.0)
            return lens_wrong(r, i, "give degrees from the axis", "the field %g is out of range", value);
        p->field[i - 1] = (lens_field){0.0, value, 1.0};
    }
    return STATUS_OK;
}

static status read_wavelengths(const lens_reader *r)
{
    lens_prescription *p = r->p;
    if (r->count - 1 > LENS_LIST_MAX || r->count < 2)
        return lens_wrong(r, 0, "give 1 to 24 wavelengths", "%d wavelengths", r->count - 1);
    p->wavelength_count = (size_t)(r->count - 1);
    for (int i = 1; i < r->count; i++) {
        double nm;
        TRY(lens_number(r, i, "a wavelength", &nm));
        if (!(nm >= 200.0 && nm <= 2000.0))
            return lens_wrong(r, i, "give nanometres, from 200 to 2000", "the wavelength %g is out of range", nm);
        p->wavelength[i - 1] = (lens_wavelength){nm, 1.0};
    }
    return STATUS_OK;
}

static status read_aperture(const lens_reader *r, lens_aperture_kind kind)
{
    if (r->p->aperture_kind != LENS_APERTURE_STOP)
        return lens_wrong(r, 0, "keep one of pupil, f_number and object_na", "%s is a second aperture", r->word[0]);
    TRY(read_positive(r, r->word[0], &r->p->aperture));
    r->p->aperture_kind = kind;
    return STATUS_OK;
}

/* A name, or layers, whose commas divide the line. */
static status read_coating(const lens_reader *r)
{
    char *to = r->p->coating;
    size_t used = 0;
    for (int i = 1; i < r->count; i++) {
        const size_t room = sizeof r->p->coating - used;
        const int length = snprintf(to + used, room, "%s%s", i > 1 ? "," : "", r->word[i]);
        if (length < 0 || (size_t)length >= room)
            return lens_wrong(r, i, "give a name of `cuvette media`", "the coating has more than 127 characters");
        used += (size_t)length;
    }
    return STATUS_OK;
}

static status read_key(const lens_reader *r, int key)
{
    lens_prescription *p = r->p;
    const bool is_list = key == 0 || (key >= 6 && key <= 8) || key >= LENS_SCENE_KEYS;
    if (!is_list && r->count > 2)
        return lens_wrong(r, 2, "give one number", "%s has %d numbers", r->word[0], r->count - 1);
    switch (key) {
    case 0:
        p->title[0] = 0;
        for (int i = 1; i < r->count; i++) { /* a title may have commas */
            const size_t used = strlen(p->title);
            snprintf(p->title + used, sizeof p->title - used, "%s%s", i > 1 ? ", " : "", r->word[i]);
        }
        return STATUS_OK;
    case 1: return read_positive(r, "unit_mm", &p->unit_mm);
    case 2: return read_positive(r, "object_distance", &p->object_distance);
    case 3: return read_aperture(r, LENS_APERTURE_PUPIL);
    case 4: return read_aperture(r, LENS_APERTURE_NUMBER);
    case 5: return read_aperture(r, LENS_APERTURE_OBJECT);
    case 6: return read_fields(r, false);
    case 7: return read_fields(r, true);
    case 8: return read_wavelengths(r);
    case 9: return read_positive(r, "image_diameter", &p->image_diameter);
    case 10: return lens_number(r, 1, "image_radius", &p->image_radius);
    case 11: return read_coating(r);
    default: return lens_read_vignetting(r, (size_t)(key - LENS_SCENE_KEYS));
    }
}

static status read_header(const lens_reader *r, int at[LENS_COLUMNS])
{
    for (int c = 0; c < LENS_COLUMNS; c++)
        at[c] = -1;
    for (int i = 0; i < r->count; i++) {
        const int c = index_of(r->word[i], lens_column_words, LENS_COLUMNS);
        if (c < 0)
            return unknown(r, i, "column", lens_column_words, LENS_COLUMNS);
        if (at[c] >= 0)
            return lens_wrong(r, i, "keep one of them", "a second column %s", r->word[i]);
        at[c] = i;
    }
    return at[COLUMN_THICKNESS] < 0 ? lens_wrong(r, -1, "add the column thickness", "no column is named thickness")
                                    : STATUS_OK;
}

static const char *cell(const lens_reader *r, const int at[LENS_COLUMNS], int column)
{
    return at[column] >= 0 && at[column] < r->count ? r->word[at[column]] : "";
}

/* A number, or 0 for an empty cell; `inf` is 0 too, for a flat surface. */
static status cell_number(const lens_reader *r, const int at[LENS_COLUMNS], int column, double *out)
{
    const char *text = cell(r, at, column);
    *out = 0.0;
    if (!*text || ((column == COLUMN_RADIUS || column == COLUMN_RADIUS_X) &&
                   (strcasecmp(text, "inf") == 0 || strcasecmp(text, "infinity") == 0)))
        return STATUS_OK;
    return lens_number(r, at[column], lens_column_words[column], out);
}

/* Spreadsheets end their lines with empty cells. */
static void drop_empty_cells(lens_reader *r, int least)
{
    while (r->count > least && !*r->word[r->count - 1])
        r->count--;
}

static status read_form(const lens_reader *r, const int at[LENS_COLUMNS], lens_surface *s)
{
    static const char *const words[] = {"round", "biconic", "toric"};
    const char *text = cell(r, at, COLUMN_FORM);
    const int form = *text ? index_of(text, words, 3) : SIDE_ROUND;
    if (form < 0)
        return lens_wrong(r, at[COLUMN_FORM], "give round, biconic or toric", "unknown form '%.40s'", text);
    s->form = (side_form)form;
    TRY(cell_number(r, at, COLUMN_RADIUS_X, &s->radius_x));
    TRY(cell_number(r, at, COLUMN_CONIC_X, &s->conic_x));
    if (s->conic_x != 0.0 && s->form != SIDE_BICONIC)
        return lens_wrong(r, at[COLUMN_CONIC_X], "give the form biconic, or a conic_x of 0",
                          "the surface is not biconic, and has no conic_x");
    return s->radius_x != 0.0 && s->form == SIDE_ROUND
               ? lens_wrong(r, at[COLUMN_RADIUS_X], "give the form biconic or toric, or a radius_x of 0",
                            "the surface is round, and has no radius_x")
               : STATUS_OK;
}

static status read_csv_row(lens_reader *r, const int at[LENS_COLUMNS], int cells)
{
    status code = STATUS_OK;
    drop_empty_cells(r, cells);
    if (r->count > cells)
        return lens_wrong(r, cells, "give as many cells as the header", "the line has %d cells, the header %d",
                          r->count, cells);
    if (r->count <= at[COLUMN_THICKNESS])
        return lens_wrong(r, -1, "complete the line", "the thickness is missing");
    lens_surface *s = lens_append(r, &code);
    if (!s)
        return code;
    TRY(cell_number(r, at, COLUMN_RADIUS, &s->radius));
    TRY(cell_number(r, at, COLUMN_THICKNESS, &s->thickness));
    TRY(cell_number(r, at, COLUMN_DIAMETER, &s->diameter));
    TRY(cell_number(r, at, COLUMN_CONIC, &s->conic));
    TRY(cell_number(r, at, COLUMN_HOLE, &s->hole));
    TRY(cell_number(r, at, COLUMN_CHAMFER, &s->chamfer));
    TRY(cell_number(r, at, COLUMN_TILT_X, &s->tilt_x_deg));
    TRY(cell_number(r, at, COLUMN_TILT_Y, &s->tilt_y_deg));
    for (int i = 0; i < LENS_EVEN_TERMS; i++)
        TRY(cell_number(r, at, COLUMN_EVEN + i, &s->even[i]));
    for (int i = 0; i < LENS_ODD_TERMS; i++)
        TRY(cell_number(r, at, COLUMN_ODD + i, &s->odd[i]));
    TRY(read_form(r, at, s));
    if (s->diameter < 0.0 || s->hole < 0.0)
        return lens_wrong(r, at[s->diameter < 0.0 ? COLUMN_DIAMETER : COLUMN_HOLE], "give 0 or more",
                          "a diameter below 0 is out of range");
    if (s->chamfer < 0.0)
        return lens_wrong(r, at[COLUMN_CHAMFER], "give 0 or more", "a chamfer below 0 is out of range");
    snprintf(s->name, sizeof s->name, "%.63s", cell(r, at, COLUMN_NAME));
    const char *stop = cell(r, at, COLUMN_STOP), *word = cell(r, at, COLUMN_MEDIUM);
    if (*stop && strcmp(stop, "0") != 0) {
        if (r->p->stop >= 0)
            return lens_wrong(r, at[COLUMN_STOP], "mark one surface", "a second surface is the stop");
        r->p->stop = (int)r->p->count - 1;
    }
    s->mirror = strcasecmp(word, "mirror") == 0;
    if (!s->mirror)
        return lens_read_medium(r, at[COLUMN_MEDIUM], word, &s->medium);
    s->medium = r->p->count > 1 ? s[-1].medium : r->p->object_medium;
    return STATUS_OK;
}

static status read_csv(lens_reader *r, char *text)
{
    int at[LENS_COLUMNS], cells = 0;
    unsigned seen = 0; /* keys, bit by bit */
    while (text) {
        char *line = strsep(&text, "\n");
        r->line++;
        if (line[strspn(line, " \t")] == '#' || !line[strspn(line, " \t")])
            continue;
        lens_divide(r, line, true);
        const int key = index_of(r->word[0], lens_key_words, LENS_KEYS);
        if (cells > 0) {
            TRY(read_csv_row(r, at, cells));
            continue;
        }
        drop_empty_cells(r, 1);
        if (key >= 0 && (seen & 1u << key))
            return lens_wrong(r, 0, "keep one of them", "%s is given twice", r->word[0]);
        if (key >= 0) {
            seen |= 1u << key;
            TRY(read_key(r, key));
        } else if (index_of(r->word[0], lens_column_words, LENS_COLUMNS) >= 0) {
            cells = r->count;
            TRY(read_header(r, at));
        } else {
            return unknown(r, 0, "key", lens_key_words, LENS_KEYS);
        }
    }
    return STATUS_OK;
}

/* --- any file --- */

static const struct lens_format {
    const char *ending;
    status (*read)(lens_reader *r, char *text);
} formats[] = {{".zmx", lens_read_zmx}, {".dat", read_dat}, {".csv", read_csv}};

static const struct lens_format *format_of(const char *name)
{
    const size_t length = strlen(name);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (length > 4 && strcasecmp(name + length - 4, formats[i].ending) == 0)
            return &formats[i];
    return NULL;
}

bool lens_file_named(const char *path)
{
    return format_of(path) != NULL;
}

/* Titles and names become part of scene files: UTF-8 without control characters; one that was cut has a blank for the
 * rest of its last character. */
static void make_plain(char *text)
{
    for (size_t length; *text; text += length) {
        uint32_t c = 0;
        length = text_utf8(text, &c);
        const bool bad = length == 0 || c < 0x20 || (c > 0x7e && c < 0xa0);
        length = length > 0 ? length : 1;
        if (bad)
            memset(text, ' ', length);
    }
}

/* What no reader has checked: that the numbers are of a size with which one can compute. */
static status check(const lens_reader *r)
{
    const lens_prescription *p = r->p;
    const double most = 1e9;
    if (p->count == 0)
        return lens_wrong(r, -1, "give a line for each surface", "the file has no surfaces");
    make_plain(r->p->title);
    lens_drop_bevels(r->p);
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        lens_reader at = *r;
        make_plain(r->p->surface[i].name);
        at.line = s->line;
        if (fabs(s->radius) > most || fabs(s->thickness) > most || s->diameter > most || s->chamfer > most ||
            fabs(s->conic) > most || fabs(s->radius_x) > most || fabs(s->conic_x) > most)
            return lens_wrong(&at, -1, "use numbers below 1e9", "a number of surface %zu is too large", i + 1);
        if (lens_folds(s) && !(s->mirror && lens_is_flat(s) && s->medium.kind == LENS_AIR))
            return lens_wrong(&at, -1, "tilt flat mirrors in air only; in a scene, any solid can be turned",
                              "surface %zu is tilted", i + 1);
        if (fabs(s->tilt_x_deg) > TILT_MAX || fabs(s->tilt_y_deg) > TILT_MAX)
            return lens_wrong(&at, -1, "tilt it by at most 80 degrees", "the mirror, surface %zu, is along the axis",
                              i + 1);
        if (s->hole > 0.0 && !s->mirror) {
            lens_note_item(r->p, "not read", "the inner radius of the aperture of surface %zu, which is no mirror",
                           i + 1);
            r->p->surface[i].hole = 0.0;
        }
    }
    return STATUS_OK;
}

/* What contradicts itself. thickness: the last one, as stated; 0 for none. */
static void note_contradictions(lens_prescription *p, double thickness)
{
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    if (thickness != 0.0 && isfinite(f.image) && fabs(f.image - thickness) > 0.1 * fabs(f.efl))
        lens_note(p, "the image is %.6g after the last surface, but the paraxial focus is at %.6g", thickness, f.image);
}

/* A catalogue that holds no glass is another file. */
static status check_glasses(const lens_glasses *glasses, diagnostic *why)
{
    for (size_t i = 0; glasses && i < glasses->count; i++) {
        char *text;
        size_t size;
        TRY(file_read_below(glasses->file[i], glasses->root, GLASS_BYTES_MAX, &text, &size, why));
        char *plain = text_narrow(text, size);
        free(text);
        if (!plain)
            return out_of_memory(why);
        const bool any = strncmp(plain, "NM ", 3) == 0 || strstr(plain, "\nNM ");
        free(plain);
        if (!any)
            return diagnose_at(why, glasses->file[i], STATUS_BAD_INPUT, "give a glass catalogue (.agf)",
                               "no line begins with NM, the name of a glass");
    }
    return STATUS_OK;
}

status lens_file_parse(const char *name, const char *text, size_t size, const lens_glasses *glasses,
                       lens_prescription *out, diagnostic *why)
{
    const struct lens_format *format = format_of(name);
    *out = lens_prescription_empty();
    if (!format)
        return diagnose_at(why, name, STATUS_BAD_INPUT, "use a file that ends in .zmx, .dat or .csv",
                           "the ending is not that of a lens file");
    char *plain = text_narrow(text, size);
    if (!plain)
        return out_of_memory(why);
    lens_reader r = {.name = name, .glasses = glasses, .p = out, .why = why};
    status code = check_glasses(glasses, why);
    THEN(code, format->read(&r, plain));
    r.line = 0;
    THEN(code, check(&r));
    free(plain);
    const double thickness = out->count > 0 ? out->surface[out->count - 1].thickness : 0.0;
    if (code == STATUS_OK) {
        lens_prescription_complete(out);
        note_contradictions(out, thickness);
    } else
        lens_prescription_release(out);
    return code;
}

status lens_file_read(const char *path, const lens_glasses *glasses, lens_prescription *out, diagnostic *why)
{
    char *text;
    size_t size;
    *out = lens_prescription_empty();
    TRY(file_read_below(path, glasses ? glasses->root : NULL, LENS_BYTES_MAX, &text, &size, why));
    const status code = lens_file_parse(path, text, size, glasses, out, why);
    free(text);
    return code;
}
