/* Parallel layers across the line of sight: polarisers, a stack of plates, a thin layer. */
#include "realism/metrics.h"

#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>
#include <string.h>

/* --- polarisers --- */

/* Malus's law: two ideal linear polarisers across the line of sight, solids named polariser and analyser, and perhaps a
 * wave plate between them, a box named plate (experiments/scenes/malus.yaml). The analyser is turned about z, and a
 * ray along z from the camera's position passes through all of them to a white sky. */

typedef struct filters {
    int analyser;
    double polariser_at, analyser_at, plate_at; /* angles of the axes in the plane across z */
    double retardance;                          /* 0 without a plate */
    bool polarised;
} filters;

static bool is_there(const scene *s, const char *name)
{
    const int at = scene_find_solid(s, name);
    return at >= 0 && s->solids[at].visible;
}

bool filters_are_there(const scene *s)
{
    return is_there(s, "polariser") && is_there(s, "analyser");
}

static double axis_at(const solid *one)
{
    const vec3 axis = mat3_apply(rotation_from_deg(one->shape.rotation_deg), one->surface.sheet_axis);
    return atan2(axis.y, axis.x);
}

static bool is_flat_on(const solid *one)
{
    return one->shape.rotation_deg.x == 0.0 && one->shape.rotation_deg.y == 0.0 && one->surface.sheet_axis.z == 0.0;
}

static bool is_ideal(const solid *one)
{
    const material *m = &one->surface;
    return is_flat_on(one) && m->sheet == SHEET_POLARISER && m->sheet_pass == 1.0 && m->sheet_block == 0.0 &&
           m->transparency == 1.0;
}

static status filters_read(const scene *s, filters *out, diagnostic *why)
{
    const solid *first = &s->solids[scene_find_solid(s, "polariser")], *last;
    *out = (filters){.analyser = scene_find_solid(s, "analyser"), .polarised = s->render.polarisation != 0};
    last = &s->solids[out->analyser];
    if (!is_ideal(first) || !is_ideal(last))
        return diagnose(why, STATUS_BAD_INPUT,
                        "set both to sheet polariser, sheet_pass 1, sheet_block 0, transparency 1, an axis across z, "
                        "and no rotation about x and y",
                        "'polariser' and 'analyser' are not ideal linear polarisers across the line of sight");
    out->polariser_at = axis_at(first), out->analyser_at = axis_at(last);
    if (!is_there(s, "plate"))
        return STATUS_OK;
    const solid *plate = &s->solids[scene_find_solid(s, "plate")];
    if (!is_flat_on(plate) || plate->shape.kind != SHAPE_BOX || plate->surface.sheet != SHEET_RETARDER ||
        plate->surface.transparency != 1.0)
        return diagnose(why, STATUS_BAD_INPUT,
                        "make it a box with sheet retarder, transparency 1, an axis across z, and no rotation about x "
                        "and y",
                        "'plate' is not a wave plate across the line of sight");
    out->plate_at = axis_at(plate);
    out->retardance = plate->surface.retardance_deg * DEGREE + 2.0 * M_PI * plate->surface.birefringence *
                                                                   plate->shape.size.z * s->render.unit_m /
                                                                   (s->render.lambda_nm * 1e-9);
    return STATUS_OK;
}

/* Without polarisation each filter is grey and transmits a half. */
static double theory_of(const filters *f)
{
    return f->polarised ? theory_crossed(f->analyser_at - f->polariser_at, f->plate_at - f->polariser_at, f->retardance)
                        : 0.25;
}

static bool is_filter(const solid *one)
{
    return strcmp(one->name, "polariser") == 0 || strcmp(one->name, "analyser") == 0 || strcmp(one->name, "plate") == 0;
}

/* The radiance of a white sky behind the filters; all else is hidden. */
static status look_through_filters(const metrics *m, const scene *turned, double *radiance, diagnostic *why)
{
    trial t;
    scene *s = scene_clone(turned);
    if (s) {
        s->background.kind = BACKGROUND_UNIFORM;
        s->background.color = vec3_make(1.0, 1.0, 1.0);
        for (size_t i = 0; i < s->solid_count; i++)
            s->solids[i].visible &= is_filter(&s->solids[i]);
    }
    status code = trial_start(&t, s, m->level, why);
    if (code == STATUS_OK)
        code = probe_ray(t.p, s->camera.position, vec3_make(0.0, 0.0, 1.0), &t.tree, why);
    if (code == STATUS_OK)
        *radiance = t.tree.radiance[0];
    trial_end(&t);
    return code;
}

