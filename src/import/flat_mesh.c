/* The mesh of a file: its vertices, joined by a hash table keyed by their bits (open addressing with linear probing, at
 * most half full), its materials, and how it is written for the program that reads it. */
#include "import/flat_mesh.h"
#include "base/array.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

status no_memory_for(const request *req, diagnostic *why)
{
    if (!req->memory_mib)
        return out_of_memory(why);
    const bool large = req->memory_mib % 1024 == 0;
    return diagnose_at(why, req->path, STATUS_BAD_INPUT, "raise --memory-limit, or use a mesh with fewer triangles",
                       "the file needs more memory than the %llu %s that reading it may take",
                       (unsigned long long)(large ? req->memory_mib / 1024 : req->memory_mib), large ? "GiB" : "MiB");
}

/* --- vertices --- */

/* How many numbers of a vertex can differ from 0. */
static int numbers_used(const flat_mesh *flat)
{
    return flat->with_colors ? JOIN_NUMBERS : flat->with_normals || flat->with_uvs ? JOIN_COLOR : 3;
}

static void vertex_numbers(const flat_mesh *flat, uint32_t index, double numbers[JOIN_NUMBERS])
{
    vec3 p = flat->positions[index];
    vec3 n = flat->with_normals ? flat->normals[index] : vec3_make(0, 0, 0);
    double u = flat->with_uvs ? flat->uvs[index].u : 0, v = flat->with_uvs ? flat->uvs[index].v : 0;
    memcpy(numbers, (double[JOIN_COLOR]){p.x, p.y, p.z, n.x, n.y, n.z, u, v}, JOIN_COLOR * sizeof *numbers);
    for (int c = 0; c < 3; c++)
        numbers[JOIN_COLOR + c] = flat->with_colors ? (double)flat->colors[index][c] : 0;
}

uint64_t join_hash(const flat_mesh *flat, const double numbers[JOIN_NUMBERS])
{
    const int used = numbers_used(flat);
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < used; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu; /* MurmurHash3's finaliser, Appleby */
        hash ^= hash >> 32;
    }
    return hash;
}

void join_color(flat_mesh *flat, const double color[3], double numbers[JOIN_NUMBERS])
{
    for (int c = 0; c < 3; c++) {
        if (!flat->clamped && (color[c] > 1 || color[c] < 0)) {
            flat->clamped = true;
            flat_note(flat, "colours of vertices outside 0 to 1 are clamped");
        }
        numbers[JOIN_COLOR + c] = color[c] > 0 ? (double)(float)(color[c] < 1 ? color[c] : 1) : 0;
    }
}

void join_prefetch(const joiner *j, uint64_t hash)
{
    if (j->size)
        __builtin_prefetch(&j->table[hash & (j->size - 1)]);
}

static bool is_vertex(const flat_mesh *flat, uint32_t index, const double numbers[JOIN_NUMBERS])
{
    double other[JOIN_NUMBERS];
    if (memcmp(&flat->positions[index], numbers, sizeof *flat->positions) != 0)
        return false;
    if (numbers_used(flat) == 3)
        return true;
    vertex_numbers(flat, index, other);
    return memcmp(other, numbers, sizeof other) == 0;
}

/* The table index of the vertex with these numbers, or of the empty entry for it. Entries are index + 1; 0 is empty. */
static size_t find(const joiner *j, const flat_mesh *flat, const double numbers[JOIN_NUMBERS], uint64_t hash)
{
    size_t at = hash & (j->size - 1);
    while (j->table[at] && !is_vertex(flat, j->table[at] - 1, numbers))
        at = (at + 1) & (j->size - 1);
    return at;
}

static bool resize_table(joiner *j, const flat_mesh *flat, size_t size)
{
    joiner larger = {.size = size, .room = j->room};
    larger.table = large_calloc(larger.size, sizeof *larger.table);
    if (!larger.table)
        return false;
    for (size_t i = 0; i < flat->vertex_count; i++) {
        double numbers[JOIN_NUMBERS];
        vertex_numbers(flat, (uint32_t)i, numbers);
        larger.table[find(&larger, flat, numbers, join_hash(flat, numbers))] = (uint32_t)i + 1;
    }
    free(j->table);
    *j = larger;
    return true;
}

static void *resized(void *array, size_t room, size_t size)
{
    return large_pages(realloc(array, room * size), room * size);
}

static bool resize_arrays(joiner *j, flat_mesh *flat, size_t room)
{
    vec3 *positions = resized(flat->positions, room, sizeof *positions);
    flat->positions = positions ? positions : flat->positions;
    vec3 *normals = flat->with_normals ? resized(flat->normals, room, sizeof *normals) : NULL;
    flat->normals = normals ? normals : flat->normals;
    void *uvs = flat->with_uvs ? resized(flat->uvs, room, sizeof *flat->uvs) : NULL;
    flat->uvs = uvs ? uvs : flat->uvs;
    void *colors = flat->with_colors ? resized(flat->colors, room, sizeof *flat->colors) : NULL;
    flat->colors = colors ? colors : flat->colors;
    if (!positions || (flat->with_normals && !normals) || (flat->with_uvs && !uvs) || (flat->with_colors && !colors))
        return false;
    j->room = room;
    return true;
}

