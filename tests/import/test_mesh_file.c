/* Tests of valid mesh files: the imported values equal those of the file. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mesh_read.h"

/* The tetrahedron of mesh_files.h, every corner bit-identical, moved by x. */
static void assert_tetrahedron(const mesh_import *got, double x)
{
    const mesh *m = got->mesh;
    assert_int_equal(m->vertex_count, 4);
    assert_int_equal(m->triangle_count, 4);
    for (size_t f = 0; f < 4; f++) {
        for (int k = 0; k < 3; k++) {
            const float *expected = corners[faces[f][k]];
            assert_vec3(corner(m, f, k), (double)expected[0] + x, (double)expected[1], (double)expected[2]);
        }
    }
    assert_true(m->closed);
    assert_null(m->normals);
    assert_null(m->uvs);
}

static void an_obj_with_two_materials_is_read(void **state)
{
    (void)state;
    put_text("paint.png", "an image");
    put_text("two.mtl",
             "newmtl red\nKa 0.125 0 0\nKd 1 0.25 0.5\nKs 0.75 0.75 0.75\nNs 40\nKe 3 0.5 0\nmap_Kd paint.png\n"
             "newmtl glass\nKd 0.5 0.5 0.5\nd 0.25\nNi 1.5\nnewmtl unused\nKd 0 0 0\n");
    mesh_import *got = read_text("two.obj", "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 2.5 0\nv 0 2.5 -0.125\nv 7 7 7\n"
                                            "vt 0 0\nvt 1 0\nvt 1 0.75\nvt 0.0625 1\n"
                                            "usemtl red\nf 1/1 2/2 3/3\nusemtl glass\nf 1/1 3/3 4/4\n");
    const mesh *m = got->mesh;
    assert_int_equal(m->triangle_count, 2);
    assert_int_equal(m->vertex_count, 4); /* shared between the materials; the fifth vertex belongs to no face */
    assert_vec3(corner(m, 0, 2), 1, 2.5, 0);
    assert_vec3(corner(m, 1, 2), 0, 2.5, -0.125);
    mesh_uv uv = m->uvs[m->triangles[0].corner[2]];
    assert_true(uv.u == 1 && uv.v == 0.75); /* v increases upwards, as in the file */
    assert_true(m->single);
    assert_false(m->closed);
    assert_int_equal(got->material_count, 2);
    assert_int_equal(m->slot_count, 2);
    const imported_material *red = &got->materials[m->slots[0]], *glass = &got->materials[m->slots[1]];
    assert_string_equal(red->name, "red");
    assert_string_equal(m->slot_names[m->slots[1]], "glass");
    assert_true(red->given && glass->given);
    assert_true(red->color[0] == 1 && red->color[1] == 0.25 && red->color[2] == 0.5);
    assert_true(red->ambient[0] == 0.125 && red->specular[2] == 0.75 && red->shininess == 40 && red->opacity == 1);
    assert_true(red->emissive[0] == 3 && red->emissive[1] == 0.5 && red->emissive[2] == 0 && glass->emissive[0] == 0);
    assert_true(glass->opacity == 0.25 && glass->ior == 1.5);
    assert_null(glass->texture.path);
    char *img = in_folder("paint.png");
    assert_string_equal(red->texture.path, img);
    free(img);
    mesh_import_destroy(got);
}

/* Regression: the room for one vertex did not grow, so that further ones were written beyond it. */
static void one_position_may_have_several_texture_coordinates(void **state)
{
    (void)state;
    mesh_import *got = read_text("one.obj", "v 0.0 0.0 0.0\nvt 0.0 0.0\nvt 1.0 0.0\nvt 0.0 1.0\nvt 1.0 1.0\n"
                                            "f 1/1 1/2 1/3\nf 1/2 1/3 1/4\n");
    assert_int_equal(got->mesh->triangle_count, 2);
    assert_int_equal(got->mesh->vertex_count, 4);
    mesh_import_destroy(got);
}

