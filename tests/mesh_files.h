/* Helpers for tests of mesh files: a temporary folder, files in it, and the bytes of binary formats. */
#pragma once

#include "base/text.h"
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[512];

static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/cuvette-mesh-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        char *path = text_format("%s/%s", folder, entry->d_name);
        if (unlink(path) != 0)
            rmdir(path);
        free(path);
    }
    closedir(entries);
    rmdir(folder);
    return 0;
}

/* The path of a file with that name in the folder; free it. */
static char *in_folder(const char *name)
{
    char *path = text_format("%s/%s", folder, name);
    assert_non_null(path);
    return path;
}

static void put(const char *name, const void *bytes, size_t size)
{
    char *path = in_folder(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    free(path);
}

static void put_text(const char *name, const char *text)
{
    put(name, text, strlen(text));
}

/* A growing byte array. */
typedef struct bytes {
    unsigned char *at;
    size_t size, room;
} bytes;

static inline void add(bytes *b, const void *more, size_t size)
{
    if (b->size + size > b->room) {
        b->room = (b->size + size) * 2;
        b->at = realloc(b->at, b->room);
        assert_non_null(b->at);
    }
    if (size > 0)
        memcpy(b->at + b->size, more, size);
    b->size += size;
}

static inline void add_text(bytes *b, const char *text)
{
    add(b, text, strlen(text));
}

/* The formats are little-endian. */
static inline void add_u32(bytes *b, uint32_t value)
{
    for (int k = 0; k < 4; k++)
        add(b, &(unsigned char){(unsigned char)(value >> 8 * k)}, 1);
}

static inline void add_float(bytes *b, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_u32(b, bits);
}

static inline void add_floats(bytes *b, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_float(b, values[i]);
}

/* A tetrahedron with outward normals; the coordinates are floats but not short decimals. */
static const float corners[4][3] = {{0.1f, -0.2f, 0.3f}, {1.1f, -0.2f, 0.3f}, {0.1f, 0.9f, 0.3f}, {0.1f, -0.2f, 1.7f}};
static const uint8_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

static inline bytes binary_stl(void)
{
    bytes b = {0};
    char header[80] = "a tetrahedron";
    add(&b, header, sizeof header);
    add_u32(&b, 4);
    for (int f = 0; f < 4; f++) {
        add_floats(&b, (float[3]){0, 0, 1}, 3);
        for (int k = 0; k < 3; k++)
            add_floats(&b, corners[faces[f][k]], 3);
        add(&b, "\0\0", 2);
    }
    return b;
}

static inline bytes binary_ply(void)
{
    bytes b = {0};
    add_text(
        &b,
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n");
    add_floats(&b, corners[0], 12);
    for (int f = 0; f < 4; f++) {
        add(&b, "\3", 1);
        for (int k = 0; k < 3; k++)
            add_u32(&b, faces[f][k]);
    }
    return b;
}

/* Pads to a multiple of four, as glTF 2.0, 4.4.3 requires. */
static inline bytes glb_of(const char *json, const void *binary, size_t size)
{
    bytes b = {0};
    uint32_t length = (uint32_t)((strlen(json) + 3) / 4 * 4);
    add_text(&b, "glTF");
    add_u32(&b, 2);
    add_u32(&b, 12 + 8 + length + 8 + (uint32_t)size);
    add_u32(&b, length);
    add_text(&b, "JSON");
    add_text(&b, json);
    add(&b, "   ", length - strlen(json));
    add_u32(&b, (uint32_t)size);
    add(&b, "BIN\0", 4);
    add(&b, binary, size);
    return b;
}

static inline bytes tetrahedron_glb(const char *node)
{
    char json[2048];
    snprintf(json, sizeof json,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]}],"
             "\"materials\":[{\"name\":\"glass\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,0.5,0.75,0.5]}}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
             "{\"bufferView\":1,\"componentType\":5121,\"count\":12,\"type\":\"SCALAR\"}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12}],"
             "\"buffers\":[{\"byteLength\":60}]}",
             node);
    bytes data = {0};
    add_floats(&data, corners[0], 12);
    add(&data, faces, sizeof faces);
    bytes b = glb_of(json, data.at, data.size);
    free(data.at);
    return b;
}
