/* Reads the facts of a run's environment from the files of the system, and hashes them into its key. */
#include "study/rows/environment.h"
#include "base/hash.h"
#include "base/installed.h"
#include "base/os_process.h"
#include "base/status.h"
#include "measure/usage.h"
#include <errno.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const environment_names[ENVIRONMENT_FACTS] = {"machine",  "cpu_model", "microcode", "smt",
                                                          "governor", "limits",    "isa",       "build"};
/* Indices of the facts in environment_names. */
enum { MACHINE, CPU_MODEL, MICROCODE, SMT, GOVERNOR, LIMITS, ISA, BUILD };

/* Where facts are read from: the files of the system below a root. */
typedef struct source {
    const char *root;
    int error; /* errno of the first file that exists but could not be read */
} source;

static void note_error(source *from, int error)
{
    const bool absent = error == ENOENT || error == ENOTDIR || error == EACCES || error == EPERM || error == ENODEV ||
                        error == EINVAL || error == EOPNOTSUPP || error == ENXIO;
    from->error = from->error || absent ? from->error : error;
}

/* The rest of the first line that starts with prefix, without blanks and colon; "unknown", and false, if there is none
 * in the file. */
static bool read_line(source *from, const char *name, const char *prefix, char *text, size_t size)
{
    char path[512], line[1024];
    bool found = false;
    snprintf(path, sizeof path, "%s%s", from->root, name);
    FILE *file = fopen(path, "re");
    if (!file)
        note_error(from, errno);
    while (file && !found && fgets(line, sizeof line, file)) {
        if (strncmp(line, prefix, strlen(prefix)) != 0)
            continue;
        char *value = line + strlen(prefix);
        value += strspn(value, " \t:");
        value[strcspn(value, "\n")] = 0;
        found = value[0] != 0;
        if (found)
            snprintf(text, size, "%.*s", (int)size - 1, value);
    }
    if (file && ferror(file))
        note_error(from, errno);
    if (file)
        fclose(file);
    if (!found)
        snprintf(text, size, "unknown");
    return found;
}

static uint64_t hash_text(uint64_t hash, const char *text)
{
    return hash_bytes(hash, text, strlen(text) + 1);
}

/* The id itself must not be published: machine-id(5) recommends a keyed hash. */
static void read_machine(source *from, char *text, size_t size)
{
    char id[ENVIRONMENT_FACT_MAX];
    const char *name = getenv("CUVETTE_MACHINE");
    const bool known = read_line(from, "/etc/machine-id", "", id, sizeof id) ||
                       read_line(from, "/proc/sys/kernel/random/boot_id", "", id, sizeof id);
    const bool named = name && name[0];
    if (!known && !named) {
        snprintf(text, size, "unknown");
        return;
    }
    uint64_t hash = hash_text(hash_text(HASH_START, "cuvette machine"), known ? id : "");
    snprintf(text, size, "%016" PRIx64, hash_finish(named ? hash_text(hash, name) : hash));
}

int environment_read_machine(const char *root, char *text, size_t size)
{
    source from = {.root = root};
    read_machine(&from, text, size);
    return from.error;
}

void environment_of_node_type(const char *type, char *text, size_t size)
{
    const uint64_t hash = hash_text(hash_text(HASH_START, "cuvette node type"), type);
    snprintf(text, size, "%016" PRIx64, hash_finish(hash));
}

const char *environment_node_type(void)
{
    const char *type = getenv("CUVETTE_NODE_TYPE");
    return type && type[0] ? type : NULL;
}

/* The processing units that the process may use, as "0-3,8", or a hash of a long list; "" if it may use all. Also "" on
 * nodes of a declared type (CUVETTE_NODE_TYPE): they are alike, whichever units a scheduler assigns. */
