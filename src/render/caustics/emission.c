/* The first rays of photons, from lamps and beams: their densities and their power. */
#include "render/caustics/emission.h"

#include "base/elementary.h"
#include "base/lanes.h"
#include "render/shade/polarisation.h"

#define PI 3.14159265358979323846

static int lamp_of(const emission *e, int64_t i)
{
    int low = 0, high = e->p->light_count - 1;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (e->lamps[middle].first <= i)
            low = middle;
        else
            high = middle - 1;
    }
    while (e->lamps[low].count == 0) /* lamps without photons begin where the next one does */
        low--;
    return low;
}

static vec3 along(vec3 axis, double cosine, double sine, double turn)
{
    vec3 u, v;
    double s, c;
    polarisation_frame(axis, &u, &v);
    elementary_sincos_deg(360.0 * turn, &s, &c);
    return vec3_add(vec3_scale(axis, cosine), vec3_add(vec3_scale(u, sine * c), vec3_scale(v, sine * s)));
}

static double off_axis(vec3 direction, vec3 axis)
{
    const vec3 off = vec3_sub(direction, axis);
    return 0.5 * vec3_dot(off, off);
}

static vec3 lamp_at(const emission *e, int lamp)
{
    return e->p->lights[lamp].position;
}

/* Whether the rays of a lamp's cone are drawn through the ball's disc, not the lamp's. */
static bool through_ball(const emission *e, int lamp, int k)
{
    return e->balls[k].radius < sphere_radius(e, lamp);
}

/* A point on a disc of that radius, perpendicular to a direction. */
static vec3 on_disc(vec3 centre, double radius, vec3 direction, unit_pair s)
{
    return vec3_add(centre, along(direction, 0.0, radius * sqrt(s.u), s.v));
}

/* The squared distance of a point from a line. */
static double off_line(vec3 point, vec3 direction, vec3 from)
{
    const vec3 off = vec3_cross(vec3_sub(from, point), direction);
    return vec3_dot(off, off);
}

/* The density of rays along a direction through a point, drawn from cone `drawn`, per solid angle and perpendicular
 * area; per solid angle for a point lamp. */
static double density_of(const emission *e, int lamp, int drawn, vec3 direction, vec3 point)
{
    const lamp_emission *l = &e->lamps[lamp];
    const double radius = sphere_radius(e, lamp), area = radius > 0.0 ? PI * radius * radius : 1.0;
    double density = 0.0;
    for (int k = 0; k < e->ball_count; k++) {
        const ball *b = &e->balls[k];
        const bool from_ball = through_ball(e, lamp, k);
        if (l->cones[k].fraction == 0.0)
            continue;
        const bool meets =
            k == drawn || (off_axis(direction, l->cones[k].axis) <= l->cones[k].cap &&
                           (!from_ball || off_line(point, direction, b->centre) <= b->radius * b->radius));
        if (meets)
            density +=
                l->cones[k].fraction / (2.0 * PI * l->cones[k].cap) / (from_ball ? PI * b->radius * b->radius : area);
    }
    return density;
}

/* Moves the point along its ray to where the ray leaves the lamp's sphere; false if the ray misses the sphere. */
static bool to_lamp(const emission *e, int lamp, vec3 direction, vec3 *point)
{
    const double radius = sphere_radius(e, lamp),
                 half = radius * radius - off_line(*point, direction, lamp_at(e, lamp));
    if (!(half > 0.0))
        return false;
    const double back = vec3_dot(vec3_sub(lamp_at(e, lamp), *point), direction) + sqrt(half);
    *point = vec3_add(*point, vec3_scale(direction, back));
    return true;
}

/* The density of a sun's rays along a direction through a point, per perpendicular area, drawn for solid `drawn`. */
static double sun_density(const emission *e, int lamp, int drawn, vec3 direction, vec3 point)
{
    double density = 0.0;
    for (int k = 0; k < e->ball_count; k++) {
        const sunlit_area a = sunlit_area_of(e, k, direction);
        const vec3 off = vec3_sub(point, a.centre);
        if (k == drawn || (fabs(vec3_dot(off, a.u)) <= a.across && fabs(vec3_dot(off, a.v)) <= a.up))
            density += e->lamps[lamp].cones[k].fraction / (4.0 * a.across * a.up);
    }
    return density;
}

/* Moves the origin back along the ray, far in front of all bounded solids; false within an opaque unbounded solid. */
static bool before_all(const emission *e, vec3 direction, emitted_ray *out)
{
    const scene_geometry *g = e->p->geometry;
    out->origin = vec3_sub(out->origin, vec3_scale(direction, sun_path(e)));
    out->inside = scene_geometry_inside(g, out->origin);
    return !g->regions[scene_geometry_priority_index(g, out->inside)].opaque;
}

