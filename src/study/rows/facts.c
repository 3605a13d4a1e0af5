/* Collects facts of the machine, the program, the study and a run as JSON, and reads and writes files of facts. */
#include "study/rows/facts.h"
#include "base/file.h"
#include "base/installed.h"
#include "base/json_build.h"
#include "base/number.h"
#include "base/text.h"
#include "measure/clock.h"
#include "measure/usage.h"
#include "study/rows/rows.h"
#include <OpenEXR/openexr.h>
#include <fcntl.h>
#include <hwloc.h>
#include <inttypes.h>
#include <libgen.h>
#include <png.h>
#include <sched.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <yaml.h>
#include <jpeglib.h>

/* --- files of JSON values --- */

json_t *facts_hash(uint64_t value)
{
    return json_sprintf("%016" PRIx64, value);
}

bool facts_get_hash(const json_t *facts, const char *key, uint64_t *out)
{
    const char *text = json_string_value(json_object_get(facts, key));
    const bool is_hash = text && strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16;
    *out = is_hash ? strtoull(text, NULL, 16) : 0;
    return is_hash;
}

status facts_read(const char *path, const char *root, json_t **out, diagnostic *why)
{
    enum { FACTS_BYTES_MAX = 64 << 20 };
    char *text;
    size_t size;
    *out = NULL;
    TRY(file_read_below(path, root, FACTS_BYTES_MAX, &text, &size, why));
    json_error_t error;
    bool no_memory;
    *out = json_parse(text, size, 0, &error, &no_memory);
    free(text);
    if (!no_memory)
        return STATUS_OK;
    diagnostic_locate(why, path, 0, 0);
    return out_of_memory(why);
}

status facts_write(const json_t *facts, size_t flags, const char *path, diagnostic *why)
{
    /* jansson writes reals independently of the locale. */
    char *text = json_text(facts, JSON_INDENT(2) | flags), *line = text ? text_format("%s\n", text) : NULL;
    const status code = line ? file_write(path, line, why) : out_of_memory(why);
    free(line);
    free(text);
    return code;
}

/* --- machine and program --- */

extern char **environ;

/* In a file, the rest of the first line that starts with prefix, without blanks and colon; NULL if there is none. */
static char *line_of(const char *path, const char *prefix)
{
    FILE *file = fopen(path, "re");
    char line[1024], *found = NULL;
    while (file && !found && fgets(line, sizeof line, file)) {
        if (strncmp(line, prefix, strlen(prefix)) != 0)
            continue;
        char *value = line + strlen(prefix);
        value += strspn(value, " \t:");
        value[strcspn(value, "\n")] = 0;
        found = strdup(value);
    }
    if (file)
        fclose(file);
    return found;
}

static char *cpu_field(const char *name)
{
    return line_of("/proc/cpuinfo", name);
}

static char *cpu_model(void)
{
    char *name = cpu_field("model name");
    return name ? name : line_of("/proc/device-tree/model", "");
}

static char *kernel(void)
{
    struct utsname name;
    return uname(&name) == 0 ? text_format("%s %s %s", name.sysname, name.release, name.machine) : NULL;
}

static char *binding(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0)
        return NULL;
    char *text = NULL;
    text_writer writer;
    if (text_writer_open(&writer, NULL) != STATUS_OK)
        return NULL;
    bool later = false;
    for (size_t first = 0; first < CPU_SETSIZE; first++) {
        if (!CPU_ISSET(first, &set))
            continue;
        size_t last = first;
        while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &set))
            last++;
        fprintf(writer.stream, last > first ? "%s%zu-%zu" : "%s%zu", later ? "," : "", first, last);
        later = true;
        first = last;
    }
    text_writer_close(&writer, &text, NULL, NULL);
    return text;
}

