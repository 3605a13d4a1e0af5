/* What the metrics of `cuvette realism` detect: measures scenes with an error of known size in what is traced, which
 * theory does not have. Built and run by experiments/detect.sh. One line a metric, scene, kind and size of the error. */
#include "injected.h"
#include "realism/realism.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct error_kind {
    const char *name;
    int injected;          /* enum injected_error, or -1 for a parameter of the traced scene */
    const char *parameter; /* of the rod scene */
    bool one_less;         /* set to 1 - size; otherwise times 1 + size */
} error_kind;

static const error_kind kinds[] = {
    {"none", -1, NULL, false},
    {"index.vessel", -1, "vessel.ior", false},
    {"index.liquid", -1, "liquid.ior", false},
    {"index.around", -1, "background.ior", false},
    {"absorption", -1, "liquid.absorb_per_m", false},
    {"transparency", -1, "clear.transparency", true},
    {"index", INJECT_INDEX, NULL, false},
    {"directions", INJECT_TURN, NULL, false},
    {"reflectances", INJECT_SHARES, NULL, false},
    {"wrong-side", INJECT_SIDE, NULL, false},
    {"swapped", INJECT_SWAP, NULL, false},
    {"total", INJECT_TOTAL, NULL, false},
    {"normal", INJECT_TILT, NULL, false},
};
/* Powers of ten; 1, a complete exchange, and 0.01 are the largest. */
enum { SMALLEST = -14, LARGEST = 0 };
/* The coefficients of experiments/realism.study. */
static const double absorb[] = {1.2, 0.5, 0.2};

static void failed(const diagnostic *why)
{
    fprintf(stderr, "detect: %s\n", why->what);
    exit(1);
}

static void set(scene *s, const char *text)
{
    diagnostic why = {0};
    if (scene_set_assignment(s, text, &why) != STATUS_OK)
        failed(&why);
}

static void disturb(scene *s, const error_kind *k, double size, double vessel, double liquid)
{
    char text[200];
    const double factor = 1.0 + size;
    if (k->one_less)
        snprintf(text, sizeof text, "%s=%.17g", k->parameter, 1.0 - size);
    else if (k->parameter[0] == 'v')
        snprintf(text, sizeof text, "%s=%.17g", k->parameter, vessel * factor);
    else if (k->parameter[0] == 'b')
        snprintf(text, sizeof text, "%s=%.17g", k->parameter, factor);
    else if (k->name[0] == 'i')
        snprintf(text, sizeof text, "%s=%.17g", k->parameter, liquid * factor);
    else
        snprintf(text, sizeof text, "%s=%.17g,%.17g,%.17g", k->parameter, absorb[0] * factor, absorb[1] * factor,
                 absorb[2] * factor);
    set(s, text);
}

static void measure(const scene *s, const char *name, double vessel, double liquid, const error_kind *k, double size)
{
    realism_report r;
    diagnostic why = {0};
    scene *traced = scene_clone(s);
    if (!traced)
        exit(1);
    if (k->parameter)
        disturb(traced, k, size, vessel, liquid);
    if (k->injected >= 0)
        injected[k->injected] = size;
    if (realism_measure_against(traced, s, isa_best(), &r, &why) != STATUS_OK)
        r.count = 0; /* such a scene has no metrics, such as a transparency of 0 */
    if (k->injected >= 0)
        injected[k->injected] = 0.0;
    for (int i = 0; i < r.count; i++) {
        const realism_value *v = &r.value[i];
        if (realism_is_defined(v))
            printf("%s,%g,%g,%s,%g,%s,%.3g,%.3g,%d\n", name, vessel, liquid, k->name, size, v->metric, realism_error(v),
                   v->tolerance, !realism_passes(v));
    }
    scene_destroy(traced);
}

static void all_sizes(const scene *s, const char *name, double vessel, double liquid, bool parameters)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (kinds[k].parameter && !parameters)
            continue;
        for (int power = k == 0 ? LARGEST : SMALLEST; power <= LARGEST; power++)
            if (power != -1)
                measure(s, name, vessel, liquid, &kinds[k], pow(10.0, power));
    }
    fflush(stdout);
}

/* detect NAME SCENE [VESSEL LIQUID | ASSIGNMENT...] */
int main(int argc, char **argv)
{
    scene *s = NULL;
    diagnostic why = {0};
    if (argc < 3)
        return 2;
    if (scene_read(argv[2], &s, &why) != STATUS_OK)
        failed(&why);
    const bool rod = argc == 5 && argv[3][0] < 'A';
    double index[2] = {0.0, 0.0};
    for (int i = 3; i < argc; i++) {
        char text[100];
        if (rod) {
            index[i - 3] = strtod(argv[i], NULL);
            snprintf(text, sizeof text, "%s.ior=%s", i == 3 ? "vessel" : "liquid", argv[i]);
        }
        set(s, rod ? text : argv[i]);
    }
    all_sizes(s, argv[1], index[0], index[1], rod);
    scene_destroy(s);
    return 0;
}
