/* A glTF file: the chunks of a .glb file (4.4), its JSON, values of the JSON, the bytes of its buffers, and their
 * accessors. */
#include "base/file.h"
#include "base/json_build.h"
#include "base/text.h"
#include "import/gltf.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { HEADER_BYTES = 12, CHUNK_HEAD_BYTES = 8, STRIDE_MAX = 65535 };
static const uint32_t JSON_CHUNK = 0x4E4F534A, BINARY_CHUNK = 0x004E4942;
#define BYTES_MAX ((uint64_t)1 << 48) /* of offsets and lengths, so that their sums fit */

/* --- values of the JSON --- */

size_t gltf_count(const gltf_file *g, const char *list)
{
    return json_array_size(json_object_get(g->root, list)); /* 0 if it is not an array */
}

gltf_item gltf_at(const gltf_file *g, const char *list, size_t index)
{
    return (gltf_item){json_array_get(json_object_get(g->root, list), index), list, index};
}

status gltf_bad(const gltf_file *g, gltf_item of, const char *key, const char *what, ...)
{
    char text[256];
    va_list list;
    va_start(list, what);
    vsnprintf(text, sizeof text, what, list);
    va_end(list);
    return of.list ? diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR, "%s[%zu]%s%s %s", of.list, of.index,
                              key[0] ? "." : "", key, text)
                   : diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR, "%s %s", key, text);
}

status gltf_whole(const gltf_file *g, gltf_item of, const json_t *object, const char *key, uint64_t most,
                  uint64_t otherwise, uint64_t *out)
{
    const json_t *value = json_object_get(object, key);
    const double number = json_number_value(value);
    *out = otherwise;
    if (!value)
        return STATUS_OK;
    if (!json_is_number(value) || !(number >= 0) || number != floor(number))
        return gltf_bad(g, of, key, "is not a whole number of at least 0");
    if (number > (double)most)
        return gltf_bad(g, of, key, "is %.17g, more than %llu", number, (unsigned long long)most);
    *out = (uint64_t)number;
    return STATUS_OK;
}

status gltf_index(const gltf_file *g, gltf_item of, const json_t *object, const char *key, const char *list,
                  int64_t *out)
{
    uint64_t index;
    *out = -1;
    if (!json_object_get(object, key))
        return STATUS_OK;
    TRY(gltf_whole(g, of, object, key, BYTES_MAX, 0, &index));
    if (index >= gltf_count(g, list))
        return gltf_bad(g, of, key, "is %llu, but the file has %zu %s", (unsigned long long)index, gltf_count(g, list),
                        list);
    *out = (int64_t)index;
    return STATUS_OK;
}

status gltf_numbers(const gltf_file *g, gltf_item of, const json_t *object, const char *key, size_t count, double *out)
{
    const json_t *value = json_object_get(object, key);
    bool right = count == 1 ? json_is_number(value) : json_is_array(value) && json_array_size(value) == count;
    if (!value)
        return STATUS_OK;
    for (size_t i = 0; right && i < count; i++) {
        const json_t *one = count == 1 ? value : json_array_get(value, i);
        right = json_is_number(one);
        out[i] = json_number_value(one);
    }
    return right        ? STATUS_OK
           : count == 1 ? gltf_bad(g, of, key, "is not a number")
                        : gltf_bad(g, of, key, "is not a list of %zu numbers", count);
}

const json_t *gltf_extension(const json_t *object, const char *name)
{
    return json_object_get(json_object_get(object, "extensions"), name);
}

const char *gltf_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

/* --- the file --- */

static uint32_t word_at(const char *text, size_t at)
{
    const unsigned char *b = (const unsigned char *)text + at;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* Finds the chunks of a binary file; others than the first two kinds are ignored. */
static status open_binary(gltf_file *g, const char **text, size_t *size)
{
    const char *file = *text, *json = NULL;
    size_t end = *size, json_size = 0;
    if (end < HEADER_BYTES || word_at(file, 8) > end)
        return diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR, "the file is cut short: it has %zu bytes of %lu", end,
                        end < HEADER_BYTES ? (unsigned long)HEADER_BYTES : (unsigned long)word_at(file, 8));
    if (word_at(file, 4) != 2)
        return diagnose(g->why, STATUS_BAD_INPUT, "export the file as glTF 2.0",
                        "this is binary glTF of version %lu, not 2", (unsigned long)word_at(file, 4));
    end = word_at(file, 8);
    for (size_t at = HEADER_BYTES; at < end && end - at >= CHUNK_HEAD_BYTES;) {
        const size_t length = word_at(file, at), left = end - at - CHUNK_HEAD_BYTES;
        const uint32_t kind = word_at(file, at + 4);
        const char *bytes = file + at + CHUNK_HEAD_BYTES;
        if (length > left)
            return diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR,
                            "the chunk at byte %zu is cut short: it has %zu bytes of %zu", at, left, length);
        if (!json && kind != JSON_CHUNK)
            break;
        if (!json)
            json = bytes, json_size = length;
        else if (kind == BINARY_CHUNK && !g->chunk)
            g->chunk = (const unsigned char *)bytes, g->chunk_size = length;
        at += CHUNK_HEAD_BYTES + length;
    }
    if (!json)
        return diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR, "the first chunk of the file is not JSON");
    *text = json;
    *size = json_size;
    return STATUS_OK;
}

