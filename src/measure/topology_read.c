/* A topology from the text of topology_discover.c. */
#include "base/grow.h"
#include "measure/topology_private.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

bool topology_add(topology *machine, int depth, char kind, int unit)
{
    if (!room_for_one(&machine->nodes, (size_t)machine->count, sizeof *machine->nodes))
        return false;
    machine->nodes[machine->count++] = (topology_node){.depth = depth, .kind = kind, .unit = unit};
    return true;
}

void topology_complete(topology *machine)
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

static bool take_line(topology *machine, const char *line)
{
    int depth, unit, level;
    char kind;
    int64_t bytes;
    if (sscanf(line, "node %d %c %d", &depth, &kind, &unit) == 3)
        return topology_add(machine, depth, kind, unit);
    if (sscanf(line, "cache %d %" SCNd64, &level, &bytes) == 2 && level >= 0 && level < TOPOLOGY_CACHES)
        machine->cache[level] = bytes;
    else if (strncmp(line, "model ", 6) == 0)
        snprintf(machine->model, sizeof machine->model, "%s", line + 6);
    else if (sscanf(line, "installed %d", &machine->installed) != 1)
        (void)!sscanf(line, "memory %" SCNd64, &machine->memory);
    return true;
}

status topology_read(topology *machine, char *text, diagnostic *why)
{
    bool has_unit = false;
    for (char *rest = text, *line; (line = strsep(&rest, "\n"));) {
        if (strcmp(line, "xml") == 0) {
            machine->xml = rest ? strdup(rest) : NULL;
            break;
        }
        if (!take_line(machine, line))
            return out_of_memory(why);
    }
    if (!machine->xml)
        return out_of_memory(why);
    topology_complete(machine);
    for (int i = 0; i < machine->count; i++)
        has_unit |= machine->nodes[i].kind == 'u';
    return has_unit ? STATUS_OK
                    : diagnose(why, STATUS_BAD_INPUT, "", "the description of the machine has no processing unit");
}
