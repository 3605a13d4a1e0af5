/* Writers of meshes: Wavefront OBJ, raw floats, binary PLY. */
#include "base/cancel.h"
#include "report/mesh_write.h"

#include <string.h>

const char *mesh_format_name(mesh_format format)
{
    static const char *const names[MESH_FORMAT_COUNT] = {"obj", "bin", "ply"};
    return names[format];
}

static void write_obj(const mesh *m, FILE *stream)
{
    const int digits = m->single ? 9 : 17;
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        const vec3 p = m->vertices[v];
        fprintf(stream, "v %.*g %.*g %.*g\n", digits, p.x, digits, p.y, digits, p.z);
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        const uint32_t *corner = m->triangles[t].corner;
        fprintf(stream, "f %lu %lu %lu\n", corner[0] + 1ul, corner[1] + 1ul, corner[2] + 1ul);
    }
}

/* Little-endian on every machine. */
static void put_bits(uint64_t bits, int bytes, FILE *stream)
{
    for (int k = 0; k < bytes; k++)
        putc((int)(bits >> 8 * k & 0xff), stream);
}

static void put_real(double x, bool single, FILE *stream)
{
    const float narrow = (float)x;
    uint32_t bits32;
    uint64_t bits64;
    memcpy(&bits32, &narrow, sizeof bits32);
    memcpy(&bits64, &x, sizeof bits64);
    put_bits(single ? bits32 : bits64, single ? 4 : 8, stream);
}

static void put_vector(vec3 v, bool single, FILE *stream)
{
    put_real(v.x, single, stream);
    put_real(v.y, single, stream);
    put_real(v.z, single, stream);
}

static void write_bin(const mesh *m, FILE *stream)
{
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++)
        for (int k = 0; k < 3; k++)
            put_vector(m->vertices[m->triangles[t].corner[k]], true, stream);
}

static void write_ply(const mesh *m, FILE *stream)
{
    const char *real = m->single ? "float" : "double";
    fprintf(stream, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n", m->vertex_count);
    fprintf(stream, "property %s x\nproperty %s y\nproperty %s z\n", real, real, real);
    if (m->normals)
        fprintf(stream, "property %s nx\nproperty %s ny\nproperty %s nz\n", real, real, real);
    if (m->uvs)
        fprintf(stream, "property %s s\nproperty %s t\n", real, real);
    fprintf(stream, "element face %zu\nproperty list uchar int vertex_indices\n%send_header\n", m->triangle_count,
            m->slots ? "property uchar material_index\n" : "");
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        put_vector(m->vertices[v], m->single, stream);
        if (m->normals)
            put_vector(m->normals[v], m->single, stream);
        if (m->uvs) {
            put_real(m->uvs[v].u, m->single, stream);
            put_real(m->uvs[v].v, m->single, stream);
        }
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        putc(3, stream);
        for (int k = 0; k < 3; k++)
            put_bits(m->triangles[t].corner[k], 4, stream);
        if (m->slots)
            putc(m->slots[t], stream);
    }
}

void mesh_write(const mesh *m, mesh_format format, FILE *stream)
{
    switch (format) {
    case MESH_OBJ: write_obj(m, stream); return;
    case MESH_BIN: write_bin(m, stream); return;
    case MESH_PLY: write_ply(m, stream); return;
    case MESH_FORMAT_COUNT: return;
    }
}
