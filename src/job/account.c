/* Memory, hash and medians of a job's account. */
#include "job/account.h"
#include "measure/statistics.h"

#include <math.h>
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
