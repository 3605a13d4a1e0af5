/* The libFuzzer entry for the importer's reply: any bytes are a reply. A mesh that is accepted must be valid: all
 * values finite, and every index in range. */
#include "scene/assets/mesh_stream.h"

#include "fuzz.h"
#include <math.h>

static void check(const mesh_import *got)
{
    const mesh *m = got->mesh;
    must(m->triangle_count <= 10000 && m->vertex_count <= 10000 && got->material_count >= 1 &&
         got->material_count == m->slot_count);
    for (size_t t = 0; t < m->triangle_count; t++) {
        must(m->slots[t] < got->material_count);
        for (int k = 0; k < 3; k++)
            must(m->triangles[t].corner[k] < m->vertex_count);
    }
    for (size_t i = 0; i < m->vertex_count; i++) {
        must(vec3_length(m->vertices[i]) < 2e9); /* false for NaN */
        must(!m->normals || fabs(vec3_length(m->normals[i]) - 1) < 1e-9);
        must(!m->uvs || (isfinite(m->uvs[i].u) && isfinite(m->uvs[i].v)));
    }
    for (int i = 0; i < got->material_count; i++) {
        const imported_material *a = &got->materials[i];
        must(a->opacity >= 0 && a->opacity <= 1 && a->shininess >= 0 && a->color[0] >= 0 && isfinite(a->ior));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mesh_limits limits = {.triangles = 10000, .vertices = 10000};
    mesh_import *got;
    diagnostic why = {.what = ""};
    status code = mesh_stream_read_bytes(data, size, &limits, &got, &why);
    if (code == STATUS_OK) {
        check(got);
        mesh_import_destroy(got);
    } else {
        must(code == STATUS_BAD_INPUT && !got && why.what[0]);
    }
    return 0;
}
