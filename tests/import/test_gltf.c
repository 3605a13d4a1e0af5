/* Tests of the reader of glTF 2.0: numbers of accessors, primitives, nodes, materials and what is refused, against
 * values computed by hand from the specification. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "import/mesh_wire.h"
#include "mesh_read.h"
#include <math.h>

/* A document: ' stands for ", @ for the size of the buffer, which is the binary chunk. */
#define DOCUMENT(nodes, primitives, accessors, views, more)                                          \
    "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[" nodes                  \
    "],'meshes':[{'primitives':[" primitives "]}],'accessors':[" accessors "],'bufferViews':[" views \
    "],'buffers':[{'byteLength':@}]" more "}"
#define ONE_NODE "{'mesh':0}"
#define PLAIN "{'attributes':{'POSITION':0}}"
#define ACCESSOR(view, type, count, of) \
    "{'bufferView':" #view ",'componentType':" #type ",'count':" #count ",'type':'" of "'}"
#define VIEW(from, size) "{'buffer':0,'byteOffset':" #from ",'byteLength':" #size "}"
/* Three positions as floats, 36 bytes, as accessor 0 and view 0. */
#define POSITIONS ACCESSOR(0, 5126, 3, "VEC3")
static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static bytes document(const char *text, const bytes *data)
{
    bytes json = {0}, chunk = {0};
    char size[32];
    snprintf(size, sizeof size, "%zu", data->size);
    for (const char *c = text; *c; c++)
        if (*c == '@')
            add_text(&json, size);
        else
            add(&json, *c == '\'' ? "\"" : c, 1);
    add(&json, "", 1);
    add(&chunk, data->at, data->size);
    add(&chunk, "\0\0\0", (4 - data->size % 4) % 4);
    const bytes b = glb_of((const char *)json.at, chunk.at, chunk.size);
    free(chunk.at);
    free(json.at);
    return b;
}

static mesh_import *read_document(const char *text, bytes data)
{
    mesh_import *got = read_bytes("d.glb", document(text, &data));
    free(data.at);
    return got;
}

static void refuse_document(const char *text, bytes data, const char *words)
{
    bytes b = document(text, &data);
    refuse_at("d.glb", b.at, b.size, 0, words);
    free(b.at);
    free(data.at);
}

static bytes three(void)
{
    bytes b = {0};
    add_floats(&b, triangle, 9);
    return b;
}

static void add_u16(bytes *b, unsigned value)
{
    add(b, (unsigned char[2]){(unsigned char)value, (unsigned char)(value >> 8)}, 2);
}

/* --- accessors --- */

#define TYPED(type, flag)                                                                                \
    DOCUMENT(ONE_NODE, PLAIN,                                                                            \
             "{'bufferView':0,'componentType':" #type ",'count':3,'type':'VEC3','normalized':" flag "}", \
             "{'buffer':0,'byteLength':@}", ",'extensionsUsed':['KHR_mesh_quantization']")

static void assert_typed(const char *text, const int numbers[9], int size, double factor)
{
    bytes b = {0};
    for (int i = 0; i < 9; i++)
        add(&b, (unsigned char[2]){(unsigned char)numbers[i], (unsigned char)((unsigned)numbers[i] >> 8)},
            (size_t)size);
    mesh_import *got = read_document(text, b);
    double expected[9];
    for (int i = 0; i < 9; i++)
        expected[i] = fmax(numbers[i] / factor, factor > 1 ? -1.0 : -1e9) + 0.0;
    assert_triangles(got, expected, 1, text);
    mesh_import_destroy(got);
}

/* 3.6.2.2: f = c / 127, c / 255, c / 32767, c / 65535, at least -1. */
static void integers_are_numbers_or_fractions(void **state)
{
    (void)state;
    static const int small[9] = {0, 1, 127, -128, -127, 64, 3, -2, 5}, positive[9] = {0, 255, 1, 128, 7, 9, 200, 3, 4},
                     words[9] = {0, 32767, -32768, -32767, 1, 1000, -5, 20000, 77},
                     large[9] = {65535, 0, 1, 1000, 32768, 5, 9, 65534, 300};
    assert_typed(TYPED(5120, "false"), small, 1, 1);
    assert_typed(TYPED(5120, "true"), small, 1, 127);
    assert_typed(TYPED(5121, "false"), positive, 1, 1);
    assert_typed(TYPED(5121, "true"), positive, 1, 255);
    assert_typed(TYPED(5122, "false"), words, 2, 1);
    assert_typed(TYPED(5122, "true"), words, 2, 32767);
    assert_typed(TYPED(5123, "false"), large, 2, 1);
    assert_typed(TYPED(5123, "true"), large, 2, 65535);
}

