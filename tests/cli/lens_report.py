#!/usr/bin/env python3
"""Random lenses through `cuvette lens report` and through the sequential trace in this file, which shares nothing with
it: fans, wavefronts and spots. lens_report.py PROGRAM FOLDER COUNT SEED; prints the largest differences."""
import json
import math
import random
import subprocess
import sys

LINES = 587.5618, 486.1327, 656.2725  # d, F, C


def index(medium, nm):
    """Cauchy's formula through n_d with the Abbe number, as lens files without a catalogue have it."""
    if not medium:
        return 1.0
    n, V = medium
    d, F, C = (1.0 / line**2 for line in LINES)
    B = (n - 1.0) / (V * (F - C))
    return n + B * (1.0 / nm**2 - d)


def sag(s, r2):
    root = math.sqrt(1.0 - (1.0 + s['k']) * s['c'] ** 2 * r2)
    slope2 = s['c'] / root + 4.0 * s['a4'] * r2  # dz/dr over r
    return s['c'] * r2 / (1.0 + root) + s['a4'] * r2 * r2, slope2


def trace(lens, n, p, d):
    """Through all surfaces to the image: the point, the direction, the optical path, the point at the stop."""
    path, z = 0.0, 0.0
    stop = None
    p, d = list(p), list(d)
    for i, s in enumerate(lens['surfaces']):
        t = (z - p[2]) / d[2]
        for _ in range(60):
            x, y = p[0] + t * d[0], p[1] + t * d[1]
            high, slope = sag(s, x * x + y * y)
            step = (p[2] + t * d[2] - z - high) / (d[2] - slope * (x * d[0] + y * d[1]))
            t -= step
            if abs(step) < 1e-16:
                break
        p = [a + t * b for a, b in zip(p, d)]
        path += n[i] * t
        if i == lens['stop']:
            stop = p[0], p[1]
        _, slope = sag(s, p[0] ** 2 + p[1] ** 2)
        normal = [-slope * p[0], -slope * p[1], 1.0]
        size = math.sqrt(sum(a * a for a in normal))
        normal = [a / size for a in normal]
        mu = n[i] / n[i + 1]
        cosine = sum(a * b for a, b in zip(d, normal))
        root = math.sqrt(1.0 - mu * mu * (1.0 - cosine * cosine))
        d = [mu * a + (root - mu * cosine) * b for a, b in zip(d, normal)]
        z += s['t']
    t = (z - p[2]) / d[2]
    return [a + t * b for a, b in zip(p, d)], d, path + n[-1] * t, stop


def paraxial(lens, n, y, u):
    """Heights at the surfaces and the last slope."""
    heights = []
    for i, s in enumerate(lens['surfaces']):
        heights.append(y)
        u = (n[i] * u - y * (n[i + 1] - n[i]) * s['c']) / n[i + 1]
        if i + 1 < len(lens['surfaces']):
            y += s['t'] * u
    return heights, u


def exit_pupil(lens, n):
    """From the image's plane, at which the paraxial chief ray crosses the axis."""
    a, ua = paraxial(lens, n, 1.0, 0.0)
    b, ub = paraxial(lens, n, 0.0, 1.0)
    ratio = -b[lens['stop']] / a[lens['stop']]
    y, u = b[-1] + ratio * a[-1], ub + ratio * ua
    return -y / u - lens['surfaces'][-1]['t']


