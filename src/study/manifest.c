#include "study/manifest.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/text.h"
#include "measure/clock.h"
#include "measure/usage.h"
#include "study/grid.h"
#include "study/provenance.h"
#include "study/rows.h"
#include "scene/model/open.h"
#include <fcntl.h>
#include <hwloc.h>
#include <jpeglib.h>
#include <libgen.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>
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
    json_t *value = text ? json_string(text) : NULL;
    free(text);
    return value ? value : json_null();
}

static json_t *borrowed(const char *text)
{
    json_t *value = text ? json_string(text) : NULL;
    return value ? value : json_null();
}

/* The current time, or that of SOURCE_DATE_EPOCH (reproducible-builds.org/specs/source-date-epoch). */
static json_t *time_text(void)
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

static json_t *machine_facts(const topology *machine)
{
    char *xml = topology_xml(machine);
    provenance_anonymize(xml);
    return json_pack("{s:o, s:o, s:i, s:i, s:i, s:o, s:o}", "cpu_model", taken(provenance_cpu_model()), "topology",
                     taken(topology_summary(machine)), "packages", topology_package_count(machine), "cores",
                     topology_core_count(machine), "processing_units", topology_pu_count(machine), "clocks", clocks(),
                     "hwloc_xml", taken(xml));
}

static json_t *files_hash(const study *s)
{
    uint64_t hash = HASH_START;
    grid_hash_files(&hash, s->base);
    return facts_hash(hash);
}

static json_t *study_facts(const study *s)
{
    return json_pack("{s:s, s:o, s:o, s:o, s:I, s:o, s:o, s:o, s:o}", "name", s->name, "title", borrowed(s->title),
                     "definition", facts_hash(s->definition_hash), "files", files_hash(s), "cells",
                     (json_int_t)study_cell_count(s), "file", borrowed(file_name_of(s->path)), "text",
                     borrowed(s->text), "scene_file", borrowed(file_name_of(s->scene_path)), "scene_text",
                     borrowed(s->scene_text));
}

static void add_disturbance(void *list, const char *text)
{
    json_array_append_new(list, borrowed(text));
}

/* The properties of a run that may change between runs: repetitions, order, kept files. */
static json_t *run_facts(const study *s, const topology *machine, isa level, long shard, long shards)
{
    char *folder = strdup(s->path);
    bool dirty = false;
    char *commit = folder ? provenance_git_commit(dirname(folder), &dirty) : NULL;
    free(folder);
    json_t *disturbances = json_array();
    usage_disturbances(load_sample_s, add_disturbance, disturbances);
    json_t *is_dirty = commit ? json_boolean(dirty) : json_null();
    return json_pack(
        "{s:o, s:i, s:i, s:o, s:o, s:s, s:o, s:o, s:s, s:s, s:s#, s:s, s:o, s:o, s:o, s:o, s:o, s:o}", "started_utc",
        time_text(), "shard", (int)shard, "shards", (int)(shards > 1 ? shards : 1), "cpu_model",
        taken(provenance_cpu_model()), "topology", taken(topology_summary(machine)), "version", CUVETTE_VERSION,
        "git_commit", taken(commit), "git_dirty", is_dirty, "compiler", COMPILER, "flags", CUVETTE_COMPILER_FLAGS,
        "config", CUVETTE_COMPILER_FLAGS, (int)strcspn(CUVETTE_COMPILER_FLAGS, ":"), "isa", isa_name(level), "kernel",
        taken(provenance_kernel()), "governor", taken(provenance_governor()), "binding", taken(provenance_binding()),
        "libraries", libraries(), "disturbances", disturbances, "study_text", borrowed(s->text));
}

/* The existing manifest, or a new one. */
static status load(const study *s, const char *path, const topology *machine, json_t **out, diagnostic *why)
{
    *out = NULL;
    if (access(path, F_OK) == 0) {
        TRY(facts_read(path, scene_root(s->base), out, why));
        if (!json_is_array(json_object_get(*out, "runs"))) {
            json_decref(*out);
            return diagnose_at(why, path, STATUS_BAD_INPUT, "move it away: a new one will be written",
                               "the manifest is damaged");
        }
        return STATUS_OK;
    }
    *out = json_pack("{s:o, s:o, s:[]}", "study", study_facts(s), "machine", machine_facts(machine), "runs");
    return *out ? STATUS_OK : out_of_memory(why);
}

status manifest_write(const study *s, const char *folder, const topology *machine, isa level, long shard, long shards,
                      diagnostic *why)
{
    json_t *run = run_facts(s, machine, level, shard, shards), *manifest = NULL;
    char *path = text_format("%s/manifest.json", folder);
    status code = run && path ? STATUS_OK : out_of_memory(why);
    /* Locked, because shards may start at the same time, and each reads the list before it writes it. */
    int lock = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock >= 0)
        flock(lock, LOCK_EX);
    THEN(code, load(s, path, machine, &manifest, why));
    if (code == STATUS_OK) {
        json_array_append(json_object_get(manifest, "runs"), run);
        code = facts_write(manifest, JSON_REAL_PRECISION(6), path, why);
    }
    if (lock >= 0)
        close(lock);
    json_decref(manifest);
    json_decref(run);
    free(path);
    return code;
}
