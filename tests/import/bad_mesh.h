/* Hostile mesh files for test_bad_meshes.c: small ones as text, the others as generators. */
#pragma once

typedef struct bad_mesh {
    const char *name, *text;
} bad_mesh;

#define THREE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#define PLY_HEAD(form, count, faces)                                                                             \
    "ply\nformat " form " 1.0\nelement vertex " count "\nproperty float x\nproperty float y\nproperty float z\n" \
    "element face " faces "\nproperty list uchar int vertex_indices\nend_header\n"
#define PLY_THREE "0 0 0\n1 0 0\n0 1 0\n"
#define FACET(a, b, c) "facet normal 0 0 1\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"

/* A glTF of one triangle: three positions, then three indices (uint16), 42 bytes. */
#define GLTF(nodes, meshes, accessors, views, buffers)                                            \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[" nodes \
    "],\"meshes\":[" meshes "],\"accessors\":[" accessors "],\"bufferViews\":[" views "],\"buffers\":[" buffers "]}"
#define NODES "{\"mesh\":0}"
#define MESHES "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}"
#define POSITIONS "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}"
#define INDICES "{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}"
#define ACCESSORS POSITIONS "," INDICES
#define VIEW_0 "{\"buffer\":0,\"byteLength\":36}"
#define VIEW_1 "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}"
#define VIEWS VIEW_0 "," VIEW_1
#define BASE64(indices) "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" indices
#define BUFFER(uri) "{\"byteLength\":42,\"uri\":\"" uri "\"}"
#define BUFFERS BUFFER(BASE64("AAABAAIA"))
/* A float in base64 is not aligned: the first 3 floats are 16 digits. NaN (0x7fc00000) in the first. */
#define BASE64_NAN "data:application/octet-stream;base64,AADAfwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"

