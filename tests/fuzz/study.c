/* The libFuzzer entry for the study reader: any bytes give a study or one located error; an accepted study provides the
 * scene of every cell, an accepted fit that of its start. The scenes that it may name are those of experiments/scenes.
 * `make fuzz` builds and runs it; seeds are experiments/ and tests/bad/studies/. */
#include "study/study.h"
#include "study/fit/fit.h"

#include "fuzz.h"

static void read_fit(const uint8_t *data, size_t size)
{
    double x[FIT_PARAMETERS_MAX];
    diagnostic why = {0};
    fit *f = NULL;
    const status code = fit_read_text("experiments/fuzz.study", (const char *)data, size, &f, &why);
    if (code == STATUS_OK) {
        scene *start = NULL;
        for (size_t i = 0; i < f->parameter_count; i++)
            x[i] = f->parameters[i].start;
        if (fit_scene(f, x, 0, &start, NULL) != STATUS_OK && start)
            __builtin_trap();
        scene_destroy(start);
    } else if (f || !why.what[0] || (code == STATUS_BAD_INPUT && !why.file[0])) {
        __builtin_trap();
    }
    fit_destroy(f);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    diagnostic why = {0};
    study *s = NULL;
    status code = study_read_text("experiments/fuzz.study", (const char *)data, size, &s, &why);
    if (code == STATUS_OK) {
        size_t count = study_cell_count(s);
        size_t cells[] = {0, count / 2, count - 1};
        for (size_t i = 0; i < 3; i++) {
            scene *setting;
            if (study_cell_scene(s, cells[i], &setting, NULL) != STATUS_OK)
                __builtin_trap();
            scene_destroy(setting);
        }
    } else if (s || !why.what[0] || (code == STATUS_BAD_INPUT && !why.file[0])) {
        __builtin_trap();
    }
    study_destroy(s);
    read_fit(data, size);
    return 0;
}
