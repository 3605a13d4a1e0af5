/* `cuvette lab`: starts the laboratory's HTTP server and opens its page in the browser. */
#include "web/lab.h"
#include "base/cancel.h"
#include "base/installed.h"
#include "base/status.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "measure/topology.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* --- the browser opens the address without showing it to others --- */

/* Arguments of programs are visible to everyone on the machine, so the browser gets a file that only its owner can read
 * and that opens the address. */

static const char ending[] = ".html";

/* Starts the browser without output, in a new session, so that the Ctrl-C that ends the laboratory does not reach
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

/* Creates the file in the first writable folder: under sudo, $XDG_RUNTIME_DIR may be somebody else's. mkstemps creates
 * the file with mode 0600. */
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

/* Writes the file for the browser, and starts xdg-open with it. *file is its path, allocated; NULL after an error.
 * STATUS_FAILURE if the file cannot be written. */
static status browser_open(const char *address, char **file, diagnostic *why)
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

/* Removes the file and frees its path; NULL is allowed. */
static void browser_remove_file(char *file)
{
    if (file)
        unlink(file);
    free(file);
}

/* --- the command --- */

typedef struct lab_request {
    const char *scene, *folder, *results; /* NULL: not given */
    int64_t port, threads;
    const char *embed_origins[HTTP_FRAME_ORIGINS_MAX];
    size_t embed_origin_count;
    bool no_browser;
} lab_request;

static status store_origin(const command_option *o, void *context, const char *value, diagnostic *why)
{
    lab_request *request = context;
    (void)o;
    if (!http_is_origin(value))
        return options_wrong("--embed-origin", NULL, why, "use scheme, host and perhaps port: https://lms.example",
                             "'%.128s' is not the origin of a site", value);
    if (request->embed_origin_count == HTTP_FRAME_ORIGINS_MAX)
        return options_wrong("--embed-origin", NULL, why, "remove the others", "only 8 origins can be given");
    request->embed_origins[request->embed_origin_count++] = value;
    return STATUS_OK;
}

static const command_option options[] = {
    {"folder", 0, "DIR",
     "folder of the scenes, models and studies, where files are also saved; nothing outside it is read or written "
     "(default: the working folder, or the folder of SCENE if that is outside it)",
     OPTION_FILLS(option_text, lab_request, folder)},
    {"results", 0, "DIR", "folder for the rows of studies, inside --folder (default: its subfolder results)",
     OPTION_FILLS(option_text, lab_request, results)},
    {"port", 0, "N", "port on 127.0.0.1 (default: any free port)", OPTION_FILLS(option_integer, lab_request, port),
     .lowest = 0, .highest = 65535},
    {"threads", 0, "N", "threads for scenes that do not set render.threads (default: one per processing unit)",
     OPTION_FILLS(option_integer, lab_request, threads), .lowest = 1, .highest = 1024},
    {"embed-origin", 0, "ORIGIN",
     "let pages of this site show the laboratory in a frame, such as https://lms.example; repeatable (default: none)",
     .store = store_origin},
    OPTION_MEMORY,
    {"no-browser", 0, NULL, "do not open the address in a browser", OPTION_FILLS(option_flag, lab_request, no_browser)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "[SCENE]",
    .arguments_at = offsetof(lab_request, scene),
    .argument_limit = 1,
    .excess_remedy = "give at most one SCENE",
    .excess = "unexpected argument '%.128s'",
    .about = "Open the laboratory in the browser: view a scene, change any of its parameters, inspect the rays of a "
             "pixel, compare images, edit the scene, move a slime, run studies. This program serves the page on "
             "127.0.0.1 only; access requires the token in the printed address.\vFor example:\n"
             "  cuvette lab experiments/scenes/rod.yaml\n"
             "From another machine, run the following and open the printed address locally:\n"
             "  ssh -L 8000:127.0.0.1:8000 HOST cuvette lab --port 8000 --no-browser SCENE\n"
             "Ctrl-C ends the laboratory.",
};

/* The working folder, if no scene is given, or if the scene is below it or does not exist (which is reported later);
 * otherwise the scene's folder. Allocated. */
static char *choose_folder(const lab_request *request)
{
    char here[PATH_MAX], there[PATH_MAX];
    if (!request->scene || !realpath(request->scene, there))
        return strdup(".");
    const size_t length = realpath(".", here) ? strlen(here) : 0;
    if (length && strncmp(there, here, length) == 0 && (there[length] == '/' || length == 1))
        return strdup(".");
    char *slash = strrchr(there, '/');
    slash[slash == there] = 0;
    return strdup(there);
}

/* The folder for state by the XDG Base Directory Specification, which ignores relative paths. Allocated; "" if no
 * folder is known. */
static char *state_folder(void)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    if (state && state[0] == '/')
        return text_format("%s/cuvette", state);
    return home && home[0] == '/' ? text_format("%s/.local/state/cuvette", home) : strdup("");
}

static void wait_for_stop(void)
{
    while (!cancel_asked())
        usleep(50000);
}

/* If the file for the browser cannot be written, a note says so: the printed address remains. */
static void open_browser(const char *address, char **file)
{
    diagnostic reason = {.line = 0};
    char text[DIAGNOSTIC_TEXT_MAX];
    if (browser_open(address, file, &reason) != STATUS_OK)
        terminal_note(diagnostic_text(&reason, text, sizeof text));
}

static status run_lab(const lab_request *request, const char *scenes, const char *results, diagnostic *why)
{
    lab *l = NULL;
    topology *machine = NULL;
    char *file = NULL, *kept_in = state_folder();
    lab_settings settings = {.folder = scenes,
                             .scene = request->scene,
                             .results = results,
                             .rescue = kept_in,
                             .port = (int)request->port,
                             .frame_origins = request->embed_origins,
                             .frame_origin_count = request->embed_origin_count,
                             .confine = true,
                             .threads = (int)request->threads};
    status code = kept_in ? scene_input_isa(&settings.level, why) : out_of_memory(why);
    if (code == STATUS_OK && settings.threads == 0 && (code = topology_create(&machine, why)) == STATUS_OK)
        settings.threads = topology_pu_count(machine);
    topology_destroy(machine);
    THEN(code, lab_start(&settings, &l, why));
    if (code == STATUS_BAD_INPUT && request->scene)
        installed_suggest(request->scene, "experiments/scenes", ".yaml", why);
    if (code == STATUS_OK) {
        printf("%s\n", lab_address(l));
        code = terminal_flush(why);
    }
    if (code == STATUS_OK && !request->no_browser)
        open_browser(lab_address(l), &file);
    if (code == STATUS_OK)
        wait_for_stop();
    browser_remove_file(file);
    if (code == STATUS_OK && !terminal_stopped_by_user())
        lab_leave_unsaved(l);
    lab_stop(l);
    free(kept_in);
    return code;
}

status command_lab(int argc, char **argv, diagnostic *why)
{
    lab_request request = {.scene = NULL};
    status code = command_form_read(&form, argc, argv, &request, why);
    char *chosen = NULL, *results = NULL;
    if (code == STATUS_OK && !request.folder && !(chosen = choose_folder(&request)))
        code =
            system_error(why, STATUS_FAILURE, NULL, "cannot find the working folder", errno, "name it with --folder");
    const char *scenes = request.folder ? request.folder : chosen;
    if (code == STATUS_OK && !request.results) {
        results = strcmp(scenes, ".") == 0 ? strdup("results") : text_format("%s/results", scenes);
        code = results ? code : out_of_memory(why);
    }
    THEN(code, run_lab(&request, scenes, request.results ? request.results : results, why));
    free(chosen);
    free(results);
    return code;
}
