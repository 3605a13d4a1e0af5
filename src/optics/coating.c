/* Reads coatings, knows named designs, and evaluates the indices of their layers. */
#include "optics/coating.h"

#include "base/number.h"
#include "base/text.h"
#include "optics/media.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- designs --- */

#define MACLEOD "Macleod, Thin-Film Optical Filters, 4th ed., on "
#define COMPUTED "; thicknesses by least squares with this table's indices"

static const coating_design designs[] = {
    {"ar-550", "mgf2 550/4", "one quarter-wave layer against reflection, on any glass",
     MACLEOD "antireflection coatings"},
    {"v-550", "mgf2 127.5, ta2o5 15.7", "V-coat: no reflection at 550 nm, on crown glass of index 1.52",
     MACLEOD "antireflection coatings" COMPUTED},
    {"ar-visible", "mgf2 550/4, ta2o5 550/2, alumina 550/4",
     "quarter-half-quarter against reflection from 430 to 700 nm, on glass of index 1.52",
     MACLEOD "antireflection coatings"},
    {"ar-broad", "mgf2 96.4, ta2o5 127.9, mgf2 32, ta2o5 16.7",
     "four layers against reflection from 420 to 680 nm, on glass of index 1.52",
     MACLEOD "antireflection coatings" COMPUTED},
    {"mirror-550", "10x(tio2 550/4, fused-silica 550/4)",
     "mirror of ten pairs of quarter-wave layers for 480 to 620 nm", MACLEOD "high-reflectance coatings"},
    {"long-pass-555",
     "tio2 10.4, fused-silica 117.8, tio2 38.7, 5x(fused-silica 79.4, tio2 46), fused-silica 79.4, tio2 40.6, "
     "fused-silica 80.6, tio2 22.1",
     "dichroic: reflects 430 to 530 nm and transmits 575 to 700 nm, on crown glass", MACLEOD "edge filters" COMPUTED},
    {"short-pass-595",
     "fused-silica 63.7, tio2 73.7, fused-silica 128.7, 5x(tio2 72.8, fused-silica 118.5), tio2 72.8, "
     "fused-silica 128.4, tio2 85.4, fused-silica 150.9",
     "dichroic: transmits 430 to 580 nm and reflects 615 to 720 nm, on crown glass", MACLEOD "edge filters" COMPUTED},
    {"splitter-45", "tio2 52.5, fused-silica 100.3, tio2 97.3, fused-silica 31.9, tio2 11",
     "halves unpolarised light at 45 degrees, 430 to 670 nm, on crown glass in air", MACLEOD "beam splitters" COMPUTED},
    {"polariser-cube", "5x(tio2 66.1, fused-silica 189.4), tio2 66.1",
     "MacNeille's polarising cube, between prisms of n-sf11: reflects s and transmits p at 45 degrees",
     "MacNeille, US patent 2403731 (1946); quarter waves of 550 nm at 45 degrees"},
    {"aluminium-mirror", "fused-silica 550/2, aluminium 100", "aluminium, protected by half a wave",
     MACLEOD "metallic reflectors"},
    {"aluminium-enhanced", "2x(tio2 550/4, mgf2 550/4), aluminium 100",
     "aluminium, reflecting more by two pairs of quarter-wave layers", MACLEOD "metallic reflectors"},
    {"silver-mirror", "fused-silica 550/2, silver 150", "silver, protected by half a wave",
     MACLEOD "metallic reflectors"},
};

size_t coating_designs_count(void)
{
    return sizeof designs / sizeof *designs;
}

const coating_design *coating_design_at(size_t i)
{
    return &designs[i];
}

const coating_design *coating_design_find(const char *name)
{
    for (size_t i = 0; i < coating_designs_count(); i++)
        if (strcmp(designs[i].name, name) == 0)
            return &designs[i];
    return NULL;
}

/* --- from text --- */

#define INDEX_MOST 20.0
#define THICKNESS_MOST_NM 1e5
#define EXAMPLE "write a design (cuvette media), or layers from outside to inside, as 'mgf2 99.7, ta2o5 550/2'"

typedef struct coating_reader {
    const char *at; /* what is left */
    coating_layers *out;
    diagnostic *why;
} coating_reader;

static void skip_blanks(coating_reader *r)
{
    r->at += strspn(r->at, " \t\n\r");
}

/* The next word, up to a blank, a comma or a bracket. */
static status read_word(coating_reader *r, char word[COATING_TEXT_MAX + 1])
{
    skip_blanks(r);
    const size_t length = strcspn(r->at, " \t\n\r,()");
    memcpy(word, r->at, length);
    word[length] = 0;
    r->at += length;
    return STATUS_OK;
}

static status nearest_medium(const coating_reader *r, const char *word)
{
#define NAME(name) name,
    static const char *const names[] = {MEDIA_NAMES(NAME) METAL_NAMES(NAME)};
#undef NAME
    const char *nearest = text_nearest(word, names, sizeof names / sizeof *names);
    char remedy[160];
    snprintf(remedy, sizeof remedy, nearest ? "did you mean '%s'?" : EXAMPLE, nearest);
    return diagnose(r->why, STATUS_BAD_INPUT, remedy, "'%.60s' is no index of a layer", word);
}

