/* Hashes the meaning of a scene and the contents of its files into the identities of cells. A file with the same name
 * and other contents makes another scene. Hashes are the same on every machine. */
#include "study/plan/identity.h"
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "scene/model/face_materials.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- meaning of a scene --- */

/* Adds an item, which owns both texts. */
static status add(meaning *m, char *name, char *value)
{
    if (!name || !value || !room_for_one(&m->items, m->count, sizeof *m->items)) {
        free(name);
        free(value);
        return STATUS_FAILURE;
    }
    m->items[m->count++] = (meaning_item){name, value};
    return STATUS_OK;
}

typedef struct visit_state {
    meaning *into;
    const scene *s;
    bool without_performance, by_chance;
} visit_state;

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    visit_state *state = context;
    if (row->group == PARAM_BEAM && !scene_film_depends_on(state->s, path))
        return STATUS_OK;
    if ((state->without_performance && row->performance_only) || (row->by_chance && !state->by_chance))
        return STATUS_OK;
    return add(state->into, strdup(path), strdup(value));
}

/* Every object is listed, including those with all parameters at their defaults. */
static status add_objects(meaning *m, const scene *s, param_group group)
{
    for (size_t i = 0; i < param_place_group_size(s, group); i++)
        if (group != PARAM_BEAM || s->beams[i].lights) /* no film depends on a beam that does not light the scene */
            TRY(add(m, text_format("%s %zu", param_group_name(group), i), strdup(param_place_group_name(s, group, i))));
    return STATUS_OK;
}

static status add_solid(meaning *m, const scene *s, const solid *owner)
{
    TRY(add(m, text_format("shape of %s", owner->name), strdup(shape_name(owner->shape.kind))));
    if (owner->material_index >= 0)
        TRY(add(m, text_format("material of %s", owner->name), strdup(s->materials[owner->material_index].name)));
    return STATUS_OK;
}

/* Adds the parameters that do not have their first defaults. */
static status add_params(meaning *m, const scene *s, bool without_performance, const param_defaults *first_defaults)
{
    visit_state state = {m, s, without_performance, integrator_traits_of(&s->render)->by_chance};
    param_defaults *own = first_defaults ? NULL : param_first_defaults_create();
    const param_defaults *but = first_defaults ? first_defaults : own;
    const status code = but ? scene_each_param_but(s, but, add_param, &state) : STATUS_FAILURE;
    param_first_defaults_destroy(own);
    return code;
}

status meaning_of_scene(meaning *m, const scene *s, bool without_performance, const param_defaults *first_defaults)
{
    static const param_group groups[] = {PARAM_MESH, PARAM_TEXTURE,  PARAM_DATA, PARAM_LIGHT,
                                         PARAM_BEAM, PARAM_MATERIAL, PARAM_SOLID};
    TRY(add_params(m, s, without_performance, first_defaults));
    TRY(add(m, strdup("the camera's direction"), strdup(s->camera.aimed ? "its target" : "its angles")));
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++)
        TRY(add_objects(m, s, groups[i]));
    for (size_t i = 0; i < s->solid_count; i++)
        TRY(add_solid(m, s, &s->solids[i]));
    return STATUS_OK;
}

void meaning_free(meaning *m)
{
    for (size_t i = 0; i < m->count; i++) {
        free(m->items[i].name);
        free(m->items[i].value);
    }
    free(m->items);
    *m = (meaning){0};
}

uint64_t meaning_hash(const meaning *m)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < m->count; i++) {
        const meaning_item *item = &m->items[i];
        const uint64_t name = hash_bytes(HASH_START, item->name, strlen(item->name) + 1);
        sum += hash_finish(hash_bytes(name, item->value, strlen(item->value) + 1));
    }
    return sum;
}

/* --- contents of files --- */

static void hash_array(uint64_t *hash, const void *array, size_t count, size_t size)
{
    if (array)
        *hash = hash_numbers(*hash, array, count, size);
}

static void hash_texture(uint64_t *hash, const texture *t)
{
    if (t)
        *hash = texture_hash(t, *hash);
}

/* Properties that later versions added are hashed only if they are not at their defaults, so that old hashes stay
 * valid. */
