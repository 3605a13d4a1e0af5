/* Tests of files: reading, writing in one piece, temporaries, folders, and errors of the system. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/os_process.h"
#include "base/status.h"
#include "base/text.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[4096];

static char *in_folder(const char *name)
{
    char *path = text_format("%s/%s", folder, name);
    assert_non_null(path);
    return path;
}

static void remove_tree(const char *path)
{
    DIR *entries = opendir(path);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            char *inner = text_format("%s/%s", path, entry->d_name);
            struct stat about;
            if (lstat(inner, &about) == 0 && S_ISDIR(about.st_mode))
                remove_tree(inner);
            else
                unlink(inner);
            free(inner);
        }
    }
    if (entries)
        closedir(entries);
    rmdir(path);
}

static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/cuvette-base-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    remove_tree(folder);
    return 0;
}

static int entries_in(const char *path)
{
    DIR *entries = opendir(path);
    int count = 0;
    assert_non_null(entries);
    while (readdir(entries))
        count++;
    closedir(entries);
    return count - 2; /* . and .. */
}

static void put(const char *path, const char *text)
{
    file_writer writer;
    diagnostic why = {0};
    assert_int_equal(file_writer_open(&writer, path, &why), STATUS_OK);
    assert_true(fputs(text, writer.stream) >= 0);
    assert_int_equal(file_writer_commit(&writer, &why), STATUS_OK);
}

static void check_content(const char *path, const char *expected)
{
    char *text;
    size_t size;
    assert_int_equal(file_read(path, 1 << 20, &text, &size, NULL), STATUS_OK);
    assert_int_equal(size, strlen(expected));
    assert_string_equal(text, expected);
    free(text);
}

static void written_files_read_back(void **state)
{
    (void)state;
    char *path = in_folder("a.txt"), *text;
    size_t size;
    diagnostic why = {0};
    put(path, "one\n");
    check_content(path, "one\n");
    put(path, "");
    check_content(path, "");
    put(path, "exactly16 bytes!");
    assert_int_equal(file_read(path, 16, &text, &size, &why), STATUS_OK);
    assert_int_equal(why.file[0], 0); /* a later error is not this file's */
    assert_int_equal(size, 16);
    free(text);
    assert_int_equal(file_read(path, 15, &text, &size, &why), STATUS_BAD_INPUT);
    assert_null(text);
    assert_string_equal(why.file, path);
    assert_int_equal(entries_in(folder), 1);
    free(path);
}

static void large_files_read_back(void **state)
{
    (void)state;
    char *path = in_folder("large"), *text;
    size_t size, count = 300001;
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    for (size_t i = 0; i < count; i++)
        putc((int)(i * 7 % 256), writer.stream);
    assert_int_equal(file_writer_commit(&writer, NULL), STATUS_OK);
    assert_int_equal(file_read(path, SIZE_MAX, &text, &size, NULL), STATUS_OK);
    assert_int_equal(size, count);
    for (size_t i = 0; i < count; i++)
        assert_int_equal((unsigned char)text[i], i * 7 % 256);
    free(text);
    free(path);
}

static void files_of_proc_are_read_to_their_end(void **state)
{
    (void)state;
    char *text;
    size_t size;
    assert_int_equal(file_read("/proc/self/status", 1 << 20, &text, &size, NULL), STATUS_OK);
    assert_true(size > 100 && text[size] == 0);
    free(text);
}

