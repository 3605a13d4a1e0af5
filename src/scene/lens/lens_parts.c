/* What the elements of a lens system are made of, and what holds them: media, stop, mounts and tube, and the screen
 * (lens_prescription.h). */
#include "base/elementary.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/lens/lens_reader.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define RING_THICKNESS 1e-4 /* of stops and mounts, of a diameter */

/* --- parameters by name (lens_reader.h) --- */

void lens_put(lens_target *t, const char *name, const char *row, const char *format, ...)
{
    char path[2 * SCENE_NAME_MAX + 2], value[512];
    va_list list;
    va_start(list, format);
    vsnprintf(value, sizeof value, format, list);
    va_end(list);
    snprintf(path, sizeof path, "%s.%s", name, row);
    THEN(t->code, scene_set_property(t->s, path, value, t->why));
}

void lens_put_number(lens_target *t, const char *name, const char *row, double value)
{
    char text[NUMBER_TEXT_MAX];
    lens_put(t, name, row, "%s", number_format(value, text));
}

void lens_add_solid(lens_target *t, const char *shape, const char *name)
{
    shape_kind kind = {0};
    THEN(t->code, scene_shape_named(shape, &kind, t->why));
    THEN(t->code, scene_add_solid(t->s, name, kind, NULL, t->why));
}

bool lens_has(const scene *s, param_group group, const char *name)
{
    return object_find(s, group, name) >= 0;
}

/* Places a solid at a height along the axis. The first one leads, the others follow it. */
void lens_put_at(lens_builder *b, const char *name, const lens_leg *leg, double y)
{
    const vec3 p = vec3_add(b->at->position, mat3_apply(b->turn, vec3_make(0.0, b->at->scale * y, 0.0))),
               r = b->at->rotation_deg;
    if (strcmp(name, b->at->name) != 0) {
        const vec3 q = vec3_add(leg->at, mat3_apply(leg->turn, vec3_make(0.0, y, 0.0))),
                   turn = rotation_to_deg(leg->turn);
        const double k = b->at->scale;
        lens_put(&b->t, name, "follows", "%s", b->at->name);
        lens_put(&b->t, name, "offset", "%.17g,%.17g,%.17g", k * q.x + 0.0, k * (q.y - b->leader), k * q.z + 0.0);
        if (turn.x != 0.0 || turn.y != 0.0 || turn.z != 0.0)
            lens_put(&b->t, name, "rotation", "%.17g,%.17g,%.17g", turn.x + 0.0, turn.y + 0.0, turn.z + 0.0);
        return;
    }
    if (leg->turn.row[1].y != 1.0 && b->t.code == STATUS_OK)
        b->t.code = diagnose(b->t.why, STATUS_BAD_INPUT, "begin with a lens, or a mirror that is not tilted",
                             "the first element of %.60s is a tilted mirror", b->at->name);
    b->leader = y;
    lens_put(&b->t, name, "position", "%.17g,%.17g,%.17g", p.x, p.y, p.z);
    lens_put(&b->t, name, "rotation", "%.17g,%.17g,%.17g", r.x, r.y, r.z);
}

void lens_part_name(const lens_builder *b, object_name name, const char *format, ...)
{
    char rest[32];
    va_list list;
    va_start(list, format);
    vsnprintf(rest, sizeof rest, format, list);
    va_end(list);
    snprintf(name, sizeof(object_name), "%.*s-%.31s", text_cut(b->at->name, 30), b->at->name, rest);
}

double lens_side_height_at(const lens_builder *b, size_t surface, double rho, double deg)
{
    const lens_surface *s = &b->p->surface[surface];
    double sine, cosine;
    if (s->form == SIDE_ROUND)
        return b->y[surface] + lens_surface_sag(s, s->diameter > 0.0 ? fmin(rho, 0.5 * s->diameter) : rho);
    elementary_sincos_deg(deg, &sine, &cosine);
    return b->y[surface] + lens_surface_height(s, rho * sine, rho * cosine);
}

double lens_side_height(const lens_builder *b, size_t surface, double rho, bool highest)
{
    const double one = lens_side_height_at(b, surface, rho, 0.0), two = lens_side_height_at(b, surface, rho, 90.0);
    return (one > two) == highest ? one : two;
}

/* --- media --- */

/* Indices of prescriptions are relative to air. In surroundings of index 1, which stand for air, they are used as they
 * are; otherwise they are multiplied by the index of air. */
static double air_index(const scene *s)
{
    const background *b = &s->background;
    return !surrounding_medium_name(b) && b->ior == 1.0 ? 1.0 : medium_index(media_at(0), LINE_HELIUM_D_NM);
}

