/* Fits of a folder for tests of `cuvette fit`: a slab of glass whose displacements have a closed form, fits of text,
 * their results, and targets from a known truth with normal noise. A failure fails the test. */
#pragma once

#include "random_stream.h"
#include "scene/model/scene.h"
#include "study/fit/fit.h"
#include "study_fixture.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define DEGREE (M_PI / 180.0)

/* A slab of glass, one unit thick, and single rays upwards through it at 20, 40 and 60 degrees from its normal. */
static const char slab_scene[] =
    "render: {width: 16, height: 12, depth: 3}\n"
    "camera: {position: [0, 3, -15], target: [0, 0, 0]}\n"
    "background: {kind: uniform, color: [0.5, 0.6, 0.7]}\n"
    "beams:\n"
    "  a: {kind: bundle, position: [-1.71010, -4.69846, 0], direction: [0.342020143325669, 0.939692620785908, 0], "
    "rays: 1, "
    "branches: off}\n"
    "  b: {kind: bundle, position: [-3.21394, -3.83022, 0], direction: [0.642787609686539, 0.766044443118978, 0], "
    "rays: 1, "
    "branches: off}\n"
    "  c: {kind: bundle, position: [-4.33013, -2.5, 0], direction: [0.866025403784439, 0.5, 0], rays: 1, branches: "
    "off}\n"
    "solids:\n"
    "  slab: {shape: box, transparency: 1, ior: 1.5, position: [0, 0.5, 0], size: [40, 1, 40], priority: 1}\n";

#define SLAB_TARGETS(more)                                     \
    "  targets:\n"                                             \
    "    a: {quantity: spot_v, beam: a, value: 0, " more "}\n" \
    "    b: {quantity: spot_v, beam: b, value: 0, " more "}\n" \
    "    c: {quantity: spot_v, beam: c, value: 0, " more "}\n" \
    "  screen: {position: [0, 5, 0]}\n"
#define SLAB_HEAD "study: test\nscene: scene.yaml\nfit:\n  parameters: {slab.ior: {from: 1.1, to: 1.9}}\n"

static inline status read_fit(const fixture *f, const char *scene_text, const char *text, fit **out, diagnostic *why)
{
    char path[400];
    fixture_write(f, "scene.yaml", scene_text);
    fixture_write(f, "test.study", text);
    fixture_path(f, "test.study", path);
    return fit_read(path, out, why);
}

static inline fit *fit_of(const fixture *f, const char *scene_text, const char *text)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {.what = ""};
    fit *out = NULL;
    if (read_fit(f, scene_text, text, &out, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return out;
}

static inline job *new_job(void)
{
    job *j = NULL;
    assert_int_equal(job_create(&(job_settings){.level = NULL}, &j, NULL), STATUS_OK);
    return j;
}

static inline fit_result *solve(const fit *f, const char *results)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {.what = ""};
    fit_result *r = calloc(1, sizeof *r);
    fit_run *run = NULL;
    assert_non_null(r);
    status code = fit_run_begin(f, &(fit_options){.results = results}, &run, &why);
    THEN(code, fit_search(run, r, &why));
    THEN(code, fit_spread(run, r, &why));
    if (code != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    fit_run_end(run);
    return r;
}

/* The targets get the values measured at the truth. */
static inline void aim(fit *f, job *j, const double *truth)
{
    double values[FIT_TARGETS_MAX];
    assert_int_equal(fit_measure_at(f, j, truth, values, NULL), STATUS_OK);
    for (size_t i = 0; i < f->target_count; i++)
        f->targets[i].value = values[i];
}

static inline double normal(uint64_t *seed) /* Box and Muller, 1958 */
{
    return sqrt(-2.0 * log(1.0 - random_real(seed, 0, 1))) * cos(2.0 * M_PI * random_real(seed, 0, 1));
}

/* The lateral displacement of a ray by a plate of unit thickness (Hecht, Optics, problem 4.22), and its derivative by
 * the index. */
static inline double plate_shift(double n, double angle, double *slope)
{
    const double s = sin(angle), c = cos(angle), root = sqrt(n * n - s * s);
    *slope = s * c * n / (root * root * root);
    return s * (1.0 - c / root);
}
