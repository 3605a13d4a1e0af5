/* Adds the solids of a lens system to a scene (lens_prescription.h). */
#include "base/number.h"
#include "base/text.h"
#include "scene/lens/lens_prescription.h"
#include "scene/lens/lens_reader.h"
#include "scene/model/edit/edit.h"
#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GAP_SAMPLES = 257 };

static void name_element(const lens_builder *b, lens_element *e)
{
    if (b->count == 1)
        snprintf(e->name, sizeof e->name, "%.*s", text_cut(b->at->name, 60), b->at->name);
    else
        lens_part_name(b, e->name, "%zu", b->count);
}

/* --- elements --- */

/* The least distance between two surfaces within a radius; NaN if one of them ends. */
static double least_gap(const lens_builder *b, size_t front, size_t back, double rim)
{
    double least = INFINITY;
    for (int i = 0; i < GAP_SAMPLES; i++) {
        const double rho = rim * i / (GAP_SAMPLES - 1);
        for (double deg = 0.0; deg <= 90.0; deg += 7.5) {
            const double gap = lens_side_height_at(b, back, rho, deg) - lens_side_height_at(b, front, rho, deg);
            if (!(gap >= least))
                least = gap;
        }
    }
    return least;
}

static void put_side(lens_builder *b, const char *name, int side, const lens_surface *of)
{
    char row[32];
    const double scale = b->at->scale;
    snprintf(row, sizeof row, "radius_%d", side);
    lens_put_number(&b->t, name, row, of->radius * scale);
    snprintf(row, sizeof row, "conic_%d", side);
    lens_put_number(&b->t, name, row, of->conic);
    double power = scale * scale * scale;
    for (int i = 0; i < LENS_EVEN_TERMS; i++, power *= scale * scale) {
        if (of->even[i] == 0.0)
            continue;
        snprintf(row, sizeof row, "a%d_%d", 4 + 2 * i, side);
        lens_put_number(&b->t, name, row, of->even[i] / power);
    }
    for (int i = 0; i < LENS_ODD_TERMS; i++) {
        if (of->odd[i] == 0.0)
            continue;
        const int n = asphere_odd_power(i);
        snprintf(row, sizeof row, "a%d_%d", n, side);
        lens_put_number(&b->t, name, row, of->odd[i] / pow(scale, n - 1));
    }
    if (of->form == SIDE_ROUND)
        return;
    snprintf(row, sizeof row, "form_%d", side);
    lens_put(&b->t, name, row, "%s", of->form == SIDE_TORIC ? "toric" : "biconic");
    snprintf(row, sizeof row, "radius_%d_x", side);
    lens_put_number(&b->t, name, row, of->radius_x * scale);
    snprintf(row, sizeof row, "conic_%d_x", side);
    if (of->form == SIDE_BICONIC)
        lens_put_number(&b->t, name, row, of->conic_x);
}

static status element_check(lens_builder *b, const lens_element *e)
{
    diagnostic bad = {.what = ""};
    const int index = scene_find_solid(b->t.s, e->name);
    const status code = check_object(b->t.s, PARAM_SOLID, (size_t)index, &bad);
    if (code == STATUS_OK)
        return code;
    return diagnose(b->t.why, code, bad.remedy, "%.60s, between surfaces %zu and %zu: %.300s", e->name,
                    (e->front < e->back ? e->front : e->back) + 1, (e->front < e->back ? e->back : e->front) + 1,
                    bad.what);
}

static void put_element(lens_builder *b, const lens_element *e)
{
    const double scale = b->at->scale;
    lens_put_at(b, e->name, &e->leg, e->y_1 - e->before);
    lens_put_number(&b->t, e->name, "thickness", (e->length + e->before + e->after) * scale);
    lens_put_number(&b->t, e->name, "diameter", e->diameter * scale);
    for (int k = 0; k < 2; k++) { /* a side that is smaller than the rim; one that is not round goes on up to it */
        const lens_surface *of = &b->p->surface[k == 0 ? e->front : e->back];
        const double own = of->form == SIDE_ROUND ? of->diameter : 0.0;
        lens_put_number(&b->t, e->name, k == 0 ? "chamfer_1" : "chamfer_2", of->chamfer * scale);
        lens_put_number(&b->t, e->name, k == 0 ? "diameter_1" : "diameter_2",
                        own > 0.0 && own < e->diameter ? own * scale : 0.0);
    }
}

