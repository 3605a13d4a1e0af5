/* Reads the wire format of cuvette-import (import/mesh_wire.h), and finds the images that materials name. */
#include "scene/assets/mesh_stream.h"
#include "base/array.h"
#include "base/budget.h"
#include "base/cancel.h"
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "image/image.h"
#include "import/mesh_wire.h"
#include "scene/model/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

_Static_assert(sizeof(mesh_wire_header) == 48 && sizeof(mesh_wire_material) == 22 * 8 + 56 &&
                   sizeof(mesh_wire_view) == 18 * 8 + 8,
               "no padding");
_Static_assert((int)MESH_WIRE_SLOTS_MAX == (int)MESH_SLOTS_MAX && (int)MESH_WIRE_FAR == (int)MESH_FAR,
               "the same limits");
_Static_assert(sizeof(vec3) == 24 && sizeof(mesh_uv) == 16 && sizeof(mesh_triangle) == 12, "arrays without padding");

mesh_limits mesh_limits_complete(const mesh_limits *limits)
{
    mesh_limits all = limits ? *limits : (mesh_limits){0};
    all.triangles = !all.triangles                       ? (size_t)1 << 25
                    : all.triangles > MESH_TRIANGLES_MAX ? MESH_TRIANGLES_MAX
                                                         : all.triangles;
    all.vertices = !all.vertices                      ? (size_t)1 << 26
                   : all.vertices > MESH_VERTICES_MAX ? MESH_VERTICES_MAX
                                                      : all.vertices;
    if (!all.memory_bytes) {
        bool chosen;
        const uint64_t left = memory_budget_left(&chosen);
        all.memory_bytes = !chosen ? (uint64_t)4 << 30 : left > 0 ? left : 1;
    }
    all.wall_s = all.wall_s > 0 ? all.wall_s : 60;
    return all;
}

void mesh_import_destroy(mesh_import *imported)
{
    if (!imported)
        return;
    for (int i = 0; imported->materials && i < imported->material_count; i++) {
        free(imported->materials[i].name);
        free(imported->materials[i].texture.path);
        free(imported->materials[i].glow.path);
    }
    free(imported->materials);
    for (int i = 0; imported->images && i < imported->image_count; i++)
        free(imported->images[i].bytes);
    free(imported->images);
    for (int i = 0; imported->views && i < imported->view_count; i++) {
        free(imported->views[i].values);
        free(imported->views[i].name);
    }
    free(imported->views);
    free(imported->note);
    mesh_release(imported->mesh);
    free(imported);
}

static status damaged(diagnostic *why, const char *what)
{
    return diagnose(why, STATUS_BAD_INPUT, "check that cuvette-import has the same version",
                    "the importer's answer is damaged: %s", what);
}

static status no_memory(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the mesh");
}

static status read_header(const mesh_source *source, const mesh_limits *limits, mesh_wire_header *header,
                          diagnostic *why)
{
    TRY(source->read(source->context, header, sizeof *header, why));
    if (memcmp(header->magic, MESH_WIRE_MAGIC, sizeof header->magic) != 0 || header->version != MESH_WIRE_VERSION)
        return damaged(why, "it does not begin with the header of this version");
    if (header->flags & ~(uint32_t)(MESH_WIRE_NORMALS | MESH_WIRE_UVS | MESH_WIRE_COLORS | MESH_WIRE_SRGB))
        return damaged(why, "unknown flags");
    if (header->material_count < 1 || header->material_count > MESH_SLOTS_MAX)
        return damaged(why, "the number of materials is out of range");
    if (header->image_count > MESH_WIRE_IMAGES_MAX || header->view_count > MESH_WIRE_VIEWS_MAX)
        return damaged(why, "the number of images, cameras or lights is out of range");
    if (!header->triangle_count || !header->vertex_count)
        return damaged(why, "no triangles");
    if (header->triangle_count > limits->triangles)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail",
                        "the mesh has %llu triangles, more than the limit of %zu",
                        (unsigned long long)header->triangle_count, limits->triangles);
    if (header->vertex_count > limits->vertices)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail",
                        "the mesh has %llu vertices, more than the limit of %zu",
                        (unsigned long long)header->vertex_count, limits->vertices);
    return STATUS_OK;
}

