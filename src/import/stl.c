/* Reads STL files (plain.h). Facets share their corners again: equal ones are joined. */
#include "base/array.h"
#include "import/plain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER = 84, FACET = 50, NORMAL = 12 /* bytes */ };

typedef struct stl {
    const request *req;
    const char *bytes;
    size_t size;
    flat_mesh *flat;
    diagnostic *why;
    joiner join;
    polygon shape;
} stl;

/* Joins up to JOIN_BLOCK positions. */
static status join(stl *s, double (*places)[3], size_t count, uint32_t *indices)
{
    double numbers[JOIN_BLOCK][JOIN_NUMBERS] = {{0}};
    for (size_t i = 0; i < count; i++)
        memcpy(numbers[i], places[i], sizeof places[i]);
    return join_vertices(s->req, &s->join, s->flat, numbers, count, indices, s->why);
}

static status begin(stl *s, uint64_t facets, uint8_t *slot)
{
    static const mesh_material none = {.values = {.diffuse = {1, 1, 1}, .opacity = 1, .ior = 1}};
    TRY(flat_reserve(s->req, s->flat, facets, s->why));
    /* a closed mesh has half as many vertices as triangles */
    if (!join_reserve(&s->join, s->flat, (size_t)facets / 2 + 4))
        return no_memory_for(s->req, s->why);
    return flat_material(s->req, s->flat, &none, slot, s->why);
}

/* --- binary --- */

static uint32_t u32_at(const char *bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value |= (uint32_t)(unsigned char)bytes[i] << 8 * i; /* little-endian */
    return value;
}

static status read_corner(stl *s, size_t at, double place[3])
{
    for (size_t k = 0; k < 3; k++) {
        const uint32_t bits = u32_at(s->bytes + at + 4 * k);
        float value;
        memcpy(&value, &bits, sizeof value);
        place[k] = (double)value;
        if (!(fabs(place[k]) <= MESH_WIRE_FAR))
            return diagnose(s->why, STATUS_BAD_INPUT, "repair the file or export it again",
                            "byte %zu: facet %zu has a coordinate that is not a finite number within 1e9", at + 4 * k,
                            (at - HEADER) / FACET + 1);
    }
    return STATUS_OK;
}

static status read_binary(stl *s, uint64_t facets)
{
    enum { AT_ONCE = JOIN_BLOCK / 3 };
    uint8_t slot;
    TRY(begin(s, facets, &slot));
    memset(s->flat->slots, slot, (size_t)facets);
    while (s->flat->triangle_count < facets) {
        double places[3 * AT_ONCE][3];
        const size_t first = s->flat->triangle_count, left = (size_t)facets - first,
                     count = left < AT_ONCE ? left : AT_ONCE;
        for (size_t i = 0; i < 3 * count; i++)
            TRY(read_corner(s, HEADER + (first + i / 3) * FACET + NORMAL + i % 3 * 12, places[i]));
        TRY(join(s, places, 3 * count, s->flat->triangles[first]));
        s->flat->triangle_count += count;
    }
    return STATUS_OK;
}

/* --- text --- */

/* Facets of the text: their corners, and how many each has. */
typedef struct facets {
    double (*places)[3];
    uint32_t *sizes;
    size_t place_count, place_room, count, room;
} facets;

static status unexpected(const stl *s, const lines *l, const char *expected, const char *word, size_t length)
{
    diagnostic_locate(s->why, s->req->path, l->line, 0);
    if (length == 0)
        return diagnose(s->why, STATUS_BAD_INPUT, "the file is truncated; export it again",
                        "the text ends where %s is expected", expected);
    return diagnose(s->why, STATUS_BAD_INPUT, "repair the file or export it again", "'%.*s' where %s is expected",
                    length < 60 ? (int)length : 60, word, expected);
}

static status expect(const stl *s, lines *l, const char *keyword)
{
    const char *word = "";
    size_t length = 0;
    if (lines_any_word(l, &word, &length) && lines_is(word, length, keyword))
        return STATUS_OK;
    char quoted[32];
    snprintf(quoted, sizeof quoted, "'%s'", keyword);
    return unexpected(s, l, quoted, word, length);
}

static status read_place(const stl *s, lines *l, double place[3])
{
    for (int k = 0; k < 3; k++) {
        const char *word = "";
        size_t length = 0;
        if (!lines_any_word(l, &word, &length) || !lines_number(word, length, &place[k]) ||
            fabs(place[k]) > MESH_WIRE_FAR)
            return unexpected(s, l, "a finite number within 1e9", word, length);
    }
    return STATUS_OK;
}

/* Reads `normal` and its three words, which are not used, and the corners to `endfacet`. Words may be divided into
 * lines in any way. */
