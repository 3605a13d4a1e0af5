/* Words, numbers and media of lens files (lens_reader.h, lens_prescription.h). */
#include "scene/lens/lens_reader.h"
#include "base/array.h"
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/data/optical_files.h"
#include "scene/model/names.h"
#include "scene/model/scene.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* --- lines --- */

status lens_wrong(const lens_reader *r, int word, const char *remedy, const char *what, ...)
{
    char text[400];
    va_list list;
    va_start(list, what);
    vsnprintf(text, sizeof text, what, list);
    va_end(list);
    const status code = diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s", text);
    diagnostic_locate(r->why, r->name, r->line, word >= 0 && word < r->count ? r->column[word] : 0);
    return code;
}

double lens_short_number(double x)
{
    char text[NUMBER_TEXT_MAX];
    double y = x;
    if (isfinite(x))
        number_parse_real(number_format_digits(x, 12, text), &y);
    return fabs(y - x) <= 4.0 * DBL_EPSILON * fabs(x) ? y : x;
}

void lens_divide(lens_reader *r, char *line, bool commas)
{
    const char *blanks = " \t\r", *start = line;
    r->count = 0;
    for (char *at = line; at && r->count < LENS_WORDS_MAX;) {
        at += strspn(at, blanks);
        if (!*at && !commas)
            break;
        char *end = at + strcspn(at, commas ? "," : blanks), *last = end;
        const bool more = *end != 0;
        while (commas && last > at && strchr(blanks, last[-1]))
            last--;
        *last = *end = 0;
        r->word[r->count] = at;
        r->column[r->count++] = (int)(at - start) + 1;
        at = more ? end + 1 : NULL;
    }
}

status lens_number(const lens_reader *r, int i, const char *what, double *out)
{
    if (i >= r->count)
        return lens_wrong(r, -1, "complete the line", "%s is missing", what);
    if (!number_parse_real(r->word[i], out) || !isfinite(*out))
        return lens_wrong(r, i, "give a number, such as 12.5", "%s: '%.40s' is not a number", what, r->word[i]);
    return STATUS_OK;
}

status lens_read_vignetting(const lens_reader *r, size_t which)
{
    for (int i = 1; i < r->count && i <= LENS_LIST_MAX; i++) {
        lens_vignetting *v = &r->p->vignetting[i - 1];
        double *const to[] = {&v->shift_x, &v->shift_y, &v->squeeze_x, &v->squeeze_y};
        TRY(lens_number(r, i, "a vignetting factor", to[which]));
        if (!(fabs(*to[which]) < 10.0) || (which > 1 && *to[which] >= 1.0))
            return lens_wrong(r, i, "give a factor below 1; 0 for the whole pupil",
                              "the vignetting factor %g is out of range", *to[which]);
    }
    return STATUS_OK;
}

lens_surface *lens_append(lens_reader *r, status *code)
{
    lens_prescription *p = r->p;
    if (p->count >= LENS_SURFACES_MAX) {
        *code = lens_wrong(r, -1, "divide the system", "more than %d surfaces", LENS_SURFACES_MAX);
        return NULL;
    }
    if (!GROW(p->surface, r->room, p->count + 1)) {
        *code = out_of_memory(r->why);
        return NULL;
    }
    lens_surface *s = &p->surface[p->count++];
    *s = (lens_surface){.medium = {.kind = LENS_AIR, .glass_file = -1}, .line = r->line};
    return s;
}

status lens_read_medium(const lens_reader *r, int i, const char *word, lens_medium *out)
{
    diagnostic bad = {.what = ""};
    const status code = lens_medium_parse(word, r->glasses, out, &bad);
    if (code == STATUS_BAD_INPUT && !bad.file[0])
        return lens_wrong(r, i, bad.remedy, "%s", bad.what);
    if (code != STATUS_OK && r->why)
        *r->why = bad;
    return code;
}

/* --- media --- */

enum { GLASS_BYTES_MAX = 1 << 26 };

/* Cauchy's law n = A + B / L^2 with the given n_d, and B from V_d = (n_d - 1) / (n_F - n_C). */
lens_medium lens_medium_of_numbers(double n_d, double V_d)
{
    const double um = 1e-3, d = LINE_HELIUM_D_NM * um, F = LINE_HYDROGEN_F_NM * um, C = LINE_HYDROGEN_C_NM * um;
    lens_medium m = {.kind = V_d > 0.0 ? LENS_MODEL : LENS_CONSTANT, .n_d = n_d, .V_d = V_d, .glass_file = -1};
    m.law.relative_to_air = true;
    m.law.law = (dispersion){.kind = DISPERSION_CONSTANT, .count = 1, .coefficient = {n_d}};
    if (V_d > 0.0) {
        const double B = (n_d - 1.0) / V_d / (1.0 / (F * F) - 1.0 / (C * C));
        m.law.law = (dispersion){.kind = DISPERSION_CAUCHY, .count = 2, .coefficient = {n_d - B / (d * d), B}};
    }
    return m;
}