/* glass: the name of the material without a coating, by which the data are named. */
static void add_data(lens_builder *b, const char *owner, const char *glass, const lens_medium *m)
{
    object_name name;
    snprintf(name, sizeof name, "%.*s-n", text_cut(glass, 60), glass);
    if (!lens_has(b->t.s, PARAM_DATA, name)) {
        THEN(b->t.code, scene_add(b->t.s, PARAM_DATA, name, NULL, b->t.why));
        const bool known = b->at->glasses && m->glass_file >= 0 && (size_t)m->glass_file < b->at->glasses->count;
        const char *file = known ? b->at->glasses->file[m->glass_file] : "";
        if (known)
            lens_put(&b->t, name, "file", "%s", file);
        if (!known || (strlen(file) > 4 && strcasecmp(file + strlen(file) - 4, ".agf") == 0))
            lens_put(&b->t, name, "glass", "%s", m->name);
        if (!m->law.relative_to_air)
            lens_put(&b->t, name, "relative_to", "vacuum");
    }
    lens_put(&b->t, owner, "medium", "data");
    lens_put(&b->t, owner, "medium_data", "%s", name);
}

static void add_glass(lens_builder *b, const lens_medium *m, const char *name, const char *glass)
{
    if (lens_has(b->t.s, PARAM_MATERIAL, name))
        return;
    THEN(b->t.code, scene_add(b->t.s, PARAM_MATERIAL, name, NULL, b->t.why));
    lens_put(&b->t, name, "transparency", "1");
    const double air = air_index(b->t.s);
    char list[2 * NUMBER_TEXT_MAX], A[NUMBER_TEXT_MAX], B[NUMBER_TEXT_MAX];
    switch (m->kind) {
    case LENS_AIR: break;
    case LENS_CATALOGUE: lens_put(&b->t, name, "medium", "%s", m->name); break;
    case LENS_DATA: add_data(b, name, glass, m); break;
    case LENS_MODEL:
        lens_put(&b->t, name, "medium", "cauchy");
        snprintf(list, sizeof list, "[%s,%s]", number_format(m->law.law.coefficient[0] * air, A),
                 number_format(m->law.law.coefficient[1] * air, B));
        lens_put(&b->t, name, "coefficients", "%s", list);
        break;
    case LENS_CONSTANT: lens_put_number(&b->t, name, "ior", m->n_d * air); break;
    }
}

/* The name of the material of a medium; the scene's own material of that name has precedence. */
void lens_medium_material(lens_builder *b, const lens_medium *m, object_name name)
{
    lens_material_name(m, name);
    add_glass(b, m, name, name);
}

void lens_coat(lens_builder *b, const lens_element *e)
{
    const lens_prescription *p = b->p;
    for (int side = 0; side < 2 && p->coating[0]; side++) {
        const size_t i = side ? e->back : e->front;
        object_name glass, name;
        if (!lens_side_in_air(p, i))
            continue;
        lens_material_name(e->medium, glass);
        snprintf(name, sizeof name, "%.*s-coated", text_cut(glass, 50), glass);
        add_glass(b, e->medium, name, glass);
        lens_put(&b->t, name, "coating", "%s", p->coating);
        lens_put(&b->t, e->name, side ? "material_2" : "material_1", "%s", name);
    }
}

/* A black opaque material for stops and mounts. */
const char *lens_black(lens_builder *b)
{
    static const char name[] = "blackened";
    if (b->t.code == STATUS_OK && !lens_has(b->t.s, PARAM_MATERIAL, name)) {
        b->t.code = scene_add(b->t.s, PARAM_MATERIAL, name, NULL, b->t.why);
        lens_put(&b->t, name, "color", "0.02,0.02,0.02");
        lens_put(&b->t, name, "diffuse", "1");
    }
    return name;
}

