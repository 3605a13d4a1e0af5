/* Reads OBJ files: parses parts of the text in parallel, joins the vertices, and divides the faces into triangles. The
 * result does not depend on how the text is divided. */
#include "import/obj.h"
#include "base/array.h"
#include "base/os_process.h"
#include "base/worker_pool.h"
#include <stdlib.h>
#include <string.h>

enum {
    PARTS_MAX = 8,
    PART_BYTES_MIN = 1 << 20 /* a smaller part is not worth a thread */
};

/* The last vertex that was joined at a place; index_plus_1 is 0 if there is none. */
typedef struct last_vertex {
    int32_t uv, normal;
    uint32_t index_plus_1;
} last_vertex;

/* A file; once merged, its first part has the places, texture coordinates and normals of all parts. */
typedef struct obj_file {
    const request *req;
    flat_mesh *flat;
    diagnostic *why;
    obj_part parts[PARTS_MAX];
    int part_count;
    mtl_library library;
    const char *material; /* its name, in the text; NULL: none */
    size_t material_length;
    int slot; /* of this material; -1: it has none yet */
    last_vertex *last;
    joiner join;
    polygon shape;
    uint32_t *indices; /* of a part with polygons */
    size_t index_room;
} obj_file;

/* --- the parts --- */

/* The first line end after `at` that no \ continues. */
static const char *part_end(const char *at, const char *end)
{
    for (;;) {
        at = memchr(at, '\n', (size_t)(end - at));
        const char *before = at - 1 - (at[-1] == '\r');
        at++;
        if (at == end || *before != '\\')
            return at;
    }
}

/* Divides the text, which ends with \n. */
static void divide(obj_file *f, const char *text, size_t size)
{
    const char *at = text + text_begin(text, size), *end = text + size + (text[size - 1] != '\n');
    const int units = os_usable_units();
    size_t count = units < 1 ? 1 : units > PARTS_MAX ? PARTS_MAX : (size_t)units;
    if (count > size / PART_BYTES_MIN)
        count = size / PART_BYTES_MIN + 1;
    while (at < end) {
        const size_t left = (size_t)(end - at), part = left / (count - (size_t)f->part_count);
        const char *next = (size_t)f->part_count + 1 == count || part < 3 ? end : part_end(at + part - 1, end);
        f->parts[f->part_count++] = (obj_part){.begin = at, .end = next};
        at = next;
    }
}

static void parse(void *parts, size_t index, int member)
{
    (void)member;
    obj_parse((obj_part *)parts + index);
}

static void locate(const obj_file *f, const obj_part *part, uint32_t line)
{
    long before = 1;
    for (const obj_part *o = f->parts; o < part; o++)
        before += (long)o->line;
    diagnostic_locate(f->why, f->req->path, before + (long)line, 0);
}

static status parse_all(obj_file *f)
{
    thread_team *team = thread_team_create(f->part_count);
    if (!team)
        return no_memory_for(f->req, f->why);
    thread_team_run(team, parse, f->parts, (size_t)f->part_count);
    thread_team_destroy(team);
    for (const obj_part *o = f->parts; o < f->parts + f->part_count; o++) {
        if (o->no_memory)
            return no_memory_for(f->req, f->why);
        if (!o->fault)
            continue;
        locate(f, o, o->line);
        const int length = o->word_length < 60 ? (int)o->word_length : 60;
        return length > 0 ? diagnose(f->why, STATUS_BAD_INPUT, o->remedy, "%s: '%.*s'", o->fault, length, o->word)
                          : diagnose(f->why, STATUS_BAD_INPUT, o->remedy, "%s", o->fault);
    }
    return STATUS_OK;
}

static void copy(void *to, const void *from, size_t bytes)
{
    if (bytes)
        memcpy(to, from, bytes);
}

/* Makes the indices of the part absolute, and checks them. `before`: the part's own statements begin after these; the
 * file has as many as the first part once all are merged. Texture coordinates and normals that the file lacks are left
 * out. */
static status resolve(obj_file *f, obj_part *o, const size_t before[3], const size_t all[3])
{
    if (!o->relative && (size_t)o->highest.place <= all[0] && (size_t)o->highest.uv <= all[1] &&
        (size_t)o->highest.normal <= all[2])
        return STATUS_OK;
    static const char *const names[] = {"", "texture coordinates", "normals"};
    int32_t *const highest[] = {&o->highest.place, &o->highest.uv, &o->highest.normal};
    size_t at = 0;
    o->highest = (obj_corner){0, 0, 0};
    for (size_t k = 0; k < o->face_count; k++)
        for (const size_t end = at + obj_size(o, k); at < end; at++) {
            int32_t *const parts[] = {&o->corners[at].place, &o->corners[at].uv, &o->corners[at].normal};
            for (int q = 0; q < 3; q++) {
                if (*parts[q] == 0)
                    continue;
                int64_t index = obj_index(*parts[q], before[q]);
                if (index < 1 || (size_t)index > all[q]) {
                    if (q == 0) {
                        locate(f, o, obj_face_line(o, k));
                        return diagnose(f->why, STATUS_BAD_INPUT, "repair the file or export it again",
                                        "a face refers to vertex %lld, but the file has %zu", (long long)index, all[q]);
                    }
                    flat_note(f->flat, "faces refer to %s that the file lacks: these are left out", names[q]);
                    index = 0;
                }
                *parts[q] = (int32_t)index;
                *highest[q] = *parts[q] > *highest[q] ? *parts[q] : *highest[q];
            }
        }
    return STATUS_OK;
}