static bool is_air(const char *word)
{
    return !*word || strcasecmp(word, "air") == 0;
}

static bool find_in_catalogue(const char *word, lens_medium *out)
{
    const char *usual = media_usual_name(word);
    const medium *m = media_find(usual);
    if (!m)
        return false;
    *out = (lens_medium){.kind = LENS_CATALOGUE, .glass_file = -1, .law = {.law = m->law}};
    out->law.relative_to_air = m->relative_to_air;
    out->n_d = lens_medium_index(out, LINE_HELIUM_D_NM);
    const double V = dispersion_abbe_number(&m->law);
    out->V_d = isfinite(V) ? V : 0.0;
    return true;
}

/* The medium of a glass in the text of a catalogue: its formula, and n_d and V_d as stated. */
static status glass_of_text(const char *path, const char *text, size_t size, const char *name, double n_d, double V_d,
                            lens_medium *out, diagnostic *why)
{
    const optical_file_choice choice = {.glass = name, .column = "", .scale = 1.0};
    const optical_data *data;
    TRY(optical_file_parse(path, text, size, &choice, &data, why));
    *out = (lens_medium){.kind = LENS_DATA, .n_d = n_d, .V_d = fmax(V_d, 0.0)};
    out->law = (index_law){.law = *optical_data_law(data), .relative_to_air = true};
    snprintf(out->name, sizeof out->name, "%s", name);
    optical_data_release(data);
    return STATUS_OK;
}

/* The scene's own material of that name. The index of data is not known before they are loaded. */
static bool find_in_scene(const scene *s, const char *word, lens_medium *out)
{
    lens_medium m = {.kind = LENS_DATA, .glass_file = -1};
    object_name name;
    snprintf(m.name, sizeof m.name, "%.63s", word);
    lens_material_name(&m, name);
    const int at = object_find(s, PARAM_MATERIAL, name);
    if (at < 0 || s->materials[at].value.medium == MEDIUM_DATA ||
        material_index_law(&s->materials[at].value, name, &m.law, NULL) != STATUS_OK)
        return false;
    m.n_d = lens_medium_index(&m, LINE_HELIUM_D_NM);
    const double F = lens_medium_index(&m, LINE_HYDROGEN_F_NM), C = lens_medium_index(&m, LINE_HYDROGEN_C_NM);
    m.V_d = F != C ? (m.n_d - 1.0) / (F - C) : 0.0;
    *out = m;
    return true;
}

/* A line "NM name formula code n_d V_d ..." of the file with that name. */
static status find_in_file(const char *path, const char *root, const char *word, lens_medium *out, bool *found,
                           diagnostic *why)
{
    char *text, name[LENS_NAME_MAX], n[32], V[32];
    size_t size;
    TRY(file_read_below(path, root, GLASS_BYTES_MAX, &text, &size, why));
    char *plain = text_narrow(text, size), *rest = plain;
    status code = plain ? STATUS_OK : out_of_memory(why);
    double n_d, V_d;
    for (char *line; !*found && code == STATUS_OK && (line = strsep(&rest, "\n"));)
        if (sscanf(line, "NM %63s %*s %*s %31s %31s", name, n, V) == 3 && strcasecmp(name, word) == 0 &&
            number_parse_real(n, &n_d) && number_parse_real(V, &V_d) && n_d > 0.0) {
            code = glass_of_text(path, text, size, name, n_d, V_d, out, why);
            *found = true;
        }
    free(plain);
    free(text);
    return code;
}

/* n/V, a six-digit glass code (517642: n_d 1.517, V_d 64.2; MIL-G-174), or n. */
static bool find_numbers(const char *word, lens_medium *out)
{
    const char *at = word;
    double n, V = 0.0;
    if (!number_scan(&at, &n))
        return false;
    if ((*at == '/' || *at == ':') && (at++, !number_scan(&at, &V)))
        return false;
    if (*at)
        return false;
    if (strlen(word) == 6 && strspn(word, "0123456789") == 6) {
        V = fmod(n, 1000.0) / 10.0;
        n = 1.0 + floor(n / 1000.0) / 1000.0;
    }
    if (!(n >= 0.1 && n <= 10.0 && V >= 0.0))
        return false;
    *out = lens_medium_of_numbers(n, V);
    if (n == 1.0)
        *out = (lens_medium){.kind = LENS_AIR, .glass_file = -1};
    return true;
}

/* The name under which a glass is known, of which the word is a variant: with the N- of newer glasses, or without. */
static bool find_variant(const char *word, const lens_glasses *glasses, char name[LENS_NAME_MAX])
{
    const bool newer = strncasecmp(word, "N-", 2) == 0;
    snprintf(name, LENS_NAME_MAX, "%s%.50s", newer ? "" : "N-", word + (newer ? 2 : 0));
    lens_medium m;
    bool found = find_in_catalogue(name, &m);
    for (size_t i = 0; glasses && i < glasses->count && !found; i++)
        if (find_in_file(glasses->file[i], glasses->root, name, &m, &found, NULL) != STATUS_OK)
            found = false;
    return found;
}

