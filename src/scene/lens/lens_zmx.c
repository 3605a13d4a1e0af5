/* Reads sequential lens files of Zemax (lens_prescription.h). The format, line by line, is a keyword and its values;
 * lines of a surface follow its line SURF, its TYPE before its PARM. Surface 0 is the object, the last one the image.
 * Zemax, OpticStudio User Guide. */
#include "base/number.h"
#include "base/text.h"
#include "scene/lens/lens_reader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Keywords between SURF and the next surface set the last surface; the first is the object. */
typedef struct zmx_reader {
    lens_reader *r;
    bool in_surface;
    bool has_distance, has_aperture; /* of the surface: DISZ; CLAP or FLAP, before which DIAM stands back */
    bool has_stop_size;              /* of the system: ENPD, FNUM, OBNA or FLOA */
    int type;                        /* of the surface: types[] */
    int field_type;
    double x[LENS_LIST_MAX], y[LENS_LIST_MAX];
    int fields, waves; /* as FTYP says; 0: by the values */
    int primary;
    lens_break breaks[LENS_SURFACES_MAX];
    long primary_line;
} zmx_reader;

static lens_surface *surface_of(const zmx_reader *z)
{
    return &z->r->p->surface[z->r->p->count - 1];
}

/* A length that may be INFINITY. */
static status read_length(const lens_reader *r, const char *what, double *out)
{
    *out = INFINITY;
    return r->count > 1 && strncasecmp(r->word[1], "INF", 3) == 0 ? STATUS_OK : lens_number(r, 1, what, out);
}

/* Types of surfaces, and what their last parameter that is read means. */
typedef enum zmx_type { ZMX_EVEN, ZMX_ODD, ZMX_BICONIC, ZMX_TOROIDAL, ZMX_STANDARD } zmx_type;
static const struct {
    const char *word, *remedy;
    int last;
    side_form form;
} types[] = {{"EVENASPH", "use PARM 1 to 10, the coefficients of r^2 to r^20", 10, SIDE_ROUND},
             {"ODDASPHE", "use PARM 1 to 8, the coefficients of r to r^8", 8, SIDE_ROUND},
             {"BICONICX", "use PARM 1 and 2, the radius and the conic constant along x", 2, SIDE_BICONIC},
             {"TOROIDAL", "use PARM 1, the radius of rotation, to 8, the coefficient of y^14", 8, SIDE_TORIC},
             {"STANDARD", "use PARM 1 to 10, the coefficients of r^2 to r^20", 10, SIDE_ROUND}};

static status read_type(zmx_reader *z)
{
    const lens_reader *r = z->r;
    const char *word = r->count > 1 ? r->word[1] : "";
    for (int i = 0; i < (int)(sizeof types / sizeof *types); i++)
        if (strcasecmp(word, types[i].word) == 0) {
            z->type = i, surface_of(z)->form = types[i].form;
            return STATUS_OK;
        }
    if (strcasecmp(word, "COORDBRK") == 0) {
        z->breaks[r->p->count - 1].given = true;
        return STATUS_OK;
    }
    return lens_wrong(r, 1,
                      "use surfaces STANDARD, EVENASPH, ODDASPHE, BICONICX, TOROIDAL and COORDBRK; in a scene file, "
                      "solids can be of any shape",
                      "surface %zu is of type %.20s, which is not supported", r->p->count - 1, word);
}

/* The coefficient of r^n, n from 1. */
static void set_term(lens_surface *s, int n, double value)
{
    if (n % 2 == 0 && n > 2)
        s->even[n / 2 - 2] = value;
    else
        s->odd[n < 3 ? n - 1 : (n + 1) / 2] = value;
}

