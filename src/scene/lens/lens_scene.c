/* Reads a lens system back from the solids of a scene (lens_prescription.h). */
#include "base/number.h"
#include "geometry/shapes/shape.h"
#include "scene/lens/lens_reader.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OFF_AXIS 1e-9 /* of the diameter: rounding of positions */

static bool ends_in(const char *text, const char *ending)
{
    const size_t a = strlen(text), b = strlen(ending);
    return a >= b && strcmp(text + a - b, ending) == 0;
}

static bool is_shape(const solid *of, const char *word)
{
    return strcmp(shape_name(of->shape.kind), word) == 0;
}

static status check_axis(const lens_finder *f, const solid *of)
{
    const mat3 turn = rotation_from_deg(of->shape.rotation_deg);
    const vec3 way = placed_axis(&turn, 1), away = vec3_sub(of->shape.position, f->origin),
               aside = vec3_sub(away, vec3_scale(f->axis, vec3_dot(away, f->axis)));
    if (vec3_dot(way, f->axis) < 1.0 - OFF_AXIS ||
        vec3_length(aside) > OFF_AXIS * (lens_size_of(of) * of->shape.diameter + vec3_length(away)))
        return lens_refuse(f, of, "give the name of one system, or put its solids on one axis, with the same rotation",
                           "is not on the axis of the first lens");
    return STATUS_OK;
}

static int by_place(const void *a, const void *b)
{
    const placed_lens *x = a, *y = b;
    return (x->y_1 > y->y_1) - (x->y_1 < y->y_1);
}

static status add_lens(lens_finder *f, const solid *of, size_t order)
{
    const material *m = &of->surface;
    const bool opaque = material_is_opaque(m),
               mirror = opaque && (m->extinction > 0.0 || material_metal(m) || m->reflectivity > 0.0);
    if (opaque && !mirror)
        return lens_refuse(f, of, "give it a metal as its medium, or name it -screen", "is opaque, and not a mirror");
    f->mirrors |= mirror;
    if (f->count == 0) {
        const mat3 turn = rotation_from_deg(of->shape.rotation_deg);
        f->axis = placed_axis(&turn, 1);
        f->origin = of->shape.position;
    }
    if (f->count >= LENS_SURFACES_MAX / 2)
        return lens_refuse(f, of, "give the name of one system", "is one lens too many");
    const vec3 k = of->shape.scale;
    if (!(k.x > 0.0) || k.x != k.y || k.x != k.z)
        return lens_refuse(f, of, "scale it by 3 equal numbers above 0", "is not scaled evenly, or mirrored");
    const double y = lens_along(f, of);
    f->lens[f->count++] = (placed_lens){
        .of = of, .y_1 = y, .y_2 = y + lens_size_of(of) * of->shape.thickness, .order = order, .mirror = mirror};
    return STATUS_OK;
}

/* NAME-hole-N is the hole of the mirror that is element N. */
static void find_holes(lens_finder *f)
{
    for (size_t i = 0; i < f->s->solid_count; i++) {
        const solid *of = &f->s->solids[i];
        const char *at =
            lens_belongs(f->name, of->name) && is_shape(of, "cylinder") ? strstr(of->name, "-hole-") : NULL;
        const long number = at ? strtol(at + 6, NULL, 10) : 0;
        if (number >= 1 && (size_t)number <= f->count && f->lens[number - 1].mirror)
            f->lens[number - 1].hole = 2.0 * lens_size_of(of) * of->shape.radius;
    }
}

static status find(lens_finder *f)
{
    for (size_t i = 0; i < f->s->solid_count; i++) {
        const solid *of = &f->s->solids[i];
        if (!lens_belongs(f->name, of->name))
            continue;
        if (is_shape(of, "cup") && of->shape.floor == 0.0 &&
            (ends_in(of->name, "-stop") || strcmp(of->name, "stop") == 0) && of->visible)
            f->stop = of;
        else if (ends_in(of->name, "-screen") || strcmp(of->name, "screen") == 0)
            f->screen = of;
        else if (is_shape(of, "lens") && of->visible)
            TRY(add_lens(f, of, i));
    }
    if (f->count == 0)
        return diagnose(f->why, STATUS_BAD_INPUT, "give a scene with solids of shape lens, or a lens file",
                        *f->name ? "no lens has a name that begins with %.60s-" : "the scene has no lens%.0s", f->name);
    if (f->mirrors) { /* light passes its solids in their own order */
        find_holes(f);
        return STATUS_OK;
    }
    for (size_t i = 0; i < f->count; i++)
        TRY(check_axis(f, f->lens[i].of));
    qsort(f->lens, f->count, sizeof *f->lens, by_place);
    return STATUS_OK;
}

