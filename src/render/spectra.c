#include "render/spectra.h"

#include "base/random.h"
#include "render/draw.h"
#include "render/sky.h"
#include "render/ticket.h"
#include <stdlib.h>

static lifted lift_light(vec3 color, double intensity)
{
    return lift_emission((const double[3]){color.x * intensity, color.y * intensity, color.z * intensity});
}

static lifted lift_surface(vec3 color)
{
    return lift_reflectance((const double[3]){color.x, color.y, color.z});
}

spectra *spectra_create(const scene *s, const material *const *materials, size_t ranks)
{
    static const double basis[SKY_BASIS_COUNT][3] = {{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    spectra *p = calloc(1, sizeof *p);
    if (!p)
        return NULL;
    p->color = calloc(ranks, sizeof *p->color);
    p->checker_color = calloc(ranks, sizeof *p->checker_color);
    p->light = calloc(s->light_count + 1, sizeof *p->light);
    if (!p->color || !p->checker_color || !p->light) {
        spectra_destroy(p);
        return NULL;
    }
    for (size_t r = 1; r < ranks; r++) {
        p->color[r] = lift_surface(materials[r]->color);
        p->checker_color[r] = lift_surface(materials[r]->checker_color);
    }
    for (size_t i = 0; i < s->light_count; i++)
        p->light[i] = lift_light(s->lights[i].color, s->lights[i].intensity);
    p->sky = lift_light(s->background.color, 1.0);
    p->horizon = lift_light(s->background.horizon, 1.0);
    p->ambient = lift_light(s->background.ambient, 1.0);
    for (size_t i = 0; i < SKY_BASIS_COUNT; i++)
        p->basis[i] = lift_emission(basis[i]);
    return p;
}

void spectra_destroy(spectra *p)
{
    if (!p)
        return;
    free(p->color);
    free(p->checker_color);
    free(p->light);
    free(p);
}

double spectra_lambda(const render_settings *render, int64_t ticket)
{
    const int64_t count = render->integrator == INTEGRATOR_PATH ? render->paths : render->wavelengths;
    const int64_t sample = ticket_sample(ticket);
    const random_words drawn = draw(render->seed, ticket, 0, DRAW_WAVELENGTH);
    const double place = ((double)(sample % count) + random_unit(drawn.word[0])) / (double)count;
    return OBSERVER_LOW_NM + place * (OBSERVER_HIGH_NM - OBSERVER_LOW_NM);
}

/* A texel as white, the best fitting secondary and the best fitting primary: Smits, "An RGB to Spectrum Conversion for Reflectances",
 * JGT 4(4), 1999, with the basis spectra lifted as all colours here. Linear where the order of the channels stays. */
static double texel_at(const spectra *p, vec3 rgb, double lambda_nm)
{
    const double v[3] = {rgb.x, rgb.y, rgb.z};
    int low = v[0] <= v[1] ? (v[0] <= v[2] ? 0 : 2) : (v[1] <= v[2] ? 1 : 2);
    int high = v[0] > v[1] ? (v[0] > v[2] ? 0 : 2) : (v[1] > v[2] ? 1 : 2);
    if (high == low) /* a grey */
        high = (low + 1) % 3;
    const int middle = 3 - low - high;
    return v[low] * lifted_emission(&p->basis[0], lambda_nm) +
           (v[middle] - v[low]) * lifted_emission(&p->basis[1 + low], lambda_nm) +
           (v[high] - v[middle]) * lifted_emission(&p->basis[4 + high], lambda_nm);
}

double spectra_sky(const spectra *p, const background *sky, vec3 direction, double lambda_nm)
{
    const double up = direction.y > 0.0 ? direction.y : 0.0;
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: break;
    case BACKGROUND_GRADIENT:
        return (1.0 - up) * lifted_emission(&p->horizon, lambda_nm) + up * lifted_emission(&p->sky, lambda_nm);
    case BACKGROUND_PICTURE: return texel_at(p, sky_radiance(sky, direction), lambda_nm);
    }
    return lifted_emission(&p->sky, lambda_nm);
}
