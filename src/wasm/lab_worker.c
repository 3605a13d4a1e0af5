/* The laboratory of a module: start, turns, and the answers of its tile workers; and, for the scripts of all workers,
 * the last error and the name of the instruction set. */
#include "base/isa.h"
#include "wasm/exports.h"
#include "wasm/worker.h"
#include "web/lab.h"

#include <string.h>

static char text[2048];

int trouble_note(status code, const diagnostic *why)
{
    if (code != STATUS_OK)
        diagnostic_text(why, text, sizeof text);
    return (int)code;
}

const char *wasm_why(void)
{
    return text;
}

const char *wasm_isa(void)
{
    return isa_name(isa_best());
}

int wasm_lab_start(const char *folder, const char *scene, int workers)
{
    static char folder_copy[256], scene_copy[512];
    lab *server = NULL;
    diagnostic why = {.line = 0};
    strncpy(folder_copy, folder, sizeof folder_copy - 1);
    strncpy(scene_copy, scene, sizeof scene_copy - 1);
    render_turns_set_workers(workers);
    const lab_settings settings = {
        .folder = folder_copy, .scene = *scene_copy ? scene_copy : NULL, .results = folder_copy, .level = isa_best()};
    return trouble_note(lab_start(&settings, &server, &why), &why);
}

double wasm_lab_turn(void)
{
    return render_turns_run();
}

void wasm_lab_lost(int worker)
{
    render_turns_lost(worker);
}

void wasm_lab_traced(int worker, const void *bytes, size_t size)
{
    render_turns_traced(worker, bytes, size);
}
