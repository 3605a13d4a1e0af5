/* The file that opens the laboratory's address, and the browser. */
#include "cli/browser.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const char ending[] = ".html";

/* In its own process without output, and in its own session, so that the Ctrl-C that ends the laboratory does not reach
 * it. */
static void start(const char *file)
{
    const pid_t child = fork();
    if (child == 0) {
        setsid();
        if (fork() == 0) {
            const int nowhere = open("/dev/null", O_RDWR);
            if (dup2(nowhere, STDIN_FILENO) < 0 || dup2(nowhere, STDOUT_FILENO) < 0 || dup2(nowhere, STDERR_FILENO) < 0)
                _exit(127);
            signal(SIGPIPE, SIG_DFL);
            execlp("xdg-open", "xdg-open", file, (char *)NULL);
        }
        _exit(127);
    }
    if (child > 0)
        waitpid(child, NULL, 0);
}

/* In the first folder that can be written: under sudo, $XDG_RUNTIME_DIR may be somebody else's. mkstemps creates the
 * file with mode 0600. */
static int create(char **file)
{
    const char *const folders[] = {getenv("XDG_RUNTIME_DIR"), getenv("TMPDIR"), "/tmp"};
    int fd = -1;
    *file = NULL;
    for (size_t i = 0; i < sizeof folders / sizeof *folders && fd < 0; i++) {
        if (!folders[i] || !*folders[i])
            continue;
        free(*file);
        *file = text_format("%s/cuvette-lab-XXXXXX%s", folders[i], ending);
        fd = *file ? mkstemps(*file, (int)strlen(ending)) : -1;
    }
    return fd;
}

static bool write_page(int fd, const char *address)
{
    FILE *out = fdopen(fd, "w");
    if (!out) {
        close(fd);
        return false;
    }
    const bool written = fprintf(out,
                                 "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<title>Cuvette</title>\n"
                                 "<meta name=\"referrer\" content=\"no-referrer\">\n"
                                 "<meta http-equiv=\"refresh\" content=\"0; url=%s\">\n"
                                 "<p><a href=\"%s\">Open the laboratory</a></p>\n",
                                 address, address) > 0;
    return (fclose(out) == 0) && written;
}

status browser_open(const char *address, char **file, diagnostic *why)
{
    const int fd = create(file);
    if (fd >= 0 && write_page(fd, address)) {
        start(*file);
        return STATUS_OK;
    }
    const status code =
        diagnose_at(why, *file ? *file : "", STATUS_FAILURE, "open the printed address, or use --no-browser",
                    "cannot write the file for the browser: %s", strerror(errno));
    if (fd >= 0)
        unlink(*file);
    free(*file);
    *file = NULL;
    return code;
}

void browser_forget(char *file)
{
    if (file)
        unlink(file);
    free(file);
}
