#!/usr/bin/env python3
"""A double Gauss objective, with the dispersion formulas of its glasses' catalogue, and what formulas and traces that
share nothing with the program say of it: lens_design.py write (glass.agf and gauss.zmx into the working folder), or one
of the functions named below. The lens is Zemax's sample; indices are those of Schott's catalogue."""
import math
import sys

# n_d, V_d, and Sellmeier's B1 C1 B2 C2 B3 C3 (C in um^2).
GLASS = {
    'SK16': (1.62041, 60.32, (1.34317774, 0.00704687339, 0.241144399, 0.0229005, 0.994317969, 92.7508526)),
    'F5': (1.60342, 38.03, (1.3104463, 0.00958633048, 0.19603426, 0.0457627627, 0.96612977, 115.011883)),
    'SK2': (1.60738, 56.65, (1.28189012, 0.0072719164, 0.257738258, 0.0242823527, 0.96818604, 110.377773)),
    'SSK2': (1.62229, 53.27, (1.4306027, 0.00823982975, 0.153150554, 0.0333736841, 1.01390904, 106.870822)),
}
# Curvature, thickness, glass and clear diameter.
SURFACES = [
    (1.7792840801403780e-2, 8.75, 'SSK2', 58.4506), (6.5666004315569810e-3, 0.5, None, 56.282),
    (2.6537432906735250e-2, 12.5, 'SK2', 48.592), (0.0, 3.8, 'F5', 42.5944),
    (4.1268937283596010e-2, 16.36945, None, 29.8388), (0.0, 13.74796, None, 20.4576),
    (-3.5239421918427080e-2, 3.8, 'F5', 26.376), (0.0, 11.0, 'SK16', 32.9366),
    (-2.6367511428997830e-2, 0.5, None, 37.8592), (5.6366049240478760e-3, 7.0, 'SK16', 42.6216),
    (-1.2592645668262110e-2, 61.48754, None, 43.2922),
]
STOP, PUPIL, FIELDS = 5, 33.33, (0.0, 10.0, 14.0)
WAVES = (486.1327, 0.7), (587.5618, 1.0), (656.2725, 0.4)


def index(glass, nm):
    if glass is None:
        return 1.0
    c, q = GLASS[glass][2], (nm / 1000.0) ** 2
    return math.sqrt(1.0 + sum(c[i] * q / (q - c[i + 1]) for i in (0, 2, 4)))


def write(stop="STOP"):
    with open('glass.agf', 'w') as out:
        print('CC glasses', file=out)
        for name, (n, V, c) in GLASS.items():
            print(f'NM {name} 2 0 {n} {V} 0 1\nCD', *c, '\nLD 0.31 2.5', file=out)
            print('IT 0.4 0.9 10\nIT 0.55 0.99 10\nIT 0.7 0.98 10', file=out)
    with open('gauss.zmx' if stop else 'nostop.zmx', 'w') as out:
        print('MODE SEQ\nNAME Double Gauss\nUNIT MM\nENPD', PUPIL, f'0\nFTYP 0 0 {len(FIELDS)} 3\nXFLN 0 0 0\nYFLN',
              *FIELDS, file=out)
        for i, (nm, weight) in enumerate(WAVES):
            print('WAVM', i + 1, nm / 1000.0, weight, file=out)
        print('PWAV 2\nSURF 0\n  DISZ INFINITY', file=out)
        for i, (c, t, glass, d) in enumerate(SURFACES):
            print(f'SURF {i + 1}\n  COMM side {i + 1}\n  CURV {c!r}\n  DISZ {t!r}\n  DIAM {d / 2}', file=out)
            if i == STOP and stop:
                print('  STOP', file=out)
            if glass:
                print(f'  GLAS {glass} 0 0 1.5 40', file=out)
        print(f'SURF {len(SURFACES) + 1}\n  DISZ 0', file=out)


