/* How a scene looks: materials (3.9), with the base colour's texture, emission, alpha and the extensions that describe
 * glass; cameras (3.10); and lights (KHR_lights_punctual). */
#include "import/gltf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const gltf_uv_map PLAIN_MAP = {.m = {1, 0, 0, 0, 1, 0}};

/* The default of KHR_materials_ior, and of glTF's dielectrics. */
#define USUAL_IOR 1.5

static const json_t *base_texture(gltf_item of)
{
    return json_object_get(json_object_get(of.json, "pbrMetallicRoughness"), "baseColorTexture");
}

/* KHR_texture_transform: the coordinates, whose origin is the image's upper left corner, are scaled, then rotated
 * counter-clockwise as seen in the image, then moved. */
static status read_uv_map(const gltf_file *g, gltf_item of, const json_t *texture, gltf_uv_map *out)
{
    double offset[2] = {0, 0}, scale[2] = {1, 1}, angle = 0;
    const json_t *moved = gltf_extension(texture, "KHR_texture_transform");
    *out = PLAIN_MAP;
    out->textured = texture != NULL;
    TRY(gltf_whole(g, of, texture, "texCoord", UINT32_MAX, 0, &out->set));
    if (!moved)
        return STATUS_OK;
    TRY(gltf_whole(g, of, moved, "texCoord", UINT32_MAX, out->set, &out->set));
    TRY(gltf_numbers(g, of, moved, "offset", 2, offset));
    TRY(gltf_numbers(g, of, moved, "scale", 2, scale));
    TRY(gltf_numbers(g, of, moved, "rotation", 1, &angle));
    const double c = cos(angle), s = sin(angle);
    const double m[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    memcpy(out->m, m, sizeof m);
    return STATUS_OK;
}

status gltf_material_uv_map(const gltf_file *g, int64_t index, gltf_uv_map *out)
{
    *out = PLAIN_MAP;
    if (index < 0)
        return STATUS_OK;
    gltf_uv_map other;
    const gltf_item of = gltf_at(g, "materials", (size_t)index);
    const json_t *base = base_texture(of), *glow = json_object_get(of.json, "emissiveTexture");
    TRY(read_uv_map(g, of, base ? base : glow, out));
    TRY(read_uv_map(g, of, glow ? glow : base, &other));
    out->glow_apart = other.set != out->set || memcmp(other.m, out->m, sizeof other.m) != 0;
    return STATUS_OK;
}

/* --- textures --- */

/* Samplers, 3.8.4.2 and 5.26: numbers of OpenGL. */
enum {
    NEAREST = 9728,
    LINEAR = 9729,
    NEAREST_MIPMAP_NEAREST = 9984,
    CLAMP_TO_EDGE = 33071,
    MIRRORED_REPEAT = 33648,
    REPEAT = 10497
};

static status read_wrap(const gltf_file *g, gltf_item of, const char *key, uint32_t *out)
{
    uint64_t wrap;
    TRY(gltf_whole(g, of, of.json, key, 65535, REPEAT, &wrap));
    *out = wrap == CLAMP_TO_EDGE     ? (uint32_t)MESH_WIRE_CLAMP
           : wrap == MIRRORED_REPEAT ? (uint32_t)MESH_WIRE_MIRROR
                                     : (uint32_t)MESH_WIRE_REPEAT;
    return STATUS_OK;
}

static status read_sampler(const gltf_file *g, int64_t index, mesh_wire_texture *m)
{
    const gltf_item of = gltf_at(g, "samplers", (size_t)index);
    uint64_t near, far;
    TRY(read_wrap(g, of, "wrapS", &m->wrap_u));
    TRY(read_wrap(g, of, "wrapT", &m->wrap_v));
    TRY(gltf_whole(g, of, of.json, "magFilter", 65535, LINEAR, &near));
    TRY(gltf_whole(g, of, of.json, "minFilter", 65535, NEAREST_MIPMAP_NEAREST, &far));
    m->filter = near == NEAREST && far != LINEAR ? (uint32_t)MESH_WIRE_NEAREST
                : far == LINEAR                  ? (uint32_t)MESH_WIRE_BILINEAR
                                                 : (uint32_t)MESH_WIRE_TRILINEAR;
    return STATUS_OK;
}

/* Whether the program reads such an image: a PNG or JPEG file, as 3.8.1.1 has them, or a BMP file. */
static bool is_readable(const unsigned char *bytes, size_t size)
{
    return (size > 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0) ||
           (size > 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0) || (size > 2 && memcmp(bytes, "BM", 2) == 0);
}

/* Takes an image that is inside the file, with bytes of its own, once. */
static void take_image(gltf_file *g, size_t index, unsigned char *bytes, size_t size)
{
    if (is_readable(bytes, size)) {
        flat_image(g->flat, bytes, size, &g->image_numbers[index]);
        return;
    }
    flat_note(g->flat, "images[%zu] is neither a PNG nor a JPEG image: materials are without it", index);
    free(bytes);
}

/* The image of a buffer or of a data: URI gets a number, that of a file its name in *path, which is the caller's. */
static status read_image(gltf_file *g, size_t index, mesh_wire_texture *m, char **path)
{
    const gltf_item of = gltf_at(g, "images", index);
    const char *uri = json_string_value(json_object_get(of.json, "uri"));
    unsigned char *bytes = NULL;
    size_t size = 0;
    int64_t view;
    TRY(gltf_index(g, of, of.json, "bufferView", "bufferViews", &view));
    if (view < 0 && !uri)
        return gltf_bad(g, of, "", "has neither a uri nor a bufferView");
    if (g->image_numbers[index] == 0 && view >= 0) {
        gltf_view bytes_of;
        TRY(gltf_view_at(g, view, &bytes_of));
        size = bytes_of.size;
        if (!(bytes = malloc(size + 1)))
            return no_memory_for(g->req, g->why);
        memcpy(bytes, bytes_of.bytes, size);
    } else if (g->image_numbers[index] == 0) {
        TRY(gltf_decode(g, of, uri, &bytes, &size));
    }
    if (bytes)
        take_image(g, index, bytes, size);
    m->image = g->image_numbers[index];
    if (bytes || m->image || strncmp(uri, "data:", 5) == 0)
        return STATUS_OK;
    *path = strdup(uri); /* whoever looks for the file decodes it */
    return *path ? STATUS_OK : no_memory_for(g->req, g->why);
}

static status read_texture(gltf_file *g, gltf_item material, const json_t *texture, mesh_wire_texture *m, char **path)
{
    int64_t index, sampler, source;
    TRY(gltf_index(g, material, texture, "index", "textures", &index));
    if (index < 0)
        return STATUS_OK;
    const gltf_item of = gltf_at(g, "textures", (size_t)index);
    TRY(gltf_index(g, of, of.json, "sampler", "samplers", &sampler));
    TRY(gltf_index(g, of, of.json, "source", "images", &source));
    if (sampler >= 0)
        TRY(read_sampler(g, sampler, m));
    if (source >= 0)
        return read_image(g, (size_t)source, m, path);
    flat_note(g->flat, "textures[%lld] has no PNG or JPEG image: materials are without it", (long long)index);
    return STATUS_OK;
}

/* --- materials --- */

/* Alpha, 3.9.4. Without an image the factor alone decides about a mask. */
static status read_alpha(const gltf_file *g, gltf_item of, double factor, bool textured, mesh_wire_material *m)
{
    const char *mode = gltf_text(of.json, "alphaMode");
    double cutoff = 0.5;
    if (strcmp(mode, "BLEND") == 0) {
        m->alpha_mode = MESH_WIRE_ALPHA_BLEND;
        m->opacity = fmin(fmax(factor, 0), 1);
    } else if (strcmp(mode, "MASK") == 0) {
        TRY(gltf_numbers(g, of, of.json, "alphaCutoff", 1, &cutoff));
        m->alpha_mode = MESH_WIRE_ALPHA_MASK;
        m->alpha_cutoff = fmax(cutoff, 0);
        m->opacity = textured ? fmin(fmax(factor, 0), 1) : factor >= cutoff ? 1 : 0;
    }
    return STATUS_OK;
}

/* The image of the emission; without it the whole surface would shine, so that one that lacks it emits nothing. */
static status read_glow(gltf_file *g, gltf_item of, bool textured, mesh_wire_material *m, char **path, bool *lacks)
{
    const json_t *texture = json_object_get(of.json, "emissiveTexture");
    gltf_uv_map map;
    TRY(gltf_material_uv_map(g, (int64_t)of.index, &map));
    if (texture && map.glow_apart)
        flat_note(g->flat, "images of emission that are laid on unlike those of the colour cannot be shown: their "
                           "surfaces emit nothing");
    if (texture && textured && !map.glow_apart)
        TRY(read_texture(g, of, texture, &m->glow, path));
    *lacks = texture && !*path && !m->glow.image;
    return STATUS_OK;
}

static status read_emission(gltf_file *g, gltf_item of, bool textured, mesh_wire_material *m, char **path)
{
    double strength = 1;
    bool lacks;
    TRY(read_glow(g, of, textured, m, path, &lacks));
    if (lacks)
        return STATUS_OK;
    TRY(gltf_numbers(g, of, of.json, "emissiveFactor", 3, m->emissive));
    TRY(gltf_numbers(g, of, gltf_extension(of.json, "KHR_materials_emissive_strength"), "emissiveStrength", 1,
                     &strength));
    const double brightest = fmax(fmax(m->emissive[0], m->emissive[1]), m->emissive[2]) * strength;
    if (brightest > MESH_WIRE_COLOR_MAX) {
        flat_note(g->flat, "emission is at most %g", MESH_WIRE_COLOR_MAX);
        strength *= MESH_WIRE_COLOR_MAX / brightest;
    }
    for (int c = 0; c < 3; c++)
        m->emissive[c] = fmin(m->emissive[c] * strength, MESH_WIRE_COLOR_MAX);
    return STATUS_OK;
}

/* KHR_materials_ior, _transmission, _volume, _dispersion. Under simple transmission, glass has the opacity of what it
 * does not let through. */
static status read_glass(const gltf_file *g, gltf_item of, mesh_wire_material *m)
{
    const json_t *clear = gltf_extension(of.json, "KHR_materials_transmission"),
                 *volume = gltf_extension(of.json, "KHR_materials_volume");
    double thickness = 0;
    TRY(gltf_numbers(g, of, gltf_extension(of.json, "KHR_materials_ior"), "ior", 1, &m->ior));
    m->ior = m->ior >= 1 ? m->ior : USUAL_IOR; /* 0 is a special value of the extension */
    TRY(gltf_numbers(g, of, clear, "transmissionFactor", 1, &m->transmission));
    m->transmission = fmin(fmax(m->transmission, 0), 1);
    if (m->alpha_mode != MESH_WIRE_ALPHA_MASK) /* of a mask, opacity decides whether there is a surface */
        m->opacity *= 1 - m->transmission;
    TRY(gltf_numbers(g, of, volume, "thicknessFactor", 1, &thickness));
    TRY(gltf_numbers(g, of, volume, "attenuationDistance", 1, &m->attenuation_distance));
    TRY(gltf_numbers(g, of, volume, "attenuationColor", 3, m->attenuation_color));
    TRY(gltf_numbers(g, of, gltf_extension(of.json, "KHR_materials_dispersion"), "dispersion", 1, &m->dispersion));
    if (json_object_get(clear, "transmissionTexture") || json_object_get(volume, "thicknessTexture"))
        flat_note(g->flat, "images of transmission and thickness are ignored");
    if ((m->transmission > 0 && volume && thickness == 0) || m->attenuation_distance > MESH_WIRE_FAR)
        m->attenuation_distance = 0; /* a thin wall; a large number stands for infinity, the default */
    return STATUS_OK;
}

static void note_ignored(const gltf_file *g, gltf_item of)
{
    if (json_object_get(of.json, "normalTexture") || json_object_get(of.json, "occlusionTexture") ||
        json_object_get(json_object_get(of.json, "pbrMetallicRoughness"), "metallicRoughnessTexture"))
        flat_note(g->flat, "images of normals, occlusion, metalness and roughness are ignored");
}

/* The caller frees the paths, also after an error. */
static status read_material(gltf_file *g, gltf_item of, const double tint[3], bool textured, mesh_material *material)
{
    mesh_wire_material *m = &material->values;
    double color[4] = {1, 1, 1, 1};
    m->flags = MESH_WIRE_GIVEN;
    TRY(gltf_numbers(g, of, json_object_get(of.json, "pbrMetallicRoughness"), "baseColorFactor", 4, color));
    for (int c = 0; c < 3; c++)
        m->diffuse[c] = color[c] * tint[c];
    if (textured)
        TRY(read_texture(g, of, base_texture(of), &m->texture, &material->texture));
    TRY(read_alpha(g, of, color[3], material->texture || m->texture.image, m));
    TRY(read_emission(g, of, textured, m, &material->glow));
    note_ignored(g, of);
    return read_glass(g, of, m);
}

status gltf_material_slot(gltf_file *g, int64_t index, const double tint[3], bool textured, uint8_t *slot)
{
    const gltf_item of = index < 0 ? (gltf_item){0} : gltf_at(g, "materials", (size_t)index);
    mesh_material m = {.values = {.diffuse = {1, 1, 1}, .opacity = 1, .ior = USUAL_IOR, .attenuation_color = {1, 1, 1}},
                       .name = (char *)(uintptr_t)json_string_value(json_object_get(of.json, "name"))};
    status code = index < 0 ? STATUS_OK : read_material(g, of, tint, textured, &m);
    THEN(code, flat_material(g->req, g->flat, &m, slot, g->why));
    free(m.texture), free(m.glow);
    return code;
}

/* --- cameras and lights --- */

static bool unit(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return length > 0;
}

/* Where the view is; it looks along its own -z, 3.10 and KHR_lights_punctual. Adds it unless the node has no axes. */
static status add_view(const gltf_file *g, gltf_item of, const gltf_affine *place, mesh_wire_view *v)
{
    for (int k = 0; k < 3; k++) {
        v->position[k] = place->m[k][3];
        v->forward[k] = -place->m[k][2];
        v->up[k] = place->m[k][1];
    }
    if (!unit(v->forward) || !unit(v->up))
        return STATUS_OK;
    return flat_view(g->req, g->flat, v, json_string_value(json_object_get(of.json, "name")), g->why);
}

static status add_camera(const gltf_file *g, size_t index, const gltf_affine *place)
{
    const gltf_item of = gltf_at(g, "cameras", index);
    const json_t *wide = json_object_get(of.json, "perspective"), *flat = json_object_get(of.json, "orthographic");
    mesh_wire_view v = {.kind = flat ? MESH_WIRE_ORTHOGRAPHIC : MESH_WIRE_PERSPECTIVE, .height = flat ? 1 : M_PI_4};
    double across = 0;
    if (flat) {
        TRY(gltf_numbers(g, of, flat, "ymag", 1, &v.height));
        TRY(gltf_numbers(g, of, flat, "xmag", 1, &across));
        v.aspect = v.height != 0 ? fabs(across / v.height) : 0;
        v.height = 2 * fabs(v.height);
    } else {
        TRY(gltf_numbers(g, of, wide, "yfov", 1, &v.height));
        TRY(gltf_numbers(g, of, wide, "aspectRatio", 1, &v.aspect));
    }
    return add_view(g, of, place, &v);
}

static status add_light(const gltf_file *g, gltf_item node, const json_t *lights, const gltf_affine *place)
{
    uint64_t index;
    TRY(gltf_whole(g, node, gltf_extension(node.json, "KHR_lights_punctual"), "light", UINT32_MAX, 0, &index));
    const gltf_item of = {json_array_get(lights, (size_t)index), "lights", (size_t)index};
    if (!of.json)
        return gltf_bad(g, node, "light", "is none of the file's lights");
    const char *type = gltf_text(of.json, "type");
    const json_t *spot = json_object_get(of.json, "spot");
    mesh_wire_view v = {.color = {1, 1, 1}, .power = 1, .outer = M_PI_4};
    v.kind = strcmp(type, "directional") == 0 ? MESH_WIRE_SUN
             : strcmp(type, "spot") == 0      ? MESH_WIRE_SPOT
                                              : MESH_WIRE_POINT;
    TRY(gltf_numbers(g, of, of.json, "color", 3, v.color));
    TRY(gltf_numbers(g, of, of.json, "intensity", 1, &v.power));
    TRY(gltf_numbers(g, of, of.json, "range", 1, &v.range));
    v.range = v.range > MESH_WIRE_FAR ? 0 : v.range; /* a large number stands for infinity, the default */
    TRY(gltf_numbers(g, of, spot, "innerConeAngle", 1, &v.inner));
    TRY(gltf_numbers(g, of, spot, "outerConeAngle", 1, &v.outer));
    return add_view(g, of, place, &v);
}

status gltf_views(const gltf_file *g, gltf_item node, const gltf_affine *place)
{
    const json_t *lights = json_object_get(gltf_extension(g->root, "KHR_lights_punctual"), "lights");
    int64_t camera;
    TRY(gltf_index(g, node, node.json, "camera", "cameras", &camera));
    if (camera >= 0)
        TRY(add_camera(g, (size_t)camera, place));
    return gltf_extension(node.json, "KHR_lights_punctual") ? add_light(g, node, lights, place) : STATUS_OK;
}