/* PARM n is the coefficient of r^(2 n) of an even asphere, and of r^n of an odd one. For others: types[]. */
static status read_parameter(zmx_reader *z)
{
    const lens_reader *r = z->r;
    double number, value;
    TRY(lens_number(r, 1, "the number of a parameter", &number));
    TRY(lens_number(r, 2, "a parameter", &value));
    if (value == 0.0)
        return STATUS_OK;
    lens_break *b = &z->breaks[r->p->count - 1];
    if (b->given && fabs(value) > (number >= 3.0 && number <= 5.0 ? 360.0 : 1e9))
        return lens_wrong(r, 2, "give tilts from -360 to 360 degrees", "the parameter %g is out of range", value);
    if (b->given && number >= 1.0 && number <= 6.0) {
        b->number[(int)number - 1] = value;
        return STATUS_OK;
    }
    if (!(number >= 1.0) || number > types[z->type].last)
        return lens_wrong(r, 1, types[z->type].remedy, "parameter %g is not supported", number);
    const int n = (int)number;
    lens_surface *s = surface_of(z);
    switch ((zmx_type)z->type) {
    case ZMX_ODD: set_term(s, n, value); break;
    case ZMX_BICONIC: *(n == 1 ? &s->radius_x : &s->conic_x) = value; break;
    case ZMX_TOROIDAL:
        if (n == 1)
            s->radius_x = value;
        else
            set_term(s, 2 * (n - 1), value);
        break;
    case ZMX_EVEN:
    case ZMX_STANDARD: set_term(s, 2 * n, value); break;
    }
    return STATUS_OK;
}

static status read_thickness(zmx_reader *z)
{
    double value;
    z->has_distance = true;
    TRY(read_length(z->r, "DISZ", &value));
    if (isinf(value) && z->r->p->count > 1)
        return lens_wrong(z->r, 1, "give a distance", "only the object can be infinitely far away");
    surface_of(z)->thickness = value;
    return STATUS_OK;
}

static status read_diameter(const zmx_reader *z, int word, double *out)
{
    double half;
    TRY(lens_number(z->r, word, z->r->word[0], &half));
    if (half < 0.0)
        return lens_wrong(z->r, word, "give a semi-diameter of 0 or more", "%g is out of range", half);
    *out = 2.0 * half;
    return STATUS_OK;
}

/* CLAP least most, and FLAP: a circular aperture, which precedes the semi-diameter; the least radius is a hole's. */
static status read_aperture(zmx_reader *z)
{
    lens_surface *s = surface_of(z);
    double most = 0.0;
    TRY(read_diameter(z, 1, &s->hole));
    TRY(read_diameter(z, 2, &most));
    if (most > 0.0)
        s->diameter = most, z->has_aperture = true;
    return STATUS_OK;
}

static status read_rim(const zmx_reader *z)
{
    double diameter = 0.0;
    TRY(read_diameter(z, 1, &diameter));
    if (!z->has_aperture)
        surface_of(z)->diameter = diameter;
    return STATUS_OK;
}

static status read_curvature(const zmx_reader *z)
{
    double c;
    TRY(lens_number(z->r, 1, "CURV", &c));
    surface_of(z)->radius = c == 0.0 ? 0.0 : lens_short_number(1.0 / c);
    return STATUS_OK;
}

static void read_comment(const lens_reader *r, char *to, size_t size)
{
    to[0] = 0;
    for (int i = 1; i < r->count; i++) {
        const size_t used = strlen(to);
        snprintf(to + used, size - used, "%s%s", i > 1 ? " " : "", r->word[i]);
    }
}

static status read_surface_line(zmx_reader *z, bool *known)
{
    const lens_reader *r = z->r;
    const char *key = r->word[0];
    lens_surface *s = surface_of(z);
    *known = true;
    if (strcmp(key, "TYPE") == 0)
        return read_type(z);
    if (strcmp(key, "CURV") == 0)
        return read_curvature(z);
    if (strcmp(key, "CONI") == 0)
        return lens_number(r, 1, "CONI", &s->conic);
    if (strcmp(key, "PARM") == 0)
        return read_parameter(z);
    if (strcmp(key, "DISZ") == 0)
        return read_thickness(z);
    if (strcmp(key, "GLAS") == 0)
        return lens_read_glass(r, s);
    if (strcmp(key, "DIAM") == 0)
        return read_rim(z);
    if (strcmp(key, "CLAP") == 0 || strcmp(key, "FLAP") == 0)
        return read_aperture(z);
    if (strcmp(key, "COMM") == 0)
        read_comment(r, s->name, sizeof s->name);
    else if (strcmp(key, "STOP") == 0)
        r->p->stop = (int)r->p->count - 1;
    else
        *known = false;
    return STATUS_OK;
}