/* Appends the colours of a part, whose places come after `before` others, to the first part's. */
static bool merge_colors(obj_part *all, const obj_part *o, size_t before)
{
    if (o->color_count == 0)
        return true;
    if (!GROW(all->colors, all->color_room, before + o->color_count))
        return false;
    for (; all->color_count < before; all->color_count++)
        memcpy(all->colors[all->color_count], (double[3]){1.0, 1.0, 1.0}, sizeof *all->colors);
    memcpy(all->colors + before, o->colors, o->color_count * sizeof *o->colors);
    all->color_count = before + o->color_count;
    return true;
}

/* Appends the vertices, texture coordinates and normals of all parts to the first part's. */
static status merge_parts(obj_file *f)
{
    obj_part *all = &f->parts[0];
    size_t before[PARTS_MAX][3] = {{0}};
    for (int i = 1; i < f->part_count; i++) {
        obj_part *o = &f->parts[i];
        memcpy(before[i], (size_t[3]){all->place_count, all->uv_count, all->normal_count}, sizeof before[i]);
        if (!GROW(all->places, all->place_room, all->place_count + o->place_count) ||
            !merge_colors(all, o, all->place_count) || !GROW(all->uvs, all->uv_room, all->uv_count + o->uv_count) ||
            !GROW(all->normals, all->normal_room, all->normal_count + o->normal_count))
            return no_memory_for(f->req, f->why);
        copy(all->places + all->place_count, o->places, o->place_count * sizeof *o->places);
        copy(all->uvs + all->uv_count, o->uvs, o->uv_count * sizeof *o->uvs);
        copy(all->normals + all->normal_count, o->normals, o->normal_count * sizeof *o->normals);
        all->place_count += o->place_count;
        all->uv_count += o->uv_count;
        all->normal_count += o->normal_count;
        free(o->places), free(o->uvs), free(o->normals), free(o->colors);
        o->places = o->normals = o->colors = NULL;
        o->uvs = NULL;
    }
    for (int i = 0; i < f->part_count; i++)
        TRY(resolve(f, &f->parts[i], before[i], (size_t[3]){all->place_count, all->uv_count, all->normal_count}));
    return STATUS_OK;
}

/* Reads all libraries, so that a material may be used before the statement that names its library. */
static status read_libraries(obj_file *f)
{
    const obj_event *last = NULL;
    for (const obj_part *o = f->parts; o < f->parts + f->part_count; o++)
        for (size_t i = 0; i < o->event_count; i++) {
            const obj_event *e = &o->events[i];
            if (!e->library || (last && last->length == e->length && memcmp(last->names, e->names, e->length) == 0))
                continue;
            locate(f, o, e->line);
            TRY(mtl_read(f->req, e->names, e->length, &f->library, f->flat, f->why));
            last = e;
        }
    diagnostic_locate(f->why, f->req->path, 0, 0);
    return STATUS_OK;
}

/* --- materials --- */

static bool is_named(const mesh_material *m, const char *name, size_t length)
{
    return name ? m->name && strlen(m->name) == length && memcmp(m->name, name, length) == 0 : !m->name;
}

/* Finds the slot of the current material, or makes it. A name that no library has is a material of the default grey. */
static status find_slot(obj_file *f)
{
    static const mesh_material none = {.values = {.diffuse = {1, 1, 1}, .opacity = 1, .ior = 1}};
    uint8_t slot;
    for (unsigned i = 0; i < f->flat->material_count; i++)
        if (is_named(&f->flat->materials[i], f->material, f->material_length)) {
            f->slot = (int)i;
            return STATUS_OK;
        }
    char *name = f->material ? strndup(f->material, f->material_length) : NULL;
    if (f->material && !name)
        return no_memory_for(f->req, f->why);
    mesh_material m = f->material ? mtl_find(&f->library, f->material, f->material_length) : none;
    m.name = name;
    const status code = flat_material(f->req, f->flat, &m, &slot, f->why);
    free(name);
    f->slot = slot;
    return code;
}

/* --- vertices --- */

static void numbers_of(const obj_file *f, obj_corner c, double numbers[JOIN_NUMBERS])
{
    static const double white[3] = {1.0, 1.0, 1.0};
    const obj_part *all = &f->parts[0];
    const size_t place = (size_t)c.place - 1;
    memset(numbers + 3, 0, (JOIN_COLOR - 3) * sizeof *numbers);
    memset(numbers + JOIN_COLOR, 0, (JOIN_NUMBERS - JOIN_COLOR) * sizeof *numbers);
    for (int k = 0; k < 3; k++) /* + 0.0: -0 becomes 0 */
        numbers[k] = all->places[place][k] + 0.0;
    for (int k = 0; c.normal && k < 3; k++)
        numbers[3 + k] = all->normals[c.normal - 1][k] + 0.0;
    for (int k = 0; c.uv && k < 2; k++)
        numbers[6 + k] = all->uvs[c.uv - 1][k] + 0.0;
    if (f->flat->with_colors)
        join_color(f->flat, place < all->color_count ? all->colors[place] : white, numbers);
}

