/* The fuzzer of the lists of runs: a file for the list of the study, one for that of a shard. */
#include "study/rows/runs.h"
#include "fuzz.h"

static void read_runs(void)
{
    run_list *all = NULL;
    diagnostic why = {.what = ""};
    const status code = runs_read(fuzz_folder(), NULL, &all, &why);
    if (code != STATUS_OK) {
        must(!all && why.file[0]);
        must_refuse(code, &why);
        return;
    }
    for (size_t i = 0; i < all->count; i++) {
        run_seal seal;
        const long at = runs_find(all, all->entry[i].id);
        must(at >= 0 && (size_t)at <= i);
        for (int k = 0; k < 3; k++)
            runs_seal(&all->entry[i], (const char *const[]){"rows", "workers", "compare"}[k], &seal);
    }
    runs_destroy(all);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"runs.json", "runs.shard-0-of-2.json"};
    fuzz_part rest = {(const char *)data, size}, part;
    for (int i = 0; i < 2; i++) {
        const bool is_there = fuzz_next(&rest, &part);
        fuzz_write(names[i], is_there ? part.at : "{\"runs\": []}", is_there ? part.size : 12);
    }
    read_runs();
    return 0;
}
