"""The public header as a page: its sections, and each declaration under the comment that precedes it."""

import html
import re

from page import Page

SECTION = re.compile(r'--- (.*?) ---\s*')
NAMES = re.compile(r'\b(cuvette_\w+)\((?!\*)|^typedef (?:struct|enum) (\w+)|^#define (\w+)|^enum \{ (\w+)', re.M)


def page(path, examples, root):
    text = c_only(path.read_text(encoding='utf-8'))
    parts, names, content = [], [], []
    for number, chunk in enumerate(re.split(r'\n{2,}', text)):
        tokens = re.findall(r'^/\*.*?\*/|(?:^(?!/\*)[^\n]*\n?)+', chunk, re.M | re.S)
        comment = ''
        for token in tokens:
            if token.startswith('/*'):
                comment = words(token)
                section = SECTION.match(comment)
                if section:
                    parts.append(heading(section[1]))
                    comment = comment[section.end():]
                if section or number == 0:
                    parts.append(paragraphs(comment))
                    comment = ''
            elif token.strip():
                parts.append(entry(token.strip(), comment, names))
                comment = ''
    parts.append(example_list(examples, root))
    title = 'Engine API: the C library'
    return Page('engine-api', 'C library', title, f'<h1>{title}</h1>\n' + ''.join(parts),
                'Every function and type of cuvette.h.', tuple(names))


def c_only(text):
    """The header as a C compiler sees it, without guards and attributes."""
    text = re.sub(r'^#ifdef __cplusplus\n.*?^#(?:else\n(.*?)^#)?endif\n', lambda match: match[1] or '', text,
                  flags=re.M | re.S)
    text = re.sub(r'^#if defined.*?^#endif\n', '', text, flags=re.M | re.S)
    text = re.sub(r'^#(?:ifndef|define) CUVETTE_H\n|^#endif\n?|^#include .*\n', '', text, flags=re.M)
    return text.replace('CUVETTE_API ', '')


def words(comment):
    """The text of a comment, its paragraphs separated by empty lines."""
    text = re.sub(r'^/\*\s?|\s*\*/$', '', comment)
    return re.sub(r'^ \* ?', '', text, flags=re.M)


def paragraphs(text):
    """`name` is code; one or two first words before a full stop are a title."""
    out = []
    for paragraph in re.split(r'\n\n', text.strip()):
        if paragraph:
            line = re.sub(r'`([^`]*)`', r'<code>\1</code>', html.escape(paragraph, quote=False))
            out.append('<p>' + re.sub(r'^([A-Z][a-z-]+(?: [a-z]+)?)\. ', r'<b>\1.</b> ', line) + '</p>\n')
    return ''.join(out)


def heading(title):
    anchor = re.sub(r'[^a-z]+', '-', title)
    return f'<h2 id="{anchor}">{html.escape(title[:1].upper() + title[1:])}</h2>\n'


def entry(code, comment, names):
    found = [next(filter(None, match)) for match in NAMES.findall(re.sub(r'^ .*', '', code, flags=re.M))]
    found = [name for name in dict.fromkeys(found) if name not in names]
    constants = re.findall(r'^    (CUVETTE_\w+)', code, re.M)
    names += found + constants
    shown = re.sub(r'(/\*.*?\*/)', r'<i>\1</i>', html.escape(code, quote=False), flags=re.S)
    for constant in constants:
        shown = shown.replace(f'    {constant}', f'    <span id="{constant}">{constant}</span>', 1)
    title = ', '.join(f'<span id="{name}">{name}</span>' for name in found)
    return f'<section class="entry">\n<h3>{title}</h3>\n<pre>{shown}</pre>\n{paragraphs(comment)}</section>\n'


def example_list(examples, root):
    items = []
    for path in examples:
        purpose = words(re.match(r'/\*.*?\*/', path.read_text(encoding='utf-8'), re.S)[0]).partition('\n\n')[0]
        purpose = html.escape(re.split(r'\.\s', purpose)[0].replace('\n', ' '), quote=False)
        items.append(f'<li><a href="../{path.relative_to(root)}">{path.name}</a>: {purpose}.</li>\n')
    return f'<h2 id="examples">Examples</h2>\n<ul>\n{"".join(items)}</ul>\n'
