/* Colour spaces of image files, to linear light with the primaries of sRGB: transfer functions as tables, primaries
 * as a matrix, and ICC profiles that consist of these two. Sources: ICC.1:2022 (profiles, adaptation by Bradford's
 * matrix), IEC 61966-2-1 (sRGB), SMPTE RP 177 (primaries to XYZ). */
#include "image/codec.h"

#include "base/cancel.h"
#include "base/elementary.h"
#include <math.h>
#include <stdlib.h>

/* ---- matrices ---- */

typedef struct matrix {
    double m[3][3];
} matrix;

static matrix product(matrix a, matrix b)
{
    matrix out = {{{0}}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out.m[i][j] += a.m[i][k] * b.m[k][j];
    return out;
}

static void apply(const matrix *a, const double from[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a->m[i][0] * from[0] + a->m[i][1] * from[1] + a->m[i][2] * from[2];
}

/* By cofactors; false for a matrix that is singular or not finite. */
static bool invert(matrix a, matrix *out)
{
    double determinant = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out->m[i][j] = a.m[r][c] * a.m[s][d] - a.m[r][d] * a.m[s][c];
        }
    for (int j = 0; j < 3; j++)
        determinant += a.m[0][j] * out->m[j][0];
    if (!(fabs(determinant) > 1e-9 && isfinite(determinant)))
        return false;
    for (int i = 0; i < 9; i++)
        out->m[i / 3][i % 3] /= determinant;
    return true;
}

static const matrix bradford = {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
static const double d50[3] = {0.9642, 1.0, 0.8249}; /* the white of profiles, ICC.1:2022, 7.2.16 */

/* XYZ under one white to XYZ under another, both with Y = 1 (ICC.1:2022, annex E). */
static bool adaptation(const double from[3], const double to[3], matrix *out)
{
    double before[3], after[3];
    matrix scale = {{{0}}}, back;
    apply(&bradford, from, before);
    apply(&bradford, to, after);
    for (int i = 0; i < 3; i++) {
        if (!(before[i] > 1e-6))
            return false;
        scale.m[i][i] = after[i] / before[i];
    }
    invert(bradford, &back);
    *out = product(back, product(scale, bradford));
    return true;
}

static bool white_of(const double xy[2], double XYZ[3])
{
    if (!(xy[1] > 1e-6))
        return false;
    XYZ[0] = xy[0] / xy[1], XYZ[1] = 1.0, XYZ[2] = (1.0 - xy[0] - xy[1]) / xy[1];
    return true;
}

/* RGB to XYZ for the chromaticities of white, red, green, blue; RGB 1, 1, 1 is the white with Y = 1. */
static bool to_XYZ(const double xy[8], matrix *out)
{
    double white[3], scale[3];
    matrix inverse;
    if (!white_of(xy, white))
        return false;
    for (int c = 0; c < 3; c++) {
        const double x = xy[2 + 2 * c], y = xy[3 + 2 * c];
        out->m[0][c] = x, out->m[1][c] = y, out->m[2][c] = 1.0 - x - y;
    }
    if (!invert(*out, &inverse))
        return false;
    apply(&inverse, white, scale);
    for (int i = 0; i < 9; i++)
        out->m[i / 3][i % 3] *= scale[i % 3];
    return true;
}

static const double srgb_xy[8] = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};

static matrix srgb_of_XYZ(void)
{
    matrix XYZ, out = {{{0}}};
    if (to_XYZ(srgb_xy, &XYZ))
        invert(XYZ, &out);
    return out;
}

/* What rounding of the numbers in a file makes of the primaries of sRGB leaves the pixels unchanged. */
static void set_matrix(codec_color *color, matrix to_srgb)
{
    double error = 0.0;
    for (int i = 0; i < 9; i++) {
        color->to_srgb[i / 3][i % 3] = to_srgb.m[i / 3][i % 3];
        error = fmax(error, fabs(to_srgb.m[i / 3][i % 3] - (i / 3 == i % 3)));
    }
    color->mixes = error > 1e-3;
}

bool codec_color_set_primaries(codec_color *color, const double xy[8])
{
    matrix XYZ, adapt;
    double from[3], to[3];
    if (!to_XYZ(xy, &XYZ) || !white_of(xy, from) || !white_of(srgb_xy, to) || !adaptation(from, to, &adapt))
        return false;
    set_matrix(color, product(srgb_of_XYZ(), product(adapt, XYZ)));
    return true;
}

bool codec_color_set_unadapted(codec_color *color, const double xy[8], double luminance[3])
{
    matrix XYZ;
    if (!to_XYZ(xy, &XYZ))
        return false;
    for (int c = 0; c < 3; c++)
        luminance[c] = XYZ.m[1][c];
    set_matrix(color, product(srgb_of_XYZ(), XYZ));
    return true;
}

void codec_color_set_XYZ(codec_color *color)
{
    set_matrix(color, srgb_of_XYZ());
}

/* ---- transfer functions ---- */

static double curve_at(const codec_curve *curve, double x)
{
    double y;
    if (curve->count > 0) {
        const double at = x * (double)(curve->count - 1);
        const size_t below = (size_t)at, above = below + 1 < curve->count ? below + 1 : below;
        const double low = codec_big_endian(curve->table + 2 * below, 2),
                     high = codec_big_endian(curve->table + 2 * above, 2);
        y = (low + (high - low) * (at - (double)below)) / 65535.0;
    } else if (x >= curve->d) {
        y = elementary_pow(fmax(curve->a * x + curve->b, 0.0), curve->g) + curve->e;
    } else {
        y = curve->c * x + curve->f;
    }
    return y > 0.0 ? fmin(y, 1.0) : 0.0; /* NaN too */
}

void codec_color_set_curve(codec_color *color, const codec_curve *all)
{
    color->curved = true;
    for (int c = 0; c < 3; c++)
        color->curve[c] = *all;
}

/* A profile of sRGB itself leaves the pixels unchanged: its curve is that of IEC 61966-2-1 but for rounding. */
static bool is_srgb(const codec_curve *curve)
{
    double error = 0.0;
    for (int i = 0; i <= 64; i++)
        error = fmax(error, fabs(curve_at(curve, i / 64.0) - srgb_decode(i / 64.0)));
    return error < 1e-4;
}

static void fill(const codec_color *color, int channel, unsigned maximum, float *table)
{
    for (unsigned i = 0; i <= maximum; i++) {
        const double x = maximum ? (double)i / maximum : 0.0;
        table[i] = (float)(!color ? x : color->curved ? curve_at(&color->curve[channel], x) : srgb_decode(x));
    }
}

status codec_tables_make(const codec_color *color, const unsigned maximum[3], codec_tables *out, diagnostic *why)
{
    const bool equal = maximum[0] == maximum[1] && maximum[0] == maximum[2] && !(color && color->curved);
    size_t count = (size_t)maximum[0] + 1;
    count += equal ? 0 : (size_t)maximum[1] + 1 + (size_t)maximum[2] + 1;
    float *table = malloc(count * sizeof *table);
    *out = (codec_tables){{table, table, table}};
    if (!table)
        return out_of_memory(why);
    for (int c = 0; c < 3; c++) {
        if (c > 0 && !equal)
            out->of[c] = out->of[c - 1] + maximum[c - 1] + 1;
        if (c == 0 || !equal)
            fill(color, c, maximum[c], out->of[c]);
    }
    return STATUS_OK;
}

void codec_tables_free(codec_tables *tables)
{
    free(tables->of[0]);
    *tables = (codec_tables){{NULL}};
}

/* ---- pixels ---- */

/* Values that leave the range by less are rounding: half a step of 8 bits. */
#define BEYOND (1.0 / 512.0)

void codec_color_apply(const codec_color *color, double most, image *img)
{
    const size_t count = (size_t)img->width * (size_t)img->height;
    size_t beyond = 0;
    if (!color->mixes)
        return;
    matrix to_srgb;
    memcpy(to_srgb.m, color->to_srgb, sizeof to_srgb.m);
    for (size_t i = 0; i < count && !cancel_asked_at(i); i++) {
        float *pixel = img->pixel + 3 * i;
        const double from[3] = {(double)pixel[0], (double)pixel[1], (double)pixel[2]};
        double to[3];
        bool out = false;
        apply(&to_srgb, from, to);
        const double slack = BEYOND * fmax(1.0, fmax(fabs(to[0]), fmax(fabs(to[1]), fabs(to[2]))));
        for (int c = 0; c < 3; c++) {
            out |= to[c] < -slack || to[c] > most + slack;
            pixel[c] = (float)(to[c] > 0.0 ? fmin(to[c], most) : 0.0);
        }
        beyond += out;
    }
    if (beyond > 0)
        image_note(img->note, "%zu of %zu pixels have colours that sRGB cannot show, limited to its range", beyond,
                   count);
}

/* ---- ICC profiles ---- */

enum { PROFILE_HEADER = 128, PROFILE_TAGS_MAX = 100 };

typedef struct icc_profile {
    const unsigned char *bytes;
    size_t size;
} icc_profile;

static double fixed_at(const unsigned char *at) /* s15Fixed16Number */
{
    return (double)(int32_t)codec_big_endian(at, 4) / 65536.0;
}

/* The data of a tag; its size in *size. NULL: the profile does not have it, or it lies outside. */
static const unsigned char *find_tag(const icc_profile *p, const char *name, size_t *size)
{
    const size_t tags = codec_big_endian(p->bytes + PROFILE_HEADER, 4);
    for (size_t i = 0; i < tags && i < PROFILE_TAGS_MAX && PROFILE_HEADER + 16 + 12 * i <= p->size; i++) {
        const unsigned char *tag = p->bytes + PROFILE_HEADER + 4 + 12 * i;
        const size_t at = codec_big_endian(tag + 4, 4), length = codec_big_endian(tag + 8, 4);
        if (memcmp(tag, name, 4) != 0)
            continue;
        *size = length;
        return at <= p->size && length <= p->size - at ? p->bytes + at : NULL;
    }
    return NULL;
}

/* ICC.1:2022, 10.6 (curv) and 10.18 (para). */
static bool read_curve(const icc_profile *p, const char *name, codec_curve *out)
{
    static const unsigned char numbers[] = {1, 3, 4, 5, 7};
    size_t size = 0;
    const unsigned char *tag = find_tag(p, name, &size);
    *out = (codec_curve){.g = 1.0, .a = 1.0};
    if (!tag || size < 12)
        return false;
    if (memcmp(tag, "curv", 4) == 0) {
        const size_t count = codec_big_endian(tag + 8, 4);
        if (count > (size - 12) / 2)
            return false;
        if (count == 1)
            out->g = codec_big_endian(tag + 12, 2) / 256.0;
        else if (count > 1)
            out->table = tag + 12, out->count = count;
        return count != 1 || out->g > 0.0;
    }
    const unsigned kind = codec_big_endian(tag + 8, 2);
    if (memcmp(tag, "para", 4) != 0 || kind >= sizeof numbers || size < 12 + 4 * (size_t)numbers[kind])
        return false;
    double v[7] = {0};
    for (int i = 0; i < numbers[kind]; i++)
        v[i] = fixed_at(tag + 12 + 4 * i);
    *out = (codec_curve){.g = v[0], .a = 1.0};
    if (kind > 0)
        out->a = v[1], out->b = v[2];
    if (kind == 1 || kind == 2)
        out->d = out->a > 0.0 ? -out->b / out->a : 0.0, out->e = out->f = kind == 2 ? v[3] : 0.0;
    if (kind >= 3)
        out->c = v[3], out->d = v[4], out->e = v[5], out->f = v[6];
    return out->g > 0.0;
}

static bool read_colorant(const icc_profile *p, const char *name, int column, matrix *out)
{
    size_t size = 0;
    const unsigned char *tag = find_tag(p, name, &size);
    if (!tag || size < 20 || memcmp(tag, "XYZ ", 4) != 0)
        return false;
    for (int i = 0; i < 3; i++)
        out->m[i][column] = fixed_at(tag + 8 + 4 * i);
    return true;
}

static const char *read_matrix_profile(const icc_profile *p, codec_color *out)
{
    static const char *const curves[] = {"rTRC", "gTRC", "bTRC"}, *const colorants[] = {"rXYZ", "gXYZ", "bXYZ"};
    matrix XYZ, adapt;
    double d65[3];
    bool srgb = true;
    for (int c = 0; c < 3; c++) {
        if (!read_curve(p, curves[c], &out->curve[c]) || !read_colorant(p, colorants[c], c, &XYZ))
            return "has neither primaries nor tables that can be read";
        srgb &= is_srgb(&out->curve[c]);
    }
    if (!white_of(srgb_xy, d65) || !adaptation(d50, d65, &adapt))
        return "is damaged";
    out->curved = !srgb;
    set_matrix(out, product(srgb_of_XYZ(), product(adapt, XYZ)));
    return NULL;
}

const char *codec_color_of_icc(const unsigned char *bytes, size_t size, codec_color *out)
{
    const icc_profile p = {bytes, size};
    size_t ignored;
    codec_color read = {.curved = false};
    const char *reason = NULL;
    if (size < PROFILE_HEADER + 4 || memcmp(bytes + 36, "acsp", 4) != 0)
        return "is damaged";
    if (find_tag(&p, "A2B0", &ignored)) {
        reason = "consists of tables";
    } else if (memcmp(bytes + 16, "RGB XYZ ", 8) == 0) {
        reason = read_matrix_profile(&p, &read);
    } else if (memcmp(bytes + 16, "GRAY", 4) == 0) {
        codec_curve grey;
        if (!read_curve(&p, "kTRC", &grey))
            reason = "is damaged";
        else if (!is_srgb(&grey))
            codec_color_set_curve(&read, &grey);
    } else {
        reason = "is neither of RGB nor of grey values";
    }
    if (!reason)
        *out = read;
    return reason;
}
