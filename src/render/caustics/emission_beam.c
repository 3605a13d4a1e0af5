/* Beams as lamps: photons start as the beam's rays do, with its power over their number. */
#include "render/caustics/emission_parts.h"

#include "base/elementary.h"
#include "base/lanes.h"
#include "optics/spectrum.h"

#define PI 3.14159265358979323846

static double log_of(double u)
{
    return 0.69314718055994530942 * elementary_log2_inline(u);
}

static vec3 color_of(const beam *b)
{
    double rgb[3];
    if (b->white)
        return vec3_make(1.0, 1.0, 1.0);
    lamp_rgb(LAMP_LINE, 0.0, b->lambda_nm, rgb);
    return vec3_make(rgb[0], rgb[1], rgb[2]);
}

/* A photon's flux is its power over pi; that of a lamp of intensity and reach 1 into 2 pi is 2 pi (emission_aim.c). */
status emission_prepare_beams(emission *e, diagnostic *why)
{
    for (int k = 0; k < e->p->beam_count; k++) {
        const beam *b = &e->p->beams[k];
        const bool is_flat = b->kind == BEAM_FAN || b->kind == BEAM_SHEET;
        const bool has_normal = is_flat && vec3_dot(b->normal, b->normal) > 0.0;
        TRY(ray_axes_set(&e->beams[k].axes, b->position, beam_axis(b), has_normal ? &b->normal : NULL, why));
        const vec3 color = e->beams[k].color = color_of(b);
        e->beams[k].flux = b->power * fmax(color.x, fmax(color.y, color.z)) / (2.0 * PI * PI);
        e->extent = fmax(e->extent, beam_is_parallel(b) ? 0.5 * b->width : e->p->geometry->extent);
    }
    return STATUS_OK;
}

/* Of a disc of radius 1: 1 - exp(-2 r^2 / w^2) of a Gaussian beam's power is within r (Siegman, Lasers, 1986, 17.1);
 * with r^2 / w^2 = -log(u) / 2, u is the share outside. */
static double radius_of(const beam *b, double u)
{
    return b->profile == BEAM_GAUSSIAN ? sqrt(-0.5 * log_of(u)) : sqrt(u);
}

/* Of a line from -1 to 1: exp(-2 x^2 / w^2) is a normal distribution of variance w^2 / 4 (Box and Muller, Ann. Math.
 * Stat. 29, 1958). */
static double offset_of(const beam *b, unit_pair s)
{
    double sine, cosine;
    if (b->profile == BEAM_UNIFORM)
        return 2.0 * s.u - 1.0;
    elementary_sincos_deg(360.0 * s.v, &sine, &cosine);
    return 0.5 * sqrt(-2.0 * log_of(s.u)) * cosine;
}

/* A direction at an angle whose tangent is given, towards `side`. */
static vec3 inclined(const ray_axes *a, vec3 side, double tangent)
{
    return vec3_normalize(vec3_add(a->axis, vec3_scale(side, tangent)));
}

/* Over a disc, or within a cone: even in solid angle, or Gaussian in every plane across the axis. */
static void start_round(const beam *b, const ray_axes *a, unit_pair s, emitted_ray *out)
{
    double sine, cosine, half_sine, half_cosine;
    elementary_sincos_deg(360.0 * s.v, &sine, &cosine);
    const vec3 radial = vec3_add(vec3_scale(a->across, cosine), vec3_scale(a->normal, sine));
    if (b->kind == BEAM_BUNDLE) {
        out->origin = vec3_add(a->from, vec3_scale(radial, 0.5 * b->width * radius_of(b, s.u)));
        return;
    }
    if (b->profile == BEAM_GAUSSIAN) {
        elementary_sincos_deg(0.5 * b->angle_deg, &half_sine, &half_cosine);
        out->direction = inclined(a, radial, half_sine / half_cosine * radius_of(b, s.u));
        return;
    }
    elementary_sincos_deg(0.25 * b->angle_deg, &half_sine, &half_cosine);
    const double versine = 2.0 * half_sine * half_sine * s.u; /* as ray_axes_round */
    out->direction = vec3_add(vec3_scale(a->axis, 1.0 - versine), vec3_scale(radial, sqrt(versine * (2.0 - versine))));
}

/* In a plane: even in offset or angle, or Gaussian in every line across the axis. */
static void start_in_plane(const beam *b, const ray_axes *a, unit_pair s, emitted_ray *out)
{
    double sine, cosine;
    const double offset = offset_of(b, s);
    if (b->kind == BEAM_SHEET) {
        out->origin = vec3_add(a->from, vec3_scale(a->across, 0.5 * b->width * offset));
        return;
    }
    elementary_sincos_deg(0.5 * b->angle_deg * (b->profile == BEAM_GAUSSIAN ? 1.0 : offset), &sine, &cosine);
    out->direction = inclined(a, a->across, sine / cosine * (b->profile == BEAM_GAUSSIAN ? offset : 1.0));
}

/* In a spectral film: of white, of a random wavelength; else of the line, as of a lamp of that line. Radiance there for
 * a power of 1. */
static double wavelength_of(const emission *e, const beam *b, double u, emitted_ray *out)
{
    const light lamp = {.spectrum = LAMP_LINE, .line_nm = b->lambda_nm, .intensity = 1.0};
    lamp_line lines[LAMP_LINES_MAX];
    out->of_line = !b->white;
    if (b->white) {
        out->wavelength = (int)(u * SPECTRA_COUNT);
        return spectra_row(e->p->spectral, sample_key_with_wavelength(0, out->wavelength))->basis[SKY_BASIS_WHITE];
    }
    spectral_lines_of(&lamp, lines);
    out->wavelength = lines[0].wavelength;
    return lines[0].radiance / SPECTRA_COUNT;
}

bool emission_beam_ray(const emission *e, int64_t i, emitted_ray *out)
{
    const plan *p = e->p;
    int k = p->beam_count - 1;
    while (k > 0 && i < e->beams[k].first)
        k--;
    const beam *b = &p->beams[k];
    const beam_emission *from = &e->beams[k];
    const uint64_t source = (uint64_t)(p->light_count + k) << 8;
    const int64_t number = i - from->first;
    const unit_pair s = emission_pair(e, number, source);
    *out = (emitted_ray){.origin = from->axes.from,
                         .direction = from->axes.axis,
                         .wavelength = -1,
                         .of_beam = true,
                         .falls = true,
                         .target = p->light_count * e->ball_count + k};
    if (b->kind == BEAM_FAN || b->kind == BEAM_SHEET)
        start_in_plane(b, &from->axes, s, out);
    else
        start_round(b, &from->axes, s, out);
    out->inside = scene_geometry_inside(p->geometry, out->origin);
    vec3 color = from->color;
    if (p->spectral) {
        const double radiance = wavelength_of(e, b, emission_pair(e, number, source | 1).u, out);
        color = vec3_make(radiance, radiance, radiance);
    }
    out->power = vec3_scale(color, b->power / (PI * (double)from->count));
    return !p->geometry->regions[scene_geometry_priority_index(p->geometry, out->inside)].opaque;
}
