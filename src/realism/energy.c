/* Energy: the balance of a white furnace, radiance across a surface, absorption. */
#include "realism/metrics.h"

#include "scene/model/edit/edit.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

/* --- the white furnace --- */

/* The white furnace: under a sky of radiance 1, transparent media without absorption are invisible; a ray returns 1,
 * whatever its ray tree, or 1 minus the weight that the depth limit cut off. Materials with a transparency below 1 or
 * with emission fail.
 *
 * Tolerance: half a unit of the film for each ray of the tree that ends in the sky, and the rounding of its weight, a
 * product of one factor for each interface of the path. */

enum { COLUMNS = 20, ROWS = 15, DEPTH_MAX = 8 };

static scene *furnace(const scene *s, const setup *at)
{
    scene *copy = arrange_vessel(s, at);
    if (!copy)
        return NULL;
    copy->background.kind = BACKGROUND_UNIFORM;
    copy->background.color = vec3_make(1.0, 1.0, 1.0);
    copy->background.ambient = vec3_make(0.0, 0.0, 0.0);
    copy->render.beyond = DEPTH_LIMIT_BLACK;
    copy->render.depth = s->render.depth < DEPTH_MAX ? s->render.depth : DEPTH_MAX;
    for (size_t i = 0; i < copy->solid_count; i++) {
        copy->solids[i].surface.absorb_per_m = vec3_make(0.0, 0.0, 0.0);
        copy->solids[i].surface.absorb_spectrum.count = 0;
    }
    return copy;
}

static double furnace_tolerance(const ray_tree *tree)
{
    double sum = 0.0;
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *n = &tree->node[i];
        if (n->end == RAY_END_SKY || n->end == RAY_END_CUT_DEPTH)
            sum += BOUND_FILM + n->throughput[0] * bound_gamma(BOUND_FORM * (n->depth + 1));
    }
    return sum;
}

static double seen_and_cut(const ray_tree *tree, int channel)
{
    double sum = tree->radiance[channel];
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == RAY_END_CUT_DEPTH)
            sum += tree->node[i].throughput[channel];
    return sum;
}

status realism_balance(const metrics *m, diagnostic *why)
{
    trial t;
    worst_pair worst = WORST_NONE;
    scene *s = furnace(m->traced, &m->at);
    status code = trial_start(&t, s, m->level, why);
    for (int i = 0; i < COLUMNS * ROWS && code == STATUS_OK; i++) {
        const double x = (i % COLUMNS + 0.5) * (double)s->render.width / COLUMNS,
                     y = (i / COLUMNS + 0.5) * (double)s->render.height / ROWS;
        code = probe_ray(t.p, s->camera.position, probe_camera_direction(t.p, x, y), &t.tree, why);
        for (int c = 0; c < 3 && code == STATUS_OK; c++)
            worst_pair_add(&worst, seen_and_cut(&t.tree, c), 1.0, furnace_tolerance(&t.tree));
    }
    trial_end(&t);
    metrics_add(
        m,
        (realism_value){
            "balance.furnace",
            "radiance plus the weight cut off at the depth limit, under a sky of radiance 1; largest error of 300 rays",
            "", worst.measured, worst.theory, worst.tolerance});
    return code;
}

/* --- radiance across a surface --- */

/* Radiance across the liquid's flat surface with render.radiance: basic. L / n^2 is preserved except for reflection
 * (Nicodemus 1963), so that from within the liquid a sky of radiance 1 has (n / n_0)^2 T, and a floor of radiance 1 in
 * the liquid has T (n_0 / n)^2 from above. A light above illuminates the floor through the surface with the T of the
 * straight line to it, and the square of the index applies only to the returning path.
 *
 * Tolerance: as for gaps (flat.c). For the lamp, also the bound of its light, whose angle depends on the point of the
 * floor: an error e of the ray's direction moves the point by e (1 + tan^2) of each length. */

enum { STEP_DEG = 5, LAST_DEG = 85, LAMP_HEIGHT = 40, EYE_HEIGHT = 2 };

typedef enum pond_view { VIEW_SKY, VIEW_FLOOR, VIEW_LAMP, VIEWS } pond_view;

static const vec3 lamp_place = {9.0, LAMP_HEIGHT, 3.0};

/* The liquid fills 0 < y < 1, on a diffuse floor. */
static scene *pond(const scene *s, const setup *at, pond_view which)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    solid *water = &copy->solids[at->liquid], *ground = &copy->solids[at->rod];
    water->visible = 1, ground->visible = which != VIEW_SKY;
    water->priority = 1, ground->priority = 2;
    water->shape = box_at(vec3_make(0.0, 0.0, 0.0), vec3_make(1e4, 2.0, 1e4));
    water->surface.ambient = water->surface.diffuse = water->surface.specular = 0.0; /* no Phong terms */
    water->surface.absorb_per_m = vec3_make(0.0, 0.0, 0.0);
    water->surface.absorb_spectrum.count = 0;
    ground->shape = ground_at(0.0);
    ground->surface = (material){.color = {1.0, 1.0, 1.0}, .ior = 1.0};
    *(which == VIEW_LAMP ? &ground->surface.diffuse : &ground->surface.ambient) = 1.0;
    copy->background.ambient = vec3_make(1.0, 1.0, 1.0);
    copy->background.kind = BACKGROUND_UNIFORM;
    const double sky = which == VIEW_SKY ? 1.0 : 0.0;
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

