/* Building a render plan: media, hierarchies, materials and light cones from the scene. */
#include "render/plan/plan.h"

#include "base/array.h"
#include "base/budget.h"
#include "base/elementary.h"
#include "geometry/shapes/shape.h"
#include "scene/model/cover.h"
#include "scene/model/face_materials.h"
#include "scene/model/scene.h"
#include <stdlib.h>

/* Whether the surface is visible even between equal media. */
static bool shows_itself(const scene *s, const material *m)
{
    return m->emission > 0.0 || material_reflectivity(m, &s->render) > 0.0 || material_is_layered(m, &s->render);
}

/* Whether both are crystals with equal extraordinary index and axis in the world, or neither is a crystal. */
static bool are_alike_crystals(const scene *s, const solid *a, const solid *b)
{
    const bool first = material_is_crystal(&a->surface, &s->render),
               second = material_is_crystal(&b->surface, &s->render);
    if (!first || !second)
        return first == second;
    const vec3 one = mat3_apply(rotation_from_deg(a->shape.rotation_deg), a->surface.optic_axis),
               other = mat3_apply(rotation_from_deg(b->shape.rotation_deg), b->surface.optic_axis);
    return a->surface.extraordinary_ior == b->surface.extraordinary_ior && one.x == other.x && one.y == other.y &&
           one.z == other.z;
}

/* Whether each copy of the solid is a medium of its own. */
static bool has_own_medium(const scene *s, const solid *one)
{
    const material *m = &one->surface;
    return solid_has_ends(one) || material_is_opaque(m) || scene_has_constant_weights(&s->render) || shows_itself(s, m);
}

/* The medium of a solid. Under Fresnel weights, solids of equal refractive index are one medium, and a boundary between
 * them is no interface unless it is a half mirror, in part too, has a thin film, or emits light; crystals must also be
 * alike. With constant weights, as in the published rod report, every surface reflects whatever its index. laws:
 * dispersion laws by solid; [solid_count] is the surrounding medium's. */
static int64_t medium_of(const scene *s, const index_law *laws, int solid_index)
{
    const material *m = &s->solids[solid_index].surface;
    if (has_own_medium(s, &s->solids[solid_index]))
        return solid_index + 1;
    if (!material_is_crystal(m, &s->render) && index_laws_match(&s->render, &laws[solid_index], &laws[s->solid_count]))
        return 0;
    for (int i = 0; i < solid_index; i++) {
        const solid *other = &s->solids[i];
        if (other->visible && !material_is_opaque(&other->surface) && !shows_itself(s, &other->surface) &&
            !solid_has_ends(other) && index_laws_match(&s->render, &laws[i], &laws[solid_index]) &&
            are_alike_crystals(s, other, &s->solids[solid_index]))
            return i + 1;
    }
    return solid_index + 1;
}

/* Sets *out to the hierarchy of the mesh: the one that the mesh keeps, or one built for this frame, which the plan
 * stores for the first solid with this mesh and the others use. */
static status tree_of(const scene *s, plan *p, const mesh *m, const hierarchy **out, diagnostic *why)
{
    const hierarchy_kind kind = (hierarchy_kind)s->render.accel;
    if (integrator_traits_of(&s->render)->drawn)
        return STATUS_OK; /* rasterisation needs none */
    if (s->render.keep)
        return hierarchy_of_mesh(m, kind, scene_build_threads(&s->render), out, why);
    for (size_t k = 0; k < p->own_tree_count; k++) {
        if (p->own_trees[k].of == m) {
            *out = p->own_trees[k].tree;
            return STATUS_OK;
        }
    }
    if (!GROW(p->own_trees, p->own_tree_room, p->own_tree_count + 1))
        return out_of_memory(why);
    own_tree *own = &p->own_trees[p->own_tree_count];
    *own = (own_tree){.of = m};
    TRY(hierarchy_build(m, kind, scene_build_threads(&s->render), &own->tree, why));
    p->own_tree_count++;
    *out = own->tree;
    return STATUS_OK;
}