/* The rim has the larger diameter of both sides, or the smaller one where the sides would cross. */
static void choose_rim(lens_builder *b, lens_element *e)
{
    const double d_1 = b->p->surface[e->front].diameter, d_2 = b->p->surface[e->back].diameter;
    e->diameter = fmax(d_1, d_2);
    put_element(b, e);
    if (b->t.code == STATUS_OK && d_1 != d_2 && fmin(d_1, d_2) > 0.0 &&
        check_object(b->t.s, PARAM_SOLID, (size_t)scene_find_solid(b->t.s, e->name), NULL) != STATUS_OK) {
        e->diameter = fmin(d_1, d_2);
        put_element(b, e);
    }
    THEN(b->t.code, element_check(b, e));
}

static void add_element(lens_builder *b, size_t i)
{
    const lens_prescription *p = b->p;
    const bool forwards = b->y[i + 1] > b->y[i];
    lens_element *e = &b->element[b->count++];
    *e = (lens_element){.front = forwards ? i : i + 1, .back = forwards ? i + 1 : i, .medium = &p->surface[i].medium};
    e->y_1 = b->y[e->front], e->y_2 = b->y[e->back], e->length = fabs(p->surface[i].thickness);
    e->leg = b->leg[i + 1];
    name_element(b, e);
    if (b->y[i + 1] == b->y[i] && b->t.code == STATUS_OK)
        b->t.code = diagnose(b->t.why, STATUS_BAD_INPUT, "give a thickness other than 0",
                             "the element after surface %zu has no thickness", i + 1);
    if (!(fmax(p->surface[i].diameter, p->surface[i + 1].diameter) > 0.0) && b->t.code == STATUS_OK)
        b->t.code = diagnose(b->t.why, STATUS_BAD_INPUT, "give diameters, or the aperture and the fields",
                             "the diameter of surface %zu is not known", i + 1);
    object_name glass;
    if (b->t.code != STATUS_OK)
        return;
    lens_medium_material(b, e->medium, glass);
    lens_add_solid(&b->t, "lens", e->name);
    lens_put(&b->t, e->name, "material", "%s", glass);
    put_side(b, e->name, 1, &p->surface[e->front]);
    put_side(b, e->name, 2, &p->surface[e->back]);
    lens_put(&b->t, e->name, "material_rim", "%s", lens_black(b));
    lens_coat(b, e);
    choose_rim(b, e);
}

/* Two neighbours with a common surface: the narrower one reaches into the other by half of the other's least thickness
 * there, and has the lower priority. */
static void cement(lens_builder *b, lens_element *one, lens_element *next)
{
    lens_element *low = one->y_1 < next->y_1 ? one : next, *high = low == one ? next : one;
    const bool low_is_wide = low->diameter > high->diameter || (low->diameter == high->diameter && low == one);
    lens_element *wide = low_is_wide ? low : high, *narrow = low_is_wide ? high : low;
    narrow->diameter = fmin(narrow->diameter, wide->diameter * (1.0 - LENS_RIM_GAP));
    const double gap = least_gap(b, wide->front, wide->back, 0.5 * narrow->diameter);
    if (!(gap > 0.0) && b->t.code == STATUS_OK)
        b->t.code = diagnose(b->t.why, STATUS_BAD_INPUT, "use smaller diameters",
                             "%.60s has no thickness at its rim, where it is cemented", wide->name);
    *(low_is_wide ? &narrow->before : &narrow->after) = 0.5 * gap;
}

static bool are_cemented(const lens_element *a, const lens_element *b)
{
    return a->medium && b->medium && (a->back == b->front || a->front == b->back);
}

/* A leg turned about its point at height y, by a rotation in a frame of X, Y, Z: +x, -z and +y of the solids. */
static lens_leg turned(const lens_leg *leg, double y, mat3 by)
{
    const vec3 *r = by.row;
    const mat3 own = {
        {vec3_make(r[0].x, r[0].z, -r[0].y), vec3_make(r[2].x, r[2].z, -r[2].y), vec3_make(-r[1].x, -r[1].z, r[1].y)}};
    const vec3 up = vec3_make(0.0, y, 0.0);
    lens_leg out = {.turn = mat3_product(leg->turn, own)};
    out.at = vec3_sub(vec3_add(leg->at, mat3_apply(leg->turn, up)), mat3_apply(out.turn, up));
    return out;
}

