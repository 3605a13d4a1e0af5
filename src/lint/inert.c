#include "lint/inert_private.h"

#include <stdarg.h>
#include <stdio.h>
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

bool inert_by_name(const inert_row *rows, const inert_case *c)
{
    for (; rows->name; rows++)
        if (strcmp(rows->name, c->at.row->name) == 0)
            return rows->rule(c);
    return false;
}

static bool ask_group(const inert_case *c)
{
    switch (c->at.object_group) {
    case PARAM_RENDER: return inert_render(c);
    case PARAM_CAMERA: return inert_camera(c);
    case PARAM_BACKGROUND: return inert_background(c);
    case PARAM_MESH: return inert_mesh(c);
    case PARAM_TEXTURE: return inert_texture(c);
    case PARAM_LIGHT: return inert_light(c);
    case PARAM_MATERIAL: return inert_material(c);
    case PARAM_SOLID: return inert_solid(c);
    case PARAM_BEAM: return inert_beam(c);
    case PARAM_GROUP_COUNT: break;
    }
    return false;
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
    if (!inert_layers(&c) && !ask_group(&c) && !inert_unmet(&c, path))
        return false;
    snprintf(out->note.place, sizeof out->note.place, "%s", path);
    return true;
}
