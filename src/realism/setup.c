/* The solids and the camera of a scene as numbers, and copies of a scene with some of its media in other solids. */
#include "realism/setup.h"
#include "geometry/shapes/shape.h"

#include "scene/model/medium.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include "scene/model/view_settings.h"
#include <math.h>

static status unsuitable(const scene *s, diagnostic *why, const char *remedy, const char *what)
{
    return diagnose_at(why, s->path, STATUS_BAD_INPUT, remedy, "%s", what);
}

static bool is_turned(const solid *one)
{
    const vec3 r = one->shape.rotation_deg;
    return r.x != 0.0 || r.y != 0.0 || r.z != 0.0 || shape_is_scaled(&one->shape);
}

static int find_visible(const scene *s, const char *name)
{
    const int i = scene_find_solid(s, name);
    return i >= 0 && s->solids[i].visible ? i : -1;
}

static status index_of(const scene *s, int which, double *n, diagnostic *why)
{
    index_law law;
    TRY(material_index_law(&s->solids[which].surface, s->solids[which].name, &law, why));
    *n = index_law_at(&law, s->render.lambda_nm);
    return STATUS_OK;
}

static const char example[] = "use the names and shapes of experiments/scenes/rod.yaml, prism.yaml, rainbow.yaml or "
                              "plates.yaml";

static status read_vessel(const scene *s, setup *out, diagnostic *why)
{
    out->vessel = find_visible(s, "vessel");
    out->rod = -1;
    if (out->vessel < 0 || s->solids[out->vessel].shape.kind != SHAPE_CUP)
        return unsuitable(s, why, example, "there is no visible cup named 'vessel'");
    const solid *vessel = &s->solids[out->vessel];
    if (vessel->shape.m != 1.0)
        return unsuitable(s, why, "set vessel.m to 1: the closed forms require a round vessel",
                          "the vessel is elliptic");
    if (is_turned(vessel) || vessel->surface.transparency == 0.0)
        return unsuitable(s, why, "set its rotation to 0, its scale to 1,1,1, and its transparency above 0",
                          "the vessel is rotated, scaled or opaque");
    out->x = vessel->shape.position.x, out->z = vessel->shape.position.z;
    out->outer = vessel->shape.radius, out->inner = vessel->shape.inner_radius;
    out->low = vessel->shape.position.y + vessel->shape.floor;
    out->high = vessel->shape.position.y + vessel->shape.height;
    return STATUS_OK;
}

static status read_rod(const scene *s, setup *out, diagnostic *why)
{
    out->rod = find_visible(s, "rod");
    if (out->rod < 0 || s->solids[out->rod].shape.kind != SHAPE_BOX)
        return unsuitable(s, why, example, "there is no visible box named 'rod'");
    const solid *vessel = &s->solids[out->vessel], *rod = &s->solids[out->rod];
    if (rod->surface.transparency != 0.0 || rod->priority <= vessel->priority)
        return unsuitable(s, why, "set its transparency to 0 and its priority above the vessel's",
                          "the rod is not opaque, or the vessel displaces it");
    return STATUS_OK;
}

/* Whether the vessel has precedence where it overlaps the liquid. */
static bool vessel_wins(const scene *s, const setup *at)
{
    const int64_t vessel = s->solids[at->vessel].priority, liquid = s->solids[at->liquid].priority;
    return vessel > liquid || (vessel == liquid && at->vessel < at->liquid);
}

static status read_liquid(const scene *s, setup *out, diagnostic *why)
{
    const solid *liquid = &s->solids[out->liquid];
    const solid_shape *shape = &liquid->shape;
    if (shape->kind != SHAPE_CYLINDER || shape->m != 1.0 || is_turned(liquid) || liquid->surface.transparency == 0.0)
        return unsuitable(s, why, "make it an upright round cylinder with a transparency above 0",
                          "the liquid is not a transparent round cylinder");
    if (shape->capillary_length > 0.0)
        return unsuitable(s, why, "set its capillary_length to 0",
                          "the liquid has a meniscus; the metrics require a level surface");
    if (shape->position.x != out->x || shape->position.z != out->z || shape->radius < out->inner ||
        shape->radius >= out->outer)
        return unsuitable(s, why,
                          "put both on one axis; set the liquid's radius between the vessel's inner_radius and radius",
                          "the liquid does not reach into the vessel's wall all around");
    if (out->rod >= 0 && s->solids[out->rod].priority <= liquid->priority)
        return unsuitable(s, why, "set the rod's priority above the liquid's", "the liquid displaces the rod");
    if (!vessel_wins(s, out)) {
        out->inner = shape->radius;
        out->low = fmax(s->solids[out->vessel].shape.position.y, shape->position.y);
    }
    if (shape->position.y > out->low || shape->position.y + shape->height <= out->low)
        return unsuitable(s, why, "make the liquid begin within the vessel's floor and end above it",
                          "the liquid does not rest on the vessel's floor");
    out->high = fmin(out->high, shape->position.y + shape->height);
    return STATUS_OK;
}