static void texture_paths_are_found_in_other_spellings(void **state)
{
    (void)state;
    put_text("my paint.png", "an image");
    char *img = in_folder("my paint.png");
    static const char *const spellings[] = {"my paint.png", ".\\my paint.png", "my%20paint.png"};
    for (size_t i = 0; i < sizeof spellings / sizeof *spellings; i++) {
        char *library = text_format("newmtl a\nmap_Kd %s\n", spellings[i]);
        put_text("spelling.mtl", library);
        free(library);
        mesh_import *got =
            read_text("spelling.obj", "mtllib spelling.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        assert_non_null(got->materials[0].texture.path);
        assert_int_equal(access(got->materials[0].texture.path, R_OK), 0);
        mesh_import_destroy(got);
    }
    free(img);
}

static void obj_polygons_are_triangulated(void **state)
{
    (void)state;
    mesh_import *got =
        read_text("square.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvn 0 0 2\nf 1//1 2//1 3//1 4//1\nl 1 2\n");
    assert_int_equal(got->mesh->triangle_count, 2);
    assert_int_equal(got->mesh->vertex_count, 4);
    assert_true(mesh_area(got->mesh) == 4);
    assert_vec3(got->mesh->normals[0], 0, 0, 1); /* normalised now */
    assert_int_equal(got->material_count, 1);
    assert_false(got->materials[0].given);
    assert_null(got->materials[0].name);
    mesh_import_destroy(got);
}

static void nearly_coincident_vertices_are_not_merged(void **state)
{
    (void)state;
    mesh_import *got = read_text("tiny.obj", "v 0 0 0\nv 1e-7 0 0\nv 0 1e-7 0\nf 1 2 3\n");
    assert_int_equal(got->mesh->vertex_count, 3);
    assert_vec3(corner(got->mesh, 0, 1), 1e-7, 0, 0);
    mesh_import_destroy(got);
}

static void an_ascii_ply_is_read(void **state)
{
    (void)state;
    mesh_import *got = read_text(
        "a.ply", "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1.5 0 0\n1.5 0.25 0\n0 0.25 -8\n4 0 1 2 3\n");
    assert_int_equal(got->mesh->triangle_count, 2);
    assert_int_equal(got->mesh->vertex_count, 4);
    assert_vec3(got->mesh->vertices[3], 0, 0.25, -8);
    assert_false(got->materials[0].given);
    mesh_import_destroy(got);
}

static void a_binary_ply_is_read_exactly(void **state)
{
    (void)state;
    mesh_import *got = read_bytes("b.ply", binary_ply());
    assert_tetrahedron(got, 0);
    assert_true(got->mesh->single);
    mesh_import_destroy(got);
}

static void an_ascii_stl_is_read(void **state)
{
    (void)state;
    mesh_import *got = read_text(
        "a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.25 0 0\nvertex 0 -1e3 0.5\nendloop\n"
                 "endfacet\nendsolid a\n");
    assert_int_equal(got->mesh->triangle_count, 1);
    assert_vec3(corner(got->mesh, 0, 1), 1.25, 0, 0);
    assert_vec3(corner(got->mesh, 0, 2), 0, -1000, 0.5);
    assert_null(got->mesh->normals);
    mesh_import_destroy(got);
}

/* Facets share their corners again, although each has its own normal in the file. */
static void a_binary_stl_is_read_exactly(void **state)
{
    (void)state;
    mesh_import *got = read_bytes("b.stl", binary_stl());
    assert_tetrahedron(got, 0);
    assert_true(got->mesh->single);
    mesh_import_destroy(got);
}

static void a_glb_is_read_exactly(void **state)
{
    (void)state;
    mesh_import *got = read_bytes("a.glb", tetrahedron_glb("{\"mesh\":0}"));
    assert_tetrahedron(got, 0);
    assert_int_equal(got->material_count, 1);
    const imported_material *glass = &got->materials[0];
    assert_string_equal(glass->name, "glass");
    assert_true(glass->color[0] == 0.25 && glass->color[1] == 0.5 && glass->color[2] == 0.75 && glass->opacity == 0.5);
    mesh_import_destroy(got);
}

/* Translated in double precision: the sum is not rounded to a float. */
static void nodes_translate_their_meshes_in_double_precision(void **state)
{
    (void)state;
    mesh_import *got = read_bytes("moved.glb", tetrahedron_glb("{\"mesh\":0,\"translation\":[1000,0,0]}"));
    assert_tetrahedron(got, 1000);
    assert_false(got->mesh->single);
    mesh_import_destroy(got);
    got = read_bytes(
        "nested.glb",
        tetrahedron_glb("{\"children\":[1],\"translation\":[600,0,0]},{\"mesh\":0,\"translation\":[400,0,0]}"));
    assert_tetrahedron(got, 1000);
    mesh_import_destroy(got);
    got = read_bytes("twice.glb",
                     tetrahedron_glb("{\"children\":[1,2]},{\"mesh\":0},{\"mesh\":0,\"translation\":[10,0,0]}"));
    assert_int_equal(got->mesh->triangle_count, 8);
    assert_int_equal(got->mesh->vertex_count, 8);
    mesh_import_destroy(got);
}

/* A mirror turns fronts into backs, unless the corners are also listed in reverse. A quarter turn, column by column. */
static void mirrored_and_rotated_nodes_keep_their_orientation(void **state)
{
    (void)state;
    mesh_import *plain = read_bytes("plain.glb", tetrahedron_glb("{\"mesh\":0}"));
    mesh_import *mirrored = read_bytes("mirror.glb", tetrahedron_glb("{\"mesh\":0,\"scale\":[-2,1,1]}"));
    assert_true(mesh_volume(plain->mesh) > 0);
    assert_true(fabs(mesh_volume(mirrored->mesh) - 2 * mesh_volume(plain->mesh)) < 1e-14);
    assert_vec3(corner(mirrored->mesh, 0, 0), -2 * (double)corners[0][0], (double)corners[0][1], (double)corners[0][2]);
    assert_vec3(corner(mirrored->mesh, 0, 1), -2 * (double)corners[1][0], (double)corners[1][1], (double)corners[1][2]);
    mesh_import_destroy(mirrored);
    mesh_import_destroy(plain);
    mesh_import *turned =
        read_bytes("turn.glb", tetrahedron_glb("{\"mesh\":0,\"matrix\":[0,1,0,0,-1,0,0,0,0,0,1,0,5,0,0,1]}"));
    assert_vec3(corner(turned->mesh, 0, 0), 5 - (double)corners[0][1], (double)corners[0][0], (double)corners[0][2]);
    mesh_import_destroy(turned);
}

/* (0 0 0) (1 0 0) (0 1 0) as floats, then 0 1 2 as uint16. */
static mesh_import *one_triangle(const char *node)
{
    char *text = text_format(
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}],"
        "\"buffers\":[{\"byteLength\":42,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA\"}]}",
        node);
    assert_non_null(text);
    mesh_import *got = read_text("inside.gltf", text);
    free(text);
    return got;
}