class Beam:
    def __init__(self, lens, nm, field, radius):
        self.lens, self.nm, self.radius = lens, nm, radius
        self.n = [1.0] + [index(s['medium'], nm) for s in lens['surfaces']]
        tangent = math.tan(math.radians(field))
        size = math.hypot(1.0, tangent)
        self.d = 0.0, tangent / size, 1.0 / size
        self.chief = self.ray(0.0, 0.0)

    def launched(self, x, y):
        # from a plane wavefront through (0, 0, -60): the path of all begins with the same phase
        dx, dy, dz = self.d
        ex, ey = (1.0, 0.0, 0.0), (0.0, dz, -dy)
        p = [x * a + y * b for a, b in zip(ex, ey)]
        p = [a - 60.0 * b for a, b in zip(p, self.d)]
        return trace(self.lens, self.n, p, self.d)

    def ray(self, px, py):
        x = y = 0.0
        target = px * self.radius, py * self.radius
        for _ in range(30):
            at = self.launched(x, y)[3]
            off = at[0] - target[0], at[1] - target[1]
            if math.hypot(*off) < 1e-13 * self.radius:
                break
            h = 1e-6
            by_x, by_y = self.launched(x + h, y)[3], self.launched(x, y + h)[3]
            a, b = (by_x[0] - at[0]) / h, (by_y[0] - at[0]) / h
            c, e = (by_x[1] - at[1]) / h, (by_y[1] - at[1]) / h
            det = a * e - b * c
            x, y = x - (e * off[0] - b * off[1]) / det, y - (a * off[1] - c * off[0]) / det
        return self.launched(x, y)

    def opd(self, ray, pupil):
        """Waves by which the path to the sphere about the chief ray's image is shorter than the chief ray's."""
        p, d, path, _ = ray
        centre, axis, chief, _ = self.chief
        R = -pupil / axis[2]
        e = [a - b for a, b in zip(p, centre)]
        ahead = sum(a * b for a, b in zip(e, d))
        q = sum(a * a for a in e) - ahead * ahead
        sphere = q / (R + math.copysign(math.sqrt(R * R - q), R))
        return (chief - path + self.n[-1] * (ahead - sphere)) / (self.nm * 1e-6)


def random_lens(r):
    """None for one that does not focus."""
    surfaces, cemented = [], False
    for element in range(r.randint(1, 3)):
        glass = round(r.uniform(1.45, 1.85), 4), round(r.uniform(25.0, 80.0), 2)
        power = 1.0 if element != 1 else -0.6
        first = power / r.uniform(25.0, 90.0) if r.random() < 0.8 else 0.0
        if not cemented:
            surfaces.append({'c': first, 't': r.uniform(4.0, 6.0), 'medium': glass})
        cemented = element == 0 and r.random() < 0.5
        if cemented:
            surfaces.append({'c': -1.0 / r.uniform(25.0, 60.0), 't': r.uniform(2.5, 4.0),
                             'medium': (round(r.uniform(1.6, 1.8), 4), round(r.uniform(25.0, 40.0), 2))})
            surfaces.append({'c': -1.0 / r.uniform(60.0, 200.0), 't': r.uniform(2.0, 6.0), 'medium': None})
            cemented = False
        else:
            surfaces.append({'c': -power / r.uniform(25.0, 90.0), 't': r.uniform(2.0, 6.0), 'medium': None})
    stop = r.randrange(len(surfaces) + 1)
    if stop < len(surfaces) and (stop == 0 or surfaces[stop - 1]['medium'] is None):
        surfaces.insert(stop, {'c': 0.0, 't': r.uniform(2.5, 5.0), 'medium': None, 'stop': True})
    else:
        stop = r.randrange(len(surfaces))
    for s in surfaces:
        s['c'] = s['c'] and 1.0 / round(1.0 / s['c'], 5)
        s['t'] = round(s['t'], 4)
        s['k'] = round(r.uniform(-1.5, 0.5), 3) if r.random() < 0.3 and s['c'] else 0.0
        s['a4'] = round(r.uniform(-2e-6, 2e-6), 9) if r.random() < 0.2 and s['c'] else 0.0
    lens = {'surfaces': surfaces, 'stop': stop}
    n = [1.0] + [index(s['medium'], LINES[0]) for s in surfaces]
    heights, u = paraxial(lens, n, 1.0, 0.0)
    focus = -heights[-1] / u
    if not -1.0 / 20.0 < u < -1.0 / 300.0 or focus < 10.0:
        return None
    surfaces[-1]['t'] = round(focus * r.uniform(0.99, 1.01), 3)
    return lens