static double pond_theory(const setup *at, pond_view which, double angle)
{
    const double n_around = at->n[SETUP_OUTSIDE], n_liquid = at->n[SETUP_LIQUID], ratio = n_liquid / n_around;
    if (which == VIEW_SKY)
        return ratio * ratio * through(angle, n_liquid, n_around);
    const double T = through(angle, n_around, n_liquid);
    if (T == 0.0) /* total reflection from above, with an index below that of the surroundings */
        return 0.0;
    return T / (ratio * ratio) * (which == VIEW_LAMP ? lamp_theory(angle, n_around, n_liquid) : 1.0);
}

static double pond_tolerance(const setup *at, pond_view which, double angle)
{
    const double n_around = at->n[SETUP_OUTSIDE], n_liquid = at->n[SETUP_LIQUID], ratio = n_liquid / n_around;
    const double gain = which == VIEW_SKY ? ratio * ratio : 1.0 / (ratio * ratio);
    double off = bound_difference(BOUND_FORM) + (which == VIEW_SKY ? bound_reflectances(angle, 0.0, n_liquid, n_around)
                                                                   : bound_reflectances(angle, 0.0, n_around, n_liquid))
                                                    .R;
    const double t = theory_snell(angle, n_around, n_liquid);
    if (which == VIEW_LAMP && !isnan(t)) {
        const double turn = bound_difference(BOUND_TURN), x = EYE_HEIGHT / cos(angle) + 1.0 / cos(t),
                     aside = turn * (EYE_HEIGHT / pow(cos(angle), 2) + n_around / n_liquid / pow(cos(t), 3) + x) /
                             LAMP_HEIGHT,
                     across = hypot(lamp_place.x - (EYE_HEIGHT - 1.0) * tan(angle) - tan(t), lamp_place.z),
                     incidence = atan2(across, lamp_place.y);
        off +=
            aside + turn + bound_reflectances(incidence, aside, fmin(n_around, n_liquid), fmax(n_around, n_liquid)).R;
    }
    return BOUND_FILM + gain * off;
}

static status measure_pond(const metrics *m, pond_view which, worst_pair *worst, diagnostic *why)
{
    scene *s = pond(m->traced, &m->at, which);
    status code = s ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && which == VIEW_LAMP)
        code = hang_lamp(s, why);
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    trial t;
    code = trial_start(&t, s, m->level, why);
    for (int degrees = 0; degrees <= LAST_DEG && code == STATUS_OK; degrees += STEP_DEG) {
        const double angle = degrees * M_PI / 180.0, up = which == VIEW_SKY ? 1.0 : -1.0;
        const vec3 from = vec3_make(0.0, which == VIEW_SKY ? 0.5 : EYE_HEIGHT, 0.0);
        code = probe_ray(t.p, from, vec3_make(sin(angle), up * cos(angle), 0.0), &t.tree, why);
        worst_pair_add(worst, code == STATUS_OK ? t.tree.radiance[0] : NAN, pond_theory(&m->theory_at, which, angle),
                       pond_tolerance(&m->theory_at, which, angle));
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
    for (int k = 0; k < VIEWS && code == STATUS_OK; k++) {
        worst_pair worst = WORST_NONE;
        const bool defined = fresnel && m->at.liquid >= 0;
        if (defined)
            code = measure_pond(m, (pond_view)k, &worst, why);
        const char *line = m->at.liquid < 0 ? "there is no liquid"
                           : !fresnel       ? "constant weights do not depend on the angle"
                                            : what[k];
        metrics_add(m, (realism_value){names[k], line, "", worst.measured, worst.theory, worst.tolerance});
    }
    return code;
}

/* --- absorption --- */

/* Beer-Lambert law: rays run inside the liquid to the rod over known lengths; -ln(transmittance) over length is a line
 * whose slope is the absorption coefficient (Hecht, Optics, 5th ed., eq. 4.78 with the coefficient of power). A liquid
 * without absorption is given coefficients.
 *
 * Tolerance: an error of a length or of exp and log is an error of -ln(transmittance); the slope weights it by the
 * distance of its length from the mean. */

enum { LENGTHS = 9 };

