/* Loads the files of a scene (background image, textures, meshes), and makes its generated meshes. */
#include "base/cancel.h"
#include "base/file.h"
#include "base/random.h"
#include "geometry/mesh/mesh_generators.h"
#include "geometry/shapes/shape.h"
#include "import/mesh_wire.h"
#include "scene/assets/mesh_stream.h"
#include "scene/assets/slime.h"
#include "scene/data/optical_files.h"
#include "scene/model/face_materials.h"
#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- generated meshes --- */

/* Value noise: random values at the points of a grid, interpolated with the fade curve 6 s^5 - 15 s^4 + 10 s^3 (Perlin,
 * "Improving noise", SIGGRAPH 2002). x and z are in cells of the grid. Result 0 to 1. */
static double noise(int64_t seed, uint32_t octave, double x, double z)
{
    const double cx = floor(x), cz = floor(z), s = x - cx, r = z - cz;
    double corner[2][2];
    for (int k = 0; k < 4; k++) {
        const uint32_t across = (uint32_t)(int64_t)cx + (uint32_t)(k & 1),
                       down = (uint32_t)(int64_t)cz + (uint32_t)(k >> 1);
        corner[k >> 1][k & 1] = random_unit(random_at((uint64_t)seed, across, down, octave, 0).word[0]);
    }
    const double u = s * s * s * (s * (s * 6.0 - 15.0) + 10.0), v = r * r * r * (r * (r * 6.0 - 15.0) + 10.0);
    const double low = corner[0][0] + u * (corner[0][1] - corner[0][0]),
                 high = corner[1][0] + u * (corner[1][1] - corner[1][0]);
    return low + v * (high - low);
}

/* Hills: five octaves of noise, each with half the amplitude and twice the frequency of the one before. */
static status make_terrain(const mesh_entry *m, mesh **out, diagnostic *why)
{
    enum { OCTAVES = 5, CELLS = 4 };
    const int columns = (int)m->around + 1, rows = (int)m->tube + 1;
    double *heights = malloc((size_t)columns * (size_t)rows * sizeof *heights);
    if (!heights)
        return out_of_memory(why);
    for (int row = 0; row < rows && !cancel_asked(); row++) {
        for (int column = 0; column < columns; column++) {
            double sum = 0.0, weight = 0.5, fine = CELLS;
            for (uint32_t k = 0; k < OCTAVES; k++, weight *= 0.5, fine *= 2.0)
                sum += weight * noise(m->seed, k, fine * column / (columns - 1), fine * row / (rows - 1));
            heights[(size_t)row * (size_t)columns + (size_t)column] = m->size.y * sum;
        }
    }
    status code = cancel_check(why);
    THEN(code, generate_height_field(heights, columns, rows, m->size.x, m->size.z, m->depth, out, why));
    free(heights);
    return code;
}

static status make_lathe(const mesh_entry *m, mesh **out, diagnostic *why)
{
    profile_point profile[NUMBER_LIST_MAX / 2];
    const size_t count = (size_t)m->profile.count / 2;
    for (size_t i = 0; i < count; i++)
        profile[i] = (profile_point){m->profile.value[2 * i], m->profile.value[2 * i + 1]};
    return generate_lathe(profile, count, (int)m->around, m->crease_deg, out, why);
}

static status generate(const mesh_entry *m, mesh **out, diagnostic *why)
{
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE: return generate_sparse_soup((size_t)m->count, out, why);
    case MESH_DENSE: return generate_dense_soup((size_t)m->count, out, why);
    case MESH_SPHERE: return generate_sphere((size_t)m->count, out, why);
    case MESH_ICOSPHERE: return generate_icosphere((int)m->level, out, why);
    case MESH_TORUS: return generate_torus(m->major, m->minor, (int)m->around, (int)m->tube, out, why);
    case MESH_LATHE: return make_lathe(m, out, why);
    case MESH_TERRAIN: return make_terrain(m, out, why);
    case MESH_BOX: return generate_box(m->size, out, why);
    case MESH_FILE:
    case MESH_SLIME:
    case MESH_ARRAYS: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "set its triangles, or another source", "%.80s has no triangles", m->name);
}

