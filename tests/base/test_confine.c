/* Tests of the rights that threads and programs give up: base/os_process.h, image/codec.h, and the importer's process.
 * What is given up cannot be had again, so that most tests run in a child process. Run from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/budget.h"
#include "base/cancel.h"
#include "base/os_process.h"
#include "base/text.h"
#include "image/codec.h"
#include "image/image.h"
#include "mesh_files.h"
#include "scene/assets/mesh_stream.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>

/* --- a child that answers with a status --- */

enum { GOOD = 0, BAD = 1, MISSING = 77 };

static int in_child(int (*work)(void))
{
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(work());
    int state;
    assert_int_equal(waitpid(child, &state, 0), child);
    assert_true(WIFEXITED(state));
    return WEXITSTATUS(state);
}

static void expect_good(int (*work)(void))
{
    const int got = in_child(work);
    if (got == MISSING)
        skip();
    assert_int_equal(got, GOOD);
}

static bool opens(const char *name, int flags)
{
    char *path = in_folder(name);
    const int fd = open(path, flags | O_CLOEXEC, 0600);
    free(path);
    if (fd >= 0)
        close(fd);
    return fd >= 0;
}

/* --- files --- */

static int only_one_folder(void)
{
    char *inside = in_folder("inside");
    const confine_place places[] = {{inside, CONFINE_READ}, {"/no/such/place", CONFINE_WRITE}};
    if (!os_confine_files(places, 2))
        return MISSING;
    const bool reads = opens("inside/a", O_RDONLY), refuses = !opens("outside", O_RDONLY) && errno == EACCES;
    return reads && refuses && !opens("inside/a", O_WRONLY) && !opens("inside/new", O_WRONLY | O_CREAT) ? GOOD : BAD;
}

static int a_folder_to_write(void)
{
    char *inside = in_folder("inside"), *from = in_folder("inside/new"), *to = in_folder("inside/deeper/newer"),
         *outside = in_folder("escaped");
    const confine_place places[] = {{inside, CONFINE_WRITE}};
    if (!os_confine_files(places, 1))
        return MISSING;
    return opens("inside/new", O_WRONLY | O_CREAT) && rename(from, to) == 0 && rename(to, outside) != 0 &&
                   truncate(to, 0) == 0 && unlink(to) == 0
               ? GOOD
               : BAD;
}

static int no_program(void)
{
    if (!os_confine_files(&(confine_place){"/", CONFINE_READ}, 1))
        return MISSING;
    char *const arguments[] = {(char *)(uintptr_t) "true", NULL};
    execv("/bin/true", arguments);
    return errno == EACCES ? GOOD : BAD;
}

/* Without open files for the places they would be left out, as if they were not there. */
static int no_files_for_the_places(void)
{
    char *inside = in_folder("inside");
    const confine_place places[] = {{inside, CONFINE_READ}};
    const int first = open("/dev/null", O_RDONLY | O_CLOEXEC), second = open("/dev/null", O_RDONLY | O_CLOEXEC);
    const struct rlimit few = {(rlim_t)second, (rlim_t)second}; /* one for the rules, none for the place */
    close(first);
    close(second);
    if (first < 0 || second != first + 1 || setrlimit(RLIMIT_NOFILE, &few) != 0)
        return BAD;
    errno = 0;
    if (os_confine_files(places, 1))
        return BAD;
    if (errno == 0)
        return MISSING;
    return errno == EMFILE && opens("outside", O_RDONLY) ? GOOD : BAD;
}

static void only_the_given_places_are_reached(void **state)
{
    (void)state;
    expect_good(only_one_folder);
    expect_good(a_folder_to_write);
    expect_good(no_program);
    expect_good(no_files_for_the_places);
}

/* --- system calls --- */

static bool refused(long result)
{
    return result < 0 && errno == EPERM;
}