/* first: of the solids with this mesh; once: of its operands. */
static void report_mesh(plan *p, const mesh_entry *m, const solid_shape *shape, const hierarchy *tree, bool first,
                        bool once)
{
    const double copies = shape->copies.x * shape->copies.y * shape->copies.z;
    p->meshes.instances += once ? (uint64_t)copies : 0;
    p->meshes.triangles += (uint64_t)copies * shape->mesh->triangle_count;
    if (first && once && m->source == MESH_SLIME) {
        p->meshes.motion_steps += m->account.substeps;
        p->meshes.motion_s += m->motion_s;
    }
    if (first && tree) {
        const hierarchy_report r = hierarchy_describe(tree);
        p->meshes.bytes += r.bytes;
        p->meshes.build_s += r.build_s;
    }
}

/* Adds the sources of the operands of a solid's mesh. shapes: room for one for each operand. */
static status add_operands(const scene *s, size_t i, plan *p, solid_shape *shapes, region_source source,
                           region_source *sources, int *count, diagnostic *why)
{
    const solid *one = &s->solids[i];
    const mesh_entry *m = scene_find_mesh(s, one->mesh);
    const mesh *const *operands;
    int operand_count;
    if (!m || !m->data)
        return diagnose(why, STATUS_FAILURE, "call scene_load first", "%.80s: the mesh is not loaded", one->name);
    TRY(scene_mesh_operands(s, one, &operands, &operand_count, why));
    bool first = true;
    for (size_t k = 0; k < i; k++)
        first &= !(s->solids[k].visible && solid_shows_mesh(&s->solids[k], one->mesh));
    for (int operand = 0; operand < operand_count; operand++) {
        shapes[operand] = one->shape;
        shapes[operand].mesh = operands[operand];
        source.shape = &shapes[operand];
        TRY(tree_of(s, p, operands[operand], &source.tree, why));
        report_mesh(p, m, &shapes[operand], source.tree, first, operand == 0);
        sources[(*count)++] = source;
    }
    return STATUS_OK;
}

/* Adds the sources of the regions of solid i. shape: room for its shape with points, or for those of its mesh's
 * operands; copies: the number of regions so far. */
static status add_source(const scene *s, const index_law *laws, int i, plan *p, solid_shape *shape,
                         region_source *sources, int *count, size_t *copies, diagnostic *why)
{
    const solid *one = &s->solids[i];
    const bool is_mesh = shape_of(&one->shape)->triangles, has_points = scene_points_of(s, one);
    double shadow_transmittance;
    if (has_points)
        *shape = scene_loaded_shape(s, one);
    if (has_points && !shape->points)
        return diagnose(why, STATUS_FAILURE, "call scene_load first", "%.80s: the points are not loaded", one->name);
    if (!region_shadow_transmittance(s, one, &shadow_transmittance, &p->shadow_transmittance[i]))
        return out_of_memory(why);
    region_source source = {.shape = has_points ? shape : &one->shape,
                            .priority = one->priority,
                            .medium = medium_of(s, laws, i),
                            .opaque = solid_is_opaque(s, one),
                            .shadow_transmittance = shadow_transmittance,
                            .face_shadow_transmittance = p->shadow_transmittance[i],
                            .face_slots = solid_has_ends(one) ? p->end_slots[i] : NULL,
                            .attenuates = material_attenuates(&one->surface) ||
                                          material_scatters(&one->surface, &s->render) ||
                                          sheet_acts(&one->surface, &s->render),
                            .reflects = p->basic && !scene_has_constant_weights(&s->render),
                            .partial = solid_is_partial(s, one),
                            .solid = i};
    if (source.partial && !is_mesh) /* an open surface in the surrounding medium */
        source.opaque = false, source.attenuates = surroundings_absorb(&s->background);
    if (has_own_medium(s, one)) /* beyond the numbers of solids, and of the copies of those before */
        source.further_media = (int64_t)(s->solid_count + *copies);
    *copies += solid_shape_count(source.shape);
    if (is_mesh)
        return add_operands(s, (size_t)i, p, shape, source, sources, count, why);
    sources[(*count)++] = source;
    return STATUS_OK;
}

