/* The libFuzzer entry for lens files; the first byte chooses the kind of file. Any bytes give a prescription or one
 * error with a remedy; a prescription that is accepted becomes a scene, or is refused with a remedy, and can be
 * written. */
#include "scene/lens/lens_prescription.h"

#include "fuzz.h"
#include <math.h>

static void must_write(const lens_prescription *p, const char *name)
{
    FILE *out = fopen("/dev/null", "w");
    diagnostic why = {.what = ""};
    if (out && lens_file_write(p, name, out, &why) != STATUS_OK)
        must(why.remedy[0]);
    if (out)
        fclose(out);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"fuzz.zmx", "fuzz.dat", "fuzz.csv"};
    if (size == 0)
        return 0;
    lens_prescription p;
    diagnostic why = {.what = ""};
    const char *name = names[data[0] % 3];
    const status code = lens_file_parse(name, (const char *)data + 1, size - 1, NULL, &p, &why);
    if (code != STATUS_OK) {
        must_refuse(code, &why);
        must(!p.surface && why.remedy[0]);
        return 0;
    }
    must(p.count > 0 && p.field_count > 0 && p.wavelength_count > 0 && p.primary < p.wavelength_count);
    must_write(&p, "a.zmx");
    must_write(&p, "a.csv");
    must_write(&p, "a.dat");
    scene *s = NULL;
    if (lens_scene_create(&p, NULL, &s, &why) != STATUS_OK)
        must(why.remedy[0]);
    scene_destroy(s);
    lens_prescription_release(&p);
    return 0;
}
