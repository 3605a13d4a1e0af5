/* The way of the light along an axis that mirrors fold: coordinate breaks of files, and the solids of scenes
 * (lens_prescription.h).
 *
 * Frames are of columns X, Y, Z with Z along the axis. A fold mirror with the unit normal n turns the axis by
 * Q = S_n S_z, the reflections at its plane and at the plane across Z: the rotation by twice the angle between n and Z,
 * after which the light travels along -Z, as after a mirror that is not tilted. */
#include "base/number.h"
#include "geometry/shapes/shape.h"
#include "scene/lens/lens_reader.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sine of an angle, and distance relative to the way, up to which a surface is on the axis: rounding of files. */
#define ON_AXIS 1e-9

static const vec3 along_z = {0.0, 0.0, 1.0};

lens_pose lens_way_pose(const lens_way *w, vec3 vertex, vec3 normal, double *distance)
{
    const vec3 axis = mat3_apply(w->frame, along_z), way = vec3_sub(vertex, w->at);
    *distance = vec3_dot(way, axis);
    const double aside = vec3_length(vec3_sub(way, vec3_scale(axis, *distance))), cosine = vec3_dot(axis, normal);
    if (aside > ON_AXIS * (1.0 + fabs(*distance)))
        return LENS_ASIDE;
    return vec3_length(vec3_cross(axis, normal)) > ON_AXIS ? LENS_TILTED : cosine > 0.0 ? LENS_AHEAD : LENS_BACK;
}

void lens_way_fold(lens_way *w, vec3 normal, lens_surface *mirror)
{
    vec3 n = mat3_apply_transposed(w->frame, normal);
    n = n.z < 0.0 ? vec3_scale(n, -1.0) : n;
    mirror->tilt_x_deg = settled_deg(atan2(-n.y, n.z) * (180.0 / M_PI));
    mirror->tilt_y_deg = settled_deg(asin(n.x) * (180.0 / M_PI));
    w->frame = mat3_product(w->frame, lens_fold(mirror));
}

/* --- coordinate breaks: decentres, then rotations about the new x, y and z; or all in the other order --- */

static void take_break(lens_way *w, const lens_break *b)
{
    const vec3 aside = vec3_make(b->number[0], b->number[1], 0.0);
    if (b->number[5] == 0.0)
        w->at = vec3_add(w->at, mat3_apply(w->frame, aside));
    for (int k = 0; k < 3; k++) {
        const int axis = b->number[5] == 0.0 ? k : 2 - k;
        const double turn = b->number[2 + axis];
        w->frame = mat3_product(w->frame, rotation_from_deg(vec3_make(axis == 0 ? turn : 0.0, axis == 1 ? turn : 0.0,
                                                                      axis == 2 ? turn : 0.0)));
    }
    if (b->number[5] != 0.0)
        w->at = vec3_add(w->at, mat3_apply(w->frame, aside));
}

typedef struct unfolder {
    lens_reader *r;
    lens_way file, way; /* the frame of the file, and that of the folded axis, at the surface kept last */
    size_t kept;
    int stop;
} unfolder;

/* Keeps surface i at its place on the axis; drops a plane that does nothing and is elsewhere. */
static status unfold(unfolder *u, size_t i, bool is_image)
{
    lens_prescription *p = u->r->p;
    lens_surface s = p->surface[i];
    const vec3 normal = mat3_apply(u->file.frame, along_z);
    double distance;
    const lens_pose pose = lens_way_pose(&u->way, u->file.at, normal, &distance);
    const lens_medium *before = &p->surface[u->kept - 1].medium;
    const bool idle = !s.mirror && !is_image && p->stop != (int)i && lens_media_match(before, &s.medium);
    if (idle && (pose == LENS_TILTED || pose == LENS_ASIDE))
        return STATUS_OK;
    if (pose == LENS_ASIDE || (pose == LENS_TILTED && !(s.mirror && lens_is_flat(&s)))) {
        u->r->line = s.line;
        return lens_wrong(
            u->r, -1, "leave these coordinate breaks out, and move or turn the solids of the scene: offset, rotation",
            "surface %zu is %s, and not a flat mirror on the axis", i, pose == LENS_ASIDE ? "off the axis" : "tilted");
    }
    if (pose == LENS_BACK)
        lens_turn_round(&s);
    if (u->kept > 1 || isfinite(p->surface[0].thickness)) /* an object may be infinitely far */
        p->surface[u->kept - 1].thickness = distance + (u->kept > 1 ? 0.0 : p->surface[0].thickness);
    u->way.at = u->file.at;
    if (pose == LENS_TILTED)
        lens_way_fold(&u->way, normal, &s);
    if (p->stop == (int)i)
        u->stop = (int)u->kept;
    p->surface[u->kept++] = s;
    return STATUS_OK;
}

