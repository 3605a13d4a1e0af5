#include "base/json_build.h"
#include "study/run_facts.h"
#include "base/build_id.h"
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "measure/clock.h"
#include "measure/usage.h"
#include "study/provenance.h"
#include "study/rows.h"
#include <hwloc.h>
#include <jpeglib.h>
#include <libgen.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <yaml.h>

#ifndef CUVETTE_VERSION
#define CUVETTE_VERSION "unknown"
#endif
#ifndef CUVETTE_COMPILER_FLAGS
#define CUVETTE_COMPILER_FLAGS "unknown"
#endif
#ifdef __clang__
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

#define TEXT_OF_(x) #x
#define TEXT_OF(x) TEXT_OF_(x)

static const double load_sample_s = 0.2;

/* Takes ownership of text; null if it is NULL or not UTF-8. */
static json_t *taken(char *text)
{
    json_t *value = json_text_or_null(text);
    free(text);
    return value;
}

/* The same for a text that is never unknown: NULL when out of memory. */
static json_t *certain(char *text)
{
    return text ? taken(text) : NULL;
}

/* --- parts --- */

/* The current time, or that of SOURCE_DATE_EPOCH (reproducible-builds.org/specs/source-date-epoch). */
json_t *run_time(void)
{
    char text[ROW_TIME_MAX];
    int64_t fixed;
    const char *epoch = getenv("SOURCE_DATE_EPOCH");
    if (epoch && number_parse_int(epoch, &fixed) && fixed >= 0 && fixed < INT64_C(253402300800)) /* year 10000 */
        return json_string(row_time(fixed * 1000, text));
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return json_string(row_time((int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000, text));
}

static json_t *libraries(void)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:s}", "libpng", png_get_libpng_ver(NULL), "libjpeg-turbo",
                     TEXT_OF(LIBJPEG_TURBO_VERSION), "hwloc", HWLOC_VERSION, "libyaml", yaml_get_version_string(),
                     "jansson", jansson_version_str());
}

static json_t *clocks(void)
{
    clock_quality wall = clock_wall_quality(), cpu = clock_thread_cpu_quality();
    return json_pack("{s:f, s:f, s:f, s:f}", "wall_tick_s", wall.tick_s, "wall_overhead_s", wall.overhead_s,
                     "thread_cpu_tick_s", cpu.tick_s, "thread_cpu_overhead_s", cpu.overhead_s);
}

json_t *run_machine_facts(const topology *machine)
{
    char *xml = topology_xml(machine);
    provenance_anonymize(xml);
    return json_pack("{s:o, s:o, s:i, s:i, s:i, s:o, s:o}", "cpu_model", taken(provenance_cpu_model()), "topology",
                     certain(topology_summary(machine)), "packages", topology_package_count(machine), "cores",
                     topology_core_count(machine), "processing_units", topology_pu_count(machine), "clocks", clocks(),
                     "hwloc_xml", certain(xml));
}

json_t *run_study_facts(const study *s)
{
    return json_pack("{s:s, s:o, s:I, s:o, s:o, s:o, s:o}", "name", s->name, "title", json_text_or_null(s->title),
                     "cells", (json_int_t)study_cell_count(s), "file", json_text_or_null(file_name_of(s->path)), "text",
                     json_text_or_null(s->text), "scene_file", json_text_or_null(file_name_of(s->scene_path)),
                     "scene_text", json_text_or_null(s->scene_text));
}

static void add_disturbance(void *list, const char *text)
{
    json_add(list, json_text_or_null(text));
}

/* Time that the hypervisor gave to others since boot, as a share of all time; null if unknown: proc(5), /proc/stat. */
static json_t *steal_share(void)
{
    unsigned long long t[8] = {0}, sum = 0;
    FILE *file = fopen("/proc/stat", "re");
    const int found = file ? fscanf(file, "cpu %llu %llu %llu %llu %llu %llu %llu %llu", &t[0], &t[1], &t[2], &t[3],
                                    &t[4], &t[5], &t[6], &t[7])
                           : 0;
    if (file)
        fclose(file);
    for (int i = 0; i < 8; i++)
        sum += t[i];
    return found == 8 && sum > 0 ? json_real((double)t[7] / (double)sum) : json_null();
}

static json_t *load_average(void)
{
    double load = 0;
    return getloadavg(&load, 1) == 1 ? json_real(load) : json_null();
}

/* Facts of the processor that are not part of the environment's key. */
static json_t *processor_facts(void)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "vendor", taken(provenance_cpu_field("vendor_id")), "family",
                     taken(provenance_cpu_field("cpu family")), "model", taken(provenance_cpu_field("model\t")),
                     "stepping", taken(provenance_cpu_field("stepping")), "mhz",
                     taken(provenance_cpu_field("cpu MHz")));
}

static json_t *environment_facts(const run_environment *e)
{
    json_t *facts = json_pack("{s:s}", "key", e->key);
    for (int i = 0; i < ENVIRONMENT_FACTS; i++)
        json_add_as(&facts, environment_names[i], json_text_or_null(e->fact[i]));
    return facts;
}

/* The machine among the nodes of its type; null if the environment names it already. */
static json_t *node(void)
{
    char machine[ENVIRONMENT_FACT_MAX];
    if (!environment_node_type())
        return json_null();
    environment_read_machine("", machine, sizeof machine);
    return json_text_or_null(machine);
}

json_t *run_facts(const study *s, const topology *machine, const run_environment *here, const char *id, long shard,
                  long shards)
{
    char *folder = strdup(s->path);
    bool dirty = false;
    char *commit = folder ? provenance_git_commit(dirname(folder), &dirty) : NULL;
    free(folder);
    json_t *disturbances = json_array();
    usage_disturbances(load_sample_s, add_disturbance, &disturbances);
    json_t *is_dirty = commit ? json_boolean(dirty) : json_null();
    json_t *run =
        json_pack("{s:s, s:o, s:o, s:o, s:n, s:i, s:i, s:o, s:o, s:o, s:o}", "id", id, "environment",
                  environment_facts(here), "node", node(), "started_utc", run_time(), "ended_utc", "shard", (int)shard,
                  "shards", (int)(shards > 1 ? shards : 1), "processor", processor_facts(), "topology",
                  certain(topology_summary(machine)), "load", load_average(), "steal_share", steal_share());
    json_t *program = json_pack(
        "{s:s, s:o, s:s, s:s, s:s#, s:o, s:o, s:o, s:o}", "version", CUVETTE_VERSION, "build_commit",
        json_text_or_null(build_commit()), "compiler", COMPILER, "flags", CUVETTE_COMPILER_FLAGS, "config",
        CUVETTE_COMPILER_FLAGS, (int)strcspn(CUVETTE_COMPILER_FLAGS, ":"), "kernel", taken(provenance_kernel()),
        "binding", taken(provenance_binding()), "libraries", libraries(), "disturbances", disturbances);
    json_t *texts = json_pack("{s:o, s:o, s:o, s:o}", "study_commit", taken(commit), "study_dirty", is_dirty,
                              "study_text", json_text_or_null(s->text), "scene_text", json_text_or_null(s->scene_text));
    if (s->quick)
        json_add_as(&run, "quick", json_true());
    if (json_object_update(run, program) != 0 || json_object_update(run, texts) != 0) {
        json_decref(run);
        run = NULL;
    }
    json_decref(program);
    json_decref(texts);
    return run;
}