/* "1.38", or "2.4+0.01i". */
static bool parse_index(const char *word, complex_pair *out)
{
    char text[COATING_TEXT_MAX + 1];
    strcpy(text, word);
    char *plus = strchr(text, '+');
    const size_t length = strlen(text);
    *out = complex_of(0.0, 0.0);
    if (plus && text[length - 1] == 'i') {
        text[length - 1] = 0;
        *plus = 0;
        if (!number_parse_real(plus + 1, &out->im))
            return false;
    }
    return number_parse_real(text, &out->re) && out->re > 0.0 && out->re <= INDEX_MOST && out->im >= 0.0 &&
           out->im <= INDEX_MOST;
}

static bool is_same_medium(const layer_medium *a, const layer_medium *b)
{
    return a->of == b->of && a->metal == b->metal && a->measured == b->measured && a->constant.re == b->constant.re &&
           a->constant.im == b->constant.im;
}

static status add_medium(const coating_reader *r, const layer_medium *m, int *number)
{
    coating_layers *c = r->out;
    for (*number = 0; *number < c->media_count; ++*number)
        if (is_same_medium(&c->media[*number], m))
            return STATUS_OK;
    if (c->media_count == COATING_MEDIA_MAX)
        return diagnose(r->why, STATUS_BAD_INPUT, "use fewer", "a coating has at most %d different media",
                        (int)COATING_MEDIA_MAX);
    c->media[c->media_count++] = *m;
    return STATUS_OK;
}

static status read_medium(coating_reader *r, int *number)
{
    char word[COATING_TEXT_MAX + 1];
    layer_medium m = {.of = NULL};
    TRY(read_word(r, word));
    if (!word[0])
        return diagnose(r->why, STATUS_BAD_INPUT, EXAMPLE, "a layer has no index");
    if (strcmp(word, "data") == 0) {
        m.measured = true;
    } else if (!parse_index(word, &m.constant)) {
        const char *usual = media_usual_name(word);
        m.constant = complex_of(0.0, 0.0);
        m.of = media_find(usual);
        m.metal = metals_find(usual);
        if (!m.of && !m.metal)
            return nearest_medium(r, word);
    }
    return add_medium(r, &m, number);
}

/* "99.7", or "550/4". */
static status read_thickness(coating_reader *r, coating_layer *out)
{
    char word[COATING_TEXT_MAX + 1];
    TRY(read_word(r, word));
    char *slash = strchr(word, '/');
    if (slash)
        *slash = 0;
    const double most = slash ? THICKNESS_MOST_NM : 1e4;
    double first = 0.0, divisor = 0.0;
    if (!number_parse_real(word, &first) || !(first > 0.0) || first > most ||
        (slash && (!number_parse_real(slash + 1, &divisor) || !(divisor >= 0.01) || divisor > 1e4)))
        return diagnose(r->why, STATUS_BAD_INPUT, "give nm, as 99.7, or a part of a wavelength, as 550/4",
                        "'%.60s%s%.60s' is no thickness of a layer", word, slash ? "/" : "", slash ? slash + 1 : "");
    out->thickness = slash ? divisor : first;
    out->wave_nm = slash ? first : 0.0;
    return STATUS_OK;
}

static status add_layer(const coating_reader *r, coating_layer layer)
{
    if (r->out->count == COATING_LAYERS_MAX)
        return diagnose(r->why, STATUS_BAD_INPUT, "use fewer", "a coating has at most %d layers",
                        (int)COATING_LAYERS_MAX);
    r->out->layer[r->out->count++] = layer;
    return STATUS_OK;
}

static status read_layer(coating_reader *r)
{
    coating_layer layer;
    TRY(read_medium(r, &layer.medium));
    TRY(read_thickness(r, &layer));
    return add_layer(r, layer);
}

static bool take(coating_reader *r, char c)
{
    skip_blanks(r);
    const bool found = *r->at == c;
    r->at += found;
    return found;
}

/* Reads "10x(" if it is next. */
static bool take_times(coating_reader *r, int *times)
{
    skip_blanks(r);
    const size_t digits = strspn(r->at, "0123456789");
    if (digits == 0 || digits > 3 || r->at[digits] != 'x' || r->at[digits + 1] != '(')
        return false;
    *times = (int)strtol(r->at, NULL, 10);
    r->at += digits + 2;
    return true;
}

/* The layers of a bracket, and their copies; brackets within brackets are not read. */
static status read_repeated(coating_reader *r, int times)
{
    const int first = r->out->count;
    do
        TRY(read_layer(r));
    while (take(r, ','));
    if (!take(r, ')'))
        return diagnose(r->why, STATUS_BAD_INPUT, "write '10x(tio2 56.4, fused-silica 94.2)'",
                        "a bracket of the coating is not closed");
    const int last = r->out->count;
    if (times < 1)
        return diagnose(r->why, STATUS_BAD_INPUT, "repeat layers once or more", "0x(...) is no layer");
    for (int k = 1; k < times; k++)
        for (int i = first; i < last; i++)
            TRY(add_layer(r, r->out->layer[i]));
    return STATUS_OK;
}

