/* Writes lens files (lens_prescription.h). */
#include "base/number.h"
#include "scene/lens/lens_prescription.h"
#include "scene/lens/lens_reader.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <strings.h>

static void put_number(FILE *out, const char *before, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "%s%s", before, number_format(value, text));
}

/* A text without the characters that divide lines or cells. */
static void put_text(FILE *out, const char *text, bool commas)
{
    for (; *text; text++)
        fputc(iscntrl((unsigned char)*text) || (*text == ',' && !commas) ? ' ' : *text, out);
}

/* --- .csv --- */

static bool is_vignetted(const lens_prescription *p)
{
    bool any = false;
    for (size_t i = 0; i < p->field_count; i++)
        for (size_t k = 0; k < 4; k++)
            any |= lens_vignetting_factor(&p->vignetting[i], k) != 0.0;
    return any;
}

static void put_vignetting(const lens_prescription *p, FILE *out)
{
    for (size_t k = 0; k < 4 && is_vignetted(p); k++) {
        fprintf(out, "\n%s", lens_key_words[LENS_SCENE_KEYS + k]);
        for (size_t i = 0; i < p->field_count; i++)
            put_number(out, ",", lens_vignetting_factor(&p->vignetting[i], k));
    }
}

static void put_system(const lens_prescription *p, FILE *out)
{
    static const char *const apertures[] = {
        [LENS_APERTURE_PUPIL] = "pupil", [LENS_APERTURE_NUMBER] = "f_number", [LENS_APERTURE_OBJECT] = "object_na"};
    if (p->title[0]) {
        fputs("title,", out);
        put_text(out, p->title, true);
        fputc('\n', out);
    }
    put_number(out, "unit_mm,", p->unit_mm);
    if (isfinite(p->object_distance))
        put_number(out, "\nobject_distance,", p->object_distance);
    if (p->aperture_kind != LENS_APERTURE_STOP) {
        fprintf(out, "\n%s", apertures[p->aperture_kind]);
        put_number(out, ",", p->aperture);
    }
    fprintf(out, "\n%s", p->field_kind == LENS_FIELD_ANGLE ? "field_deg" : "field_height");
    for (size_t i = 0; i < p->field_count; i++)
        put_number(out, ",", p->field[i].x == 0.0 ? p->field[i].y : hypot(p->field[i].x, p->field[i].y));
    put_vignetting(p, out);
    fputs("\nwavelength_nm", out);
    put_number(out, ",", p->wavelength[p->primary].nm);
    for (size_t i = 0; i < p->wavelength_count; i++)
        if (i != p->primary)
            put_number(out, ",", p->wavelength[i].nm);
    if (p->image_radius != 0.0)
        put_number(out, "\nimage_radius,", p->image_radius);
    if (p->image_diameter > 0.0)
        put_number(out, "\nimage_diameter,", p->image_diameter);
    if (p->coating[0])
        fprintf(out, "\ncoating,%s", p->coating);
    fputc('\n', out);
}

/* The number of coefficients that some surface has. */
static int terms_of(const lens_prescription *p)
{
    int terms = 0;
    for (size_t i = 0; i < p->count; i++)
        for (int k = terms; k < LENS_EVEN_TERMS; k++)
            if (p->surface[i].even[k] != 0.0)
                terms = k + 1;
    return terms;
}

/* The number of odd coefficients, and whether some surface is not round. */
static int odd_terms_of(const lens_prescription *p)
{
    int terms = 0;
    for (size_t i = 0; i < p->count; i++)
        for (int k = terms; k < LENS_ODD_TERMS; k++)
            if (p->surface[i].odd[k] != 0.0)
                terms = k + 1;
    return terms;
}

static bool has_bevels(const lens_prescription *p)
{
    bool any = false;
    for (size_t i = 0; i < p->count; i++)
        any |= p->surface[i].chamfer > 0.0;
    return any;
}