static void a_gltf_with_an_embedded_buffer_is_read(void **state)
{
    (void)state;
    mesh_import *got = one_triangle("{\"mesh\":0,\"translation\":[0,0,0.5]}");
    assert_int_equal(got->mesh->triangle_count, 1);
    assert_vec3(corner(got->mesh, 0, 0), 0, 0, 0.5);
    assert_vec3(corner(got->mesh, 0, 1), 1, 0, 0.5);
    assert_vec3(corner(got->mesh, 0, 2), 0, 1, 0.5);
    assert_false(got->materials[0].given);
    mesh_import_destroy(got);
    got = one_triangle("{\"mesh\":0,\"scale\":[-1,1,1]}"); /* the mesh is open: nothing else inverts it */
    assert_vec3(corner(got->mesh, 0, 1), 0, 1, 0);
    assert_vec3(corner(got->mesh, 0, 2), -1, 0, 0);
    mesh_import_destroy(got);
}

static void unusual_file_names_are_read(void **state)
{
    (void)state;
    static const char *const names[] = {"-o.obj", "a b;c: d.obj", "$(touch x).obj", "LOUD.OBJ"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        mesh_import_destroy(read_text(names[i], "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_obj_with_two_materials_is_read),
        cmocka_unit_test(one_position_may_have_several_texture_coordinates),
        cmocka_unit_test(texture_paths_are_found_in_other_spellings),
        cmocka_unit_test(obj_polygons_are_triangulated),
        cmocka_unit_test(nearly_coincident_vertices_are_not_merged),
        cmocka_unit_test(an_ascii_ply_is_read),
        cmocka_unit_test(a_binary_ply_is_read_exactly),
        cmocka_unit_test(an_ascii_stl_is_read),
        cmocka_unit_test(a_binary_stl_is_read_exactly),
        cmocka_unit_test(a_glb_is_read_exactly),
        cmocka_unit_test(nodes_translate_their_meshes_in_double_precision),
        cmocka_unit_test(mirrored_and_rotated_nodes_keep_their_orientation),
        cmocka_unit_test(a_gltf_with_an_embedded_buffer_is_read),
        cmocka_unit_test(unusual_file_names_are_read),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
