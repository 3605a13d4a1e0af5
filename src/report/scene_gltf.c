/* A scene as glTF 2.0, mirrored in z into the format's right-handed axes: the camera, the lights
 * (KHR_lights_punctual), and every solid as triangles, analytic ones cut as for the depth buffer. */
#include "geometry/shapes/shape.h"
#include "import/mesh_wire.h"
#include "report/json.h"
#include "report/mesh_writers.h"
#include "report/scene_export.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The edge of the square that stands for a plane, in extents of the scene. */
enum { PLANE_EXTENTS = 20 };

/* The meshes of a region: the triangles of its shape's parts. */
typedef struct region_meshes {
    mesh *part[SHAPE_PRIMITIVES]; /* owned references; NULL: none */
    json_int_t number[SHAPE_PRIMITIVES];
} region_meshes;

typedef struct gltf {
    const export_work *w;
    glb *file;
    json_t *nodes, *lights;
    region_meshes *meshes; /* by region */
    diagnostic *why;
    bool bad;
} gltf;

static void add(gltf *g, json_t *list, json_t *value)
{
    g->bad |= json_array_append_new(list, value) != 0;
}

/* The 16 numbers of a node's matrix, by column, of a mirrored frame: the images of the axes x, y, z and of the
 * origin. */
static json_t *matrix_json(vec3 x, vec3 y, vec3 z, vec3 origin)
{
    return json_pack("[f,f,f,f,f,f,f,f,f,f,f,f,f,f,f,f]", x.x, x.y, x.z, 0.0, y.x, y.y, y.z, 0.0, z.x, z.y, z.z, 0.0,
                     origin.x, origin.y, origin.z, 1.0);
}

/* A frame that looks along its own -z, as cameras and lights do. */
static json_t *looking_json(vec3 right, vec3 up, vec3 forward, vec3 at)
{
    return matrix_json(mirrored_if(true, right), mirrored_if(true, up), vec3_scale(mirrored_if(true, forward), -1.0),
                       mirrored_if(true, at));
}

/* --- camera and lights --- */

static json_t *camera_json(const gltf *g)
{
    const camera_frame *f = &g->w->p->view;
    const double far = 1e3 * (1.0 + g->w->p->geometry->extent);
    if (f->parallel)
        return json_pack("[{s:s,s:{s:f,s:f,s:f,s:f}}]", "type", "orthographic", "orthographic", "xmag", f->half_width,
                         "ymag", f->half_height, "znear", 0.0, "zfar", far);
    return json_pack("[{s:s,s:{s:f,s:f,s:f}}]", "type", "perspective", "perspective", "yfov",
                     2.0 * atan(f->half_height), "aspectRatio", f->half_width / f->half_height, "znear", 1e-6 * far);
}

static void add_camera(gltf *g)
{
    const camera_frame *f = &g->w->p->view;
    add(g, g->nodes,
        json_pack("{s:s,s:i,s:o}", "name", "camera", "camera", 0, "matrix",
                  looking_json(f->right, f->up, f->forward, f->eye)));
}

/* In Phong's model a matt surface of colour c that faces the light has the radiance k_d c I; by Lambert's law it has
 * c / pi times the irradiance: of pi I for a sun, and of pi I reach^2 candela over the distance squared for a point. */
static double strength_of(gltf *g, const light *l)
{
    if (l->kind == LIGHT_SUN)
        return M_PI * l->intensity;
    double reach = l->reach;
    if (reach == 0.0) {
        reach = vec3_length(vec3_sub(l->position, l->kind == LIGHT_POINT ? vec3_make(0.0, 0.0, 0.0) : l->target));
        export_note(g->w->notes, l->name,
                    "light falls with the square of the distance: a light without reach is right at its target, or, of "
                    "a point light, at the origin");
    }
    return M_PI * l->intensity * reach * reach;
}

