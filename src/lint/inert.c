/* Asks the table (needs.c) about a parameter; and what the first hits of an image show. */
#include "lint/needs.h"

#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool inert_say(const inert_case *c, const char *rule, const char *remedy, const char *text, ...)
{
    scene_note *note = &c->out->note;
    va_list arguments;
    va_start(arguments, text);
    vsnprintf(note->text, sizeof note->text, text, arguments);
    va_end(arguments);
    snprintf(note->remedy, sizeof note->remedy, "%s", remedy);
    c->out->rule = rule;
    return true;
}

inert_remedy inert_set(const char *format, ...)
{
    inert_remedy r = {"set "};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r.text + 4, sizeof r.text - 4, format, arguments);
    va_end(arguments);
    return r;
}

inert_remedy inert_set_on(const solid *one, const char *assignment)
{
    return one ? inert_set("%s.%s", one->name, assignment) : (inert_remedy){"add a solid"};
}

inert_remedy inert_set_clear(const solid *one)
{
    return one ? inert_set("%s.transparency=0.9 and %s.ior=1.5", one->name, one->name) : inert_set_on(one, "");
}

bool inert_same(const inert_case *c, const char *format, ...)
{
    char assignment[NOTE_TEXT_MAX];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(assignment, sizeof assignment, format, arguments);
    va_end(arguments);
    return c->witness->same && c->witness->same(c->witness->context, assignment);
}

/* --- what the first hits show --- */

/* Whether the film is unchanged with the parameter scaled by that factor. */
static bool same_times(const inert_case *c, const char *path, double factor)
{
    char *now = NULL;
    if (scene_get(c->s, path, &now, NULL) != STATUS_OK)
        return false;
    double value = strtod(now, NULL);
    free(now);
    if (value == 0.0 && c->at.row->group == PARAM_SOLID) /* of contact_radius: the solid's radius */
        value = c->s->solids[c->at.index].shape.radius;
    return inert_same(c, "%s=%.6g", path, value * factor);
}

/* The background, and surface properties that only decide whether there is a surface, may matter for this image of a
 * layer: the witness decides. */
static bool is_unmet_by_camera(const inert_case *c, const char *path)
{
    static const struct {
        const char *name, *values[3];
    } rows[] = {
        {"emission", {"0", "1", NULL}},
        {"transparency", {"0", "0.5", "1"}},
        {"ior", {"1.1", "1.9", NULL}},
        {"film_thickness_nm", {"0", "300", NULL}},
        {"medium", {"water", "diamond", "bk7"}},
        {"priority", {"-1000", "0", "1000"}},
        {"visible", {"on", "off", NULL}},
        {"color", {"0,0,0", "1,1,1", NULL}},
        {"capillary_length", {"0", "0.05", "0.2"}},
        {"contact_angle_deg", {"20", "90", "150"}},
        {"contact_radius", {"0", NULL}}, /* 0: the largest */
        {"inner_radius", {NULL}},
        {"floor", {NULL}},
    };
    if (!has_layers(c->s) || !c->witness->same)
        return false;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!is_named(c, rows[i].name))
            continue;
        const bool part = strcmp(rows[i].name, "contact_radius") == 0;
        bool same =
            (rows[i].values[0] && !part) || (same_times(c, path, 0.5) && same_times(c, path, part ? 0.9 : 1.05));
        for (size_t k = 0; k < 3 && rows[i].values[k] && same; k++)
            same = inert_same(c, "%s=%s", path, rows[i].values[k]);
        return same &&
               inert_say(c, "met-first", "set render.integrator=whitted", "the first hits of this image do not change");
    }
    return false;
}

/* --- the question --- */

static bool ask_solid(const inert_case *c)
{
    inert_case own = *c;
    own.owner = &c->s->solids[c->at.index], own.m = &own.owner->surface;
    return needs_ask(&own, PARAM_SOLID) || (c->at.row->group == PARAM_MATERIAL && inert_surface(&own));
}

static bool ask_group(const inert_case *c)
{
    if (c->at.object_group == PARAM_MATERIAL)
        return inert_material(c);
    return c->at.object_group == PARAM_SOLID ? ask_solid(c) : needs_ask(c, c->at.object_group);
}

bool inert_ask(const scene *s, const char *path, const inert_witness *witness, inert_answer *out)
{
    static const inert_witness nobody = {.frame = NULL};
    inert_case c = {.s = s, .witness = witness ? witness : &nobody, .out = out};
    c.frame = c.witness->frame && c.witness->frame->camera > 0 ? c.witness->frame : NULL;
    *out = (inert_answer){.rule = ""};
    if (param_place_find(s, path, &c.at, NULL) != STATUS_OK || !scene_film_depends_on(s, path))
        return false;
    c.name = param_place_group_name(s, c.at.object_group, c.at.index);
    if (!needs_light(&c) && !ask_group(&c) && !is_unmet_by_camera(&c, path))
        return false;
    snprintf(out->note.place, sizeof out->note.place, "%s", path);
    return true;
}