status lens_take_breaks(lens_reader *r, const lens_break *breaks)
{
    lens_prescription *p = r->p;
    bool any = false;
    for (size_t i = 1; i < p->count; i++)
        any |= breaks[i].given;
    if (!any)
        return STATUS_OK;
    const mat3 straight = rotation_from_deg(vec3_make(0.0, 0.0, 0.0));
    unfolder u = {
        .r = r, .file = {straight, {0.0, 0.0, 0.0}}, .way = {straight, {0.0, 0.0, 0.0}}, .kept = 1, .stop = -1};
    for (size_t i = 1; i < p->count; i++) {
        const double thickness = p->surface[i].thickness;
        if (breaks[i].given && i + 1 < p->count)
            take_break(&u.file, &breaks[i]);
        else
            TRY(unfold(&u, i, i + 1 == p->count));
        u.file.at = vec3_add(u.file.at, mat3_apply(u.file.frame, vec3_make(0.0, 0.0, thickness)));
    }
    p->count = u.kept;
    p->stop = u.stop;
    return STATUS_OK;
}

/* --- the solids of a scene, in the order of the light --- */

double lens_size_of(const solid *of)
{
    return of->shape.scale.x;
}

static double get(const lens_finder *f, const solid *of, const char *row, int side)
{
    char path[2 * SCENE_NAME_MAX], *text = NULL, word[32];
    double value = 0.0;
    snprintf(word, sizeof word, row, side);
    snprintf(path, sizeof path, "%s.%s", of->name, word);
    if (param_find(PARAM_SOLID, word) && scene_get(f->s, path, &text, NULL) == STATUS_OK)
        number_parse_real(text, &value);
    free(text);
    return value;
}

status lens_refuse(const lens_finder *f, const solid *of, const char *remedy, const char *what)
{
    return diagnose(f->why, STATUS_BAD_INPUT, remedy, "%.60s %s", of->name, what);
}

double lens_along(const lens_finder *f, const solid *of)
{
    return vec3_dot(f->axis, vec3_sub(of->shape.position, f->origin));
}

lens_surface lens_side_of(const lens_finder *f, const placed_lens *l, int side)
{
    const solid *of = l->of;
    lens_surface s = {.radius = get(f, of, "radius_%d", side),
                      .conic = get(f, of, "conic_%d", side),
                      .form = (side_form)(side == 1 ? of->shape.form_1 : of->shape.form_2),
                      .radius_x = get(f, of, "radius_%d_x", side),
                      .conic_x = get(f, of, "conic_%d_x", side),
                      .diameter = get(f, of, "diameter_%d", side),
                      .chamfer = get(f, of, "chamfer_%d", side),
                      .medium = {.kind = LENS_AIR, .glass_file = -1}};
    char row[16];
    for (int i = 0; i < LENS_EVEN_TERMS; i++) {
        snprintf(row, sizeof row, "a%d_%%d", 4 + 2 * i);
        s.even[i] = get(f, of, row, side);
    }
    for (int i = 0; i < LENS_ODD_TERMS; i++) {
        snprintf(row, sizeof row, "a%d_%%d", asphere_odd_power(i));
        s.odd[i] = get(f, of, row, side);
    }
    if (s.diameter == 0.0)
        s.diameter = of->shape.diameter;
    return lens_surface_scaled(&s, lens_size_of(of));
}