status filters_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    scene *turned = scene_clone(m->traced);
    status code = turned ? STATUS_OK : out_of_memory(why);
    for (int i = 0; i <= 90 && code == STATUS_OK; i++) {
        filters supposed;
        double radiance = NAN;
        turned->solids[scene_find_solid(turned, "analyser")].shape.rotation_deg = vec3_make(0.0, 0.0, 2.0 * i);
        code = filters_read(turned, &supposed, why);
        THEN(code, look_through_filters(m, turned, &radiance, why));
        if (code == STATUS_OK)
            curve_add(out, 2.0 * i, radiance, theory_of(&supposed));
    }
    scene_destroy(turned);
    return code;
}

/* --- a stack of plates --- */

/* A stack of parallel plates, solids named plate1 and plate2: equal boxes with equal rotation
 * (experiments/scenes/plates.yaml). The transmittance is that of a ray along z from the camera's position, for white
 * light: with polarisation s and p light are transmitted separately, without it every interface uses the mean of both,
 * as most renderers do.
 *
 * Tolerance: the bound of the reflectance at that angle times the derivative with respect to it, and the rounding of
 * the products. The depth limit adds nothing: the closed form counts only the paths up to that depth. */

enum { INTERFACES = 4, STACK_DEPTH = 16 };

bool stack_is_there(const scene *s)
{
    return scene_find_solid(s, "plate1") >= 0 && scene_find_solid(s, "plate2") >= 0;
}

typedef struct stack {
    double angle, n;
    bool polarised;
} stack;

static bool stack_read(const scene *s, stack *out)
{
    const solid *plate = &s->solids[scene_find_solid(s, "plate1")];
    const vec3 normal = mat3_apply(rotation_from_deg(plate->shape.rotation_deg), vec3_make(0.0, 0.0, 1.0));
    *out = (stack){.angle = acos(fmin(fabs(normal.z), 1.0)),
                   .polarised = s->render.polarisation != 0,
                   .n = relative_index(s, scene_find_solid(s, "plate1"), s->render.lambda_nm)};
    return !isnan(out->n) && s->solids[scene_find_solid(s, "plate2")].surface.transparency == 1.0 &&
           plate->surface.transparency == 1.0;
}

static double through_to_depth(double R)
{
    return theory_pile(R, INTERFACES, STACK_DEPTH);
}

static double straight_through(double R)
{
    return pow(1.0 - R, INTERFACES);
}

static double polarised_mean(const stack *s, double (*through)(double R))
{
    const double R_s = theory_fresnel_s(s->angle, 1.0, s->n), R_p = theory_fresnel_p(s->angle, 1.0, s->n);
    return s->polarised ? 0.5 * (through(R_s) + through(R_p)) : through(0.5 * (R_s + R_p));
}

/* The bound of R times the derivative of the transmittance with respect to R, at the R that are used. */
static double stack_tolerance(const stack *s, double (*through)(double R), int interfaces)
{
    const reflectance_bound off = bound_reflectances(s->angle, bound_difference(BOUND_TURN), 1.0, s->n);
    const double R_s = theory_fresnel_s(s->angle, 1.0, s->n), R_p = theory_fresnel_p(s->angle, 1.0, s->n), step = 1e-6,
                 R[] = {R_s, R_p, 0.5 * (R_s + R_p)}, R_bound[] = {off.R_s, off.R_p, off.R};
    double most = 0.0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, R_bound[i] * fabs(through(R[i] + step) - through(R[i] - step)) / (2.0 * step));
    return most + bound_difference(BOUND_FORM * interfaces);
}

/* Sums the throughput of rays that end in the sky or on a board in the direction of view: parallel faces do not change
 * directions. */
static double sum_throughput(const ray_tree *tree, vec3 forward)
{
    double through = 0.0;
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *n = &tree->node[i];
        if ((n->end == RAY_END_SKY || (n->end == RAY_END_HIT && n->hit.opaque)) &&
            vec3_dot(n->direction, forward) > 1.0 - 1e-9)
            through += n->throughput[0];
    }
    return through;
}

static status look_through_stack(const metrics *m, double *straight, double *total, diagnostic *why)
{
    trial t;
    scene *s = scene_clone(m->traced);
    if (s) {
        arrange_bare(s);
        s->render.depth = STACK_DEPTH;
        s->render.min_weight = 0.0;
    }
    status code = trial_start(&t, s, m->level, why);
    const vec3 eye = m->traced->camera.position, forward = vec3_make(0.0, 0.0, 1.0);
    THEN(code, probe_path(t.p, eye, forward, -1, &t.tree, why));
    if (code == STATUS_OK) {
        const ray_node *last = &t.tree.node[t.tree.count - 1];
        *straight = t.tree.count == INTERFACES + 1 && (last->end == RAY_END_SKY || last->hit.opaque)
                        ? last->throughput[0]
                        : NAN;
        code = probe_ray(t.p, eye, forward, &t.tree, why);
    }
    if (code == STATUS_OK)
        *total = sum_throughput(&t.tree, forward);
    trial_end(&t);
    return code;
}

