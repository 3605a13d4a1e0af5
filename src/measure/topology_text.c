/* Texts of a topology: a one-line summary and hwloc XML. */
#include "measure/topology.h"
#include "measure/topology_private.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

typedef struct line {
    char text[512];
    size_t used;
} line;

static void append(line *to, const char *text)
{
    size_t length = strlen(text);
    if (to->used + length >= sizeof to->text)
        return;
    memcpy(to->text + to->used, text, length + 1);
    to->used += length;
}

static void append_count(line *to, int count, const char *noun)
{
    char part[64];
    snprintf(part, sizeof part, "%s%d %s%s", to->used > 0 ? ", " : "", count, noun, count == 1 ? "" : "s");
    append(to, part);
}

static void append_size(line *to, const char *name, uint64_t bytes)
{
    char part[64];
    bool large = bytes >= UINT64_C(10) << 20;
    snprintf(part, sizeof part, ", %s %" PRIu64 " %s", name, bytes >> (large ? 20 : 10), large ? "MiB" : "KiB");
    append(to, part);
}

static void append_caches(line *to, const topology *machine)
{
    static const char *const names[TOPOLOGY_CACHES] = {"L1d", "L2", "L3"};
    for (int i = 0; i < TOPOLOGY_CACHES; i++)
        if (machine->cache[i] > 0)
            append_size(to, names[i], (uint64_t)machine->cache[i]);
}

char *topology_summary(const topology *machine)
{
    line summary = {.used = 0};
    int units = topology_pu_count(machine);
    append_count(&summary, topology_package_count(machine), "package");
    append_count(&summary, topology_core_count(machine), "core");
    append_count(&summary, units, "thread");
    if (machine->installed > units) {
        char part[64];
        snprintf(part, sizeof part, " (of the machine's %d)", machine->installed);
        append(&summary, part);
    }
    append_caches(&summary, machine);
    if (machine->memory > 0)
        append_size(&summary, "memory", (uint64_t)machine->memory);
    if (machine->model[0]) {
        append(&summary, ", ");
        append(&summary, machine->model);
    }
    if (machine->assumed)
        append(&summary, ", cores and packages assumed (hwloc failed)");
    return strdup(summary.text);
}

char *topology_xml(const topology *machine)
{
    return strdup(machine->xml ? machine->xml : "");
}
