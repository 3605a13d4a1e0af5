/* A complete scene about a lens system: camera, object, light and beams; and the fields of its beams, read back
 * (lens_prescription.h). */
#include "base/number.h"
#include "scene/lens/lens_prescription.h"
#include "scene/lens/lens_reader.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SYSTEM "objective"

/* --- the scene --- */

static double rounded(double x, int digits)
{
    char text[NUMBER_TEXT_MAX];
    double value = x;
    number_parse_real(number_format_digits(x, digits, text), &value);
    return value;
}

/* What the setup is built from; light travels along +z. */
typedef struct setup {
    lens_target t;
    const lens_prescription *p;
    lens_first_order f;
    double length;          /* from the first vertex to the image */
    vec3 at, axis;          /* the image on the axis, and its direction there, which mirrors fold */
    double distance;        /* of the object that the camera sees */
    double object_distance; /* of the prescription */
    double object;          /* half height of the object */
    double image;           /* half height of the image */
    double cone;            /* radius of the camera's aperture */
    double leader;          /* height of the first element */
} setup;

static void set_render(setup *u)
{
    lens_target *t = &u->t;
    size_t catalogue = 0;
    for (size_t i = 0; i < u->p->count; i++)
        catalogue += u->p->surface[i].medium.kind == LENS_CATALOGUE || u->p->surface[i].medium.kind == LENS_DATA;
    lens_put(t, "render", "width", "360");
    lens_put(t, "render", "height", "240");
    lens_put(t, "render", "samples", "36");
    lens_put(t, "render", "depth", "%d", (int)fmin(64.0, 8.0 + 2.0 * (double)u->p->count));
    /* without ghosts, whose rays would outnumber the others; weights are those of a pixel's 36 rays */
    lens_put(t, "render", "min_weight", "0.0027");
    lens_put_number(t, "render", "unit_m", 0.001 * u->p->unit_mm);
    lens_put_number(t, "render", "lambda_nm", u->p->wavelength[u->p->primary].nm);
    lens_put(t, "background", "color", "0.02,0.03,0.05");
    if (catalogue > 0) /* their indices are relative to air */
        lens_put(t, "background", "medium", "air");
}

/* Behind the image, in focus on it, with an aperture through which the rays of each of its points go on to all of the
 * exit pupil. The image is upside down, and so is the camera. */
static void set_camera(setup *u)
{
    lens_target *t = &u->t;
    const lens_prescription *p = u->p;
    double vertex = 0.0;
    for (size_t i = 0; i + 1 < p->count; i++)
        vertex += p->surface[i].thickness;
    const double pupil = fabs(u->length - vertex - u->f.exit_pupil), /* from the exit pupil to the image */
        behind = 4.0 * fmin(pupil, 20.0 * fabs(u->f.efl)), side = u->f.direction,
                 radius = 0.5 * u->f.pupil_diameter * pupil / fmax(fabs(u->f.efl), 1e-9),
                 cone = radius / pupil * behind + u->image * (1.0 + behind / pupil);
    u->cone = cone;
    const vec3 eye = vec3_add(u->at, vec3_scale(u->axis, side * behind));
    lens_put(t, "camera", "position", "%.12g,%.12g,%.12g", eye.x + 0.0, eye.y + 0.0, eye.z);
    lens_put(t, "camera", "target", "%.12g,%.12g,%.12g", u->at.x + 0.0, u->at.y + 0.0, u->at.z);
    lens_put(t, "camera", "roll_deg", "180");
    lens_put_number(t, "camera", "focus", rounded(behind, 12));
    lens_put_number(t, "camera", "fov_deg", rounded(2.0 * 57.295779513 * atan(0.55 * u->image / behind), 4));
    lens_put_number(t, "camera", "aperture", rounded(2.0 * cone, 4));
    /* the fraction of the camera's rays that reach the pupil */
    lens_put_number(t, "camera", "exposure", rounded(2.0 * log2(cone * pupil / (radius * behind)), 3));
}

