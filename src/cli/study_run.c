/* Parts of `cuvette study run`: the plan of --dry-run, counted instructions, and the fresh processes, which run this
 * program with --process=K, or alternate with another build. */
#include "base/budget.h"
#include "base/cancel.h"
#include "base/isa.h"
#include "base/os_process.h"
#include "base/random.h"
#include "base/status.h"
#include "base/text.h"
#include "cli/options.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "measure/clock.h"
#include "measure/usage.h"
#include "study/run/estimate.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* --- the plan --- */

status study_check_room(const study *s, const study_request *request, const study_estimate *e, diagnostic *why)
{
    char note[DISK_ROOM_TEXT_MAX];
    char *folder = text_format("%s/%s", request->results, s->name);
    if (!folder)
        return out_of_memory(why);
    const status result = disk_room_check(&e->needed, e->free_bytes, folder, "the run", note, why);
    free(folder);
    if (note[0])
        terminal_note(note);
    return result;
}

status study_dry_run(const study *s, const study_request *request, diagnostic *why)
{
    const study_options options = {.results = request->results,
                                   .shard = request->shard,
                                   .shards = request->shards,
                                   .by_repetition = request->by_repetition,
                                   .any_environment = request->any_environment};
    study_estimate e;
    TRY(study_estimate_run(s, &options, &e, why));
    if (request->quiet)
        return STATUS_OK;
    study_estimate_write(stdout, s, request->results, &e);
    TRY(terminal_flush(why));
    return study_check_room(s, request, &e, why);
}

/* --- counted instructions --- */

static bool has_valgrind(void)
{
    const char *path = getenv("PATH");
    char name[1024];
    for (size_t length; path && *path; path += length + (path[length] == ':')) {
        length = strcspn(path, ":");
        snprintf(name, sizeof name, "%.*s/valgrind", (int)length, path);
        if (access(name, X_OK) == 0)
            return true;
    }
    return false;
}

status study_instructions_begin(study_request *request, counted_run *out, diagnostic *why)
{
    *out = (counted_run){.folder = ""};
    if (!request->instructions)
        return STATUS_OK;
    if (!has_valgrind())
        return options_wrong("--instructions", NULL, why,
                             "install it: apt-get install --no-install-recommends valgrind",
                             "valgrind is not installed");
    const char *below = getenv("TMPDIR");
    char path[256];
    snprintf(out->folder, sizeof out->folder, "%.150s/cuvette-instructions-XXXXXX", below && *below ? below : "/tmp");
    if (!mkdtemp(out->folder)) {
        const int error = errno;
        snprintf(path, sizeof path, "%s", out->folder);
        out->folder[0] = 0;
        return system_error(why, STATUS_FAILURE, path, "cannot be created", error, "set TMPDIR to another folder");
    }
    size_t length = strlen(request->results);
    while (length > 1 && request->results[length - 1] == '/')
        length--;
    snprintf(out->results, sizeof out->results, "%.*s-instructions", (int)(length < 4000 ? length : 4000),
             request->results);
    request->results = out->results;
    snprintf(path, sizeof path, "%s/frame", out->folder);
    setenv(INSTRUCTION_DUMPS_VARIABLE, path, 1);
    /* So that no frame counts the search for symbols, and each clears the memory that it uses: after the heap has
     * shrunk, the system would clear it, uncounted. */
    setenv("LD_BIND_NOW", "1", 1);
    setenv("GLIBC_TUNABLES", "glibc.malloc.trim_threshold=1073741824", 0);
#if defined(__x86_64__)
    setenv("CUVETTE_ISA", "avx2", 0); /* valgrind does not know AVX-512 */
    if (strcmp(getenv("CUVETTE_ISA"), "avx512") == 0)
        return options_wrong("--instructions", NULL, why, "set CUVETTE_ISA=avx2", "valgrind does not know AVX-512");
#endif
    return STATUS_OK;
}

void study_instructions_end(const counted_run *run)
{
    char name[300];
    if (!run->folder[0])
        return;
    snprintf(name, sizeof name, "%s/frame", run->folder);
    unlink(name);                     /* the counts after the last frame */
    for (long i = 1; i < 4096; i++) { /* frames that were not read: the program was interrupted */
        snprintf(name, sizeof name, "%s/frame.%ld", run->folder, i);
        unlink(name);
    }
    rmdir(run->folder);
}

/* Sets the words of a counted process's command line that precede the program, for /usr/bin/env; returns their number,
 * at most STUDY_INSTRUCTIONS_WORDS. option: memory for one of them. */
enum { STUDY_INSTRUCTIONS_WORDS = 8, STUDY_INSTRUCTIONS_OPTION = 300 };
static size_t study_instructions_words(const char **words, char option[STUDY_INSTRUCTIONS_OPTION])
{
    snprintf(option, STUDY_INSTRUCTIONS_OPTION, "--callgrind-out-file=%.256s", getenv(INSTRUCTION_DUMPS_VARIABLE));
    const char *const all[] = {"env", "valgrind", "-q", INSTRUCTION_DUMPS_OPTIONS, option};
    memcpy(words, all, sizeof all);
    return sizeof all / sizeof *all;
}

/* --- fresh processes --- */

enum { ARGUMENTS_MAX = 32 };

static char *study_against_folder(const study_request *request)
{
    return text_format("%s-against", request->results);
}

