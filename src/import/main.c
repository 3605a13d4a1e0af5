/* The command line of cuvette-import, which reads one mesh file under resource limits that it sets itself, and writes
 * the triangles to standard output in the format of import/mesh_wire.h. It is a program of its own so that a file that
 * crashes it or exhausts its memory affects nothing else. Exit codes: 0, 1 (the machine failed), 2 (the file is wrong),
 * with one line on standard error. */
#include "import/plain.h"

#include "base/float_environment.h"
#include "base/json_build.h"
#include "base/number.h"
#include "base/os_process.h"
#include <argp.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

static error_t parse_option(int key, char *value, struct argp_state *state)
{
    request *req = state->input;
    uint64_t *number = key == 'm'   ? &req->memory_mib
                       : key == 's' ? &req->seconds
                       : key == 't' ? &req->triangles
                                    : &req->vertices;
    int64_t got;
    switch (key) {
    case 'r': req->root = value; return 0;
    case 'm':
    case 's':
    case 't':
    case 'v':
        if (!number_parse_int(value, &got) || got < 1)
            argp_error(state, "'%s' is not an integer of at least 1", value);
        *number = (uint64_t)got;
        return 0;
    case ARGP_KEY_ARG:
        if (req->path)
            argp_error(state, "unexpected argument '%s'", value);
        req->path = value;
        return 0;
    case ARGP_KEY_NO_ARGS: argp_error(state, "no file is given"); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option options[] = {
    {.name = "memory", .key = 'm', .arg = "MIB", .doc = "Limit of this process's address space (4096)"},
    {.name = "seconds", .key = 's', .arg = "N", .doc = "Limit of processor time (60)"},
    {.name = "triangles", .key = 't', .arg = "N", .doc = "Limit of triangles (33554432)"},
    {.name = "vertices", .key = 'v', .arg = "N", .doc = "Limit of vertices (67108864)"},
    {.name = "root",
     .key = 'r',
     .arg = "FOLDER",
     .doc = "Open only files below this folder, an absolute path without links"},
    {0},
};

/* Lowers a resource limit; never raises it. */
static void limit(__rlimit_resource_t what, rlim_t value)
{
    struct rlimit now;
    if (getrlimit(what, &now) == 0) {
        now.rlim_max = value < now.rlim_max ? value : now.rlim_max;
        now.rlim_cur = value < now.rlim_cur ? value : now.rlim_cur;
        setrlimit(what, &now);
    }
}

/* Confines the process: it can no longer create or change a file, open one outside the root, start a program, reach a
 * network, dump its memory, open many files, or outlive its parent. If the kernel lacks what os_confine.h needs, only
 * the resource limits apply. */
static void limit_all(const request *req)
{
    const confine_place readable = {req->root[0] ? req->root : "/", CONFINE_READ};

    os_die_with_parent();
    prctl(PR_SET_DUMPABLE, 0);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, 16);
    limit(RLIMIT_CPU, (rlim_t)req->seconds);
    limit(RLIMIT_AS, (rlim_t)req->memory_mib << 20);
    os_confine_files(&readable, 1);
    os_confine_calls(CONFINE_READING);
}

static status convert(const request *req, diagnostic *why)
{
    static flat_mesh flat;
    TRY(plain_read(req, &flat, why));
    return flat_write(&flat, stdout, why);
}

static int work(void *context)
{
    diagnostic why = {0};
    const status code = convert(context, &why);
    if (code != STATUS_OK) {
        char text[DIAGNOSTIC_TEXT_MAX];
        fprintf(stderr, "cuvette-import: %s\n", diagnostic_text(&why, text, sizeof text));
    }
    return (int)code;
}

int main(int count, char **arguments)
{
    static const struct argp parser = {
        .options = options,
        .parser = parse_option,
        .args_doc = "FILE",
        .doc = "Read a triangle mesh (OBJ, PLY, STL, glTF, glb) and write it to standard output, a pipe, in the wire "
               "format of the program cuvette, which starts this one.",
    };
    request req = {
        .memory_mib = 4096, .seconds = 60, .triangles = (uint64_t)1 << 25, .vertices = (uint64_t)1 << 26, .root = ""};
    float_environment_set();
    json_memory_reserve();
    argp_err_exit_status = STATUS_BAD_INPUT;
    argp_parse(&parser, count, arguments, 0, NULL, &req);
    req.kind = file_kind_of(req.path);
    limit_all(&req);
    _exit(os_call_with_stack(work, &req)); /* no destructors run: the scene may be damaged */
}