def write(lens, path, field, pupil):
    with open(path, 'w', encoding='utf-8') as out:
        out.write(f'pupil, {pupil}\nfield_deg, 0, {field}\nwavelength_nm, {", ".join(map(str, LINES))}\n')
        out.write('radius, thickness, medium, diameter, conic, a4, stop\n')
        for i, s in enumerate(lens['surfaces']):
            medium = '%s/%s' % s['medium'] if s['medium'] else ''
            radius = repr(round(1.0 / s['c'], 5)) if s['c'] else '0'
            out.write(f"{radius}, {s['t']!r}, {medium}, 20, {s['k']!r}, {s['a4']!r}, {int(i == lens['stop'])}\n")


def compare(lens, report, fields):
    """The largest differences: of ray aberrations and root mean squares, mm; of wavefronts, waves."""
    sections = {name: s['values'] for name, s in report['sections'].items()}
    radius = 0.5 * sections['first-order']['stop_diameter_real'] * (1.0 - 1e-11)
    pupil = exit_pupil(lens, [1.0] + [index(s['medium'], LINES[0]) for s in lens['surfaces']])
    beams, far, waves, rays = {}, 0.0, 0.0, 0
    for i, field in enumerate(fields):
        for nm in LINES:
            beams[i + 1, nm] = Beam(lens, nm, field, radius)
    for name, across in (('fan-tangential', False), ('fan-sagittal', True)):
        fan = sections[name]
        for k, p in enumerate(fan['x']):
            if fan['opd'][k] is None:
                continue
            field, nm = int(fan['field'][k]), fan['lambda_nm'][k]
            beam, about = beams[field, nm], beams[field, LINES[0]].chief[0]
            ray = beam.ray(-p if across else 0.0, 0.0 if across else p)
            far = max(far, abs(ray[0][1] - about[1] - fan['e_tangential'][k]),
                      abs(about[0] - ray[0][0] - fan['e_sagittal'][k]))
            waves = max(waves, abs(beam.opd(ray, pupil) - fan['opd'][k]))
            rays += 1
    spot, cells = sections['spot'], 8
    for k, nm in enumerate(spot['lambda_nm']):
        field = int(spot['field'][k])
        if sections['vignetting']['passes'][field - 1] < 1.0 or nm == 0.0 or nm != LINES[0]:
            continue
        beam, points = beams[field, nm], []
        about = beam.chief[0]
        for i in range(cells):
            for j in range(cells):
                px, py = (2 * i + 1) / cells - 1.0, (2 * j + 1) / cells - 1.0
                if px * px + py * py <= 1.0:
                    p = beam.ray(px, py)[0]
                    points.append((p[0] - about[0], p[1] - about[1]))
        x, y = (sum(a) / len(points) for a in zip(*points))
        rms = math.sqrt(sum((a - x) ** 2 + (b - y) ** 2 for a, b in points) / len(points))
        far = max(far, abs(rms - spot['rms_centroid'][k]))
    return far, waves, rays


def main():
    program, folder, count, seed = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    r, far, waves, rays, refused = random.Random(seed), 0.0, 0.0, 0, 0
    for _ in range(count):
        while True:
            lens, field, pupil = random_lens(r), round(r.uniform(1.0, 6.0), 3), round(r.uniform(3.0, 7.0), 2)
            if not lens:
                continue
            path = f'{folder}/lens.csv'
            write(lens, path, field, pupil)
            words = ('--json', '--fan', '4', '--spot', '8', '--wave', '8', path)
            done = subprocess.run([program, 'lens', 'report', *words], capture_output=True, text=True, check=False)
            if done.returncode == 0:
                break
            refused += 1
            if refused > 5 * count:
                sys.exit(f'too many lenses are refused: {done.stderr}')
        at = compare(lens, json.loads(done.stdout), (0.0, field))
        far, waves, rays = max(far, at[0]), max(waves, at[1]), rays + at[2]
    print(f'{far:.3g} {waves:.3g} {rays} {refused}')


main()