/* Appends a surface at y; the thickness of the one before it follows. */
static lens_surface *append(lens_finder *f, double y, lens_surface s)
{
    lens_prescription *p = f->p;
    if (p->count > 0)
        p->surface[p->count - 1].thickness = lens_tidy(y - f->y);
    f->way.at = vec3_add(f->way.at, mat3_apply(f->way.frame, vec3_make(0.0, 0.0, p->count > 0 ? y - f->y : 0.0)));
    f->y = y;
    p->surface[p->count] = s;
    return &p->surface[p->count++];
}

static vec3 axis_of(const solid *of)
{
    const mat3 turn = rotation_from_deg(of->shape.rotation_deg);
    return placed_axis(&turn, 1);
}

/* The side of a solid that faces the light, and its vertex. */
static int facing_side(const lens_finder *f, const solid *of, vec3 *vertex)
{
    const vec3 axis = axis_of(of), way = mat3_apply(f->way.frame, vec3_make(0.0, 0.0, f->direction));
    const bool first = vec3_dot(axis, way) > 0.0;
    *vertex = of->shape.position;
    if (!first)
        *vertex = vec3_add(*vertex, vec3_scale(axis, lens_size_of(of) * of->shape.thickness));
    return first ? 1 : 2;
}

/* Whether the second solid, which begins within the first, has the true surface between them. */
static bool second_wins(const placed_lens *first, const placed_lens *second)
{
    return second->of->priority != first->of->priority ? second->of->priority > first->of->priority
                                                       : second->order < first->order;
}

/* Heights on the present part of the axis. */
static status place_lens(const lens_finder *f, placed_lens *l)
{
    double distance;
    if (f->mirrors) {
        if (lens_way_pose(&f->way, l->of->shape.position, axis_of(l->of), &distance) != LENS_AHEAD)
            return lens_refuse(
                f, l->of, "list the solids in the order of the light, each on the axis behind the mirror before it",
                "is not on the axis of the light");
        l->y_1 = f->y + distance, l->y_2 = l->y_1 + lens_size_of(l->of) * l->of->shape.thickness;
    }
    return STATUS_OK;
}

static double height(const lens_finder *f, const placed_lens *l, bool near)
{
    return (f->direction > 0.0) == near ? l->y_1 : l->y_2;
}

static int side_at(const lens_finder *f, bool near)
{
    return (f->direction > 0.0) == near ? 1 : 2;
}

/* A mirror, and the glass before it once more: `within`, or NULL. */
static status read_mirror(lens_finder *f, const placed_lens *l, const placed_lens *within)
{
    vec3 vertex;
    double distance;
    const int side = facing_side(f, l->of, &vertex);
    const vec3 axis = axis_of(l->of);
    const lens_pose pose = lens_way_pose(&f->way, vertex, axis, &distance);
    lens_surface s = lens_side_of(f, l, side);
    const lens_medium air = {.kind = LENS_AIR, .glass_file = -1};
    if (pose == LENS_ASIDE || (pose == LENS_TILTED && (within || !lens_is_flat(&s))))
        return lens_refuse(f, l->of, "place its vertex on the axis; only a flat mirror in air can be tilted",
                           "is a mirror off the axis, or tilted");
    if (pose == LENS_BACK)
        lens_turn_round(&s);
    s.mirror = true, s.hole = l->hole;
    s.medium = within ? f->p->surface[f->p->count - 1].medium : air;
    lens_surface *mirror = append(f, f->y + distance, s);
    if (pose == LENS_TILTED)
        lens_way_fold(&f->way, axis, mirror), f->leg++;
    f->direction = -f->direction;
    if (within) {
        const int back = f->direction > 0.0 ? 2 : 1;
        append(f, back == 1 ? within->y_1 : within->y_2, lens_side_of(f, within, back));
    }
    return STATUS_OK;
}

