"""The images that are shown before an engine has rendered (make page-images).

Writes src/web/page/lessons/NAME.jpg for each lesson, with the rays of its beams, and first.jpg here, the scene with
which the site opens; removes images of lessons that do not exist any more. Prints their sizes, and fails if they are
large. Needs djpeg and cjpeg (libjpeg-turbo-progs)."""

import json
import re
import subprocess
import sys
import tempfile
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
LESSONS = ROOT / 'src/web/page/lessons'
LESSON = (320, 240)  # covers these pixels: a card of the gallery, sharp also on most telephones
FIRST = (800, 600)
FIRST_IMAGE = Path(__file__).parent / 'first.jpg'
FIRST_SCENE = ROOT / 'experiments/scenes/rod.yaml'
SAMPLES = 4
QUALITY = '60'
LIMIT = 20_000  # bytes of a lesson's image


def small_jpeg(path):
    pixels = subprocess.run(['djpeg', path], check=True, capture_output=True).stdout
    small = subprocess.run(['cjpeg', '-quality', QUALITY, '-sample', '2x2', '-optimize', '-progressive'], check=True,
                           input=pixels, capture_output=True).stdout
    path.write_bytes(small)


def render(cuvette, scene, size, output):
    listed = subprocess.run([cuvette, 'params', scene, '--json'], check=True, capture_output=True).stdout
    values = json.loads(listed)['params']
    value = {row['path']: row['value'] for row in values if row['path'].startswith('render.')}
    width, height = value['render.width'], value['render.height']
    shrink = min(max(size[0] / width, size[1] / height), 1)
    options = [
        f'--set=render.width={round(width * shrink)}', f'--set=render.height={round(height * shrink)}',
        f'--set=render.samples={max(SAMPLES, value["render.samples"])}'
    ]
    subprocess.run([cuvette, 'render', '--beams', scene, '-o', output, *options], check=True, capture_output=True)
    small_jpeg(output)


class Laboratory:
    """A running `cuvette lab` without a page."""

    def __init__(self, cuvette, folder):
        self.process = subprocess.Popen([cuvette, 'lab', '--no-browser', '--folder', folder], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)
        for line in self.process.stdout:
            found = re.search(r'(http://[\d.]+:\d+)/\?token=(\w+)', line)
            if found:
                self.origin, self.token = found.groups()
                return
        raise OSError('cuvette lab printed no address')

    def ask(self, path, body=None):
        request = urllib.request.Request(self.origin + path, data=None if body is None else json.dumps(body).encode())
        request.add_header('Authorization', f'Bearer {self.token}')
        request.add_header('Content-Type', 'application/json')
        with urllib.request.urlopen(request) as reply:
            return reply.read()

    def end(self):
        self.process.terminate()
        self.process.wait()


def lessons(cuvette, scratch):
    laboratory = Laboratory(cuvette, scratch)
    try:
        made = []
        for one in json.loads(laboratory.ask('/api/lessons'))['lessons']:
            laboratory.ask(f'/api/lessons/{one["name"]}/open', {})
            scene = scratch / f'{one["name"]}.yaml'
            scene.write_bytes(laboratory.ask('/api/scene.yaml'))
            made.append(LESSONS / f'{one["name"]}.jpg')
            render(cuvette, scene, LESSON, made[-1])
        return made
    finally:
        laboratory.end()


def main():
    if len(sys.argv) != 2:
        raise OSError('usage: images.py CUVETTE')
    cuvette = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        made = lessons(cuvette, Path(scratch))
    for path in set(LESSONS.glob('*.jpg')) - set(made):
        path.unlink()
    render(cuvette, FIRST_SCENE, FIRST, FIRST_IMAGE)
    for path in [*made, FIRST_IMAGE]:
        print(f'{path.stat().st_size:8,} {path.relative_to(ROOT)}')
    large = [path.name for path in made if path.stat().st_size > LIMIT]
    if large:
        raise OSError(f'more than {LIMIT:,} bytes: {", ".join(large)}')


if __name__ == '__main__':
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f'images: {error}')