static const bad_mesh bad_meshes[] = {
    /* OBJ */
    {"empty.obj", ""},
    {"text.obj", "this is not a mesh at all\n"},
    {"no_faces.obj", THREE},
    {"lines_only.obj", THREE "l 1 2\nl 2 3\n"},
    {"points_only.obj", THREE "p 1 2 3\n"},
    {"two_corners.obj", THREE "f 1 2\n"},
    {"face_past_the_end.obj", THREE "f 1 2 7\n"},
    {"face_just_past_the_end.obj", THREE "f 1 2 4\n"},
    {"face_zero.obj", THREE "f 0 1 2\n"},
    {"face_negative.obj", THREE "f -9 -2 -1\n"},
    {"face_before_vertices.obj", "f 1 2 3\n"},
    {"face_overflow.obj", THREE "f 1 2 4294967299\n"},
    {"face_overflow_64.obj", THREE "f 1 2 18446744073709551617\n"},
    {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"infinity.obj", "v 0 inf 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"far.obj", "v 0 0 1e12\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"overflow.obj", "v 0 0 1e60\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"nan_normal.obj", THREE "vn nan 0 1\nf 1//1 2//1 3//1\n"},
    {"nan_uv.obj", THREE "vt nan 0\nf 1/1 2/1 3/1\n"},
    {"one_coordinate.obj", "v 1\nv 2\nv 3\nf 1 2 3\n"},
    {"letters.obj", "v a b c\nv d e f\nv g h i\nf 1 2 3\n"},
    {"face_of_letters.obj", THREE "f a b c\n"},
    {"mtl_folder.obj", "mtllib folder\n" THREE "f 1 2 3\n"},
    {"mtl_fifo.obj", "mtllib fifo\n" THREE "f 1 2 3\n"},
    {"mtl_endless.obj", "mtllib /dev/zero\n" THREE "f 1 2 3\n"},
    {"texture_folder.obj", "mtllib texture_folder.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
    {"texture_fifo.obj", "mtllib texture_fifo.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
    {"color_nan.obj", "mtllib color_nan.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
    {"color_negative.obj", "mtllib color_negative.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
    {"opacity_of_two.obj", "mtllib opacity_of_two.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
    {"shininess_negative.obj", "mtllib shininess_negative.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
    /* PLY */
    {"empty.ply", ""},
    {"text.ply", "this is not a mesh at all\n"},
    {"magic_only.ply", "ply\n"},
    {"no_end_of_header.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"},
    {"no_format.ply",
     "ply\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n" PLY_THREE},
    {"unknown_format.ply", "ply\nformat klingon 1.0\nelement vertex 3\nproperty float x\nend_header\n1\n2\n3\n"},
    {"unknown_type.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nproperty quad y\nproperty quad "
                         "z\nend_header\n" PLY_THREE},
    {"no_faces.ply", PLY_HEAD("ascii", "3", "0") PLY_THREE},
    {"no_vertices.ply", PLY_HEAD("ascii", "0", "1") "3 0 1 2\n"},
    {"no_positions.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float q\nelement face 1\nproperty list "
                         "uchar int vertex_indices\n"
                         "end_header\n1\n2\n3\n3 0 1 2\n"},
    {"billion_vertices.ply", PLY_HEAD("ascii", "1000000000", "1") PLY_THREE "3 0 1 2\n"},
    {"billion_faces.ply", PLY_HEAD("ascii", "3", "1000000000") PLY_THREE "3 0 1 2\n"},
    {"billion_vertices_binary.ply", PLY_HEAD("binary_little_endian", "1000000000", "1") "0123456789ab"},
    {"billion_faces_binary.ply", PLY_HEAD("binary_little_endian", "1", "1000000000") "0123456789ab"},
    {"too_many_vertices.ply", PLY_HEAD("ascii", "99999999999999999999", "1") PLY_THREE "3 0 1 2\n"},
    {"negative_count.ply", PLY_HEAD("ascii", "-3", "1") PLY_THREE "3 0 1 2\n"},
    {"list_of_a_billion.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
     "element face 1\nproperty list uint int vertex_indices\nend_header\n" PLY_THREE "1000000000 0 1 2\n"},
    {"index_past_the_end.ply", PLY_HEAD("ascii", "3", "1") PLY_THREE "3 0 1 3\n"},
    {"index_negative.ply", PLY_HEAD("ascii", "3", "1") PLY_THREE "3 0 1 -1\n"},
    {"index_huge.ply", PLY_HEAD("ascii", "3", "1") PLY_THREE "3 0 1 2147483647\n"},
    {"nan.ply", PLY_HEAD("ascii", "3", "1") "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {"infinity.ply", PLY_HEAD("ascii", "3", "1") "inf 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {"truncated_vertices.ply", PLY_HEAD("ascii", "3", "1") "0 0 0\n1 0\n"},
    {"truncated_faces.ply", PLY_HEAD("ascii", "3", "2") PLY_THREE "3 0 1 2\n"},
    {"truncated_face.ply", PLY_HEAD("ascii", "3", "1") PLY_THREE "3 0 1"},
    /* STL */
    {"empty.stl", ""},
    {"text.stl", "this is not a mesh at all\n"},
    {"solid_only.stl", "solid a\n"},
    {"no_facets.stl", "solid a\nendsolid a\n"},
    {"nan.stl", "solid a\n" FACET("nan 0 0", "1 0 0", "0 1 0") "endsolid a\n"},
    {"infinity.stl", "solid a\n" FACET("inf 0 0", "1 0 0", "0 1 0") "endsolid a\n"},
    {"letters.stl", "solid a\n" FACET("a b c", "d e f", "g h i") "endsolid a\n"},
    {"two_vertices.stl",
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid a\n"},
    {"truncated_facet.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1"},
    {"far.stl", "solid a\n" FACET("1e30 0 0", "1 0 0", "0 1 0") "endsolid a\n"},
    /* glTF */
    {"empty.gltf", ""},
    {"text.gltf", "this is not a mesh at all\n"},
    {"object.gltf", "{}"},
    {"list.gltf", "[]"},
    {"null.gltf", "null"},
    {"cut.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nod"},
    {"no_asset.gltf", "{\"scene\":0,\"scenes\":[{\"nodes\":[]}]}"},
    {"version_9.gltf", "{\"asset\":{\"version\":\"9.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[]}]}"},
    {"no_nodes.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[]}]}"},
    {"scene_past_the_end.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scene\":7,\"scenes\":[{\"nodes\":[]}]}"},
    {"node_past_the_end.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[5]}],\"nodes\":[{}]}"},
    {"node_of_letters.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[\"a\"]}],\"nodes\":[{}]}"},
    {"node_its_own_child.gltf", GLTF("{\"mesh\":0,\"children\":[0]}", MESHES, ACCESSORS, VIEWS, BUFFERS)},
    {"nodes_in_a_circle.gltf",
     GLTF("{\"mesh\":0,\"children\":[1]},{\"children\":[2]},{\"children\":[0]}", MESHES, ACCESSORS, VIEWS, BUFFERS)},
    {"mesh_past_the_end.gltf", GLTF("{\"mesh\":1}", MESHES, ACCESSORS, VIEWS, BUFFERS)},
    {"mesh_negative.gltf", GLTF("{\"mesh\":-1}", MESHES, ACCESSORS, VIEWS, BUFFERS)},
    {"matrix_far.gltf", GLTF("{\"mesh\":0,\"scale\":[1e30,1e30,1e30]}", MESHES, ACCESSORS, VIEWS, BUFFERS)},
    {"matrix_of_letters.gltf", GLTF("{\"mesh\":0,\"matrix\":\"abc\"}", "\"a\"", ACCESSORS, VIEWS, BUFFERS)},
    {"no_primitives.gltf", GLTF(NODES, "{}", ACCESSORS, VIEWS, BUFFERS)},
    {"no_positions.gltf",
     GLTF(NODES, "{\"primitives\":[{\"attributes\":{},\"indices\":1}]}", ACCESSORS, VIEWS, BUFFERS)},
    {"accessor_past_the_end.gltf",
     GLTF(NODES, "{\"primitives\":[{\"attributes\":{\"POSITION\":9},\"indices\":1}]}", ACCESSORS, VIEWS, BUFFERS)},
    {"indices_past_the_end.gltf",
     GLTF(NODES, "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":9}]}", ACCESSORS, VIEWS, BUFFERS)},
    {"material_past_the_end.gltf",
     GLTF(NODES, "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":3}]}", ACCESSORS, VIEWS,
          BUFFERS)},
    {"count_huge.gltf",
     GLTF(NODES, MESHES, "{\"bufferView\":0,\"componentType\":5126,\"count\":1000000000,\"type\":\"VEC3\"}," INDICES,
          VIEWS, BUFFERS)},
    {"count_of_indices_huge.gltf",
     GLTF(NODES, MESHES,
          POSITIONS ",{\"bufferView\":1,\"componentType\":5123,\"count\":1000000000,\"type\":\"SCALAR\"}", VIEWS,
          BUFFERS)},
    {"count_negative.gltf",
     GLTF(NODES, MESHES, "{\"bufferView\":0,\"componentType\":5126,\"count\":-3,\"type\":\"VEC3\"}," INDICES, VIEWS,
          BUFFERS)},
    {"count_of_views_of_none.gltf",
     GLTF(NODES, MESHES, "{\"componentType\":5126,\"count\":1000000000,\"type\":\"VEC3\"}," INDICES, VIEWS, BUFFERS)},
    {"component_unknown.gltf",
     GLTF(NODES, MESHES, "{\"bufferView\":0,\"componentType\":1,\"count\":3,\"type\":\"VEC3\"}," INDICES, VIEWS,
          BUFFERS)},
    {"offset_past_the_end.gltf",
     GLTF(NODES, MESHES,
          "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}," INDICES, VIEWS,
          BUFFERS)},
    {"offset_overflow.gltf", GLTF(NODES, MESHES,
                                  "{\"bufferView\":0,\"byteOffset\":18446744073709551600,\"componentType\":5126,"
                                  "\"count\":3,\"type\":\"VEC3\"}," INDICES,
                                  VIEWS, BUFFERS)},
    {"sparse_past_the_end.gltf", GLTF(NODES, MESHES,
                                      "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
                                      "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":9,"
                                      "\"componentType\":5123},\"values\":{\"bufferView\":9}}}," INDICES,
                                      VIEWS, BUFFERS)},
    {"view_past_the_end.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEW_0, BUFFERS)},
    {"view_longer_than_buffer.gltf",
     GLTF(NODES, MESHES, ACCESSORS, "{\"buffer\":0,\"byteLength\":3600}," VIEW_1, BUFFERS)},
    {"view_after_buffer.gltf",
     GLTF(NODES, MESHES, ACCESSORS, "{\"buffer\":0,\"byteOffset\":1000000,\"byteLength\":36}," VIEW_1, BUFFERS)},
    {"view_of_no_buffer.gltf", GLTF(NODES, MESHES, ACCESSORS, "{\"buffer\":4,\"byteLength\":36}," VIEW_1, BUFFERS)},
    {"stride_huge.gltf",
     GLTF(NODES, MESHES, ACCESSORS, "{\"buffer\":0,\"byteLength\":36,\"byteStride\":1000000}," VIEW_1, BUFFERS)},
    {"buffer_missing.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER("nowhere.bin"))},
    {"buffer_folder.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER("folder"))},
    {"buffer_fifo.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER("fifo"))},
    {"buffer_endless.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER("/dev/zero"))},
    {"buffer_without_bytes.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, "{\"byteLength\":42}")},
    {"buffer_too_short.gltf",
     GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER("data:application/octet-stream;base64,AAAA"))},
    {"buffer_not_base64.gltf",
     GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER("data:application/octet-stream;base64,!!!!!"))},
    {"buffer_of_terabytes.gltf",
     GLTF(NODES, MESHES, ACCESSORS, VIEWS, "{\"byteLength\":4398046511104,\"uri\":\"" BASE64("AAABAAIA") "\"}")},
    {"index_past_the_end.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER(BASE64("AAABAP//")))},
    {"nan.gltf", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFER(BASE64_NAN))},
    /* glb */
    {"empty.glb", ""},
    {"text.glb", "this is not a mesh at all\n"},
    {"json.glb", GLTF(NODES, MESHES, ACCESSORS, VIEWS, BUFFERS)},
    {"magic_only.glb", "glTF"},
    /* unsupported files */
    {"scene.yaml", "solids: {}\n"},
    {"no_ending", "v 0 0 0\n"},
    {"blender.blend", "BLENDER-v279"},
    {"collada.dae", "<COLLADA/>"},
};

/* Files that name others, which do not exist: read, with a note. */
static const bad_mesh tolerated_meshes[] = {
    {"mtl_missing.obj", "mtllib nowhere.mtl\n" THREE "f 1 2 3\n"},
    {"mtl_absolute.obj", "mtllib /nowhere/a.mtl\n" THREE "f 1 2 3\n"},
    {"texture_missing.obj", "mtllib texture_missing.mtl\nusemtl a\n" THREE "f 1 2 3\n"},
};

/* Other files to which some of them refer. */
static const bad_mesh companions[] = {
    {"texture_missing.mtl", "newmtl a\nmap_Kd nowhere.png\n"}, {"texture_folder.mtl", "newmtl a\nmap_Kd folder\n"},
    {"texture_fifo.mtl", "newmtl a\nmap_Kd fifo\n"},           {"color_nan.mtl", "newmtl a\nKd nan 0 0\n"},
    {"color_negative.mtl", "newmtl a\nKd -1 0 0\n"},           {"opacity_of_two.mtl", "newmtl a\nd 2\n"},
    {"shininess_negative.mtl", "newmtl a\nNs -5\n"},
};
