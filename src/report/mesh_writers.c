/* Describes a mesh (counts, bounds, area, volume or first hole, memory), and writes it as Wavefront OBJ, raw numbers
 * or binary PLY. */
#include "report/mesh_writers.h"
#include "base/cancel.h"
#include "base/number.h"
#include "report/json.h"
#include <string.h>

/* --- description --- */

/* Size of the mesh's arrays. */
static size_t memory_bytes(const mesh *m)
{
    const size_t by_vertex =
        sizeof *m->vertices + (m->normals ? sizeof *m->normals : 0) + (m->uvs ? sizeof *m->uvs : 0);
    return m->vertex_count * by_vertex + m->triangle_count * (sizeof *m->triangles + (m->slots ? 1 : 0));
}

static void print_vector(FILE *stream, const char *name, vec3 v)
{
    char x[NUMBER_TEXT_MAX], y[NUMBER_TEXT_MAX], z[NUMBER_TEXT_MAX];
    fprintf(stream, "%-10s %s %s %s\n", name, number_format_digits(v.x, 9, x), number_format_digits(v.y, 9, y),
            number_format_digits(v.z, 9, z));
}

static void print_hole(FILE *stream, const mesh *m)
{
    const mesh_hole *h = &m->hole;
    if (m->triangle_count == 0)
        fputs("closed     no: it has points only\n", stream);
    else if (h->sharing == 0)
        fputs("closed     no: every triangle has zero area\n", stream);
    else if (h->sharing == 2)
        fprintf(stream, "closed     no: inconsistent orientation at the edge from vertex %lu to %lu of triangle %zu\n",
                (unsigned long)h->from, (unsigned long)h->to, h->triangle);
    else
        fprintf(stream, "closed     no: the edge from vertex %lu to %lu of triangle %zu is shared by %d, not 2\n",
                (unsigned long)h->from, (unsigned long)h->to, h->triangle, h->sharing);
}

void mesh_rows_text(FILE *stream, const mesh *m)
{
    char number[NUMBER_TEXT_MAX];
    fprintf(stream, "triangles  %zu\nvertices   %zu\n", m->triangle_count, m->vertex_count);
    if (m->bounds.low.x <= m->bounds.high.x) {
        print_vector(stream, "from", m->bounds.low);
        print_vector(stream, "to", m->bounds.high);
    }
    fprintf(stream, "area       %s\n", number_format_digits(mesh_area(m), 12, number));
    if (m->closed)
        fprintf(stream, "closed     yes\nvolume     %s\n", number_format_digits(mesh_volume(m), 12, number));
    else
        print_hole(stream, m);
    fprintf(stream, "has       %s%s%s positions\n", m->normals ? " normals," : "",
            m->uvs ? " texture coordinates," : "", m->single ? " single-precision" : " double-precision");
    if (m->slot_count > 1)
        fprintf(stream, "materials  %d\n", m->slot_count);
    fprintf(stream, "memory     %s MB\n", number_format_digits((double)memory_bytes(m) / 1e6, 4, number));
}

static json_t *vector_json(vec3 v)
{
    return json_pack("[o,o,o]", json_of_real(v.x), json_of_real(v.y), json_of_real(v.z));
}

static json_t *hole_json(const mesh *m)
{
    const mesh_hole *h = &m->hole;
    if (m->closed || h->sharing == 0)
        return json_null();
    return json_pack("{s:I,s:I,s:I,s:i}", "from", (json_int_t)h->from, "to", (json_int_t)h->to, "triangle",
                     (json_int_t)h->triangle, "sharing", h->sharing);
}

json_t *mesh_rows_json(const mesh *m)
{
    return json_pack("{s:i,s:I,s:I,s:o,s:o,s:o,s:b,s:o,s:o,s:b,s:b,s:b,s:i,s:I}", "schema", 1, "triangles",
                     (json_int_t)m->triangle_count, "vertices", (json_int_t)m->vertex_count, "low",
                     vector_json(m->bounds.low), "high", vector_json(m->bounds.high), "area",
                     json_of_real(mesh_area(m)), "closed", m->closed, "volume",
                     json_of_real(m->closed ? mesh_volume(m) : (double)NAN), "hole", hole_json(m), "normals",
                     m->normals != NULL, "texture_coordinates", m->uvs != NULL, "single", m->single, "materials",
                     m->slot_count, "bytes", (json_int_t)memory_bytes(m));
}

/* --- formats of other programs --- */

const char *mesh_format_name(mesh_format format)
{
    static const char *const names[MESH_FORMAT_COUNT] = {"obj", "bin", "ply"};
    return names[format];
}

static vec3 mirrored_if(bool mirrored, vec3 v)
{
    return mirrored ? vec3_make(v.x, v.y, 0.0 - v.z) : v;
}

/* The corner of a triangle that is written as number k: a mirror exchanges the last two (mesh_mirror). */
static uint32_t corner_if(bool mirrored, const mesh_triangle *t, int k)
{
    return t->corner[mirrored && k > 0 ? 3 - k : k];
}

static void write_obj(const mesh *m, bool mirrored, FILE *stream)
{
    const int digits = m->single ? 9 : 17;
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        const vec3 p = mirrored_if(mirrored, m->vertices[v]);
        fprintf(stream, "v %.*g %.*g %.*g\n", digits, p.x, digits, p.y, digits, p.z);
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        const mesh_triangle *one = &m->triangles[t];
        fprintf(stream, "f %lu %lu %lu\n", corner_if(mirrored, one, 0) + 1ul, corner_if(mirrored, one, 1) + 1ul,
                corner_if(mirrored, one, 2) + 1ul);
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
            put_vector(m->vertices[m->triangles[t].corner[k]], m->single, stream);
}

static void write_ply(const mesh *m, bool mirrored, FILE *stream)
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
        put_vector(mirrored_if(mirrored, m->vertices[v]), m->single, stream);
        if (m->normals)
            put_vector(mirrored_if(mirrored, m->normals[v]), m->single, stream);
        if (m->uvs) {
            put_real(m->uvs[v].u, m->single, stream);
            put_real(m->uvs[v].v, m->single, stream);
        }
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        putc(3, stream);
        for (int k = 0; k < 3; k++)
            put_bits(corner_if(mirrored, &m->triangles[t], k), 4, stream);
        if (m->slots)
            putc(m->slots[t], stream);
    }
}

void mesh_write(const mesh *m, mesh_format format, bool mirrored, FILE *stream)
{
    switch (format) {
    case MESH_OBJ: write_obj(m, mirrored, stream); return;
    case MESH_BIN: write_bin(m, stream); return;
    case MESH_PLY: write_ply(m, mirrored, stream); return;
    case MESH_FORMAT_COUNT: return;
    }
}
