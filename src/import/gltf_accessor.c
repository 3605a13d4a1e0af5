/* Accessors (3.6.2): typed elements in buffers, dense or sparse. Bytes are little-endian (3.6.2.4) and need not be
 * aligned here. */
#include "import/gltf.h"
#include <math.h>
#include <string.h>

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
    return sparse ? open_sparse(g, of, sparse, out) : STATUS_OK;
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