void lens_add_hole(lens_builder *b, const lens_element *e, double hole)
{
    object_name name, plug;
    lens_part_name(b, name, "hole-%zu", b->count);
    lens_part_name(b, plug, "hole");
    const background *around = &b->t.s->background;
    if (!lens_has(b->t.s, PARAM_MATERIAL, plug)) {
        THEN(b->t.code, scene_add(b->t.s, PARAM_MATERIAL, plug, NULL, b->t.why));
        lens_put(&b->t, plug, "transparency", "1");
        if (surrounding_medium_name(around))
            lens_put(&b->t, plug, "medium", "%s", surrounding_medium_name(around));
        else
            lens_put_number(&b->t, plug, "ior", around->ior);
    }
    const double glass = lens_is_air(&b->p->surface[e->front].medium) ? 0.0 : fabs(b->p->surface[e->front].thickness),
                 length = e->y_2 - e->y_1 + glass;
    const lens_surface *of = &b->p->surface[e->front];
    const double half_of = 0.5 * e->diameter,
                 sag = fmax(fabs(lens_surface_sag(of, half_of)), fabs(lens_surface_height(of, half_of, 0.0)));
    lens_add_solid(&b->t, "cylinder", name);
    lens_put(&b->t, name, "material", "%s", plug);
    lens_put_at(b, name, &e->leg, e->y_1 - sag - length);
    lens_put_number(&b->t, name, "radius", 0.5 * hole * b->at->scale);
    lens_put_number(&b->t, name, "height", (3.0 * length + 2.0 * sag) * b->at->scale);
    lens_put(&b->t, name, "priority", "%lld", (long long)(b->at->priority + 2 + LENS_SURFACES_MAX));
}

const char *lens_mirror_material(lens_builder *b)
{
    static const char name[] = "mirror";
    if (!lens_has(b->t.s, PARAM_MATERIAL, name)) {
        THEN(b->t.code, scene_add(b->t.s, PARAM_MATERIAL, name, NULL, b->t.why));
        lens_put(&b->t, name, "medium", "aluminium");
    }
    return name;
}

status lens_medium_of(const scene *s, const solid *of, lens_medium *out, diagnostic *why)
{
    const material *m = &of->surface;
    const background *around = &s->background;
    const char *surroundings = surrounding_medium_name(around), *name = material_medium_name(m);
    *out = (lens_medium){.kind = LENS_CONSTANT, .glass_file = -1};
    if (surroundings && strcmp(surroundings, "air") != 0)
        return diagnose(why, STATUS_BAD_INPUT, "set background.medium to air, or background.ior to 1",
                        "the surroundings are %s", surroundings);
    out->around = surroundings ? 0.0 : around->ior;
    TRY(material_index_law(m, of->name, &out->law, why));
    if (out->law.data && optical_data_law(out->law.data)) { /* a formula outlives the scene */
        out->law.law = *optical_data_law(out->law.data);
        out->law.data = NULL;
        out->kind = LENS_DATA;
    }
    out->n_d = lens_tidy(lens_medium_index(out, LINE_HELIUM_D_NM));
    const double F = lens_medium_index(out, LINE_HYDROGEN_F_NM), C = lens_medium_index(out, LINE_HYDROGEN_C_NM);
    out->V_d = F != C ? lens_tidy((out->n_d - 1.0) / (F - C)) : 0.0;
    if (name) {
        out->kind = LENS_CATALOGUE;
        snprintf(out->name, sizeof out->name, "%s", name);
    } else if (m->medium == MEDIUM_DATA) {
        out->kind = LENS_DATA;
        snprintf(out->name, sizeof out->name, "%s", m->medium_data);
        const int at = object_find(s, PARAM_DATA, m->medium_data);
        const data_entry *d = at >= 0 ? &s->data[at] : NULL;
        if (d && d->glass[0])
            snprintf(out->name, sizeof out->name, "%s", d->glass);
        if (d && !d->column[0] && d->scale == 1.0)
            out->glass_file = at;
    } else if (out->V_d > 0.0) {
        out->kind = LENS_MODEL;
    }
    return STATUS_OK;
}

/* --- rings and the screen --- */

/* A ring from inner to outer radius between two heights. */
static void add_ring(lens_builder *b, const char *name, const lens_leg *leg, double inner, double outer, double y,
                     double thickness, int64_t priority)
{
    const double scale = b->at->scale;
    const char *paint = lens_black(b);
    lens_add_solid(&b->t, "cup", name);
    lens_put(&b->t, name, "material", "%s", paint);
    lens_put_at(b, name, leg, y);
    lens_put_number(&b->t, name, "radius", outer * scale);
    lens_put_number(&b->t, name, "inner_radius", inner * scale);
    lens_put_number(&b->t, name, "height", thickness * scale);
    lens_put(&b->t, name, "floor", "0");
    lens_put(&b->t, name, "priority", "%lld", (long long)(b->at->priority + priority));
}

bool lens_is_air(const lens_medium *m)
{
    return m->kind == LENS_AIR;
}

bool lens_side_in_air(const lens_prescription *p, size_t i)
{
    const lens_medium *before = i ? &p->surface[i - 1].medium : &p->object_medium, *after = &p->surface[i].medium;
    return !p->surface[i].mirror && lens_is_air(before) != lens_is_air(after);
}

