/* The laboratory of a module: start, turns, and the answers of its tile workers. And for scripts of any worker: the
 * last error and the name of the instruction set. */
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
    static char own_folder[256], own_scene[512];
    lab *own = NULL;
    diagnostic why = {.line = 0};
    strncpy(own_folder, folder, sizeof own_folder - 1);
    strncpy(own_scene, scene, sizeof own_scene - 1);
    render_turns_set_workers(workers);
    const lab_settings settings = {
        .folder = own_folder, .scene = *own_scene ? own_scene : NULL, .results = own_folder, .level = isa_best()};
    return trouble_note(lab_start(&settings, &own, &why), &why);
}

double wasm_lab_turn(void)
{
    return render_turns_take();
}

void wasm_lab_lost(int worker)
{
    render_turns_lost(worker);
}

void wasm_lab_traced(int worker, const void *bytes, size_t size)
{
    render_turns_traced(worker, bytes, size);
}
