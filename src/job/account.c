/* Memory, hash and medians of a job's account, and notes on the light of photons in its frame. */
#include "job/account.h"
#include "measure/statistics.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status job_account_begin(const scene *s, isa level, size_t frames, job_account *out, diagnostic *why)
{
    *out = (job_account){.of = s,
                         .level = level,
                         .wall_s = calloc(frames + 1, sizeof(double)),
                         .cpu_s = calloc(frames + 1, sizeof(double)),
                         .spent = {NAN, NAN, -1, -1, -1},
                         .noise = noise_unknown(),
                         .hardware = {-1, -1, -1, -1}};
    return out->wall_s && out->cpu_s ? STATUS_OK : out_of_memory(why);
}

void job_account_release(job_account *a)
{
    render_result_destroy(a->result);
    free(a->wall_s);
    free(a->cpu_s);
    *a = (job_account){.result = NULL};
}

uint64_t job_account_hash(const job_account *a)
{
    return a->film_hash ? a->film_hash : film_hash(a->result->img);
}

/* The median; `otherwise` without values, NaN when out of memory. */
static double median(const double *values, size_t count, double otherwise)
{
    if (count <= 1)
        return count ? values[0] : otherwise;
    double *sorted = malloc(count * sizeof *sorted);
    if (!sorted)
        return NAN;
    memcpy(sorted, values, count * sizeof *sorted);
    const double middle = summarize(sorted, count).median;
    free(sorted);
    return middle;
}

double job_account_wall_s(const job_account *a)
{
    return median(a->wall_s, a->count, a->result->wall_s);
}

double job_account_cpu_s(const job_account *a)
{
    return median(a->cpu_s, a->count, a->result->cpu_s);
}

/* --- light narrower than a pixel --- */

/* If the footprints of samples are known, light narrower than a pixel keeps its power at any number of samples
 * (render/photons/photon_map.c). Behind curved surfaces, footprints are exact only to first order; behind crystals and
 * surfaces with interpolated normals, they are guessed. There such light may be missed. */

/* A note is reported if a larger fraction of the image's light may be missing. */
#define NOTED 0.01

/* The sum over all pixels and channels. */
static double light_in(const film *f)
{
    double sum = 0.0;
    for (size_t i = 0; i < 3 * (size_t)f->width * (size_t)f->height; i++)
        sum += film_radiance(f->sum[i]);
    return sum;
}

static void note_narrow_light(const job_account *a, const note_sink *taker)
{
    const render_result *r = a->result;
    const int64_t *units = r->counters.undersampled;
    double narrow = (double)units[0];
    for (int k = 2; k < COUNTERS_FACTORS; k++)
        narrow += (double)units[k];
    if (!(narrow > 0.0)) /* the film's sum takes longer than its hash */
        return;
    const double one_percent = NOTED * COUNTERS_CUT_ONE * (r->img ? light_in(r->img) : 0.0), all = narrow;
    if (!(narrow > one_percent))
        return;
    int factor = 1;
    while (narrow > one_percent && ++factor < COUNTERS_FACTORS)
        narrow -= (double)units[factor];
    const int64_t samples = factor * factor * a->of->render.samples;
    char remedy[NOTE_TEXT_MAX] = "set render.integrator=path, whose random points find all light on average";
    if (factor < COUNTERS_FACTORS && samples <= SCENE_SAMPLES_MAX)
        snprintf(remedy, sizeof remedy, "set render.samples=%d", (int)samples);
    note_report(taker, "render", "samples", remedy,
                "%.0f %% of the image's light is narrower than a pixel, behind surfaces where it may be missed",
                fmax(100.0 * NOTED * all / one_percent, 1.0));
}

/* --- light of few photons --- */

/* Rounds up to two significant digits: the number of photons that suffice is a random estimate. */
static int64_t rounded_up(int64_t number)
{
    int64_t digit = 1;
    while (number / digit >= 100)
        digit *= 10;
    return (number + digit - 1) / digit * digit;
}

static void note_few_photons(const job_account *a, const note_sink *taker)
{
    const photon_shortage *few = &a->result->few;
    if (few->solid < 0)
        return;
    const int64_t most = (int64_t)param_find(PARAM_RENDER, "photons")->highest, enough = rounded_up(few->enough);
    char remedy[NOTE_TEXT_MAX] = "";
    if (a->of->render.photons < most)
        snprintf(remedy, sizeof remedy, "set render.photons=%" PRId64, enough < most ? enough : most);
    note_report(taker, "render", "photons", remedy,
                "the light that '%s' throws on matte surfaces rests on only %" PRId64 " photon%s",
                a->of->solids[few->solid].name, few->arrived, few->arrived == 1 ? "" : "s");
}

void frame_notes(const job_account *a, const note_sink *taker)
{
    if (a->result && a->count > 0)
        note_narrow_light(a, taker), note_few_photons(a, taker);
}