/* The size of a generated mesh before it is made; 0 for shapes that are always small. A terrain with a bottom has
 * slightly more vertices and triangles. */
static void size_of(const mesh_entry *m, size_t *vertices, size_t *triangles)
{
    const size_t count = (size_t)m->count, around = (size_t)m->around, tube = (size_t)m->tube;
    size_t f = 0; /* triangles along an edge of the icosahedron */
    *vertices = *triangles = 0;
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE:
    case MESH_DENSE: *vertices = 3 * count, *triangles = count; return;
    case MESH_SPHERE: f = (size_t)floor(sqrt((double)count / 20.0) + 0.5); break;
    case MESH_ICOSPHERE: f = (size_t)1 << m->level; break;
    case MESH_TORUS:
    case MESH_TERRAIN: *vertices = (around + 1) * (tube + 1), *triangles = 2 * around * tube; return;
    case MESH_LATHE: /* small */
    case MESH_BOX:
    case MESH_FILE:
    case MESH_SLIME:
    case MESH_ARRAYS: return;
    }
    *vertices = 10 * (f + 1) * (f + 2);
    *triangles = 20 * f * f;
}

static size_t planned_triangles(const mesh_entry *m)
{
    size_t vertices, triangles;
    size_of(m, &vertices, &triangles);
    return triangles;
}

static status make_mesh(mesh_entry *m, diagnostic *why)
{
    mesh *made = NULL;
    size_t vertices, triangles;
    size_of(m, &vertices, &triangles);
    const bool smooth = m->source != MESH_SPARSE && m->source != MESH_DENSE;
    TRY(mesh_check_size(vertices, triangles, smooth, smooth, false, why));
    const status code = generate(m, &made, why);
    m->data = made;
    return code;
}

/* --- meshes from files, and the materials in them --- */

#define EMISSION_MAX 1e4 /* as in the parameter table */

static double at_most_one(double value)
{
    return value < 1.0 ? value : 1.0;
}

/* Whether two textures are the same image, laid on in the same way. */
static bool same_image(const imported_texture *a, const imported_texture *b)
{
    const bool same = a->path ? b->path && strcmp(a->path, b->path) == 0 : a->image && !b->path && a->image == b->image;
    return same && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v && a->filter == b->filter;
}

/* The image of an earlier slot, or of this one. */
static const texture *image_before(const mesh_import *imported, int slot, const imported_texture *t,
                                   const face_material *list)
{
    for (int i = 0; i <= slot; i++) {
        if (list[i].img && same_image(&imported->materials[i].texture, t))
            return list[i].img;
        if (list[i].glow_img && same_image(&imported->materials[i].glow, t))
            return list[i].glow_img;
    }
    return NULL;
}

/* glTF 2.0, 5.19: what images say of their colour space is ignored. */
static bool is_gltf(const char *path)
{
    return strcasestr(file_name_of(path), ".gltf") || strcasestr(file_name_of(path), ".glb");
}

/* Reads an image of a slot, if it has one, from a file or from inside the mesh file at mesh_path, or retains an earlier
 * one. */
