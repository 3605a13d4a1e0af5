/* Complex numbers as pairs of doubles, for kernels: branch-free, only + - * /, so that every compiler gives the same
 * bits (C's own complex product calls a function for infinities). Pure; cannot fail. */
#pragma once

typedef struct complex_pair {
    double re, im;
} complex_pair;

static inline complex_pair complex_of(double re, double im)
{
    complex_pair z = {re, im};
    return z;
}

static inline complex_pair complex_add(complex_pair a, complex_pair b)
{
    return complex_of(a.re + b.re, a.im + b.im);
}

static inline complex_pair complex_sub(complex_pair a, complex_pair b)
{
    return complex_of(a.re - b.re, a.im - b.im);
}

static inline complex_pair complex_scale(complex_pair a, double times)
{
    return complex_of(a.re * times, a.im * times);
}

static inline complex_pair complex_multiply(complex_pair a, complex_pair b)
{
    return complex_of(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re);
}

/* -i a */
static inline complex_pair complex_minus_i(complex_pair a)
{
    return complex_of(a.im, -a.re);
}

/* conj(a) b */
static inline complex_pair complex_conj_multiply(complex_pair a, complex_pair b)
{
    return complex_of(a.re * b.re + a.im * b.im, a.re * b.im - a.im * b.re);
}

static inline double complex_norm2(complex_pair a)
{
    return a.re * a.re + a.im * a.im;
}

/* a / b; b != 0, and |b|^2 must not overflow. */
static inline complex_pair complex_divide(complex_pair a, complex_pair b)
{
    return complex_scale(complex_conj_multiply(b, a), 1.0 / complex_norm2(b));
}