static status write_csv(const lens_prescription *p, FILE *out, diagnostic *why)
{
    char word[LENS_NAME_MAX];
    static const char *const forms[] = {"round", "biconic", "toric"};
    const int terms = terms_of(p), odd = odd_terms_of(p);
    const bool round = lens_is_round(p);
    bool folds = false, bevels = has_bevels(p);
    for (size_t i = 0; i < p->count; i++)
        folds |= lens_folds(&p->surface[i]);
    (void)why;
    put_system(p, out);
    fputs("radius,thickness,medium,diameter,conic,stop,hole", out);
    fputs(bevels ? ",chamfer" : "", out);
    fputs(folds ? ",tilt_x,tilt_y" : "", out);
    for (int k = 0; k < terms; k++)
        fprintf(out, ",a%d", 4 + 2 * k);
    for (int k = 0; k < odd; k++)
        fprintf(out, ",a%d", asphere_odd_power(k));
    fputs(round ? ",name\n" : ",form,radius_x,conic_x,name\n", out);
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        put_number(out, "", s->radius);
        put_number(out, ",", s->thickness);
        fprintf(out, ",%s", s->mirror ? "mirror" : lens_medium_text(&s->medium, word));
        put_number(out, ",", s->diameter);
        put_number(out, ",", s->conic);
        fprintf(out, ",%d", p->stop == (int)i);
        put_number(out, ",", s->hole);
        if (bevels)
            put_number(out, ",", s->chamfer);
        if (folds)
            put_number(out, ",", s->tilt_x_deg), put_number(out, ",", s->tilt_y_deg);
        for (int k = 0; k < terms; k++)
            put_number(out, ",", s->even[k]);
        for (int k = 0; k < odd; k++)
            put_number(out, ",", s->odd[k]);
        if (!round) {
            fprintf(out, ",%s", forms[s->form]);
            put_number(out, ",", s->radius_x);
            put_number(out, ",", s->conic_x);
        }
        fputc(',', out);
        put_text(out, s->name, false);
        fputc('\n', out);
    }
    return STATUS_OK;
}

/* --- .dat --- */

static status write_dat(const lens_prescription *p, FILE *out, diagnostic *why)
{
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        bool plain = !s->mirror && s->conic == 0.0 && s->form == SIDE_ROUND && odd_terms_of(p) == 0;
        for (int k = 0; k < LENS_EVEN_TERMS; k++)
            plain &= s->even[k] == 0.0;
        if (!plain)
            return diagnose(why, STATUS_BAD_INPUT, "write a .zmx or .csv file",
                            "surface %zu is a mirror or not a sphere, which a .dat file cannot hold", i + 1);
    }
    fputs("# ", out);
    put_text(out, p->title, true);
    fputs("\n# radius thickness index diameter, V\n", out);
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        const bool air = s->medium.kind == LENS_AIR;
        put_number(out, "", s->radius);
        put_number(out, " ", s->thickness);
        put_number(out, " ", air ? ((int)i == p->stop ? 0.0 : 1.0) : s->medium.n_d);
        put_number(out, " ", s->diameter);
        if (!air && s->medium.V_d > 0.0)
            put_number(out, " ", s->medium.V_d);
        fputc('\n', out);
    }
    return STATUS_OK;
}

/* --- .zmx --- */

static void put_zmx_glass(const lens_surface *s, FILE *out)
{
    const lens_medium *m = &s->medium;
    if (s->mirror)
        fputs("  GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0\n", out);
    if (s->mirror || m->kind == LENS_AIR)
        return;
    const bool named = m->kind == LENS_CATALOGUE || m->kind == LENS_DATA;
    fputs("  GLAS ", out);
    for (const char *c = named ? m->name : "___BLANK"; *c; c++)
        fputc(toupper((unsigned char)*c), out);
    fputs(named ? " 0 0" : " 1 0", out);
    put_number(out, " ", m->n_d);
    put_number(out, " ", m->V_d);
    fputs(" 0 0 0 0 0 0\n", out);
}

/* The coefficient of r^n. */
static double term_of(const lens_surface *s, int n)
{
    return n % 2 == 0 && n > 2 ? s->even[n / 2 - 2] : s->odd[n < 3 ? n - 1 : (n + 1) / 2];
}

/* A type of surfaces: its name, the power of the coefficient PARM 1, and by how much that grows with the number; a
 * parameter before that, of a toric surface; the last parameter. */
typedef struct zmx_kind {
    const char *word;
    int power, step, before, last;
} zmx_kind;

static zmx_kind zmx_kind_of(const lens_surface *s)
{
    bool odd = false, any = false;
    for (int n = 1; n <= 20; n++) {
        const double a = n % 2 == 0 || n < 16 ? term_of(s, n) : 0.0;
        any |= a != 0.0, odd |= a != 0.0 && n % 2 == 1;
    }
    if (s->form == SIDE_BICONIC)
        return (zmx_kind){"BICONICX", 0, 0, 2, 2};
    if (s->form == SIDE_TORIC)
        return (zmx_kind){"TOROIDAL", 2, 2, 1, 8};
    return odd   ? (zmx_kind){"ODDASPHE", 1, 1, 0, 8}
           : any ? (zmx_kind){"EVENASPH", 2, 2, 0, 10}
                 : (zmx_kind){"STANDARD", 2, 2, 0, 0};
}

/* Whether all coefficients are among the parameters. */
static bool zmx_holds(const lens_surface *s)
{
    const zmx_kind kind = zmx_kind_of(s);
    for (int n = 1; n <= 20; n++) {
        if ((n % 2 == 1 && n > 15) || term_of(s, n) == 0.0)
            continue;
        const int at = kind.step ? (n - kind.power) / kind.step + 1 + kind.before : 0;
        if (!kind.step || (n - kind.power) % kind.step != 0 || at <= kind.before || at > kind.last)
            return false;
    }
    return true;
}