/* A chequered wall at the distance of the object, and small lamps before and behind it. */
static void add_object(setup *u)
{
    lens_target *t = &u->t;
    const double d = u->distance, wide = u->object;
    THEN(t->code, scene_add(t->s, PARAM_MATERIAL, "wall-paint", NULL, t->why));
    lens_put(t, "wall-paint", "color", "0.75,0.72,0.65");
    lens_put(t, "wall-paint", "ambient", "0.6");
    lens_put(t, "wall-paint", "diffuse", "0.8");
    lens_put_number(t, "wall-paint", "checker", rounded(wide / 4.0, 3));
    lens_put(t, "wall-paint", "checker_color", "0.1,0.2,0.4");
    lens_add_solid(t, "box", "wall");
    lens_put(t, "wall", "material", "wall-paint");
    lens_put(t, "wall", "position", "0,0,%.6g", -d * 1.005);
    lens_put(t, "wall", "size", "%.6g,%.6g,%.6g", 4.0 * wide, 2.2 * wide, 0.01 * d);
    THEN(t->code, scene_add(t->s, PARAM_LIGHT, "sun", NULL, t->why)); /* from the side, past the lens */
    lens_put(t, "sun", "kind", "sun");
    lens_put(t, "sun", "position", "2,3,1");
    lens_put(t, "sun", "target", "0,0,0");
    THEN(t->code, scene_add(t->s, PARAM_MATERIAL, "lamp-glow", NULL, t->why));
    lens_put(t, "lamp-glow", "emission", "8");
    for (int i = 0; i < 5; i++) {
        char name[16];
        snprintf(name, sizeof name, "lamp-%d", i + 1);
        const double at = 0.25 * d, across = 0.32 * wide * at / d * (i - 2);
        lens_add_solid(t, "sphere", name);
        lens_put(t, name, "material", "lamp-glow");
        lens_put(t, name, "visible", "off"); /* before the object, where they would hide a part of it */
        lens_put(t, name, "position", "%.6g,%.6g,%.6g", across, 0.25 * across, -at);
        lens_put_number(t, name, "radius", rounded(0.015 * wide * at / d, 3));
    }
}

/* A board around the tube, so that the camera sees nothing past the lens. */
static void add_board(setup *u)
{
    lens_target *t = &u->t;
    const int tube = scene_find_solid(t->s, "objective-tube");
    if (tube < 0)
        return;
    const solid_shape of = t->s->solids[tube].shape;
    lens_add_solid(t, "cup", "board");
    lens_put(t, "board", "material", "blackened");
    lens_put(t, "board", "position", "0,0,%.9g", of.position.z + 0.45 * of.height);
    lens_put(t, "board", "rotation", "90,0,0");
    lens_put_number(t, "board", "floor", 0.0);
    lens_put_number(t, "board", "height", rounded(0.1 * of.height, 4));
    lens_put_number(t, "board", "inner_radius", rounded(0.5 * (of.radius + of.inner_radius), 6));
    lens_put_number(t, "board", "radius", rounded(4.0 * (u->cone + u->image + of.radius), 4));
    lens_put(t, "board", "priority", "-1");
}

/* Parallel light from a far object, a pencil from the point of a near one; both fill the entrance pupil. */
static void add_field_beam(setup *u, const char *name, size_t i, const lens_wavelength *w)
{
    lens_target *t = &u->t;
    const lens_prescription *p = u->p;
    const bool far = isinf(u->object_distance);
    const double rad = 0.017453292519943295769, pupil = u->f.pupil,
                 start = far ? -fmax(0.5 * fabs(u->f.efl), pupil < 0.0 ? -1.2 * pupil : 0.0) : -u->object_distance;
    const bool angles = p->field_kind == LENS_FIELD_ANGLE;
    const double reach = p->object_distance + pupil,
                 slope_x = angles ? tan(p->field[i].x * rad) : -p->field[i].x / reach,
                 slope_y = angles ? tan(p->field[i].y * rad) : -p->field[i].y / reach;
    /* towards the centre of the entrance pupil, in the frame of the first element: +y along the light, fields of +y
     * towards -z */
    lens_put(t, name, "kind", far ? "bundle" : "pencil");
    lens_put(t, name, "follows", "%s", SYSTEM);
    lens_put(t, name, "direction", "%.17g,1,%.17g", slope_x + 0.0, 0.0 - slope_y);
    lens_put(t, name, "position", "%.17g,%.17g,%.17g", slope_x * (start - pupil) + 0.0, start - u->leader,
             0.0 - slope_y * (start - pupil));
    if (far)
        lens_put_number(t, name, "width", u->f.pupil_diameter);
    else
        lens_put_number(
            t, name, "angle_deg",
            2.0 / rad * atan2(0.5 * u->f.pupil_diameter, reach * sqrt(1.0 + slope_x * slope_x + slope_y * slope_y)));
    lens_put(t, name, "rays", "61");
    lens_put(t, name, "branches", "off");
    lens_put(t, name, "depth", "64");
    lens_put_number(t, name, "lambda_nm", w->nm);
    lens_put_number(t, name, "power", w->weight);
    lens_put(t, name, "visible", "off");
}