scene *attenuation_scene(const scene *s, const setup *at)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    solid *liquid = &copy->solids[at->liquid];
    liquid->visible = 1;
    liquid->shape.position = vec3_make(0.0, 0.0, 0.0);
    /* The rod's face is at x = 0 exactly, so that lengths have no rounding error from its position. */
    const double width = 0.1 * liquid->shape.radius;
    solid *rod = &copy->solids[at->rod];
    rod->visible = 1;
    rod->shape = box_at(vec3_make(width / 2.0, liquid->shape.height / 2.0, 0.0),
                        vec3_make(width, liquid->shape.height / 2.0, width));
    if (!material_absorbs(&liquid->surface)) {
        const double one = 1.0 / (liquid->shape.radius * s->render.unit_m);
        liquid->surface.absorb_per_m = vec3_make(one, one / 2.0, one / 4.0);
    }
    return copy;
}

/* The transmittance of a ray along x to the rod, at half height. */
status attenuation_point(trial *t, const setup *at, double length, double transmittance[3], diagnostic *why)
{
    const solid_shape *liquid = &t->s->solids[at->liquid].shape;
    const vec3 from = vec3_make(-length, liquid->height / 2.0, 0.0);
    const status code = probe_path(t->p, from, vec3_make(1.0, 0.0, 0.0), -1, &t->tree, why);
    const ray_node *first = &t->tree.node[0];
    for (int c = 0; c < 3 && code == STATUS_OK; c++)
        transmittance[c] = first->end == RAY_END_HIT && first->hit.solid == at->rod ? first->hit.transmittance[c] : NAN;
    return code;
}

double attenuation_reach(const trial *t, const setup *at)
{
    const vec3 a = material_absorption(&t->s->solids[at->liquid].surface);
    const double most = fmax(a.x, fmax(a.y, a.z)) * t->s->render.unit_m;
    return fmin(0.95 * t->s->solids[at->liquid].shape.radius, 20.0 / most); /* stays in the liquid, above exp(-20) */
}

/* Slopes of the least squares lines through the points (length, -ln transmittance). */
static status fit_slopes(const metrics *m, trial *t, double reach, double slope[3], double off[3], diagnostic *why)
{
    double mean_x = 0.0, xx = 0.0, x[LENGTHS], y[3][LENGTHS];
    status code = STATUS_OK;
    for (int i = 0; i < LENGTHS && code == STATUS_OK; i++) {
        double through_length[3] = {NAN, NAN, NAN};
        x[i] = reach * (i + 1) / LENGTHS;
        code = attenuation_point(t, &m->at, x[i], through_length, why);
        x[i] *= t->s->render.unit_m;
        mean_x += x[i] / LENGTHS;
        for (int c = 0; c < 3; c++)
            y[c][i] = -log(through_length[c]);
    }
    if (code != STATUS_OK)
        return code;
    slope[0] = slope[1] = slope[2] = off[0] = off[1] = off[2] = 0.0;
    for (int i = 0; i < LENGTHS; i++) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        for (int c = 0; c < 3; c++) {
            slope[c] += (x[i] - mean_x) * y[c][i];
            /* errors of exp and log, and of their arguments */
            off[c] += fabs(x[i] - mean_x) * bound_difference(BOUND_FORM) * (1.0 + 2.0 * fabs(y[c][i]));
        }
    }
    for (int c = 0; c < 3; c++) {
        slope[c] /= xx;
        off[c] = off[c] / xx + bound_gamma(BOUND_FORM) * fabs(slope[c]);
    }
    return STATUS_OK;
}

static status compare_slopes(const metrics *m, worst_pair *worst, diagnostic *why)
{
    scene *supposed = attenuation_scene(m->supposed, &m->theory_at);
    if (!supposed)
        return out_of_memory(why);
    const vec3 a = material_absorption(&supposed->solids[m->theory_at.liquid].surface);
    scene_destroy(supposed);
    const double theory[3] = {a.x, a.y, a.z};
    double slope[3] = {NAN, NAN, NAN}, off[3] = {NAN, NAN, NAN};
    trial t;
    status code = trial_start(&t, attenuation_scene(m->traced, &m->at), m->level, why);
    if (code == STATUS_OK) {
        code = fit_slopes(m, &t, attenuation_reach(&t, &m->at), slope, off, why);
        for (int c = 0; c < 3; c++)
            worst_pair_add(worst, slope[c], theory[c], off[c]);
    }
    trial_end(&t);
    return code;
}

status realism_absorption(const metrics *m, diagnostic *why)
{
    worst_pair worst = WORST_NONE;
    const bool exists = m->theory_at.liquid >= 0 && m->at.liquid >= 0;
    const status code = exists ? compare_slopes(m, &worst, why) : STATUS_OK;
    metrics_add(m, (realism_value){
                       "absorption.slope",
                       exists ? "slope of -ln(transmittance) over length in the liquid; largest error of three channels"
                              : "there is no liquid",
                       "1/m", worst.measured, worst.theory, worst.tolerance});
    return code;
}