static json_t *spot_json(gltf *g, const light *l)
{
    const bool soft = l->kind != LIGHT_CONE, flat = light_is_flat(l);
    const double outer = fmin((flat ? 90.0 : l->half_angle_deg) * M_PI / 180.0, M_PI / 2.0);
    if (!flat && l->half_angle_deg > 90.0)
        export_note(g->w->notes, l->name, "a cone ends at 90 degrees");
    if (soft)
        export_note(g->w->notes, l->name, "the light of a soft cone falls by the reading program's own law");
    return json_pack("{s:f,s:f}", "innerConeAngle", soft ? 0.0 : outer * (1.0 - 1e-6), "outerConeAngle", outer);
}

static void add_light(gltf *g, const light *l, const light *given)
{
    const vec3 c = l->color, at = given->position;
    const double most = fmax(fmax(c.x, c.y), fmax(c.z, 1.0));
    const char *type = l->kind == LIGHT_SUN ? "directional" : light_has_cone(l) ? "spot" : "point";
    json_t *one = json_pack("{s:o,s:s,s:[f,f,f],s:f}", "name", json_of_text(given->name), "type", type, "color",
                            c.x / most, c.y / most, c.z / most, "intensity", most * strength_of(g, given));
    if (light_has_cone(l))
        g->bad |= json_object_set_new(one, "spot", spot_json(g, given)) != 0;
    add(g, g->lights, one);
    const vec3 forward = l->kind == LIGHT_POINT ? vec3_make(0.0, 0.0, 1.0)
                                                : vec3_normalize(vec3_sub(given->target, given->position)),
               right = lamp_right(forward), up = vec3_cross(forward, right);
    add(g, g->nodes,
        json_pack("{s:o,s:{s:{s:I}},s:o}", "name", json_of_text(given->name), "extensions", "KHR_lights_punctual",
                  "light", (json_int_t)json_array_size(g->lights) - 1, "matrix", looking_json(right, up, forward, at)));
}

static void add_lights(gltf *g)
{
    if (g->w->p->light_count > 0)
        glb_use(g->file, "KHR_lights_punctual");
    for (int i = 0; i < g->w->p->light_count; i++)
        add_light(g, &g->w->p->lights[i], &g->w->s->lights[i]);
}

/* --- materials --- */

/* The file of a texture of the scene, in a format of glTF; newly allocated, NULL: none. */
static char *image_path(gltf *g, int r, const shading_material *m, imported_texture *out)
{
    static const int wraps[] = {
        [TEXTURE_REPEAT] = MESH_WIRE_REPEAT, [TEXTURE_MIRROR] = MESH_WIRE_MIRROR, [TEXTURE_CLAMP] = MESH_WIRE_CLAMP};
    static const int filters[] = {[TEXTURE_NEAREST] = MESH_WIRE_NEAREST,
                                  [TEXTURE_BILINEAR] = MESH_WIRE_BILINEAR,
                                  [TEXTURE_TRILINEAR] = MESH_WIRE_TRILINEAR};
    const scene *s = g->w->s;
    for (size_t i = 0; i < s->texture_count; i++) {
        const texture_entry *t = &s->textures[i];
        if (t->data != m->img)
            continue;
        const char *dot = strrchr(t->path, '.');
        if (!dot || (strcmp(dot, ".png") != 0 && strcmp(dot, ".jpg") != 0 && strcmp(dot, ".jpeg") != 0)) {
            export_note(g->w->notes, t->name, "images are PNG or JPEG");
            return NULL;
        }
        out->wrap_u = wraps[t->wrap_u], out->wrap_v = wraps[t->wrap_v], out->filter = filters[t->filter];
        return scene_file_path(s, t->path);
    }
    export_note(g->w->notes, export_name(g->w, r), "an image inside a mesh file is left out");
    return NULL;
}

/* Schlick's roughness of a Phong exponent n is alpha^2 = 2 / (n + 2) (Walter et al., "Microfacet models", EGSR 2007),
 * and glTF's roughness is the root of alpha. */