/* Waits for the program's end; forwards a cancellation once. */
static int wait_for_end(pid_t pid)
{
    int ended = 0;
    bool forwarded = false;
    for (;;) {
        const pid_t found = waitpid(pid, &ended, 0);
        if (found == pid)
            return WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
        if (found < 0 && errno != EINTR)
            return -1;
        if (!forwarded && cancel_asked()) {
            kill(pid, SIGTERM);
            forwarded = true;
        }
    }
}

static const char this_program[] = "/proc/self/exe";

static status ended(const study *s, const char *program, long process, int code, diagnostic *why)
{
    if (code == 0)
        return STATUS_OK;
    diagnostic_locate(why, s->path, 0, 0);
    if (code == 130 || cancel_asked())
        return diagnose(why, STATUS_INTERRUPTED, "run it again to resume", "interrupted; all completed rows are kept");
    return diagnose(why, code == 2 ? STATUS_BAD_INPUT : STATUS_FAILURE, "see its message above; rows so far are kept",
                    "process %ld of %s ended with status %d", process, program, code);
}

/* Runs one process of the study to its end. */
static status run_process(const study *s, const study_request *request, const char *program, const char *results,
                          long process, diagnostic *why)
{
    char number[32], processes[32], shard[64], wait[64], memory[48];
    const char *const fixed[] = {"study", "run", "--results", results, "--process", number, "--processes", processes};
    const char *arguments[ARGUMENTS_MAX] = {NULL};
    char option[STUDY_INSTRUCTIONS_OPTION];
    size_t count = request->instructions ? study_instructions_words(arguments, option) : 0;
    arguments[count++] = request->instructions ? program : "cuvette";
    memcpy(arguments + count, fixed, sizeof fixed);
    count += sizeof fixed / sizeof *fixed;
    snprintf(number, sizeof number, "%ld", process);
    snprintf(processes, sizeof processes, "%ld", s->processes);
    snprintf(shard, sizeof shard, "--shard=%ld/%ld", request->shard, request->shards);
    if (request->shards > 1)
        arguments[count++] = shard;
    if (request->by_repetition)
        arguments[count++] = "--by=repetition";
    snprintf(wait, sizeof wait, "--wait-quiet=%g", request->wait_quiet_s);
    if (request->wait_quiet_s > 0)
        arguments[count++] = wait;
    if (request->any_environment)
        arguments[count++] = "--any-environment";
    snprintf(memory, sizeof memory, "--memory-limit=%llu", (unsigned long long)memory_budget_limit());
    if (memory_budget_limit() > 0)
        arguments[count++] = memory;
    if (request->quick)
        arguments[count++] = "--quick";
    if (request->quiet)
        arguments[count++] = "--quiet";
    if (request->progress)
        arguments[count++] = "--progress";
    arguments[count++] = "--";
    arguments[count++] = s->path;
    pid_t pid = 0;
    char *copies[ARGUMENTS_MAX] = {NULL};
    memcpy(copies, arguments, sizeof copies);
    const char *started = request->instructions ? "/usr/bin/env" : program;
    const int error = spawn_bound(&pid, started, copies, STDOUT_FILENO, STDERR_FILENO);
    if (error && system_error(why, STATUS_BAD_INPUT, NULL, "cannot start a process", error, "") == STATUS_FAILURE)
        return STATUS_FAILURE;
    if (error)
        return options_wrong("--against", program, why, "give the path of a cuvette program", "cannot start it: %s",
                             strerrordesc_np(error));
    return ended(s, request->against && program == request->against ? program : "the study", process, wait_for_end(pid),
                 why);
}

/* Each process would repeat the notes of the previous one; instead, the disturbed rows of all are counted once per
 * minute. */
typedef struct disturbed_rows {
    size_t rows;
    double next_s;
} disturbed_rows;

static status note_disturbed(const study *s, const study_request *request, disturbed_rows *last, diagnostic *why)
{
    char text[300];
    study_progress now;
    if (request->quiet)
        return STATUS_OK;
    TRY(study_status(s, request->results, &now, why));
    const bool more = now.rows_disturbed > last->rows;
    last->rows = now.rows_disturbed;
    if (!more || clock_wall_s() < last->next_s)
        return STATUS_OK;
    last->next_s = clock_wall_s() + 60;
    snprintf(text, sizeof text,
             "%s: %zu of %zu rows are disturbed: see others_fraction, steal_fraction, frequency_drop and "
             "stalled_fraction in the "
             "rows; stop other programs, or measure with --wait-quiet",
             s->name, now.rows_disturbed, now.rows - now.warmups);
    terminal_note(text);
    return STATUS_OK;
}

status study_run_processes(const study *s, const study_request *request, diagnostic *why)
{
    char program[PATH_MAX];
    if (!request->instructions || !os_program_path(program)) /* under valgrind, /proc/self/exe is valgrind's */
        snprintf(program, sizeof program, "%s", this_program);
    char *against = request->against ? study_against_folder(request) : NULL;
    if (request->against && !against)
        return out_of_memory(why);
    study_progress before = {.rows_disturbed = 0};
    status code = study_status(s, request->results, &before, why);
    disturbed_rows disturbed = {.rows = before.rows_disturbed};
    for (long process = 1; process <= study_processes(s) && code == STATUS_OK; process++) {
        const bool other_first = against && random_at(s->seed, (uint32_t)process, 0, 0, 0).word[0] & 1;
        for (int turn = 0; turn < (against ? 2 : 1) && code == STATUS_OK; turn++)
            code = against && (turn == 0) == other_first
                       ? run_process(s, request, request->against, against, process, why)
                       : run_process(s, request, program, request->results, process, why);
        THEN(code, note_disturbed(s, request, &disturbed, why));
    }
    free(against);
    return code;
}
