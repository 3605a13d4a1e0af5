/* Placement of threads on processing units through hwloc. */
#include "measure/topology.h"

#include "base/grow.h"
#include "measure/topology_private.h"

#include <errno.h>
#include <limits.h>
#include <sched.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static status no_room(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "", "out of memory for the topology of the machine");
}

static int units_of(hwloc_topology_t tree)
{
    return hwloc_get_nbobjs_by_type(tree, HWLOC_OBJ_PU);
}

/* Cores, or units if the machine does not report cores. */
static hwloc_obj_type_t core_type(hwloc_topology_t tree)
{
    return hwloc_get_nbobjs_by_type(tree, HWLOC_OBJ_CORE) > 0 ? HWLOC_OBJ_CORE : HWLOC_OBJ_PU;
}

/* Sets `set` to the r-th unit (from 0) of every core that has more than r units; to the empty set if no core has. */
static void units_of_round(hwloc_topology_t tree, int r, hwloc_bitmap_t set)
{
    hwloc_obj_type_t type = core_type(tree);
    hwloc_bitmap_zero(set);
    for (int i = 0; i < hwloc_get_nbobjs_by_type(tree, type); i++) {
        hwloc_obj_t core = hwloc_get_obj_by_type(tree, type, (unsigned)i);
        hwloc_obj_t pu = hwloc_get_obj_inside_cpuset_by_type(tree, core->cpuset, HWLOC_OBJ_PU, (unsigned)r);
        if (pu)
            hwloc_bitmap_set(set, pu->os_index);
    }
}

static int restrict_tree(hwloc_topology_t tree, hwloc_const_bitmap_t set)
{
    if (hwloc_topology_restrict(tree, set, 0) != 0)
        return -1;
    return hwloc_topology_refresh(tree); /* so that several threads may read the tree */
}

static void drop_rounds(topology *machine)
{
    for (int r = 0; r < machine->rounds; r++)
        hwloc_topology_destroy(machine->round[r]);
    free(machine->round);
    machine->round = NULL;
    machine->rounds = 0;
}

static bool add_round(topology *machine, hwloc_const_bitmap_t set)
{
    if (!room_for_one(&machine->round, (size_t)machine->rounds, sizeof *machine->round) ||
        hwloc_topology_dup(&machine->round[machine->rounds], machine->tree) != 0)
        return false;
    return restrict_tree(machine->round[machine->rounds++], set) == 0;
}

static bool make_rounds(topology *machine)
{
    drop_rounds(machine);
    hwloc_bitmap_t set = hwloc_bitmap_alloc();
    bool good = set != NULL;
    while (good) {
        units_of_round(machine->tree, machine->rounds, set);
        if (hwloc_bitmap_iszero(set))
            break;
        good = add_round(machine, set);
    }
    hwloc_bitmap_free(set);
    return good;
}

/* Removes private data: the tree's XML goes into published manifests, which describe the hardware but must not identify
 * its owner. */
static void forget_owner(hwloc_topology_t tree)
{
    static const char *const private_infos[] = {"HostName", "Serial", "UUID", "AssetTag"};
    hwloc_obj_t root = hwloc_get_root_obj(tree);
    for (unsigned i = 0; i < root->infos_count; i++)
        for (size_t p = 0; p < sizeof private_infos / sizeof private_infos[0]; p++)
            if (strstr(root->infos[i].name, private_infos[p]))
                root->infos[i].value[0] = '\0';
}

/* synthetic: NULL for this machine. */
static status load(topology *machine, const char *synthetic, diagnostic *why)
{
    if (hwloc_topology_init(&machine->tree) != 0) {
        machine->tree = NULL;
        return no_room(why);
    }
    if (synthetic && hwloc_topology_set_synthetic(machine->tree, synthetic) != 0)
        return diagnose(why, STATUS_BAD_INPUT, "use hwloc's synthetic format, such as \"pack:2 core:4 pu:2\"",
                        "'%s' is not a description of a machine", synthetic);
    if (hwloc_topology_load(machine->tree) != 0)
        return diagnose(why, STATUS_FAILURE, "", "hwloc cannot read the topology of the machine");
    machine->installed = hwloc_bitmap_weight(hwloc_topology_get_complete_cpuset(machine->tree));
    forget_owner(machine->tree);
    return STATUS_OK;
}

/* If the system does not report the process's binding, all units of the tree are used. */
static status respect_binding(topology *machine, diagnostic *why)
{
    hwloc_bitmap_t own = hwloc_bitmap_alloc();
    if (!own)
        return no_room(why);
    status result = STATUS_OK;
    if (hwloc_get_cpubind(machine->tree, own, HWLOC_CPUBIND_PROCESS) == 0 &&
        hwloc_bitmap_intersects(own, hwloc_topology_get_topology_cpuset(machine->tree)) &&
        restrict_tree(machine->tree, own) != 0)
        result = diagnose(why, STATUS_FAILURE, "", "hwloc cannot restrict the topology to the process's own units");
    hwloc_bitmap_free(own);
    return result;
}