static void unreadable_paths_are_refused(void **state)
{
    (void)state;
    char *missing = in_folder("missing"), *fifo = in_folder("fifo"), *text;
    size_t size;
    diagnostic why = {0};
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_int_equal(file_read(missing, 100, &text, &size, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, missing);
    assert_non_null(strstr(why.what, "No such file"));
    assert_int_equal(file_read(folder, 100, &text, &size, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "is a folder");
    assert_int_equal(file_read(fifo, 100, &text, &size, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "is not a regular file");
    assert_int_equal(file_read("/dev/null", 100, &text, &size, &why), STATUS_BAD_INPUT);
    free(missing);
    free(fifo);
}

static void the_file_is_unchanged_before_the_commit(void **state)
{
    (void)state;
    char *path = in_folder("a"), *fresh = in_folder("b");
    file_writer writer;
    put(path, "old");
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    fputs("new", writer.stream);
    fflush(writer.stream);
    check_content(path, "old");
    file_writer_abandon(&writer);
    check_content(path, "old");
    assert_int_equal(entries_in(folder), 1);

    assert_int_equal(file_writer_open(&writer, fresh, NULL), STATUS_OK);
    assert_int_equal(access(fresh, F_OK), -1);
    assert_int_equal(file_writer_commit(&writer, NULL), STATUS_OK);
    check_content(fresh, "");
    assert_int_equal(entries_in(folder), 2);
    free(path);
    free(fresh);
}

static void two_writers_do_not_interfere(void **state)
{
    (void)state;
    char *a = in_folder("a"), *b = in_folder("b");
    file_writer first, second;
    assert_int_equal(file_writer_open(&first, a, NULL), STATUS_OK);
    assert_int_equal(file_writer_open(&second, b, NULL), STATUS_OK);
    fputs("1", first.stream);
    fputs("2", second.stream);
    assert_int_equal(file_writer_commit(&second, NULL), STATUS_OK);
    assert_int_equal(file_writer_commit(&first, NULL), STATUS_OK);
    check_content(a, "1");
    check_content(b, "2");
    free(a);
    free(b);
}

static mode_t mode_of(const char *path)
{
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    return about.st_mode & 07777;
}

static void permissions_follow_umask_or_the_old_file(void **state)
{
    (void)state;
    char *a = in_folder("a"), *b = in_folder("b");
    mode_t before = umask(027);
    put(a, "x");
    umask(before);
    assert_int_equal(mode_of(a), 0640);
    put(b, "x");
    assert_int_equal(chmod(b, 0604), 0);
    put(b, "y");
    assert_int_equal(mode_of(b), 0604);
    free(a);
    free(b);
}

static void writing_through_a_link_keeps_the_link(void **state)
{
    (void)state;
    char *target = in_folder("target"), *absolute = in_folder("absolute"), *relative = in_folder("relative");
    char *dangling = in_folder("dangling"), *later = in_folder("later"), *loop = in_folder("loop");
    struct stat about;
    put(target, "old");
    assert_int_equal(symlink(target, absolute), 0);
    assert_int_equal(symlink("absolute", relative), 0);
    assert_int_equal(symlink("later", dangling), 0);
    assert_int_equal(symlink("loop", loop), 0);
    put(relative, "new");
    check_content(target, "new");
    assert_true(lstat(relative, &about) == 0 && S_ISLNK(about.st_mode));
    assert_true(lstat(absolute, &about) == 0 && S_ISLNK(about.st_mode));
    put(dangling, "made");
    check_content(later, "made");
    assert_true(lstat(dangling, &about) == 0 && S_ISLNK(about.st_mode));
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, loop, NULL), STATUS_FAILURE);
    free(target);
    free(absolute);
    free(relative);
    free(dangling);
    free(later);
    free(loop);
}

static void devices_are_written_directly(void **state)
{
    (void)state;
    diagnostic why = {0};
    file_writer writer;
    struct stat about;
    put("/dev/null", "gone");
    assert_true(stat("/dev/null", &about) == 0 && S_ISCHR(about.st_mode));
    assert_int_equal(file_writer_open(&writer, "/dev/full", &why), STATUS_OK);
    fputs("x", writer.stream);
    assert_int_equal(file_writer_commit(&writer, &why), STATUS_FAILURE);
    assert_string_equal(why.file, "/dev/full");
    assert_non_null(strstr(why.what, "No space left"));
    assert_int_equal(file_writer_open(&writer, "/dev/full", NULL), STATUS_OK);
    for (int i = 0; i < 100000; i++) /* the error comes early and must still be reported at the end */
        putc('x', writer.stream);
    assert_int_equal(file_writer_commit(&writer, NULL), STATUS_FAILURE);
}

static void a_full_disk_keeps_the_old_file(void **state)
{
    (void)state;
    char *path = in_folder("a");
    put(path, "old");
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 5000;
    os_signals_as_errors();
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    file_writer writer;
    diagnostic why = {0};
    status opened = file_writer_open(&writer, path, NULL), committed = STATUS_OK;
    if (opened == STATUS_OK) {
        for (int i = 0; i < 20000; i++)
            putc('x', writer.stream);
        committed = file_writer_commit(&writer, &why);
    }
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(opened, STATUS_OK);
    assert_int_equal(committed, STATUS_FAILURE);
    assert_string_equal(why.file, path);
    assert_true(strstr(why.what, "cannot write") == why.what);
    check_content(path, "old");
    assert_int_equal(entries_in(folder), 1);
    free(path);
}

/* Space that becomes free before the commit does not restore what was lost. */
static void an_early_write_error_is_reported_at_the_commit(void **state)
{
    (void)state;
    char *path = in_folder("a");
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 100;
    os_signals_as_errors();
    file_writer writer;
    diagnostic why = {0};
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    setvbuf(writer.stream, NULL, _IONBF, 0);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    char block[300] = {0};
    size_t written = fwrite(block, 1, sizeof block, writer.stream);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_true(written < sizeof block);
    assert_int_equal(file_writer_commit(&writer, &why), STATUS_FAILURE);
    assert_string_equal(why.file, path);
    assert_int_equal(entries_in(folder), 0);
    free(path);
}

/* The name that a temporary file has for an instant when it replaces another: a folder cannot be replaced. */
static char *named_temporary(int *fd)
{
    char *full = in_folder("full"), *inside = in_folder("full/x"), *name = NULL;
    assert_int_equal(mkdir(full, 0777), 0);
    put(inside, "");
    *fd = temporary_open(full, &name);
    assert_true(*fd >= 0);
    assert_int_equal(temporary_move(*fd, &name, full), -1);
    assert_non_null(name);
    assert_int_equal(access(name, F_OK), 0);
    free(inside);
    free(full);
    return name;
}

static void the_file_of_a_killed_writer_is_removed_by_the_next(void **state)
{
    (void)state;
    int fd;
    char *a = in_folder("a"), *b = in_folder("b"), *left = named_temporary(&fd);
    put(a, "1");
    put(a, "2"); /* needs a name, and leaves that of the living writer alone */
    assert_int_equal(access(left, F_OK), 0);
    close(fd);   /* as the kernel does for a killed process */
    put(b, "1"); /* a new file needs no other name */
    assert_int_equal(access(left, F_OK), 0);
    put(a, "3");
    assert_int_equal(access(left, F_OK), -1);
    check_content(a, "3");
    assert_int_equal(entries_in(folder), 3); /* a, b and the folder */
    free(left);
    free(b);
    free(a);
}

static void a_file_for_another_program_has_a_name_and_ends_with_its_writer(void **state)
{
    (void)state;
    char *path = in_folder("figure.png"), *left = NULL, *other = NULL, *again = NULL;
    const int first = temporary_open_named(path, ".png", &left);
    const int second = temporary_open_named(path, ".png", &other);
    assert_true(first >= 0 && second >= 0);
    assert_string_equal(left + strlen(left) - 9, ".part.png");
    assert_string_not_equal(left, other);
    assert_int_equal(entries_in(folder), 2);
    close(first); /* killed */
    const int third = temporary_open_named(path, ".png", &again);
    assert_string_equal(again, left);
    assert_int_equal(access(other, F_OK), 0); /* its writer lives */
    assert_int_equal(temporary_move(third, &again, path), 0);
    assert_int_equal(temporary_move(second, &other, path), 0);
    assert_int_equal(entries_in(folder), 1);
    close(third);
    close(second);
    free(left);
    free(other);
    free(again);
    free(path);
}

static void an_unfinished_file_has_no_name(void **state)
{
    (void)state;
    char *path = in_folder("a");
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    assert_int_equal(entries_in(folder), writer.temporary ? 1 : 0); /* named on old file systems */
    file_writer_abandon(&writer);
    assert_int_equal(entries_in(folder), 0);
    free(path);
}

static void the_remedy_fits_the_error(void **state)
{
    (void)state;
    assert_non_null(strstr(system_remedy(EACCES), "permissions"));
    assert_non_null(strstr(system_remedy(EIO), "check the disk"));
    assert_null(system_remedy(EINVAL));
}

static void unwritable_paths_are_refused(void **state)
{
    (void)state;
    char *closed = in_folder("closed"), *inside = in_folder("closed/a"), *no_folder = in_folder("none/a");
    char *read_only = in_folder("read_only");
    file_writer writer;
    diagnostic why = {0};
    assert_int_equal(file_writer_open(&writer, "", &why), STATUS_BAD_INPUT);
    assert_int_equal(file_writer_open(&writer, no_folder, &why), STATUS_FAILURE);
    assert_string_equal(why.file, no_folder);
    assert_int_equal(file_writer_open(&writer, folder, &why), STATUS_FAILURE);

    assert_int_equal(mkdir(closed, 0555), 0);
    put(read_only, "keep");
    assert_int_equal(chmod(read_only, 0444), 0);
    uid_t user = geteuid();
    assert_int_equal(chmod(folder, 0777), 0);
    if (user == 0)
        assert_int_equal(seteuid(65534), 0); /* root may write everywhere */
    status code = file_writer_open(&writer, inside, &why), kept = file_writer_open(&writer, read_only, NULL);
    status made = file_make_directory(inside, NULL);
    if (user == 0)
        assert_int_equal(seteuid(0), 0);
    assert_int_equal(code, STATUS_FAILURE);
    assert_non_null(strstr(why.what, "Permission denied"));
    assert_int_equal(kept, STATUS_FAILURE);
    assert_int_equal(made, STATUS_FAILURE);
    free(closed);
    free(inside);
    free(no_folder);
    free(read_only);
}

static void a_path_of_minus_is_standard_output(void **state)
{
    (void)state;
    char *path = in_folder("out");
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        int fd = open(path, O_WRONLY | O_CREAT, 0600);
        dup2(fd, STDOUT_FILENO);
        free(path);
        file_writer writer;
        printf("before ");
        bool good = file_writer_open(&writer, "-", NULL) == STATUS_OK && fputs("image", writer.stream) >= 0 &&
                    file_writer_commit(&writer, NULL) == STATUS_OK;
        printf(" after");
        fflush(stdout);
        _exit(good ? 0 : 1);
    }
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_int_equal(result, 0);
    check_content(path, "before image after");
    free(path);
}

