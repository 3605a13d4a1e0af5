/* Test fixtures: scenes as packages, and a scene with one of everything that is loaded, in a temporary folder. Each
 * call asserts that it succeeded. Ownership: scene_destroy releases scenes, free a package's bytes. */
#pragma once

#include "geometry/hierarchy/hierarchy.h"
#include "mesh_files.h"
#include "render_fixture.h"
#include "scene/package/package.h"

typedef struct package {
    char *at;
    size_t size;
} package;

static inline package packed(const scene *s)
{
    package p = {0};
    void *at;
    diagnostic why = {0};
    worked(scene_pack(s, &at, &p.size, &why), &why);
    p.at = at;
    assert_int_equal(p.size % 8, 0);
    return p;
}

static inline scene *unpacked(const package *p)
{
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_unpack(p->at, p->size, &s, &why), &why);
    return s;
}

/* An image with sides that are not powers of two. */
static inline void put_image(const char *name, float scale)
{
    image *img;
    diagnostic why = {0};
    worked(image_create(7, 5, &img, &why), &why);
    for (int i = 0; i < 7 * 5 * 3; i++)
        img->pixel[i] = scale * (float)(i % 11) / 11.0F;
    char *path = in_folder(name);
    worked(image_write(img, path, 8, &why), &why);
    free(path);
    image_destroy(img);
}

/* One of everything that is loaded: a sky, textures, meshes from a file with images, from generators, and a slime. */
static const char everything[] =
    "title: \"Ünusual: # title\"\n"
    "render: {width: 12, height: 9}\n"
    "background: {image: sky.pfm}\n"
    "textures: {a: {file: a.png, filter: trilinear}, b: {file: b.png, wrap_u: mirror, filter: nearest}}\n"
    "meshes: {model: {file: model.obj}, ball: {generate: icosphere, level: 1},\n"
    "  toy: {generate: slime, level: 1, time_s: 0.1}, ground: {generate: terrain, depth: 0, around: 4, tube: 4}}\n"
    "lights: {lamp: {position: [4, 7, -5]}}\n"
    "solids: {one: {shape: mesh, mesh: model}, two: {shape: mesh, mesh: ball, texture: a, position: [2, 0, 0]},\n"
    "  three: {shape: mesh, mesh: toy, transparency: 1, ior: 1.4}, four: {shape: mesh, mesh: ground, texture: b},\n"
    "  hidden: {shape: mesh, mesh: ball, visible: off}}\n";

static inline void put_everything(void)
{
    put_image("sky.pfm", 3.0F);
    put_image("a.png", 1.0F);
    put_image("b.png", 0.5F);
    put_text("model.mtl", "newmtl red\nKd 1 0.25 0.5\nKs 0.75 0.75 0.75\nNs 40\nmap_Kd a.png\nnewmtl plain\nKe 1 1 1\n"
                          "newmtl same\nKd 0.1 0.2 0.3\nd 0.5\nmap_Kd a.png\n");
    put_text("model.obj",
             "mtllib model.mtl\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\n"
             "v -1 1 1.125\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl red\nf 1/1 4/2 3/3\nf 1/1 3/2 2/3\nusemtl same\n"
             "f 5/1 6/2 7/3\nf 5/1 7/2 8/3\nusemtl plain\nf 1/1 2/2 6/3\n");
    put_text("all.yaml", everything);
}

/* All kinds of hierarchies for all its meshes, so that a render with any of them needs none. */
static inline scene *whole_scene(void)
{
    put_everything();
    char *path = in_folder("all.yaml");
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read(path, &s, &why), &why);
    free(path);
    worked(scene_load(s, &why), &why);
    for (size_t i = 0; i < s->mesh_count; i++)
        for (int kind = HIERARCHY_NONE; kind <= HIERARCHY_BVH; kind++) {
            const hierarchy *h;
            worked(hierarchy_of_mesh(s->meshes[i].data, (hierarchy_kind)kind, 1, &h, &why), &why);
        }
    return s;
}
