/* Spectra and their colours: the tables of the standard observer and of D65, the sRGB matrices, and lamps. */
#include "optics/spectrum.h"

#include "base/elementary.h"

/* ---- the standard observer and daylight ---- */

enum { FIRST_NM = 360, LAST_NM = 830, STEP_NM = 5, ENTRIES = (LAST_NM - FIRST_NM) / STEP_NM + 1 };

/* xbar, ybar, zbar, and D65 as published (100 at 560 nm). CIE 15:2018, tables 5 and 6; as distributed by the Colour and
 * Vision Research Laboratory, UCL (ciexyz31, Illuminantd65). The comment is the row's first wavelength. */
/* clang-format off */
static const double table[ENTRIES][4] = {
    {0.0001299, 0.000003917, 0.0006061, 46.6383}, {0.0002321, 0.000006965, 0.001086, 49.3637}, /* 360 */
    {0.0004149, 0.00001239, 0.001946, 52.0891}, {0.0007416, 0.00002202, 0.003486, 51.0323}, /* 370 */
    {0.001368, 0.000039, 0.006450001, 49.9755}, {0.002236, 0.000064, 0.01054999, 52.3118}, /* 380 */
    {0.004243, 0.00012, 0.02005001, 54.6482}, {0.00765, 0.000217, 0.03621, 68.7015}, /* 390 */
    {0.01431, 0.000396, 0.06785001, 82.7549}, {0.02319, 0.00064, 0.1102, 87.1204}, /* 400 */
    {0.04351, 0.00121, 0.2074, 91.486}, {0.07763, 0.00218, 0.3713, 92.4589}, /* 410 */
    {0.13438, 0.004, 0.6456, 93.4318}, {0.21477, 0.0073, 1.0390501, 90.057}, /* 420 */
    {0.2839, 0.0116, 1.3856, 86.6823}, {0.3285, 0.01684, 1.62296, 95.7736}, /* 430 */
    {0.34828, 0.023, 1.74706, 104.865}, {0.34806, 0.0298, 1.7826, 110.936}, /* 440 */
    {0.3362, 0.038, 1.77211, 117.008}, {0.3187, 0.048, 1.7441, 117.41}, /* 450 */
    {0.2908, 0.06, 1.6692, 117.812}, {0.2511, 0.0739, 1.5281, 116.336}, /* 460 */
    {0.19536, 0.09098, 1.28764, 114.861}, {0.1421, 0.1126, 1.0419, 115.392}, /* 470 */
    {0.09564, 0.13902, 0.8129501, 115.923}, {0.05795001, 0.1693, 0.6162, 112.367}, /* 480 */
    {0.03201, 0.20802, 0.46518, 108.811}, {0.0147, 0.2586, 0.3533, 109.082}, /* 490 */
    {0.0049, 0.323, 0.272, 109.354}, {0.0024, 0.4073, 0.2123, 108.578}, /* 500 */
    {0.0093, 0.503, 0.1582, 107.802}, {0.0291, 0.6082, 0.1117, 106.296}, /* 510 */
    {0.06327, 0.71, 0.07824999, 104.79}, {0.1096, 0.7932, 0.05725001, 106.239}, /* 520 */
    {0.1655, 0.862, 0.04216, 107.689}, {0.2257499, 0.9148501, 0.02984, 106.047}, /* 530 */
    {0.2904, 0.954, 0.0203, 104.405}, {0.3597, 0.9803, 0.0134, 104.225}, /* 540 */
    {0.4334499, 0.9949501, 0.008749999, 104.046}, {0.5120501, 1.0, 0.005749999, 102.023}, /* 550 */
    {0.5945, 0.995, 0.0039, 100.0}, {0.6784, 0.9786, 0.002749999, 98.1671}, /* 560 */
    {0.7621, 0.952, 0.0021, 96.3342}, {0.8425, 0.9154, 0.0018, 96.0611}, /* 570 */
    {0.9163, 0.87, 0.001650001, 95.788}, {0.9786, 0.8163, 0.0014, 92.2368}, /* 580 */
    {1.0263, 0.757, 0.0011, 88.6856}, {1.0567, 0.6949, 0.001, 89.3459}, /* 590 */
    {1.0622, 0.631, 0.0008, 90.0062}, {1.0456, 0.5668, 0.0006, 89.8026}, /* 600 */
    {1.0026, 0.503, 0.00034, 89.5991}, {0.9384, 0.4412, 0.00024, 88.6489}, /* 610 */
    {0.8544499, 0.381, 0.00019, 87.6987}, {0.7514, 0.321, 0.0001, 85.4936}, /* 620 */
    {0.6424, 0.265, 0.00004999999, 83.2886}, {0.5419, 0.217, 0.00003, 83.4939}, /* 630 */
    {0.4479, 0.175, 0.00002, 83.6992}, {0.3608, 0.1382, 0.00001, 81.863}, /* 640 */
    {0.2835, 0.107, 0.0, 80.0268}, {0.2187, 0.0816, 0.0, 80.1207}, /* 650 */
    {0.1649, 0.061, 0.0, 80.2146}, {0.1212, 0.04458, 0.0, 81.2462}, /* 660 */
    {0.0874, 0.032, 0.0, 82.2778}, {0.0636, 0.0232, 0.0, 80.281}, /* 670 */
    {0.04677, 0.017, 0.0, 78.2842}, {0.0329, 0.01192, 0.0, 74.0027}, /* 680 */
    {0.0227, 0.00821, 0.0, 69.7213}, {0.01584, 0.005723, 0.0, 70.6652}, /* 690 */
    {0.01135916, 0.004102, 0.0, 71.6091}, {0.008110916, 0.002929, 0.0, 72.979}, /* 700 */
    {0.005790346, 0.002091, 0.0, 74.349}, {0.004109457, 0.001484, 0.0, 67.9765}, /* 710 */
    {0.002899327, 0.001047, 0.0, 61.604}, {0.00204919, 0.00074, 0.0, 65.7448}, /* 720 */
    {0.001439971, 0.00052, 0.0, 69.8856}, {0.0009999493, 0.0003611, 0.0, 72.4863}, /* 730 */
    {0.0006900786, 0.0002492, 0.0, 75.087}, {0.0004760213, 0.0001719, 0.0, 69.3398}, /* 740 */
    {0.0003323011, 0.00012, 0.0, 63.5927}, {0.0002348261, 0.0000848, 0.0, 55.0054}, /* 750 */
    {0.0001661505, 0.00006, 0.0, 46.4182}, {0.000117413, 0.0000424, 0.0, 56.6118}, /* 760 */
    {0.00008307527, 0.00003, 0.0, 66.8054}, {0.00005870652, 0.0000212, 0.0, 65.0941}, /* 770 */
    {0.00004150994, 0.00001499, 0.0, 63.3828}, {0.00002935326, 0.0000106, 0.0, 63.8434}, /* 780 */
    {0.00002067383, 0.0000074657, 0.0, 64.304}, {0.00001455977, 0.0000052578, 0.0, 61.8779}, /* 790 */
    {0.00001025398, 0.0000037029, 0.0, 59.4519}, {0.000007221456, 0.0000026078, 0.0, 55.7054}, /* 800 */
    {0.000005085868, 0.0000018366, 0.0, 51.959}, {0.000003581652, 0.0000012934, 0.0, 54.6998}, /* 810 */
    {0.000002522525, 0.00000091093, 0.0, 57.4406}, {0.000001776509, 0.00000064153, 0.0, 58.8765}, /* 820 */
    {0.000001251141, 0.00000045181, 0.0, 60.3125}, /* 830 */
};
/* clang-format on */