static status parse(gltf_file *g, const char *text, size_t size)
{
    json_error_t error;
    bool no_memory;
    const size_t mark = text_begin(text, size);
    g->root =
        json_parse(text + mark, size - mark, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error, &no_memory);
    if (no_memory)
        return no_memory_for(g->req, g->why);
    if (!g->root && g->req->kind == FILE_GLTF)
        diagnostic_locate(g->why, g->req->path, error.line, error.column > 0 ? error.column : 1);
    if (!g->root)
        return diagnose(g->why, STATUS_BAD_INPUT, "repair the JSON, or export the file again", "%s%s",
                        g->req->kind == FILE_GLTF ? "" : "its JSON: ", error.text);
    if (!json_is_object(g->root))
        return diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR, "this JSON is not glTF: it is not an object");
    return STATUS_OK;
}

/* Versions, 3.2: a file of version 2.x is read unless it needs a later one. */
static status check_version(const gltf_file *g)
{
    const json_t *asset = json_object_get(g->root, "asset");
    const char *version = gltf_text(asset, "version"), *least = gltf_text(asset, "minVersion");
    if (!*version)
        return diagnose(g->why, STATUS_BAD_INPUT, GLTF_REPAIR,
                        "this is not a file of format glTF 2.0: it has no "
                        "asset.version");
    if (strncmp(version, "2.", 2) == 0 && (!*least || strcmp(least, "2.0") == 0))
        return STATUS_OK;
    return diagnose(g->why, STATUS_BAD_INPUT, "export the file as glTF 2.0", "this is glTF of version %.20s, not 2.0",
                    *least && strncmp(version, "2.", 2) == 0 ? least : version);
}

/* Extensions, 3.12: those that are required must be known, others are noted. */
static status check_extensions(const gltf_file *g)
{
    static const char *const known[] = {
        "KHR_mesh_quantization", "KHR_texture_transform",    "KHR_materials_ior",   "KHR_materials_transmission",
        "KHR_materials_volume",  "KHR_materials_dispersion", "KHR_lights_punctual", "KHR_materials_emissive_strength"};
    static const char *const lists[] = {"extensionsRequired", "extensionsUsed"};
    char ignored[400] = "";
    for (int required = 1; required >= 0; required--) {
        const char *list = lists[!required];
        for (size_t i = 0; i < gltf_count(g, list); i++) {
            const char *name = json_string_value(gltf_at(g, list, i).json);
            bool found = !name;
            for (size_t k = 0; k < sizeof known / sizeof *known; k++)
                found |= name && strcmp(name, known[k]) == 0;
            if (!found && required)
                return diagnose(g->why, STATUS_BAD_INPUT, "export the file without this extension",
                                "%s[%zu]: the file requires the extension '%.100s', which is unknown here", list, i,
                                name);
            const size_t length = strlen(ignored);
            if (!found && length + strlen(name) + 3 < sizeof ignored)
                snprintf(ignored + length, sizeof ignored - length, "%s%s", length ? ", " : "", name);
        }
    }
    if (*ignored)
        flat_note(g->flat, "ignored extensions: %s", ignored);
    return STATUS_OK;
}

status gltf_open(gltf_file *g, const char *text, size_t size)
{
    const size_t file_size = size;
    if (g->req->kind == FILE_GLB)
        TRY(open_binary(g, &text, &size));
    TRY(parse(g, text, size));
    TRY(check_version(g));
    TRY(check_extensions(g));
    g->size = file_size;
    g->buffer_count = gltf_count(g, "buffers");
    g->buffers = calloc(g->buffer_count + 1, sizeof *g->buffers);
    g->image_numbers = calloc(gltf_count(g, "images") + 1, sizeof *g->image_numbers);
    return g->buffers && g->image_numbers ? STATUS_OK : no_memory_for(g->req, g->why);
}

