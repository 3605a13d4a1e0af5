/* Tests of hostile mesh files: each is refused with one line of error, in bounded time and memory, and leaves no
 * process, descriptor or file behind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "bad_mesh.h"
#include "mesh_files.h"
#include "scene/assets/mesh_stream.h"
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <zlib.h>

static const mesh_limits limits = {
    .triangles = 1000000, .vertices = 1000000, .memory_bytes = (uint64_t)1 << 30, .wall_s = 600};
static int refusals;
static double longest_s;
static char slowest[64];

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void refuse_within(const char *name, const mesh_limits *within, const char *pattern)
{
    char *path = in_folder(name), text[DIAGNOSTIC_TEXT_MAX];
    mesh_import *got = (mesh_import *)&got;
    diagnostic why = {.what = ""};
    double start = now_s();
    status code = mesh_read_file(path, within, &got, &why);
    double took_s = now_s() - start;
    diagnostic_text(&why, text, sizeof text);
    if (getenv("SHOW"))
        fprintf(stderr, "%.3f s %d %s\n", took_s, (int)code, text);
    if (code != STATUS_BAD_INPUT || got || !why.what[0] || strchr(text, '\n') ||
        strncmp(why.file, path, strlen(path)) != 0 || !strstr(text, pattern))
        fail_msg("%s: status %d, '%s'", name, (int)code, text);
    if (took_s > longest_s) {
        longest_s = took_s;
        snprintf(slowest, sizeof slowest, "%s", name);
    }
    refusals++;
    free(path);
}

static void refuse(const char *name)
{
    refuse_within(name, &limits, "");
}

static void refuse_bytes(const char *name, bytes b, const char *pattern)
{
    put(name, b.at, b.size);
    free(b.at);
    refuse_within(name, &limits, pattern);
}

static void small_invalid_files_are_refused(void **state)
{
    (void)state;
    char *path = in_folder("folder"), *fifo = in_folder("fifo");
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(mkfifo(fifo, 0666), 0);
    free(path);
    free(fifo);
    for (size_t i = 0; i < sizeof companions / sizeof *companions; i++)
        put_text(companions[i].name, companions[i].text);
    for (size_t i = 0; i < sizeof bad_meshes / sizeof *bad_meshes; i++) {
        put_text(bad_meshes[i].name, bad_meshes[i].text);
        refuse(bad_meshes[i].name);
    }
}

static void tolerated_files_give_a_valid_mesh(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof tolerated_meshes / sizeof *tolerated_meshes; i++) {
        put_text(tolerated_meshes[i].name, tolerated_meshes[i].text);
        char *path = in_folder(tolerated_meshes[i].name);
        mesh_import *got;
        assert_int_equal(mesh_read_file(path, &limits, &got, NULL), STATUS_OK);
        assert_int_equal(got->mesh->triangle_count, 1);
        assert_non_null(strstr(got->note, "nowhere"));
        mesh_import_destroy(got);
        free(path);
    }
}

/* Truncated anywhere, a binary file is shorter than its header states. */
static void truncated_binary_files_are_refused(void **state)
{
    (void)state;
    struct {
        const char *name;
        bytes whole;
    } files[] = {
        {"cut.stl", binary_stl()},
        {"cut.ply", binary_ply()},
        {"cut.glb", tetrahedron_glb("{\"mesh\":0}")},
    };
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        size_t step = files[f].whole.size / 25 + 1;
        for (size_t size = 1; size < files[f].whole.size; size += step) {
            put(files[f].name, files[f].whole.at, size);
            refuse(files[f].name);
        }
        put(files[f].name, files[f].whole.at, files[f].whole.size - 1);
        refuse(files[f].name);
        free(files[f].whole.at);
    }
}

static void noise_is_refused_in_every_format(void **state)
{
    (void)state;
    static const char *const names[] = {"noise.obj", "noise.ply", "noise.stl", "noise.gltf", "noise.glb"};
    uint64_t random = 1;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        for (int sort = 0; sort < 3; sort++) { /* any bytes; zeros; the start of a PNG followed by any bytes */
            unsigned char noise[4000];
            for (size_t k = 0; k < sizeof noise; k++) {
                random = random * 6364136223846793005u + 1442695040888963407u;
                noise[k] = sort == 1 ? 0 : (unsigned char)(random >> 56);
            }
            if (sort == 2)
                memcpy(noise, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
            put(names[i], noise, sizeof noise);
            refuse(names[i]);
        }
    }
}