/* --- the stop --- */

/* A plane between the surfaces `at` - 1 and `at`, at y; y_before is that of the surface before it, or of the first
 * one. */
static void insert_stop(lens_prescription *p, size_t at, double y, double y_before, double diameter)
{
    lens_surface *s = &p->surface[at];
    memmove(s + 1, s, (p->count++ - at) * sizeof *s);
    *s = (lens_surface){.diameter = diameter, .medium = {.kind = LENS_AIR, .glass_file = -1}};
    if (at == 0) {
        s->thickness = lens_tidy(y_before - y);
    } else {
        s->thickness = lens_tidy(s[-1].thickness - (y - y_before));
        s[-1].thickness = lens_tidy(y - y_before);
    }
    p->stop = (int)at;
}

/* A ring at the edge of a surface makes that surface the stop; another one is a plane in the air. */
static status read_stop(lens_finder *f)
{
    lens_prescription *p = f->p;
    const double k = lens_size_of(f->stop), half = k * f->stop->shape.inner_radius, height = k * f->stop->shape.height,
                 from = lens_along(f, f->stop), rounding = 1e-9 * half;
    double y = f->first, y_before = y;
    size_t after = 0; /* the first surface beyond the plane */
    p->aperture_kind = LENS_APERTURE_STOP;
    for (size_t i = 0; i < p->count; i++) {
        if (p->surface[i].mirror && y < from)
            return lens_refuse(f, f->stop, "place it before the first mirror, or leave it out", "is behind a mirror");
        const double edge = y + lens_surface_sag(&p->surface[i], half);
        if (fabs(edge - from) < rounding || fabs(edge - from - height) < rounding) {
            p->stop = (int)i;
            p->surface[i].diameter = 2.0 * half;
            return STATUS_OK;
        }
        if (y <= from + 0.5 * height)
            after = i + 1, y_before = y;
        y += p->surface[i].thickness;
    }
    y = from + 0.5 * height;
    insert_stop(p, after, y, after == 0 ? f->first : y_before, 2.0 * half);
    f->first = after == 0 ? y : f->first;
    return STATUS_OK;
}

static lens_placement placement_found(const lens_finder *f)
{
    return (lens_placement){.name = f->stop ? f->stop->name : NULL,
                            .position = vec3_add(f->origin, vec3_scale(f->axis, f->first)),
                            .rotation_deg = f->lens[0].of->shape.rotation_deg,
                            .scale = 1.0};
}

status lens_of_scene(const scene *s, const char *name, lens_prescription *out, lens_placement *at, diagnostic *why)
{
    *out = lens_prescription_empty();
    lens_finder *f = calloc(1, sizeof *f);
    out->surface = calloc(LENS_SURFACES_MAX + 2, sizeof *out->surface);
    status code = f && out->surface ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        *f = (lens_finder){.s = s, .name = name ? name : "", .p = out, .why = why};
        out->unit_mm = 1000.0 * s->render.unit_m;
        snprintf(out->title, sizeof out->title, "%.255s", s->title);
        code = find(f);
        f->first = f->lens[0].y_1;
        THEN(code, lens_read_surfaces(f));
        if (code == STATUS_OK && f->stop)
            code = read_stop(f);
    }
    if (code == STATUS_OK) {
        const lens_placement place = placement_found(f);
        lens_read_beams(s, f->name, &place, out);
        lens_drop_bevels(out);
        lens_prescription_complete(out);
        if (f->mirrors && out->stop < 0) /* the rim of a mirror, which has no solid */
            out->stop = lens_first_order_of(out, out->wavelength[0].nm).stop;
        if (at)
            *at = place;
    } else {
        lens_prescription_release(out);
    }
    free(f);
    return code;
}
