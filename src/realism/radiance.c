/* Radiance across the liquid's flat surface with render.radiance: basic. L / n^2 is preserved except for reflection
 * (Nicodemus 1963), so that from within the liquid a sky of radiance 1 has (n / n_0)^2 T, and a floor of radiance 1 in
 * the liquid has T (n_0 / n)^2 from above. A light above illuminates that floor through the surface with the T of its
 * own straight line, and the square of the index applies only to the returning path.
 *
 * Tolerance: as in gap.c; for the lamp, also the bound of its own light, whose angle follows from the point of the
 * floor: an error e of the ray's direction moves that by e (1 + tan^2) of each length. */
#include "realism/metrics.h"

#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"
#include <math.h>

enum { STEP_DEG = 5, LAST_DEG = 85, LAMP_HEIGHT = 40, EYE_HEIGHT = 2 };

typedef enum look { LOOK_SKY, LOOK_FLOOR, LOOK_LAMP, LOOKS } look;

static const vec3 lamp_place = {9.0, LAMP_HEIGHT, 3.0};

/* The liquid fills 0 < y < 1, on a diffuse floor. */
static scene *pond(const scene *s, const setup *at, look which)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    solid *water = &copy->solids[at->liquid], *ground = &copy->solids[at->rod];
    water->visible = 1, ground->visible = which != LOOK_SKY;
    water->priority = 1, ground->priority = 2;
    water->shape = box_at(vec3_make(0.0, 0.0, 0.0), vec3_make(1e4, 2.0, 1e4));
    water->surface.ambient = water->surface.diffuse = water->surface.specular = 0.0; /* no reflection of the surface's
                                                                                        own */
    water->surface.absorb_per_m = vec3_make(0.0, 0.0, 0.0);
    water->surface.absorb_spectrum.count = 0;
    ground->shape = ground_at(0.0);
    ground->surface = (material){.color = {1.0, 1.0, 1.0}, .ior = 1.0};
    *(which == LOOK_LAMP ? &ground->surface.diffuse : &ground->surface.ambient) = 1.0;
    copy->background.ambient = vec3_make(1.0, 1.0, 1.0);
    copy->background.kind = BACKGROUND_UNIFORM;
    const double sky = which == LOOK_SKY ? 1.0 : 0.0;
    copy->background.color = vec3_make(sky, sky, sky);
    copy->render.beyond = DEPTH_LIMIT_BLACK;
    copy->render.depth = 1;
    copy->render.radiance = RADIANCE_BASIC;
    copy->render.shadows = SHADOWS_ATTENUATED;
    return copy;
}

/* A single point light above the surface. */
static status hang_lamp(scene *s, diagnostic *why)
{
    size_t at = 0;
    while (s->light_count > 0)
        TRY(scene_remove(s, s->lights[0].name, why));
    TRY(scene_add(s, PARAM_LIGHT, "lamp", &at, why));
    light *l = &s->lights[at];
    l->position = lamp_place;
    l->intensity = 1.0;
    l->color = vec3_make(1.0, 1.0, 1.0);
    return STATUS_OK;
}

static double through(double angle, double n_from, double n_to)
{
    return n_from == n_to ? 1.0 : 1.0 - theory_fresnel(angle, n_from, n_to);
}

/* Irradiance E at the point of the floor that a ray from (0, EYE_HEIGHT, 0) hits. */
static double lamp_theory(double angle, double n_around, double n_liquid)
{
    const double x = (EYE_HEIGHT - 1.0) * tan(angle) + tan(theory_snell(angle, n_around, n_liquid));
    const double across = hypot(lamp_place.x - x, lamp_place.z), incidence = atan2(across, lamp_place.y);
    return cos(incidence) * through(incidence, fmin(n_around, n_liquid), fmax(n_around, n_liquid));
}