static bool is_same(double a, double b)
{
    return fabs(a - b) <= 1e-9 * (1.0 + fabs(a));
}

static bool same_place(const lens_builder *b, size_t i, size_t k)
{
    const lens_surface *s = &b->p->surface[i], *t = &b->p->surface[k];
    bool same = is_same(b->y[i], b->y[k]) && is_same(s->radius, t->radius) && is_same(s->conic, t->conic);
    for (int n = 0; n < LENS_EVEN_TERMS; n++)
        same &= s->even[n] == t->even[n];
    return same;
}

/* Whether the light passes an element again between surfaces i and i + 1, after a mirror. */
static bool is_again(lens_builder *b, size_t i)
{
    const bool forwards = b->y[i + 1] > b->y[i];
    const size_t front = forwards ? i : i + 1, back = forwards ? i + 1 : i;
    for (size_t k = 0; k < b->count; k++) {
        const lens_element *e = &b->element[k];
        if (e->medium && same_place(b, e->front, front) && same_place(b, e->back, back))
            return true;
        if (e->medium && b->t.code == STATUS_OK && b->p->surface[i].mirror && (e->front == i || e->back == i))
            b->t.code =
                diagnose(b->t.why, STATUS_BAD_INPUT,
                         "after the mirror, give the surfaces before it again, with thicknesses below 0",
                         "surface %zu is not that by which the light entered the glass of mirror %zu", i + 2, i + 1);
    }
    return false;
}

/* A mirror's body has the reflecting surface, behind which its glass ends, half as deep as the body is thick. */
static void silver(lens_element *glass, lens_element *mirror)
{
    if (!glass->medium || mirror->medium || (glass->front != mirror->front && glass->back != mirror->back))
        return;
    mirror->diameter = fmax(mirror->diameter, glass->diameter);
    glass->diameter = fmin(glass->diameter, mirror->diameter * (1.0 - LENS_RIM_GAP));
    *(glass->back == mirror->back ? &glass->after : &glass->before) = 0.5 * mirror->length;
    mirror->rank = glass->rank + 1;
}

static void cement_all(lens_builder *b)
{
    for (size_t i = 0; i + 1 < b->count && b->t.code == STATUS_OK; i++)
        if (are_cemented(&b->element[i], &b->element[i + 1]))
            cement(b, &b->element[i], &b->element[i + 1]);
    for (size_t round = 0; round < b->count; round++)
        for (size_t i = 0; i + 1 < b->count; i++) {
            lens_element *one = &b->element[i], *next = &b->element[i + 1];
            if (!are_cemented(one, next))
                continue;
            lens_element *wide = one->diameter > next->diameter ? one : next, *narrow = wide == one ? next : one;
            if (wide->rank <= narrow->rank)
                wide->rank = narrow->rank + 1;
        }
    for (size_t i = 0; i < b->count; i++)
        for (size_t k = 0; k < b->count; k++)
            silver(&b->element[i], &b->element[k]);
    for (size_t i = 0; i < b->count; i++) {
        put_element(b, &b->element[i]);
        lens_put(&b->t, b->element[i].name, "priority", "%lld", (long long)(b->at->priority + 2 + b->element[i].rank));
        if (b->t.code == STATUS_OK)
            b->t.code = element_check(b, &b->element[i]);
    }
}

/* --- mirrors --- */