void lens_drop_bevels(lens_prescription *p)
{
    for (size_t i = 0; i < p->count; i++)
        if (p->surface[i].chamfer > 0.0 && !lens_side_in_air(p, i)) {
            p->surface[i].chamfer = 0.0;
            lens_note_item(p, "not read", "the bevel of surface %zu, which is no side of glass in air", i + 1);
        }
}

/* In air, a ring in the plane of the stop, which yields to glass. On a surface of glass, a ring in the air at the edge
 * of the clear diameter, which cuts glass beyond it. */
void lens_add_stop(lens_builder *b, double outer)
{
    const lens_prescription *p = b->p;
    if (p->stop < 0 || p->surface[p->stop].mirror)
        return;
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    const lens_surface *s = &p->surface[p->stop];
    const double diameter = f.stop_diameter > 0.0 ? f.stop_diameter : s->diameter, thin = RING_THICKNESS * diameter;
    if (!(diameter > 0.0) || !(0.5 * diameter < outer))
        return;
    const bool before = lens_is_air(p->stop > 0 ? &p->surface[p->stop - 1].medium : &p->object_medium),
               after = lens_is_air(&s->medium), in_air = before && after;
    const double sag = lens_surface_sag(s, 0.5 * diameter), edge = b->y[p->stop] + (isnan(sag) ? 0.0 : sag),
                 from = in_air  ? edge - 0.5 * thin
                        : after ? edge
                                : edge - thin;
    object_name name;
    lens_part_name(b, name, "stop");
    add_ring(b, name, &b->leg[p->stop], 0.5 * diameter, outer, from, thin, in_air ? 1 : LENS_SURFACES_MAX);
}

void lens_add_mounts(lens_builder *b, double outer)
{
    double low = INFINITY, high = -INFINITY;
    object_name name;
    for (size_t i = 0; i < b->count; i++) {
        const lens_element *e = &b->element[i];
        const double rim = 0.5 * e->diameter * (1.0 - LENS_RIM_GAP);
        if (!e->medium)
            return; /* a tube would shade mirrors */
        const double y_1 = lens_side_height(b, e->front, rim, true), y_2 = lens_side_height(b, e->back, rim, false),
                     thin = fmin(RING_THICKNESS * e->diameter, 0.5 * (y_2 - y_1));
        low = fmin(low, y_1), high = fmax(high, y_2);
        lens_part_name(b, name, "mount-%zu", i + 1);
        if (thin > 0.0)
            add_ring(b, name, &e->leg, rim, outer, 0.5 * (y_1 + y_2 - thin), thin, 0);
    }
    lens_part_name(b, name, "tube");
    if (high > low)
        add_ring(b, name, &b->leg[0], outer, outer * LENS_TUBE_CLEARANCE, low, high - low, 0);
}

/* The half diagonal of the image of the outermost field. */
double lens_image_height(const lens_prescription *p, const lens_first_order *f)
{
    if (p->image_diameter > 0.0)
        return 0.5 * p->image_diameter;
    const double h = isfinite(p->object_distance)
                         ? fabs(f->magnification * f->field_slope) * (p->object_distance + f->pupil)
                         : fabs(f->efl * f->field_slope);
    return h > 0.0 && isfinite(h) ? h : 0.1 * fabs(f->efl);
}

/* A white lens-shaped solid whose side towards the light is the image surface. */
void lens_add_screen(lens_builder *b)
{
    const lens_prescription *p = b->p;
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    const double half = 1.05 * lens_image_height(p, &f), y = b->y[p->count];
    const lens_surface s = {.radius = p->image_radius};
    const double sag = lens_surface_sag(&s, half), thickness = 0.05 * half + fmax(0.0, f.direction * sag);
    object_name name;
    if (!isfinite(y) || isnan(sag) || !(half > 0.0))
        return;
    lens_part_name(b, name, "screen");
    lens_add_solid(&b->t, "lens", name);
    lens_put_at(b, name, &b->leg[p->count], f.direction > 0.0 ? y : y - thickness);
    lens_put_number(&b->t, name, f.direction > 0.0 ? "radius_1" : "radius_2", p->image_radius * b->at->scale);
    lens_put_number(&b->t, name, f.direction > 0.0 ? "radius_2" : "radius_1", 0.0);
    lens_put_number(&b->t, name, "thickness", thickness * b->at->scale);
    lens_put_number(&b->t, name, "diameter", 2.0 * half * b->at->scale);
    lens_put(&b->t, name, "diffuse", "0.9");
    lens_put(&b->t, name, "priority", "%lld", (long long)(b->at->priority + 3 + LENS_SURFACES_MAX));
}
