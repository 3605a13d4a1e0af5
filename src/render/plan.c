#include "render/plan.h"

#include "base/elementary.h"
#include <stdlib.h>

/* Refractive index of the medium around all solids. */
#define SURROUNDING_IOR 1.0

static void aim_at_target(const struct camera *c, camera_frame *f)
{
    f->forward = vec3_normalize(vec3_sub(c->target, c->position));
    vec3 side = vec3_cross(vec3_make(0.0, 1.0, 0.0), f->forward);
    f->right = vec3_length(side) > 1e-12 ? vec3_normalize(side) : vec3_make(1.0, 0.0, 0.0); /* straight up or down */
}

static void aim_along_angles(const struct camera *c, camera_frame *f)
{
    double sin_yaw, cos_yaw, sin_pitch, cos_pitch;
    elementary_sincos_deg(c->yaw_deg, &sin_yaw, &cos_yaw);
    elementary_sincos_deg(c->pitch_deg, &sin_pitch, &cos_pitch);
    f->forward = vec3_make(cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw);
    f->right = vec3_make(cos_yaw, 0.0, -sin_yaw);
}

static camera_frame frame_of(const struct camera *c, double aspect)
{
    camera_frame f;
    f.eye = c->position;
    if (c->aimed)
        aim_at_target(c, &f);
    else
        aim_along_angles(c, &f);
    f.up = vec3_cross(f.forward, f.right);
    double s, k;
    elementary_sincos_deg(0.5 * c->fov_deg, &s, &k);
    f.half_height = s / k;
    f.half_width = f.half_height * aspect;
    return f;
}

/* Under Fresnel's weights equal indices are one medium, and a crossing between them is no interface; under constant weights, as
 * in the report, every surface reflects whatever its index. */
static int64_t medium_of(const scene *s, int solid_index)
{
    const material *m = &s->solids[solid_index].surface;
    if (m->transparency == 0.0 || s->render.weights == WEIGHTS_CONSTANT)
        return solid_index + 1;
    if (m->ior == SURROUNDING_IOR)
        return 0;
    for (int i = 0; i < solid_index; i++) {
        const solid *other = &s->solids[i];
        if (other->visible && other->surface.transparency > 0.0 && other->surface.ior == m->ior)
            return i + 1;
    }
    return solid_index + 1;
}

static status arrange(const scene *s, arrangement **out, diagnostic *why)
{
    body_source *sources = calloc(s->solid_count + 1, sizeof *sources);
    if (!sources)
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    int count = 0;
    for (int i = 0; i < (int)s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one->visible)
            sources[count++] = (body_source){.shape = &one->shape, .priority = one->priority, .medium = medium_of(s, i),
                                             .opaque = one->surface.transparency == 0.0,
                                             .clearness = one->surface.transparency, .solid = i};
    }
    status code = arrangement_build(sources, count, 0, out, why);
    free(sources);
    return code;
}

status plan_build(const scene *s, plan **out, diagnostic *why)
{
    plan *p = calloc(1, sizeof *p);
    if (!p)
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    status code = arrange(s, &p->solids, why);
    if (code == STATUS_OK) {
        size_t ranks = (size_t)p->solids->body_count + 1;
        p->materials = calloc(ranks, sizeof *p->materials);
        p->ior = calloc(ranks, sizeof *p->ior);
        if (!p->materials || !p->ior)
            code = diagnose(why, STATUS_FAILURE, "", "out of memory");
    }
    if (code != STATUS_OK) {
        plan_destroy(p);
        return code;
    }
    p->ior[0] = SURROUNDING_IOR;
    for (int r = 1; r <= p->solids->body_count; r++) {
        p->materials[r] = &s->solids[p->solids->bodies[r].solid].surface;
        p->ior[r] = p->materials[r]->ior;
    }
    p->view = frame_of(&s->camera, (double)s->render.width / (double)s->render.height);
    p->eye_inside = arrangement_inside(p->solids, p->view.eye);
    p->render = s->render;
    p->sky = &s->background;
    p->lights = s->lights;
    p->light_count = (int)s->light_count;
    *out = p;
    return STATUS_OK;
}

void plan_destroy(plan *p)
{
    if (!p)
        return;
    arrangement_destroy(p->solids);
    free(p->materials);
    free(p->ior);
    free(p);
}