/* Reads the indices and the liquid; read_vessel must come first. */
static status read_media(const scene *s, setup *out, diagnostic *why)
{
    status code = STATUS_OK;
    const index_law around = surrounding_index_law(&s->background);
    out->n[SETUP_OUTSIDE] = out->n[SETUP_LIQUID] = index_law_at(&around, s->render.lambda_nm);
    out->liquid = find_visible(s, "liquid");
    THEN(code, index_of(s, out->vessel, &out->n[SETUP_VESSEL], why));
    if (code == STATUS_OK && out->liquid >= 0) {
        code = read_liquid(s, out, why);
        THEN(code, index_of(s, out->liquid, &out->n[SETUP_LIQUID], why));
    }
    return code;
}

status setup_read(const scene *s, setup *out, diagnostic *why)
{
    TRY(read_vessel(s, out, why));
    TRY(read_rod(s, out, why));
    return read_media(s, out, why);
}

status setup_read_glass(const scene *s, setup *out, diagnostic *why)
{
    TRY(read_vessel(s, out, why));
    TRY(read_media(s, out, why));
    return out->liquid >= 0 ? STATUS_OK
                            : unsuitable(s, why, "use the names and shapes of experiments/scenes/arrow.yaml",
                                         "there is no visible cylinder named 'liquid'");
}

theory_shells setup_shells(const setup *at)
{
    const theory_shells c = {.n_around = at->n[SETUP_OUTSIDE],
                             .n_wall = at->n[SETUP_VESSEL],
                             .n_core = at->n[SETUP_LIQUID],
                             .outer = at->outer,
                             .inner = at->inner};
    return c;
}

void arrange_bare(scene *s)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        material *m = &s->solids[i].surface;
        if (material_is_opaque(m))
            continue;
        m->color = vec3_make(1.0, 1.0, 1.0);
        m->reflectivity -= material_reflectivity(m, &s->render);
        m->film_thickness_nm = 0.0;
        m->sheet = SHEET_NONE;
    }
}

scene *arrange_empty(const scene *s)
{
    scene *copy = scene_clone(s);
    if (!copy)
        return NULL;
    arrange_bare(copy);
    for (size_t i = 0; i < copy->solid_count; i++)
        copy->solids[i].visible = 0;
    for (size_t i = 0; i < copy->light_count; i++)
        copy->lights[i].intensity = 0.0;
    render_settings *r = &copy->render;
    use_whitted(r);
    r->lighting = LIGHTING_WHITTED;
    r->polarisation = 0;
    r->samples = 1;
    r->min_weight = 0.0;
    r->depth = 16;
    copy->camera.roll_deg = 0.0;                      /* vertical edges are searched along the lines of the image */
    copy->camera.projection = PROJECTION_PERSPECTIVE; /* view_of describes a pinhole */
    copy->camera.aperture = 0.0;
    copy->background.absorb_per_m = vec3_make(0.0, 0.0, 0.0); /* the closed forms do not cover the path to the vessel */
    return copy;
}

scene *arrange_vessel(const scene *s, const setup *at)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    copy->solids[at->vessel].visible = 1;
    if (at->liquid >= 0)
        copy->solids[at->liquid].visible = 1;
    return copy;
}

solid_shape ground_at(double y)
{
    return (solid_shape){.kind = SHAPE_PLANE, .position = {0.0, y, 0.0}};
}

solid_shape box_at(vec3 position, vec3 size)
{
    return (solid_shape){.kind = SHAPE_BOX, .position = position, .size = size};
}

solid_shape ball_at(vec3 position, double radius)
{
    return (solid_shape){.kind = SHAPE_SPHERE, .position = position, .radius = radius};
}