static status read_facet(const stl *s, lines *l, facets *all)
{
    const char *word = "";
    size_t length = 0;
    const size_t first = all->place_count;
    TRY(expect(s, l, "normal"));
    for (int k = 0; k < 3; k++)
        if (!lines_any_word(l, &word, &length))
            return unexpected(s, l, "a normal", "", 0);
    TRY(expect(s, l, "outer"));
    TRY(expect(s, l, "loop"));
    for (;;) {
        const size_t count = all->place_count - first;
        length = 0;
        lines_any_word(l, &word, &length);
        if (count >= 3 && lines_is(word, length, "endloop")) {
            all->sizes[all->count++] = (uint32_t)count;
            return expect(s, l, "endfacet");
        }
        if (count == POLYGON_MAX || !lines_is(word, length, "vertex"))
            return unexpected(s, l, count < 3 ? "'vertex'" : "'endloop'", word, length);
        if (!GROW(all->places, all->place_room, all->place_count + 1))
            return no_memory_for(s->req, s->why);
        TRY(read_place(s, l, all->places[all->place_count++]));
    }
}

static status read_solids(const stl *s, facets *all)
{
    lines l = lines_of(s->bytes, s->size);
    const char *word = "", *name;
    size_t length = 0;
    bool solid = false;
    while (lines_any_word(&l, &word, &length)) {
        if (lines_is(word, length, solid ? "endsolid" : "solid")) {
            solid = !solid;
            l.at += lines_rest(&l, &name);
            lines_next(&l);
        } else if (solid && lines_is(word, length, "facet")) {
            if (!GROW(all->sizes, all->room, all->count + 1))
                return no_memory_for(s->req, s->why);
            TRY(read_facet(s, &l, all));
        } else {
            return unexpected(s, &l, solid ? "'facet' or 'endsolid'" : "'solid'", word, length);
        }
    }
    return solid ? unexpected(s, &l, "'facet' or 'endsolid'", "", 0) : STATUS_OK;
}

static status join_places(stl *s, const facets *all, uint32_t *indices)
{
    for (size_t i = 0; i < all->place_count; i += JOIN_BLOCK) {
        const size_t left = all->place_count - i;
        TRY(join(s, all->places + i, left < JOIN_BLOCK ? left : JOIN_BLOCK, indices + i));
    }
    return STATUS_OK;
}

static status build(stl *s, const facets *all)
{
    uint8_t slot;
    TRY(begin(s, all->place_count - 2 * all->count, &slot));
    uint32_t *indices = malloc(all->place_count * sizeof *indices);
    status code = indices ? join_places(s, all, indices) : no_memory_for(s->req, s->why);
    const uint32_t *at = indices;
    for (size_t i = 0; i < all->count && code == STATUS_OK; at += all->sizes[i++])
        code = polygon_append(s->req, &s->shape, at, all->sizes[i], slot, s->flat, s->why);
    free(indices);
    return code;
}

static status read_text(stl *s)
{
    facets all = {0};
    status code = read_solids(s, &all);
    diagnostic_locate(s->why, s->req->path, code == STATUS_OK || !s->why ? 0 : s->why->line, 0);
    THEN(code, build(s, &all));
    free(all.places), free(all.sizes);
    return code;
}

/* A text begins with 'solid' after blanks, and has no NUL soon after; some binary files begin with 'solid', too. */
static bool is_text(const char *bytes, size_t size)
{
    const char *word;
    size_t length;
    lines l = lines_of(bytes, size);
    return lines_any_word(&l, &word, &length) && lines_is(word, length, "solid") &&
           !memchr(bytes, 0, size < 512 ? size : 512);
}

/* The size of a binary file by its header. */
static uint64_t binary_size(const char *bytes, size_t size)
{
    return HEADER + FACET * (size >= HEADER ? (uint64_t)u32_at(bytes + HEADER - 4) : 0);
}

/* Fewer bytes than a facet's may follow the last one; more would be facets that the count conceals. */
bool stl_agrees(const char *bytes, size_t size)
{
    const uint64_t end = binary_size(bytes, size);
    return size >= end && size - end < FACET;
}

status stl_check(const char *bytes, size_t size, bool whole, diagnostic *why)
{
    const uint64_t end = binary_size(bytes, size);
    if (size < end + FACET || is_text(bytes, size))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "the header is wrong; export the file again",
                    "byte 80: the header counts %llu facets, but the file has %s%zu",
                    (unsigned long long)((end - HEADER) / FACET), whole ? "" : "at least ", (size - HEADER) / FACET);
}

static status read_any(stl *s)
{
    const uint64_t end = binary_size(s->bytes, s->size), count = (end - HEADER) / FACET;
    if (s->size < HEADER || s->size != end) {
        if (is_text(s->bytes, s->size))
            return read_text(s);
        if (s->size < HEADER)
            return diagnose(s->why, STATUS_BAD_INPUT, "check that the file is complete and has the right ending",
                            "this is not an STL file: it does not begin with 'solid', and is shorter than a "
                            "binary file's %d bytes",
                            (int)HEADER);
    }
    if (s->size < end)
        return diagnose(s->why, STATUS_BAD_INPUT, "the file is truncated, or its header is wrong; export it again",
                        "byte %zu: the file ends within facet %zu of %llu", s->size, (s->size - HEADER) / FACET + 1,
                        (unsigned long long)count);
    return read_binary(s, count);
}

status stl_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why)
{
    stl s = {.req = req, .bytes = text, .size = size, .flat = flat, .why = why};
    const status code = read_any(&s);
    polygon_release(&s.shape);
    free(s.join.table);
    return code;
}