static void put_parameters(const lens_surface *s, FILE *out)
{
    const zmx_kind kind = zmx_kind_of(s);
    for (int i = 1; i <= kind.last; i++) {
        const double value = i > kind.before ? term_of(s, kind.power + (i - 1 - kind.before) * kind.step)
                             : i == 1        ? s->radius_x
                                             : s->conic_x;
        if (value == 0.0)
            continue;
        fprintf(out, "  PARM %d", i);
        put_number(out, " ", value);
        fputc('\n', out);
    }
}

/* Before and after a fold mirror, whose own thickness is then 0. */
static void put_zmx_break(size_t number, const lens_surface *s, double thickness, FILE *out)
{
    fprintf(out, "SURF %zu\n  TYPE COORDBRK\n", number);
    put_number(out, "  PARM 3 ", s->tilt_x_deg), fputc('\n', out);
    put_number(out, "  PARM 4 ", s->tilt_y_deg), fputc('\n', out);
    put_number(out, "  DISZ ", thickness), fputc('\n', out);
}

/* The shortest curvature that a reader takes for that radius. */
static void put_curvature(double radius, FILE *out)
{
    char text[NUMBER_TEXT_MAX] = "0";
    double c = 0.0;
    for (int digits = 1; digits <= 17 && radius != 0.0; digits++) {
        number_parse_real(number_format_digits(1.0 / radius, digits, text), &c);
        if (lens_short_number(1.0 / c) == radius)
            break;
    }
    fprintf(out, "  CURV %s", text);
}

static void put_zmx_surface(const lens_prescription *p, size_t number, const lens_surface *s, bool stop, FILE *out)
{
    fprintf(out, "SURF %zu\n", number);
    if (stop)
        fputs("  STOP\n", out);
    fprintf(out, "  TYPE %s\n", zmx_kind_of(s).word);
    if (s->name[0]) {
        fputs("  COMM ", out);
        put_text(out, s->name, true);
        fputc('\n', out);
    }
    put_curvature(s->radius, out);
    lens_zmx_put_tail(p, s->line > 0 ? s->line : LONG_MAX, "CURV", " 0 0 0 0 \"\"", out);
    put_parameters(s, out);
    if (isinf(s->thickness))
        fputs("  DISZ INFINITY\n", out);
    else
        put_number(out, "  DISZ ", s->thickness), fputc('\n', out);
    put_zmx_glass(s, out);
    if (s->conic != 0.0)
        put_number(out, "  CONI ", s->conic), fputc('\n', out);
    put_number(out, "  DIAM ", 0.5 * s->diameter);
    lens_zmx_put_tail(p, s->line > 0 ? s->line : LONG_MAX, "DIAM", " 1 0 0 1 \"\"", out);
    if (s->hole > 0.0) {
        put_number(out, "  CLAP ", 0.5 * s->hole);
        put_number(out, " ", 0.5 * s->diameter);
        fputs(" 0\n", out);
    }
    if (s->line > 0)
        lens_zmx_put_kept(p, s->line, out);
}

static void put_zmx_fields(const lens_prescription *p, FILE *out)
{
    static const char *const factors[] = {"VDXN", "VDYN", "VCXN", "VCYN"};
    fprintf(out, "FTYP %d 0 %zu %zu 0 0 0\nXFLN", p->field_kind == LENS_FIELD_OBJECT, p->field_count,
            p->wavelength_count);
    for (size_t i = 0; i < p->field_count; i++)
        put_number(out, " ", p->field[i].x);
    fputs("\nYFLN", out);
    for (size_t i = 0; i < p->field_count; i++)
        put_number(out, " ", p->field[i].y);
    for (size_t k = 0; k < 4; k++) {
        fprintf(out, "\n%s", factors[k]);
        for (size_t i = 0; i < p->field_count; i++)
            put_number(out, " ", lens_vignetting_factor(&p->vignetting[i], k));
    }
}

/* The shortest number of micrometres that a reader takes for that wavelength. */
static void put_micrometres(double nm, FILE *out)
{
    char text[NUMBER_TEXT_MAX];
    double um;
    for (int digits = 1; digits <= 17; digits++) {
        number_parse_real(number_format_digits(nm / 1000.0, digits, text), &um);
        if (lens_short_number(1000.0 * um) == nm)
            break;
    }
    fprintf(out, " %s", text);
}

