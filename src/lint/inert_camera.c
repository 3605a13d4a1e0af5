/* Camera parameters without effect. */
#include "lint/inert_private.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

static bool fov(const inert_case *c)
{
    return c->s->camera.projection == PROJECTION_ORTHOGRAPHIC &&
           inert_say(c, "orthographic", "set camera.projection=perspective",
                     "the rays of an orthographic camera are parallel: camera.view_height gives the image's size");
}

static bool view_height(const inert_case *c)
{
    return c->s->camera.projection == PROJECTION_PERSPECTIVE &&
           inert_say(c, "perspective", "set camera.projection=orthographic",
                     "the image's size in the scene grows with the distance: camera.fov_deg gives its angle");
}

static bool aperture(const inert_case *c)
{
    const scene *s = c->s;
    const integrator_traits *traits = integrator_traits_of(&s->render);
    scene wide = *s; /* borrows from s */
    wide.camera.aperture = 1.0;
    if (camera_lens_is_sampled(&wide))
        return false;
    if (traits->drawn || traits->layers)
        return inert_say(c, "chief-rays", "set render.integrator=whitted and render.samples=16",
                         "this render.integrator sees along the rays through the centre of the lens");
    return inert_say(c, "one-ray", traits->by_chance ? "set render.paths=64" : "set render.samples=16",
                     "the only ray of a pixel passes through the centre of the lens");
}

static bool focus(const inert_case *c)
{
    if (aperture(c))
        return true;
    return c->s->camera.aperture == 0.0 &&
           inert_say(c, "pinhole", "set camera.aperture=0.2", "a pinhole shows everything in focus");
}

inert_remedy polarised_remedy(const scene *s)
{
    const render_settings *r = &s->render;
    const integrator_traits *traits = integrator_traits_of(r);
    const char *first = traits->drawn || traits->layers          ? "render.integrator=whitted and "
                        : r->weights == WEIGHTS_CONSTANT         ? "render.weights=fresnel and "
                        : r->transmission == TRANSMISSION_SIMPLE ? "render.transmission=refract and "
                                                                 : "";
    return inert_set("%srender.polarisation=on", first);
}

bool unpolarised(const inert_case *c)
{
    return !c->s->render.polarisation &&
           inert_say(c, "unpolarised", polarised_remedy(c->s).text, "light is traced without its polarisation");
}

static bool analyser_angle(const inert_case *c)
{
    if (unpolarised(c))
        return true;
    if (c->s->camera.analyser != ANALYSER_LINEAR)
        return inert_say(c, "not-linear", "set camera.analyser=linear", "only a linear analyser has an axis");
    return inert_polarisation(c);
}

bool inert_camera(const inert_case *c)
{
    static const inert_row rows[] = {
        {"fov_deg", fov}, {"view_height", view_height}, {"aperture", aperture},
        {"focus", focus}, {"analyser", unpolarised},    {"analyser_angle_deg", analyser_angle},
        {NULL, NULL}};
    return inert_by_name(rows, c);
}