static void texture_coordinates_may_be_normalised_integers(void **state)
{
    (void)state;
    bytes b = three();
    for (unsigned i = 0; i < 6; i++)
        add_u16(&b, i * 13107); /* fifths of 65535 */
    mesh_import *got = read_document(
        DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0,'TEXCOORD_0':1}}",
                 POSITIONS ",{'bufferView':1,'componentType':5123,'normalized':true,'count':3,'type':'VEC2'}",
                 VIEW(0, 36) "," VIEW(36, 12), ""),
        b);
    for (int i = 0; i < 3; i++) {
        const mesh_uv uv = got->mesh->uvs[got->mesh->triangles[0].corner[i]];
        assert_true(uv.u == 2 * i * 13107 / 65535.0 && uv.v == 1 - (2 * i + 1) * 13107 / 65535.0); /* v upwards */
    }
    mesh_import_destroy(got);
}

/* Positions and normals in turn, 24 bytes each, after 4 bytes that are not used. */
static void elements_may_be_interleaved(void **state)
{
    (void)state;
    bytes b = {0};
    add_u32(&b, 7);
    for (size_t i = 0; i < 3; i++) {
        add_floats(&b, triangle + 3 * i, 3);
        add_floats(&b, (float[3]){0, 0, 1}, 3);
    }
    mesh_import *got =
        read_document(DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0,'NORMAL':1}}",
                               "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                               "{'bufferView':0,'byteOffset':12,'componentType':5126,'count':3,'type':'VEC3'}",
                               "{'buffer':0,'byteOffset':4,'byteLength':72,'byteStride':24}", ""),
                      b);
    assert_triangles(got, (double[9]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 1, "interleaved");
    assert_vec3(got->mesh->normals[2], 0, 0, 1);
    mesh_import_destroy(got);
}

#define SPARSE(base, count)                                                           \
    "{" base "'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':" #count \
    ",'indices':{'bufferView':1,'componentType':5121},'values':{'bufferView':2}}}"
#define SPARSE_VIEWS VIEW(0, 36) "," VIEW(36, 2) "," VIEW(38, 24)

static bytes sparse_data(unsigned char first, unsigned char second)
{
    bytes b = three();
    add(&b, (unsigned char[2]){first, second}, 2);
    add_floats(&b, (float[6]){5, 6, 7, 8, 9, 10}, 6);
    return b;
}

static void sparse_accessors_replace_elements(void **state)
{
    (void)state;
    mesh_import *got =
        read_document(DOCUMENT(ONE_NODE, PLAIN, SPARSE("'bufferView':0,", 2), SPARSE_VIEWS, ""), sparse_data(0, 2));
    assert_triangles(got, (double[9]){5, 6, 7, 1, 0, 0, 8, 9, 10}, 1, "sparse");
    mesh_import_destroy(got);
    got = read_document(DOCUMENT(ONE_NODE, PLAIN, SPARSE("", 2), SPARSE_VIEWS, ""), sparse_data(1, 2));
    assert_triangles(got, (double[9]){0, 0, 0, 5, 6, 7, 8, 9, 10}, 1, "sparse zeros");
    mesh_import_destroy(got);
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, SPARSE("", 2), SPARSE_VIEWS, ""), sparse_data(2, 1),
                    "accessors[0].sparse.indices do not ascend");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, SPARSE("", 2), SPARSE_VIEWS, ""), sparse_data(1, 3), "below 3");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, SPARSE("", 4), SPARSE_VIEWS, ""), sparse_data(1, 2), "more than 3");
}

static void accessors_outside_their_bytes_are_refused(void **state)
{
    (void)state;
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, ACCESSOR(0, 5126, 4, "VEC3"), VIEW(0, 36), ""), three(),
                    "accessors[0].count is 4, which needs 48 bytes, but bufferViews[0] has 36");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, POSITIONS, VIEW(4, 36), ""), three(),
                    "bufferViews[0] ends at byte 40, but its buffer has 36 bytes");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, POSITIONS, "{'buffer':0,'byteLength':36,'byteStride':8}", ""), three(),
                    "byteStride of 8, but an element has 12 bytes");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, ACCESSOR(0, 5126, 3, "VEC2"), VIEW(0, 36), ""), three(),
                    "accessors[0].type is 'VEC2', which does not suit meshes[0]");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, ACCESSOR(0, 5124, 3, "VEC3"), VIEW(0, 36), ""), three(),
                    "accessors[0].componentType is 5124");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, ACCESSOR(0, 5126, 1.5, "VEC3"), VIEW(0, 36), ""), three(),
                    "accessors[0].count is not a whole number");
}

