"""Checks the documentation site: doc_check.py FOLDER. Prints each fault as one line, FILE: FAULT.

Every page is well formed and complete, every link and anchor leads somewhere within the folder, nothing is loaded from
elsewhere, no page is without a link to it. Only links of the text may lead to https: pages. A folder with an index.html
of its own, the laboratory, is one target."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

VOID = {'meta', 'link', 'img', 'br', 'hr', 'source', 'col', 'wbr', 'path', 'circle', 'polyline'}
BLOCK = {'p', 'div', 'ul', 'ol', 'dl', 'pre', 'table', 'section', 'figure', 'details', 'h1', 'h2', 'h3', 'h4', 'nav'}
RESOURCE = {'src', 'srcset', 'data', 'poster', 'action', 'background'}
FORBIDDEN = {'script', 'iframe', 'object', 'embed', 'base', 'form'}


class Reader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.faults, self.ids, self.targets, self.count = [], [], set(), [], {}

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.count[tag] = self.count.get(tag, 0) + 1
        self.check_place(tag)
        if tag not in VOID:
            self.open.append(tag)
        if tag == 'br' and 'pre' in self.open:
            self.fault('an example has lines that its source does not have')
        if tag in FORBIDDEN or any(name.startswith('on') for name in values) or 'style' in values:
            self.fault(f'<{tag}> with a script, a style or content from elsewhere')
        if tag == 'img' and not (values.get('alt') or '').strip():
            self.fault(f'the image {values.get("src")} has no alternative text')
        if tag == 'svg' and not values.get('aria-label'):
            self.fault('an <svg> has no label')
        if 'id' in values:
            if values['id'] in self.ids:
                self.fault(f'two elements have the id {values["id"]}')
            self.ids.add(values['id'])
        for name in RESOURCE | {'href'}:
            if name in values:
                self.targets.append((tag, name, values[name]))

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        if not self.open or self.open[-1] != tag:
            self.fault(f'</{tag}> closes <{self.open[-1] if self.open else ""}>')
        if tag in self.open:
            while self.open.pop() != tag:
                pass

    def check_place(self, tag):
        if tag in BLOCK and 'p' in self.open:
            self.fault(f'<{tag}> in a paragraph')
        if tag == 'a' and 'a' in self.open:
            self.fault('a link in a link')

    def fault(self, text):
        self.faults.append(f'line {self.getpos()[0]}: {text}')


def read(path):
    reader = Reader()
    text = path.read_text(encoding='utf-8')
    reader.feed(text)
    reader.close()
    if reader.open:
        reader.fault(f'<{reader.open[-1]}> is not closed')
    for tag, number in {'h1': 1, 'title': 1, 'main': 1, 'header': 1, 'html': 1}.items():
        if reader.count.get(tag) != number:
            reader.fault(f'{reader.count.get(tag, 0)} elements <{tag}>')
    if 'raw HTML omitted' in text:
        reader.fault('Markdown has left out something that looks like HTML')
    for part in ('<!DOCTYPE html>', '<html lang=', 'name="viewport"', 'href="style.css"', '<nav class="pages"'):
        if part not in text:
            reader.fault(f'{part} is missing')
    return reader


def fault_of(folder, pages, file, tag, name, target):
    path, _, anchor = target.partition('#')
    path = path.partition('?')[0]
    if re.match(r'https?:', target) and (tag, name) == ('a', 'href'):
        return None
    if re.match(r'[a-z]+:|/', target):
        return f'{target} is not in this folder'
    aim = Path(unquote(path)) if path else file
    if path.endswith('/') and (folder / aim / 'index.html').is_file():
        return None
    if '..' in aim.parts or not (folder / aim).is_file():
        return f'the link {target} leads nowhere'
    if anchor and (str(aim) not in pages or unquote(anchor) not in pages[str(aim)].ids):
        return f'the anchor {target} does not exist'
    return None


def check(folder):
    pages = {path.name: read(path) for path in sorted(folder.glob('*.html'))}
    used = {'index.html'}
    for name, page in pages.items():
        yield from (f'{name}: {fault}' for fault in page.faults)
        for tag, attribute, target in page.targets:
            fault = fault_of(folder, pages, Path(name), tag, attribute, target)
            if fault:
                yield f'{name}: {fault}'
            used.add(unquote(target.partition('#')[0]))
    for path in sorted(folder.rglob('*')):
        if (path.parent / 'index.html').exists() and path.parent != folder:
            continue
        if path.is_file() and str(path.relative_to(folder)) not in used:
            yield f'{path.relative_to(folder)}: no page links to it'
    if re.search(r'url\(|@import', (folder / 'style.css').read_text(encoding='utf-8')):
        yield 'style.css: it loads something'
    if len(pages) < 2:
        yield 'index.html: there are no pages'


if __name__ == '__main__':
    found = list(check(Path(sys.argv[1])))
    print(*found, sep='\n', end='\n' * bool(found))
    sys.exit(bool(found))