static status write_zmx(const lens_prescription *p, FILE *out, diagnostic *why)
{
    static const struct {
        const char *word;
        double mm;
    } units[] = {{"MM", 1.0}, {"CM", 10.0}, {"IN", 25.4}, {"METER", 1000.0}};
    static const char *const apertures[] = {
        [LENS_APERTURE_PUPIL] = "ENPD ", [LENS_APERTURE_NUMBER] = "FNUM ", [LENS_APERTURE_OBJECT] = "OBNA "};
    const char *unit = NULL;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        unit = fabs(units[i].mm - p->unit_mm) <= 1e-12 * p->unit_mm ? units[i].word : unit;
    for (size_t i = 0; i < p->count; i++)
        if (p->surface[i].tilt_x_deg != 0.0 && p->surface[i].tilt_y_deg != 0.0)
            return diagnose(why, STATUS_BAD_INPUT, "write a .csv file",
                            "surface %zu is tilted about two axes, for which a .zmx file has no simple form", i + 1);
    if (!unit)
        return diagnose(why, STATUS_BAD_INPUT, "set render.unit_m to 0.001, 0.01, 0.0254 or 1, or write a .csv file",
                        "a .zmx file has no unit of %g mm", p->unit_mm);
    for (size_t i = 0; i < p->count; i++)
        if (!zmx_holds(&p->surface[i]))
            return diagnose(why, STATUS_BAD_INPUT, "write a .csv file",
                            "surface %zu has coefficients that a .zmx file cannot hold", i + 1);
    fputs("VERS", out);
    lens_zmx_put_tail(p, 0, "VERS", " 181005 0 0", out);
    fputs("MODE SEQ\nNAME ", out);
    put_text(out, p->title, true);
    fputc('\n', out);
    lens_zmx_put_kept(p, 0, out);
    fprintf(out, "UNIT %s X W X CM MR CPMM\n", unit);
    if (p->aperture_kind == LENS_APERTURE_STOP)
        fputs("FLOA\n", out);
    else
        put_number(out, apertures[p->aperture_kind], p->aperture), fputs(" 0\n", out);
    put_zmx_fields(p, out);
    for (size_t i = 0; i < p->wavelength_count; i++) {
        fprintf(out, "\nWAVM %zu", i + 1);
        put_micrometres(p->wavelength[i].nm, out);
        put_number(out, " ", p->wavelength[i].weight);
    }
    fprintf(out, "\nPWAV %zu\n", p->primary + 1);
    const lens_surface object = {.thickness = p->object_distance, .medium = {.kind = LENS_AIR}},
                       plane = {.radius = p->image_radius, .diameter = p->image_diameter, .medium = {.kind = LENS_AIR}};
    size_t number = 0;
    put_zmx_surface(p, number++, &object, false, out);
    for (size_t i = 0; i < p->count; i++) {
        lens_surface s = p->surface[i];
        const double thickness = s.thickness;
        const bool folds = lens_folds(&s);
        if (folds)
            put_zmx_break(number++, &s, 0.0, out), s.thickness = 0.0;
        put_zmx_surface(p, number++, &s, (int)i == p->stop, out);
        if (folds)
            put_zmx_break(number++, &s, thickness, out);
    }
    put_zmx_surface(p, number, &plane, false, out);
    lens_zmx_put_kept(p, -1, out);
    return STATUS_OK;
}

status lens_file_write(const lens_prescription *p, const char *path, FILE *out, diagnostic *why)
{
    const size_t length = strlen(path);
    const char *ending = length > 4 ? path + length - 4 : "";
    if (strcasecmp(ending, ".zmx") == 0)
        return write_zmx(p, out, why);
    if (strcasecmp(ending, ".dat") == 0)
        return write_dat(p, out, why);
    return write_csv(p, out, why);
}

const char *lens_file_lacks(const lens_prescription *p, const char *path)
{
    const size_t length = strlen(path);
    const char *ending = length > 4 ? path + length - 4 : "";
    bool aside = false, weighted = false, named = false;
    for (size_t i = 0; i < p->field_count; i++)
        aside |= p->field[i].x != 0.0;
    for (size_t i = 0; i < p->wavelength_count; i++)
        weighted |= p->wavelength[i].weight != p->wavelength[0].weight;
    for (size_t i = 0; i < p->count; i++)
        named |= p->surface[i].medium.kind == LENS_CATALOGUE || p->surface[i].medium.kind == LENS_DATA;
    if (strcasecmp(ending, ".dat") == 0)
        return named || p->field_count > 1 || p->wavelength_count > 1 || p->aperture_kind != LENS_APERTURE_STOP ||
                       isfinite(p->object_distance) || has_bevels(p)
                   ? "names of glasses (n_d and V_d stand for them), the aperture, the object, fields, wavelengths "
                     "and bevels"
                   : NULL;
    if (strcasecmp(ending, ".csv") != 0)
        return has_bevels(p) ? "bevels" : NULL;
    if (!aside && !weighted)
        return NULL;
    return aside && weighted ? "the direction of fields across y and the weights of wavelengths"
           : aside           ? "the direction of fields across y"
                             : "the weights of wavelengths";
}