/* --- primitives --- */

#define FIVE(mode, indices)                                                         \
    DOCUMENT(ONE_NODE, "{'mode':" #mode ",'attributes':{'POSITION':0}" indices "}", \
             ACCESSOR(0, 5126, 5, "VEC3") "," ACCESSOR(1, 5125, 5, "SCALAR"), VIEW(0, 60) "," VIEW(60, 20), "")

static bytes five(void)
{
    bytes b = {0};
    for (int i = 0; i < 5; i++)
        add_floats(&b, (float[3]){(float)i, (float)(i % 2), 0}, 3);
    for (uint32_t i = 0; i < 5; i++)
        add_u32(&b, 4 - i);
    return b;
}

static void assert_corners(const char *text, const int (*expected)[3], size_t count)
{
    mesh_import *got = read_document(text, five());
    assert_int_equal(got->mesh->triangle_count, count);
    for (size_t t = 0; t < count; t++)
        for (int k = 0; k < 3; k++)
            assert_vec3(corner(got->mesh, t, k), expected[t][k], expected[t][k] % 2, 0);
    mesh_import_destroy(got);
}

/* 3.7.2.1. */
static void strips_and_fans_are_triangles(void **state)
{
    (void)state;
    assert_corners(FIVE(4, ""), (const int[][3]){{0, 1, 2}}, 1);
    assert_corners(FIVE(5, ""), (const int[][3]){{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}, 3);
    assert_corners(FIVE(6, ""), (const int[][3]){{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}, 3);
    assert_corners(FIVE(5, ",'indices':1"), (const int[][3]){{4, 3, 2}, {3, 1, 2}, {2, 1, 0}}, 3);
    refuse_document(FIVE(1, ""), five(), "the file has no triangles");
    refuse_document(FIVE(7, ""), five(), "meshes[0].mode is 7");
}

static void lines_beside_triangles_are_noted(void **state)
{
    (void)state;
    mesh_import *got = read_document(DOCUMENT(ONE_NODE, PLAIN ",{'mode':3,'attributes':{'POSITION':0},'targets':[{}]}",
                                              POSITIONS, VIEW(0, 36), ",'animations':[{}]"),
                                     three());
    assert_int_equal(got->mesh->triangle_count, 1);
    assert_non_null(strstr(got->note, "points and lines are ignored"));
    assert_non_null(strstr(got->note, "animations are not played"));
    mesh_import_destroy(got);
}

/* --- nodes --- */

/* A half turn about y, after doubling x, then moved. */
static void nodes_turn_scale_and_move(void **state)
{
    (void)state;
    mesh_import *got = read_document(DOCUMENT("{'mesh':0,'translation':[1,2,3],'rotation':[0,2,0,0],'scale':[2,1,1]}",
                                              PLAIN, POSITIONS, VIEW(0, 36), ""),
                                     three());
    assert_triangles(got, (double[9]){1, 2, 3, -1, 2, 3, 1, 3, 3}, 1, "half turn");
    mesh_import_destroy(got);
    refuse_document(DOCUMENT("{'mesh':0,'rotation':[0,0,0,0]}", PLAIN, POSITIONS, VIEW(0, 36), ""), three(),
                    "nodes[0].rotation is a quaternion of length 0");
}

static void nodes_are_trees(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {DOCUMENT("{'children':[1,1]},{'mesh':0}", PLAIN, POSITIONS, VIEW(0, 36), ""),
         "nodes[0].children has nodes[1], which is already a child of nodes[0]"},
        {DOCUMENT("{'children':[1]},{'children':[0],'mesh':0}", PLAIN, POSITIONS, VIEW(0, 36), ""),
         "nodes[0] is its own descendant"},
        {DOCUMENT("{'children':[7]}", PLAIN, POSITIONS, VIEW(0, 36), ""),
         "nodes[0].children has an item that is none of the file's 1 nodes"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuse_document(cases[i].text, three(), cases[i].words);
}

/* A chain of `last` nodes below the first; only the last one has the mesh. */
static char *chain(int last)
{
    bytes b = {0};
    char node[64];
    for (int i = 1; i <= last; i++)
        add(&b, node, (size_t)snprintf(node, sizeof node, "{'children':[%d]},", i));
    add(&b, "", 1);
    char *text = text_format(DOCUMENT("%s{'mesh':0}", PLAIN, POSITIONS, VIEW(0, 36), ""), (char *)b.at);
    free(b.at);
    return text;
}

static void nodes_are_nested_up_to_a_limit(void **state)
{
    (void)state;
    char *most = chain(256), *more = chain(257);
    mesh_import *got = read_document(most, three());
    assert_int_equal(got->mesh->triangle_count, 1);
    mesh_import_destroy(got);
    refuse_document(more, three(), "nodes are nested more than 256 deep");
    free(most), free(more);
}

/* Without "scene" the first one is read. */
static void one_scene_is_read(void **state)
{
    (void)state;
    static const char *const chosen[] = {"", "'scene':1,"};
    for (int i = 0; i < 2; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "{'asset':{'version':'2.0'},%s'scenes':[{'nodes':[0]},{'nodes':[1]}],'nodes':[{'mesh':0},{'mesh':0,"
                 "'translation':[0,0,1]}],'meshes':[{'primitives':[" PLAIN "]}],'accessors':[" POSITIONS
                 "],'bufferViews':[" VIEW(0, 36) "],'buffers':[{'byteLength':@}]}",
                 chosen[i]);
        mesh_import *got = read_document(text, three());
        assert_triangles(got, (double[9]){0, 0, i, 1, 0, i, 0, 1, i}, 1, chosen[i]);
        assert_non_null(strstr(got->note, i ? "scenes[1] is read" : "scenes[0] is read"));
        mesh_import_destroy(got);
    }
}

/* Two joints, each moved; the inverse matrix of the second moves back by 10. The third vertex is half of each: its
 * weights are divided by their sum. */
static void skins_follow_their_joints(void **state)
{
    (void)state;
    bytes b = three();
    add(&b, "\0\1\0\0\0\1\0\0\0\1\0\0", 12);
    add_floats(&b, (float[12]){1, 0, 0, 0, 0, 1, 0, 0, 2, 2, 0, 0}, 12);
    for (int k = 0; k < 2; k++)
        add_floats(&b, (float[16]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, k ? -10.0F : 0.0F, 0, 0, 1}, 16);
    mesh_import *got = read_document(DOCUMENT("{'children':[1,2,3]},{'translation':[0,0,4]},{'translation':[30,0,0]},"
                                              "{'mesh':0,'skin':0,'translation':[1000,0,0]}",
                                              "{'attributes':{'POSITION':0,'JOINTS_0':1,'WEIGHTS_0':2}}",
                                              POSITIONS "," ACCESSOR(1, 5121, 3, "VEC4") "," ACCESSOR(
                                                  2, 5126, 3, "VEC4") "," ACCESSOR(3, 5126, 2, "MAT4"),
                                              VIEW(0, 36) "," VIEW(36, 12) "," VIEW(48, 48) "," VIEW(96, 128),
                                              ",'skins':[{'joints':[1,2],'inverseBindMatrices':3}]"),
                                     b);
    assert_triangles(got, (double[9]){0, 0, 4, 21, 0, 0, 10, 1, 2}, 1, "skin");
    mesh_import_destroy(got);
}

/* --- files --- */

static void names_of_buffers_are_decoded(void **state)
{
    (void)state;
    bytes b = three();
    put("my mesh.bin", b.at, b.size);
    free(b.at);
    mesh_import *got =
        read_text("percent.gltf",
                  "\xef\xbb\xbf{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":"
                  "[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
                  "\"count\":3,\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                  "\"buffers\":[{\"byteLength\":36,\"uri\":\"my%20mesh.bin\"}]}");
    assert_int_equal(got->mesh->triangle_count, 1);
    mesh_import_destroy(got);
}

/* The first float of this buffer has the bytes with which gzip's files begin; the buffer of the other cannot be
 * read. */
static void buffers_are_taken_as_they_are(void **state)
{
    (void)state;
#define OUTSIDE(uri)                                                                                                   \
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"         \
    "\"POSITION\":"                                                                                                    \
    "0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"bufferViews\":[" \
    "{"                                                                                                                \
    "\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"" uri "\"}]}"
    bytes b = three();
    memcpy(b.at, "\x1f\x8b\x08", 4);
    put("like_gzip.bin", b.at, b.size);
    free(b.at);
    mesh_import *got = read_text("like_gzip.gltf", OUTSIDE("like_gzip.bin"));
    assert_int_equal(got->mesh->triangle_count, 1);
    mesh_import_destroy(got);
    const mesh_limits small = {.memory_bytes = 64 << 20};
    put_text("unread.gltf", OUTSIDE("/proc/self/mem"));
    char *path = in_folder("unread.gltf");
    diagnostic why = {.what = ""};
    assert_int_equal(mesh_read_file(path, &small, &got, &why), STATUS_FAILURE);
    assert_non_null(strstr(why.what, "needs the file '/proc/self/mem': cannot read: Input/output error"));
    free(path);
}

static void mistakes_have_their_place(void **state)
{
    (void)state;
    static const char cut[] = "{\"asset\":\n{\"version\":\"2.0\",}}", old[] = "{\"asset\":{\"version\":\"1.0\"}}";
    refuse_at("cut.gltf", cut, sizeof cut - 1, 2, "cut.gltf:2:18: ");
    refuse_at("old.gltf", old, sizeof old - 1, 0, "this is glTF of version 1.0, not 2.0");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, POSITIONS, VIEW(0, 36),
                             ",'extensionsUsed':['FOO_x'],'extensionsRequired':['KHR_mesh_quantization','FOO_x']"),
                    three(), "extensionsRequired[1]: the file requires the extension 'FOO_x'");
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, POSITIONS, VIEW(0, 37), ""), three(), "ends at byte 37");
    mesh_import *got = read_document(
        DOCUMENT(ONE_NODE, PLAIN, POSITIONS, VIEW(0, 36), ",'extensionsUsed':['FOO_x','KHR_materials_ior']"), three());
    assert_string_equal(got->note, "ignored extensions: FOO_x");
    mesh_import_destroy(got);
}