/* Reads the arrays, and checks texture coordinates and slots; mesh_finish checks the others. */
static status read_arrays(const mesh_source *source, mesh *m, diagnostic *why)
{
    struct {
        void *bytes;
        size_t size;
    } arrays[] = {
        {m->vertices, m->vertex_count * sizeof *m->vertices},
        {m->normals, m->normals ? m->vertex_count * sizeof *m->normals : 0},
        {m->uvs, m->uvs ? m->vertex_count * sizeof *m->uvs : 0},
        {m->colors, m->colors ? m->vertex_count * sizeof *m->colors : 0},
        {m->triangles, m->triangle_count * sizeof *m->triangles},
        {m->slots, m->triangle_count},
    };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (arrays[i].size)
            TRY(source->read(source->context, arrays[i].bytes, arrays[i].size, why));
    for (size_t i = 0; m->uvs && i < m->vertex_count; i++) {
        if (cancel_asked_at(i))
            return cancel_check(why);
        if (!isfinite(m->uvs[i].u) || !isfinite(m->uvs[i].v))
            return diagnose(why, STATUS_BAD_INPUT, "use finite texture coordinates",
                            "a texture coordinate of vertex %zu is not a number", i);
    }
    for (size_t t = 0; t < m->triangle_count; t++)
        if (m->slots[t] >= m->slot_count)
            return damaged(why, "a triangle's material is out of range");
    return STATUS_OK;
}

/* Decodes colours from sRGB. Nearly all are of 8 bits, whose values are in a table. */
static void decode_colors(mesh *m)
{
    enum { LAST = 255 };
    float bytes[LAST + 1], decoded[LAST + 1];
    for (int i = 0; i <= LAST; i++)
        bytes[i] = (float)((double)i / LAST), decoded[i] = (float)srgb_decode((double)bytes[i]);
    float *color = m->colors[0];
    for (size_t i = 0; i < 3 * m->vertex_count && !cancel_asked_at(i); i++) {
        if (!(color[i] >= 0.0f && color[i] <= 1.0f))
            continue; /* mesh_finish refuses it */
        const int byte = (int)(color[i] * (float)LAST + 0.5f);
        color[i] =
            memcmp(&bytes[byte], &color[i], sizeof *color) == 0 ? decoded[byte] : (float)srgb_decode((double)color[i]);
    }
}

/* Reads a text of this length; *text is newly allocated, or NULL for length 0. NUL and other control characters are
 * refused. */
static status read_text(const mesh_source *source, uint32_t length, char **text, diagnostic *why)
{
    *text = NULL;
    if (length == 0)
        return STATUS_OK;
    if (length > MESH_WIRE_TEXT_MAX)
        return damaged(why, "a text is too long");
    char *fresh = malloc(length + 1);
    if (!fresh)
        return no_memory(why);
    status code = source->read(source->context, fresh, length, why);
    fresh[length] = 0;
    for (uint32_t i = 0; i < length && code == STATUS_OK; i++) {
        if ((unsigned char)fresh[i] < 0x20 || fresh[i] == 0x7f)
            code = diagnose(why, STATUS_BAD_INPUT, "rename it",
                            "the name of a material, an image, a camera or a light contains a control character");
    }
    if (code != STATUS_OK) {
        free(fresh);
        return code;
    }
    *text = fresh;
    return STATUS_OK;
}

static bool within(const double *values, int count, double low, double high)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= low && values[i] <= high)) /* NaN is refused as well */
            return false;
    return true;
}

static status check_numbers(const imported_material *m, diagnostic *why)
{
    const char *wrong = !within(m->color, 3, 0, MESH_WIRE_COLOR_MAX)           ? "diffuse colour"
                        : !within(m->ambient, 3, 0, MESH_WIRE_COLOR_MAX)       ? "ambient colour"
                        : !within(m->specular, 3, 0, MESH_WIRE_COLOR_MAX)      ? "specular colour"
                        : !within(m->emissive, 3, 0, MESH_WIRE_COLOR_MAX)      ? "emitted colour"
                        : !within(&m->shininess, 1, 0, MESH_WIRE_COLOR_MAX)    ? "shininess"
                        : !within(&m->opacity, 1, 0, 1)                        ? "opacity"
                        : !within(&m->ior, 1, 0, MESH_WIRE_COLOR_MAX)          ? "index of refraction"
                        : !within(&m->alpha_cutoff, 1, 0, MESH_WIRE_COLOR_MAX) ? "alpha cutoff"
                        : !within(&m->transmission, 1, 0, 1)                   ? "transmission"
                        : !within(m->attenuation_color, 3, 0, 1)               ? "attenuation colour"
                        : !within(&m->attenuation_distance, 1, 0, MESH_FAR)    ? "attenuation distance"
                        : !within(&m->dispersion, 1, 0, MESH_WIRE_COLOR_MAX)   ? "dispersion"
                                                                               : NULL;
    return !wrong ? STATUS_OK
                  : diagnose(why, STATUS_BAD_INPUT, "correct the material", "material '%s': its %s is out of range",
                             m->name ? m->name : "", wrong);
}

