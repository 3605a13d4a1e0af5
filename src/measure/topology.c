/* A topology: its tree, read from the text of topology_discover.c; counts, placement and binding of threads, texts. */
#include "measure/topology.h"

#include "base/array.h"
#include "measure/topology_private.h"
#include <errno.h>
#include <inttypes.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- the tree ---- */

static bool add_node(topology *machine, int depth, char kind, int unit)
{
    if (!room_for_one(&machine->nodes, (size_t)machine->count, sizeof *machine->nodes))
        return false;
    machine->nodes[machine->count++] = (topology_node){.depth = depth, .kind = kind, .unit = unit};
    return true;
}

/* Computes end and round of every node after the last add_node. */
static void complete_tree(topology *machine)
{
    int core = -1, in_core = 0; /* the core that the walk is in, and the units seen in it */
    for (int i = 0; i < machine->count; i++) {
        topology_node *n = &machine->nodes[i];
        n->end = i + 1;
        while (n->end < machine->count && machine->nodes[n->end].depth > n->depth)
            n->end++;
        if (n->kind == 'c') {
            core = i;
            in_core = 0;
        }
        if (n->kind == 'u')
            n->round = core >= 0 && i < machine->nodes[core].end ? in_core++ : 0;
    }
}

static int count_kind(const topology *machine, char kind)
{
    int count = 0;
    for (int i = 0; i < machine->count; i++)
        count += machine->nodes[i].kind == kind;
    return count;
}

enum { ANY_ROUND = -1 };

static bool is_unit(const topology_node *node, int round)
{
    return node->kind == 'u' && (round == ANY_ROUND || node->round == round);
}

/* The number of units of a round below a node. */
static int weight(const topology *machine, int node, int round)
{
    int units = 0;
    for (int i = node; i < machine->nodes[node].end; i++)
        units += is_unit(&machine->nodes[i], round);
    return units;
}

/* The OS index of the n-th unit of a round below a node; -1: none. */
static int unit_below(const topology *machine, int node, int round, int n)
{
    for (int i = node; i < machine->nodes[node].end; i++)
        if (is_unit(&machine->nodes[i], round) && n-- == 0)
            return machine->nodes[i].unit;
    return -1;
}

/* Drops the units that are not in the set, and nodes without units. False, without a change, if none remains. */
static bool keep_units(topology *machine, const cpu_set_t *set, size_t size)
{
    int kept = 0, units = 0;
    for (int i = 0; i < machine->count; i++)
        units += machine->nodes[i].kind == 'u' && CPU_ISSET_S((size_t)machine->nodes[i].unit, size, set);
    if (units == 0)
        return false;
    for (int i = 0; i < machine->count; i++) {
        bool wanted = false;
        for (int j = i; j < machine->nodes[i].end && !wanted; j++)
            wanted = machine->nodes[j].kind == 'u' && CPU_ISSET_S((size_t)machine->nodes[j].unit, size, set);
        if (wanted)
            machine->nodes[kept++] = machine->nodes[i];
    }
    machine->count = kept;
    complete_tree(machine);
    return true;
}

/* ---- reading ---- */

static bool read_line(topology *machine, const char *line)
{
    int depth, unit, level;
    char kind;
    int64_t bytes;
    if (sscanf(line, "node %d %c %d", &depth, &kind, &unit) == 3)
        return add_node(machine, depth, kind, unit);
    if (sscanf(line, "cache %d %" SCNd64, &level, &bytes) == 2 && level >= 0 && level < TOPOLOGY_CACHES)
        machine->cache[level] = bytes;
    else if (strncmp(line, "model ", 6) == 0)
        snprintf(machine->model, sizeof machine->model, "%s", line + 6);
    else if (sscanf(line, "installed %d", &machine->installed) != 1)
        (void)!sscanf(line, "memory %" SCNd64, &machine->memory);
    return true;
}