/* --- the system --- */

static status read_unit(const lens_reader *r)
{
    static const struct {
        const char *word;
        double mm;
    } units[] = {{"MM", 1.0},       {"CM", 10.0},       {"IN", 25.4}, {"INCH", 25.4},
                 {"METER", 1000.0}, {"METERS", 1000.0}, {"M", 1000.0}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (r->count > 1 && strcasecmp(r->word[1], units[i].word) == 0) {
            r->p->unit_mm = units[i].mm;
            return STATUS_OK;
        }
    return lens_wrong(r, 1, "use MM, CM, IN or METER", "unknown unit '%.20s'", r->count > 1 ? r->word[1] : "");
}

static status read_system_aperture(zmx_reader *z, lens_aperture_kind kind)
{
    const lens_reader *r = z->r;
    double value;
    TRY(lens_number(r, 1, r->word[0], &value));
    if (!(value > 0.0))
        return lens_wrong(r, 1, "give a number above 0", "%s %g is out of range", r->word[0], value);
    if (z->has_stop_size)
        lens_note(r->p, "%s replaces the aperture that is given before", r->word[0]);
    z->has_stop_size = true;
    r->p->aperture_kind = kind;
    r->p->aperture = value;
    return STATUS_OK;
}

static status read_field_list(zmx_reader *z, double *to)
{
    const lens_reader *r = z->r;
    for (int i = 1; i < r->count && i <= LENS_LIST_MAX; i++)
        TRY(lens_number(r, i, "a field", &to[i - 1]));
    for (int i = 1; i < r->count && i <= LENS_LIST_MAX; i++)
        if (to[i - 1] != 0.0 && (size_t)i > r->p->field_count)
            r->p->field_count = (size_t)i;
    return STATUS_OK;
}

/* FTYP type telecentric fields wavelengths ... */
static status read_field_type(zmx_reader *z)
{
    const lens_reader *r = z->r;
    double type, count = 0.0, waves = 0.0;
    TRY(lens_number(r, 1, "FTYP", &type));
    if (!(type >= 0.0 && type <= 3.0))
        return lens_wrong(r, 1, "use 0, angles; 1, heights of the object; 2 or 3, heights of the image",
                          "the kind of fields %g is unknown", type);
    z->field_type = (int)type;
    double telecentric = 0.0;
    if (r->count > 2)
        TRY(lens_number(r, 2, "whether the object space is telecentric", &telecentric));
    if (telecentric != 0.0)
        lens_note_item(r->p, "not read", "telecentric object space");
    if (r->count > 3)
        TRY(lens_number(r, 3, "the number of fields", &count));
    if (r->count > 4)
        TRY(lens_number(r, 4, "the number of wavelengths", &waves));
    z->fields = count >= 1.0 && count <= LENS_LIST_MAX ? (int)count : 0;
    z->waves = waves >= 1.0 && waves <= LENS_LIST_MAX ? (int)waves : 0;
    return STATUS_OK;
}

static status add_wavelength(const lens_reader *r, int number, double um, double weight)
{
    lens_prescription *p = r->p;
    if (number < 1 || number > LENS_LIST_MAX || !(um >= 0.2 && um <= 2.0))
        return lens_wrong(r, 1, "use at most 24 wavelengths from 0.2 to 2 um", "the wavelength %g um is out of range",
                          um);
    p->wavelength[number - 1] = (lens_wavelength){lens_short_number(1000.0 * um), weight};
    if ((size_t)number > p->wavelength_count)
        p->wavelength_count = (size_t)number;
    return STATUS_OK;
}

/* WAVM number um weight. Zemax fills the list with 0.55 um of weight 1 or 0; the used ones come first. */
static status read_wavelength(const zmx_reader *z)
{
    const lens_reader *r = z->r;
    double number, um, weight = 1.0;
    TRY(lens_number(r, 1, "the number of a wavelength", &number));
    TRY(lens_number(r, 2, "a wavelength", &um));
    if (r->count > 3)
        TRY(lens_number(r, 3, "a weight", &weight));
    if (!(number >= 1.0 && number <= LENS_LIST_MAX) || (size_t)number != r->p->wavelength_count + 1) {
        lens_note_item(r->p, "not read", "wavelength %.6g (line %ld)", number, r->line);
        return STATUS_OK;
    }
    return add_wavelength(r, (int)number, um, weight);
}

static status read_wavelength_list(const zmx_reader *z)
{
    const lens_reader *r = z->r;
    for (int i = 1; i < r->count; i++) {
        double um;
        TRY(lens_number(r, i, "a wavelength", &um));
        TRY(add_wavelength(r, i, um, 1.0));
    }
    return STATUS_OK;
}

static status read_mode(const lens_reader *r)
{
    return r->count > 1 && strcasecmp(r->word[1], "SEQ") != 0
               ? lens_wrong(r, 1, "save it as a sequential system", "mode %.20s is not supported", r->word[1])
               : STATUS_OK;
}

static status read_system_line(zmx_reader *z, bool *known)
{
    lens_reader *r = z->r;
    const char *key = r->word[0];
    double primary;
    *known = true;
    if (strcmp(key, "UNIT") == 0)
        return read_unit(r);
    if (strcmp(key, "MODE") == 0)
        return read_mode(r);
    if (strcmp(key, "NAME") == 0)
        read_comment(r, r->p->title, sizeof r->p->title);
    else if (strcmp(key, "ENPD") == 0)
        return read_system_aperture(z, LENS_APERTURE_PUPIL);
    else if (strcmp(key, "FNUM") == 0)
        return read_system_aperture(z, LENS_APERTURE_NUMBER);
    else if (strcmp(key, "OBNA") == 0)
        return read_system_aperture(z, LENS_APERTURE_OBJECT);
    else if (strcmp(key, "FLOA") == 0)
        r->p->aperture_kind = LENS_APERTURE_STOP, z->has_stop_size = true;
    else if (strcmp(key, "FTYP") == 0)
        return read_field_type(z);
    else if (strcmp(key, "XFLN") == 0 || strcmp(key, "XFLD") == 0)
        return read_field_list(z, z->x);
    else if (strcmp(key, "YFLN") == 0 || strcmp(key, "YFLD") == 0)
        return read_field_list(z, z->y);
    else if (strcmp(key, "VDXN") == 0 || strcmp(key, "VDYN") == 0 || strcmp(key, "VCXN") == 0 ||
             strcmp(key, "VCYN") == 0)
        return lens_read_vignetting(r, (key[1] == 'C') * 2u + (key[2] == 'Y'));
    else if (strcmp(key, "WAVM") == 0)
        return read_wavelength(z);
    else if (strcmp(key, "WAVL") == 0)
        return read_wavelength_list(z);
    else if (strcmp(key, "PWAV") == 0) {
        TRY(lens_number(r, 1, "PWAV", &primary));
        if (!(primary >= 1.0 && primary <= LENS_LIST_MAX))
            return lens_wrong(r, 1, "give the number of a wavelength", "PWAV %g is out of range", primary);
        z->primary = (int)primary, z->primary_line = r->line;
    } else
        *known = false;
    return STATUS_OK;
}

/* --- the file --- */

/* A surface's lines are indented; some programs drop the blanks. */
static status read_words(zmx_reader *z, bool indented, const char *whole)
{
    lens_reader *r = z->r;
    const long of = z->in_surface ? surface_of(z)->line : 0;
    bool known = false;
    if (z->in_surface && (indented || strcmp(r->word[0], "TOL") != 0))
        TRY(read_surface_line(z, &known));
    if (!known && !(z->in_surface && indented))
        TRY(read_system_line(z, &known));
    if (!known)
        return lens_zmx_other(r, of, whole);
    /* what follows their value is kept, and an aperture that is not written as a hole */
    static const char *const kept[] = {"CURV", "DIAM", "CLAP", "FLAP"};
    bool keep = false;
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++)
        keep |= strcmp(r->word[0], kept[i]) == 0 && (i < 2 || surface_of(z)->hole == 0.0);
    return keep ? lens_zmx_keep(r, of, whole) : STATUS_OK;
}