/* Draws a sun's ray through the area of solid k; out has its direction. Returns 1 / (the ray's density per area), times
 * a factor for the sun's size: pi L dw over the density of directions, relative to parallel light, which is 2 (1 - cos
 * a) / sin^2 a = 2 / (1 + cos a). */
static double draw_sun_ray(const emission *e, int lamp, int k, unit_pair place, emitted_ray *out)
{
    const sunlit_area a = sunlit_area_of(e, k, out->direction);
    out->origin = vec3_add(a.centre, vec3_add(vec3_scale(a.u, a.across * (2.0 * place.u - 1.0)),
                                              vec3_scale(a.v, a.up * (2.0 * place.v - 1.0))));
    const double density = sun_density(e, lamp, k, out->direction, out->origin);
    return before_all(e, out->direction, out) ? 2.0 / ((2.0 - e->lamps[lamp].cones[k].cap) * density) : 0.0;
}

/* Chooses a cone by *u in (0, 1), which then becomes the position within the cone's fraction. */
static int choose_cone(const emission *e, int lamp, double *u)
{
    const cone *cones = e->lamps[lamp].cones;
    int k = 0, last = e->ball_count - 1;
    while (last > 0 && cones[last].fraction == 0.0)
        last--;
    while (k < last && *u >= cones[k].fraction)
        *u -= cones[k++].fraction;
    return k;
}

/* Draws a ray. Returns 1 / (its density * the area of the lamp's disc), without the area for a lamp that is no sphere;
 * 0 if it does not leave the lamp. s.u also chooses the cone. */
static double draw_ray(const emission *e, int lamp, unit_pair s, unit_pair place, emitted_ray *out)
{
    const lamp_emission *l = &e->lamps[lamp];
    const double radius = sphere_radius(e, lamp);
    const int k = choose_cone(e, lamp, &s.u);
    out->target = lamp * e->ball_count + k;
    const cone *c = &l->cones[k];
    const double off = c->cap * fmin(s.u / c->fraction, 1.0);
    out->direction = along(c->axis, 1.0 - off, sqrt(off * (2.0 - off)), s.v);
    out->origin = lamp_at(e, lamp);
    out->inside = l->inside;
    if (is_sun(e, lamp))
        return draw_sun_ray(e, lamp, k, place, out);
    if (is_flat(e, lamp)) /* a uniform point of the lamp; light_fraction applies Lambert's law */
        out->origin = lamp_shape_point(&e->p->shapes[lamp], out->origin, place.u, place.v);
    if (radius == 0.0)
        return 1.0 / density_of(e, lamp, k, out->direction, out->origin);
    const bool from_ball = through_ball(e, lamp, k);
    out->origin = on_disc(from_ball ? e->balls[k].centre : lamp_at(e, lamp), from_ball ? e->balls[k].radius : radius,
                          out->direction, place);
    const double density = density_of(e, lamp, k, out->direction, out->origin);
    return to_lamp(e, lamp, out->direction, &out->origin) ? 1.0 / (density * PI * radius * radius) : 0.0;
}

/* The radiance at a random wavelength of the lamp, divided by the density of the choice relative to a uniform one.
 * Lines are chosen by their brightness. */
static double draw_wavelength(const emission *e, int lamp, double u, emitted_ray *out)
{
    lamp_line lines[LAMP_LINES_MAX];
    const int count = spectral_lines_of(&e->p->lights[lamp], lines);
    double all = 0.0;
    out->of_line = count > 0;
    if (count == 0) {
        out->wavelength = (int)(u * SPECTRA_COUNT);
        return spectra_light(e->p->spectral, sample_key_with_wavelength(0, out->wavelength), lamp);
    }
    for (int k = 0; k < count; k++)
        all += lines[k].bright;
    int k = 0;
    for (double left = u * all; k + 1 < count && left >= lines[k].bright; k++)
        left -= lines[k].bright;
    out->wavelength = lines[k].wavelength;
    return all > 0.0 ? lines[k].radiance / SPECTRA_COUNT * (all / lines[k].bright) : 0.0;
}

/* --- beams as lamps: photons start as the beam's rays do, with the beam's power divided by their number --- */

static double log_of(double u)
{
    return 0.69314718055994530942 * elementary_log2_inline(u);
}

/* The radius of a sample in a disc of radius 1: 1 - exp(-2 r^2 / w^2) of a Gaussian beam's power is within r (Siegman,
 * Lasers, 1986, 17.1); with r^2 / w^2 = -log(u) / 2, u is the fraction outside. */
static double radius_of(const beam *b, double u)
{
    return b->profile == BEAM_GAUSSIAN ? sqrt(-0.5 * log_of(u)) : sqrt(u);
}

/* The offset of a sample on a line from -1 to 1: exp(-2 x^2 / w^2) is a normal distribution of variance w^2 / 4 (Box
 * and Muller, Ann. Math. Stat. 29, 1958). */