/* A body behind the reflecting surface, with a flat back, an eighth of its diameter thick where it is thinnest. */
static void add_mirror(lens_builder *b, size_t i, double direction)
{
    const lens_surface *s = &b->p->surface[i];
    lens_element *e = &b->element[b->count++];
    *e = (lens_element){.front = i,
                        .back = i,
                        .diameter = s->diameter,
                        .direction = direction,
                        .leg = turned(&b->leg[i], b->y[i], lens_tilt(s))};
    name_element(b, e);
    const double sag = lens_surface_sag(s, 0.5 * s->diameter), sag_x = lens_surface_height(s, 0.5 * s->diameter, 0.0),
                 thickness = 0.125 * s->diameter + fmax(0.0, fmax(sag * direction, sag_x * direction));
    if ((!(s->diameter > 0.0) || isnan(sag)) && b->t.code == STATUS_OK)
        b->t.code = diagnose(b->t.why, STATUS_BAD_INPUT, "give a diameter within the surface",
                             "the mirror, surface %zu, has no diameter, or a larger one than its surface", i + 1);
    if (b->t.code != STATUS_OK)
        return;
    const bool ahead = direction > 0.0;
    e->y_1 = ahead ? b->y[i] : b->y[i] - thickness;
    e->y_2 = e->y_1 + thickness, e->length = thickness;
    const char *paint = lens_mirror_material(b);
    lens_add_solid(&b->t, "lens", e->name);
    lens_put(&b->t, e->name, "material", "%s", paint);
    put_side(b, e->name, ahead ? 1 : 2, s);
    lens_put_number(&b->t, e->name, ahead ? "radius_2" : "radius_1", 0.0);
    put_element(b, e);
    if (s->hole > 0.0)
        lens_add_hole(b, e, s->hole);
}

/* --- the system --- */

static void build(lens_builder *b)
{
    const lens_prescription *p = b->p;
    double direction = 1.0;
    b->leg[0].turn = rotation_from_deg(vec3_make(0.0, 0.0, 0.0));
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        b->y[i + 1] = b->y[i] + s->thickness;
        b->leg[i + 1] = lens_folds(s) ? turned(&b->leg[i], b->y[i], lens_fold(s)) : b->leg[i];
    }
    for (size_t i = 0; i < p->count && b->t.code == STATUS_OK; i++) {
        if (p->surface[i].mirror) {
            add_mirror(b, i, direction);
            direction = -direction;
        }
        if (!lens_is_air(&p->surface[i].medium) && i + 1 < p->count && !is_again(b, i) && b->t.code == STATUS_OK)
            add_element(b, i);
    }
    cement_all(b);
    double widest = 0.0;
    for (size_t i = 0; i < b->count; i++)
        widest = fmax(widest, 0.5 * b->element[i].diameter);
    const double outer = LENS_TUBE_CLEARANCE * widest;
    lens_add_stop(b, outer);
    if (b->at->mount)
        lens_add_mounts(b, outer);
    if (b->at->screen)
        lens_add_screen(b);
}

/* With an image within a medium, as in an eye: the medium ends at a flat surface within the screen, or at the image. */
static status close_image(const lens_prescription *p, bool screen, lens_prescription *out)
{
    const lens_surface *last = &p->surface[p->count - 1];
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    const double half = lens_image_height(p, &f), beyond = screen ? 0.02 * half : 0.0;
    *out = *p;
    out->surface = malloc((p->count + 1) * sizeof *p->surface);
    if (!out->surface)
        return STATUS_FAILURE;
    memcpy(out->surface, p->surface, p->count * sizeof *p->surface);
    out->surface[p->count - 1].thickness += f.direction * beyond;
    out->surface[out->count++] = (lens_surface){.thickness = -f.direction * beyond,
                                                .diameter = fmax(last->diameter, 2.0 * half),
                                                .medium = {.kind = LENS_AIR, .glass_file = -1}};
    return STATUS_OK;
}

status lens_add_to_scene(scene *s, const lens_prescription *p, const lens_placement *at, diagnostic *why)
{
    if (p->count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "give surfaces", "%.60s has no surfaces", at->name);
    lens_builder *b = calloc(1, sizeof *b);
    lens_prescription closed = {.surface = NULL};
    const bool within = !lens_is_air(&p->surface[p->count - 1].medium) && !p->surface[p->count - 1].mirror;
    if (!b || (within && close_image(p, at->screen, &closed) != STATUS_OK)) {
        free(b);
        return out_of_memory(why);
    }
    *b = (lens_builder){
        .t = {s, STATUS_OK, why}, .p = within ? &closed : p, .at = at, .turn = rotation_from_deg(at->rotation_deg)};
    build(b);
    const status code = b->t.code;
    free(closed.surface);
    free(b);
    return code;
}