void gltf_close(gltf_file *g)
{
    for (size_t i = 0; g->buffers && i < g->buffer_count; i++) {
        files_release(&g->buffers[i].file);
        free(g->buffers[i].decoded);
    }
    free(g->buffers);
    free(g->image_numbers);
    json_decref(g->root);
}

/* --- buffers --- */

/* The name of a file in a URI: %20 and the like replaced. NULL without memory; the caller's. */
static char *gltf_file_name(const char *uri)
{
    char *name = strdup(uri), *to = name;
    for (const char *from = name; name && *from; from++) {
        char digits[3] = {from[0] == '%' ? from[1] : (char)0, 0, 0};
        digits[1] = digits[0] ? from[2] : (char)0;
        char *end = digits;
        const long byte = strtol(digits, &end, 16);
        const bool escaped = end == digits + 2 && byte >= 0x20;
        *to++ = escaped ? (char)byte : *from;
        from += escaped ? 2 : 0;
    }
    if (name)
        *to = 0;
    return name;
}

status gltf_decode(const gltf_file *g, gltf_item of, const char *uri, unsigned char **bytes, size_t *size)
{
    *bytes = NULL;
    if (strncasecmp(uri, "data:", 5) != 0)
        return STATUS_OK;
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 12 || strncasecmp(comma - 7, ";base64", 7) != 0)
        return gltf_bad(g, of, "uri", "is data that is not in base64");
    size_t length = strlen(comma + 1);
    *bytes = base64_decode(comma + 1, length, false, size);
    if (!*bytes && errno == ENOMEM)
        return no_memory_for(g->req, g->why);
    return *bytes ? STATUS_OK : gltf_bad(g, of, "uri", "is not valid base64");
}

static status read_file(const gltf_file *g, gltf_item of, const char *uri, file_text *text)
{
    const char *reason = "";
    char *name = gltf_file_name(uri);
    const int fd = name ? files_open_beside(g->req, name, &reason) : -1;
    int error = name ? errno : ENOMEM;
    status code = STATUS_OK;
    if (fd < 0 && error == ENOMEM)
        code = no_memory_for(g->req, g->why);
    else if (fd < 0 && error == EXDEV)
        code = diagnose(g->why, STATUS_BAD_INPUT, BELOW_REMEDY, "needs the file '%.200s', which %s", name, reason);
    else if (fd < 0 && strstr(uri, "://"))
        code = gltf_bad(g, of, "uri", "is not a file next to this one: '%.200s'", uri);
    else if (fd < 0)
        code = diagnose(g->why, STATUS_BAD_INPUT, "put this file where the mesh file expects it, or export both again",
                        "needs the file '%.200s': %s", name, reason);
    else {
        diagnostic bad = {.what = ""};
        code = files_read(g->req, fd, FILE_BUFFER, text, &bad);
        if (code != STATUS_OK)
            diagnose(g->why, code, bad.remedy, "needs the file '%.200s': %s", name, bad.what);
    }
    free(name);
    return code;
}

/* Reads a buffer at its first use. */
static status load_buffer(gltf_file *g, size_t index)
{
    gltf_buffer *b = &g->buffers[index];
    const gltf_item of = gltf_at(g, "buffers", index);
    const char *uri = json_string_value(json_object_get(of.json, "uri"));
    uint64_t wanted;
    TRY(gltf_whole(g, of, of.json, "byteLength", BYTES_MAX, 0, &wanted));
    if (uri) {
        TRY(gltf_decode(g, of, uri, &b->decoded, &b->size));
        if (!b->decoded)
            TRY(read_file(g, of, uri, &b->file));
        b->size = b->decoded ? b->size : b->file.size;
    } else if (index > 0 || !g->chunk) {
        return gltf_bad(g, of, "", "has no bytes: there is neither a uri nor a chunk for it");
    } else {
        b->size = g->chunk_size;
    }
    if (b->size < wanted)
        return gltf_bad(g, of, "byteLength", "is %llu, but there are only %zu bytes", (unsigned long long)wanted,
                        b->size);
    b->bytes = !uri ? g->chunk : b->decoded ? b->decoded : (const unsigned char *)b->file.bytes;
    b->size = (size_t)wanted;
    return STATUS_OK;
}