/* Lenses through which the light has come, and which it meets again before a height. */
static status pass_again(lens_finder *f, double to)
{
    for (;;) {
        const placed_lens *next = NULL;
        for (size_t i = 0; i < f->count; i++) {
            const placed_lens *l = &f->lens[i];
            const double ahead = f->direction * (height(f, l, true) - f->y);
            if (l->leg == f->leg && !l->mirror && ahead > 1e-9 * l->of->shape.thickness &&
                ahead < f->direction * (to - f->y) && (!next || ahead < f->direction * (height(f, next, true) - f->y)))
                next = l;
        }
        if (!next)
            return STATUS_OK;
        lens_medium glass;
        if (next->cemented || f->p->count + 2 > LENS_SURFACES_MAX)
            return lens_refuse(f, next->of, "use the file of the system",
                               "is passed twice, and is cemented, or one lens too many");
        TRY(lens_medium_of(f->s, next->of, &glass, f->why));
        append(f, height(f, next, true), lens_side_of(f, next, side_at(f, true)))->medium = glass;
        append(f, height(f, next, false), lens_side_of(f, next, side_at(f, false)));
    }
}

static bool overlaps(const lens_finder *f, const placed_lens *l, const placed_lens *next)
{
    vec3 vertex;
    double distance = next->y_1 - f->y;
    if (next->mirror) {
        facing_side(f, next->of, &vertex);
        lens_way_pose(&f->way, vertex, axis_of(next->of), &distance);
    }
    return f->direction * (f->y + distance - height(f, l, false)) < 0.0;
}

static status read_screen(lens_finder *f)
{
    vec3 vertex;
    double distance;
    if (!f->screen)
        return STATUS_OK;
    if (!f->mirrors) {
        f->p->surface[f->p->count - 1].thickness = lens_tidy(lens_along(f, f->screen) - f->y);
        return STATUS_OK;
    }
    facing_side(f, f->screen, &vertex);
    if (lens_way_pose(&f->way, vertex, axis_of(f->screen), &distance) == LENS_ASIDE)
        return lens_refuse(f, f->screen, "place it behind the last mirror", "is not on the axis of the light");
    const double y = f->y + distance;
    TRY(pass_again(f, y));
    f->p->surface[f->p->count - 1].thickness = lens_tidy(y - f->y);
    return STATUS_OK;
}

status lens_read_surfaces(lens_finder *f)
{
    const mat3 turn = rotation_from_deg(f->lens[0].of->shape.rotation_deg);
    const mat3 columns = {{vec3_make(1.0, 0.0, 0.0), vec3_make(0.0, 0.0, 1.0), vec3_make(0.0, -1.0, 0.0)}};
    f->way = (lens_way){mat3_product(turn, columns), f->origin};
    f->leg = 1, f->y = 0.0, f->direction = 1.0;
    bool cemented = false;
    for (size_t i = 0; i < f->count; i++) {
        placed_lens *l = &f->lens[i], *next = i + 1 < f->count ? l + 1 : NULL;
        lens_medium glass;
        if (f->p->count + 2 > LENS_SURFACES_MAX)
            return lens_refuse(f, l->of, "give the name of one system", "is one lens too many");
        if (l->mirror) {
            const placed_lens *within = cemented ? l - 1 : NULL;
            TRY(read_mirror(f, l, within));
            cemented = false;
            continue;
        }
        TRY(place_lens(f, l));
        TRY(f->mirrors && !cemented ? pass_again(f, height(f, l, true)) : STATUS_OK);
        TRY(lens_medium_of(f->s, l->of, &glass, f->why));
        if (!cemented)
            append(f, height(f, l, true), lens_side_of(f, l, side_at(f, true)));
        f->p->surface[f->p->count - 1].medium = glass;
        l->leg = f->leg;
        if (next && !next->mirror)
            TRY(place_lens(f, next));
        cemented = next && overlaps(f, l, next);
        l->cemented |= cemented && !next->mirror;
        if (cemented)
            next->cemented = !next->mirror;
        if (cemented && next->mirror)
            continue;
        if (cemented && second_wins(l, next))
            append(f, height(f, next, true), lens_side_of(f, next, side_at(f, true)));
        else
            append(f, height(f, l, false), lens_side_of(f, l, side_at(f, false)));
    }
    return read_screen(f);
}
