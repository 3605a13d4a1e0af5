/* Malus's law: two ideal linear polarisers across the line of sight, solids named polariser and analyser, and perhaps a
 * wave plate between them, a box named plate (experiments/scenes/malus.yaml). The analyser is turned about z, and the
 * camera's central ray looks through all at a white sky. */
#include "realism/metrics.h"

#include "realism/theory.h"
#include "scene/model/scene.h"
#include "scene/model/medium.h"
#include <math.h>
#include <string.h>

#define DEGREE (M_PI / 180.0)

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
                        "give both sheet polariser, sheet_pass 1, sheet_block 0, transparency 1, and an axis across z",
                        "'polariser' and 'analyser' are not ideal linear polarisers across the line of sight");
    out->polariser_at = axis_at(first), out->analyser_at = axis_at(last);
    if (!is_there(s, "plate"))
        return STATUS_OK;
    const solid *plate = &s->solids[scene_find_solid(s, "plate")];
    if (!is_flat_on(plate) || plate->shape.kind != SHAPE_BOX || plate->surface.sheet != SHEET_RETARDER ||
        plate->surface.transparency != 1.0)
        return diagnose(why, STATUS_BAD_INPUT, "make it a box with sheet retarder, transparency 1 and an axis across z",
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
static status look_through(const metrics *m, const scene *turned, double *radiance, diagnostic *why)
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
        THEN(code, look_through(m, turned, &radiance, why));
        if (code == STATUS_OK)
            curve_add(out, 2.0 * i, radiance, theory_of(&supposed));
    }
    scene_destroy(turned);
    return code;
}