/* The output of `git -C folder arguments`, at most size - 1 bytes; false if it fails. */
static bool run_git(const char *folder, const char *const *arguments, char *text, size_t size)
{
    const char *argv[12] = {"git", "--no-optional-locks", "-C", folder};
    for (size_t i = 0; arguments[i] && i < 7; i++)
        argv[i + 4] = arguments[i];
    int pipes[2];
    if (pipe2(pipes, O_CLOEXEC) != 0)
        return false;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    int failed = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    failed = failed ? failed : posix_spawn_file_actions_adddup2(&actions, pipes[1], 1);
    failed = failed ? failed : posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    pid_t child;
    failed = failed ? failed : posix_spawnp(&child, "git", &actions, NULL, (char *const *)(void *)argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(pipes[1]);
    size_t used = 0;
    char rest[512];
    for (ssize_t count; !failed && (count = read(pipes[0], rest, sizeof rest)) > 0;)
        for (ssize_t i = 0; i < count; i++)
            if (used + 1 < size)
                text[used++] = rest[i];
    text[used] = 0;
    close(pipes[0]);
    int exit_status = -1;
    return !failed && waitpid(child, &exit_status, 0) == child && WIFEXITED(exit_status) &&
           WEXITSTATUS(exit_status) == 0;
}

char *provenance_git_commit(const char *folder, bool *dirty)
{
    static const char *const head[] = {"rev-parse", "--verify", "--quiet", "HEAD", NULL};
    static const char *const changed[] = {"status", "--porcelain", "--untracked-files=no", NULL};
    char commit[128], changes[8];
    *dirty = false;
    if (!run_git(folder, head, commit, sizeof commit))
        return NULL;
    commit[strcspn(commit, "\n")] = 0;
    if (strspn(commit, "0123456789abcdef") != strlen(commit))
        return NULL;
    *dirty = run_git(folder, changed, changes, sizeof changes) && changes[0];
    return strdup(commit);
}

void provenance_anonymize(char *xml)
{
    static const char *const identifying[] = {"HostName", "Serial", "UUID",   "Address",
                                              "AssetTag", "Cgroup", "CGroup", "ProcessName"};
    if (!xml)
        return;
    char *write = xml;
    for (char *read = xml; *read;) {
        size_t line = strcspn(read, "\n");
        line += read[line] == '\n';
        char *name = strstr(read, "<info name=\"");
        bool drop = false;
        if (name && name < read + line) {
            name += strlen("<info name=\"");
            size_t length = strcspn(name, "\"");
            for (size_t i = 0; i < sizeof identifying / sizeof identifying[0]; i++)
                drop |= memmem(name, length, identifying[i], strlen(identifying[i])) != NULL;
        }
        if (!drop) {
            memmove(write, read, line);
            write += line;
        }
        read += line;
    }
    *write = 0;
}

/* --- JSON --- */

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

/* Frees text after its conversion; JSON null if it is NULL or not UTF-8. */
static json_t *owned_text(char *text)
{
    json_t *value = json_text_or_null(text);
    free(text);
    return value;
}

/* Like owned_text, for a text that is always known: NULL then means that memory ran out, and the result is NULL. */
static json_t *required_text(char *text)
{
    return text ? owned_text(text) : NULL;
}

/* The current time, or the time in SOURCE_DATE_EPOCH (reproducible-builds.org/specs/source-date-epoch). */
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

static json_t *openexr_version(void)
{
    int major, minor, patch;
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    return json_sprintf("%d.%d.%d", major, minor, patch);
}

static json_t *libraries(void)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:o}", "libpng", png_get_libpng_ver(NULL), "libjpeg-turbo",
                     TEXT_OF(LIBJPEG_TURBO_VERSION), "hwloc", HWLOC_VERSION, "libyaml", yaml_get_version_string(),
                     "jansson", jansson_version_str(), "OpenEXR", openexr_version());
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
    return json_pack("{s:o, s:o, s:i, s:i, s:i, s:o, s:o}", "cpu_model", owned_text(cpu_model()), "topology",
                     required_text(topology_summary(machine)), "packages", topology_package_count(machine), "cores",
                     topology_core_count(machine), "processing_units", topology_pu_count(machine), "clocks", clocks(),
                     "hwloc_xml", required_text(xml));
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

/* The fraction of time since boot that the hypervisor spent on other guests; null if unknown: proc(5), /proc/stat. */
static json_t *steal_fraction(void)
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
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "vendor", owned_text(cpu_field("vendor_id")), "family",
                     owned_text(cpu_field("cpu family")), "model", owned_text(cpu_field("model\t")), "stepping",
                     owned_text(cpu_field("stepping")), "mhz", owned_text(cpu_field("cpu MHz")));
}

static json_t *environment_facts(const run_environment *e)
{
    json_t *facts = json_pack("{s:s}", "key", e->key);
    for (int i = 0; i < ENVIRONMENT_FACTS; i++)
        json_add_as(&facts, environment_names[i], json_text_or_null(e->fact[i]));
    return facts;
}

/* The machine, if the environment names only the type of its node; otherwise null. */
static json_t *node(void)
{
    char machine[ENVIRONMENT_FACT_MAX];
    if (!environment_node_type())
        return json_null();
    environment_read_machine("", machine, sizeof machine);
    return json_text_or_null(machine);
}

json_t *run_facts(const study *s, const topology *machine, const run_environment *environment, const char *id,
                  long shard, long shards)
{
    char *folder = strdup(s->path);
    bool dirty = false;
    char *commit = folder ? provenance_git_commit(dirname(folder), &dirty) : NULL;
    free(folder);
    json_t *disturbances = json_array();
    disturbances_report(load_sample_s, add_disturbance, &disturbances);
    json_t *is_dirty = commit ? json_boolean(dirty) : json_null();
    json_t *run =
        json_pack("{s:s, s:o, s:o, s:o, s:n, s:i, s:i, s:o, s:o, s:o, s:o}", "id", id, "environment",
                  environment_facts(environment), "node", node(), "started_utc", run_time(), "ended_utc", "shard",
                  (int)shard, "shards", (int)(shards > 1 ? shards : 1), "processor", processor_facts(), "topology",
                  required_text(topology_summary(machine)), "load", load_average(), "steal_fraction", steal_fraction());
    json_t *program =
        json_pack("{s:s, s:o, s:s, s:s, s:s#, s:o, s:o, s:o, s:o}", "version", CUVETTE_VERSION, "build_commit",
                  json_text_or_null(build_commit()), "compiler", COMPILER, "flags", CUVETTE_COMPILER_FLAGS, "config",
                  CUVETTE_COMPILER_FLAGS, (int)strcspn(CUVETTE_COMPILER_FLAGS, ":"), "kernel", owned_text(kernel()),
                  "binding", owned_text(binding()), "libraries", libraries(), "disturbances", disturbances);
    json_t *texts = json_pack("{s:o, s:o, s:o, s:o}", "study_commit", owned_text(commit), "study_dirty", is_dirty,
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