static status unknown_glass(const char *word, const lens_glasses *glasses, diagnostic *why)
{
    char name[LENS_NAME_MAX], hint[LENS_NAME_MAX + 64] = "", remedy[400];
    if (find_variant(word, glasses, name))
        snprintf(hint, sizeof hint, "%s is known: write it if that will do; or ", name);
    snprintf(remedy, sizeof remedy,
             "%sgive the maker's catalogue with -g FILE.agf (in a scene: glasses: FILE.agf); or write n_d/V_d, such as "
             "1.62041/60.3, by which other colours are near, not exact",
             hint);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "the glass '%.60s' is neither in the catalogue nor in a file of glasses", word);
}

status lens_medium_parse(const char *word, const lens_glasses *glasses, lens_medium *out, diagnostic *why)
{
    *out = (lens_medium){.kind = LENS_AIR, .glass_file = -1};
    if (is_air(word))
        return STATUS_OK;
    bool found = find_numbers(word, out) || (glasses && glasses->own && find_in_scene(glasses->own, word, out));
    for (size_t i = 0; glasses && i < glasses->count && !found; i++) {
        TRY(find_in_file(glasses->file[i], glasses->root, word, out, &found, why));
        out->glass_file = (int)i;
    }
    if (!found && !find_in_catalogue(word, out))
        return unknown_glass(word, glasses, why);
    if (!out->name[0] && (out->kind == LENS_CATALOGUE || out->kind == LENS_DATA))
        snprintf(out->name, sizeof out->name, "%s", media_usual_name(word));
    return STATUS_OK;
}

char *lens_medium_text(const lens_medium *m, char *text)
{
    char n[NUMBER_TEXT_MAX], V[NUMBER_TEXT_MAX];
    switch (m->kind) {
    case LENS_AIR: snprintf(text, LENS_NAME_MAX, "air"); break;
    case LENS_CATALOGUE:
    case LENS_DATA: snprintf(text, LENS_NAME_MAX, "%.*s", LENS_NAME_MAX - 1, m->name); break;
    case LENS_MODEL: snprintf(text, LENS_NAME_MAX, "%s/%s", number_format(m->n_d, n), number_format(m->V_d, V)); break;
    case LENS_CONSTANT: snprintf(text, LENS_NAME_MAX, "%s", number_format(m->n_d, n)); break;
    }
    return text;
}

void lens_material_name(const lens_medium *m, object_name name)
{
    char word[LENS_NAME_MAX];
    lens_medium_text(m, word);
    const bool number = isdigit((unsigned char)word[0]);
    size_t used = (size_t)snprintf(name, sizeof(object_name), "%s", number ? "glass-" : "");
    for (const char *c = word; *c && used < 60; c++)
        name[used++] = isalnum((unsigned char)*c) || *c == '_' ? (char)tolower((unsigned char)*c) : '-';
    name[used] = 0;
}

/* --- glasses of Zemax's files --- */

/* n_d 1.5 and V_d 40 are what Zemax writes for a glass of a catalogue. */
static bool is_placeholder(double n, double V)
{
    return n == 1.5 && V == 40.0;
}

status lens_read_glass(const lens_reader *r, lens_surface *s)
{
    double n = 0.0, V = 0.0;
    if (r->count < 2)
        return lens_wrong(r, -1, "give the name of a glass", "GLAS has no name");
    s->mirror = strcasecmp(r->word[1], "MIRROR") == 0;
    if (s->mirror) {
        s->medium = r->p->count > 1 ? s[-1].medium : s->medium;
        return STATUS_OK;
    }
    const bool has_numbers = r->count > 5 && number_parse_real(r->word[4], &n) && number_parse_real(r->word[5], &V) &&
                             n >= 1.0 && n < 10.0 && V >= 0.0;
    const bool is_model = r->count > 2 && strcmp(r->word[2], "1") == 0;
    if (is_model && has_numbers) {
        s->medium = lens_medium_of_numbers(n, V);
        return STATUS_OK;
    }
    diagnostic bad = {.what = ""};
    const status code = lens_medium_parse(r->word[1], r->glasses, &s->medium, &bad);
    if (code != STATUS_BAD_INPUT || bad.file[0]) {
        if (code != STATUS_OK && r->why)
            *r->why = bad;
        return code;
    }
    if (!has_numbers || is_placeholder(n, V))
        return lens_wrong(r, 1, bad.remedy, "%s", bad.what);
    s->medium = lens_medium_of_numbers(n, V);
    lens_note_item(r->p, "by n_d and V_d, which do not tell the index of other colours exactly", "%.20s", r->word[1]);
    return STATUS_OK;
}

/* --- systems of scenes --- */

double lens_tidy(double x)
{
    char text[NUMBER_TEXT_MAX];
    double rounded = x;
    number_parse_real(number_format_digits(x, 12, text), &rounded);
    return rounded;
}

bool lens_belongs(const char *system, const char *name)
{
    const size_t length = strlen(system);
    return length == 0 || (strncmp(name, system, length) == 0 && (name[length] == '-' || !name[length]));
}