bool join_reserve(joiner *j, flat_mesh *flat, size_t count)
{
    if (count == 0)
        return true;
    size_t size = 1024;
    while (size < 2 * count)
        size *= 2;
    return resize_table(j, flat, size) && resize_arrays(j, flat, count);
}

status join_vertex(const request *req, joiner *j, flat_mesh *flat, const double numbers[JOIN_NUMBERS], uint64_t hash,
                   uint32_t *index, diagnostic *why)
{
    if (flat->vertex_count * 2 >= j->size && !resize_table(j, flat, j->size ? j->size * 2 : 1024))
        return no_memory_for(req, why);
    size_t at = find(j, flat, numbers, hash);
    if (j->table[at]) {
        *index = j->table[at] - 1;
        return STATUS_OK;
    }
    if (flat->vertex_count >= req->vertices)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail", "more vertices than the limit of %llu",
                        (unsigned long long)req->vertices);
    if (flat->vertex_count >= j->room && !resize_arrays(j, flat, j->room + j->room / 2 + 1024))
        return no_memory_for(req, why);
    *index = (uint32_t)flat->vertex_count++;
    j->table[at] = *index + 1;
    flat->positions[*index] = vec3_make(numbers[0], numbers[1], numbers[2]);
    if (flat->with_normals)
        flat->normals[*index] = vec3_make(numbers[3], numbers[4], numbers[5]);
    if (flat->with_uvs) {
        flat->uvs[*index].u = numbers[6];
        flat->uvs[*index].v = numbers[7];
    }
    for (int c = 0; flat->with_colors && c < 3; c++)
        flat->colors[*index][c] = (float)numbers[JOIN_COLOR + c];
    return STATUS_OK;
}

status join_vertices(const request *req, joiner *j, flat_mesh *flat, double (*numbers)[JOIN_NUMBERS], size_t count,
                     uint32_t *indices, diagnostic *why)
{
    uint64_t hashes[JOIN_BLOCK];
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < JOIN_COLOR; k++)
            numbers[i][k] += 0.0; /* -0 becomes 0 */
        hashes[i] = join_hash(flat, numbers[i]);
        join_prefetch(j, hashes[i]);
    }
    for (size_t i = 0; i < count; i++)
        TRY(join_vertex(req, j, flat, numbers[i], hashes[i], &indices[i], why));
    return STATUS_OK;
}

/* --- triangles and materials --- */

/* As in a diagnostic. */
static void replace_controls(char *text)
{
    for (char *c = text; *c; c++)
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
}

/* A copy of a name; NULL: none, or no memory. */
static char *name_copy(const char *name)
{
    char *copy = name ? strdup(name) : NULL;
    if (copy)
        replace_controls(copy);
    return copy;
}

void flat_release(flat_mesh *flat)
{
    free(flat->positions), free(flat->normals), free(flat->uvs), free(flat->colors);
    free(flat->triangles), free(flat->slots);
    for (unsigned i = 0; i < flat->material_count; i++)
        free(flat->materials[i].name), free(flat->materials[i].texture), free(flat->materials[i].glow);
    for (unsigned i = 0; i < flat->image_count; i++)
        free(flat->images[i].bytes);
    for (unsigned i = 0; i < flat->view_count; i++)
        free(flat->views[i].name);
    free(flat->views);
    free(flat->note);
    *flat = (flat_mesh){0};
}

status flat_reserve(const request *req, flat_mesh *flat, uint64_t count, diagnostic *why)
{
    if (count > req->triangles)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail", "more triangles than the limit of %llu",
                        (unsigned long long)req->triangles);
    if (count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "points and lines are ignored; use a file with faces",
                        "the file has no triangles");
    const size_t bytes = (size_t)count * sizeof *flat->triangles;
    flat->triangles = large_pages(malloc(bytes), bytes);
    flat->slots = malloc((size_t)count);
    return flat->triangles && flat->slots ? STATUS_OK : no_memory_for(req, why);
}

status flat_material(const request *req, flat_mesh *flat, const mesh_material *like, uint8_t *slot, diagnostic *why)
{
    if (flat->material_count == MESH_WIRE_SLOTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "merge equal materials", "more than %d materials are in use",
                        (int)MESH_WIRE_SLOTS_MAX);
    const mesh_material m = {.values = like->values,
                             .name = name_copy(like->name),
                             .texture = like->texture ? strdup(like->texture) : NULL,
                             .glow = like->glow ? strdup(like->glow) : NULL};
    *slot = (uint8_t)flat->material_count;
    flat->materials[flat->material_count++] = m;
    const bool complete = (!like->name || m.name) && (!like->texture || m.texture) && (!like->glow || m.glow);
    return complete ? STATUS_OK : no_memory_for(req, why);
}

void flat_image(flat_mesh *flat, unsigned char *bytes, size_t size, uint32_t *number)
{
    *number = 0;
    if (flat->image_count == MESH_WIRE_IMAGES_MAX) {
        free(bytes);
        return;
    }
    flat->images[flat->image_count] = (mesh_image){bytes, size};
    *number = ++flat->image_count;
}

