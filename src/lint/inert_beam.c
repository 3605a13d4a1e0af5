/* Parameters of beams that light the scene without effect. */
#include "lint/inert_private.h"
#include "scene/model/scene.h"

#include <string.h>

static bool is(const inert_case *c, const char *name)
{
    return strcmp(c->at.row->name, name) == 0;
}

/* No photons bring its light. */
static bool dark(const inert_case *c, const beam *b)
{
    const scene *s = c->s;
    if (integrator_traits_of(&s->render)->drawn)
        return inert_say(c, "zbuffer-beam", "set render.integrator=whitted", "the depth buffer traces no light");
    if (s->render.shadows == SHADOWS_OFF)
        return inert_say(c, "no-shadows-beam", "set render.shadows=opaque", "render.shadows is off");
    if (s->render.caustics == CAUSTICS_OFF)
        return inert_say(c, "no-photons-beam", "set render.caustics=photons",
                         "photons alone bring the light of beams, and render.caustics is off");
    if (!b->visible && !is(c, "visible"))
        return inert_say(c, "hidden-beam", inert_set("%s.visible=on", c->name).text, "the beam is left out");
    if (b->power == 0.0 && !is(c, "power"))
        return inert_say(c, "dark-beam", inert_set("%s.power=1", c->name).text, "the beam's power is 0");
    return !b->white && (b->lambda_nm < OBSERVER_LOW_NM || b->lambda_nm > OBSERVER_HIGH_NM) && !is(c, "lambda_nm") &&
           !is(c, "white") &&
           inert_say(c, "unseen-beam", inert_set("%s.lambda_nm=550", c->name).text,
                     "the eye does not see its wavelength");
}

/* Parameters of other kinds of beams. */
static bool other_kind(const inert_case *c, const beam *b)
{
    const bool is_flat = b->kind == BEAM_FAN || b->kind == BEAM_SHEET;
    if (is(c, "angle_deg") && beam_is_parallel(b))
        return inert_say(c, "parallel-beam", inert_set("%s.kind=pencil", c->name).text, "its rays are parallel");
    if (is(c, "width") && !beam_is_parallel(b))
        return inert_say(c, "beam-from-point", inert_set("%s.kind=bundle", c->name).text, "its rays start at a point");
    if (is(c, "normal") && !is_flat)
        return inert_say(c, "round-beam", inert_set("%s.kind=fan", c->name).text, "its rays are not in a plane");
    if (is(c, "target") && vec3_dot(b->direction, b->direction) > 0.0)
        return inert_say(c, "beam-direction", inert_set("%s.direction=0,0,0", c->name).text,
                         "its direction is used instead of its target");
    if (is(c, "lambda_nm") && b->white)
        return inert_say(c, "white-beam", inert_set("%s.white=off", c->name).text, "the beam is white");
    const double size = beam_is_parallel(b) ? b->width : b->angle_deg;
    return is(c, "profile") && size == 0.0 &&
           inert_say(c, "thin-beam", inert_set(beam_is_parallel(b) ? "%s.width=0.5" : "%s.angle_deg=10", c->name).text,
                     "all its rays are on its axis");
}

/* Whether the film is the same with the beam's light and without it. If the parameter in question makes the beam dark,
 * light is that of another value. */
static bool shows_no_light(const inert_case *c, const beam *b)
{
    const char *other = !b->lights                            ? "lights=on"
                        : !b->visible                         ? "visible=on"
                        : b->power == 0.0                     ? "power=1"
                        : beam_lights_scene(b, &c->s->render) ? "lights=off"
                                                              : "lambda_nm=550";
    return inert_same(c, "%s.%s", c->name, other);
}

/* A spot between the samples of the pixels is in no film, too. */
bool inert_beam(const inert_case *c)
{
    const beam *b = &c->s->beams[c->at.index];
    return dark(c, b) || other_kind(c, b) ||
           (shows_no_light(c, b) &&
            inert_say(c, "beam-lights-nothing",
                      "aim it at a matte surface that the camera sees; a spot narrower than a pixel needs more samples",
                      "no sample of the image shows its light"));
}