status gltf_view_at(gltf_file *g, int64_t index, gltf_view *out)
{
    const gltf_item of = gltf_at(g, "bufferViews", (size_t)index);
    int64_t buffer;
    uint64_t offset, length, stride;
    TRY(gltf_index(g, of, of.json, "buffer", "buffers", &buffer));
    if (buffer < 0)
        return gltf_bad(g, of, "buffer", "is missing");
    TRY(gltf_whole(g, of, of.json, "byteOffset", BYTES_MAX, 0, &offset));
    TRY(gltf_whole(g, of, of.json, "byteLength", BYTES_MAX, 0, &length));
    TRY(gltf_whole(g, of, of.json, "byteStride", STRIDE_MAX, 0, &stride));
    if (!g->buffers[buffer].bytes)
        TRY(load_buffer(g, (size_t)buffer));
    const gltf_buffer *b = &g->buffers[buffer];
    if (offset + length > b->size)
        return gltf_bad(g, of, "", "ends at byte %llu, but its buffer has %zu bytes",
                        (unsigned long long)(offset + length), b->size);
    *out = (gltf_view){b->bytes + offset, (size_t)length, (size_t)stride};
    return STATUS_OK;
}

/* --- accessors (3.6.2): typed elements in buffers, dense or sparse ---
 *
 * Bytes are little-endian (3.6.2.4) and need not be aligned here. */

/* Types of components, 3.6.2.2. */
enum { INT8 = 5120, UINT8, INT16, UINT16, UINT32 = 5125, FLOAT32 };

enum { TYPES = 5 }; /* of elements; MAT2 and MAT3 are not used */

static size_t type_size(int type)
{
    switch (type) {
    case INT8:
    case UINT8: return 1;
    case INT16:
    case UINT16: return 2;
    case UINT32:
    case FLOAT32: return 4;
    default: return 0;
    }
}