status flat_view(const request *req, flat_mesh *flat, const mesh_wire_view *values, const char *name, diagnostic *why)
{
    if (flat->view_count == MESH_WIRE_VIEWS_MAX) {
        flat_note(flat, "only the first %d cameras and lights are read", (int)MESH_WIRE_VIEWS_MAX);
        return STATUS_OK;
    }
    if (!flat->views && !(flat->views = malloc(MESH_WIRE_VIEWS_MAX * sizeof *flat->views)))
        return no_memory_for(req, why);
    const mesh_view v = {*values, name_copy(name)};
    flat->views[flat->view_count++] = v;
    return !name || v.name ? STATUS_OK : no_memory_for(req, why);
}

void flat_note(flat_mesh *flat, const char *format, ...)
{
    char sentence[MESH_WIRE_TEXT_MAX + 1];
    va_list list;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    replace_controls(sentence);
    if (flat->note && strstr(flat->note, sentence))
        return;
    const size_t before = flat->note ? strlen(flat->note) + 2 : 0, length = before + strlen(sentence);
    char *all = length <= MESH_WIRE_TEXT_MAX ? malloc(length + 1) : NULL;
    if (!all)
        return;
    snprintf(all, length + 1, "%s%s%s", before ? flat->note : "", before ? "; " : "", sentence);
    free(flat->note);
    flat->note = all;
}

/* --- the wire format --- */

static size_t text_length(const char *text)
{
    return text ? strnlen(text, MESH_WIRE_TEXT_MAX) : 0;
}

static void write_materials(const flat_mesh *flat, FILE *to)
{
    for (unsigned i = 0; i < flat->material_count; i++) {
        const mesh_material *m = &flat->materials[i];
        mesh_wire_material record = m->values;
        record.name_length = (uint32_t)text_length(m->name);
        record.texture.path_length = (uint32_t)text_length(m->texture);
        record.glow.path_length = (uint32_t)text_length(m->glow);
        fwrite(&record, sizeof record, 1, to);
        if (m->name)
            fwrite(m->name, 1, record.name_length, to);
        if (m->texture)
            fwrite(m->texture, 1, record.texture.path_length, to);
        if (m->glow)
            fwrite(m->glow, 1, record.glow.path_length, to);
    }
}

static void write_images(const flat_mesh *flat, FILE *to)
{
    for (unsigned i = 0; i < flat->image_count; i++) {
        const uint64_t size = flat->images[i].size;
        fwrite(&size, sizeof size, 1, to);
        fwrite(flat->images[i].bytes, 1, flat->images[i].size, to);
    }
}

static void write_views(const flat_mesh *flat, FILE *to)
{
    for (unsigned i = 0; i < flat->view_count; i++) {
        mesh_wire_view record = flat->views[i].values;
        record.name_length = (uint32_t)text_length(flat->views[i].name);
        fwrite(&record, sizeof record, 1, to);
        if (flat->views[i].name)
            fwrite(flat->views[i].name, 1, record.name_length, to);
    }
}

status flat_write(const flat_mesh *flat, FILE *to, diagnostic *why)
{
    const mesh_wire_header header = {
        .magic = MESH_WIRE_MAGIC,
        .version = MESH_WIRE_VERSION,
        .vertex_count = flat->vertex_count,
        .triangle_count = flat->triangle_count,
        .flags = (flat->with_normals ? MESH_WIRE_NORMALS : 0u) | (flat->with_uvs ? MESH_WIRE_UVS : 0u) |
                 (flat->with_colors ? MESH_WIRE_COLORS | (flat->srgb ? MESH_WIRE_SRGB : 0u) : 0u),
        .material_count = flat->material_count,
        .note_length = (uint32_t)text_length(flat->note),
        .image_count = flat->image_count,
        .view_count = flat->view_count,
    };
    fwrite(&header, sizeof header, 1, to);
    fwrite(flat->positions, sizeof *flat->positions, flat->vertex_count, to);
    if (flat->with_normals)
        fwrite(flat->normals, sizeof *flat->normals, flat->vertex_count, to);
    if (flat->with_uvs)
        fwrite(flat->uvs, sizeof *flat->uvs, flat->vertex_count, to);
    if (flat->with_colors)
        fwrite(flat->colors, sizeof *flat->colors, flat->vertex_count, to);
    fwrite(flat->triangles, sizeof *flat->triangles, flat->triangle_count, to);
    fwrite(flat->slots, 1, flat->triangle_count, to);
    write_materials(flat, to);
    write_images(flat, to);
    write_views(flat, to);
    if (flat->note)
        fwrite(flat->note, 1, header.note_length, to);
    fwrite(MESH_WIRE_END, 1, sizeof MESH_WIRE_END - 1, to);
    if (fflush(to) != 0 || ferror(to)) {
        const char *reason = strerrordesc_np(errno);
        return diagnose_at(why, NULL, STATUS_FAILURE, "write to a pipe", "cannot write to standard output: %s",
                           reason ? reason : "unknown error");
    }
    return STATUS_OK;
}
