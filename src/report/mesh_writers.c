/* Describes a mesh (counts, bounds, area, volume or first hole, memory), and writes it as Wavefront OBJ, binary PLY,
 * or GLB (glb.c). */
#include "report/mesh_writers.h"
#include "base/cancel.h"
#include "base/number.h"
#include "image/image.h"
#include "report/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- description --- */

/* Size of the mesh's arrays. */
static size_t memory_bytes(const mesh *m)
{
    const size_t by_vertex = sizeof *m->vertices + (m->normals ? sizeof *m->normals : 0) +
                             (m->uvs ? sizeof *m->uvs : 0) + (m->colors ? sizeof *m->colors : 0);
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
    static const char *const faults[MESH_FAULT_COUNT] = {
        [MESH_ODD] = "", /* see below */
        [MESH_ONE_SIDED] = "inconsistent orientation at",
        [MESH_UNBALANCED] = "triangles do not agree about the inside at",
        [MESH_CANCELLED] = "each triangle lies on one that faces the other way, as at"};
    const mesh_hole *h = &m->hole;
    if (m->triangle_count == 0 || h->fault == MESH_FLAT) {
        fprintf(stream, "closed     no: %s\n",
                m->triangle_count ? "every triangle has zero area" : "it has points only");
        return;
    }
    fprintf(stream, "closed     no: %s%sthe edge from vertex %lu to %lu of triangle %zu", faults[h->fault],
            h->fault == MESH_ODD ? "" : " ", (unsigned long)h->from, (unsigned long)h->to, h->triangle);
    if (h->fault != MESH_ONE_SIDED)
        fprintf(stream, h->fault == MESH_ODD ? " is shared by %d, not %s" : ", which %d share%s", h->sharing,
                h->fault != MESH_ODD ? ""
                : h->sharing == 1    ? "2"
                                     : "an even number");
    putc('\n', stream);
}

void mesh_rows_text(FILE *stream, const mesh *m, const char *refusal)
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
    if (m->shell_count > 1 || m->crowded)
        fprintf(stream, "shells     %zu\n", m->shell_count);
    if (refusal)
        fprintf(stream, "solid      no: %s\n", refusal);
    fprintf(stream, "has       %s%s%s%s positions\n", m->normals ? " normals," : "",
            m->uvs ? " texture coordinates," : "", m->colors ? " colours," : "",
            m->single ? " single-precision" : " double-precision");
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
    if (m->closed || h->fault == MESH_FLAT)
        return json_null();
    return json_pack("{s:I,s:I,s:I,s:i}", "from", (json_int_t)h->from, "to", (json_int_t)h->to, "triangle",
                     (json_int_t)h->triangle, "sharing", h->sharing);
}

json_t *mesh_rows_json(const mesh *m, const char *refusal)
{
    return json_pack("{s:i,s:I,s:I,s:o,s:o,s:o,s:b,s:o,s:o,s:I,s:s?,s:b,s:b,s:b,s:b,s:i,s:I}", "schema", 1, "triangles",
                     (json_int_t)m->triangle_count, "vertices", (json_int_t)m->vertex_count, "low",
                     vector_json(m->bounds.low), "high", vector_json(m->bounds.high), "area",
                     json_of_real(mesh_area(m)), "closed", m->closed, "volume",
                     json_of_real(m->closed ? mesh_volume(m) : (double)NAN), "hole", hole_json(m), "shells",
                     (json_int_t)m->shell_count, "refusal", refusal, "normals", m->normals != NULL,
                     "texture_coordinates", m->uvs != NULL, "colors", m->colors != NULL, "single", m->single,
                     "materials", m->slot_count, "bytes", (json_int_t)memory_bytes(m));
}

/* --- formats of other programs --- */

const char *mesh_format_name(mesh_format format)
{
    static const char *const names[MESH_FORMAT_COUNT] = {"obj", "ply", "glb"};
    return names[format];
}

/* A component of a vertex's colour as OBJ and PLY files have it, in sRGB. */
static float encoded_color(const mesh *m, size_t v, int c)
{
    return (float)srgb_encode((double)m->colors[v][c]);
}

/* Whether bytes represent all colours exactly. */
static bool has_byte_colors(const mesh *m)
{
    bool exact = true;
    for (size_t i = 0; exact && i < 3 * m->vertex_count && !cancel_asked_at(i); i++) {
        const float value = m->colors[i / 3][i % 3], byte = rintf(255.0f * encoded_color(m, i / 3, (int)(i % 3)));
        const float decoded = (float)srgb_decode((double)(float)((double)byte / 255.0));
        exact = memcmp(&decoded, &value, sizeof value) == 0;
    }
    return exact;
}

static void write_obj(const mesh *m, bool mirrored, FILE *stream)
{
    const int digits = m->single ? 9 : 17;
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        const vec3 p = mirrored_if(mirrored, m->vertices[v]);
        fprintf(stream, "v %.*g %.*g %.*g", digits, p.x, digits, p.y, digits, p.z);
        for (int c = 0; m->colors && c < 3; c++)
            fprintf(stream, " %.9g", (double)encoded_color(m, v, c));
        putc('\n', stream);
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        const mesh_triangle *one = &m->triangles[t];
        fprintf(stream, "f %lu %lu %lu\n", corner_if(mirrored, one, 0) + 1ul, corner_if(mirrored, one, 1) + 1ul,
                corner_if(mirrored, one, 2) + 1ul);
    }
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
    const bool bytes = m->colors && has_byte_colors(m);
    const char *of_color = bytes ? "uchar" : "float";
    if (m->colors)
        fprintf(stream, "property %s red\nproperty %s green\nproperty %s blue\n", of_color, of_color, of_color);
    fprintf(stream, "element face %zu\nproperty list uchar int vertex_indices\n%send_header\n", m->triangle_count,
            m->slots ? "property uchar material_index\n" : "");
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        put_real_vector(mirrored_if(mirrored, m->vertices[v]), m->single, stream);
        if (m->normals)
            put_real_vector(mirrored_if(mirrored, m->normals[v]), m->single, stream);
        if (m->uvs) {
            put_real(m->uvs[v].u, m->single, stream);
            put_real(m->uvs[v].v, m->single, stream);
        }
        for (int c = 0; m->colors && c < 3; c++) {
            const float color = encoded_color(m, v, c);
            if (bytes)
                putc((int)rintf(255.0f * color), stream);
            else
                put_real((double)color, true, stream);
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

double mesh_rounding(const mesh *m)
{
    double most = 0.0;
    for (size_t v = 0; !m->single && v < m->vertex_count; v++) {
        const vec3 p = m->vertices[v];
        most = fmax(most, fmax(fabs((double)(float)p.x - p.x),
                               fmax(fabs((double)(float)p.y - p.y), fabs((double)(float)p.z - p.z))));
    }
    return most;
}

status mesh_write(const mesh *m, const mesh_import *looks, mesh_format format, bool mirrored, const char *path,
                  FILE *stream, diagnostic *why)
{
    switch (format) {
    case MESH_OBJ: write_obj(m, mirrored, stream); return STATUS_OK;
    case MESH_PLY: write_ply(m, mirrored, stream); return STATUS_OK;
    case MESH_GLB: return glb_write_mesh(m, looks, mirrored, path, stream, why);
    case MESH_FORMAT_COUNT: break;
    }
    return STATUS_OK;
}