/* 47 bytes that announce 2 GB, and 2^30 nodes in 687 bytes (cases of issue 51). */
static void small_files_need_little_memory(void **state)
{
    (void)state;
    const mesh_limits small = {.memory_bytes = 64 << 20};
    bytes b = {0};
    add_text(&b, "glTF");
    add_u32(&b, 2);
    add_u32(&b, 60);
    add_u32(&b, 0x7fffffff);
    add_text(&b, "JSON{\"asset\":{\"version\":\"2.0\"}}");
    put("h.glb", b.at, b.size);
    free(b.at);
    char *path = in_folder("h.glb");
    mesh_import *got;
    diagnostic why = {.what = ""};
    assert_int_equal(mesh_read_file(path, &small, &got, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "the file is cut short"));
    free(path);
    /* elements without bytes, which are zeros: fewer than the file and its buffers have bytes */
    refuse_document(DOCUMENT(ONE_NODE, PLAIN, "{'componentType':5126,'count':60000000,'type':'VEC3'}", VIEW(0, 36), ""),
                    three(), "accessors[0].count is 60000000, without bytes");
    refuse_document(DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0,'COLOR_0':1}}",
                             POSITIONS ",{'componentType':5126,'count':2000,'type':'VEC3'}", VIEW(0, 36), ""),
                    three(), "accessors[1].count is 2000, without bytes");
    refuse_document(DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0},'indices':1}",
                             POSITIONS ",{'componentType':5125,'count':3,'type':'SCALAR'}", VIEW(0, 36), ""),
                    three(), "accessors[1].bufferView is missing, but these are indices");
    refuse_document(
        DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0},'extensions':{'KHR_draco_mesh_compression':{'bufferView':0}}}",
                 "{'componentType':5126,'count':60000000,'type':'VEC3'}", VIEW(0, 36), ""),
        three(), "meshes[0] is compressed with Draco");
}

