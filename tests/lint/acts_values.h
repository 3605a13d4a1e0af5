/* Other legal values of a parameter, chosen from its table row alone (type, range, unit): a few near the current value
 * and a few far from it, so that a parameter with any effect shows it. A new parameter needs no line here. Ownership:
 * acts_values_of fills the caller's array. */
#pragma once

#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ACTS_VALUES_MAX = 32, ACTS_TEXT_MAX = 768 };

typedef struct acts_values {
    int count;
    char text[ACTS_VALUES_MAX][ACTS_TEXT_MAX];
} acts_values;

static inline void acts_add(acts_values *v, const char *now, const char *text)
{
    bool known = strcmp(text, now) == 0;
    for (int i = 0; i < v->count; i++)
        known |= strcmp(v->text[i], text) == 0;
    if (!known && v->count < ACTS_VALUES_MAX)
        snprintf(v->text[v->count++], ACTS_TEXT_MAX, "%s", text);
}

static inline double acts_clip(const param *row, double x)
{
    const double least = row->above_lowest ? row->lowest + 1e-12 * (row->highest - row->lowest) : row->lowest;
    return fmin(fmax(x, least), row->highest);
}

/* The k-th other number of a row. The steps fit lengths of a scene of a few units, shares, angles and indices alike. */
enum { ACTS_NUMBERS = 10 };
static inline double acts_number(const param *row, double now, int k)
{
    const bool angle = strcmp(row->unit, "deg") == 0, share = row->lowest >= 0.0 && row->highest <= 1.0;
    const double by = angle ? 20.0 : share ? 0.3 : fmax(0.4, 0.3 * fabs(now));
    const double others[ACTS_NUMBERS] = {now + by,       now - by,        now + 2.3 * by,  now * 0.5,   now + 0.1 * by,
                                         now - 3.7 * by, now * 3.0 + 1.0, now - 0.05 * by, row->lowest, row->highest};
    return acts_clip(row, others[k]);
}

static inline void acts_integers(const param *row, const char *now, acts_values *v)
{
    const int64_t n = strtoll(now, NULL, 10);
    const double others[] = {(double)n + 1, (double)n - 1, (double)n * 2, (double)(n / 2),
                             (double)n + 3, (double)n - 7, row->lowest,   row->lowest < 0 ? row->highest : (double)n};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char text[40];
        snprintf(text, sizeof text, "%.0f", acts_clip(row, others[i]));
        acts_add(v, now, text);
    }
}

static inline void acts_reals(const param *row, const char *now, acts_values *v)
{
    for (int k = 0; k < ACTS_NUMBERS; k++) {
        char text[40];
        snprintf(text, sizeof text, "%.9g", acts_number(row, strtod(now, NULL), k));
        acts_add(v, now, text);
    }
}

static inline void acts_triples(const param *row, const char *now, acts_values *v)
{
    double x[3] = {0};
    if (sscanf(now, "%lf,%lf,%lf", &x[0], &x[1], &x[2]) != 3)
        return;
    for (int k = 0; k < ACTS_NUMBERS; k++) {
        char text[160];
        double y[3];
        for (int i = 0; i < 3; i++) {
            y[i] = acts_number(row, x[i], (k + i) % ACTS_NUMBERS);
            y[i] = strcmp(row->name, "copies") == 0 ? floor(y[i]) : y[i];
        }
        snprintf(text, sizeof text, "%.9g,%.9g,%.9g", y[0], y[1], y[2]);
        acts_add(v, now, text);
    }
}

/* The current list with every number multiplied by a factor; for an empty list, lists that suit the uses of lists:
 * pairs by wavelength. */
static inline void acts_lists(const char *now, acts_values *v)
{
    static const char *const pairs[] = {"400,1.3,550,1.6,700,1.7", "400,0.6,550,0.2,700,0.1", "1.5,0.01", "1.4,0.006",
                                        NULL};
    const double factors[] = {0.9, 1.1, 0.7, 1.3};
    for (size_t k = 0; k < 4; k++) {
        char text[ACTS_TEXT_MAX] = "";
        const char *at = now + (*now == '[');
        for (char *end;; at = end + 1) {
            const double x = strtod(at, &end);
            if (end == at)
                break;
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s%.9g", *text ? "," : "", factors[k] * x);
            if (*end != ',')
                break;
        }
        if (*text)
            acts_add(v, now, text);
    }
    for (size_t k = 0; pairs[k]; k++)
        acts_add(v, now, pairs[k]);
}

/* Of a long list, such as the catalogue's media, evenly distributed ones, so that glasses and metals are among them. */
static inline void acts_words(const char *const *words, const char *now, acts_values *v)
{
    size_t count = 0;
    while (words[count])
        count++;
    const size_t step = (count + ACTS_VALUES_MAX - 1) / ACTS_VALUES_MAX;
    for (size_t i = 0; i < count; i += step)
        acts_add(v, now, words[i]);
}

/* Names that are legal for a word: of meshes, textures and materials, and files of the folder experiments/scenes. */
static inline void acts_names(const scene *s, const param *row, const char *now, acts_values *v)
{
    static const char *const files[] = {"chequer.png",       "models.jpg",         "slime.jpg",
                                        "../hands/tug.yaml", "../hands/pull.yaml", NULL};
    if (row->type == PARAM_PATH) {
        acts_words(files, now, v);
        return;
    }
    for (size_t i = 0; i < s->texture_count; i++)
        acts_add(v, now, s->textures[i].name);
    for (size_t i = 0; i < s->mesh_count; i++)
        acts_add(v, now, s->meshes[i].name);
    for (size_t i = 0; i < s->material_count; i++)
        acts_add(v, now, s->materials[i].name);
    acts_add(v, now, "");
}

static inline void acts_values_of(const scene *s, const param *row, const char *now, acts_values *v)
{
    v->count = 0;
    switch (row->type) {
    case PARAM_INT:
        if (!row->choices) {
            acts_integers(row, now, v);
            break;
        }
        /* fallthrough */
    case PARAM_CHOICE: acts_words(row->choices, now, v); break;
    case PARAM_REAL: acts_reals(row, now, v); break;
    case PARAM_VECTOR:
    case PARAM_COLOR: acts_triples(row, now, v); break;
    case PARAM_LIST: acts_lists(now, v); break;
    case PARAM_PATH:
    case PARAM_WORD: acts_names(s, row, now, v); break;
    case PARAM_LAYERS:
        acts_words((const char *const[]){"none", "ar-550", "mirror-550", NULL}, *now ? now : "none", v);
        break;
    }
}