solid_shape cylinder_at(vec3 position, double radius, double height)
{
    return (solid_shape){.kind = SHAPE_CYLINDER, .position = position, .radius = radius, .height = height, .m = 1.0};
}

static void place_ground(scene *s, int which, double top, int priority)
{
    if (which < 0)
        return;
    solid *one = &s->solids[which];
    one->shape = ground_at(top);
    one->priority = priority;
    one->visible = 1;
}

scene *arrange_interface(const scene *s, const setup *at, setup_medium from, setup_medium to, double *start_y)
{
    const int solids[SETUP_MEDIA] = {-1, at->vessel, at->liquid};
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    const bool below = from != SETUP_OUTSIDE;
    place_ground(copy, solids[below ? from : to], 0.0, 2);
    if (below)
        place_ground(copy, solids[to], 10.0, 1);
    *start_y = below ? -1.0 : 1.0;
    return copy;
}

scene *arrange_shining(const scene *s, const setup *at, solid_shape slab, double y)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    solid *clear = &copy->solids[at->vessel], *shining = &copy->solids[at->rod];
    clear->visible = shining->visible = 1;
    clear->shape = slab;
    clear->surface.absorb_per_m = vec3_make(0.0, 0.0, 0.0);
    clear->surface.absorb_spectrum.count = 0;
    shining->shape = ground_at(y);
    shining->surface = (material){.color = {1.0, 1.0, 1.0}, .ambient = 1.0, .ior = 1.0};
    copy->background.ambient = vec3_make(1.0, 1.0, 1.0);
    copy->background.kind = BACKGROUND_UNIFORM;
    copy->background.color = vec3_make(0.0, 0.0, 0.0);
    copy->render.beyond = DEPTH_LIMIT_BLACK;
    return copy;
}

/* --- the camera --- */

view view_of(const scene *s)
{
    const struct camera *c = scene_camera(s);
    const double degree = M_PI / 180.0;
    view v = {.x = c->position.x,
              .y = c->position.y,
              .z = c->position.z,
              .yaw = c->yaw_deg * degree,
              .pitch = c->pitch_deg * degree,
              .roll = c->roll_deg * degree,
              .width = (double)scene_settings(s)->width,
              .height = (double)scene_settings(s)->height};
    if (c->aimed) {
        const double dx = c->target.x - v.x, dy = c->target.y - v.y, dz = c->target.z - v.z;
        v.yaw = atan2(dx, dz);
        v.pitch = atan2(dy, hypot(dx, dz));
    }
    v.focal_px = v.height / 2.0 / tan(c->fov_deg / 2.0 * degree);
    return v;
}

/* Camera coordinates (right, up, ahead): roll rotates right and up, then pitch up and ahead, then yaw right and
 * ahead. */
sight view_through(const view *v, double px, double py)
{
    const double across = (px - v->width / 2.0) / v->focal_px, upwards = (v->height / 2.0 - py) / v->focal_px;
    const double right = across * cos(v->roll) + upwards * sin(v->roll);
    const double up = upwards * cos(v->roll) - across * sin(v->roll);
    const double length = sqrt(right * right + up * up + 1.0);
    const double level = cos(v->pitch) - up * sin(v->pitch);
    sight s = {.x = (right * cos(v->yaw) + level * sin(v->yaw)) / length,
               .y = (sin(v->pitch) + up * cos(v->pitch)) / length,
               .z = (level * cos(v->yaw) - right * sin(v->yaw)) / length};
    return s;
}

bool view_place(const view *v, double x, double y, double z, double *px, double *py)
{
    const double dx = x - v->x, dy = y - v->y, dz = z - v->z;
    const double right = dx * cos(v->yaw) - dz * sin(v->yaw), level = dx * sin(v->yaw) + dz * cos(v->yaw);
    const double ahead = level * cos(v->pitch) + dy * sin(v->pitch), up = dy * cos(v->pitch) - level * sin(v->pitch);
    if (!(ahead > 0.0))
        return false;
    const double across = right * cos(v->roll) - up * sin(v->roll), upwards = right * sin(v->roll) + up * cos(v->roll);
    *px = v->width / 2.0 + v->focal_px * across / ahead;
    *py = v->height / 2.0 - v->focal_px * upwards / ahead;
    return true;
}