static status read_image(const mesh_import *imported, int slot, const imported_texture *t, const char *mesh_path,
                         const char *root, const face_material *list, const texture **out, diagnostic *why)
{
    static const texture_wrap wraps[] = {
        [MESH_WIRE_REPEAT] = TEXTURE_REPEAT, [MESH_WIRE_MIRROR] = TEXTURE_MIRROR, [MESH_WIRE_CLAMP] = TEXTURE_CLAMP};
    static const texture_filter filters[] = {[MESH_WIRE_TRILINEAR] = TEXTURE_TRILINEAR,
                                             [MESH_WIRE_BILINEAR] = TEXTURE_BILINEAR,
                                             [MESH_WIRE_NEAREST] = TEXTURE_NEAREST};
    if (!imported_texture_exists(t))
        return STATUS_OK;
    if ((*out = image_before(imported, slot, t, list))) {
        texture_retain(*out);
        return STATUS_OK;
    }
    texture *img;
    const texture_space space = is_gltf(mesh_path) ? TEXTURE_GLTF : TEXTURE_SRGB;
    const texture_wrap u = wraps[t->wrap_u], v = wraps[t->wrap_v];
    const texture_filter filter = filters[t->filter];
    if (t->path) {
        TRY(texture_read_below(t->path, root, space, u, v, filter, &img, why));
    } else {
        const imported_image *inside = &imported->images[t->image - 1];
        TRY(locate_failure(why, mesh_path,
                           texture_decode(inside->bytes, inside->size, space, u, v, filter, &img, why)));
    }
    *out = img;
    return STATUS_OK;
}

static double brightest(vec3 color)
{
    return fmax(color.x, fmax(color.y, color.z));
}

static void emit(face_material *mat, const imported_material *m)
{
    const vec3 sent = vec3_make(m->emissive[0], m->emissive[1], m->emissive[2]);
    if (!(brightest(sent) > 0.0))
        return;
    mat->glow = vec3_scale(sent, 1.0 / brightest(sent));
    mat->emission = fmin(brightest(sent), EMISSION_MAX);
}

/* Material files have a colour for each term of Phong's equation, this program a coefficient: the brightest channel. */
static face_material face_material_of(const imported_material *m)
{
    face_material mat = {.given = m->given,
                         .diffuse = 1.0,
                         .shininess = m->shininess,
                         .opacity = m->opacity,
                         .alpha = (material_alpha)m->alpha_mode,
                         .alpha_cutoff = m->alpha_cutoff};
    snprintf(mat.name, sizeof mat.name, "%s", m->name ? m->name : "");
    mat.color = vec3_make(at_most_one(m->color[0]), at_most_one(m->color[1]), at_most_one(m->color[2]));
    /* A highlight without an exponent is ignored: with exponent 0 it would cover the whole surface. */
    for (int c = 0; c < 3 && m->shininess > 0.0; c++)
        mat.specular = m->specular[c] > mat.specular ? at_most_one(m->specular[c]) : mat.specular;
    emit(&mat, m);
    return mat;
}

static status read_face_materials(const mesh_import *imported, const char *mesh_path, const char *root,
                                  face_material *list, diagnostic *why)
{
    for (int i = 0; i < imported->material_count; i++) {
        list[i] = face_material_of(&imported->materials[i]);
        const imported_material *m = &imported->materials[i];
        TRY(read_image(imported, i, &m->texture, mesh_path, root, list, &list[i].img, why));
        if (list[i].emission > 0.0)
            TRY(read_image(imported, i, &m->glow, mesh_path, root, list, &list[i].glow_img, why));
    }
    return STATUS_OK;
}

/* Converts the importer's result; reads its image files, each once, below root (base/file.h). A diagnostic has the
 * path of the image file. */
static status make_face_materials(const mesh_import *imported, const char *mesh_path, const char *root,
                                  const face_materials **out, diagnostic *why)
{
    const int count = imported->material_count;
    face_material *list = calloc((size_t)count, sizeof *list);
    if (!list)
        return out_of_memory(why);
    status code = read_face_materials(imported, mesh_path, root, list, why);
    if (code == STATUS_OK)
        code = face_materials_of(list, count, imported->note ? imported->note : "", out, why);
    else
        for (int i = 0; i < count; i++)
            texture_release(list[i].img), texture_release(list[i].glow_img);
    free(list);
    return code;
}

