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

/* The first cache of each level; on a machine with different kinds of cores, that of the first core. */
static void append_caches(line *to, hwloc_topology_t tree)
{
    static const struct {
        hwloc_obj_type_t type;
        const char *name;
    } levels[] = {{HWLOC_OBJ_L1CACHE, "L1d"}, {HWLOC_OBJ_L2CACHE, "L2"}, {HWLOC_OBJ_L3CACHE, "L3"}};
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++) {
        hwloc_obj_t cache = hwloc_get_obj_by_type(tree, levels[i].type, 0);
        if (cache && cache->attr->cache.size > 0)
            append_size(to, levels[i].name, cache->attr->cache.size);
    }
}

char *topology_summary(const topology *machine)
{
    line summary = {.used = 0};
    hwloc_obj_t root = hwloc_get_root_obj(machine->tree);
    int units = topology_pu_count(machine);
    append_count(&summary, topology_package_count(machine), "package");
    append_count(&summary, topology_core_count(machine), "core");
    append_count(&summary, units, "thread");
    if (machine->installed > units) {
        char part[64];
        snprintf(part, sizeof part, " (of the machine's %d)", machine->installed);
        append(&summary, part);
    }
    append_caches(&summary, machine->tree);
    if (root->total_memory > 0)
        append_size(&summary, "memory", root->total_memory);
    hwloc_obj_t package = hwloc_get_obj_by_type(machine->tree, HWLOC_OBJ_PACKAGE, 0);
    const char *model = package ? hwloc_obj_get_info_by_name(package, "CPUModel") : NULL;
    if (model && *model) {
        append(&summary, ", ");
        append(&summary, model);
    }
    return strdup(summary.text);
}

char *topology_xml(const topology *machine)
{
    char *buffer = NULL;
    int length = 0;
    if (hwloc_topology_export_xmlbuffer(machine->tree, &buffer, &length, 0) != 0)
        return NULL;
    char *copy = strdup(buffer);
    hwloc_free_xmlbuffer(machine->tree, buffer);
    return copy;
}
