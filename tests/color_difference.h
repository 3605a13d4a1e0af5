/* The perceptual difference of two colours: CIELAB under D65 as the engine integrates it, and CIEDE2000 (Sharma, Wu and
 * Dalal, "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test Data, and Mathematical
 * Observations", Color Research and Application 30(1), 2005; kL = kC = kH = 1). Only for tests: libm may differ in the
 * last place. Pure; cannot fail. */
#pragma once

#include "optics/spectrum.h"
#include <math.h>

static const double degrees_per_radian = 57.295779513082321;

static inline double cos_of_deg(double degrees)
{
    return cos(degrees / degrees_per_radian);
}

static inline double lab_curve(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

/* CIE 15:2018, 8.2.1. */
static inline void lab_from_xyz(const double xyz[3], double lab[3])
{
    const double white[3] = {1.0, 1.0, 1.0};
    double n[3];
    linear_srgb_to_xyz(white, n);
    double x = lab_curve(xyz[0] / n[0]), y = lab_curve(xyz[1] / n[1]), z = lab_curve(xyz[2] / n[2]);
    lab[0] = 116.0 * y - 16.0;
    lab[1] = 500.0 * (x - y);
    lab[2] = 200.0 * (y - z);
}

/* 0 .. 360; 0 for grey (eq. 7) */
static inline double hue_deg(double a, double b)
{
    double h = a == 0.0 && b == 0.0 ? 0.0 : atan2(b, a) * degrees_per_radian;
    return h < 0.0 ? h + 360.0 : h;
}

/* Equation numbers are Sharma's. */
static inline double color_difference_2000(const double lab1[3], const double lab2[3])
{
    const double c7_25 = 6103515625.0; /* 25^7 */
    double c_mean = 0.5 * (hypot(lab1[1], lab1[2]) + hypot(lab2[1], lab2[2]));
    double g = 0.5 * (1.0 - sqrt(pow(c_mean, 7.0) / (pow(c_mean, 7.0) + c7_25))); /* 4 */
    double a1 = (1.0 + g) * lab1[1], a2 = (1.0 + g) * lab2[1];                    /* 5 */
    double c1 = hypot(a1, lab1[2]), c2 = hypot(a2, lab2[2]);                      /* 6 */
    double h1 = hue_deg(a1, lab1[2]), h2 = hue_deg(a2, lab2[2]);
    double turn = h2 - h1, h = h1 + h2; /* 10, 14 */
    if (c1 * c2 == 0.0) {
        turn = 0.0;
    } else if (fabs(h1 - h2) <= 180.0) {
        h *= 0.5;
    } else {
        turn += turn > 180.0 ? -360.0 : 360.0;
        h = 0.5 * (h < 360.0 ? h + 360.0 : h - 360.0);
    }
    double d_l = lab2[0] - lab1[0], d_c = c2 - c1;
    double d_h = 2.0 * sqrt(c1 * c2) * sin(0.5 * turn / degrees_per_radian); /* 11 */
    double l = 0.5 * (lab1[0] + lab2[0]), c = 0.5 * (c1 + c2);
    double t = 1.0 - 0.17 * cos_of_deg(h - 30.0) + 0.24 * cos_of_deg(2.0 * h) + 0.32 * cos_of_deg(3.0 * h + 6.0) -
               0.20 * cos_of_deg(4.0 * h - 63.0); /* 15 */
    double theta = 30.0 * exp(-(h - 275.0) / 25.0 * ((h - 275.0) / 25.0));
    double r_c = 2.0 * sqrt(pow(c, 7.0) / (pow(c, 7.0) + c7_25));
    double s_l = 1.0 + 0.015 * (l - 50.0) * (l - 50.0) / sqrt(20.0 + (l - 50.0) * (l - 50.0));
    double s_c = 1.0 + 0.045 * c, s_h = 1.0 + 0.015 * c * t;
    double r_t = -sin(2.0 * theta / degrees_per_radian) * r_c;
    double l_part = d_l / s_l, c_part = d_c / s_c, h_part = d_h / s_h;
    return sqrt(l_part * l_part + c_part * c_part + h_part * h_part + r_t * c_part * h_part); /* 22 */
}