static bool is_texture(const mesh_wire_texture *t, uint32_t image_count)
{
    return t->image <= image_count && !(t->image && t->path_length) && t->wrap_u <= MESH_WIRE_CLAMP &&
           t->wrap_v <= MESH_WIRE_CLAMP && t->filter <= MESH_WIRE_NEAREST;
}

/* Without its path. */
static imported_texture texture_of(const mesh_wire_texture *t)
{
    return (imported_texture){
        .image = (int)t->image, .wrap_u = (int)t->wrap_u, .wrap_v = (int)t->wrap_v, .filter = (int)t->filter};
}

static status read_material(const mesh_source *source, uint32_t image_count, imported_material *m, diagnostic *why)
{
    mesh_wire_material record;
    TRY(source->read(source->context, &record, sizeof record, why));
    if (record.flags & ~(uint32_t)MESH_WIRE_GIVEN || record.alpha_mode > MESH_WIRE_ALPHA_BLEND ||
        !is_texture(&record.texture, image_count) || !is_texture(&record.glow, image_count))
        return damaged(why, "unknown flags of a material");
    m->given = record.flags & MESH_WIRE_GIVEN;
    memcpy(m->color, record.diffuse, sizeof m->color);
    memcpy(m->ambient, record.ambient, sizeof m->ambient);
    memcpy(m->specular, record.specular, sizeof m->specular);
    memcpy(m->emissive, record.emissive, sizeof m->emissive);
    memcpy(m->attenuation_color, record.attenuation_color, sizeof m->attenuation_color);
    m->shininess = record.shininess;
    m->opacity = record.opacity;
    m->ior = record.ior;
    m->alpha_cutoff = record.alpha_cutoff;
    m->transmission = record.transmission;
    m->attenuation_distance = record.attenuation_distance;
    m->dispersion = record.dispersion;
    m->alpha_mode = record.alpha_mode;
    m->texture = texture_of(&record.texture);
    m->glow = texture_of(&record.glow);
    TRY(read_text(source, record.name_length, &m->name, why));
    TRY(read_text(source, record.texture.path_length, &m->texture.path, why));
    TRY(read_text(source, record.glow.path_length, &m->glow.path, why));
    return check_numbers(m, why);
}

/* Reads an image in pieces, so that memory is only taken for bytes that arrive. */
static status read_image(const mesh_source *source, uint64_t size, imported_image *into, diagnostic *why)
{
    enum { PIECE = 1 << 20 };
    size_t room = 0;
    while (into->size < size) {
        const size_t left = (size_t)size - into->size, piece = left < PIECE ? left : PIECE;
        if (!GROW(into->bytes, room, into->size + piece))
            return no_memory(why);
        TRY(source->read(source->context, into->bytes + into->size, piece, why));
        into->size += piece;
    }
    return STATUS_OK;
}

static status read_images(const mesh_source *source, mesh_import *into, diagnostic *why)
{
    for (int i = 0; i < into->image_count; i++) {
        uint64_t size;
        TRY(source->read(source->context, &size, sizeof size, why));
        if (size == 0 || size > SIZE_MAX / 4)
            return damaged(why, "the size of an image is out of range");
        TRY(memory_budget_check(size, "use a smaller image", why, "an image inside the mesh file"));
        TRY(read_image(source, size, &into->images[i], why));
    }
    return STATUS_OK;
}

/* Mirrors z into the left-handed world, as mesh_mirror does. */
static void mirror_view(mesh_wire_view *v)
{
    v->position[2] = 0.0 - v->position[2];
    v->forward[2] = 0.0 - v->forward[2];
    v->up[2] = 0.0 - v->up[2];
}