static status read_layers(coating_reader *r)
{
    do {
        int times;
        TRY(take_times(r, &times) ? read_repeated(r, times) : read_layer(r));
    } while (take(r, ','));
    skip_blanks(r);
    return *r->at ? diagnose(r->why, STATUS_BAD_INPUT, EXAMPLE, "'%.60s' is unexpected in a coating", r->at)
                  : STATUS_OK;
}

/* A single word that is no design. */
static status no_design(const char *text, diagnostic *why)
{
    const char *names[sizeof designs / sizeof *designs];
    for (size_t i = 0; i < coating_designs_count(); i++)
        names[i] = designs[i].name;
    const char *nearest = text_nearest(text, names, coating_designs_count());
    char remedy[160];
    snprintf(remedy, sizeof remedy, nearest ? "did you mean '%s'?" : EXAMPLE, nearest);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "there is no coating '%.60s'", text);
}

status coating_parse(const char *text, coating_layers *out, diagnostic *why)
{
    const coating_design *named = coating_design_find(text);
    const char *layers = named ? named->layers : text;
    char plain[COATING_TEXT_MAX + 1];
    const size_t length = strlen(layers);
    *out = (coating_layers){.count = 0};
    if (length > COATING_TEXT_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "write fewer layers, or repeat them, as 10x(...)",
                        "a coating is longer than %d bytes", (int)COATING_TEXT_MAX);
    const bool bracketed = length >= 2 && layers[0] == '[' && layers[length - 1] == ']';
    snprintf(plain, sizeof plain, "%.*s", (int)(bracketed ? length - 2 : length), layers + bracketed);
    if (!plain[strcspn(plain, " ,(")] && !bracketed)
        return no_design(text, why);
    coating_reader r = {plain, out, why};
    return read_layers(&r);
}

bool coating_needs_data(const coating_layers *c)
{
    for (int i = 0; i < c->media_count; i++)
        if (c->media[i].measured)
            return true;
    return false;
}

/* --- films --- */

complex_pair film_stack_index(const film_stack *s, int number, double lambda_nm)
{
    const layer_medium *m = &s->layers.media[number];
    if (m->metal)
        return metal_index(m->metal, lambda_nm);
    if (m->of)
        return complex_of(medium_index(m->of, lambda_nm), 0.0);
    if (!m->measured)
        return m->constant;
    if (!s->data || !optical_data_has_first(s->data))
        return complex_of(1.0, 0.0);
    const double n = optical_data_at(s->data, lambda_nm);
    return complex_of(s->data_in_air ? n * medium_index(media_at(0), lambda_nm) : n,
                      optical_data_k(s->data, lambda_nm));
}

static bool absorbs(const film_stack *s)
{
    const coating_layers *c = &s->layers;
    for (int i = 0; i < c->media_count; i++)
        if (c->media[i].metal || c->media[i].constant.im > 0.0 ||
            (c->media[i].measured && s->data && optical_data_has_k(s->data)))
            return true;
    return false;
}

void film_stack_make(thin_film thin, const coating_layers *c, const optical_data *data, bool data_in_air,
                     film_stack *out)
{
    *out = (film_stack){.data = data, .data_in_air = data_in_air};
    coating_layers *l = &out->layers;
    if (c)
        *l = *c;
    if (thin.thickness_nm > 0.0) {
        memmove(&l->layer[1], &l->layer[0], (size_t)l->count++ * sizeof l->layer[0]);
        l->media[l->media_count] = (layer_medium){.constant = thin.index};
        l->layer[0] = (coating_layer){.medium = l->media_count++, .thickness = thin.thickness_nm};
    }
    for (int i = 0; i < l->count; i++) {
        const coating_layer one = l->layer[i];
        out->thickness_nm[i] = one.wave_nm > 0.0
                                   ? one.wave_nm / (one.thickness * film_stack_index(out, one.medium, one.wave_nm).re)
                                   : one.thickness;
    }
    out->absorbs = absorbs(out);
}

double film_stack_thickness_nm(const film_stack *s)
{
    double sum = 0.0;
    for (int i = 0; i < s->layers.count; i++)
        sum += s->thickness_nm[i];
    return sum;
}

int film_stack_films(const film_stack *s, double lambda_nm, bool inward, thin_film films[FILMS_MAX])
{
    const int count = s->layers.count;
    complex_pair index[COATING_MEDIA_MAX + 1];
    for (int i = 0; i < s->layers.media_count; i++)
        index[i] = film_stack_index(s, i, lambda_nm);
    for (int i = 0; i < count; i++)
        films[inward ? i : count - 1 - i] = (thin_film){index[s->layers.layer[i].medium], s->thickness_nm[i]};
    return count;
}