/* Fills an empty topology from the text of topology_discover.c. STATUS_BAD_INPUT: it is truncated or damaged. */
static status read_tree(topology *machine, char *text, diagnostic *why)
{
    bool has_unit = false;
    for (char *rest = text, *line; (line = strsep(&rest, "\n"));) {
        if (strcmp(line, "xml") == 0) {
            machine->xml = rest ? strdup(rest) : NULL;
            break;
        }
        if (!read_line(machine, line))
            return out_of_memory(why);
    }
    if (!machine->xml)
        return out_of_memory(why);
    complete_tree(machine);
    for (int i = 0; i < machine->count; i++)
        has_unit |= machine->nodes[i].kind == 'u';
    return has_unit ? STATUS_OK
                    : diagnose(why, STATUS_BAD_INPUT, "", "the description of the machine has no processing unit");
}

/* ---- creation ---- */

enum { UNITS_MAX = 1 << 16 };

static status no_room(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "close other programs", "out of memory for the topology of the machine");
}

/* hwloc failed: each unit that this process may use counts as a core, and all as one package. */
static status assume(topology *machine, diagnostic *why)
{
    const size_t size = CPU_ALLOC_SIZE(UNITS_MAX);
    cpu_set_t *usable = CPU_ALLOC(UNITS_MAX);
    const bool known = usable && sched_getaffinity(0, size, usable) == 0;
    bool good = add_node(machine, 0, 'p', -1);
    for (int i = 0; good && i < UNITS_MAX; i++)
        if (known ? CPU_ISSET_S((size_t)i, size, usable) : i == 0)
            good = add_node(machine, 1, 'c', -1) && add_node(machine, 2, 'u', i);
    CPU_FREE(usable);
    const long installed = sysconf(_SC_NPROCESSORS_CONF);
    machine->installed = installed > 0 && installed < UNITS_MAX ? (int)installed : 1;
    machine->assumed = true;
    complete_tree(machine);
    return good ? STATUS_OK : no_room(why);
}

static status fill(topology *machine, const char *synthetic, diagnostic *why)
{
    status code;
    bool no_memory;
    char *text = topology_discover_in_child(synthetic, &code, &no_memory);
    if (text) {
        code = read_tree(machine, text, why);
        free(text);
        return code;
    }
    if (no_memory)
        return no_room(why);
    if (!synthetic)
        return assume(machine, why);
    return code == STATUS_BAD_INPUT
               ? diagnose(why, code, "use hwloc's synthetic format, such as \"pack:2 core:4 pu:2\"",
                          "'%s' is not a description of a machine", synthetic)
               : no_room(why);
}

static status create(const char *synthetic, topology **out, diagnostic *why)
{
    *out = NULL;
    topology *machine = calloc(1, sizeof *machine);
    if (!machine)
        return no_room(why);
    machine->described = synthetic != NULL;
    const status code = fill(machine, synthetic, why);
    if (code == STATUS_OK)
        *out = machine;
    else
        topology_destroy(machine);
    return code;
}

status topology_create(topology **out, diagnostic *why)
{
    return create(NULL, out, why);
}

status topology_from_synthetic(const char *description, topology **out, diagnostic *why)
{
    return create(description, out, why);
}

void topology_destroy(topology *machine)
{
    if (!machine)
        return;
    free(machine->nodes);
    free(machine->xml);
    free(machine);
}

/* Reads a list such as "0-3,8" into the set; false if it is none. */
static bool read_units(const char *list, cpu_set_t *set, size_t size)
{
    do {
        char *end;
        const long first = strtol(list, &end, 10);
        long last = first;
        if (end == list || first < 0)
            return false;
        if (*end == '-') {
            list = end + 1;
            last = strtol(list, &end, 10);
            if (end == list)
                return false;
        }
        for (long i = first; i <= last && i < UNITS_MAX; i++)
            CPU_SET_S((size_t)i, size, set);
        list = *end == ',' ? end + 1 : end;
    } while (*list >= '0' && *list <= '9');
    return *list == '\0';
}

status topology_restrict(topology *machine, const char *units, diagnostic *why)
{
    const size_t size = CPU_ALLOC_SIZE(UNITS_MAX);
    cpu_set_t *set = CPU_ALLOC(UNITS_MAX);
    if (!set)
        return no_room(why);
    CPU_ZERO_S(size, set);
    const bool good = read_units(units, set, size) && keep_units(machine, set, size);
    CPU_FREE(set);
    return good ? STATUS_OK
                : diagnose(why, STATUS_BAD_INPUT, "give a list such as 0-3,8",
                           "'%s' contains no processing unit of this machine", units);
}

