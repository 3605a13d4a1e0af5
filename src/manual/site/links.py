"""Links of the sources as links between pages: relative paths, names of manual pages, names of the engine's API."""

import html
import os
import re
import shutil
from urllib.parse import unquote

from page import Page, Trouble

IMAGES = ('.png', '.jpg', '.svg')
LINK = re.compile(r'(<a\b.*?</a>|<h[1-6].*?</h[1-6]>)', re.S)  # a title is no link either
TAG = re.compile(r'(<a\b.*?</a>|<h[1-6].*?</h[1-6]>|<[^>]*>)', re.S)
NAMED = re.compile(r'(<b>|<code>)?\b(cuvette(?:-[a-z]+)?)(</b>|</code>)?\(([1-8])\)')
COMMAND = re.compile(r'<code>man (?:-M \S+ )?(?:\d )?(cuvette(?:-[a-z]+)?)</code>')
API = re.compile(r'\b(?:cuvette_[a-z0-9_]+|CUVETTE_[A-Z_]+)\b')
TARGET = re.compile(r'\b(href|src)="([^"]*)"')
IMAGE = re.compile(r'<img src="([^"]*)"[^>]*>')


class Links:
    def __init__(self, root, folder, pages):
        self.root, self.folder = root, folder
        self.by_source = {page.source: page for page in pages}
        self.manual = {page.name: page for page in pages if '/man' in page.source}
        self.api = {name: f'{page.file}#{name}' for page in pages for name in page.names}
        self.made = []

    def new_pages(self):
        made, self.made = self.made, []
        return made

    def resolve(self, page):
        base = self.root / page.source
        base = base if base.is_dir() else base.parent
        body = IMAGE.sub(r'<a href="\1">\g<0></a>', page.body)  # opens in full
        body = TARGET.sub(lambda match: f'{match[1]}="{self.target(base, page, match[2])}"', body)
        parts = LINK.split(body)
        parts[::2] = [COMMAND.sub(self.command, NAMED.sub(self.named, part)) for part in parts[::2]]
        parts = TAG.split(''.join(parts))
        parts[::2] = [API.sub(self.api_name, part) for part in parts[::2]]
        return ''.join(parts)

    def target(self, base, page, target):
        path, mark, fragment = html.unescape(target).partition('#')
        if not path or re.match(r'[a-z]+:', path) or path.endswith('.html'):
            return target
        source = os.path.relpath((base / unquote(path)).resolve(), self.root)
        if not (self.root / source).exists() or source.startswith('..'):
            raise Trouble(f'{page.source}: the link {path} leads to no file of the project; correct it')
        if source.endswith(IMAGES):
            return self.image(source)
        if source not in self.by_source:
            self.by_source[source] = self.text_page(source)
            self.made.append(self.by_source[source])
        return html.escape(self.by_source[source].file + mark + fragment)

    def image(self, source):
        name = 'images/' + re.sub(r'^(\.\./)*', '', source).replace('/', '-')
        (self.folder / 'images').mkdir(exist_ok=True)
        shutil.copyfile(self.root / source, self.folder / name)
        return name

    def text_page(self, source):
        """A file that is only linked, such as a scene: its text."""
        try:
            text = (self.root / source).read_text(encoding='utf-8')
        except (UnicodeDecodeError, IsADirectoryError):
            raise Trouble(f'{source} is linked, but is no text file; link another one') from None
        body = f'<h1>{html.escape(source)}</h1>\n<pre class="file">{html.escape(text)}</pre>\n'
        page = Page(source.replace('/', '-'), source, html.escape(source), body)
        page.source = source
        return page

    def named(self, match):
        opened, name, closed, section = match[1] or '', match[2], match[3] or '', match[4]
        page = self.manual.get(f'{name}.{section}')
        if not page or bool(opened) != bool(closed):
            return match[0]
        return f'<a href="{page.file}">{opened}{name}{closed}({section})</a>'

    def command(self, match):
        page = next((page for name, page in self.manual.items() if name.rpartition('.')[0] == match[1]), None)
        return f'<a href="{page.file}">{match[0]}</a>' if page else match[0]

    def api_name(self, match):
        return f'<a href="{self.api[match[0]]}">{match[0]}</a>' if match[0] in self.api else match[0]
