#include "cli/study_instructions.h"
#include "base/isa.h"
#include "base/status.h"
#include "cli/options.h"
#include "measure/instruction_dumps.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
        return options_wrong("--instructions", NULL, why, "apt-get install --no-install-recommends valgrind",
                             "valgrind is not installed");
    const char *below = getenv("TMPDIR");
    char path[256];
    snprintf(out->folder, sizeof out->folder, "%.150s/cuvette-instructions-XXXXXX", below && *below ? below : "/tmp");
    if (!mkdtemp(out->folder)) {
        const int error = errno;
        snprintf(path, sizeof path, "%s", out->folder);
        out->folder[0] = 0;
        return system_error(why, STATUS_FAILURE, path, "cannot be made", error, "set TMPDIR to another folder");
    }
    size_t length = strlen(request->results);
    while (length > 1 && request->results[length - 1] == '/')
        length--;
    snprintf(out->results, sizeof out->results, "%.*s-instructions", (int)(length < 4000 ? length : 4000),
             request->results);
    request->results = out->results;
    snprintf(path, sizeof path, "%s/frame", out->folder);
    setenv(INSTRUCTION_DUMPS_VARIABLE, path, 1);
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
    unlink(name);                     /* what followed the last frame */
    for (long i = 1; i < 4096; i++) { /* frames that were not read: the program was interrupted */
        snprintf(name, sizeof name, "%s/frame.%ld", run->folder, i);
        unlink(name);
    }
    rmdir(run->folder);
}

size_t study_instructions_words(const char **words, char option[STUDY_INSTRUCTIONS_OPTION])
{
    snprintf(option, STUDY_INSTRUCTIONS_OPTION, "--callgrind-out-file=%.256s", getenv(INSTRUCTION_DUMPS_VARIABLE));
    const char *const all[] = {"env", "valgrind", "-q", INSTRUCTION_DUMPS_OPTIONS, option};
    memcpy(words, all, sizeof all);
    return sizeof all / sizeof *all;
}