static glb_finish finish_of(const gltf *g, int r, const shading_material *sm)
{
    const material *m = &sm->surface;
    const bool clear = export_is_clear(g->w, r);
    const bool is_metal =
        !clear && export_has_branches(g->w->s) &&
        ((g->w->p->layered && g->w->p->layered->surface[r]) || (m->reflectivity > 0 && m->diffuse == 0));
    if (clear || is_metal)
        return (glb_finish){sqrt(m->roughness), is_metal ? 1.0 : 0.0, 1.0};
    return (glb_finish){sqrt(sqrt(2.0 / (m->shininess + 2.0))), 0.0, m->specular};
}

static void set_color(double to[3], vec3 c)
{
    to[0] = c.x, to[1] = c.y, to[2] = c.z;
}

/* The transmittance after the distance over which the strongest channel falls to 1 / e. */
static void set_medium(const gltf *g, int r, imported_material *out)
{
    const plan *p = g->w->p;
    const vec3 a = p->absorption[r];
    const double most = fmax(a.x, fmax(a.y, a.z));
    double n[3];
    for (int k = 0; k < 3; k++)
        n[k] = index_law_at(p->laws[r], (const double[]){587.5618, 486.1327, 656.2725}[k]);
    out->ior = p->ior[r] / p->ior[0];
    out->dispersion = n[1] > n[2] && n[0] != 1.0 ? 20.0 * (n[1] - n[2]) / (n[0] - 1.0) : 0.0;
    if (most > 0.0) {
        out->attenuation_distance = 1.0 / most;
        set_color(out->attenuation_color, vec3_make(exp(-a.x / most), exp(-a.y / most), exp(-a.z / most)));
    }
}

static json_int_t add_material(gltf *g, int r, int slot)
{
    const shading_material *sm = &g->w->p->shading_materials[r].mat[slot];
    const material *m = &sm->surface;
    const glb_finish finish = finish_of(g, r, sm);
    const bool layered = finish.metallic > 0.0 && g->w->p->layered && g->w->p->layered->surface[r];
    imported_material out = {.given = true, .opacity = 1.0, .ior = 1.5, .attenuation_color = {1.0, 1.0, 1.0}};
    set_color(out.color, layered                    ? export_layered_color(g->w, r)
                         : finish.metallic > 0.0    ? vec3_make(m->reflectivity, m->reflectivity, m->reflectivity)
                         : export_is_clear(g->w, r) ? vec3_make(1.0, 1.0, 1.0)
                                                    : vec3_scale(m->color, m->diffuse));
    set_color(out.emissive, vec3_scale(sm->glows ? sm->glow : m->color, m->emission));
    if (export_is_clear(g->w, r)) {
        out.transmission = m->transparency;
        set_medium(g, r, &out);
    }
    if (sm->img && shape_of(&g->w->s->solids[g->w->p->geometry->regions[r].solid].shape)->triangles)
        out.texture.path = image_path(g, r, sm, &out.texture);
    else if (sm->img)
        export_note(g->w->notes, export_name(g->w, r), "only meshes have textures");
    out.alpha_mode = m->alpha == ALPHA_MASK    ? MESH_WIRE_ALPHA_MASK
                     : m->alpha == ALPHA_BLEND ? MESH_WIRE_ALPHA_BLEND
                                               : MESH_WIRE_ALPHA_OPAQUE;
    out.opacity = sm->opacity, out.alpha_cutoff = m->alpha_cutoff;
    const int material_index = g->w->s->solids[g->w->p->geometry->regions[r].solid].material_index;
    const json_int_t number = glb_add_material(
        g->file, &out, material_index >= 0 ? g->w->s->materials[material_index].name : export_name(g->w, r), &finish);
    free(out.texture.path);
    return number;
}

/* --- solids --- */

/* Two triangles, larger than the scene. */
static status plane_mesh(const gltf *g, mesh **out)
{
    const double half = 0.5 * PLANE_EXTENTS * (1.0 + g->w->p->geometry->extent);
    TRY(mesh_create(4, 2, false, false, false, out, g->why));
    for (int i = 0; i < 4; i++)
        (*out)->vertices[i] = vec3_make(i & 1 ? half : -half, 0.0, i & 2 ? half : -half);
    (*out)->triangles[0] = (mesh_triangle){{0, 2, 3}};
    (*out)->triangles[1] = (mesh_triangle){{0, 3, 1}};
    return mesh_finish(*out, g->why);
}