static void hash_material(uint64_t *hash, const face_material *m)
{
    const double numbers[] = {m->given, m->color.x, m->color.y, m->color.z, m->diffuse, m->specular, m->shininess};
    hash_array(hash, numbers, sizeof numbers / sizeof *numbers, sizeof *numbers);
    const bool masks = m->alpha == ALPHA_MASK;
    const double later[] = {m->emission, 1.0 - m->opacity, (double)m->alpha, masks ? m->alpha_cutoff : 0.0};
    for (size_t i = 0; i < sizeof later / sizeof *later; i++) {
        const double numbered[] = {(double)i, later[i]};
        hash_array(hash, later[i] != 0.0 ? numbered : NULL, 2, sizeof *numbered);
    }
    hash_texture(hash, m->img);
    if (m->img)
        *hash = texture_sampler_hash(m->img, *hash);
    const double glow[] = {(double)(sizeof later / sizeof *later), m->glow.x, m->glow.y, m->glow.z};
    hash_array(hash, m->emission > 0.0 ? glow : NULL, sizeof glow / sizeof *glow, sizeof *glow);
    hash_texture(hash, m->glow_img);
    if (m->glow_img)
        *hash = texture_sampler_hash(m->glow_img, *hash);
}

static void hash_mesh(uint64_t *hash, const mesh *m)
{
    hash_array(hash, m->vertices, m->vertex_count * 3, sizeof(double));
    hash_array(hash, m->triangles, m->triangle_count * 3, sizeof(uint32_t));
    hash_array(hash, m->normals, m->vertex_count * 3, sizeof(double));
    hash_array(hash, m->uvs, m->vertex_count * 2, sizeof(double));
    hash_array(hash, m->colors, m->vertex_count * 3, sizeof(float));
    hash_array(hash, m->slots, m->triangle_count, sizeof *m->slots);
    for (int i = 0; i < m->slot_count; i++)
        if (m->slot_names[i])
            hash_array(hash, m->slot_names[i], strlen(m->slot_names[i]) + 1, 1);
}

/* The text of a slime's script. An unreadable script is skipped: loading it reports the error. */
static status hash_script(uint64_t *hash, const scene *s, const mesh_entry *m, diagnostic *why)
{
    enum { SCRIPT_BYTES_MAX = 1 << 20 };
    char *path = scene_file_path(s, m->script_path), *text = NULL;
    size_t size = 0;
    const status code =
        path ? file_read_below(path, s->limits.root, SCRIPT_BYTES_MAX, &text, &size, why) : out_of_memory(why);
    if (code == STATUS_OK)
        hash_array(hash, text, size, 1);
    free(text);
    free(path);
    return code == STATUS_BAD_INPUT ? STATUS_OK : code;
}

status identity_hash_files(uint64_t *hash, const scene *s, diagnostic *why)
{
    status code = STATUS_OK;
    const image *sky = s->background.img;
    if (sky)
        hash_array(hash, sky->pixel, (size_t)sky->width * (size_t)sky->height * 3, sizeof *sky->pixel);
    for (size_t i = 0; i < s->texture_count; i++)
        hash_texture(hash, s->textures[i].data);
    for (size_t i = 0; i < s->data_count; i++)
        if (s->data[i].data)
            *hash = optical_data_hash(s->data[i].data, *hash);
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *m = &s->meshes[i];
        if (m->source == MESH_FILE && m->data)
            hash_mesh(hash, m->data);
        if (m->source == MESH_SLIME && m->script_path[0])
            THEN(code, hash_script(hash, s, m, why));
        for (int slot = 0; slot < face_materials_count(m->shading_materials); slot++)
            hash_material(hash, face_materials_at(m->shading_materials, slot));
    }
    return code;
}

/* --- hashes --- */

static void hash_text(uint64_t *hash, const char *text)
{
    *hash = hash_bytes(*hash, text, strlen(text) + 1);
}

status reference_scene_hash(const scene *setting, uint64_t *hash)
{
    meaning m = {0};
    status code = meaning_of_scene(&m, setting, true, NULL);
    const int64_t word = (int64_t)meaning_hash(&m);
    meaning_free(&m);
    *hash = hash_words(HASH_START, &word, 1);
    THEN(code, identity_hash_files(hash, setting, NULL));
    *hash = hash_finish(*hash);
    return code;
}