static double offset_of(const beam *b, unit_pair s)
{
    double sine, cosine;
    if (b->profile == BEAM_UNIFORM)
        return 2.0 * s.u - 1.0;
    elementary_sincos_deg(360.0 * s.v, &sine, &cosine);
    return 0.5 * sqrt(-2.0 * log_of(s.u)) * cosine;
}

/* The direction at an angle to the axis, given by its tangent, towards `side`. */
static vec3 inclined(const ray_axes *a, vec3 side, double tangent)
{
    return vec3_normalize(vec3_add(a->axis, vec3_scale(side, tangent)));
}

/* Samples the disc of a bundle, uniform in area, or a cone, uniform in solid angle; or either with a profile that is
 * Gaussian in every plane across the axis. */
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

/* Samples a ray of a planar beam (sheet or fan): uniform in offset or angle, or Gaussian on every line across the
 * axis. */
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

/* Sets the wavelength in a spectral film: random for white light, else the line's. Returns the radiance there for a
 * power of 1. */
static double beam_wavelength(const emission *e, const beam *b, double u, emitted_ray *out)
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

static bool emission_beam_ray(const emission *e, int64_t i, emitted_ray *out)
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
    if (beam_is_flat(b))
        start_in_plane(b, &from->axes, s, out);
    else
        start_round(b, &from->axes, s, out);
    out->inside = scene_geometry_inside(p->geometry, out->origin);
    vec3 color = from->color;
    if (p->spectral) {
        const double radiance = beam_wavelength(e, b, emission_pair(e, number, source | 1).u, out);
        color = vec3_make(radiance, radiance, radiance);
    }
    out->power = vec3_scale(color, b->power / (PI * (double)from->count));
    return !p->geometry->regions[scene_geometry_priority_index(p->geometry, out->inside)].opaque;
}

/* --- a photon --- */

bool emission_ray(const emission *e, int64_t i, emitted_ray *out)
{
    const plan *p = e->p;
    if (p->beam_count > 0 && i >= e->beams[0].first)
        return emission_beam_ray(e, i, out);
    const int lamp = lamp_of(e, i);
    const light *l = &p->lights[lamp];
    const lamp_emission *from = &e->lamps[lamp];
    const bool sun = is_sun(e, lamp); /* parallel light, whose flux does not fall off */
    const int64_t number = i - from->first;
    const double angle = draw_ray(e, lamp, emission_pair(e, number, (uint64_t)lamp << 8),
                                  emission_pair(e, number, (uint64_t)lamp << 8 | 1), out);
    const double fraction = light_fraction(l, &p->cones[lamp], out->direction);
    if (fraction == 0.0 || angle == 0.0)
        return false;
    out->lamp_radius = sun                ? sun_path(e) * sqrt(from->cones[0].cap * (2.0 - from->cones[0].cap))
                       : is_flat(e, lamp) ? sqrt(p->shapes[lamp].area / PI)
                                          : sphere_radius(e, lamp);
    const bool polarised = p->render.polarisation && l->polarised > 0.0;
    const stokes s = polarised ? lamp_stokes(p, lamp, out->direction, out->direction) : (stokes){1.0, 0.0, 0.0, 0.0};
    out->q = s.q, out->u = s.u;
    out->of_beam = false;
    out->falls = sun || l->reach > 0.0;
    out->wavelength = -1;
    vec3 color = vec3_scale(l->color, l->intensity);
    out->of_line = false;
    if (p->spectral) {
        const double radiance = draw_wavelength(e, lamp, emission_pair(e, number, (uint64_t)lamp << 8 | 2).u, out);
        color = vec3_make(radiance, radiance, radiance);
    }
    out->power =
        vec3_scale(color, fraction * (l->reach > 0.0 ? l->reach * l->reach : 1.0) * angle / (double)from->count);
    return true;
}

static random_words words(const emission *e, int64_t i, int depth, int purpose)
{
    return random_at((uint64_t)e->p->render.seed, (uint32_t)i, (uint32_t)(i >> 32), (uint32_t)depth, (uint32_t)purpose);
}

double emission_chance(const emission *e, int64_t i, int depth, int which)
{
    return random_unit(words(e, i, depth, DRAW_PHOTON + which).word[0]);
}

static unit_pair two(random_words w)
{
    return (unit_pair){random_unit(w.word[0]), random_unit(w.word[1])};
}

unit_pair emission_roulette(const emission *e, int64_t i, int depth)
{
    return two(words(e, i, depth, DRAW_PHOTON_END));
}

unit_pair emission_facet(const emission *e, int64_t i, int depth)
{
    return two(words(e, i, depth, DRAW_FACET));
}

unit_pair emission_further(const emission *e, int64_t i, int depth, double *chance)
{
    const random_words w = words(e, i, depth, DRAW_FURTHER);
    *chance = random_unit(w.word[2]);
    return two(w);
}
