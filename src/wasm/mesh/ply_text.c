/* PLY files: vertices with positions, normals and texture coordinates, and faces, as text or binary. Format: Greg Turk,
 * "The PLY Polygon File Format", 1994. */
#include "wasm/mesh/ply.h"

#include <stdlib.h>
#include <string.h>

/* The vertices that faces use, in the order of the file. */
static status join_vertices(ply *p)
{
    p->joined = malloc((p->vertex_count + 1) * sizeof *p->joined);
    if (!p->joined)
        return out_of_memory(p->why);
    memset(p->joined, 0, p->vertex_count * sizeof *p->joined);
    for (size_t f = 0; f < p->face_count; f++)
        for (size_t c = p->starts[f]; c < p->starts[f + 1]; c++) {
            if (p->corners[c] >= p->vertex_count)
                return diagnose(p->why, STATUS_BAD_INPUT, "repair the file or export it again",
                                "a face refers to vertex %u of %zu", p->corners[c], p->vertex_count);
            p->joined[p->corners[c]] |= p->starts[f + 1] - p->starts[f] >= 3;
        }
    for (size_t i = 0; i < p->vertex_count; i++)
        if (p->joined[i])
            TRY(mesh_parts_vertex(p->parts, p->vertices[i], &p->joined[i], p->why));
    return STATUS_OK;
}

/* The importer never begins two triangles at the same vertex one after the other, unless they are of one quadrilateral:
 * it begins the second one elsewhere. */
static void begin_elsewhere(const uint32_t *corners, uint32_t (*triangles)[3], size_t count, bool four, uint32_t *last)
{
    for (size_t t = 0; t < count; t += four ? 2 : 1) {
        uint32_t *a = triangles[t];
        if (corners[a[0]] == *last) {
            memcpy(a, (uint32_t[3]){a[2], a[0], a[1]}, 3 * sizeof *a);
            if (four) {
                uint32_t *b = triangles[t + 1];
                memcpy(b, (uint32_t[3]){b[1], b[2], b[0]}, 3 * sizeof *b);
            }
        }
        *last = corners[a[0]];
    }
}

static status build_face(ply *p, size_t f, bool polygons, float (*places)[3], uint32_t (*triangles)[3], uint32_t *last)
{
    const uint32_t *corners = p->corners + p->starts[f];
    const size_t size = p->starts[f + 1] - p->starts[f];
    size_t count = 1;
    if (size < 3)
        return STATUS_OK;
    if (size > POLYGON_MAX)
        return diagnose(p->why, STATUS_BAD_INPUT, "divide it into triangles", "a face has more than 4096 corners");
    memcpy(triangles[0], (uint32_t[3]){0, 1, 2}, sizeof *triangles);
    for (size_t i = 0; i < size; i++)
        for (int k = 0; k < 3; k++)
            places[i][k] = (float)p->vertices[corners[i]][k];
    if (size > 3)
        count = polygon_divide((const float(*)[3])places, size, triangles);
    if (polygons)
        begin_elsewhere(corners, triangles, count, size == 4, last);
    for (size_t t = 0; t < count; t++) {
        uint32_t own[3];
        for (int k = 0; k < 3; k++)
            own[k] = p->joined[corners[triangles[t][k]]];
        TRY(mesh_parts_triangle(p->parts, own, 0, p->why));
    }
    return STATUS_OK;
}

static status build(ply *p)
{
    bool polygons = false;
    uint32_t last = UINT32_MAX;
    for (size_t f = 0; f < p->face_count; f++)
        polygons |= p->starts[f + 1] - p->starts[f] > 3;
    TRY(join_vertices(p));
    float(*places)[3] = malloc(POLYGON_MAX * sizeof *places);
    uint32_t(*triangles)[3] = malloc(POLYGON_MAX * sizeof *triangles);
    status code = places && triangles ? STATUS_OK : out_of_memory(p->why);
    for (size_t f = 0; f < p->face_count && code == STATUS_OK; f++)
        code = build_face(p, f, polygons, places, triangles, &last);
    free(places), free(triangles);
    return code;
}

status ply_read_text(const char *text, size_t size, mesh_parts *parts, diagnostic *why)
{
    ply *p = calloc(1, sizeof *p);
    if (!p)
        return out_of_memory(why);
    p->text = (lines){.at = text, .end = text + size};
    p->parts = parts;
    p->why = why;
    status code = ply_header(p);
    if (code == STATUS_OK) {
        p->text.word = p->text.line_end = p->text.at;
        code = ply_body(p);
    }
    THEN(code, build(p));
    free(p->vertices), free(p->joined), free(p->starts), free(p->corners);
    free(p);
    return code;
}
