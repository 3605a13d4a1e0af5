/* Writes the topology of a machine as text; hwloc finds it in a child process. Lines: "node DEPTH KIND UNIT" for each
 * object of the tree, in preorder; "installed N"; "cache LEVEL BYTES"; "memory BYTES"; "model TEXT"; and "xml",
 * followed by hwloc's XML to the end. */
#include "measure/topology_private.h"

#include <errno.h>
#include <fcntl.h>
#include <hwloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- the child ---- */

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

/* If the system does not report the process's binding, all units of the tree are used. */
static bool respect_binding(hwloc_topology_t tree)
{
    hwloc_bitmap_t binding = hwloc_bitmap_alloc();
    bool good = binding != NULL;
    if (binding && hwloc_get_cpubind(tree, binding, HWLOC_CPUBIND_PROCESS) == 0 &&
        hwloc_bitmap_intersects(binding, hwloc_topology_get_topology_cpuset(tree)))
        good = hwloc_topology_restrict(tree, binding, 0) == 0;
    hwloc_bitmap_free(binding);
    return good;
}

static char kind_of(hwloc_obj_t object)
{
    return object->type == HWLOC_OBJ_PU        ? 'u'
           : object->type == HWLOC_OBJ_CORE    ? 'c'
           : object->type == HWLOC_OBJ_PACKAGE ? 'p'
                                               : 'o';
}

static void write_nodes(hwloc_obj_t object, int depth, FILE *out)
{
    const char kind = kind_of(object);
    fprintf(out, "node %d %c %d\n", depth, kind, kind == 'u' ? (int)object->os_index : -1);
    for (unsigned i = 0; i < object->arity; i++)
        write_nodes(object->children[i], depth + 1, out);
}

/* The first cache of each level; on a machine with different kinds of cores, the cache of the first core. */
static void write_caches(hwloc_topology_t tree, FILE *out)
{
    static const hwloc_obj_type_t levels[TOPOLOGY_CACHES] = {HWLOC_OBJ_L1CACHE, HWLOC_OBJ_L2CACHE, HWLOC_OBJ_L3CACHE};
    for (int i = 0; i < TOPOLOGY_CACHES; i++) {
        hwloc_obj_t cache = hwloc_get_obj_by_type(tree, levels[i], 0);
        if (cache)
            fprintf(out, "cache %d %lld\n", i, (long long)cache->attr->cache.size);
    }
}

static bool write_tree(hwloc_topology_t tree, FILE *out)
{
    hwloc_obj_t root = hwloc_get_root_obj(tree), package = hwloc_get_obj_by_type(tree, HWLOC_OBJ_PACKAGE, 0);
    const char *model = package ? hwloc_obj_get_info_by_name(package, "CPUModel") : NULL;
    char *xml = NULL;
    int length = 0;
    if (hwloc_topology_export_xmlbuffer(tree, &xml, &length, 0) != 0)
        return false;
    fprintf(out, "installed %d\n", hwloc_bitmap_weight(hwloc_topology_get_complete_cpuset(tree)));
    write_nodes(root, 0, out);
    write_caches(tree, out);
    fprintf(out, "memory %lld\n", (long long)root->total_memory);
    if (model)
        fprintf(out, "model %s\n", model);
    fprintf(out, "xml\n%s", xml);
    hwloc_free_xmlbuffer(tree, xml);
    return fflush(out) == 0 && !ferror(out);
}

static status describe(hwloc_topology_t tree, const char *synthetic, FILE *out)
{
    if (synthetic && hwloc_topology_set_synthetic(tree, synthetic) != 0)
        return errno == ENOMEM ? STATUS_FAILURE : STATUS_BAD_INPUT;
    if (hwloc_topology_load(tree) != 0 || (!synthetic && !respect_binding(tree)))
        return STATUS_FAILURE;
    forget_owner(tree);
    return write_tree(tree, out) ? STATUS_OK : STATUS_FAILURE;
}

int topology_discover(const char *synthetic, FILE *out)
{
    hwloc_topology_t tree;
    if (hwloc_topology_init(&tree) != 0)
        return STATUS_FAILURE;
    const int code = (int)describe(tree, synthetic, out);
    hwloc_topology_destroy(tree);
    return code;
}

/* Runs hwloc and ends the child. A crash of hwloc leaves no message and no core file; an alarm ends an endless loop. */
static void run_child(const char *synthetic, int pipe_end)
{
    enum { LIMIT_S = 20 };
    const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
    sigset_t none;
    sigemptyset(&none);
    signal(SIGALRM, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    alarm(LIMIT_S);
    if (nothing >= 0)
        dup2(nothing, STDERR_FILENO);
    FILE *out = fdopen(pipe_end, "w");
    _exit(out ? topology_discover(synthetic, out) : STATUS_FAILURE);
}

/* ---- the parent ---- */

/* All text of the pipe; NULL: out of memory, or the pipe failed. */
static char *read_all(int fd, bool *no_memory)
{
    size_t room = 4096, used = 0;
    char *text = malloc(room);
    while (text) {
        const ssize_t got = read(fd, text + used, room - used - 1);
        if (got < 0 && errno == EINTR)
            continue;
        if (got == 0) {
            text[used] = '\0';
            return text;
        }
        if (got < 0)
            break;
        used += (size_t)got;
        if (used + 1 < room)
            continue;
        room *= 2;
        char *larger = realloc(text, room);
        if (!larger)
            break;
        text = larger;
    }
    *no_memory = !text || used + 1 >= room;
    free(text);
    return NULL;
}

/* The exit status; 0 if a handler of the caller has already reaped the child: the text shows whether it is complete. */
static int reap(pid_t child)
{
    int state;
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return errno == ECHILD ? STATUS_OK : STATUS_FAILURE;
    return WIFEXITED(state) ? WEXITSTATUS(state) : STATUS_FAILURE;
}

char *topology_discover_in_child(const char *synthetic, status *code, bool *no_memory)
{
    int ends[2];
    *no_memory = false;
    *code = STATUS_FAILURE;
    if (pipe2(ends, O_CLOEXEC) != 0)
        return NULL;
    const pid_t child = fork();
    if (child == 0)
        run_child(synthetic, ends[1]);
    close(ends[1]);
    char *text = child > 0 ? read_all(ends[0], no_memory) : NULL;
    close(ends[0]);
    const int exit_code = child > 0 ? reap(child) : STATUS_FAILURE;
    if (text && exit_code == STATUS_OK) {
        *code = STATUS_OK;
        return text;
    }
    *code = exit_code == STATUS_BAD_INPUT ? STATUS_BAD_INPUT : STATUS_FAILURE;
    free(text);
    return NULL;
}
