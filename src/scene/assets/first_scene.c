/* A first scene out of a mesh file: its mesh as one solid, with the file's glass, cameras and lights. What a scene
 * cannot say is a note. */
#include "base/text.h"
#include "import/mesh_wire.h"
#include "scene/assets/mesh_stream.h"
#include "scene/model/camera.h"
#include "scene/model/edit/edit.h"
#include "scene/model/medium.h"
#include "scene/model/names.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BODY "body"
#define MODEL "model"

typedef struct first_scene {
    scene *s;
    const mesh_import *from;
    vec3 centre;
    double radius; /* of a ball around the mesh */
    char note[1024];
    diagnostic *why;
} first_scene;

/* Adds a sentence to the note, unless it is there or there is no room. */
__attribute__((format(printf, 2, 3))) static void note(first_scene *f, const char *format, ...)
{
    char sentence[300];
    const size_t length = strlen(f->note);
    va_list list;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    if (!strstr(f->note, sentence) && length + strlen(sentence) + 3 < sizeof f->note)
        snprintf(f->note + length, sizeof f->note - length, "%s%s", length ? "; " : "", sentence);
}

static vec3 vector(const double v[3])
{
    return vec3_make(v[0], v[1], v[2]);
}

/* Adds an object with the name of the file, in letters that a scene allows, and a number if it is in use. */
static status add_named(first_scene *f, param_group group, const char *wanted, const char *otherwise, size_t *index)
{
    char name[SCENE_NAME_MAX + 1], other[SCENE_NAME_MAX + 1];
    diagnostic unused = {.what = ""};
    snprintf(name, sizeof name - 8, "%s", wanted && *wanted ? wanted : otherwise);
    for (char *c = name; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-", *c))
            *c = '_';
    if (check_name(name, NULL) != STATUS_OK)
        snprintf(name, sizeof name, "%s", otherwise);
    status code = scene_add(f->s, group, name, index, &unused);
    for (int number = 2; code == STATUS_BAD_INPUT && number < 2000; number++) {
        snprintf(other, sizeof other, "%.50s_%d", name, number);
        code = scene_add(f->s, group, other, index, &unused);
    }
    if (code != STATUS_OK && f->why)
        *f->why = unused;
    return code;
}

/* --- the solid and its glass --- */

static status add_body(first_scene *f, const char *path)
{
    TRY(scene_add(f->s, PARAM_MESH, MODEL, NULL, f->why));
    TRY(scene_set(f->s, MODEL ".file", path, f->why));
    TRY(scene_add_solid(f->s, BODY, SHAPE_MESH, NULL, f->why));
    TRY(scene_set(f->s, BODY ".mesh", MODEL, f->why));
    bool given = true;
    for (int i = 0; i < f->from->material_count; i++)
        given &= f->from->materials[i].given;
    return given ? STATUS_OK : scene_set(f->s, BODY ".diffuse", "0.8", f->why);
}

/* Cauchy's law n = A + B / L^2 with the index at the line d, and Abbe's number V = (n_d - 1) / (n_F - n_C), of which
 * KHR_materials_dispersion gives 20 / V. Lines in um: Born and Wolf, Principles of Optics, 4.7.1. */
static void disperse(material *m, double strength)
{
    const double d = 0.58756, F = 0.48613, C = 0.65627;
    const double b = (m->ior - 1) * strength / 20 / (1 / (F * F) - 1 / (C * C));
    m->medium = MEDIUM_CAUCHY;
    m->coefficients = (number_list){.count = 2, .value = {m->ior - b / (d * d), b}};
}

/* A solid has one medium: glass refracts if all of the mesh is glass, or else light goes straight through it. */
static status add_glass(first_scene *f)
{
    const imported_material *glass = NULL;
    int clear = 0;
    size_t index;
    for (int i = 0; i < f->from->material_count; i++) {
        const imported_material *m = &f->from->materials[i];
        if (m->transmission > 0 || (m->opacity < 1 && m->alpha_mode == MESH_WIRE_ALPHA_OPAQUE))
            clear++;
        if (m->transmission > 0 && !glass)
            glass = m;
    }
    if (clear == 0)
        return STATUS_OK;
    if (!glass || clear < f->from->material_count) {
        f->s->render.transmission = TRANSMISSION_SIMPLE;
        note(f, "light goes straight through the transparent materials, because a solid has one medium: for glass that "
                "refracts, export its parts as a file of their own");
        return STATUS_OK;
    }
    if (clear > 1)
        note(f, "all of the mesh is glass of material '%.60s'", glass->name ? glass->name : "");
    TRY(add_named(f, PARAM_MATERIAL, glass->name, "glass", &index));
    material *m = &f->s->materials[index].value;
    m->transparency = glass->transmission;
    m->ior = glass->ior;
    if (glass->attenuation_distance > 0) {
        m->color = vector(glass->attenuation_color);
        m->tint_distance = glass->attenuation_distance;
    }
    if (glass->dispersion > 0)
        disperse(m, glass->dispersion);
    return scene_assign_material(f->s, BODY, f->s->materials[index].name, f->why);
}

/* --- cameras --- */

static void look_from_front(first_scene *f)
{
    camera *c = &f->s->camera;
    const vec3 from = vec3_normalize(vec3_make(0.45, 0.35, -1));
    c->aimed = 1;
    c->target = f->centre;
    const double distance = 1.05 * f->radius / sin(0.5 * c->fov_deg * M_PI / 180);
    c->position = vec3_add(f->centre, vec3_scale(from, distance));
}

/* The roll turns the level image upright: its up is then that of the file. */
static void set_camera(first_scene *f, const mesh_wire_view *v)
{
    scene *s = f->s;
    camera *c = &s->camera;
    const vec3 forward = vector(v->forward), up = vector(v->up);
    const double ahead = vec3_dot(vec3_sub(f->centre, vector(v->position)), forward);
    c->aimed = 1;
    c->position = vector(v->position);
    c->target = vec3_add(c->position, vec3_scale(forward, ahead > 0 ? ahead : 1));
    const camera_frame level = camera_frame_level(s);
    const double roll = atan2(vec3_dot(up, level.right), vec3_dot(up, level.up)) * 180 / M_PI;
    c->roll_deg = fabs(roll) < 1e-9 ? 0 : roll;
    if (v->kind == MESH_WIRE_ORTHOGRAPHIC) {
        c->projection = PROJECTION_ORTHOGRAPHIC;
        c->view_height = v->height > 0 ? v->height : c->view_height;
    } else if (v->height > 0) {
        c->fov_deg = fmin(v->height * 180 / M_PI, 179);
    }
    if (v->aspect > 0.05 && v->aspect < 20)
        s->render.width = (int64_t)floor((double)s->render.height * v->aspect + 0.5);
}

static void add_cameras(first_scene *f)
{
    int count = 0;
    for (int i = 0; i < f->from->view_count; i++) {
        const mesh_wire_view *v = f->from->views[i].values;
        if (v->kind > MESH_WIRE_ORTHOGRAPHIC)
            continue;
        const char *name = f->from->views[i].name;
        if (count++ == 0)
            set_camera(f, v);
        else if (name && *name)
            note(f, "a scene has one camera: '%.60s' is left out", name);
        else
            note(f, "a scene has one camera: camera %d, which has no name, is left out", count);
    }
    if (count == 0)
        look_from_front(f);
}

/* --- lights --- */

static vec3 toward_centre(const first_scene *f, const mesh_wire_view *v)
{
    return vec3_sub(f->centre, vector(v->position));
}

static double brightest(const double color[3])
{
    return fmax(color[0], fmax(color[1], color[2]));
}

/* The light that would reach the centre of the mesh if a spot shone there: lx of a sun, cd / m^2 of a point. */
static double at_centre(const first_scene *f, const mesh_wire_view *v)
{
    const vec3 way = toward_centre(f, v);
    const double distance2 = fmax(vec3_dot(way, way), 1e-6 * f->radius * f->radius);
    return v->power * brightest(v->color) / (v->kind == MESH_WIRE_SUN ? 1 : distance2);
}

static status add_light(first_scene *f, const imported_view *view, double factor)
{
    const mesh_wire_view *v = view->values;
    size_t index;
    TRY(add_named(f, PARAM_LIGHT, view->name, "light", &index));
    light *l = &f->s->lights[index];
    const vec3 way = toward_centre(f, v), forward = vector(v->forward);
    const double distance = fmax(vec3_length(way), 1e-3 * f->radius);
    const double scale = brightest(v->color) > 0 ? 1 / brightest(v->color) : 0;
    l->color = vec3_scale(vector(v->color), scale);
    l->intensity = at_centre(f, v) * factor;
    l->position = vector(v->position);
    l->target = vec3_add(l->position, vec3_scale(forward, distance));
    if (v->kind == MESH_WIRE_SUN) {
        l->kind = LIGHT_SUN;
        l->position = vec3_sub(f->centre, vec3_scale(forward, 2 * f->radius));
        l->target = f->centre;
        return STATUS_OK;
    }
    l->reach = distance;
    if (v->kind == MESH_WIRE_SPOT) {
        l->kind = v->inner < 0.9 * v->outer ? LIGHT_SOFT_CONE : LIGHT_CONE;
        l->half_angle_deg = fmin(fmax(v->outer * 180 / M_PI, 0.01), 180);
        if (v->inner > 0 && l->kind == LIGHT_SOFT_CONE)
            note(f, "spots have no inner angle: their light falls from the axis to the edge");
    }
    if (v->range > 0)
        note(f, "lights have no range: they fall with the square of the distance only");
    return STATUS_OK;
}

/* Without a light, a sun above the camera's left shoulder. */
static status add_sun(first_scene *f)
{
    size_t index;
    TRY(add_named(f, PARAM_LIGHT, NULL, "sun", &index));
    light *l = &f->s->lights[index];
    const camera_frame frame = camera_frame_of(f->s);
    const vec3 from = vec3_normalize(
        vec3_add(vec3_add(vec3_scale(frame.forward, -1), vec3_scale(frame.right, -0.6)), vec3_make(0, 1, 0)));
    l->kind = LIGHT_SUN;
    l->angular_diameter_deg = 0; /* a size that nobody set would be noted where shadows are sharp */
    l->position = vec3_add(f->centre, vec3_scale(from, 2 * f->radius));
    l->target = f->centre;
    return STATUS_OK;
}

/* The units of files differ by 683 lm/W, and viewers adapt: here the lights are scaled together, so that white paper at
 * the centre is as bright as white. */
static status add_lights(first_scene *f)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < f->from->view_count; i++)
        if (f->from->views[i].values->kind > MESH_WIRE_ORTHOGRAPHIC)
            sum += at_centre(f, f->from->views[i].values), count++;
    if (!(sum > 0))
        return add_sun(f);
    note(f, "the %d light%s of the file, by a common factor, sum up to 1 at the middle of the mesh", count,
         count == 1 ? "" : "s");
    for (int i = 0; i < f->from->view_count; i++)
        if (f->from->views[i].values->kind > MESH_WIRE_ORTHOGRAPHIC)
            TRY(add_light(f, &f->from->views[i], 1 / sum));
    return STATUS_OK;
}

/* --- the scene --- */

static status build(first_scene *f, const char *path)
{
    const bounds3 b = f->from->mesh->bounds;
    f->centre = vec3_scale(vec3_add(b.low, b.high), 0.5);
    f->radius = fmax(0.5 * vec3_length(vec3_sub(b.high, b.low)), 1e-6);
    TRY(add_body(f, path));
    TRY(add_glass(f));
    add_cameras(f);
    return add_lights(f);
}

status mesh_first_scene(const char *path, scene **out, char **notes, diagnostic *why)
{
    const mesh_limits limits = {.right_handed = true};
    mesh_import *from = NULL;
    *out = NULL;
    *notes = NULL;
    TRY(mesh_read_file(path, &limits, &from, why));
    first_scene f = {.s = scene_create(), .from = from, .why = why};
    status code = f.s ? build(&f, path) : out_of_memory(why);
    const char *read = from->note ? from->note : "";
    if (code == STATUS_OK && (*read || f.note[0]) &&
        !(*notes = text_format("%s%s%s", read, *read && f.note[0] ? "; " : "", f.note)))
        code = out_of_memory(why);
    mesh_import_destroy(from);
    if (code == STATUS_OK)
        *out = f.s;
    else
        scene_destroy(f.s);
    return code;
}