/* Computed from the tables above over 380 .. 780 nm in exact rational arithmetic, then rounded. */
static const double ONE_OVER_YBAR = 0.009358344722132764; /* 1 / integral of ybar, 106.8565 nm */
static const double D65_SCALE = 0.010112441656744924;     /* integral of ybar / integral of ybar D65 */

/* The matrix is P diag(P^-1 w): P holds the primaries' XYZ for Y = 1, from their chromaticities (0.64, 0.33), (0.30,
 * 0.60), (0.15, 0.06); w is the white point, (0.9504192396994354, 1, 1.0884270576889240) by the integrals above (SMPTE
 * RP 177-1993, 3.3). Both matrices in rational arithmetic, rounded once. */
static const double srgb_to_xyz[3][3] = {
    {0.41247144960494997, 0.35758768297478344, 0.18036010711970205},
    {0.21268059120255234, 0.7151753659495669, 0.07214404284788081},
    {0.01933459920023203, 0.1191958943249278, 0.9498965641637641},
};
static const double xyz_to_srgb[3][3] = {
    {3.2403362366511685, -1.5370825737960672, -0.49851326717710287},
    {-0.969234573456958, 1.8759499604452747, 0.041554668850414186},
    {0.055667302503356754, -0.2041134425123081, 1.0576787475637783},
};

/* Entry at or below a wavelength, and the fraction of the step to the next, 0 .. 1; -1 outside the tables. */
static int entry_below(double lambda_nm, double *part)
{
    if (!(lambda_nm >= FIRST_NM && lambda_nm <= LAST_NM))
        return -1;
    double position = (lambda_nm - FIRST_NM) / STEP_NM;
    int k = (int)position;
    if (k > ENTRIES - 2)
        k = ENTRIES - 2;
    *part = position - k;
    return k;
}

