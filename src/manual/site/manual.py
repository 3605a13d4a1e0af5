"""A manual page as HTML, by mandoc."""

import re

from page import Page, output_of

COMMAND = 'cuvette-'


def page(path):
    text = output_of('mandoc', '-T', 'html', '-O', 'fragment', path)
    text = re.sub(r'<table class="(?:head|foot)">.*?</table>\n?', '', text, flags=re.S)
    text = re.sub(r'(</?)h2\b', r'\1h3', text)
    text = re.sub(r'(</?)h1\b', r'\1h2', text)
    text = re.sub(r'<a class="permalink" href="#[^"]*">(.*?)</a>', r'\1', text, flags=re.S)
    text = text.replace('\n<br/>\n', '\n')  # before an indented line of an example
    text = re.sub(r'<b>(--?[a-z][a-z-]*)', r'<b><span class="option">\1</span>', text)
    text, purpose = without_name(text)
    name, section = path.name.rsplit('.', 1)
    title = f'{name}({section})'
    return Page(path.name, label(name, section), title, f'<h1>{title}</h1>\n<p class="purpose">{purpose}</p>\n{text}',
                purpose)


def without_name(text):
    """The text without the section NAME, which repeats the page's title, and the purpose in that section."""
    match = re.search(r'<section class="Sh">\n<h2[^>]*>NAME</h2>\n<p[^>]*>(.*?)</p>\n</section>\n', text, re.S)
    purpose = re.sub(r'\s+', ' ', match[1]).partition(' - ')[2]
    return text.replace(match[0], ''), purpose[:1].upper() + purpose[1:]


def label(name, section):
    short = name.removeprefix(COMMAND)
    return short if section == '1' else short.capitalize()
