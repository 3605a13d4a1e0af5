/* The CIE standard general sky: parameters of the 15 types, relative luminance, and its mean. */
#include "optics/cie_sky.h"

#include "base/elementary.h"
#include "base/lanes.h"

#define PI 3.14159265358979323846

/* Gradation and indicatrix by group: Darula and Kittler 2002, tables 1 and 2. */
#define I 4.0, -0.70
#define II 1.1, -0.8
#define III 0.0, -1.0
#define IV -1.0, -0.55
#define V -1.0, -0.32
#define VI -1.0, -0.15
#define ROUND_1 0.0, -1.0, 0.0
#define ROUND_2 2.0, -1.5, 0.15
#define ROUND_3 5.0, -2.5, 0.30
#define ROUND_4 10.0, -3.0, 0.45
#define ROUND_5 16.0, -3.0, 0.30
#define ROUND_6 24.0, -2.8, 0.15

cie_sky_type cie_sky_type_of(int type)
{
    static const cie_sky_type types[CIE_SKY_TYPES] = {
        {I, ROUND_1},   /* 1: overcast, with the steep gradation of the CIE standard overcast sky */
        {I, ROUND_2},   /* 2: overcast, steep gradation, slightly brighter towards the sun */
        {II, ROUND_1},  /* 3: overcast, moderate gradation */
        {II, ROUND_2},  /* 4: the same, slightly brighter towards the sun */
        {III, ROUND_1}, /* 5: uniform */
        {III, ROUND_2}, /* 6: partly cloudy, no gradation, slightly brighter towards the sun */
        {III, ROUND_3}, /* 7: the same, brighter around the sun */
        {III, ROUND_4}, /* 8: the same, with a distinct corona */
        {IV, ROUND_2},  /* 9: partly cloudy, the sun obscured */
        {IV, ROUND_3},  /* 10: partly cloudy, brighter around the sun */
        {IV, ROUND_4},  /* 11: white-blue, with a distinct corona */
        {V, ROUND_4},   /* 12: clear, of low turbidity: the CIE standard clear sky */
        {V, ROUND_5},   /* 13: clear, polluted */
        {VI, ROUND_5},  /* 14: cloudless and turbid, with a broad corona */
        {VI, ROUND_6},  /* 15: white-blue and turbid, with a broad corona */
    };
    return types[type - 1];
}

/* exp(x); below 2^-1000 it is not 0, but negligible. */
static double exponential(double x)
{
    const double log2_e = 1.4426950408889634074;
    return elementary_exp2_inline(x * log2_e);
}

static double gradation(const cie_sky_type *t, double cos_zenith)
{
    return 1.0 + t->a * exponential(t->b / cos_zenith);
}

/* The indicatrix, from the cosine and sine of the angle from the sun. */
static double indicatrix(const cie_sky_type *t, double cosine, double sine)
{
    const double angle = elementary_atan2_deg(sine, cosine) * (PI / 180.0);
    return 1.0 + t->c * (exponential(t->d * angle) - exponential(t->d * (0.5 * PI))) + t->e * cosine * cosine;
}

cie_sky cie_sky_make(int type, vec3 to_sun)
{
    cie_sky sky = {.of = cie_sky_type_of(type), .to_sun = to_sun};
    const double level = sqrt(to_sun.x * to_sun.x + to_sun.z * to_sun.z);
    sky.zenith = indicatrix(&sky.of, to_sun.y, level) * gradation(&sky.of, 1.0);
    return sky;
}

double cie_sky_relative(const cie_sky *sky, vec3 direction)
{
    const double sine = vec3_length(vec3_cross(direction, sky->to_sun)), cosine = vec3_dot(direction, sky->to_sun);
    return indicatrix(&sky->of, cosine, sine) * gradation(&sky->of, direction.y) / sky->zenith;
}

/* The midpoint rule in azimuth and in the square root of the height, which resolves the steep gradation at the
 * horizon. */
double cie_sky_mean(const cie_sky *sky)
{
    enum { HEIGHTS = 192, AZIMUTHS = 192 };
    double sum = 0.0;
    for (int h = 0; h < HEIGHTS; h++) {
        const double root = (h + 0.5) / HEIGHTS, y = root * root, level = sqrt(1.0 - y * y);
        double row = 0.0;
        for (int k = 0; k < AZIMUTHS; k++) {
            double sine, cosine;
            elementary_sincos_deg((k + 0.5) * (360.0 / AZIMUTHS), &sine, &cosine);
            row += cie_sky_relative(sky, vec3_make(level * sine, y, level * cosine));
        }
        sum += row / AZIMUTHS * (2.0 * root / HEIGHTS);
    }
    return sum;
}