static void an_stl_with_a_wrong_facet_count_is_refused(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 5, 1000000, 1000000000, 0x80000000u, 0xffffffffu};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        bytes b = binary_stl();
        memcpy(b.at + 80, &counts[i], 4);
        refuse_bytes("count.stl", b, "");
    }
    bytes b = binary_stl();
    memcpy(b.at + 84 + 12, "\0\0\xc0\x7f", 4); /* NaN */
    refuse_bytes("nan_binary.stl", b, "nan");
}

static void a_ply_with_invalid_lists_is_refused(void **state)
{
    (void)state;
    static const unsigned char lengths[] = {0, 1, 2, 255};
    for (size_t i = 0; i < sizeof lengths; i++) {
        bytes b = binary_ply();
        b.at[b.size - 13 * 4] = lengths[i];
        refuse_bytes("list.ply", b, "");
    }
    bytes b = binary_ply();
    memcpy(b.at + b.size - 4, "\xff\xff\xff\x7f", 4);
    refuse_bytes("index_binary.ply", b, "face 4 refers to vertex 2147483647");
    b = (bytes){0};
    add_text(
        &b,
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uint int vertex_indices\nend_header\n");
    add(&b, corners, 12);
    add_u32(&b, 0xffffffffu);
    add(&b, corners, 48);
    refuse_bytes("list_of_4_billion.ply", b, "face 1 refers to vertex 1036831949");
}

static void a_glb_with_wrong_lengths_is_refused(void **state)
{
    (void)state;
    static const struct {
        size_t at;
        uint32_t value;
    } changes[] = {
        {0, 0x12345678}, {4, 3}, {4, 0xffffffff}, {12, 0xffffffff}, {12, 0x7ffffff0}, {12, 0}, {16, 0x004e4942},
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        bytes b = tetrahedron_glb("{\"mesh\":0}");
        memcpy(b.at + changes[i].at, &changes[i].value, 4);
        refuse_bytes("lengths.glb", b, "");
    }
}

static void a_gltf_file_under_the_other_ending_is_refused(void **state)
{
    (void)state;
    refuse_bytes("binary.gltf", tetrahedron_glb("{\"mesh\":0}"), "this is a binary glTF file");
    refuse_within("json.glb", &limits, "begins with 'glTF'");
}

/* --- what is no text of the kind, compressed or not --- */

/* The bytes as gzip compresses them. */
static bytes gzipped(bytes plain)
{
    enum { GZIP = 16 + MAX_WBITS };
    z_stream z = {.next_in = plain.at, .avail_in = (uInt)plain.size};
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, GZIP, 8, Z_DEFAULT_STRATEGY), Z_OK);
    bytes b = {0};
    b.room = deflateBound(&z, (uLong)plain.size);
    b.at = malloc(b.room);
    assert_non_null(b.at);
    z.next_out = b.at;
    z.avail_out = (uInt)b.room;
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    b.size = z.total_out;
    deflateEnd(&z);
    free(plain.at);
    return b;
}

/* Many times the same bytes: compressed, they are a thousandth. */
static bytes much(const void *unit, size_t length, size_t size)
{
    bytes b = {0};
    b.room = b.size = size;
    b.at = malloc(size);
    assert_non_null(b.at);
    for (size_t i = 0; i < size; i++)
        b.at[i] = ((const unsigned char *)unit)[i % length];
    return b;
}

