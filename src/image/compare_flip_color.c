/* The colour space of FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, FLIP: A Difference
 * Evaluator for Alternating Images, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020,
 * section 4.1. */
#include "image/compare_parts.h"

#include "base/elementary.h"
#include <math.h>

/* Linear sRGB to XYZ relative to its own white (D65). Each row is divided by the sum of its numerators and so sums to
 * 1. The fractions follow from the primaries of IEC 61966-2-1; the authors' implementation uses the same. */
static const double XYZ_OF_RGB[3][3] = {
    {10135552.0 / 23359437, 8788810.0 / 23359437, 4435075.0 / 23359437},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 80288307, 8788810.0 / 80288307, 70074185.0 / 80288307},
};

/* The inverse, from exact fractions. */
static const double RGB_OF_XYZ[3][3] = {
    {3.0803419882804608, -1.5373989694887855, -0.54294301879167506},
    {-0.92117839616512365, 1.8759299836951759, 0.045248412469947583},
    {0.052881292875543252, -0.20401120612390997, 1.1511299132483668},
};

static double clamp(double value)
{
    return value > 0.0 ? value < 1.0 ? value : 1.0 : 0.0;
}

static void multiply(const double matrix[3][3], const double in[3], double out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = matrix[row][0] * in[0] + matrix[row][1] * in[1] + matrix[row][2] * in[2];
}

void flip_opponent(const float rgb[3], double opponent[3])
{
    double clamped[3] = {clamp(rgb[0]), clamp(rgb[1]), clamp(rgb[2])}, xyz[3];
    multiply(XYZ_OF_RGB, clamped, xyz);
    opponent[0] = xyz[1];
    opponent[1] = xyz[0] - xyz[1];
    opponent[2] = xyz[1] - xyz[2];
}

/* CIE 15, the cube root with a linear segment near 0. */
static double lab_root(double t)
{
    const double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? elementary_pow(t, 1.0 / 3.0) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

void flip_hunt_lab(const double opponent[3], double lab[3])
{
    double xyz[3] = {opponent[0] + opponent[1], opponent[0], opponent[0] - opponent[2]}, rgb[3];
    multiply(RGB_OF_XYZ, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = clamp(rgb[i]);
    multiply(XYZ_OF_RGB, rgb, xyz);
    double x = lab_root(xyz[0]), y = lab_root(xyz[1]), z = lab_root(xyz[2]);
    lab[0] = 116.0 * y - 16.0;
    lab[1] = 0.01 * lab[0] * 500.0 * (x - y); /* Hunt effect: lighter colours appear more colourful */
    lab[2] = 0.01 * lab[0] * 200.0 * (y - z);
}

/* HyAB (Abasi, Tehran, Fairchild 2020), for large distances: city block in lightness, Euclidean in colour; to the power
 * 0.7. */
static double hyab_power(const double a[3], const double b[3])
{
    double d1 = a[1] - b[1], d2 = a[2] - b[2];
    return elementary_pow(fabs(a[0] - b[0]) + sqrt(d1 * d1 + d2 * d2), 0.7);
}

double flip_farthest(void)
{
    const float green[3] = {0.0f, 1.0f, 0.0f}, blue[3] = {0.0f, 0.0f, 1.0f};
    double opponent[3], lab_green[3], lab_blue[3];
    flip_opponent(green, opponent);
    flip_hunt_lab(opponent, lab_green);
    flip_opponent(blue, opponent);
    flip_hunt_lab(opponent, lab_blue);
    return hyab_power(lab_green, lab_blue);
}

double flip_color_error(const double a[3], const double b[3], double farthest)
{
    const double share = 0.95; /* p_t, the value at the knee, p_c = 0.4 of the maximum distance */
    double distance = hyab_power(a, b), knee = 0.4 * farthest;
    return distance < knee ? share * distance / knee : share + (1.0 - share) * (distance - knee) / (farthest - knee);
}