/* One for each solid, and for each further operand of its mesh. */
static status count_sources(const scene *s, size_t *places, diagnostic *why)
{
    *places = s->solid_count;
    for (size_t i = 0; i < s->solid_count; i++) {
        const mesh *const *operands;
        int count = 0;
        if (s->solids[i].visible && shape_of(&s->solids[i].shape)->triangles)
            TRY(scene_mesh_operands(s, &s->solids[i], &operands, &count, why));
        *places += count > 1 ? (size_t)count - 1 : 0;
    }
    return STATUS_OK;
}

/* The slots of faces, for solids with materials of parts of their surface. */
static status make_end_slots(const scene *s, plan *p, diagnostic *why)
{
    bool any = false;
    for (size_t i = 0; i < s->solid_count && !any; i++)
        any = s->solids[i].visible && solid_has_ends(&s->solids[i]);
    if (!any)
        return STATUS_OK;
    if (!(p->end_slots = calloc(s->solid_count, sizeof *p->end_slots)))
        return out_of_memory(why);
    for (size_t i = 0; i < s->solid_count; i++)
        for (int face = 0; face < FACES_MAX; face++)
            p->end_slots[i][face] = solid_end_slot(&s->solids[i].shape, face);
    return STATUS_OK;
}

static status build_geometry(const scene *s, const index_law *laws, plan *p, diagnostic *why)
{
    size_t places;
    TRY(count_sources(s, &places, why));
    TRY(make_end_slots(s, p, why));
    region_source *sources = large_calloc(places + 1, sizeof *sources);
    solid_shape *shapes = large_calloc(places + 1, sizeof *shapes);
    p->solid_count = s->solid_count;
    p->shadow_transmittance = calloc(s->solid_count + 1, sizeof *p->shadow_transmittance);
    status code = STATUS_OK;
    if (!sources || !shapes || !p->shadow_transmittance)
        code = out_of_memory(why);
    int count = 0;
    size_t copies = 0;
    for (int i = 0; i < (int)s->solid_count && code == STATUS_OK; i++)
        if (s->solids[i].visible)
            code = add_source(s, laws, i, p, &shapes[count], sources, &count, &copies, why);
    enum { REGION_BYTES = sizeof(region) + sizeof(primitive) + 256 };
    THEN(code, memory_budget_check(copies * REGION_BYTES, "use fewer solids or points", why, "a scene of %zu solids",
                                   copies));
    const bool drawn = integrator_traits_of(&s->render)->drawn;
    const tree_use use = drawn || s->render.accel == HIERARCHY_NONE ? TREE_IF_TOO_MANY : TREE_IF_MANY;
    THEN(code, scene_geometry_build(sources, count, 0, use, &p->geometry, why));
    if (code == STATUS_OK && drawn && p->geometry->tree)
        code = diagnose(why, STATUS_BAD_INPUT, "use another render.integrator, or fewer solids",
                        "the z-buffer draws at most 64 solids; a cup and a torus count as two, a lens as three");
    if (code == STATUS_OK && surroundings_absorb(&s->background))
        scene_geometry_surroundings_absorb(p->geometry);
    free(shapes);
    free(sources);
    return code;
}

/* The colour of a lamp's spectrum, linear sRGB. */
static vec3 seen_color(const light *l)
{
    double rgb[3];
    if (l->spectrum == LAMP_OF_COLOR)
        return l->color;
    if (l->spectrum == LAMP_DATA && l->emission_data) {
        double xyz[3];
        spectrum_xyz(optical_data_emission, l->emission_data, xyz);
        light_rgb(xyz, rgb);
        return vec3_make(rgb[0], rgb[1], rgb[2]);
    }
    lamp_rgb((lamp_spectrum)l->spectrum, l->temperature_k, l->line_nm, rgb);
    return vec3_make(rgb[0], rgb[1], rgb[2]);
}