static void read_mask(source *from, char *text, size_t size)
{
    char allowed[1000], all[1000];
    bool is_all =
        !read_line(from, "/proc/self/status", "Cpus_allowed_list", allowed, sizeof allowed) || environment_node_type();
    is_all |= !read_line(from, "/sys/devices/system/cpu/online", "", all, sizeof all) || strcmp(allowed, all) == 0;
    /* a process that is not restricted may use units that are offline now */
    is_all |= read_line(from, "/sys/devices/system/cpu/possible", "", all, sizeof all) && strcmp(allowed, all) == 0;
    text[0] = 0;
    if (!is_all && strlen(allowed) < size)
        snprintf(text, size, "%s", allowed);
    else if (!is_all)
        snprintf(text, size, "list %016" PRIx64, hash_finish(hash_text(HASH_START, allowed)));
}

/* The error of the first file that exists but could not be read. */
static status read_whole(const source *from, diagnostic *why)
{
    return from->error ? system_error(why, STATUS_FAILURE, NULL, "the environment of the run cannot be read",
                                      from->error, "run the command again")
                       : STATUS_OK;
}

status environment_read_units(char *text, size_t size, diagnostic *why)
{
    source from = {.root = ""};
    read_line(&from, "/proc/self/status", "Cpus_allowed_list", text, size);
    return read_whole(&from, why);
}

static void read_limits(source *from, char *text, size_t size)
{
    char cpu[48] = "max", memory[24] = "max", mask[64];
    control_group_limits limits;
    const int error = control_group_read(from->root, &limits);
    from->error = from->error ? from->error : error;
    if (limits.quota_us)
        snprintf(cpu, sizeof cpu, "%lld %lld", limits.quota_us, limits.period_us);
    if (limits.memory_bytes != UINT64_MAX)
        snprintf(memory, sizeof memory, "%" PRIu64, limits.memory_bytes);
    read_mask(from, mask, sizeof mask);
    snprintf(text, size, "cpu %s, memory %s, units %d%s%s", cpu, memory, os_usable_units(), mask[0] ? ": " : "", mask);
}

void environment_close(run_environment *e)
{
    uint64_t hash = HASH_START;
    for (int i = 0; i < ENVIRONMENT_FACTS; i++)
        hash = hash_text(hash, e->fact[i]);
    snprintf(e->key, sizeof e->key, "%08" PRIx32, (uint32_t)(hash_finish(hash) >> 32));
}

status environment_read(const char *root, isa level, run_environment *out, diagnostic *why)
{
    source system = {.root = root}, *from = &system;
    *out = (run_environment){.key = ""};
    if (environment_node_type())
        environment_of_node_type(environment_node_type(), out->fact[MACHINE], ENVIRONMENT_FACT_MAX);
    else
        read_machine(from, out->fact[MACHINE], ENVIRONMENT_FACT_MAX);
    if (!read_line(from, "/proc/cpuinfo", "model name", out->fact[CPU_MODEL], ENVIRONMENT_FACT_MAX)) /* ARM has none */
        read_line(from, "/proc/device-tree/model", "", out->fact[CPU_MODEL], ENVIRONMENT_FACT_MAX);
    read_line(from, "/proc/cpuinfo", "microcode", out->fact[MICROCODE], ENVIRONMENT_FACT_MAX);
    read_line(from, "/sys/devices/system/cpu/smt/active", "", out->fact[SMT], ENVIRONMENT_FACT_MAX);
    read_line(from, "/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "", out->fact[GOVERNOR],
              ENVIRONMENT_FACT_MAX);
    read_limits(from, out->fact[LIMITS], ENVIRONMENT_FACT_MAX);
    /* under valgrind, times are those of an emulated processor */
    snprintf(out->fact[ISA], ENVIRONMENT_FACT_MAX, "%s%s", isa_name(level),
             instruction_dumps_exist() ? ", counted by valgrind" : "");
    snprintf(out->fact[BUILD], ENVIRONMENT_FACT_MAX, "%s", build_id());
    environment_close(out);
    return read_whole(from, why);
}

bool environment_difference(const run_environment *a, const run_environment *b, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; i < ENVIRONMENT_FACTS && used + 1 < size; i++)
        if (strcmp(a->fact[i], b->fact[i]) != 0)
            used += (size_t)snprintf(text + used, size - used, "%s%s %.40s instead of %.40s", used ? ", " : "",
                                     environment_names[i], a->fact[i], b->fact[i]);
    return text[0] != 0;
}
