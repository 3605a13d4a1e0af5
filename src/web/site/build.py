"""The laboratory for any browser: python3 -B src/web/site/build.py WASM FOLDER (make site).

Writes FOLDER/laboratory, plain files for any web server, and FOLDER/laboratory.html, the same in one file that also
opens from a local folder. WASM is the folder of `make wasm`. Prints what is loaded before the first image, and fails if
that is too much. Addresses are relative."""

import gzip
import sys
from pathlib import Path

import bundle
from bundle import Trouble

LIMIT = 3_000_000  # bytes, compressed
SETS = ('simd128', 'plain')
ENGINE = ('worker.js', 'cuvette.wasm')


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode())


def existing(path):
    if not path.exists():
        raise Trouble(f'{path} does not exist; run: make wasm')
    return path


def engine_part(wasm, set_name, name):
    path = existing(wasm / set_name / name)
    return bundle.minified(path).encode() if path.suffix == '.js' else path.read_bytes()


def write_folder(parts, wasm, folder):
    """laboratory/: a folder for each set of instructions of the engine, of which a browser loads one."""
    head = bundle.script(parts['boot']) + '<link rel="modulepreload" href="lab.js" />\n'
    write(folder / 'index.html', bundle.document(head, '<script type="module" src="lab.js"></script>\n'))
    write(folder / 'lab.js', parts['lab'])
    for path in bundle.lesson_images():
        write(folder / 'lessons' / path.name, path.read_bytes())
    for name, catalogue in parts['languages'].items():
        write(folder / f'languages/{name}.json', catalogue)
    engine = {'files.json': parts['files'].encode()}
    engine |= {f'{set_name}/{name}': engine_part(wasm, set_name, name) for set_name in SETS for name in ENGINE}
    for name, content in engine.items():
        write(folder / 'engine' / name, content)
        write(folder / f'engine/{name}.packed', bundle.packed(content))


def one_file(parts, wasm):
    """laboratory.html, with the engine for vectors: every browser that can unpack it has them."""
    content = {'worker': engine_part(wasm, SETS[0], ENGINE[0]), 'module': engine_part(wasm, SETS[0], ENGINE[1]),
               'files': parts['files'].encode(),
               **{f'language-{name}': catalogue.encode() for name, catalogue in parts['languages'].items()}}
    end = ''.join(bundle.part_element(name, part) for name, part in content.items()) + bundle.image_element()
    end += bundle.script(parts['lab'], ' type="module"') + bundle.script(parts['boot'])
    return bundle.document('', end)


def report(title, paths, base):
    """Prints the sizes of each file and their sums; returns the sum of the compressed sizes."""
    total = [0, 0]
    print(f'{title}\n{"":48}{"bytes":>12}{"gzip":>12}')
    for path in paths:
        content = path.read_bytes()
        sizes = len(content), len(gzip.compress(content, 9))
        total = [a + b for a, b in zip(total, sizes)]
        print(f'  {str(path.relative_to(base)):46}{sizes[0]:12,}{sizes[1]:12,}')
    print(f'  {"all":46}{total[0]:12,}{total[1]:12,}')
    return total[1]


def report_sizes(folder):
    loaded = [folder / 'laboratory' / name for name in ('index.html', 'lab.js', 'engine/files.json.packed')]
    sums = [
        report(f'loaded before the first image, {set_name}:',
               loaded + sorted((folder / 'laboratory/engine' / set_name).glob('*.packed')), folder) for set_name in SETS
    ] + [report('in one file:', [folder / 'laboratory.html'], folder)]
    if max(sums) > LIMIT:
        raise Trouble(f'{max(sums):,} bytes are loaded before the first image, more than {LIMIT:,}; reduce them')


def main():
    if len(sys.argv) != 3:
        raise Trouble('usage: build.py WASM FOLDER')
    wasm, folder = Path(sys.argv[1]), Path(sys.argv[2])
    parts = {
        'boot': bundle.classic(Path(__file__).parent / 'boot.js'),
        'lab': bundle.module(bundle.PAGE / 'main.js'),
        'files': bundle.files(),
        'languages': bundle.languages(),
    }
    write_folder(parts, wasm, folder / 'laboratory')
    write(folder / 'laboratory.html', one_file(parts, wasm))
    report_sizes(folder)


if __name__ == '__main__':
    try:
        main()
    except (Trouble, OSError) as error:
        sys.exit(f'site: {error}')
