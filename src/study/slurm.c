#include "study/slurm.h"
#include "base/build_id.h"
#include "base/text.h"
#include "scene/model/scene.h"
#include "study/row_environments.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_missing(const study_estimate *part)
{
    return part->cells_lacking || part->cells_to_keep;
}

char *slurm_array(const study_estimate *parts, size_t count)
{
    text_writer writer;
    char *text = NULL;
    if (text_writer_open(&writer, NULL) != STATUS_OK)
        return NULL;
    const char *before = "";
    for (size_t i = 0, last; i < count; i = last + 1) {
        for (last = i; last + 1 < count && is_missing(&parts[last + 1]); last++) {
        }
        if (!is_missing(&parts[i])) {
            last = i;
            continue;
        }
        fprintf(writer.stream, last > i ? "%s%zu-%zu" : "%s%zu", before, i, last);
        before = ",";
    }
    return text_writer_close(&writer, &text, NULL, NULL) == STATUS_OK ? text : NULL;
}

double slurm_longest_s(const study_estimate *parts, size_t count)
{
    double longest_s = 0;
    for (size_t i = 0; i < count; i++)
        if (is_missing(&parts[i]) && (parts[i].cut || isnan(parts[i].most_s)))
            return NAN;
        else if (is_missing(&parts[i]))
            longest_s = fmax(longest_s, parts[i].most_s);
    return longest_s;
}

void slurm_time_limit(double longest_s, double factor, char text[SLURM_TIME])
{
    const double most_min = 1e8; /* a limit that Slurm still reads */
    const long minutes = (long)fmin(fmax(ceil(longest_s * factor / 60), SLURM_LEAST_MIN), most_min);
    const long hours = minutes / 60 % 24, days = minutes / (24 * 60);
    if (days)
        snprintf(text, SLURM_TIME, "%ld-%02ld:%02ld:00", days, hours, minutes % 60);
    else
        snprintf(text, SLURM_TIME, "%02ld:%02ld:00", hours, minutes % 60);
}

status slurm_needs_of(const study *s, slurm_needs *out, diagnostic *why)
{
    const double gib = 1 << 30, program_bytes = gib / 2, pixel_bytes = 64;
    *out = (slurm_needs){1, 0};
    for (size_t cell = 0; cell < study_cell_count(s); cell++) {
        scene *setting;
        TRY(study_cell_scene(s, cell, &setting, why));
        const double pixels = (double)setting->render.width * (double)setting->render.height;
        const long memory_gib = (long)ceil((program_bytes + pixel_bytes * pixels) / gib);
        if (setting->render.threads > out->threads)
            out->threads = (long)setting->render.threads;
        if (memory_gib > out->memory_gib)
            out->memory_gib = memory_gib;
        scene_destroy(setting);
    }
    return STATUS_OK;
}

static bool is_of(const row_environment_count *e, const char *machine)
{
    return e->run && strcmp(e->run->here.fact[0], machine) == 0 &&
           strcmp(e->run->here.fact[ENVIRONMENT_FACTS - 1], build_id()) == 0;
}

status slurm_environment(const study *s, const char *results, const char *node_type, char key[ENVIRONMENT_KEY],
                         char *unlike, size_t size, size_t *others, diagnostic *why)
{
    char machine[ENVIRONMENT_FACT_MAX];
    row_files *files;
    row_environment_count *all = NULL, *most = NULL;
    size_t count = 0;
    environment_of_node_type(node_type, machine, sizeof machine);
    snprintf(key, ENVIRONMENT_KEY, "none");
    unlike[0] = 0;
    *others = 0;
    TRY(row_files_read(s, results, ROWS, &files, why));
    const status code = row_environments_find(files, &all, &count, why);
    for (size_t i = 0; i < count; i++)
        if (!is_of(&all[i], machine))
            *others += all[i].rows;
        else if (!most || all[i].rows > most->rows)
            most = &all[i];
    for (size_t i = 0; most && i < count && !unlike[0]; i++)
        if (&all[i] != most && is_of(&all[i], machine))
            environment_difference(&all[i].run->here, &most->run->here, unlike, size);
    if (most)
        memcpy(key, most->key, ENVIRONMENT_KEY);
    free(all);
    row_files_destroy(files);
    return code;
}