static void what_is_no_mesh_is_refused_at_its_first_bytes(void **state)
{
    (void)state;
    static const struct {
        const char *name, *unit;
        size_t length;
        const char *pattern;
    } cases[] = {
        {"zeros.obj", "\0", 1, "this is not an OBJ file: it has bytes that no text has"},
        {"png.obj", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16, "this is not an OBJ file"},
        {"zeros.ply", "\0", 1, "begins with the line 'ply'"},
        {"zeros.stl", "\0", 1, "byte 80: the header counts 0 facets, but the file has"},
        {"zeros.gltf", "\0", 1, "does not begin with '{'"},
        {"zeros.glb", "\0", 1, "begins with 'glTF'"},
        {"marked.obj", "\xff\xfev\0 \0", 6, "the text is UTF-16; save it as UTF-8"},
        {"marked.ply", "\xfe\xff\0p\0l\0y", 8, "the text is UTF-16; save it as UTF-8"},
        {"unmarked.obj", "v\0 \0", 4, "the text is UTF-16; save it as UTF-8"},
        {"unmarked.gltf", "\0{\0\n", 4, "the text is UTF-16; save it as UTF-8"},
        {"marked.stl", "\xff\xfes\0o\0l\0i\0d\0\n", 14, "the text is UTF-16; save it as UTF-8"},
    };
    mesh_limits small = limits;
    small.memory_bytes = (uint64_t)64 << 20;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bytes plain = much(cases[i].unit, cases[i].length, 100000), large;
        char name[64];
        snprintf(name, sizeof name, "%s.gz", cases[i].name);
        refuse_bytes(cases[i].name, plain, cases[i].pattern);
        if (strstr(name, "marked.stl"))
            continue; /* known only with the size of the file */
        large = gzipped(much(cases[i].unit, cases[i].length, (size_t)30 << 20));
        put(name, large.at, large.size);
        free(large.at);
        refuse_within(name, &small, cases[i].pattern);
    }
    bytes twice = gzipped(gzipped(much(THREE "f 1 2 3\n", strlen(THREE "f 1 2 3\n"), 1000)));
    refuse_bytes("twice.obj.gz", twice, "the file is compressed twice; expand it once");
    put("zeros.mtl", "newmtl a\nKd\0 1", 15);
    put_text("library.obj", "mtllib zeros.mtl\n" THREE "f 1 2 3\n");
    refuse_within("library.obj", &limits, "needs the file 'zeros.mtl': this is not an MTL file");
}

/* A quarter of 64 MiB is 16.8 MB. Short of it, repeated text is refused after 67.1 MB. */
static void what_expands_too_far_is_refused(void **state)
{
    (void)state;
    mesh_limits small = limits;
    small.memory_bytes = (uint64_t)64 << 20;
    bytes b = gzipped(much("v 0 0 0\n", 8, (size_t)17 << 20));
    put("bomb.obj.gz", b.at, b.size);
    free(b.at);
    refuse_within("bomb.obj.gz", &small,
                  "MB expand to more than 17 MB, a quarter of the memory that reading it may take; "
                  "raise --memory-limit");
    refuse_bytes("repeated.obj.gz", gzipped(much("v 0 0 0\n", 8, (size_t)128 << 20)),
                 "over 100 times as much, as no mesh does; if it is a mesh all the same, expand it first");
}

static bytes repeat(const char *before, const char *unit, const char *between, size_t count, const char *after)
{
    bytes b = {0};
    add_text(&b, before);
    size_t start = b.size, length = strlen(unit) + strlen(between);
    b.room = b.size + length * count;
    b.at = realloc(b.at, b.room);
    assert_non_null(b.at);
    for (size_t i = 0; i < count; i++) {
        memcpy(b.at + start + i * length, unit, strlen(unit));
        memcpy(b.at + start + i * length + strlen(unit), between, strlen(between));
    }
    b.size += length * count - strlen(between);
    add_text(&b, after);
    return b;
}

static void deep_nesting_is_refused(void **state)
{
    (void)state;
    refuse_bytes("deep_lists.gltf", repeat("", "[", "", 1000000, ""), "");
    refuse_bytes("deep_objects.gltf", repeat("", "{\"a\":", "", 1000000, ""), "");
    bytes inner = repeat("{\"asset\":{\"version\":\"2.0\"},\"extras\":", "[", "", 1000000, "");
    bytes whole = repeat((inner.at = realloc(inner.at, inner.size + 1), inner.at[inner.size] = 0, (char *)inner.at),
                         "]", "", 1000000, "}");
    free(inner.at);
    refuse_bytes("deep_extras.gltf", whole, "");
    bytes b = {0};
    add_text(&b, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 0; i < 100000; i++) {
        char node[64];
        add(&b, node, (size_t)snprintf(node, sizeof node, "{\"children\":[%d]},", i + 1));
    }
    add_text(&b, "{}]}");
    refuse_bytes("deep_nodes.gltf", b, "");
}

/* Each node has the next one as its child twice: 2^40 of them. */
static void exponentially_shared_nodes_are_refused(void **state)
{
    (void)state;
    bytes b = {0};
    add_text(&b, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 0; i < 40; i++) {
        char node[64];
        add(&b, node, (size_t)snprintf(node, sizeof node, "{\"children\":[%d,%d]},", i + 1, i + 1));
    }
    add_text(&b, "{}]}");
    refuse_bytes("doubling.gltf", b, "");
}