static status create(const char *synthetic, topology **out, diagnostic *why)
{
    *out = NULL;
    topology *machine = calloc(1, sizeof *machine);
    if (!machine)
        return no_room(why);
    status result = load(machine, synthetic, why);
    if (result == STATUS_OK && !synthetic)
        result = respect_binding(machine, why);
    if (result == STATUS_OK && !make_rounds(machine))
        result = no_room(why);
    if (result != STATUS_OK) {
        topology_destroy(machine);
        return result;
    }
    *out = machine;
    return STATUS_OK;
}

status topology_create(topology **out, diagnostic *why)
{
    return create(NULL, out, why);
}

status topology_from_synthetic(const char *description, topology **out, diagnostic *why)
{
    return create(description, out, why);
}

status topology_restrict(topology *machine, const char *units, diagnostic *why)
{
    hwloc_bitmap_t set = hwloc_bitmap_alloc();
    if (!set)
        return no_room(why);
    status result = STATUS_OK;
    if (hwloc_bitmap_list_sscanf(set, units) != 0 ||
        !hwloc_bitmap_intersects(set, hwloc_topology_get_topology_cpuset(machine->tree)))
        result = diagnose(why, STATUS_BAD_INPUT, "give a list such as 0-3,8",
                          "'%s' contains no processing unit of this machine", units);
    else if (restrict_tree(machine->tree, set) != 0 || !make_rounds(machine))
        result = no_room(why);
    hwloc_bitmap_free(set);
    return result;
}

void topology_destroy(topology *machine)
{
    if (!machine)
        return;
    drop_rounds(machine);
    if (machine->tree)
        hwloc_topology_destroy(machine->tree);
    free(machine);
}

int topology_pu_count(const topology *machine)
{
    return units_of(machine->tree);
}

int topology_core_count(const topology *machine)
{
    return hwloc_get_nbobjs_by_type(machine->tree, core_type(machine->tree));
}

int topology_package_count(const topology *machine)
{
    int count = hwloc_get_nbobjs_by_type(machine->tree, HWLOC_OBJ_PACKAGE);
    return count > 0 ? count : 1;
}

static int unit_index(hwloc_topology_t tree, hwloc_const_bitmap_t within, int n)
{
    hwloc_obj_t pu = hwloc_get_obj_inside_cpuset_by_type(tree, within, HWLOC_OBJ_PU, (unsigned)n);
    return pu ? (int)pu->os_index : -1;
}

/* The unit of one worker among count <= units, distributed by hwloc_distrib over the whole tree. */
static int distribute(hwloc_topology_t tree, int worker, int count)
{
    hwloc_obj_t root = hwloc_get_root_obj(tree);
    hwloc_cpuset_t *part = calloc((size_t)count, sizeof *part);
    if (!part)
        return unit_index(tree, root->cpuset, worker);
    int unit = -1;
    if (hwloc_distrib(tree, &root, 1, part, (unsigned)count, INT_MAX, 0) == 0) {
        unit = unit_index(tree, part[worker], 0);
        for (int i = 0; i < count; i++)
            hwloc_bitmap_free(part[i]);
    }
    free(part);
    return unit;
}

int topology_place(const topology *machine, pin_policy policy, int worker, int count)
{
    int units = units_of(machine->tree);
    if (policy == PIN_NONE || worker < 0)
        return -1;
    if (count > units)
        count = units;
    worker %= units;
    if (policy == PIN_COMPACT)
        return unit_index(machine->tree, hwloc_topology_get_topology_cpuset(machine->tree), worker);

    /* hwloc_distrib weights subtrees by their number of units, so it may fill a package with two units per core before
     * it has used every core of a package with one unit per core. Therefore distribute over one unit per core first,
     * then over the second units. */
    for (int r = 0; r < machine->rounds; r++) {
        int room = units_of(machine->round[r]);
        if (worker < room)
            return distribute(machine->round[r], worker, count < room ? (count > worker ? count : worker + 1) : room);
        worker -= room;
        count -= room;
    }
    return -1;
}

status topology_bind_thread(const topology *machine, int pu, diagnostic *why)
{
    hwloc_const_bitmap_t own = hwloc_topology_get_topology_cpuset(machine->tree);
    if (pu >= 0 && !hwloc_bitmap_isset(own, (unsigned)pu))
        return diagnose(why, STATUS_BAD_INPUT, "`cuvette machine` lists the available units",
                        "this process may not use processing unit %d", pu);
    hwloc_bitmap_t set = hwloc_bitmap_dup(own);
    if (!set)
        return no_room(why);
    if (pu >= 0)
        hwloc_bitmap_only(set, (unsigned)pu);
    int failed = hwloc_set_cpubind(machine->tree, set, HWLOC_CPUBIND_THREAD);
    int reason = errno;
    hwloc_bitmap_free(set);
    if (failed) {
        char text[128];
        return diagnose(why, STATUS_FAILURE, "render with render.pin none",
                        "cannot bind a thread to processing unit %d: %s", pu, strerror_r(reason, text, sizeof text));
    }
    return STATUS_OK;
}

int topology_current_pu(void)
{
    return sched_getcpu();
}