static void hash_point(uint64_t *hash, const study_point *point)
{
    for (size_t i = 0; i < point->count; i++) {
        hash_text(hash, point->paths[i]);
        hash_text(hash, point->values[i]);
    }
}

/* --- identities --- */

static bool names_file(const study *s, const study_axis *axis)
{
    param_place at;
    for (size_t i = 0; i < axis->points[0].count; i++)
        if (param_place_find(s->base, axis->points[0].paths[i], &at, NULL) == STATUS_OK && at.row->type == PARAM_PATH)
            return true;
    return false;
}

/* Whether cells may differ in the files that they name. */
static bool files_vary(const study *s)
{
    for (size_t axis = 0; axis < s->axis_count; axis++)
        if (names_file(s, &s->axes[axis]))
            return true;
    return false;
}

typedef struct search {
    uint64_t *identity;
    bool loads;
    uint64_t files; /* hash of the files of the base, unless cells name different ones */
    param_defaults *first_defaults;
} search;

static status find_one(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    search *all = context;
    meaning m = {0};
    uint64_t files = all->files;
    if (all->loads) {
        scene_load_files(setting, NULL); /* a file that cannot be read counts as empty; measuring reports it */
        files = HASH_START;
        TRY(identity_hash_files(&files, setting, why));
    }
    const status code = meaning_of_scene(&m, setting, false, all->first_defaults);
    const int64_t words[] = {(int64_t)meaning_hash(&m), (int64_t)files};
    meaning_free(&m);
    if (code != STATUS_OK)
        return out_of_memory(why);
    all->identity[cell] = hash_finish(hash_words(HASH_START, words, 2));
    (void)s;
    return STATUS_OK;
}

typedef struct numbered {
    uint64_t identity;
    size_t cell;
} numbered;

static int compare_numbered(const void *a, const void *b)
{
    const numbered *x = a, *y = b;
    if (x->identity != y->identity)
        return x->identity < y->identity ? -1 : 1;
    return (x->cell > y->cell) - (x->cell < y->cell);
}

/* Cells that differ only in values without effect would have one identity: their axis values are hashed as well. */
static status separate_equals(const study *s, uint64_t *identity, diagnostic *why)
{
    const size_t count = study_cell_count(s);
    numbered *sorted = malloc(count * sizeof *sorted);
    if (!sorted)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        sorted[i] = (numbered){identity[i], i};
    qsort(sorted, count, sizeof *sorted, compare_numbered);
    for (size_t i = 1; i < count; i++) {
        if (sorted[i].identity != sorted[i - 1].identity)
            continue;
        uint64_t hash = sorted[i].identity;
        for (size_t axis = 0; axis < s->axis_count; axis++)
            hash_point(&hash, &s->axes[axis].points[study_cell_point(s, sorted[i].cell, axis)]);
        identity[sorted[i].cell] = hash_finish(hash);
    }
    free(sorted);
    return STATUS_OK;
}

status identities_find(const study *s, uint64_t **out, diagnostic *why)
{
    search all = {.loads = files_vary(s), .files = HASH_START};
    *out = NULL;
    if (!all.loads)
        TRY(identity_hash_files(&all.files, s->base, why));
    all.identity = calloc(study_cell_count(s), sizeof *all.identity);
    all.first_defaults = param_first_defaults_create();
    status code = all.identity && all.first_defaults ? grid_each_cell(s, find_one, &all, why) : out_of_memory(why);
    param_first_defaults_destroy(all.first_defaults);
    THEN(code, separate_equals(s, all.identity, why));
    if (code == STATUS_OK)
        *out = all.identity;
    else
        free(all.identity);
    return code;
}

size_t identity_cell(const study *s, uint64_t identity)
{
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        if (s->identity[cell] == identity)
            return cell;
    return study_cell_count(s);
}

uint64_t identity_compared(const study *s, uint64_t identity)
{
    const int64_t word = (int64_t)identity;
    uint64_t hash = hash_words(HASH_START, &word, 1);
    hash_point(&hash, &s->reference);
    return hash_finish(hash);
}