/* --- materials --- */

static mesh_import *with_material(const char *material, const char *more)
{
    bytes b = three();
    add_floats(&b, (float[6]){0.25F, 0.5F, 0, 0, 1, 1}, 6);
    add_floats(&b, (float[6]){0.5F, 0.125F, 0, 0, 1, 1}, 6);
    add(&b, "\x89PNG\r\n\x1a\n12", 10);
    char *text =
        text_format(DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0,'TEXCOORD_0':1,'TEXCOORD_1':2},'material':0}",
                             POSITIONS "," ACCESSOR(1, 5126, 3, "VEC2") "," ACCESSOR(2, 5126, 3, "VEC2"),
                             VIEW(0, 36) "," VIEW(36, 24) "," VIEW(60, 24) "," VIEW(84, 10), ",'materials':[{%s}]%s"),
                    material, more);
    mesh_import *got = read_document(text, b);
    free(text);
    return got;
}

static void alpha_has_a_mode(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        unsigned mode;
        double opacity, cutoff;
    } cases[] = {
        {"'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.25]}", MESH_WIRE_ALPHA_OPAQUE, 1, 0},
        {"'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.25]}", MESH_WIRE_ALPHA_BLEND, 0.25, 0},
        {"'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.25]}", MESH_WIRE_ALPHA_MASK, 0, 0.5},
        {"'alphaMode':'MASK','alphaCutoff':0.125,'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.25]}",
         MESH_WIRE_ALPHA_MASK, 1, 0.125},
        {"'alphaMode':'MASK'", MESH_WIRE_ALPHA_MASK, 1, 0.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_import *got = with_material(cases[i].text, "");
        const imported_material *m = &got->materials[0];
        if (m->alpha_mode != cases[i].mode || m->opacity != cases[i].opacity || m->alpha_cutoff != cases[i].cutoff)
            fail_msg("%s: mode %u, opacity %g, cutoff %g", cases[i].text, m->alpha_mode, m->opacity, m->alpha_cutoff);
        mesh_import_destroy(got);
    }
}