static status make_meshes(gltf *g, int r, const solid_shape *shape, region_meshes *out)
{
    const shape_rule *rule = shape_of(shape);
    const char *name = export_name(g->w, r);
    if (rule->triangles) {
        mesh_retain(shape->mesh);
        out->part[0] = (mesh *)(uintptr_t)shape->mesh;
        if (!shape->mesh->single)
            export_note(g->w->notes, name, "coordinates have single precision");
        return STATUS_OK;
    }
    if (rule->unbounded) {
        export_note(g->w->notes, name, "a plane is a square of %d extents of the scene", PLANE_EXTENTS);
        return plane_mesh(g, &out->part[0]);
    }
    if (rule->curved)
        export_note(g->w->notes, name, "curved sides are triangles, up to %d around", 256);
    for (int k = 0; k < rule->primitive_count; k++)
        TRY(rule->tessellation(shape, k, &out->part[k], g->why));
    return STATUS_OK;
}

/* The meshes of a region in the file, or those of another region of the same solid. */
static status add_meshes(gltf *g, int r, const solid_shape *shape)
{
    const scene_geometry *s = g->w->p->geometry;
    const region_materials *of = &g->w->p->shading_materials[r];
    region_meshes *own = &g->meshes[r];
    for (int other = r - 1; other > 0 && s->origins[other].source == s->origins[r].source; other--)
        if (g->meshes[other].part[0]) {
            *own = g->meshes[other];
            for (int k = 0; k < SHAPE_PRIMITIVES; k++)
                mesh_retain(own->part[k]);
            return STATUS_OK;
        }
    TRY(make_meshes(g, r, shape, own));
    json_int_t materials[MESH_SLOTS_MAX];
    for (int k = 0; k < SHAPE_PRIMITIVES && own->part[k]; k++) {
        const mesh *m = own->part[k];
        for (int slot = 0; slot < m->slot_count; slot++)
            materials[slot] = slot < of->count ? add_material(g, r, slot) : materials[0];
        own->number[k] = m->triangle_count > 0 ? glb_add_mesh(g->file, m, true, of->shading != SHADING_FLAT,
                                                              of->mat->vertex_colors, materials)
                                               : -1;
    }
    return STATUS_OK;
}

/* The format does not want the matrix of a node that is not moved. */
static bool is_default(const json_t *matrix)
{
    size_t i;
    const json_t *one;
    bool same = true;
    json_array_foreach(matrix, i, one) same &= json_number_value(one) == (i % 5 == 0 ? 1.0 : 0.0);
    return same;
}

/* A node for one part of a solid; offset: of a copy, in the solid's frame. */
static void add_node(gltf *g, int r, const solid_shape *shape, json_int_t number, vec3 offset)
{
    const shape_rule *rule = shape_of(shape);
    const mat3 turn = rotation_from_deg(shape->rotation_deg);
    const vec3 scale = rule->triangles ? shape->scale : shape_tessellation_scale(shape);
    const vec3 x = vec3_scale(placed_axis(&turn, 0), scale.x), y = vec3_scale(placed_axis(&turn, 1), scale.y),
               z = vec3_scale(placed_axis(&turn, 2), scale.z),
               origin = vec3_add(shape->position, mat3_apply(turn, offset));
    /* the mesh is mirrored as well: its z is the other way */
    json_t *matrix = matrix_json(mirrored_if(true, x), mirrored_if(true, y), vec3_scale(mirrored_if(true, z), -1.0),
                                 mirrored_if(true, origin)),
           *node = json_pack("{s:o,s:I}", "name", json_of_text(export_name(g->w, r)), "mesh", number);
    if (!is_default(matrix))
        g->bad |= json_object_set(node, "matrix", matrix) != 0;
    json_decref(matrix);
    add(g, g->nodes, node);
}

