/* The libFuzzer entry for files of optical data; the first byte chooses the kind of file. Any bytes give data or one
 * error with a remedy. Data that are accepted have finite values at every wavelength, and an n of a law above 0 in its
 * range. */
#include "scene/data/optical_files.h"

#include "fuzz.h"
#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"fuzz.yml", "fuzz.agf", "fuzz.csv"};
    static const char *const glasses[] = {"", "", "n-bk7"};
    if (size == 0)
        return 0;
    char *text = malloc(size);
    const optical_data *d;
    diagnostic why = {.what = ""};
    if (!text)
        return 0;
    memcpy(text, data + 1, size - 1);
    text[size - 1] = 0;
    const optical_file_choice of = {glasses[data[0] / 3 % 3], "", 1.0};
    const status code = optical_file_parse(names[data[0] % 3], text, size - 1, &of, &d, &why);
    free(text);
    if (code != STATUS_OK) {
        must_refuse(code, &why);
        must(!d && why.remedy[0]);
        return 0;
    }
    double low_nm, high_nm;
    optical_data_range(d, &low_nm, &high_nm);
    must(low_nm > 0.0 && low_nm <= high_nm && isfinite(high_nm));
    for (int nm = 100; nm <= 3000; nm += 100) {
        must(optical_data_k(d, nm) >= 0.0 && isfinite(optical_data_k(d, nm)));
        must(!optical_data_has_first(d) || isfinite(optical_data_at(d, nm)));
        must(!optical_data_has_first(d) || optical_data_emission(d, nm) >= 0.0);
    }
    optical_data_release(d);
    return 0;
}