/* Sets the positions of suns, at which their shadow rays end: a half-space that a ray meets at an angle below 2^-16 is
 * farther away, and does not block it. The distance is a power of two, so that directions are scaled exactly, and a far
 * solid changes nothing. */
static void place_suns(plan *p)
{
    double extent = p->geometry->extent;
    for (int i = 0; i < p->light_count; i++)
        if (p->lights[i].kind != LIGHT_SUN)
            extent = fmax(extent, vec3_length(p->lights[i].position));
    for (p->sun_distance = 0x1p16; p->sun_distance < 0x1p16 * extent;)
        p->sun_distance *= 2.0;
    for (int i = 0; i < p->light_count; i++) {
        light *l = &p->lights[i];
        if (l->kind == LIGHT_SUN)
            l->position = vec3_scale(p->cones[i].axis, -p->sun_distance), l->radius = l->reach = 0.0;
    }
}

static status prepare_lights(const scene *s, plan *p, diagnostic *why)
{
    p->lights = calloc(s->light_count + 1, sizeof *p->lights);
    p->cones = calloc(s->light_count + 1, sizeof *p->cones);
    p->shapes = calloc(s->light_count + 1, sizeof *p->shapes);
    if (!p->lights || !p->cones || !p->shapes)
        return out_of_memory(why);
    p->light_count = (int)s->light_count;
    for (size_t i = 0; i < s->light_count; i++) {
        p->lights[i] = s->lights[i];
        p->lights[i].color = seen_color(&s->lights[i]);
        if (s->lights[i].kind != LIGHT_POINT)
            p->cones[i] = light_cone_of(&s->lights[i]);
        p->has_sun |= s->lights[i].kind == LIGHT_SUN;
        if (light_is_flat(&s->lights[i]))
            p->shapes[i] = lamp_shape_of(&s->lights[i]);
    }
    place_suns(p);
    return STATUS_OK;
}

static status prepare_beams(const scene *s, plan *p, diagnostic *why)
{
    if (!(p->beams = calloc(s->beam_count + 1, sizeof *p->beams)))
        return out_of_memory(why);
    for (size_t i = 0; i < s->beam_count; i++)
        if (beam_lights_scene(&s->beams[i], &s->render))
            p->beams[p->beam_count++] = s->beams[i];
    return STATUS_OK;
}

static status add_rain(const scene *s, plan *p, diagnostic *why)
{
    const bool traced = !integrator_traits_of(&s->render)->unlit;
    if (s->background.kind != BACKGROUND_RAIN || s->background.rain == 0.0 || !traced)
        return STATUS_OK;
    p->rain = rain_create(&s->background, scene_to_sun(s), s->render.spectrum == SPECTRUM_SPECTRAL);
    return p->rain ? STATUS_OK : out_of_memory(why);
}

/* The sky to render. A gradient between equal colours, or a uniform CIE sky over ground of its colour, is replaced by a
 * uniform sky, which is bit-identical. */
static const background *sky_of(const scene *s, plan *p)
{
    const background *b = &s->background;
    const bool level = b->color.x == b->horizon.x && b->color.y == b->horizon.y && b->color.z == b->horizon.z;
    if (b->kind == BACKGROUND_CIE && !(level && b->sky_type == CIE_SKY_UNIFORM)) {
        p->own_sky = *b;
        p->own_sky.cie = cie_sky_make((int)b->sky_type, scene_to_sun(s));
        p->own_sky.cie.mean = s->render.beyond == DEPTH_LIMIT_MEAN ? cie_sky_mean(&p->own_sky.cie) : 0.0;
        return &p->own_sky;
    }
    const bool gradient = b->kind == BACKGROUND_GRADIENT || (b->kind == BACKGROUND_RAIN && !p->rain);
    if (!level || !(gradient || b->kind == BACKGROUND_CIE))
        return b;
    p->own_sky = *b;
    p->own_sky.kind = BACKGROUND_UNIFORM;
    return &p->own_sky;
}