static int no_calls_but_reading(void)
{
    char *file = in_folder("outside");
    if (!os_confine_calls(CONFINE_READING))
        return MISSING;
    bool good = opens("outside", O_RDONLY) && !opens("outside", O_RDWR) && !opens("made", O_WRONLY | O_CREAT);
    good = good && refused(socket(AF_INET, SOCK_STREAM, 0)) && refused(socket(AF_UNIX, SOCK_STREAM, 0));
    good = good && refused(unlink(file)) && refused(kill(getppid(), 0)) && refused(fork());
    good = good && refused(syscall(SYS_execve, "/bin/true", NULL, NULL)) && refused(syscall(SYS_ptrace, 0, 0, 0, 0));
    good = good && mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED;
    return good ? GOOD : BAD;
}

static void *add_one(void *number)
{
    ++*(int *)number;
    return number;
}

static int threads_and_memory(void)
{
    pthread_t thread;
    int number = 0;
    if (!os_confine_calls(CONFINE_READING))
        return MISSING;
    bool good = pthread_create(&thread, NULL, add_one, &number) == 0 && pthread_join(thread, NULL) == 0;
    char *much = malloc(64 << 20);
    good = good && number == 1 && much;
    memset(much, 1, 64 << 20);
    free(much);
    return good ? GOOD : BAD;
}

static void only_reading_calls_are_left(void **state)
{
    (void)state;
    expect_good(no_calls_but_reading);
    expect_good(threads_and_memory);
}

/* --- a call apart --- */

typedef struct findings {
    bool ran, reads, writes, connects;
} findings;

static void look_around(void *of)
{
    findings *f = of;
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    *f = (findings){true, opens("outside", O_RDONLY), opens("escaped", O_WRONLY | O_CREAT), fd >= 0};
    if (fd >= 0)
        close(fd);
}

static int has_calls(void)
{
    return os_confine_calls(CONFINE_COMPUTING) ? GOOD : MISSING;
}

static void a_call_apart_reaches_nothing_and_its_caller_everything(void **state)
{
    (void)state;
    findings f = {false}, own = {false};
    codec_run_confined(look_around, &f);
    assert_true(f.ran);
    if (in_child(has_calls) == GOOD)
        assert_false(f.reads || f.writes || f.connects);
    look_around(&own);
    assert_true(own.reads && own.writes && own.connects);
}

typedef struct question {
    int asks;         /* of the caller's token, so far */
    bool was_stopped; /* the work saw it */
} question;

/* True at the third time. */
static bool ask(void *of)
{
    question *q = of;
    return ++q->asks > 2;
}

static void work_until_cancelled(void *of)
{
    question *q = of;
    while (!q->was_stopped) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
        q->was_stopped = cancel_asked();
    }
}

static void a_call_apart_is_cancelled_with_its_caller(void **state)
{
    (void)state;
    question q = {0};
    cancel_token token = {.ask = ask, .context = &q};
    cancel_begin(&token);
    codec_run_confined(work_until_cancelled, &q);
    cancel_end(&token);
    assert_true(q.was_stopped);
}

static void refuse(void *of)
{
    *(status *)of = memory_budget_check((uint64_t)1 << 62, "use a smaller one", NULL, "it");
}

/* The files that say what is free are out of its reach. */
static void a_call_apart_has_the_budget_of_its_caller(void **state)
{
    (void)state;
    status code = STATUS_OK;
    codec_run_confined(refuse, &code);
    assert_int_equal(code, STATUS_BAD_INPUT);
}

/* --- where it is not possible --- */

/* A kernel or container without both: all their calls fail. */
static bool forbid(void)
{
    struct sock_filter code[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, 444, 0, 1), /* landlock_create_ruleset; the same everywhere */
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, 447, 0, 4),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_seccomp, 3, 0),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_prctl, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
    };
    const struct sock_fprog all = {sizeof code / sizeof *code, code};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all) == 0;
}

static bool reads_mesh(void)
{
    char *path = in_folder("triangle.obj");
    mesh_import *got = NULL;
    const status code = mesh_read_file(path, NULL, &got, NULL);
    const bool right = code == STATUS_OK && got->mesh->triangle_count == 1;
    mesh_import_destroy(got);
    free(path);
    return right;
}