#define COLORS(type)                                                                 \
    DOCUMENT(ONE_NODE, "{'attributes':{'POSITION':0,'COLOR_0':1},'material':0}",     \
             POSITIONS "," ACCESSOR(1, 5126, 3, type), VIEW(0, 36) "," VIEW(36, 48), \
             ",'materials':[{'pbrMetallicRoughness':{'baseColorFactor':[0.5,1,1,1]}}]")

static void one_color_of_all_vertices_is_the_materials(void **state)
{
    (void)state;
    for (int differ = 0; differ < 2; differ++) {
        bytes b = three();
        for (int i = 0; i < 3; i++)
            add_floats(&b, (float[4]){0.5F, 0.25F, differ && i == 2 ? 1.0F : 0.125F, 1}, 4);
        mesh_import *got = read_document(COLORS("VEC4"), b);
        const double *color = got->materials[0].color;
        assert_true(differ ? color[0] == 0.5 && color[1] == 1 && color[2] == 1
                           : color[0] == 0.25 && color[1] == 0.25 && color[2] == 0.125);
        assert_true(!got->mesh->colors == !differ);
        assert_null(got->note);
        mesh_import_destroy(got);
    }
    bytes b = three();
    for (int i = 0; i < 3; i++)
        add_floats(&b, (float[4]){1, 1, 1, i == 2 ? 0.5F : 1}, 4);
    mesh_import *got = read_document(COLORS("VEC4"), b);
    assert_string_equal(got->note, "the alpha of vertices is ignored");
    mesh_import_destroy(got);
}

#define TEXTURED(info) "'pbrMetallicRoughness':{'baseColorTexture':{'index':0" info "}}"
#define INSIDE ",'textures':[{'source':0,'sampler':0}],'images':[{'bufferView':3,'mimeType':'image/png'}],'samplers':[{"

/* Two primitives of one material, of which only the first has texture coordinates. */
static void a_texture_without_coordinates_is_left_out(void **state)
{
    (void)state;
    bytes b = three();
    add_floats(&b, (float[6]){0.25F, 0.5F, 0, 0, 1, 1}, 6);
    add(&b, "\x89PNG\r\n\x1a\n12", 10);
    mesh_import *got = read_document(
        DOCUMENT(ONE_NODE,
                 "{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0},{'attributes':{'POSITION':0},'material':0}",
                 POSITIONS "," ACCESSOR(1, 5126, 3, "VEC2"), VIEW(0, 36) "," VIEW(36, 24) "," VIEW(60, 10),
                 ",'materials':[{'name':'a','pbrMetallicRoughness':{'baseColorFactor':[0.5,1,1,1],"
                 "'baseColorTexture':{'index':0}}}],'textures':[{'source':0}],"
                 "'images':[{'bufferView':2,'mimeType':'image/png'}]"),
        b);
    assert_int_equal(got->material_count, 2);
    const imported_material *with = &got->materials[got->mesh->slots[0]],
                            *without = &got->materials[got->mesh->slots[1]];
    assert_true(with->texture.image == 1 && without->texture.image == 0 && !without->texture.path);
    assert_true(with->color[0] == 0.5 && without->color[0] == 0.5);
    assert_string_equal(without->name, "a");
    assert_string_equal(got->note, "a texture whose coordinates the mesh lacks is left out");
    mesh_import_destroy(got);
}