/* Dispersion laws by solid; the last one is the surrounding medium's. */
static status laws_of(const scene *s, index_law *laws, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t i = 0; i < s->solid_count && code == STATUS_OK; i++)
        code = material_index_law(&s->solids[i].surface, s->solids[i].name, &laws[i], why);
    laws[s->solid_count] = surrounding_index_law(&s->background);
    return code;
}

/* The material that a solid is rendered with; for a mirror an opaque substitute, and with measured values one of their
 * colour, which spectra have by wavelength (render/plan/spectra.h). */
static const material *material_of(const scene *s, plan *p, int solid_index)
{
    const material *m = &s->solids[solid_index].surface;
    if (!material_is_mirror(m) && !m->color_values)
        return m;
    material *other = &p->substitutes[solid_index];
    *other = material_as_measured(m);
    if (!material_is_mirror(m))
        return other;
    const double both = m->reflectivity + m->transparency;
    other->reflectivity = scene_has_constant_weights(&s->render) && both < 1.0 ? both : 1.0;
    other->transparency = other->extinction = other->film_thickness_nm = 0.0;
    other->coating[0] = 0;
    return other;
}

/* False when out of memory. */
static bool add_roughness(const scene *s, plan *p, const material *m)
{
    const double alpha = material_roughness(m, &s->render);
    p->rough |= alpha > 0.0;
    return !(alpha > 0.0) || !s->render.energy_compensation ||
           rough_energy_add(&p->energy, alpha, material_reflectivity(m, &s->render), material_is_opaque(m));
}

/* Materials, refractive indices, absorption and shading materials, by priority index. shared: region_materials_make. */
static status fill_materials(const scene *s, shading_material **shared, plan *p, diagnostic *why)
{
    for (int r = 0; r <= p->geometry->region_count; r++) {
        const int solid_index = p->geometry->regions[r].solid;
        const bool open = p->geometry->regions[r].partial;
        p->laws[r] = &p->solid_laws[solid_index < 0 || open ? (int)s->solid_count : solid_index];
        p->ior[r] = index_law_at(p->laws[r], s->render.lambda_nm);
        if (solid_index < 0)
            continue;
        p->materials[r] = material_of(s, p, solid_index);
        if (!region_materials_make(s, &s->solids[solid_index], p->materials[r], shared, &p->shading_materials[r]))
            return out_of_memory(why);
        if (p->first_key && p->first_key[r])
            p->shading_materials[r].end_slots = p->end_slots[solid_index];
        for (int k = 0; k < p->shading_materials[r].count; k++)
            if (!add_roughness(s, p, &p->shading_materials[r].mat[k].surface))
                return out_of_memory(why);
        p->absorption[r] = open ? vec3_scale(s->background.absorb_per_m, s->render.unit_m)
                                : material_extinction(p->materials[r], s->render.unit_m);
    }
    return STATUS_OK;
}

/* Numbers the surface keys of regions whose faces differ. */
static status number_keys(const scene *s, plan *p, diagnostic *why)
{
    p->key_count = (size_t)p->geometry->region_count + 1;
    if (!p->end_slots)
        return STATUS_OK;
    if (!(p->first_key = calloc(p->key_count, sizeof *p->first_key)))
        return out_of_memory(why);
    for (int r = 1; r <= p->geometry->region_count; r++)
        if (solid_has_ends(&s->solids[p->geometry->regions[r].solid]))
            p->first_key[r] = (int)p->key_count, p->key_count += END_SLOTS - 1;
    return (p->end_laws = calloc(p->key_count, sizeof *p->end_laws)) ? STATUS_OK : out_of_memory(why);
}

/* The materials of the further keys. Only the law of an opaque one matters: that of a metal. */
static status fill_keys(plan *p, diagnostic *why)
{
    for (int r = 1; p->first_key && r <= p->geometry->region_count; r++)
        for (int slot = 1; p->first_key[r] && slot < END_SLOTS; slot++) {
            const int key = plan_surface_key(p, r, slot);
            const material *m = &p->shading_materials[r].mat[slot].surface;
            p->materials[key] = m;
            p->laws[key] = p->laws[r];
            p->ior[key] = p->ior[r];
            if (!material_is_opaque(m))
                continue;
            TRY(material_index_law(m, "", &p->end_laws[key], why));
            p->laws[key] = &p->end_laws[key];
        }
    return STATUS_OK;
}