static uint32_t bits_at(const unsigned char *b, size_t size)
{
    return size == 1   ? b[0]
           : size == 2 ? (uint32_t)b[0] | (uint32_t)b[1] << 8
                       : (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* A component; a normalised integer c is c / 255, max(c / 127, -1) and so on. */
static double component(const unsigned char *b, int type, bool normalized)
{
    const uint32_t bits = bits_at(b, type_size(type));
    float real;
    switch (type) {
    case INT8: return normalized ? fmax((int8_t)bits / 127.0, -1.0) : (int8_t)bits;
    case UINT8: return normalized ? bits / 255.0 : bits;
    case INT16: return normalized ? fmax((int16_t)bits / 32767.0, -1.0) : (int16_t)bits;
    case UINT16: return normalized ? bits / 65535.0 : bits;
    case UINT32: return normalized ? bits / 4294967295.0 : bits;
    default: memcpy(&real, &bits, sizeof real); return (double)real;
    }
}

/* --- opening --- */

/* A view of `count` elements of `size` bytes: where they begin, and the distance between them. */
static status open_elements(gltf_file *g, gltf_item of, const json_t *object, uint64_t count, size_t size,
                            const unsigned char **base, size_t *stride)
{
    int64_t index;
    uint64_t offset;
    gltf_view view;
    *base = NULL;
    *stride = size;
    TRY(gltf_index(g, of, object, "bufferView", "bufferViews", &index));
    TRY(gltf_whole(g, of, object, "byteOffset", (uint64_t)1 << 48, 0, &offset));
    if (index < 0)
        return STATUS_OK;
    TRY(gltf_view_at(g, index, &view));
    *stride = view.stride ? view.stride : size;
    if (*stride < size)
        return gltf_bad(g, of, "bufferView", "has a byteStride of %zu, but an element has %zu bytes", *stride, size);
    const uint64_t end = offset + (count - 1) * *stride + size;
    if (end > view.size)
        return gltf_bad(g, of, "count", "is %llu, which needs %llu bytes, but bufferViews[%lld] has %zu",
                        (unsigned long long)count, (unsigned long long)end, (long long)index, view.size);
    *base = view.bytes + offset;
    return STATUS_OK;
}

/* Sparse accessors, 3.6.2.3: the indices ascend. */
static status open_sparse(gltf_file *g, gltf_item of, const json_t *sparse, gltf_accessor *a)
{
    uint64_t count, type;
    size_t stride;
    const json_t *indices = json_object_get(sparse, "indices");
    TRY(gltf_whole(g, of, sparse, "count", a->count, 0, &count));
    TRY(gltf_whole(g, of, indices, "componentType", FLOAT32, 0, &type));
    if (count == 0)
        return STATUS_OK;
    if (type != UINT8 && type != UINT16 && type != UINT32)
        return gltf_bad(g, of, "sparse.indices.componentType", "is %llu", (unsigned long long)type);
    a->sparse_type = (int)type;
    a->sparse_size = type_size(a->sparse_type);
    TRY(open_elements(g, of, indices, count, a->sparse_size, &a->sparse_indices, &stride));
    bool dense = stride == a->sparse_size;
    const size_t size = (size_t)a->components * type_size(a->type);
    TRY(open_elements(g, of, json_object_get(sparse, "values"), count, size, &a->sparse_values, &stride));
    dense &= stride == size;
    if (!a->sparse_indices || !a->sparse_values || !dense)
        return gltf_bad(g, of, "sparse", "has no dense indices and values");
    a->sparse_count = (size_t)count;
    for (size_t i = 0; i < a->sparse_count; i++) {
        const uint32_t now = bits_at(a->sparse_indices + i * a->sparse_size, a->sparse_size);
        if (now >= a->count || (i > 0 && now <= bits_at(a->sparse_indices + (i - 1) * a->sparse_size, a->sparse_size)))
            return gltf_bad(g, of, "sparse.indices", "do not ascend, or are not below %zu", a->count);
    }
    return STATUS_OK;
}

/* Elements without bytes, which are 0: the file and its buffers could index as many as they have bytes at most. */
static status check_zeros(const gltf_file *g, gltf_item of, size_t count)
{
    uint64_t bytes = g->size;
    for (size_t i = 0; i < g->buffer_count; i++)
        bytes += g->buffers[i].size;
    return count <= bytes ? STATUS_OK
                          : gltf_bad(g, of, "count", "is %zu, without bytes, in a file of %llu bytes", count,
                                     (unsigned long long)bytes);
}

status gltf_accessor_open(gltf_file *g, gltf_item reader, int64_t index, int components, gltf_accessor *out)
{
    static const char *const types[TYPES] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"};
    const gltf_item of = gltf_at(g, "accessors", (size_t)index);
    const char *type = gltf_text(of.json, "type");
    uint64_t count, component_type;
    *out = (gltf_accessor){0};
    for (int i = 0; i < TYPES; i++)
        if (strcmp(type, types[i]) == 0)
            out->components = i < 4 ? i + 1 : 16;
    if (components ? out->components != components : out->components != 3 && out->components != 4)
        return gltf_bad(g, of, "type", "is '%.20s', which does not suit %s[%zu]", type, reader.list, reader.index);
    TRY(gltf_whole(g, of, of.json, "count", UINT32_MAX, 0, &count));
    TRY(gltf_whole(g, of, of.json, "componentType", FLOAT32, 0, &component_type));
    out->count = (size_t)count;
    out->type = (int)component_type;
    out->normalized = json_is_true(json_object_get(of.json, "normalized")) && out->type != FLOAT32;
    const size_t size = (size_t)out->components * type_size(out->type);
    if (size == 0)
        return gltf_bad(g, of, "componentType", "is %d", out->type);
    if (count == 0)
        return gltf_bad(g, of, "count", "is 0 or missing");
    TRY(open_elements(g, of, of.json, count, size, &out->base, &out->stride));
    const json_t *sparse = json_object_get(of.json, "sparse");
    if (sparse)
        TRY(open_sparse(g, of, sparse, out));
    return out->base ? STATUS_OK : check_zeros(g, of, out->count);
}

/* --- reading --- */

/* The bytes of an element, or NULL: it is 0. */
static const unsigned char *element_of(const gltf_accessor *a, size_t element)
{
    size_t low = 0, high = a->sparse_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const uint32_t index = bits_at(a->sparse_indices + middle * a->sparse_size, a->sparse_size);
        if (index == element)
            return a->sparse_values + middle * (size_t)a->components * type_size(a->type);
        low = index < element ? middle + 1 : low;
        high = index < element ? high : middle;
    }
    return a->base ? a->base + element * a->stride : NULL;
}

void gltf_accessor_get(const gltf_accessor *a, size_t element, double *out)
{
    const unsigned char *at = element_of(a, element);
    const size_t size = type_size(a->type);
    for (int k = 0; k < a->components; k++)
        out[k] = at ? component(at + (size_t)k * size, a->type, a->normalized) : 0.0;
}

uint32_t gltf_accessor_index(const gltf_accessor *a, size_t element)
{
    const unsigned char *at = element_of(a, element);
    return at ? bits_at(at, type_size(a->type)) : 0;
}