static void images_inside_the_file_are_carried(void **state)
{
    (void)state;
    mesh_import *got =
        with_material(TEXTURED(""), INSIDE "'wrapS':33071,'wrapT':33648,'magFilter':9728,'minFilter':9728}]");
    const imported_material *m = &got->materials[0];
    assert_int_equal(m->texture.image, 1);
    assert_int_equal(got->image_count, 1);
    assert_int_equal(got->images[0].size, 10);
    assert_memory_equal(got->images[0].bytes, "\x89PNG\r\n\x1a\n12", 10);
    assert_true(m->texture.wrap_u == MESH_WIRE_CLAMP && m->texture.wrap_v == MESH_WIRE_MIRROR &&
                m->texture.filter == MESH_WIRE_NEAREST);
    mesh_import_destroy(got);
    got = with_material(TEXTURED(""),
                        ",'textures':[{'source':0}],'images':[{'uri':'data:image/png;base64,iVBORw0KGgoxMg=='}]");
    m = &got->materials[0];
    assert_memory_equal(got->images[0].bytes, "\x89PNG\r\n\x1a\n12", 10);
    assert_true(m->texture.wrap_u == MESH_WIRE_REPEAT && m->texture.wrap_v == MESH_WIRE_REPEAT &&
                m->texture.filter == MESH_WIRE_TRILINEAR);
    mesh_import_destroy(got);
    got =
        with_material(TEXTURED(""), ",'textures':[{'source':0}],'images':[{'uri':'data:image/webp;base64,UklGRg=='}]");
    assert_int_equal(got->materials[0].texture.image, 0);
    assert_non_null(strstr(got->note, "images[0] is neither a PNG nor a JPEG image"));
    mesh_import_destroy(got);
    got = with_material(TEXTURED(""), ",'textures':[{'source':0}],'images':[{'uri':'no%20such.png'}]");
    assert_non_null(strstr(got->note, "the image 'no%20such.png' of material '' does not exist"));
    mesh_import_destroy(got);
}

/* %25 is decoded once: to the name a%20b.png, and not to a b.png. */
static void names_of_images_are_decoded_once(void **state)
{
    (void)state;
    put_text("a b.png", "x");
    for (int there = 0; there < 2; there++) {
        mesh_import *got = with_material(TEXTURED(""), ",'textures':[{'source':0}],'images':[{'uri':'a%2520b.png'}]");
        assert_true(there ? strstr(got->materials[0].texture.path, "a%20b.png") != NULL
                          : !got->materials[0].texture.path);
        mesh_import_destroy(got);
        put_text("a%20b.png", "x");
    }
}

static void assert_first_uv(const char *info, double u, double v)
{
    char *text = text_format("'pbrMetallicRoughness':{'baseColorTexture':{'index':0%s}}", info);
    mesh_import *got = with_material(text, INSIDE "}]");
    const mesh_uv uv = got->mesh->uvs[got->mesh->triangles[0].corner[0]];
    if (fabs(uv.u - u) > 1e-15 || fabs(uv.v - v) > 1e-15)
        fail_msg("%s: %.17g %.17g, not %.17g %.17g", info, uv.u, uv.v, u, v);
    mesh_import_destroy(got);
    free(text);
}

/* The first vertex has 0.25, 0.5 in set 0 and 0.5, 0.125 in set 1. KHR_texture_transform: rotated counter-clockwise as
 * seen in the image, u' = 0.5 v, v' = 1 - 0.5 u is its example of the lower left quadrant. */
static void texture_coordinates_are_chosen_and_moved(void **state)
{
    (void)state;
#define MOVED(values) ",'extensions':{'KHR_texture_transform':{" values "}}"
    assert_first_uv("", 0.25, 0.5);
    assert_first_uv(",'texCoord':1", 0.5, 0.875);
    assert_first_uv(",'texCoord':1" MOVED("'texCoord':0"), 0.25, 0.5);
    assert_first_uv(MOVED("'offset':[0.5,0.25],'scale':[2,0.5]"), 1, 0.5);
    assert_first_uv(MOVED("'offset':[0,1],'rotation':1.5707963267948966,'scale':[0.5,0.5]"), 0.25, 0.125);
}

