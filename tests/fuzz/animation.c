/* The fuzzer of the files next to an animation's frames: its progress index, and its table of rows. */
#include "cli/animate.h"
#include "fuzz.h"

static void read_index(void)
{
    char *pattern = fuzz_path("f%d.png"), *path = fuzz_path("f%d.png.json");
    animate_names names;
    must(animate_names_parse(pattern, &names, NULL) == STATUS_OK);
    animate_definition d = {.parameters = json_pack("{s:s,s:s}", "render.depth", "8", "animation.fps", "25"),
                            .hash = 7};
    const int64_t count = animate_index_count(path);
    must(count >= -1);
    for (int restart = 0; restart < 2; restart++) {
        diagnostic why = {.what = ""};
        const status code = animate_index_check(&names, &d, 3, restart == 1, &why);
        if (code != STATUS_OK)
            must_refuse(code, &why);
    }
    animate_definition_release(&d);
    animate_names_release(&names);
    free(pattern);
    free(path);
}

static void read_rows(void)
{
    char *path = fuzz_path("rows.csv");
    for (int restart = 0; restart < 2; restart++) {
        animate_rows *rows = NULL;
        diagnostic why = {.what = ""};
        const status code = animate_rows_open(path, 7, restart == 1, &rows, &why);
        if (code == STATUS_OK)
            animate_rows_have(rows, 1);
        else
            must_refuse(code, &why);
        animate_rows_close(rows);
    }
    free(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_part rest = {(const char *)data, size}, part;
    fuzz_next(&rest, &part);
    fuzz_write("f%d.png.json", part.at, part.size);
    fuzz_next(&rest, &part);
    fuzz_write("rows.csv", part.at, part.size);
    read_index();
    read_rows();
    return 0;
}