static void counts_above_the_limits_are_refused(void **state)
{
    (void)state;
    mesh_limits few = limits;
    few.triangles = 1000;
    bytes b = repeat(THREE, "f 1 2 3\n", "", 1001, "");
    put("thousand.obj", b.at, b.size);
    free(b.at);
    refuse_within("thousand.obj", &few, "more triangles than the limit of 1000");
    few = limits;
    few.vertices = 2;
    put_text("three.obj", THREE "f 1 2 3\n");
    refuse_within("three.obj", &few, "more vertices than the limit of 2");
    bytes faceted = {0}, library = {0};
    add_text(&faceted, "mtllib many.mtl\n" THREE);
    for (int i = 0; i < 257; i++) {
        char line[64];
        add(&library, line, (size_t)snprintf(line, sizeof line, "newmtl m%d\nKd 1 0 0\n", i));
        add(&faceted, line, (size_t)snprintf(line, sizeof line, "usemtl m%d\nf 1 2 3\n", i));
    }
    put("many.mtl", library.at, library.size);
    free(library.at);
    refuse_bytes("many.obj", faceted, "256 materials");
}

static void memory_and_time_have_limits(void **state)
{
    (void)state;
    mesh_limits small = limits;
    small.memory_bytes = (uint64_t)64 << 20;
    bytes b = repeat(THREE, "f 1 2 3\n", "", 900000, "");
    put("large.obj", b.at, b.size);
    free(b.at);
    refuse_within("large.obj", &small, "");
    small = limits;
    small.wall_s = 0.001;
    refuse_within("large.obj", &small, "longer than the limit of 0.001 s");
    /* One polygon with that many corners: ear clipping takes time proportional to the square. */
    b = (bytes){0};
    for (int i = 0; i < 64000; i++) {
        char line[64];
        add(&b, line, (size_t)snprintf(line, sizeof line, "v %d %d 0\n", i, i % 2 ? i : -i));
    }
    add_text(&b, "f");
    for (int i = 0; i < 64000; i++) {
        char word[16];
        add(&b, word, (size_t)snprintf(word, sizeof word, " %d", i + 1));
    }
    put("polygon.obj", b.at, b.size);
    free(b.at);
    small = limits;
    small.wall_s = 0.1;
    refuse_within("polygon.obj", &small, "limit of 0.1 s");
}

static void folders_pipes_loops_and_devices_are_refused(void **state)
{
    (void)state;
    char *path = in_folder("folder.stl"), *fifo = in_folder("fifo.ply"), *loop = in_folder("loop.obj"),
         *endless = in_folder("endless.glb"), *unmapped = in_folder("unmapped.stl");
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(mkfifo(fifo, 0666), 0);
    assert_int_equal(symlink("loop.obj", loop), 0);
    assert_int_equal(symlink("/dev/zero", endless), 0);
    assert_int_equal(symlink("/proc/version", unmapped),
                     0); /* regular and of size 0, but not empty: its text is read, which is no mesh */
    refuse_within("nowhere.obj", &limits, "No such file");
    refuse_within("nowhere/a.obj", &limits, "No such file");
    refuse_within("three.obj/a.obj", &limits, "");
    refuse_within("folder.stl", &limits, "is a folder");
    refuse_within("fifo.ply", &limits, "not a regular file");
    refuse_within("loop.obj", &limits, "symbolic links");
    refuse_within("endless.glb", &limits, "not a regular file");
    refuse_within("unmapped.stl", &limits, "the file ends within facet");
    free(path);
    free(fifo);
    free(loop);
    free(endless);
    free(unmapped);
}

static const char TOO_LONG[] = "longer than the limit";

/* Reads a good file with a shell script in place of the importer; the limit is short where the script exceeds it. */
static void with_importer(const char *script, const char *pattern, status expected)
{
    char *path = in_folder("importer"), *mesh_path = in_folder("three.obj"), *old = strdup(getenv("CUVETTE_IMPORT"));
    mesh_import *got;
    diagnostic why = {.what = ""};
    mesh_limits brief = limits;
    if (strcmp(pattern, TOO_LONG) == 0)
        brief.wall_s = 0.5;
    assert_non_null(old);
    put_text("three.obj", THREE "f 1 2 3\n");
    put_text("importer", script);
    chmod(path, 0755);
    setenv("CUVETTE_IMPORT", path, 1);
    status code = mesh_read_file(mesh_path, &brief, &got, &why);
    setenv("CUVETTE_IMPORT", old, 1);
    if (code != expected || got || !strstr(why.what, pattern))
        fail_msg("%s: status %d, '%s'", script, (int)code, why.what);
    free(old);
    free(mesh_path);
    free(path);
}