static status opaque_plates(diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "make both plates transparent: transparency 1",
                    "the plates of the stack are not transparent");
}

status realism_stack(const metrics *m, diagnostic *why)
{
    stack supposed;
    if (!stack_read(m->supposed, &supposed))
        return opaque_plates(why);
    double straight, total;
    TRY(look_through_stack(m, &straight, &total, why));
    metrics_add(m, (realism_value){"stack.straight", "transmittance of four interfaces without reflections", "",
                                   straight, polarised_mean(&supposed, straight_through),
                                   stack_tolerance(&supposed, straight_through, INTERFACES)});
    metrics_add(m,
                (realism_value){"stack.whole", "transmittance with the reflections of paths with up to 16 interfaces",
                                "", total, polarised_mean(&supposed, through_to_depth),
                                stack_tolerance(&supposed, through_to_depth, STACK_DEPTH)});
    return STATUS_OK;
}

/* The plates are rotated about y; their distance in the scene must leave room for that. */
status stack_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    scene *turned = scene_clone(m->traced);
    status code = turned ? STATUS_OK : out_of_memory(why);
    const metrics at = {.traced = turned, .supposed = turned, .level = m->level};
    for (int i = 0; i <= 85 && code == STATUS_OK; i++) {
        static const char *const plates[] = {"plate1", "plate2"};
        stack supposed;
        double straight = NAN, total;
        for (int k = 0; k < 2; k++)
            turned->solids[scene_find_solid(turned, plates[k])].shape.rotation_deg = vec3_make(0.0, i, 0.0);
        if (!stack_read(turned, &supposed))
            code = opaque_plates(why);
        THEN(code, look_through_stack(&at, &straight, &total, why));
        if (code == STATUS_OK)
            curve_add(out, i, straight, polarised_mean(&supposed, straight_through));
    }
    scene_destroy(turned);
    return code;
}

/* --- a thin film --- */

/* Interference in a thin film: the solid named film1, a box with a film on it (experiments/scenes/soap.yaml), in the
 * camera's direction of view. Its reflectance at render.lambda_nm is measured for films of many thicknesses. */

bool soap_is_there(const scene *s)
{
    const int at = scene_find_solid(s, "film1");
    return at >= 0 && s->solids[at].visible && s->solids[at].shape.kind == SHAPE_BOX &&
           s->solids[at].surface.film_thickness_nm > 0.0;
}

/* A copy in which only film1 is visible. */
static scene *film_scene(const scene *s, int film, double thickness_nm)
{
    scene *copy = scene_clone(s);
    for (size_t i = 0; copy && i < copy->solid_count; i++)
        copy->solids[i].visible = (int)i == film;
    if (copy) {
        copy->solids[film].surface.film_thickness_nm = thickness_nm;
        copy->render.spectrum = SPECTRUM_SPECTRAL; /* an rgb film has a table of colours, which is not read here */
        copy->render.wavelengths = 1;
    }
    return copy;
}

status soap_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    const scene *s = m->traced;
    const int film = scene_find_solid(s, "film1");
    const solid *one = &s->solids[film];
    const vec3 ahead = vec3_normalize(vec3_sub(s->camera.target, s->camera.position)),
               normal = mat3_apply(rotation_from_deg(one->shape.rotation_deg), vec3_make(0.0, 0.0, 1.0));
    const index_law around = surrounding_index_law(&s->background);
    const double n = index_law_at(&around, s->render.lambda_nm), facing = vec3_dot(ahead, normal),
                 behind = n * relative_index(s, film, s->render.lambda_nm), angle = acos(fmin(fabs(facing), 1.0));
    const vec3 face = vec3_sub(one->shape.position, vec3_scale(normal, copysign(0.5 * one->shape.size.z, facing)));
    status code = STATUS_OK;
    for (int i = 1; i <= 200 && code == STATUS_OK; i++) {
        const double thickness_nm = 5.0 * i;
        trial t;
        code = trial_start(&t, film_scene(s, film, thickness_nm), m->level, why);
        THEN(code, probe_path(t.p, vec3_sub(face, vec3_scale(ahead, 2.0)), ahead, -1, &t.tree, why));
        if (code == STATUS_OK)
            curve_add(out, thickness_nm, t.tree.node[0].hit.R,
                      theory_film(angle, n, one->surface.film_ior, behind, thickness_nm / s->render.lambda_nm));
        trial_end(&t);
    }
    return code;
}