/* ---- counts ---- */

int topology_pu_count(const topology *machine)
{
    return count_kind(machine, 'u');
}

/* Cores, or units if the machine does not report cores. */
int topology_core_count(const topology *machine)
{
    const int cores = count_kind(machine, 'c');
    return cores > 0 ? cores : topology_pu_count(machine);
}

int topology_package_count(const topology *machine)
{
    const int packages = count_kind(machine, 'p');
    return packages > 0 ? packages : 1;
}

/* ---- placement ---- */

/* The unit of one worker among count <= units of the round, as hwloc_distrib of hwloc 2.9 divides them: each subtree
 * gets workers in proportion to its units, rounded up as long as they last. */
static int distribute(const topology *machine, int round, int worker, int count)
{
    int node = 0;
    while (count > 1 && machine->nodes[node].end > node + 1) {
        const int total = weight(machine, node, round), end = machine->nodes[node].end;
        int before = 0, chosen = -1, chunk = 0;
        for (int child = node + 1; child < end && chosen < 0; child = machine->nodes[child].end) {
            const int units = weight(machine, child, round);
            chunk = ((before + units) * count + total - 1) / total - (before * count + total - 1) / total;
            before += units;
            if (worker < chunk)
                chosen = child;
            else
                worker -= chunk;
        }
        if (chosen < 0)
            break;
        node = chosen;
        count = chunk;
    }
    return unit_below(machine, node, round, count > 1 ? worker : 0);
}

int topology_place(const topology *machine, pin_policy policy, int worker, int count)
{
    const int units = topology_pu_count(machine);
    if (policy == PIN_NONE || worker < 0)
        return -1;
    if (count > units)
        count = units;
    worker %= units;
    if (policy == PIN_COMPACT)
        return unit_below(machine, 0, ANY_ROUND, worker);

    /* `distribute` weighs subtrees by their numbers of units: it could fill a package with two units per core before it
     * uses every core of a package with one unit per core. Therefore the first units of all cores come first. */
    for (int r = 0, room; (room = weight(machine, 0, r)) > 0; r++) {
        if (worker < room)
            return distribute(machine, r, worker, count < room ? (count > worker ? count : worker + 1) : room);
        worker -= room;
        count -= room;
    }
    return -1;
}

/* ---- binding ---- */

/* Adds a unit of the topology, or all of them for -1, to the set; false if there is none. */
static bool add_units(const topology *machine, int unit, cpu_set_t *set, size_t size)
{
    bool found = false;
    for (int i = 0; i < machine->count; i++) {
        const topology_node *n = &machine->nodes[i];
        if (n->kind != 'u' || (unit >= 0 && n->unit != unit) || n->unit < 0 || n->unit >= UNITS_MAX)
            continue;
        CPU_SET_S((size_t)n->unit, size, set);
        found = true;
    }
    return found;
}

status topology_bind_thread(const topology *machine, int pu, diagnostic *why)
{
    cpu_set_t set[UNITS_MAX / CPU_SETSIZE]; /* 8 KiB on the stack, because a worker cannot report that memory ran out */
    memset(set, 0, sizeof set);
    const bool found = add_units(machine, pu, set, sizeof set);
    const int failed = found && !machine->described ? sched_setaffinity(0, sizeof set, set) : 0, reason = errno;
    if (!found && pu >= 0)
        return diagnose(why, STATUS_BAD_INPUT, "use one of the units that `cuvette machine` lists",
                        "this process may not use processing unit %d", pu);
    if (pu < 0 && (!found || failed))
        return diagnose(why, STATUS_FAILURE, "start the program again",
                        "cannot allow a thread all processing units of the process: %s",
                        found ? strerrordesc_np(reason) : "none is known");
    if (failed)
        return diagnose(why, STATUS_FAILURE, "set render.pin=none", "cannot bind a thread to processing unit %d: %s",
                        pu, strerrordesc_np(reason));
    return STATUS_OK;
}

int topology_current_pu(void)
{
    return sched_getcpu();
}

/* ---- texts ---- */

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