static status read_line(zmx_reader *z, char *line)
{
    lens_reader *r = z->r;
    const bool indented = *line == ' ' || *line == '\t';
    char *whole = text_format("%s", line);
    if (!whole)
        return out_of_memory(r->why);
    lens_divide(r, line, false);
    status code = STATUS_OK;
    if (r->count > 0 && strcmp(r->word[0], "SURF") == 0) {
        z->in_surface = lens_append(r, &code) != NULL, z->type = ZMX_STANDARD;
        z->has_distance = z->has_aperture = false;
    } else if (r->count > 0) {
        code = read_words(z, indented, whole);
    }
    free(whole);
    return code;
}

/* Heights of the image become angles by the focal length. */
static void set_fields(const zmx_reader *z)
{
    lens_prescription *p = z->r->p;
    const double deg = 57.295779513082320877;
    if (z->fields)
        p->field_count = (size_t)z->fields;
    p->field_kind = z->field_type == 1 ? LENS_FIELD_OBJECT : LENS_FIELD_ANGLE;
    const double f = z->field_type >= 2 ? fabs(lens_first_order_of(p, p->wavelength[p->primary].nm).efl) : 0.0;
    for (size_t i = 0; i < p->field_count; i++) {
        const double x = z->x[i], y = z->y[i];
        p->field[i] = f > 0.0 ? (lens_field){deg * atan(x / f), deg * atan(y / f), 1.0} : (lens_field){x, y, 1.0};
    }
    if (z->field_type == 3)
        lens_note(p, "real image heights were taken as paraxial ones");
}