static void glass_has_its_numbers(void **state)
{
    (void)state;
    mesh_import *got = with_material(
        "'name':'glass','extensions':{'KHR_materials_ior':{'ior':1.7},'KHR_materials_transmission':{"
        "'transmissionFactor':0.75},'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':0.5,"
        "'attenuationColor':[0.5,0.25,1]},'KHR_materials_dispersion':{'dispersion':0.4}}",
        "");
    const imported_material *m = &got->materials[0];
    assert_true(m->ior == 1.7 && m->transmission == 0.75 && m->opacity == 0.25 && m->dispersion == 0.4);
    assert_true(m->attenuation_distance == 0.5 && m->attenuation_color[0] == 0.5 && m->attenuation_color[1] == 0.25);
    mesh_import_destroy(got);
    got =
        with_material("'alphaMode':'MASK','extensions':{'KHR_materials_transmission':{'transmissionFactor':0.75}}", "");
    assert_true(got->materials[0].transmission == 0.75 && got->materials[0].opacity == 1);
    mesh_import_destroy(got);
    got = with_material(
        "'emissiveFactor':[0.5,1,0],'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':4}}", "");
    assert_true(got->materials[0].emissive[0] == 2 && got->materials[0].emissive[1] == 4);
    assert_true(got->materials[0].ior == 1.5 && got->materials[0].transmission == 0);
    mesh_import_destroy(got);
    got = with_material("'name':'a\\nb','emissiveFactor':[0.5,1,0],'extensions':{'KHR_materials_emissive_strength':{"
                        "'emissiveStrength':4e38},'KHR_materials_transmission':{'transmissionFactor':1},"
                        "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':3.4028234e38}}",
                        "");
    assert_true(fabs(got->materials[0].emissive[0] / 5e5 - 1) < 1e-12 && got->materials[0].emissive[1] <= 1e6);
    assert_true(got->materials[0].attenuation_distance == 0);
    assert_string_equal(got->materials[0].name, "a?b");
    assert_non_null(strstr(got->note, "emission is at most 1e+06"));
    mesh_import_destroy(got);
    got = with_material("'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0}", INSIDE "}]");
    assert_true(got->materials[0].emissive[0] == 1 && got->materials[0].glow.image == 1);
    mesh_import_destroy(got);
}

/* --- cameras and lights --- */

/* A camera turned by a quarter about y, so that it looks along -x; a spot that shines along -z. */
static void cameras_and_lights_are_read(void **state)
{
    (void)state;
    mesh_import *got = read_document(
        DOCUMENT("{'mesh':0,'children':[1,2]},{'camera':0,'translation':[5,1,2],'rotation':[0,1,0,1],'name':'n'},"
                 "{'translation':[0,3,0],'extensions':{'KHR_lights_punctual':{'light':0}}}",
                 PLAIN, POSITIONS, VIEW(0, 36),
                 ",'cameras':[{'type':'perspective','name':'eye','perspective':{'yfov':0.5,'aspectRatio':1.5}}],"
                 "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','color':[1,0.5,0],'intensity':20,"
                 "'range':3.4028234e38,'spot':{'innerConeAngle':0.25,'outerConeAngle':0.5}}]}}"),
        three());
    assert_int_equal(got->view_count, 2);
    const mesh_wire_view *eye = got->views[0].values, *spot = got->views[1].values;
    assert_string_equal(got->views[0].name, "eye");
    assert_true(eye->kind == MESH_WIRE_PERSPECTIVE && eye->height == 0.5 && eye->aspect == 1.5);
    assert_true(eye->position[0] == 5 && eye->position[1] == 1 && eye->position[2] == 2);
    assert_true(fabs(eye->forward[0] + 1) < 1e-15 && fabs(eye->forward[2]) < 1e-15 && eye->up[1] == 1);
    assert_true(spot->kind == MESH_WIRE_SPOT && spot->power == 20 && spot->range == 0 && spot->inner == 0.25 &&
                spot->outer == 0.5);
    assert_true(spot->position[1] == 3 && spot->forward[2] == -1 && spot->color[1] == 0.5);
    mesh_import_destroy(got);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers_are_numbers_or_fractions),
        cmocka_unit_test(texture_coordinates_may_be_normalised_integers),
        cmocka_unit_test(elements_may_be_interleaved),
        cmocka_unit_test(sparse_accessors_replace_elements),
        cmocka_unit_test(accessors_outside_their_bytes_are_refused),
        cmocka_unit_test(strips_and_fans_are_triangles),
        cmocka_unit_test(lines_beside_triangles_are_noted),
        cmocka_unit_test(nodes_turn_scale_and_move),
        cmocka_unit_test(nodes_are_trees),
        cmocka_unit_test(nodes_are_nested_up_to_a_limit),
        cmocka_unit_test(one_scene_is_read),
        cmocka_unit_test(skins_follow_their_joints),
        cmocka_unit_test(names_of_buffers_are_decoded),
        cmocka_unit_test(buffers_are_taken_as_they_are),
        cmocka_unit_test(mistakes_have_their_place),
        cmocka_unit_test(small_files_need_little_memory),
        cmocka_unit_test(alpha_has_a_mode),
        cmocka_unit_test(one_color_of_all_vertices_is_the_materials),
        cmocka_unit_test(a_texture_without_coordinates_is_left_out),
        cmocka_unit_test(images_inside_the_file_are_carried),
        cmocka_unit_test(names_of_images_are_decoded_once),
        cmocka_unit_test(texture_coordinates_are_chosen_and_moved),
        cmocka_unit_test(glass_has_its_numbers),
        cmocka_unit_test(cameras_and_lights_are_read),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