void observer_xyz(double lambda_nm, double xyz[3])
{
    double part = 0.0;
    int k = entry_below(lambda_nm, &part);
    for (int i = 0; i < 3; i++)
        xyz[i] = k < 0 ? 0.0 : table[k][i] * (1.0 - part) + table[k + 1][i] * part;
}

double observer_d65(double lambda_nm)
{
    double part = 0.0;
    int k = entry_below(lambda_nm, &part);
    return k < 0 ? 0.0 : (table[k][3] * (1.0 - part) + table[k + 1][3] * part) * D65_SCALE;
}

void observer_weights(double lambda_nm, double xyz[3])
{
    observer_xyz(lambda_nm, xyz);
    for (int i = 0; i < 3; i++)
        xyz[i] *= (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) * ONE_OVER_YBAR;
}

static void multiply(const double m[3][3], const double v[3], double out[3])
{
    const double a = v[0], b = v[1], c = v[2]; /* v and out may be the same array */
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * a + m[i][1] * b + m[i][2] * c;
}

void xyz_to_linear_srgb(const double xyz[3], double rgb[3])
{
    multiply(xyz_to_srgb, xyz, rgb);
}

void linear_srgb_to_xyz(const double rgb[3], double xyz[3])
{
    multiply(srgb_to_xyz, rgb, xyz);
}

/* ---- lamps: Planck's law, line lists, and their colours ---- */

#define SECOND_RADIATION_NM_K 1.4388e7 /* c2 = h c / k, as CIE 15 rounds it */
#define REFERENCE_NM 560.0
#define E 2.71828182845904523536

/* e^x - 1; x is at least 0.18 in the ranges of the header, so that the difference loses no more than a place. */
static double exp_minus_one(double x)
{
    return elementary_pow(E, x) - 1.0;
}

double planck_relative(double lambda_nm, double temperature_k)
{
    const double ratio = REFERENCE_NM / lambda_nm, ratio2 = ratio * ratio, x = SECOND_RADIATION_NM_K / temperature_k;
    return ratio2 * ratio2 * ratio * (exp_minus_one(x / REFERENCE_NM) / exp_minus_one(x / lambda_nm));
}

/* The error of the midpoints is below 1e-6 of Y for Planck's spectrum. */
void spectrum_xyz(spectrum_value *value, const void *context, double xyz[3])
{
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int nm = OBSERVER_LOW_NM; nm < OBSERVER_HIGH_NM; nm++) {
        const double lambda_nm = nm + 0.5, here = value(context, lambda_nm);
        double weights[3];
        observer_weights(lambda_nm, weights);
        for (int c = 0; c < 3; c++)
            xyz[c] += weights[c] * here / (OBSERVER_HIGH_NM - OBSERVER_LOW_NM);
    }
}

static double planck_at(const void *temperature_k, double lambda_nm)
{
    return planck_relative(lambda_nm, *(const double *)temperature_k);
}

double black_body_scale(double temperature_k)
{
    double xyz[3];
    spectrum_xyz(planck_at, &temperature_k, xyz);
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
    case LAMP_BLACK_BODY:
    case LAMP_DATA: break;
    case LAMP_SODIUM: return COPY(sodium);
    case LAMP_MERCURY: return COPY(mercury);
    case LAMP_HYDROGEN: return COPY(hydrogen);
    case LAMP_LINE: return copy_lines(&one, 1, lines);
    }
#undef COPY
    return 0;
}

/* Adds the fraction of white with which the least component becomes 0. */
static void into_gamut(double rgb[3])
{
    const double low = rgb[0] < rgb[1] ? rgb[0] : rgb[1], least = low < rgb[2] ? low : rgb[2];
    const double white = least < 0.0 ? -least / (1.0 - least) : 0.0;
    for (int c = 0; c < 3; c++) {
        rgb[c] = (1.0 - white) * rgb[c] + white;
        rgb[c] = rgb[c] > 0.0 ? rgb[c] : 0.0; /* negative by rounding */
    }
}

void light_rgb(const double xyz[3], double rgb[3])
{
    const double of_one[3] = {xyz[0] / xyz[1], 1.0, xyz[2] / xyz[1]};
    xyz_to_linear_srgb(of_one, rgb);
    into_gamut(rgb);
}

void lamp_rgb(lamp_spectrum kind, double temperature_k, double line_nm, double rgb[3])
{
    spectral_line lines[LAMP_LINES_MAX];
    const int count = lamp_lines(kind, line_nm, lines);
    double xyz[3] = {0.0, 0.0, 0.0};
    if (count == 0)
        spectrum_xyz(planck_at, &temperature_k, xyz);
    for (int k = 0; k < count; k++) {
        double weights[3];
        observer_weights(lines[k].nm, weights);
        for (int c = 0; c < 3; c++)
            xyz[c] += lines[k].power * weights[c];
    }
    light_rgb(xyz, rgb);
}
