"""The documentation as HTML: build.py CUVETTE MANUAL FOLDER [LABORATORY] (make doc, make site).

MANUAL is the folder of the complete manual pages, build/man. LABORATORY is the address of a laboratory that runs in the
browser, relative to FOLDER: pages link to it. 
Every page comes from a source that is also read elsewhere: manual pages, Markdown, the public header, lessons. FOLDER
must be new or empty. The same sources and program give the same bytes."""

import os
import re
import subprocess
import sys
from pathlib import Path

import frame
import header
import lessons
import manual
import validation
from laboratory import Laboratory
from links import Links
from page import Group, Page, Trouble, output_of

ROOT = Path(__file__).resolve().parents[3]
REST = 'src/manual/man7/*'  # pages that no other group names

GROUPS = (
    Group('Start', 'What Cuvette does, its first image, and each of its parts in one command.',
          ('README.md', 'src/manual/man7/cuvette-tour.7')),
    Group('Tutorial', 'Exercises with values to compute by hand and to trace.', ('src/manual/man7/*tutorial*',)),
    Group('Commands', 'Purpose, options, examples and exit status of every command.', ('src/manual/man1/*',)),
    Group('File formats', 'What is in every file that Cuvette reads or writes.',
          ('src/manual/man5/*', 'results/README.md')),
    Group('Optics', 'The models, their limits, and how times are measured.', (REST,)),
    Group('Engine API', 'The library and the laboratory for your own programs.',
          ('src/cuvette.h', 'src/manual/man3/*', 'src/manual/man7/*python*', 'src/web/README.md')),
    Group('Lessons', 'Guided experiments: predict, measure, compare with theory.',
          ('experiments/lessons', 'experiments/lessons/*.lesson')),
    Group('Gallery', 'Images and figures, each with the command that makes it.', ('src/manual/site/gallery.md',)),
    Group('Development', 'How to build, test and extend Cuvette; what has changed.',
          ('CONTRIBUTING.md', 'CHANGELOG.md')),
)
LABELS = {
    'README.md': 'First steps',
    'results/README.md': 'Data dictionary',
    'src/web/README.md': 'Laboratory and HTTP',
    'src/manual/site/gallery.md': 'Gallery',
    'CONTRIBUTING.md': 'Contributing',
    'CHANGELOG.md': 'Changelog',
}


def convert(source, program, pages):
    """The page of one source, by its kind."""
    path = ROOT / source
    if source.endswith('/cuvette-validation.7'):
        return validation.page(ROOT, source)
    if re.fullmatch(r'src/manual/man\d/.*', source):
        return manual.page(pages / path.relative_to(ROOT / 'src/manual'))
    if source.endswith('.h'):
        return header.page(path, sorted((ROOT / 'experiments/engine').glob('*.c')), ROOT)
    if source.endswith('.lesson'):
        return lessons.page(ROOT, source, program)
    if path.is_dir():
        return lessons.overview(ROOT, source)
    return markdown(path, source)


def markdown(path, source):
    text = re.sub(r'^(#+ .*)<(\w+)>', r'\1\\<\2>', path.read_text(encoding='utf-8'), flags=re.M)  # a word, not a tag
    body = output_of('cmark-gfm', '-e', 'table', input=text)
    body = re.sub(r'<p>(<img [^>]*alt="([^"]*)"[^>]*>)</p>', r'<figure>\1<figcaption>\2</figcaption></figure>', body)
    title = re.search(r'<h1>(.*?)</h1>', body)[1]
    label = LABELS.get(source, title)
    return Page(re.sub(r'[^a-z0-9]+', '-', label.lower()), label, title, frame.with_ids(body))


def by_name(path):
    """cuvette(1) comes before its commands."""
    return path.parent, path.stem


def collect(program, pages):
    """All pages of all groups, in the order of the navigation."""
    taken = set()
    found = {}
    for group in sorted(GROUPS, key=lambda group: REST in group.patterns):
        paths = [path for pattern in group.patterns for path in sorted(ROOT.glob(pattern), key=by_name)]
        sources = [str(path.relative_to(ROOT)) for path in paths]
        found[group.title] = [source for source in dict.fromkeys(sources) if source not in taken]
        taken.update(sources)
    for group in GROUPS:
        for source in found[group.title]:
            page = convert(source, program, pages)
            page.source, page.group = source, group
            group.pages.append(page)
    return [page for group in GROUPS for page in group.pages]


def build(program, manual_pages, folder, address):
    laboratory = Laboratory(ROOT, program, address)
    pages = collect(program, manual_pages)
    links = Links(ROOT, folder, pages)
    readme = next(page for page in pages if page.source == 'README.md')
    first = Page('index', 'Cuvette', 'Cuvette', frame.index(readme.body, GROUPS))
    first.source, first.group = 'README.md', None
    version = re.search(r'^\.TH .*"Cuvette ([\d.]+)"', (ROOT / 'src/manual/man1/cuvette.1').read_text(), re.M)[1]
    waiting = [first, *pages]
    while waiting:  # a link to a text file of the project adds a page for the file
        page = waiting.pop(0)
        body = laboratory.add(page, links.resolve(page))
        waiting += links.new_pages()
        (folder / page.file).write_text(frame.whole(page, body, GROUPS, version, address), encoding='utf-8')
    (folder / 'style.css').write_bytes((Path(__file__).parent / 'style.css').read_bytes())


def main():
    if len(sys.argv) not in (4, 5):
        raise Trouble('usage: build.py CUVETTE MANUAL FOLDER [LABORATORY]')
    program, pages, folder = (Path(argument).resolve() for argument in sys.argv[1:4])
    if folder.exists() and os.listdir(folder):
        raise Trouble(f'{sys.argv[3]} is not empty; give a new folder')
    folder.mkdir(parents=True, exist_ok=True)
    build(program, pages, folder, sys.argv[4] if len(sys.argv) == 5 else None)


if __name__ == '__main__':
    try:
        main()
    except subprocess.CalledProcessError as error:
        sys.exit(f'doc: {" ".join(map(str, error.cmd))} failed: {error.stderr.strip()}')
    except (Trouble, OSError) as error:
        sys.exit(f'doc: {error}')
