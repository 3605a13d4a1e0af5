/* Creates, copies and destroys scenes; finds objects by name (open.h, scene.h); estimates
 * its work. */
#include "scene/model/scene.h"
#include "base/elementary.h"
#include "base/file.h"
#include "base/worker_pool.h"
#include "geometry/shapes/shape.h"
#include "scene/model/names.h"
#include "scene/model/open.h"
#include "scene/model/params.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

scene *scene_create(void)
{
    scene *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->path = strdup("");
    s->title = strdup("");
    s->camera.aimed = 1;
    if (!s->path || !s->title || param_set_defaults(PARAM_RENDER, &s->render, NULL) != STATUS_OK ||
        param_set_defaults(PARAM_CAMERA, &s->camera, NULL) != STATUS_OK ||
        param_set_defaults(PARAM_BACKGROUND, &s->background, NULL) != STATUS_OK) {
        scene_destroy(s);
        return NULL;
    }
    return s;
}

void scene_destroy(scene *s)
{
    if (!s)
        return;
    objects_release(s);
    free(s->new_solid);
    free(s->background.image_path);
    image_destroy(s->background.img);
    free(s->path);
    free(s->title);
    free(s->remarks);
    free(s->limits.root);
    free(s);
}

static bool clone_texture(background *to, const background *from)
{
    to->img = NULL;
    to->image_path = strdup(from->image_path);
    if (!to->image_path)
        return false;
    if (from->img)
        to->img = image_retain(from->img); /* not modified after loading */
    return true;
}

scene *scene_clone(const scene *original)
{
    scene *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->render = original->render;
    s->camera = original->camera;
    s->background = original->background;
    s->has_followers = original->has_followers;
    s->path = strdup(original->path);
    s->title = strdup(original->title);
    s->remarks = original->remarks ? strdup(original->remarks) : NULL;
    bool complete = clone_texture(&s->background, &original->background);
    complete = objects_clone(s, original) && complete;
    complete = scene_limit(s, original->limits.root, original->limits.triangles, NULL) == STATUS_OK && complete;
    if (!complete || !s->path || !s->title || (original->remarks && !s->remarks)) {
        scene_destroy(s);
        return NULL;
    }
    return s;
}

const char *scene_path(const scene *s)
{
    return s->path;
}

const char *scene_root(const scene *s)
{
    return s->limits.root ? s->limits.root : "";
}

const render_settings *scene_settings(const scene *s)
{
    return &s->render;
}

const struct camera *scene_camera(const scene *s)
{
    return &s->camera;
}

const struct background *scene_background(const scene *s)
{
    return &s->background;
}

size_t scene_solid_count(const scene *s)
{
    return s->solid_count;
}

const char *scene_solid_name(const scene *s, int index)
{
    return s->solids[index].name;
}

const char *scene_light_name(const scene *s, int index)
{
    return s->lights[index].name;
}

status scene_limit(scene *s, const char *root, size_t triangles, diagnostic *why)
{
    char *copy = root ? strdup(root) : NULL;
    if (root && !copy)
        return out_of_memory(why);
    free(s->limits.root);
    s->limits = (load_limits){.root = copy, .triangles = triangles};
    return STATUS_OK;
}

char *scene_file_path(const scene *s, const char *path)
{
    return file_next_to(s->path, path);
}

status scene_file_error(const scene *s, const char *what, long line, long column, const diagnostic *bad, status code,
                        diagnostic *why)
{
    if (line == 0) {
        diagnostic_locate(why, bad->file, bad->line, bad->column);
        return diagnose(why, code, bad->remedy, "%s: %s", what, bad->what);
    }
    char place[64] = "";
    if (bad->file[0] && bad->line > 0 && bad->column > 0)
        snprintf(place, sizeof place, ":%ld:%ld", bad->line, bad->column);
    else if (bad->file[0] && bad->line > 0)
        snprintf(place, sizeof place, ":%ld", bad->line);
    diagnostic_locate(why, s->path, line, column);
    return diagnose(why, code, bad->remedy, "%s: %s%s%s%s", what, bad->file, place, bad->file[0] ? ": " : "",
                    bad->what);
}

/* --- objects by name --- */

int scene_find_solid(const scene *s, const char *name)
{
    return object_find(s, PARAM_SOLID, name);
}