/* Removes the object and the image from the list of surfaces. */
static status end_surfaces(zmx_reader *z)
{
    lens_reader *r = z->r;
    lens_prescription *p = r->p;
    if (p->count < 3)
        return lens_wrong(r, -1, "give an object, surfaces and an image", "the file has %zu surfaces", p->count);
    TRY(lens_take_breaks(r, z->breaks));
    const lens_surface object = p->surface[0], plane = p->surface[p->count - 1];
    if (object.medium.kind != LENS_AIR) {
        r->line = object.line;
        return lens_wrong(r, -1, "begin with a surface of air", "an object within glass is not supported");
    }
    if (isfinite(object.thickness) && object.thickness < 1e9) {
        if (!(object.thickness > 0.0)) {
            r->line = object.line;
            return lens_wrong(r, -1, "give a distance above 0, or INFINITY", "the object's distance is %g",
                              object.thickness);
        }
        p->object_distance = object.thickness;
    }
    p->image_radius = plane.radius;
    p->image_diameter = plane.diameter;
    p->count -= 2;
    memmove(p->surface, p->surface + 1, p->count * sizeof *p->surface);
    if (p->stop >= 0)
        p->stop--;
    if (p->stop < 0 || (size_t)p->stop >= p->count)
        p->stop = -1;
    return STATUS_OK;
}

status lens_read_zmx(lens_reader *r, char *text)
{
    zmx_reader z = {.r = r, .primary = 1};
    r->p->wavelength_count = 0;
    while (text) {
        char *line = strsep(&text, "\n");
        r->line++;
        TRY(read_line(&z, line));
    }
    TRY(lens_zmx_check_image(r, z.has_distance));
    TRY(end_surfaces(&z));
    lens_zmx_check_makers(r);
    lens_prescription *p = r->p;
    if (!z.has_stop_size)
        lens_note(p, "no ENPD, FNUM, OBNA or FLOA: the beam fills the stop as its diameter states");
    if (p->wavelength_count == 0)
        p->wavelength_count = 1;
    /* unused entries of the list: 0.55 um after the used ones */
    if (z.waves && (size_t)z.waves < p->wavelength_count)
        p->wavelength_count = (size_t)z.waves;
    while (!z.waves && p->wavelength_count > 1 && p->wavelength[p->wavelength_count - 1].nm == 550.0 &&
           p->wavelength[p->wavelength_count - 2].nm == 550.0)
        p->wavelength_count--;
    if ((size_t)z.primary > p->wavelength_count) {
        r->line = z.primary_line;
        return lens_wrong(r, -1, "give the number of one of them", "PWAV is %d, but the file has %zu wavelengths",
                          z.primary, p->wavelength_count);
    }
    p->primary = (size_t)z.primary - 1;
    set_fields(&z);
    return STATUS_OK;
}