static bool is_last(const last_vertex *v, obj_corner c)
{
    return v->index_plus_1 && v->uv == c.uv && v->normal == c.normal;
}

/* Sets the vertices of up to JOIN_BLOCK corners. */
static status join_corners(obj_file *f, const obj_corner *corners, size_t count, uint32_t *indices)
{
    double numbers[JOIN_BLOCK][JOIN_NUMBERS];
    uint64_t hashes[JOIN_BLOCK];
    bool ready[JOIN_BLOCK];
    for (size_t i = 0; i < count; i++) {
        ready[i] = !is_last(&f->last[corners[i].place - 1], corners[i]);
        if (!ready[i])
            continue;
        numbers_of(f, corners[i], numbers[i]);
        hashes[i] = join_hash(f->flat, numbers[i]);
        join_prefetch(&f->join, hashes[i]);
    }
    for (size_t i = 0; i < count; i++) {
        last_vertex *last = &f->last[corners[i].place - 1];
        if (!is_last(last, corners[i])) {
            if (!ready[i]) { /* an earlier corner of this block has replaced the last vertex */
                numbers_of(f, corners[i], numbers[i]);
                hashes[i] = join_hash(f->flat, numbers[i]);
            }
            TRY(join_vertex(f->req, &f->join, f->flat, numbers[i], hashes[i], &indices[i], f->why));
            *last = (last_vertex){corners[i].uv, corners[i].normal, indices[i] + 1};
        }
        indices[i] = last->index_plus_1 - 1;
    }
    return STATUS_OK;
}

static status join_part(obj_file *f, const obj_part *o, uint32_t *indices)
{
    for (size_t i = 0; i < o->corner_count; i += JOIN_BLOCK) {
        const size_t left = o->corner_count - i;
        TRY(join_corners(f, o->corners + i, left < JOIN_BLOCK ? left : JOIN_BLOCK, indices + i));
    }
    return STATUS_OK;
}

/* --- faces --- */

static status append_face(obj_file *f, const obj_part *o, size_t k, const uint32_t *indices)
{
    if (f->slot < 0)
        TRY(find_slot(f));
    if (o->sizes)
        return polygon_append(f->req, &f->shape, indices, o->sizes[k], (uint8_t)f->slot, f->flat, f->why);
    f->flat->slots[f->flat->triangle_count++] = (uint8_t)f->slot; /* its indices are there already */
    return STATUS_OK;
}

static status append_part(obj_file *f, const obj_part *o)
{
    if (o->sizes && !GROW(f->indices, f->index_room, o->corner_count))
        return no_memory_for(f->req, f->why);
    uint32_t *indices = o->sizes ? f->indices : f->flat->triangles[f->flat->triangle_count];
    TRY(join_part(f, o, indices));
    size_t event = 0;
    for (size_t k = 0; k <= o->face_count; k++) {
        for (; event < o->event_count && o->events[event].face == k; event++)
            if (!o->events[event].library) {
                f->material = o->events[event].names;
                f->material_length = o->events[event].length;
                f->slot = -1;
            }
        if (k == o->face_count)
            break;
        TRY(append_face(f, o, k, indices));
        indices += obj_size(o, k);
    }
    return STATUS_OK;
}

static status assemble(obj_file *f)
{
    uint64_t triangles = 0;
    for (const obj_part *o = f->parts; o < f->parts + f->part_count; o++) {
        if (o->clear)
            flat_note(f->flat, VERTEX_ALPHA_NOTE);
        if (o->narrow)
            flat_note(f->flat, FLAT_FEW_CORNERS);
        triangles += o->corner_count - 2 * o->face_count;
        f->flat->with_uvs |= o->highest.uv > 0;
        f->flat->with_normals |= o->highest.normal > 0;
    }
    f->flat->with_colors = f->parts[0].color_count > 0;
    f->flat->srgb = true;
    TRY(flat_reserve(f->req, f->flat, triangles, f->why));
    f->last = large_calloc(f->parts[0].place_count, sizeof *f->last);
    if (!f->last || !join_reserve(&f->join, f->flat, f->parts[0].place_count))
        return no_memory_for(f->req, f->why);
    for (int i = 0; i < f->part_count; i++)
        TRY(append_part(f, &f->parts[i]));
    return STATUS_OK;
}

status obj_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why)
{
    obj_file f = {.req = req, .flat = flat, .why = why, .slot = -1};
    divide(&f, text, size);
    status code = parse_all(&f);
    THEN(code, merge_parts(&f));
    THEN(code, read_libraries(&f));
    THEN(code, assemble(&f));
    for (int i = 0; i < f.part_count; i++)
        obj_part_release(&f.parts[i]);
    mtl_release(&f.library);
    polygon_release(&f.shape);
    free(f.last), free(f.join.table), free(f.indices);
    return code;
}