const mesh_entry *scene_find_mesh(const scene *s, const char *name)
{
    const int at = object_find(s, PARAM_MESH, name);
    return at < 0 ? NULL : &s->meshes[at];
}

const mesh_entry *scene_mesh_of(const scene *s, const solid *owner)
{
    return shape_of(&owner->shape)->triangles ? scene_find_mesh(s, owner->mesh) : NULL;
}

const mesh_entry *scene_points_of(const scene *s, const solid *owner)
{
    return owner->points[0] && shape_has(shape_of(&owner->shape), "points") ? scene_find_mesh(s, owner->points) : NULL;
}

solid_shape scene_loaded_shape(const scene *s, const solid *owner)
{
    solid_shape shape = owner->shape;
    const mesh_entry *m = scene_mesh_of(s, owner), *points = scene_points_of(s, owner);
    shape.mesh = m ? m->data : NULL;
    shape.points = points ? points->data : NULL;
    return shape;
}

const texture_entry *scene_find_texture(const scene *s, const char *name)
{
    const int at = object_find(s, PARAM_TEXTURE, name);
    return at < 0 ? NULL : &s->textures[at];
}

static const optical_data *data_named(const scene *s, const char *name)
{
    const int at = name[0] ? object_find(s, PARAM_DATA, name) : -1;
    return at < 0 ? NULL : s->data[at].data;
}

static void follow_data(const scene *s, material *m)
{
    const int at = m->medium_data[0] ? object_find(s, PARAM_DATA, m->medium_data) : -1;
    m->index_data = data_named(s, m->medium_data);
    m->index_in_air = at >= 0 && s->data[at].relative_to == DATA_IN_AIR;
    const int coats = m->coating_data[0] ? object_find(s, PARAM_DATA, m->coating_data) : -1;
    m->coating_values = data_named(s, m->coating_data);
    m->coating_in_air = coats >= 0 && s->data[coats].relative_to == DATA_IN_AIR;
    m->color_values = data_named(s, m->color_data);
    m->absorb_values = data_named(s, m->absorb_data);
    m->scatter_values = data_named(s, m->scatter_data);
}

void scene_follow_data(scene *s)
{
    for (size_t i = 0; i < s->material_count; i++)
        follow_data(s, &s->materials[i].value);
    for (size_t i = 0; i < s->solid_count; i++)
        follow_data(s, &s->solids[i].surface);
    for (size_t i = 0; i < s->light_count; i++)
        s->lights[i].emission_data = data_named(s, s->lights[i].spectrum_data);
}

void solid_stand(solid *owner)
{
    owner->shape.rotation_deg = owner->rotation_deg;
    owner->shape.scale = owner->scale;
}

void beam_stand(beam *b)
{
    const beam_place *own = &b->own;
    b->position = own->position, b->target = own->target, b->direction = own->direction, b->normal = own->normal;
    b->width = own->width, b->field_width = own->field_width;
}

static vec3 passed_scale(const solid *leader)
{
    return shape_of(&leader->shape)->triangles || leader->points[0] ? vec3_make(1.0, 1.0, 1.0) : leader->shape.scale;
}