static status read_mesh_file(mesh_entry *m, const char *path, const load_limits *limits, diagnostic *why)
{
    const bool points = mesh_is_points(path),
               right_handed = m->handedness == HANDEDNESS_FILE ? !points : m->handedness == HANDEDNESS_RIGHT;
    const mesh_limits import_limits = {
        .root = limits->root, .triangles = limits->triangles, .right_handed = right_handed};
    mesh_import *imported;
    TRY(points ? mesh_points_read(path, limits->root, right_handed, &imported, why)
               : mesh_read_file(path, &import_limits, &imported, why));
    status code = points ? STATUS_OK : make_face_materials(imported, path, limits->root, &m->shading_materials, why);
    if (code == STATUS_OK) {
        m->data = imported->mesh;
        mesh_retain(m->data);
    }
    mesh_import_destroy(imported);
    return code;
}

/* --- the scene --- */

static status load_sky(scene *s, diagnostic *why)
{
    background *sky = &s->background;
    if (sky->kind != BACKGROUND_IMAGE || sky->img || !sky->image_path[0])
        return STATUS_OK;
    char *path = scene_file_path(s, sky->image_path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    status code = image_read_below(path, s->limits.root, IMAGE_LIGHT, &sky->img, NULL, &bad);
    if (code == STATUS_OK && (code = sky_take(sky, path, &bad)) != STATUS_OK) {
        image_destroy(sky->img);
        sky->img = NULL;
    }
    free(path);
    return code == STATUS_OK
               ? code
               : scene_file_error(s, "background.image", sky->image_line, sky->image_column, &bad, code, why);
}

static status load_texture(const scene *s, texture_entry *t, diagnostic *why)
{
    char *path = scene_file_path(s, t->path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    texture *data = NULL;
    const status code = texture_read_below(path, s->limits.root, (texture_space)t->space, (texture_wrap)t->wrap_u,
                                           (texture_wrap)t->wrap_v, (texture_filter)t->filter, &data, &bad);
    free(path);
    t->data = data;
    return code == STATUS_OK ? code : scene_file_error(s, t->name, t->path_line, t->path_column, &bad, code, why);
}

static status load_data(const scene *s, data_entry *d, diagnostic *why)
{
    char *path = scene_file_path(s, d->path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    const status code =
        optical_file_read(path, s->limits.root, &(optical_file_choice){d->glass, d->column, d->scale}, &d->data, &bad);
    free(path);
    return code == STATUS_OK ? code : scene_file_error(s, d->name, d->path_line, d->path_column, &bad, code, why);
}

static bool values_equal(const param *row, const char *a, const char *b)
{
    char *x = param_value_text(row, -1, a + row->offset), *y = param_value_text(row, -1, b + row->offset);
    const bool same = x && y && strcmp(x, y) == 0;
    free(x);
    free(y);
    return same;
}

static bool meshes_equal(const mesh_entry *a, const mesh_entry *b)
{
    bool same = true;
    for (size_t i = 0; i < param_count() && same; i++) {
        const param *row = param_at(i);
        same = row->group != PARAM_MESH || values_equal(row, (const char *)a, (const char *)b);
    }
    return same;
}

void scene_retain_meshes(scene *s, const scene *from)
{
    for (size_t i = 0; i < s->mesh_count; i++) {
        mesh_entry *m = &s->meshes[i];
        const bool simulates = m->source == MESH_SLIME && !s->render.keep;
        for (size_t k = 0; k < from->mesh_count && !m->data && !simulates; k++) {
            const mesh_entry *other = &from->meshes[k];
            if (!other->data || !meshes_equal(m, other))
                continue;
            m->data = other->data;
            m->shading_materials = other->shading_materials;
            m->account = other->account;
            m->motion_s = other->motion_s;
            mesh_retain(m->data);
            face_materials_retain(m->shading_materials);
        }
    }
}

static status load_mesh(const scene *s, mesh_entry *m, diagnostic *why)
{
    char *path = scene_file_path(s, m->path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    const status code = read_mesh_file(m, path, &s->limits, &bad);
    free(path);
    return code == STATUS_OK ? code : scene_file_error(s, m->name, m->path_line, m->path_column, &bad, code, why);
}

/* Fails if the triangles of all meshes exceed the limit. `further`: the triangles of m if it is not generated yet. */
static status check_triangles(const scene *s, mesh_entry *m, size_t further, diagnostic *why)
{
    size_t all = further;
    for (size_t i = 0; i < s->mesh_count; i++)
        all += s->meshes[i].data ? s->meshes[i].data->triangle_count : 0;
    if (!s->limits.triangles || all <= s->limits.triangles)
        return STATUS_OK;
    diagnostic bad = {.what = ""};
    const status code =
        diagnose(&bad, STATUS_BAD_INPUT, "use smaller or fewer meshes",
                 "the meshes have %zu triangles together, more than the limit of %zu", all, s->limits.triangles);
    mesh_entry_unload(m);
    return scene_file_error(s, m->name, m->path_line, m->path_column, &bad, code, why);
}

static status generate_mesh(const scene *s, mesh_entry *m, diagnostic *why)
{
    TRY(check_triangles(s, m, planned_triangles(m), why));
    return make_mesh(m, why);
}

/* Loads the background image, the textures and the optical data. */
static status load_textures(scene *s, diagnostic *why)
{
    TRY(load_sky(s, why));
    for (size_t i = 0; i < s->texture_count; i++)
        if (!s->textures[i].data)
            TRY(load_texture(s, &s->textures[i], why));
    for (size_t i = 0; i < s->data_count; i++)
        if (!s->data[i].data)
            TRY(load_data(s, &s->data[i], why));
    if (s->data_count > 0)
        scene_follow_data(s);
    return STATUS_OK;
}

/* Progress of one slime as a fraction of the motion of all slimes. */
typedef struct motion_watch {
    const load_watch *watch;
    double before, current, total; /* in units of slime_work */
} motion_watch;

static void show_total(void *context, double fraction)
{
    const motion_watch *w = context;
    w->watch->progress(w->watch->context, (w->before + fraction * w->current) / w->total);
}

static double work_of(const mesh_entry *m)
{
    return m->source == MESH_SLIME && !m->data ? slime_work(m) : 0.0;
}

static status load_meshes(scene *s, const load_watch *watch, diagnostic *why)
{
    motion_watch all = {.watch = watch};
    for (size_t i = 0; i < s->mesh_count; i++)
        all.total += work_of(&s->meshes[i]);
    status code = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && code == STATUS_OK; i++) {
        mesh_entry *m = &s->meshes[i];
        all.current = work_of(m);
        if (!m->data && m->source == MESH_SLIME)
            code = slime_make(s, m, watch ? &(load_watch){show_total, &all} : NULL, why);
        else if (!m->data && m->source == MESH_FILE)
            code = load_mesh(s, m, why);
        else if (!m->data)
            code = generate_mesh(s, m, why);
        THEN(code, check_triangles(s, m, 0, why));
        all.before += all.current;
    }
    return code;
}

status scene_load_until(scene *s, const load_watch *watch, diagnostic *why)
{
    TRY(load_textures(s, why));
    return load_meshes(s, watch, why);
}

status scene_load(scene *s, diagnostic *why)
{
    return scene_load_until(s, NULL, why);
}

status scene_load_files(scene *s, diagnostic *why)
{
    status code = load_textures(s, why);
    for (size_t i = 0; i < s->mesh_count && code == STATUS_OK; i++) {
        mesh_entry *m = &s->meshes[i];
        if (m->source == MESH_FILE && !m->data) {
            code = load_mesh(s, m, why);
            THEN(code, check_triangles(s, m, 0, why));
        } else if (m->source == MESH_SLIME) {
            hand_script *script;
            code = slime_read_script(s, m, &script, why);
            hand_script_destroy(script);
        }
    }
    return code;
}
