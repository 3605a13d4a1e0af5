/* The libFuzzer entry for texts of points: any bytes give points or one located error. The points of an accepted text
 * are finite and within their bounds. `make fuzz` builds and runs it. */
#include "scene/assets/mesh_stream.h"

#include "fuzz.h"
#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    mesh_import *got;
    diagnostic why = {.what = ""};
    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = 0;
    const status code = mesh_points_parse("fuzz.xyz", text, size, false, &got, &why);
    free(text);
    if (code != STATUS_OK) {
        must_refuse(code, &why);
        must(!got && why.line >= 1 && why.column >= 1 && why.remedy[0]);
        return 0;
    }
    const bounds3 b = got->mesh->bounds;
    for (size_t i = 0; i < got->mesh->vertex_count; i++) {
        const vec3 p = got->mesh->vertices[i];
        must(fabs(p.x) <= 1e6 && p.x >= b.low.x && p.y >= b.low.y && p.z >= b.low.z && p.x <= b.high.x &&
             p.y <= b.high.y && p.z <= b.high.z);
    }
    mesh_import_destroy(got);
    return 0;
}
