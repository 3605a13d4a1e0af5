"""The light of lamps out of focus (experiments/lenses/bokeh.yaml) over that of the middle one, by photons; and the part
of the pupil that passes over that on the axis, by the rays of `cuvette lens report`, times the cosine of the field: the
entrance pupil is seen from the side. bokeh.py PROGRAM LENSES FOLDER"""
import array
import json
import math
import subprocess
import sys

program, lenses, folder = sys.argv[1:]
PITCH, TANGENT = 4.25, 55.0  # of the lamps on the film, mm, and over their tangents
LAMPS = ((0, 0), (2, 0), (-3, 0), (4, -2))  # columns and rows from the middle, to the right and downwards
WIDTH, HEIGHT, MM = 900, 600, 24 / 600


def run(*arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True).stdout


off = []
for row in range(-2, 3):
    for column in range(-4, 5):
        if (column, row) not in LAMPS:
            off += ['--set', f'lamp-{row + 3}{column + 5}.visible=off']
run('render', f'{lenses}/bokeh.yaml', '-o', f'{folder}/discs.pfm', '--set', 'render.photons=20000', *off)
with open(f'{folder}/discs.pfm', 'rb') as file:
    assert [file.readline() for _ in range(3)][1].split() == [b'%d' % WIDTH, b'%d' % HEIGHT]
    pixels = array.array('f', file.read())


def light(column, row):
    """Of the square around a lamp's disc. Rows of a PFM go upwards."""
    side = PITCH / 2 / MM
    x, y = WIDTH / 2 + side * 2 * column, HEIGHT / 2 - side * 2 * row
    return sum(pixels[3 * (v * WIDTH + u) + 1] for v in range(int(y - side), min(int(y + side), HEIGHT))
               for u in range(int(x - side), min(int(x + side), WIDTH)))


fields = [math.degrees(math.atan(PITCH * math.hypot(*lamp) / TANGENT)) for lamp in LAMPS]
report = json.loads(run('lens', 'report', f'{lenses}/dgauss.50mm.dat', '--json', '--spot', '128', '--field',
                        ','.join(f'{field:.6f}' for field in fields)))
passes = report['sections']['vignetting']['values']['passes']
lights = [light(*lamp) for lamp in LAMPS]
for k in range(1, len(LAMPS)):
    expected = passes[k] / passes[0] * math.cos(math.radians(fields[k]))
    print(f'lamp at {fields[k]:.2f} {lights[k] / lights[0]:.4f} report {expected:.4f}')