static vec3 times(vec3 a, vec3 b)
{
    return vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

/* A point in a solid's frame, in the world. */
static vec3 led_point(const solid *leader, vec3 local)
{
    const mat3 turn = rotation_from_deg(leader->shape.rotation_deg);
    return vec3_add(leader->shape.position, mat3_apply(turn, times(passed_scale(leader), local)));
}

static void solid_follow(solid *owner, const solid *leader)
{
    const vec3 own = owner->rotation_deg;
    owner->shape.position = led_point(leader, owner->offset);
    owner->shape.rotation_deg = leader->shape.rotation_deg;
    if (own.x != 0.0 || own.y != 0.0 || own.z != 0.0)
        owner->shape.rotation_deg =
            rotation_to_deg(mat3_product(rotation_from_deg(leader->shape.rotation_deg), rotation_from_deg(own)));
    owner->shape.scale = times(passed_scale(leader), owner->scale);
}

static void beam_follow(beam *b, const solid *leader)
{
    const mat3 turn = rotation_from_deg(leader->shape.rotation_deg);
    const double k = passed_scale(leader).x;
    b->position = led_point(leader, b->own.position), b->target = led_point(leader, b->own.target);
    b->direction = mat3_apply(turn, vec3_scale(b->own.direction, k));
    b->normal = mat3_apply(turn, b->own.normal);
    b->width = fabs(k) * b->own.width, b->field_width = fabs(k) * b->own.field_width;
}

double beam_scale(const scene *s, const beam *b)
{
    const int at = b->follows[0] ? scene_find_solid(s, b->follows) : -1;
    const vec3 k = at < 0 ? vec3_make(1.0, 1.0, 1.0) : passed_scale(&s->solids[at]);
    return k.x == k.y && k.x == k.z ? k.x : NAN;
}

void scene_follow_leaders(scene *s)
{
    for (size_t i = 0; s->has_followers && i < s->solid_count; i++) {
        const int at = solid_follows(&s->solids[i]) ? scene_find_solid(s, s->solids[i].follows) : -1;
        if (at >= 0 && (size_t)at != i)
            solid_follow(&s->solids[i], &s->solids[at]);
    }
    for (size_t i = 0; s->has_followers && i < s->beam_count; i++) {
        const int at = s->beams[i].follows[0] ? scene_find_solid(s, s->beams[i].follows) : -1;
        if (at >= 0)
            beam_follow(&s->beams[i], &s->solids[at]);
    }
}

const light *scene_sun(const scene *s)
{
    for (size_t i = 0; i < s->light_count; i++)
        if (s->lights[i].kind == LIGHT_SUN)
            return &s->lights[i];
    return NULL;
}

vec3 scene_to_sun(const scene *s)
{
    const light *l = scene_sun(s);
    double up, level, side, ahead;
    if (l)
        return vec3_normalize(vec3_sub(l->position, l->target));
    elementary_sincos_deg(s->background.sun_elevation_deg, &up, &level);
    elementary_sincos_deg(s->background.sun_azimuth_deg, &side, &ahead);
    return vec3_make(level * side, up, level * ahead);
}

/* --- threads --- */

static int automatic_threads(void)
{
    enum { THREADS_MAX = 1024 };
    const int units = thread_team_units();
    return units > THREADS_MAX ? THREADS_MAX : units;
}

int scene_threads(const render_settings *r)
{
    return r->threads > 0 ? (int)r->threads : automatic_threads();
}

int scene_build_threads(const render_settings *r)
{
    return r->build_threads > 0 ? (int)r->build_threads : automatic_threads();
}

/* --- the work of a scene, estimated from its parameters --- */

static double triangles_of(const mesh_entry *m)
{
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE:
    case MESH_DENSE:
    case MESH_SPHERE: return (double)m->count;
    case MESH_ICOSPHERE:
    case MESH_SLIME: return 20.0 * pow(4.0, (double)m->level);
    case MESH_TORUS: return 2.0 * (double)m->around * (double)m->tube;
    case MESH_LATHE: return (double)m->around * ((double)m->profile.count - 2.0); /* two numbers per point */
    case MESH_TERRAIN: /* the heights; if it has a bottom, also 4 for the walls and 2 for the bottom per cell of the
                          edge */
        return 2.0 * (double)m->around * (double)m->tube + (m->depth > 0.0 ? 6.0 * (double)(m->around + m->tube) : 0.0);
    case MESH_BOX:
    case MESH_FILE:
    case MESH_ARRAYS: break;
    }
    return 12.0;
}

double scene_planned_triangles(const scene *s)
{
    double triangles = 0.0;
    for (size_t i = 0; i < s->mesh_count; i++)
        triangles += triangles_of(&s->meshes[i]);
    return triangles;
}

double scene_camera_rays(const render_settings *r)
{
    const double rays =
        integrator_traits_of(r)->by_chance ? fmax((double)r->paths, (double)r->samples) : (double)r->samples;
    const double wavelengths = r->spectrum == SPECTRUM_SPECTRAL ? (double)r->wavelengths : 1.0;
    return (double)r->width * (double)r->height * rays * wavelengths;
}

double scene_rays_bound(const render_settings *r)
{
    const double levels = (double)r->depth + 1.0;
    const double tree = fmin(exp2(levels), r->min_weight > 0.0 ? levels / r->min_weight : INFINITY);
    return scene_camera_rays(r) * (integrator_traits_of(r)->by_chance ? levels : tree);
}

double slime_work(const mesh_entry *m)
{
    const double steps = floor(m->time_s / m->slime.dt_s + 0.5); /* counted as by softbody_advance */
    return steps * (10.0 * pow(4.0, (double)m->level) + 2.0);
}