static status read_view(const mesh_source *source, bool right_handed, imported_view *view, diagnostic *why)
{
    mesh_wire_view *v = view->values = malloc(sizeof *v);
    if (!v)
        return no_memory(why);
    TRY(source->read(source->context, v, sizeof *v, why));
    TRY(read_text(source, v->name_length, &view->name, why));
    if (v->kind >= MESH_WIRE_VIEW_KINDS || !within(v->forward, 3, -1.001, 1.001) || !within(v->up, 3, -1.001, 1.001))
        return damaged(why, "a camera or a light has no direction");
    if (!within(v->position, 3, -MESH_FAR, MESH_FAR) || !within(&v->height, 1, 0, MESH_FAR) ||
        !within(&v->aspect, 1, 0, MESH_FAR) || !within(v->color, 3, 0, MESH_WIRE_COLOR_MAX) ||
        !within(&v->power, 1, 0, 1e12) || !within(&v->inner, 1, 0, 4) || !within(&v->outer, 1, 0, 4) ||
        !within(&v->range, 1, 0, 1e30))
        return diagnose(why, STATUS_BAD_INPUT, "correct it", "a number of %s '%s' is out of range",
                        v->kind <= MESH_WIRE_ORTHOGRAPHIC ? "camera" : "light", view->name ? view->name : "");
    if (right_handed)
        mirror_view(v);
    return STATUS_OK;
}

static status read_rest(const mesh_source *source, mesh_import *into, bool right_handed, uint32_t note_length,
                        diagnostic *why)
{
    for (int i = 0; i < into->material_count; i++) {
        imported_material *m = &into->materials[i];
        TRY(read_material(source, (uint32_t)into->image_count, m, why));
        if (m->name && !(into->mesh->slot_names[i] = strdup(m->name)))
            return no_memory(why);
    }
    TRY(read_images(source, into, why));
    for (int i = 0; i < into->view_count; i++)
        TRY(read_view(source, right_handed, &into->views[i], why));
    TRY(read_text(source, note_length, &into->note, why));
    char end[sizeof MESH_WIRE_END - 1];
    TRY(source->read(source->context, end, sizeof end, why));
    return memcmp(end, MESH_WIRE_END, sizeof end) == 0 ? source->end(source->context, why)
                                                       : damaged(why, "it has the wrong length");
}

static status read_all(const mesh_source *source, const mesh_limits *limits, mesh_import *into, diagnostic *why)
{
    mesh_wire_header header;
    TRY(read_header(source, limits, &header, why));
    TRY(mesh_create((size_t)header.vertex_count, (size_t)header.triangle_count, header.flags & MESH_WIRE_NORMALS,
                    header.flags & MESH_WIRE_UVS, true, &into->mesh, why));
    if (header.flags & MESH_WIRE_COLORS)
        TRY(mesh_add_colors(into->mesh, why));
    into->mesh->slot_count = into->material_count = (int)header.material_count;
    into->image_count = (int)header.image_count;
    into->view_count = (int)header.view_count;
    into->materials = calloc(header.material_count, sizeof *into->materials);
    into->images = calloc(header.image_count + 1, sizeof *into->images);
    into->views = calloc(header.view_count + 1, sizeof *into->views);
    if (!into->materials || !into->images || !into->views)
        return no_memory(why);
    TRY(read_arrays(source, into->mesh, why));
    TRY(read_rest(source, into, limits->right_handed, header.note_length, why));
    if (into->mesh->colors && header.flags & MESH_WIRE_SRGB)
        decode_colors(into->mesh);
    /* equal vertices are joined: mesh_wire.h */
    into->mesh->distinct = !into->mesh->normals && !into->mesh->uvs && !into->mesh->colors;
    if (limits->right_handed)
        mesh_mirror(into->mesh);
    return mesh_finish(into->mesh, why);
}

status mesh_stream_read(const mesh_source *source, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    mesh_limits all = mesh_limits_complete(limits);
    *out = NULL;
    mesh_import *fresh = calloc(1, sizeof *fresh);
    if (!fresh)
        return no_memory(why);
    status code = read_all(source, &all, fresh, why);
    if (code != STATUS_OK) {
        mesh_import_destroy(fresh);
        return code;
    }
    *out = fresh;
    return STATUS_OK;
}

typedef struct memory_source {
    const char *at;
    size_t left;
} memory_source;

