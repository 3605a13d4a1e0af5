"""The parts of the laboratory for browsers, bundled and minified by esbuild, and the documents that hold them."""

import base64
import gzip
import json
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / 'src/web/page'
EXPERIMENTS = ROOT / 'experiments'
FOLDERS = ('scenes', 'hands', 'lessons')
READ_BY_SCENES = ('.yaml', '.lesson')
# A link brings a stranger's scene: nothing may be loaded or run but the page
# and what is next to it.
POLICY = ("default-src 'none'; img-src 'self' data: blob:; media-src blob:; style-src 'self' 'unsafe-inline'; "
          "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src 'self' blob:; "
          "connect-src 'self' data: blob:; base-uri 'none'; form-action 'none'")
META = (f'<meta http-equiv="Content-Security-Policy" content="{POLICY}" />\n'
        '<meta name="cuvette-engine" content="browser" />')
TARGET = '--target=es2022'
# Shown until the engine has rendered an image (view.js), if the page opens the site's first scene (boot.js).
FIRST = ('<img class="first-image" alt="" width="800" height="600" src="data:image/jpeg;base64,{}" />'
         '<p class="first-progress"><progress aria-label="Loading the laboratory"></progress><span></span></p>')


class Trouble(Exception):
    """One line for the user: what is wrong, where, what to do."""


def esbuild(*options, text=None):
    result = subprocess.run(['esbuild', '--minify', '--charset=utf8', '--log-level=error', *map(str, options)],
                          input=text, capture_output=True, encoding='utf-8')
    if result.returncode:
        raise Trouble(f'esbuild: {result.stderr.strip()}')
    return result.stdout


def module(path):
    """A script and all that it imports."""
    return esbuild(path, '--bundle', '--format=esm', TARGET)


def classic(path):
    """A script that runs at once, before the page is parsed, and all that it imports."""
    return esbuild(path, '--bundle', '--format=iife', TARGET)


def minified(path):
    """A classic script, not bundled, so that other scripts can use its names."""
    return esbuild(path, TARGET)


def style():
    """All style sheets, in the order in which the page loads them: its own, then those of the panels."""
    names = re.findall(r'<link rel="stylesheet" href="([^"]+)"', (PAGE / 'index.html').read_text(encoding='utf-8'))
    panels = sorted(PAGE.glob('*/panel_*.css'), key=lambda path: path.name)
    sheets = '\n'.join(path.read_text(encoding='utf-8') for path in [PAGE / name for name in names] + panels)
    return esbuild('--loader=css', text=sheets)


def files():
    """The laboratory's folder, as JSON: {NAME: text or {base64}}: scenes, lessons, hands, and what they read."""
    found = [path for folder in FOLDERS for path in sorted((EXPERIMENTS / folder).iterdir())]
    text = {path: path.read_text(encoding='utf-8') for path in found if path.suffix in READ_BY_SCENES}
    named = set(re.findall(r'[\w-]+\.(?:png|jpg|obj|ply|hdr|pfm)', '\n'.join(text.values())))
    packed = {}
    for path in found:
        name = str(path.relative_to(EXPERIMENTS))
        if path in text:
            packed[name] = text[path]
        elif path.name in named:
            packed[name] = {'base64': base64.b64encode(path.read_bytes()).decode()}
    return json.dumps(packed, ensure_ascii=False, separators=(',', ':'))


def languages():
    """The catalogues: {CODE: JSON}."""
    catalogues = {path.stem: json.loads(path.read_text(encoding='utf-8')) for path in PAGE.glob('languages/*.json')}
    return {code: json.dumps(texts, ensure_ascii=False, separators=(',', ':')) for code, texts in catalogues.items()}


def replaced(text, pattern, new):
    """The text with `new` instead of the first match, and without the other matches."""
    found = list(re.finditer(pattern, text))
    if not found:
        raise Trouble(f'src/web/page/index.html: nothing matches {pattern}; correct src/web/site/bundle.py')
    for match in reversed(found):
        text = text[:match.start()] + (new if match is found[0] else '') + text[match.end():]
    return text


def document(head, end):
    """The page with one style sheet and its icon; head and end are added to its head and at its end."""
    text = (PAGE / 'index.html').read_text(encoding='utf-8')
    icon = base64.b64encode((PAGE / 'icon.svg').read_bytes()).decode()
    text = replaced(text, r'href="icon\.svg"', f'href="data:image/svg+xml;base64,{icon}"')
    text = replaced(text, r' *<script type="module" src="main\.js"></script>\n', '')
    styles = f'{head}<style id="styles">{style()}</style>\n'
    text = replaced(text, r' *<link rel="stylesheet" href="[^"]+" />\n', styles)
    first = base64.b64encode((Path(__file__).parent / 'first.jpg').read_bytes()).decode()
    text = replaced(text, r'(?<=<section class="view" id="view" aria-label="Image">)', FIRST.format(first))
    text = replaced(text, r'<meta charset="utf-8" />', f'<meta charset="utf-8" />\n{META}')
    return replaced(text, r' *</body>', f'{end}</body>')


def packed(content):
    return gzip.compress(content, 9, mtime=0)


def part_element(name, content):
    """An element that holds a part, which boot.js unpacks."""
    return f'<script type="text/plain" id="cuvette-{name}">{base64.b64encode(packed(content)).decode()}</script>\n'


def lesson_images():
    return sorted((PAGE / 'lessons').glob('*.jpg'))


def image_element():
    """An element that holds the images of lessons (panel_lessons.js)."""
    images = {path.stem: base64.b64encode(path.read_bytes()).decode() for path in lesson_images()}
    return f'<script type="application/json" id="cuvette-images">{json.dumps(images)}</script>\n'


def script(text, kind=''):
    if re.search(r'</script|<!--', text, re.I):
        raise Trouble('a script of the page contains </script or <!--; write it in two parts')
    return f'<script{kind}>{text.strip()}</script>\n'