static void add_nodes(gltf *g, int r, const solid_shape *shape)
{
    const vec3 n = shape_of(shape)->triangles ? shape->copies : vec3_make(1.0, 1.0, 1.0), by = shape->spacing;
    for (int k = 0; k < SHAPE_PRIMITIVES && g->meshes[r].part[k]; k++)
        for (double a = 0.0; a < n.x; a++)
            for (double b = 0.0; b < n.y; b++)
                for (double c = 0.0; c < n.z; c++)
                    if (g->meshes[r].number[k] >= 0)
                        add_node(g, r, shape, g->meshes[r].number[k], vec3_make(a * by.x, b * by.y, c * by.z));
}

static void note_overlaps(gltf *g)
{
    const scene_geometry *s = g->w->p->geometry;
    enum { COMPARED = 400 };
    for (int r = 2; r <= s->region_count && r <= COMPARED; r++)
        for (int low = 1; low < r; low++) {
            const solid_shape a = scene_geometry_shape(s, low), b = scene_geometry_shape(s, r);
            if ((export_is_clear(g->w, low) || export_is_clear(g->w, r)) && export_gap(&a, &b) <= 0.0)
                export_note(g->w->notes, export_name(g->w, r),
                            "media have no priorities: where solids touch or overlap, what is there is undefined");
        }
}

static status add_solids(gltf *g)
{
    const scene_geometry *s = g->w->p->geometry;
    status code = STATUS_OK;
    for (int r = 1; r <= s->region_count && code == STATUS_OK; r++) {
        const solid_shape shape = scene_geometry_shape(s, r);
        code = add_meshes(g, r, &shape);
        if (code == STATUS_OK)
            add_nodes(g, r, &shape);
    }
    note_overlaps(g);
    return code;
}

/* --- the file --- */

/* {"title": .., "size": [width, height], "not_said": [..]} */
static json_t *extras_json(const gltf *g)
{
    const scene *s = g->w->s;
    json_t *notes = json_array();
    bool bad = !notes;
    for (size_t i = 0; i < g->w->notes->count; i++) {
        char *text = export_note_text(g->w->notes, i, NULL);
        bad |= !text || json_array_append_new(notes, json_of_text(text)) != 0;
        free(text);
    }
    return json_if(json_pack("{s:o,s:[I,I],s:o}", "title", json_of_text(s->title), "size", (json_int_t)s->render.width,
                             (json_int_t)s->render.height, "not_said", notes),
                   !bad);
}

static json_t *members_json(gltf *g)
{
    json_t *all = json_pack("{s:o}", "cameras", camera_json(g));
    if (json_array_size(g->lights) > 0)
        g->bad |= json_object_set_new(all, "extensions",
                                      json_pack("{s:{s:O}}", "KHR_lights_punctual", "lights", g->lights)) != 0;
    return all;
}

status gltf_scene_write(const export_work *w, bool binary, FILE *out, diagnostic *why)
{
    const size_t regions = (size_t)w->p->geometry->region_count + 1;
    gltf g = {.w = w,
              .file = glb_create(w->path, NULL),
              .nodes = json_array(),
              .lights = json_array(),
              .meshes = calloc(regions, sizeof *g.meshes),
              .why = why};
    status code = g.file && g.meshes ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        if (w->s->background.kind == BACKGROUND_UNIFORM)
            export_note(w->notes, "background.color", "glTF has no sky: the reading program sets its own");
        add_camera(&g);
        add_lights(&g);
        code = add_solids(&g);
    }
    json_t *more = code == STATUS_OK ? members_json(&g) : NULL, *extras = code == STATUS_OK ? extras_json(&g) : NULL;
    if (code == STATUS_OK && (g.bad || !more || !extras))
        code = out_of_memory(why);
    if (code == STATUS_OK)
        code = glb_write(g.file, json_incref(g.nodes), json_incref(more), json_incref(extras), binary, out, why);
    json_decref(more);
    json_decref(extras);
    for (size_t r = 0; g.meshes && r < regions; r++)
        for (int k = 0; k < SHAPE_PRIMITIVES; k++)
            mesh_release(g.meshes[r].part[k]);
    free(g.meshes);
    json_decref(g.nodes);
    json_decref(g.lights);
    glb_destroy(g.file);
    return code;
}