/* Of the primary wavelength, then of the others by their place in the list: lens_read_beams. */
static void add_beams(setup *u)
{
    char name[48];
    const lens_prescription *p = u->p;
    const int leader = scene_find_solid(u->t.s, SYSTEM);
    u->leader = leader >= 0 ? u->t.s->solids[leader].shape.position.z : 0.0;
    for (size_t i = 0; i < p->field_count; i++)
        for (size_t k = 0; k <= p->wavelength_count; k++) {
            const size_t w = k ? k - 1 : p->primary;
            if (k && w == p->primary)
                continue;
            const int used = snprintf(name, sizeof name, SYSTEM "-field-%zu", i + 1);
            if (k)
                snprintf(name + used, sizeof name - (size_t)used, "-line-%zu", k);
            THEN(u->t.code, scene_add(u->t.s, PARAM_BEAM, name, NULL, u->t.why));
            add_field_beam(u, name, i, &p->wavelength[w]);
        }
}

static setup measured(scene *s, const lens_prescription *p, lens_prescription *focused, diagnostic *why)
{
    setup u = {.t = {s, STATUS_OK, why}, .p = focused};
    const lens_first_order far = lens_first_order_of(p, p->wavelength[p->primary].nm);
    *focused = *p;
    u.object_distance = p->object_distance;
    if (!isfinite(focused->object_distance))
        focused->object_distance = rounded(fmin(1e5, 50.0 * fabs(far.efl)), 3);
    u.distance = focused->object_distance;
    u.f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    const double slope = u.f.field_slope != 0.0 ? fmin(fabs(u.f.field_slope), 2.0) : 0.2;
    u.object = slope * (u.distance + u.f.pupil);
    const lens_first_order near = lens_first_order_of(focused, p->wavelength[p->primary].nm);
    u.image = fabs(near.magnification) * u.object;
    mat3 frame = rotation_from_deg(vec3_make(0.0, 0.0, 0.0)); /* X, Y, Z of the prescription are those of the scene */
    for (size_t i = 0; i < p->count; i++) {
        const double length = i + 1 < p->count ? p->surface[i].thickness : near.image;
        if (lens_folds(&p->surface[i]))
            frame = mat3_product(frame, lens_fold(&p->surface[i]));
        u.axis = mat3_apply(frame, vec3_make(0.0, 0.0, 1.0));
        u.at = vec3_add(u.at, vec3_scale(u.axis, length));
        u.length += length;
    }
    return u;
}