/* Fills the tables by priority index. */
static status fill_priority_indices(const scene *s, plan *p, diagnostic *why)
{
    TRY(number_keys(s, p, why));
    const size_t keys = p->key_count, priority_indices = (size_t)p->geometry->region_count + 1;
    shading_material **shared = calloc(s->material_count + s->solid_count + 1, sizeof(shading_material *));
    p->materials = large_calloc(keys, sizeof *p->materials);
    p->ior = large_calloc(keys, sizeof *p->ior);
    p->laws = large_calloc(keys, sizeof *p->laws);
    p->absorption = large_calloc(priority_indices, sizeof *p->absorption);
    p->shading_materials = large_calloc(priority_indices, sizeof *p->shading_materials);
    p->substitutes = calloc(s->solid_count + 1, sizeof *p->substitutes);
    const bool room =
        shared && p->substitutes && p->materials && p->ior && p->laws && p->absorption && p->shading_materials;
    const status code = room ? fill_materials(s, shared, p, why) : out_of_memory(why);
    free(shared);
    TRY(code);
    TRY(fill_keys(p, why));
    if (!plan_find_shading_classes(p))
        return out_of_memory(why);
    p->absorption[0] = vec3_scale(s->background.absorb_per_m, s->render.unit_m);
    if (s->render.spectrum == SPECTRUM_SPECTRAL && !(p->spectral = spectra_create(s, p->materials, p->laws, keys)))
        return out_of_memory(why);
    if (!sheet_list_create(s, p->geometry, &p->sheets))
        return out_of_memory(why);
    if (!crystal_list_create(s, p->geometry, &p->crystals))
        return out_of_memory(why);
    if (!scatter_plan_create(s, p->geometry, &p->scatter))
        return out_of_memory(why);
    return layered_plan_create(&s->render, p->materials, p->laws, p->ior, p->shading_class, keys, &p->layered)
               ? STATUS_OK
               : out_of_memory(why);
}

/* Refuses a solid in which only some camera rays start: basic radiance has one index at the camera, and the depth
 * buffer one list of media. */
static status needs_one_medium(const scene *s, const plan *p, const solid *cut, diagnostic *why)
{
    if (solid_is_opaque(s, cut) || !(p->basic || integrator_traits_of(&s->render)->drawn))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT,
                    p->basic ? "move camera.position away from it, or set render.radiance to classic"
                             : "move camera.position away from it, or set render.integrator to whitted",
                    "%.80s reaches into the camera's %s, so that rays start in several media", cut->name,
                    p->view.parallel ? "image" : "lens");
}

static void add_analyser(const scene *s, plan *p)
{
    double sine, cosine;
    if (!s->render.polarisation)
        return;
    elementary_sincos_deg(s->camera.analyser_angle_deg, &sine, &cosine);
    p->analyser = (analyser_kind)s->camera.analyser;
    p->analyser_axis = vec3_add(vec3_scale(p->view.right, cosine), vec3_scale(p->view.up, sine));
}

/* A ray in a crystal has one of two modes; a camera ray has none. */
static status refuse_crystal(const solid *crystal, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "move camera.position out of it, or set its extraordinary_ior to 0",
                    "the camera is in the crystal %.80s", crystal->name);
}