static void folders_are_created_with_their_parents(void **state)
{
    (void)state;
    char *deep = in_folder("a//b/c/"), *c = in_folder("a/b/c"), *file = in_folder("file"), *under = in_folder("file/x");
    struct stat about;
    diagnostic why = {0};
    assert_int_equal(file_make_directory(deep, &why), STATUS_OK);
    assert_true(stat(c, &about) == 0 && S_ISDIR(about.st_mode));
    assert_int_equal(file_make_directory(c, &why), STATUS_OK);
    put(file, "x");
    assert_int_equal(file_make_directory(file, &why), STATUS_FAILURE);
    assert_int_equal(file_make_directory(under, &why), STATUS_FAILURE);
    assert_string_equal(why.file, under);
    assert_int_equal(file_make_directory("", &why), STATUS_FAILURE);
    assert_int_equal(file_make_directory("/", &why), STATUS_OK);
    free(deep);
    free(c);
    free(file);
    free(under);
}

#define file_test(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        file_test(written_files_read_back),
        file_test(large_files_read_back),
        file_test(files_of_proc_are_read_to_their_end),
        file_test(unreadable_paths_are_refused),
        file_test(the_file_is_unchanged_before_the_commit),
        file_test(two_writers_do_not_interfere),
        file_test(permissions_follow_umask_or_the_old_file),
        file_test(writing_through_a_link_keeps_the_link),
        file_test(devices_are_written_directly),
        file_test(a_full_disk_keeps_the_old_file),
        file_test(an_early_write_error_is_reported_at_the_commit),
        file_test(the_file_of_a_killed_writer_is_removed_by_the_next),
        file_test(a_file_for_another_program_has_a_name_and_ends_with_its_writer),
        file_test(an_unfinished_file_has_no_name),
        cmocka_unit_test(the_remedy_fits_the_error),
        file_test(unwritable_paths_are_refused),
        file_test(a_path_of_minus_is_standard_output),
        file_test(folders_are_created_with_their_parents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