static double theory(const setup *at, look which, double angle)
{
    const double n_around = at->n[SETUP_OUTSIDE], n_liquid = at->n[SETUP_LIQUID], ratio = n_liquid / n_around;
    if (which == LOOK_SKY)
        return ratio * ratio * through(angle, n_liquid, n_around);
    const double T = through(angle, n_around, n_liquid);
    if (T == 0.0) /* total reflection from above, with an index below that of the surroundings */
        return 0.0;
    return T / (ratio * ratio) * (which == LOOK_LAMP ? lamp_theory(angle, n_around, n_liquid) : 1.0);
}

static double tolerance(const setup *at, look which, double angle)
{
    const double n_around = at->n[SETUP_OUTSIDE], n_liquid = at->n[SETUP_LIQUID], ratio = n_liquid / n_around;
    const double gain = which == LOOK_SKY ? ratio * ratio : 1.0 / (ratio * ratio);
    double off = bound_difference(BOUND_FORM) + (which == LOOK_SKY ? bound_shares(angle, 0.0, n_liquid, n_around)
                                                                   : bound_shares(angle, 0.0, n_around, n_liquid))
                                                    .R;
    const double t = theory_snell(angle, n_around, n_liquid);
    if (which == LOOK_LAMP && !isnan(t)) {
        const double turn = bound_difference(BOUND_TURN), x = EYE_HEIGHT / cos(angle) + 1.0 / cos(t),
                     aside = turn * (EYE_HEIGHT / pow(cos(angle), 2) + n_around / n_liquid / pow(cos(t), 3) + x) /
                             LAMP_HEIGHT,
                     across = hypot(lamp_place.x - (EYE_HEIGHT - 1.0) * tan(angle) - tan(t), lamp_place.z),
                     incidence = atan2(across, lamp_place.y);
        off += aside + turn + bound_shares(incidence, aside, fmin(n_around, n_liquid), fmax(n_around, n_liquid)).R;
    }
    return BOUND_FILM + gain * off;
}

static status measure(const metrics *m, look which, worst_pair *worst, diagnostic *why)
{
    scene *s = pond(m->traced, &m->at, which);
    status code = s ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && which == LOOK_LAMP)
        code = hang_lamp(s, why);
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    trial t;
    code = trial_start(&t, s, m->level, why);
    for (int degrees = 0; degrees <= LAST_DEG && code == STATUS_OK; degrees += STEP_DEG) {
        const double angle = degrees * M_PI / 180.0, up = which == LOOK_SKY ? 1.0 : -1.0;
        const vec3 from = vec3_make(0.0, which == LOOK_SKY ? 0.5 : EYE_HEIGHT, 0.0);
        code = probe_ray(t.p, from, vec3_make(sin(angle), up * cos(angle), 0.0), &t.tree, why);
        worst_take(worst, code == STATUS_OK ? t.tree.radiance[0] : NAN, theory(&m->theory_at, which, angle),
                   tolerance(&m->theory_at, which, angle));
    }
    trial_end(&t);
    return code;
}

status realism_radiance(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"radiance.sky_under_water", "radiance.floor_under_water",
                                        "radiance.lamp_under_water"};
    static const char *const what[] = {("radiance of a sky of radiance 1, seen from inside the liquid "
                                        "(render.radiance=basic); largest error at 0 to 85 degrees"),
                                       "radiance of a floor of radiance 1 below the liquid, seen from above",
                                       "radiance of a diffuse floor below the liquid, lit by a light above it"};
    const bool fresnel = !scene_has_constant_weights(&m->traced->render);
    status code = STATUS_OK;
    for (int k = 0; k < LOOKS && code == STATUS_OK; k++) {
        worst_pair worst = WORST_NONE;
        const bool defined = fresnel && m->at.liquid >= 0;
        if (defined)
            code = measure(m, (look)k, &worst, why);
        const char *line = m->at.liquid < 0 ? "there is no liquid"
                           : !fresnel       ? "constant weights do not depend on the angle"
                                            : what[k];
        metrics_add(m, (realism_value){names[k], line, "", worst.measured, worst.theory, worst.tolerance});
    }
    return code;
}
