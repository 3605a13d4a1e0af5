#include "study/provenance.h"
#include "base/text.h"
#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* The rest of the first line of a file that starts with prefix, without blanks and colon; NULL if there is none. */
static char *line_of(const char *path, const char *prefix)
{
    FILE *file = fopen(path, "re");
    char line[1024], *found = NULL;
    while (file && !found && fgets(line, sizeof line, file)) {
        if (strncmp(line, prefix, strlen(prefix)) != 0)
            continue;
        char *value = line + strlen(prefix);
        value += strspn(value, " \t:");
        value[strcspn(value, "\n")] = 0;
        found = strdup(value);
    }
    if (file)
        fclose(file);
    return found;
}

char *provenance_cpu_model(void)
{
    char *name = provenance_cpu_field("model name");
    return name ? name : line_of("/proc/device-tree/model", "");
}

char *provenance_cpu_field(const char *name)
{
    return line_of("/proc/cpuinfo", name);
}

char *provenance_kernel(void)
{
    struct utsname name;
    return uname(&name) == 0 ? text_format("%s %s %s", name.sysname, name.release, name.machine) : NULL;
}

char *provenance_binding(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0)
        return NULL;
    char *text = NULL;
    text_writer writer;
    if (text_writer_open(&writer, NULL) != STATUS_OK)
        return NULL;
    bool later = false;
    for (size_t first = 0; first < CPU_SETSIZE; first++) {
        if (!CPU_ISSET(first, &set))
            continue;
        size_t last = first;
        while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &set))
            last++;
        fprintf(writer.stream, last > first ? "%s%zu-%zu" : "%s%zu", later ? "," : "", first, last);
        later = true;
        first = last;
    }
    text_writer_close(&writer, &text, NULL, NULL);
    return text;
}

/* The output of `git -C folder arguments`, at most size - 1 bytes; false if it fails. */
static bool run_git(const char *folder, const char *const *arguments, char *text, size_t size)
{
    const char *argv[12] = {"git", "--no-optional-locks", "-C", folder};
    for (size_t i = 0; arguments[i] && i < 7; i++)
        argv[i + 4] = arguments[i];
    int pipes[2];
    if (pipe2(pipes, O_CLOEXEC) != 0)
        return false;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    int failed = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    failed = failed ? failed : posix_spawn_file_actions_adddup2(&actions, pipes[1], 1);
    failed = failed ? failed : posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    pid_t child;
    failed = failed ? failed : posix_spawnp(&child, "git", &actions, NULL, (char *const *)(void *)argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(pipes[1]);
    size_t used = 0;
    char rest[512];
    for (ssize_t count; !failed && (count = read(pipes[0], rest, sizeof rest)) > 0;)
        for (ssize_t i = 0; i < count; i++)
            if (used + 1 < size)
                text[used++] = rest[i];
    text[used] = 0;
    close(pipes[0]);
    int ended = -1;
    return !failed && waitpid(child, &ended, 0) == child && WIFEXITED(ended) && WEXITSTATUS(ended) == 0;
}

char *provenance_git_commit(const char *folder, bool *dirty)
{
    static const char *const head[] = {"rev-parse", "--verify", "--quiet", "HEAD", NULL};
    static const char *const changed[] = {"status", "--porcelain", "--untracked-files=no", NULL};
    char commit[128], changes[8];
    *dirty = false;
    if (!run_git(folder, head, commit, sizeof commit))
        return NULL;
    commit[strcspn(commit, "\n")] = 0;
    if (strspn(commit, "0123456789abcdef") != strlen(commit))
        return NULL;
    *dirty = run_git(folder, changed, changes, sizeof changes) && changes[0];
    return strdup(commit);
}

void provenance_anonymize(char *xml)
{
    static const char *const telling[] = {"HostName", "Serial", "UUID",   "Address",
                                          "AssetTag", "Cgroup", "CGroup", "ProcessName"};
    if (!xml)
        return;
    char *write = xml;
    for (char *read = xml; *read;) {
        size_t line = strcspn(read, "\n");
        line += read[line] == '\n';
        char *name = strstr(read, "<info name=\"");
        bool drop = false;
        if (name && name < read + line) {
            name += strlen("<info name=\"");
            size_t length = strcspn(name, "\"");
            for (size_t i = 0; i < sizeof telling / sizeof telling[0]; i++)
                drop |= memmem(name, length, telling[i], strlen(telling[i])) != NULL;
        }
        if (!drop) {
            memmove(write, read, line);
            write += line;
        }
        read += line;
    }
    *write = 0;
}