status lens_scene_create(const lens_prescription *p, const lens_glasses *glasses, scene **out, diagnostic *why)
{
    lens_prescription focused;
    *out = scene_create();
    if (!*out)
        return out_of_memory(why);
    setup u = measured(*out, p, &focused, why);
    if (!isfinite(u.length) || !(u.image > 0.0) || !(u.f.pupil_diameter > 0.0))
        u.t.code = diagnose(why, STATUS_BAD_INPUT,
                            "give the aperture (pupil, f_number or the diameter of the stop) of a system with an image",
                            "the system has no image, or no aperture");
    THEN(u.t.code, scene_set_title(*out, p->title[0] ? p->title : "A lens", why));
    const lens_placement at = {.name = SYSTEM,
                               .rotation_deg = {90.0, 0.0, 0.0},
                               .scale = 1.0,
                               .mount = true,
                               .screen = true,
                               .glasses = glasses};
    set_render(&u);
    set_camera(&u);
    add_object(&u);
    THEN(u.t.code, lens_add_to_scene(*out, p, &at, why));
    add_beams(&u);
    add_board(&u);
    lens_put(&u.t, SYSTEM "-screen", "visible", "off"); /* the camera is behind it */
    if (u.t.code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return u.t.code;
}

/* --- fields and wavelengths of a system's beams --- */

static void add_field(lens_prescription *p, double x, double y)
{
    for (size_t i = 0; i < p->field_count; i++)
        if (p->field[i].x == x && p->field[i].y == y)
            return;
    if (p->field_count < LENS_LIST_MAX)
        p->field[p->field_count++] = (lens_field){x, y, 1.0};
}

typedef struct ranked_wave {
    lens_wavelength of;
    long rank; /* place in the list, from 1; 0: by the order of the beams */
} ranked_wave;

static size_t add_wavelength(ranked_wave *list, size_t count, const beam *b)
{
    const char *line = strstr(b->name, "-line-");
    for (size_t i = 0; i < count; i++)
        if (list[i].of.nm == b->lambda_nm)
            return count;
    if (count < LENS_LIST_MAX)
        list[count++] = (ranked_wave){{b->lambda_nm, b->power}, line ? strtol(line + 6, NULL, 10) : 0};
    return count;
}

/* The first beam has the primary wavelength, whose place is that which the others leave. */
static void order_wavelengths(ranked_wave *list, size_t count, lens_prescription *p)
{
    bool used[LENS_LIST_MAX + 2] = {false};
    long free_rank = 1;
    for (size_t i = 1; i < count; i++)
        if (list[i].rank > 0 && list[i].rank <= LENS_LIST_MAX)
            used[list[i].rank] = true;
    while (used[free_rank])
        free_rank++;
    for (size_t i = 0; i < count; i++)
        list[i].rank = i == 0 ? free_rank : list[i].rank > 0 ? list[i].rank : LENS_LIST_MAX + (long)i;
    const double primary = list[0].of.nm;
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k > 0 && list[k].rank < list[k - 1].rank; k--) {
            const ranked_wave moved = list[k];
            list[k] = list[k - 1], list[k - 1] = moved;
        }
    for (size_t i = 0; i < count; i++) {
        p->wavelength[i] = list[i].of;
        if (list[i].of.nm == primary)
            p->primary = i;
    }
    p->wavelength_count = count;
}

/* The point of a near object that a pencil starts at: its height is the field, its distance that of the object. */
static void add_object_point(vec3 local, lens_prescription *p)
{
    if (p->field_count == 0)
        p->object_distance = lens_tidy(-local.y), p->field_kind = LENS_FIELD_OBJECT;
    add_field(p, lens_tidy(local.x) + 0.0, lens_tidy(-local.z) + 0.0);
}

/* The aperture is the diameter of the entrance pupil that the first beam fills, if it is that of the stop's solid. */
static void read_aperture(lens_prescription *p, const beam *b)
{
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    const double away = p->object_distance + f.pupil, tilt = hypot(p->field[0].x, p->field[0].y);
    const double pupil =
        b->kind == BEAM_BUNDLE ? b->width : 2.0 * hypot(away, tilt) * tan(0.5 * 0.017453292519943295769 * b->angle_deg);
    if (p->stop >= 0 && fabs(pupil - f.pupil_diameter) <= 1e-9 * pupil)
        p->aperture_kind = LENS_APERTURE_PUPIL, p->aperture = lens_tidy(pupil);
}

void lens_read_beams(const scene *s, const char *system, const lens_placement *at, lens_prescription *p)
{
    const double deg = 57.295779513082320877;
    const mat3 turn = rotation_from_deg(at->rotation_deg);
    ranked_wave waves[LENS_LIST_MAX];
    size_t count = 0;
    const beam *first = NULL;
    p->field_count = 0;
    for (size_t i = 0; i < s->beam_count; i++) {
        const beam *b = &s->beams[i];
        const vec3 d = mat3_apply_transposed(turn, beam_axis(b));
        if (!lens_belongs(system, b->name) || !strstr(b->name, "-field-") || !(d.y > 0.0) || b->kind == BEAM_FAN)
            continue;
        if (beam_is_parallel(b) && p->field_kind == LENS_FIELD_ANGLE)
            add_field(p, lens_tidy(deg * atan2(d.x, d.y)) + 0.0, lens_tidy(deg * atan2(-d.z, d.y)) + 0.0);
        else if (b->kind == BEAM_PENCIL && (p->field_count == 0 || p->field_kind == LENS_FIELD_OBJECT))
            add_object_point(mat3_apply_transposed(turn, vec3_sub(b->position, at->position)), p);
        count = add_wavelength(waves, count, b);
        first = first ? first : b;
    }
    if (p->field_count == 0)
        add_field(p, 0.0, 0.0);
    if (count == 0)
        waves[count++] = (ranked_wave){{s->render.lambda_nm, 1.0}, 0};
    order_wavelengths(waves, count, p);
    if (first)
        read_aperture(p, first);
}