static bool reads_image(void)
{
    char *path = in_folder("small.png");
    image *img = NULL;
    const bool right = image_read(path, &img, NULL, NULL) == STATUS_OK && img->width == 7;
    image_destroy(img);
    free(path);
    return right;
}

static int work_without(void)
{
    if (!forbid())
        return MISSING;
    const bool none = !os_confine_files(NULL, 0) && !os_confine_calls(CONFINE_COMPUTING);
    return none && reads_mesh() && reads_image() && opens("outside", O_RDONLY) ? GOOD : BAD;
}

static int work_switched_off(void)
{
    setenv("CUVETTE_SANDBOX", "off", 1);
    const bool none = !os_confine_files(NULL, 0) && !os_confine_calls(CONFINE_COMPUTING);
    return none && reads_mesh() && reads_image() && opens("outside", O_RDONLY) ? GOOD : BAD;
}

static void all_is_read_where_nothing_can_be_confined(void **state)
{
    (void)state;
    expect_good(work_without);
    expect_good(work_switched_off);
}

/* --- the importer --- */

/* A field of /proc/PID/status, or -1. */
static int field_of(pid_t process, const char *name)
{
    char path[64], line[256];
    int value = -1;
    snprintf(path, sizeof path, "/proc/%d/status", (int)process);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0 && line[strlen(name)] == ':')
            value = atoi(line + strlen(name) + 1);
    if (file)
        fclose(file);
    return value;
}

/* The importer of a mesh that is larger than a pipe waits until somebody reads: its process can be looked at. */
static void the_importer_is_confined(void **state)
{
    (void)state;
    const char *program = getenv("CUVETTE_IMPORT");
    int ends[2];
    if (!program || in_child(has_calls) != GOOD)
        skip();
    char *path = in_folder("large.obj");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int i = 0; i < 20000; i++)
        fprintf(file, "v %d 0 0\nv %d 1 0\nv %d 0 1\nf %d %d %d\n", i, i, i, 3 * i + 1, 3 * i + 2, 3 * i + 3);
    fclose(file);
    assert_int_equal(pipe2(ends, O_CLOEXEC), 0);
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        execl(program, "cuvette-import", path, (char *)NULL);
        _exit(BAD);
    }
    close(ends[1]);
    char first;
    assert_int_equal(read(ends[0], &first, 1), 1);
    const int filtered = field_of(child, "Seccomp"), unprivileged = field_of(child, "NoNewPrivs");
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    close(ends[0]);
    free(path);
    assert_int_equal(filtered, SECCOMP_MODE_FILTER);
    assert_int_equal(unprivileged, 1);
}

/* --- the folder --- */

static int enter(void **state)
{
    assert_int_equal(make_folder(state), 0);
    char *inside = in_folder("inside"), *deeper = in_folder("inside/deeper"), *small = in_folder("small.png");
    assert_true(mkdir(inside, 0700) == 0 && mkdir(deeper, 0700) == 0);
    put_text("inside/a", "a");
    put_text("outside", "b");
    put_text("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    image *img = NULL;
    assert_int_equal(image_create(7, 5, &img, NULL), STATUS_OK);
    assert_int_equal(image_write(img, small, 8, NULL), STATUS_OK);
    image_destroy(img);
    free(inside);
    free(deeper);
    free(small);
    return 0;
}

static int leave(void **state)
{
    static const char *const below[] = {"inside/deeper", "inside/a", "inside/new"};
    for (size_t i = 0; i < sizeof below / sizeof *below; i++) {
        char *path = in_folder(below[i]);
        remove(path);
        free(path);
    }
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_the_given_places_are_reached),
        cmocka_unit_test(only_reading_calls_are_left),
        cmocka_unit_test(a_call_apart_reaches_nothing_and_its_caller_everything),
        cmocka_unit_test(a_call_apart_is_cancelled_with_its_caller),
        cmocka_unit_test(a_call_apart_has_the_budget_of_its_caller),
        cmocka_unit_test(all_is_read_where_nothing_can_be_confined),
        cmocka_unit_test(the_importer_is_confined),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