static void a_failing_importer_gives_an_error(void **state)
{
    (void)state;
    with_importer("#!/bin/sh\nkill -SEGV $$\n", "stopped by signal 11", STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nkill -KILL $$\n", "as the system does when memory runs out", STATUS_FAILURE);
    with_importer("#!/bin/sh\nkill -XCPU $$\n", "CPU time", STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nkill -INT $$\n", "interrupted", STATUS_INTERRUPTED);
    with_importer("#!/bin/sh\nexec sleep 100000\n", TOO_LONG, STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nexec sleep 100000 >&- 2>&-\n", "", /* both pipes closed, but still running */
                  STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nexec 2>&-\nexec sleep 100000\n", TOO_LONG, STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nexit 0\n", "truncated", STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nexit 3\n", "exit code 3", STATUS_FAILURE);
    with_importer("#!/bin/sh\nexec cat /dev/zero\n", "damaged", STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nexec cat /dev/zero >&2\n", TOO_LONG, STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nprintf 'CUVMESH\\n\\001'\n", "truncated", STATUS_BAD_INPUT);
    with_importer("#!/bin/sh\nhead -c 100 /dev/urandom\n", "damaged", STATUS_BAD_INPUT);
    with_importer("this is no program", "cannot start", STATUS_BAD_INPUT);
    char *old = strdup(getenv("CUVETTE_IMPORT"));
    mesh_import *got;
    diagnostic why = {.what = ""};
    setenv("CUVETTE_IMPORT", "/nowhere/cuvette-import", 1);
    assert_int_equal(mesh_read_file("a.obj", NULL, &got, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, "/nowhere/cuvette-import");
    assert_non_null(strstr(why.remedy, "CUVETTE_IMPORT"));
    setenv("CUVETTE_IMPORT", old, 1);
    free(old);
}

static int open_descriptors(void)
{
    DIR *entries = opendir("/proc/self/fd");
    int count = 0;
    while (readdir(entries))
        count++;
    closedir(entries);
    return count;
}

static void no_descriptor_or_child_process_is_leaked(void **state)
{
    (void)state;
    int before = open_descriptors();
    for (int i = 0; i < 5; i++)
        refuse("three.obj/nothing.obj");
    with_importer("#!/bin/sh\nexec sleep 100000\n", TOO_LONG, STATUS_BAD_INPUT);
    assert_int_equal(open_descriptors(), before);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* no child, not even a zombie */
    assert_int_equal(errno, ECHILD);
}

/* The last test: covers everything that was refused before it. */
static void all_refusals_kept_the_limit_of_memory(void **state)
{
    (void)state;
    struct rusage ours, theirs;
    getrusage(RUSAGE_SELF, &ours);
    getrusage(RUSAGE_CHILDREN, &theirs);
    printf("# %d refusals; the longest took %.2f s (%s); at most %ld MiB in the importer, %ld MiB here\n", refusals,
           longest_s, slowest, theirs.ru_maxrss >> 10, ours.ru_maxrss >> 10);
    assert_true(refusals >= 60);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    if (!getenv("RUNNER")) /* valgrind has its own memory */
        assert_true(ours.ru_maxrss < 256 << 10);
#endif
    assert_true(theirs.ru_maxrss < (long)(limits.memory_bytes >> 10)); /* the importer is built without sanitizers */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_invalid_files_are_refused),
        cmocka_unit_test(tolerated_files_give_a_valid_mesh),
        cmocka_unit_test(truncated_binary_files_are_refused),
        cmocka_unit_test(noise_is_refused_in_every_format),
        cmocka_unit_test(an_stl_with_a_wrong_facet_count_is_refused),
        cmocka_unit_test(a_ply_with_invalid_lists_is_refused),
        cmocka_unit_test(a_glb_with_wrong_lengths_is_refused),
        cmocka_unit_test(a_gltf_file_under_the_other_ending_is_refused),
        cmocka_unit_test(what_is_no_mesh_is_refused_at_its_first_bytes),
        cmocka_unit_test(what_expands_too_far_is_refused),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(exponentially_shared_nodes_are_refused),
        cmocka_unit_test(counts_above_the_limits_are_refused),
        cmocka_unit_test(memory_and_time_have_limits),
        cmocka_unit_test(folders_pipes_loops_and_devices_are_refused),
        cmocka_unit_test(a_failing_importer_gives_an_error),
        cmocka_unit_test(no_descriptor_or_child_process_is_leaked),
        cmocka_unit_test(all_refusals_kept_the_limit_of_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