/* Sets the camera's view, and finds the solids in which its rays start. */
static status place_camera(const scene *s, plan *p, diagnostic *why)
{
    const bool spread = (p->view = camera_frame_of(s)).parallel || p->view.lens_radius > 0.0;
    add_analyser(s, p);
    for (size_t i = 0; spread && i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (!one->visible || scene_apart_from_eye(s, one))
            continue;
        p->starts_vary = true;
        if (!solid_is_opaque(s, one) && material_is_crystal(&one->surface, &s->render))
            return refuse_crystal(one, why);
        TRY(needs_one_medium(s, p, one, why));
    }
    if (!integrator_traits_of(&s->render)->drawn)
        p->eye_inside = scene_geometry_inside(p->geometry, p->view.eye);
    p->camera_priority_index = scene_geometry_priority_index(p->geometry, p->eye_inside);
    if (p->crystals && p->crystals[p->camera_priority_index].uniaxial)
        return refuse_crystal(&s->solids[p->geometry->regions[p->camera_priority_index].solid], why);
    return STATUS_OK;
}

status plan_build(const scene *s, plan **out, diagnostic *why)
{
    plan *p = calloc(1, sizeof *p);
    if (p)
        p->solid_laws = calloc(s->solid_count + 1, sizeof *p->solid_laws);
    status code = p && p->solid_laws ? laws_of(s, p->solid_laws, why) : out_of_memory(why);
    if (code == STATUS_OK)
        p->basic = scene_has_basic_radiance(&s->render);
    THEN(code, build_geometry(s, p->solid_laws, p, why));
    THEN(code, fill_priority_indices(s, p, why));
    THEN(code, prepare_lights(s, p, why));
    THEN(code, prepare_beams(s, p, why));
    THEN(code, add_rain(s, p, why));
    THEN(code, place_camera(s, p, why));
    if (code != STATUS_OK) {
        plan_destroy(p);
        return code;
    }
    p->render = s->render;
    p->draws = integrator_traits_of(&s->render)->by_chance
                   ? path_sampling_of(&s->render)
                   : path_sampling_of_grid(&s->render,
                                           s->render.samples *
                                               (s->render.spectrum == SPECTRUM_SPECTRAL ? s->render.wavelengths : 1));
    if (integrator_traits_of(&s->render)->drawn)
        p->render.shadows = SHADOWS_OFF;
    p->sky = sky_of(s, p);
    if (s->render.beyond == DEPTH_LIMIT_MEAN)
        p->sky_mean = p->rain && !p->spectral ? vec3_add(sky_mean(p->sky), rain_color_mean(p->rain)) : sky_mean(p->sky);
    if (scene_has_caustics(&s->render))
        p->render.shadows = SHADOWS_OPAQUE; /* photons supply the light through clear solids */
    p->solid_shadows = p->render.shadows == SHADOWS_OPAQUE;
    for (size_t i = 0; i < s->light_count && integrator_traits_of(&s->render)->by_chance; i++)
        p->solid_shadows |= light_has_size(&s->lights[i]);
    for (int i = 0; i < p->light_count; i++)
        p->polarised_shadows |= p->sheets && s->render.polarisation && p->lights[i].polarised > 0.0;
    *out = p;
    return STATUS_OK;
}

void plan_destroy(plan *p)
{
    if (!p)
        return;
    for (int r = 0; p->shading_materials && r <= p->geometry->region_count; r++)
        if (!p->shading_materials[r].borrowed)
            free(p->shading_materials[r].mat);
    free(p->shading_materials);
    free(p->shading_class);
    free(p->first_key);
    free(p->end_laws);
    free(p->end_slots);
    scene_geometry_destroy(p->geometry);
    for (size_t i = 0; i < p->own_tree_count; i++)
        hierarchy_destroy(p->own_trees[i].tree);
    free(p->own_trees);
    for (size_t i = 0; p->shadow_transmittance && i < p->solid_count; i++)
        free(p->shadow_transmittance[i]);
    free(p->shadow_transmittance);
    free(p->materials);
    free(p->substitutes);
    free(p->ior);
    free(p->laws);
    free(p->solid_laws);
    free(p->absorption);
    free(p->lights);
    free(p->beams);
    free(p->cones);
    free(p->shapes);
    spectra_destroy(p->spectral);
    layered_plan_destroy(p->layered);
    rough_energy_destroy(p->energy);
    free(p->sheets);
    free(p->crystals);
    free(p->scatter);
    rain_destroy(p->rain);
    free(p);
}
