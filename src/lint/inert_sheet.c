/* Parameters of polarisers and wave plates that have no effect. */
#include "lint/inert_private.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include "scene/model/sheet.h"

bool sheet_rule(const inert_case *c)
{
    const scene *s = c->s;
    if (opaque_rule(c) || mirror_rule(c))
        return true;
    if (integrator_traits_of(&s->render)->drawn)
        return inert_say(c, "zbuffer-sheet", "set render.integrator=whitted",
                         "the depth buffer does not show what sheets do");
    return !material_matches_surroundings(s, c->m) && unpassed(c);
}

/* The solid is not such a sheet; one of that kind, with polarised light, shows the parameter. */
static bool say_other_kind(const inert_case *c, const char *kind)
{
    const inert_remedy before = c->s->render.polarisation ? (inert_remedy){""} : polarised_remedy(c->s);
    const inert_remedy remedy = before.text[0] ? inert_set("%s.sheet=%s and %s", c->name, kind, before.text + 4)
                                               : inert_set("%s.sheet=%s", c->name, kind);
    const bool none = c->m->sheet == SHEET_NONE;
    return inert_say(c, none ? "no-sheet" : "other-sheet", remedy.text,
                     none ? "its sheet is none: light passes it unchanged" : "its sheet is of another kind");
}

bool sheet_axis_rule(const inert_case *c)
{
    if (sheet_rule(c))
        return true;
    if (!sheet_has_axis(c->m))
        return say_other_kind(c, "polariser");
    if (unpolarised(c))
        return true;
    if (c->m->sheet == SHEET_RETARDER)
        return !sheet_retards(c->m) &&
               inert_say(c, "no-retardance", inert_set("%s.retardance_deg=90", c->name).text, "its retardance is 0");
    return c->m->sheet_pass == c->m->sheet_block &&
           inert_say(c, "grey", inert_set("%s.sheet_pass=1 and %s.sheet_block=0", c->name, c->name).text,
                     "sheet_pass equals sheet_block: it is a grey filter");
}

bool sheet_share_rule(const inert_case *c)
{
    return sheet_rule(c) || (!sheet_is_polariser(c->m) && say_other_kind(c, "polariser"));
}

bool retardance_rule(const inert_case *c)
{
    return sheet_rule(c) || (c->m->sheet != SHEET_RETARDER ? say_other_kind(c, "retarder") : unpolarised(c));
}
