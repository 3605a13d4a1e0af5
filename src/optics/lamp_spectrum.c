/* Planck's law, line lists, and their colours. */
#include "optics/lamp_spectrum.h"

#include "base/elementary.h"

#define SECOND_RADIATION_NM_K 1.4388e7 /* c2 = h c / k, as CIE 15 rounds it */
#define REFERENCE_NM 560.0
#define E 2.71828182845904523536

/* e^x - 1; x is at least 0.18 in the ranges of the header, so that the difference loses no more than a place. */
static double above_one(double x)
{
    return elementary_pow(E, x) - 1.0;
}

double planck_relative(double lambda_nm, double temperature_k)
{
    const double ratio = REFERENCE_NM / lambda_nm, ratio2 = ratio * ratio, x = SECOND_RADIATION_NM_K / temperature_k;
    return ratio2 * ratio2 * ratio * (above_one(x / REFERENCE_NM) / above_one(x / lambda_nm));
}

/* XYZ of Planck's spectrum; midpoints of 1 nm, whose error is below 1e-6 of Y. */
static void black_body_xyz(double temperature_k, double xyz[3])
{
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int nm = OBSERVER_LOW_NM; nm < OBSERVER_HIGH_NM; nm++) {
        const double lambda_nm = nm + 0.5, value = planck_relative(lambda_nm, temperature_k);
        double weights[3];
        observer_weights(lambda_nm, weights);
        for (int c = 0; c < 3; c++)
            xyz[c] += weights[c] * value / (OBSERVER_HIGH_NM - OBSERVER_LOW_NM);
    }
}

double black_body_scale(double temperature_k)
{
    double xyz[3];
    black_body_xyz(temperature_k, xyz);
    return 1.0 / xyz[1];
}

static int copy_lines(const spectral_line *from, int count, spectral_line *to)
{
    double luminance = 0.0;
    for (int k = 0; k < count; k++) {
        double xyz[3];
        observer_weights(from[k].nm, xyz);
        luminance += from[k].power * xyz[1];
    }
    for (int k = 0; k < count; k++)
        to[k] = (spectral_line){from[k].nm, from[k].power / luminance};
    return count;
}

int lamp_lines(lamp_spectrum kind, double line_nm, spectral_line lines[LAMP_LINES_MAX])
{
    static const spectral_line sodium[] = {{588.995, 2.0}, {589.592, 1.0}};
    static const spectral_line mercury[] = {{404.656, 1800.0}, {407.783, 150.0}, {435.833, 4000.0}, {491.607, 80.0},
                                            {546.074, 1100.0}, {576.960, 240.0}, {578.966, 100.0},  {579.066, 280.0}};
    static const spectral_line hydrogen[] = {
        {397.007, 8.0}, {410.174, 15.0}, {434.047, 30.0}, {486.133, 80.0}, {656.280, 300.0}};
    const spectral_line one = {line_nm, 1.0};
#define COPY(list) copy_lines(list, (int)(sizeof list / sizeof list[0]), lines)
    switch (kind) {
    case LAMP_OF_COLOR:
    case LAMP_BLACK_BODY: break;
    case LAMP_SODIUM: return COPY(sodium);
    case LAMP_MERCURY: return COPY(mercury);
    case LAMP_HYDROGEN: return COPY(hydrogen);
    case LAMP_LINE: return copy_lines(&one, 1, lines);
    }
#undef COPY
    return 0;
}

/* The share of white that brings the least component to 0. */
static void into_gamut(double rgb[3])
{
    const double low = rgb[0] < rgb[1] ? rgb[0] : rgb[1], least = low < rgb[2] ? low : rgb[2];
    const double white = least < 0.0 ? -least / (1.0 - least) : 0.0;
    for (int c = 0; c < 3; c++) {
        rgb[c] = (1.0 - white) * rgb[c] + white;
        rgb[c] = rgb[c] > 0.0 ? rgb[c] : 0.0; /* of rounding */
    }
}

void lamp_rgb(lamp_spectrum kind, double temperature_k, double line_nm, double rgb[3])
{
    spectral_line lines[LAMP_LINES_MAX];
    const int count = lamp_lines(kind, line_nm, lines);
    double xyz[3] = {0.0, 0.0, 0.0};
    if (count == 0)
        black_body_xyz(temperature_k, xyz);
    for (int k = 0; k < count; k++) {
        double weights[3];
        observer_weights(lines[k].nm, weights);
        for (int c = 0; c < 3; c++)
            xyz[c] += lines[k].power * weights[c];
    }
    const double of_one[3] = {xyz[0] / xyz[1], 1.0, xyz[2] / xyz[1]};
    xyz_to_linear_srgb(of_one, rgb);
    into_gamut(rgb);
}
