/* The camera's frame, from its target or its angles, and its lens and tone (camera.h). */
#include "scene/model/camera.h"
#include "base/elementary.h"
#include "scene/model/view_settings.h"

static void aim_at_target(const struct camera *c, camera_frame *f)
{
    f->forward = vec3_normalize(vec3_sub(c->target, c->position));
    vec3 side = vec3_cross(vec3_make(0.0, 1.0, 0.0), f->forward);
    f->right = vec3_length(side) > 1e-12 ? vec3_normalize(side) : vec3_make(1.0, 0.0, 0.0); /* forward is vertical */
}

static void aim_along_angles(const struct camera *c, camera_frame *f)
{
    double sin_yaw, cos_yaw, sin_pitch, cos_pitch;
    elementary_sincos_deg(c->yaw_deg, &sin_yaw, &cos_yaw);
    elementary_sincos_deg(c->pitch_deg, &sin_pitch, &cos_pitch);
    f->forward = vec3_make(cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw);
    f->right = vec3_make(cos_yaw, 0.0, -sin_yaw);
}

/* Rolls the axes about forward, right towards down. A multiple of 90 degrees is exact, and 0 changes no bit. */
static void roll(camera_frame *f, double degrees)
{
    if (degrees == 0.0)
        return;
    double sine, cosine;
    elementary_sincos_deg(degrees, &sine, &cosine);
    const vec3 right = f->right, up = f->up;
    f->right = vec3_sub(vec3_scale(right, cosine), vec3_scale(up, sine));
    f->up = vec3_add(vec3_scale(right, sine), vec3_scale(up, cosine));
}

camera_frame camera_frame_level(const scene *s)
{
    const struct camera *c = scene_camera(s);
    camera_frame f;
    f.eye = c->position;
    if (c->aimed)
        aim_at_target(c, &f);
    else
        aim_along_angles(c, &f);
    f.up = vec3_cross(f.forward, f.right);
    double sine, cosine;
    elementary_sincos_deg(0.5 * c->fov_deg, &sine, &cosine);
    f.parallel = c->projection == PROJECTION_ORTHOGRAPHIC;
    f.half_height = f.parallel ? 0.5 * c->view_height : sine / cosine;
    f.lens_radius = 0.5 * c->aperture;
    f.focus = c->focus > 0.0 ? c->focus : 1.0; /* 0 if no defaults are set: a pinhole can have any */
    f.half_width = f.half_height * ((double)scene_settings(s)->width / (double)scene_settings(s)->height);
    return f;
}

image_tone camera_tone(const scene *s)
{
    const struct camera *c = scene_camera(s);
    if (integrator_traits_of(scene_settings(s))->unlit)
        return (image_tone){.curve = TONE_NONE};
    return (image_tone){.exposure = c->exposure, .curve = c->tone, .white = c->white};
}

bool camera_lens_is_sampled(const scene *s)
{
    const render_settings *r = scene_settings(s);
    const integrator_traits *traits = integrator_traits_of(r);
    const int64_t rays = traits->by_chance                  ? r->paths
                         : r->spectrum == SPECTRUM_SPECTRAL ? r->samples * r->wavelengths
                                                            : r->samples;
    return scene_camera(s)->aperture > 0.0 && rays > 1 && !traits->drawn && !traits->unlit;
}

camera_frame camera_frame_of(const scene *s)
{
    camera_frame f = camera_frame_level(s);
    roll(&f, scene_camera(s)->roll_deg);
    return f;
}