static status read_memory(void *context, void *bytes, size_t size, diagnostic *why)
{
    memory_source *m = context;
    if (size > m->left)
        return damaged(why, "it is incomplete");
    memcpy(bytes, m->at, size);
    m->at += size;
    m->left -= size;
    return STATUS_OK;
}

static status end_memory(void *context, diagnostic *why)
{
    const memory_source *m = context;
    return m->left == 0 ? STATUS_OK : damaged(why, "it has the wrong length");
}

status mesh_stream_read_bytes(const void *bytes, size_t size, const mesh_limits *limits, mesh_import **out,
                              diagnostic *why)
{
    memory_source m = {bytes, size};
    const mesh_source source = {read_memory, end_memory, &m};
    return mesh_stream_read(&source, limits, out, why);
}

/* --- points as text --- */

enum { POINTS_BYTES_MAX = 256 << 20 };
#define POINT_FAR 1e6 /* as the position of a solid in the parameter table */

typedef struct point_reader {
    const char *name, *at, *line; /* at: the next character; line: the beginning of its line */
    long number;                  /* of the line, from 1 */
    diagnostic *why;
} point_reader;

static status point_error(point_reader *r, const char *remedy, const char *what)
{
    long column = 1;
    for (const char *c = r->line; c < r->at; c++)
        column += ((unsigned char)*c & 0xc0) != 0x80; /* characters, not bytes */
    diagnostic_locate(r->why, r->name, r->number, column);
    return diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s", what);
}

/* Moves past blanks; stops at the end of the line, which is a line feed, or the final 0. */
static void skip_blanks(point_reader *r)
{
    while (*r->at == ' ' || *r->at == '\t' || *r->at == '\r')
        r->at++;
}

static bool ends_line(point_reader *r)
{
    skip_blanks(r);
    if (*r->at == '#')
        r->at += strcspn(r->at, "\n");
    return *r->at == '\n' || *r->at == 0;
}

static status read_coordinate(point_reader *r, double *out)
{
    if (ends_line(r))
        return point_error(r, "give three numbers: x y z", "a coordinate of the point is missing");
    const char *end = r->at;
    if (!number_scan(&end, out) || !strchr(" \t\r\n,#", *end))
        return point_error(r, "give three numbers: x y z", "this is not a finite number");
    if (!(fabs(*out) <= POINT_FAR))
        return point_error(r, "use coordinates between -1000000 and 1000000", "the coordinate is too large");
    r->at = end;
    return STATUS_OK;
}

/* Reads the three coordinates of a point, and the end of its line. */
static status read_point(point_reader *r, vec3 *out)
{
    double *const coordinate[] = {&out->x, &out->y, &out->z};
    for (int k = 0; k < 3; k++) {
        TRY(read_coordinate(r, coordinate[k]));
        skip_blanks(r);
        r->at += k < 2 && *r->at == ',';
    }
    return ends_line(r) ? STATUS_OK : point_error(r, "give one point a line: x y z", "this follows the three numbers");
}

/* Fills *points, with *count of them, which the caller frees also after an error. end: of the text. */
static status read_points(point_reader *r, const char *end, vec3 **points, size_t *count)
{
    size_t room = 0;
    for (;; r->line = ++r->at, r->number++) {
        if (!ends_line(r)) {
            if (*count == SCENE_PRIMITIVES_MAX)
                return point_error(r, "use fewer points", "there are more than 2097151 points");
            if (!GROW(*points, room, *count + 1))
                return out_of_memory(r->why);
            TRY(read_point(r, &(*points)[*count]));
            ++*count;
        }
        if (r->at >= end)
            return STATUS_OK;
        if (*r->at == 0)
            return point_error(r, "save the file as plain text", "the text contains a NUL character");
        if (cancel_asked_at(*count))
            return cancel_check(r->why);
    }
}

static status make_points(const vec3 *points, size_t count, bool right_handed, mesh_import *into, diagnostic *why)
{
    TRY(mesh_create(count, 0, false, false, false, &into->mesh, why));
    memcpy(into->mesh->vertices, points, count * sizeof *points);
    into->mesh->distinct = true; /* without triangles, equal points are not joined */
    if (right_handed)
        mesh_mirror(into->mesh);
    return mesh_finish(into->mesh, why);
}