def paraxial():
    """Focal length and focus from the image's plane, mm, by wavelength."""
    for nm, _ in WAVES:
        y, u, n = 1.0, 0.0, 1.0
        for c, t, glass, _ in SURFACES:
            after = index(glass, nm)
            u = (n * u - y * c * (after - n)) / after
            n, last = after, y
            y += u * t
        print(f'{nm:.4f} {-1.0 / u:.7f} {-last / u - SURFACES[-1][1]:.7f}')


def meridional(y, u, nm):
    """A ray in the meridional plane from the first vertex's plane, as (height, sine, path) in the image's plane, and
    its height at the stop."""
    z, n, path, slope = 0.0, 1.0, 0.0, math.sqrt(1.0 - u * u)
    dy, dz, stop, at = u, slope, 0.0, 0.0  # z: of the ray's point, `at` of the vertex
    for i, (c, t, glass, _) in enumerate(SURFACES):
        A, B, C = c, dz - c * (y * dy + (z - at) * dz), c * (y * y + (z - at) ** 2) - 2.0 * (z - at)
        s = C / (B + math.copysign(math.sqrt(B * B - A * C), dz))
        y, z, path = y + s * dy, z + s * dz, path + n * s
        if i == STOP:
            stop = y
        ny, nz = -c * y, 1.0 - c * (z - at)  # unit normal of a sphere
        mu = n / index(glass, nm)
        ci = dy * ny + dz * nz
        ct = math.sqrt(1.0 - mu * mu * (1.0 - ci * ci))
        dy, dz, n = mu * dy + (ct - mu * ci) * ny, mu * dz + (ct - mu * ci) * nz, index(glass, nm)
        at += t
    s = (at - z) / dz
    return y + s * dy, dy, path + s, stop


def transmission():
    """Of the surfaces, on the axis, by wavelength: Fresnel at normal incidence."""
    for nm, _ in WAVES:
        surfaces, n = 1.0, 1.0
        for _, _, glass, _ in SURFACES:
            after = index(glass, nm)
            surfaces *= 1.0 - ((after - n) / (after + n)) ** 2
            n = after
        print(f'{nm:.4f} {surfaces:.6f}')


def strehl():
    """On the axis, by wavelength: the Debye integral along the pupil's radius, for a rotationally symmetric wavefront
    on the sphere about the image's point that reaches to the exit pupil."""
    y, u, n = 0.0, 1.0, 1.0
    for c, t, glass, _ in SURFACES[STOP:]:
        after = index(glass, WAVES[1][0])
        u = (n * u - y * c * (after - n)) / after
        n, last = after, y
        y += u * t
    exit_ray = -last / u - SURFACES[-1][1]  # from the image to the exit pupil
    stop = abs(meridional(PUPIL / 2, 0.0, WAVES[1][0])[3])
    for nm, _ in WAVES:
        low, high = 0.0, PUPIL
        for _ in range(80):  # the marginal ray, at the stop's edge
            middle = 0.5 * (low + high)
            low, high = (middle, high) if meridional(middle, 0.0, nm)[3] < stop else (low, middle)
        count, R, samples = 4000, exit_ray, []
        chief = meridional(0.0, 0.0, nm)[2]
        for i in range(count + 1):
            e, sine, path, _ = meridional(low * i / count, 0.0, nm)
            cosine = math.sqrt(1.0 - sine * sine)
            # to the sphere x^2 + z^2 = R^2 about (0, 0), from (e, 0) along (sine, cosine); R is below 0
            back = -e * sine - math.sqrt(e * e * sine * sine + R * R - e * e)
            samples.append((sine * sine, ((path + back) - (chief + R)) / (nm * 1e-6)))
        re = im = 0.0
        for (a, v), (b, w) in zip(samples, samples[1:]):
            middle = 2.0 * math.pi * 0.5 * (v + w)
            re, im = re + (b - a) * math.cos(middle), im + (b - a) * math.sin(middle)
        print(f'{nm:.4f} {math.hypot(re, im) ** 2 / samples[-1][0] ** 2:.6f}')


if __name__ == '__main__':
    globals()[sys.argv[1]](*sys.argv[2:])