status mesh_points_parse(const char *name, const char *text, size_t size, bool right_handed, mesh_import **out,
                         diagnostic *why)
{
    point_reader r = {.name = name, .at = text, .line = text, .number = 1, .why = why};
    vec3 *points = NULL;
    size_t count = 0;
    mesh_import *fresh = calloc(1, sizeof *fresh);
    *out = NULL;
    status code = fresh ? read_points(&r, text + size, &points, &count) : out_of_memory(why);
    if (code == STATUS_OK && count == 0)
        code = point_error(&r, "give one point a line: x y z", "the file has no points");
    THEN(code, make_points(points, count, right_handed, fresh, why));
    free(points);
    if (code == STATUS_OK)
        *out = fresh;
    else
        mesh_import_destroy(fresh);
    return code;
}

bool mesh_is_points(const char *path)
{
    const size_t length = strlen(path), ending = sizeof POINTS_ENDING - 1;
    return length > ending && strcasecmp(path + length - ending, POINTS_ENDING) == 0;
}

status mesh_points_read(const char *path, const char *root, bool right_handed, mesh_import **out, diagnostic *why)
{
    char *text;
    size_t size;
    *out = NULL;
    TRY(file_read_below(path, root, POINTS_BYTES_MAX, &text, &size, why));
    const status code = mesh_points_parse(path, text, size, right_handed, out, why);
    free(text);
    return code;
}

/* --- images --- */

/* Alternative spellings of a file name: \ for / (MTL files from Windows), and %20 for a blank (URIs in glTF). */
static void respell(char *name)
{
    char *to = name;
    for (const char *from = name; *from; from++) {
        char digits[3] = {from[0] == '%' ? from[1] : (char)0, 0, 0};
        digits[1] = digits[0] ? from[2] : (char)0;
        char *end = digits;
        long byte = strtol(digits, &end, 16);
        if (end == digits + 2 && byte >= 0x20) {
            *to++ = (char)byte;
            from += 2;
        } else {
            *to++ = *from == '\\' ? '/' : *from;
        }
    }
    *to = 0;
}

static bool exists(const char *path)
{
    struct stat about;
    return path && stat(path, &about) == 0;
}

static bool is_file(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

/* Adds to the note of the import that the material is without its image. Without that of its emission it emits
 * nothing: the whole surface would shine. */
static status note_missing(mesh_import *imported, imported_material *m, imported_texture *image_of, diagnostic *why)
{
    const bool glow = image_of == &m->glow;
    char *note = text_format("%s%sthe image '%.200s' of %smaterial '%.100s' does not exist: %s",
                             imported->note ? imported->note : "", imported->note ? "; " : "", image_of->path,
                             glow ? "the emission of " : "", m->name ? m->name : "",
                             glow ? "it emits nothing" : "the material is without it");
    if (!note)
        return out_of_memory(why);
    free(imported->note);
    imported->note = note;
    free(image_of->path);
    image_of->path = NULL;
    for (int c = 0; glow && c < 3; c++)
        m->emissive[c] = 0.0;
    return STATUS_OK;
}

/* Finds an image of a material; the original spelling is tried first. */
static status resolve(const char *path, mesh_import *imported, imported_material *m, imported_texture *image_of,
                      diagnostic *why)
{
    if (!image_of->path)
        return STATUS_OK;
    char *found = file_next_to(path, image_of->path);
    if (!exists(found)) {
        char *respelt = strdup(image_of->path);
        if (respelt) {
            respell(respelt);
            free(found);
            found = file_next_to(path, respelt);
        }
        free(respelt);
    }
    if (!found)
        return out_of_memory(why);
    if (!exists(found)) {
        free(found);
        return note_missing(imported, m, image_of, why);
    }
    if (!is_file(found)) {
        diagnose(
            why, STATUS_BAD_INPUT, "put the image where the mesh file expects it, or remove the line that names it",
            "the image '%.200s' of material '%.100s' is not a regular file", image_of->path, m->name ? m->name : "");
        free(found);
        return STATUS_BAD_INPUT;
    }
    free(image_of->path);
    image_of->path = found;
    return STATUS_OK;
}

status mesh_textures_find(const char *path, mesh_import *imported, diagnostic *why)
{
    status code = STATUS_OK;
    for (int i = 0; i < imported->material_count && code == STATUS_OK; i++) {
        imported_material *m = &imported->materials[i];
        code = resolve(path, imported, m, &m->texture, why);
        THEN(code, resolve(path, imported, m, &m->glow, why));
    }
    return code;
}
