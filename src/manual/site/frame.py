"""What all pages have in common: head, navigation, the contents of long pages; and the first page."""

import re
from html import escape

CONTENTS_FROM = 4  # headings


def with_ids(body):
    """Anchors of Markdown headings, as GitHub names them."""
    used = {}

    def named(match):
        plain = re.sub(r'<[^>]*>|&[a-z]+;', '', match[2]).lower()
        slug = re.sub(r'[^\w -]', '', plain).replace(' ', '-')
        used[slug] = used.get(slug, -1) + 1
        anchor = f'{slug}-{used[slug]}' if used[slug] else slug
        return f'<h{match[1]} id="{anchor}">{match[2]}</h{match[1]}>'

    return re.sub(r'<h([2-6])>(.*?)</h\1>', named, body, flags=re.S)


def contents(body):
    found = re.findall(r'<h2[^>]* id="([^"]*)"[^>]*>(.*?)</h2>', body, re.S)
    if len(found) < CONTENTS_FROM:
        return ''
    items = ''.join(f'<li><a href="#{anchor}">{re.sub("<[^>]*>", "", title)}</a></li>\n' for anchor, title in found)
    return f'<nav class="contents" aria-label="On this page">\n<b>On this page</b>\n<ul>\n{items}</ul>\n</nav>\n'


def current(same):
    return ' aria-current="page"' if same else ''


def bar(page, groups, laboratory):
    items = f'<a href="{escape(laboratory)}">Laboratory</a>\n' if laboratory else ''
    items += ''.join(
        f'<a href="{group.pages[0].file}"{" class=here" * (group is page.group)}>{escape(group.title)}</a>\n'
        for group in groups if group.pages)
    return f'<nav class="groups" aria-label="Sections">\n{items}</nav>\n'


def pages(page, groups):
    out = []
    for group in groups:
        items = ''.join(f'<li><a href="{other.file}"{current(other is page)}>{escape(other.label)}</a></li>\n'
                        for other in group.pages)
        opened = ' open' if group is page.group else ''
        out.append(f'<details{opened}>\n<summary>{escape(group.title)}</summary>\n<ul>\n{items}</ul>\n</details>\n')
    return f'<nav class="pages" id="pages" aria-label="All pages">\n{"".join(out)}</nav>\n'


def whole(page, body, groups, version, laboratory):
    if '<!-- pages -->' in body:
        body = body.replace('<!-- pages -->', page_list(page.group.pages[1:]))
    home = page.name == 'index'
    if not home:
        head = re.match(r'<h1>.*?</h1>\n(?:<p class.*?</p>\n)?', body, re.S)[0]
        body = (f'<div class="title">\n{head}</div>\n{contents(body)}<div class="text">\n{body[len(head):]}</div>\n')
    title = re.sub('<[^>]*>', '', page.title)
    return ''.join([
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n',
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n',
        f'<title>{title if home else f"{title} - Cuvette"}</title>\n<link rel="stylesheet" href="style.css">\n',
        '</head>\n<body>\n<header>\n',
        f'<a class="home" href="index.html"{current(home)}>Cuvette <small>{escape(version)}</small></a>\n',
        bar(page, groups, laboratory), '<a class="all" href="#pages">All pages</a>\n</header>\n<div class="columns">\n',
        f'<main{" class=first" * home}>\n{body}</main>\n', pages(page, groups), '</div>\n</body>\n</html>\n'
    ])


def page_list(listed):
    items = ''.join(f'<dt><a href="{page.file}">{page.title}</a></dt>\n<dd>{page.purpose}</dd>\n' for page in listed)
    return f'<dl class="list">\n{items}</dl>\n'


def index(readme, groups):
    """The first page: what the README says first, its first image, and a card for each group."""
    intro, image = re.search(r'<p>(?!<img).*?</p>', readme, re.S)[0], re.search(r'<img [^>]*>', readme)[0]
    cards = []
    for group in groups:
        items = ''.join(f'<li><a href="{page.file}">{escape(page.label)}</a></li>\n' for page in group.pages)
        cards.append(f'<section class="card">\n<h2><a href="{group.pages[0].file}">{escape(group.title)}</a></h2>\n'
                     f'<p>{escape(group.purpose)}</p>\n<ul>\n{items}</ul>\n</section>\n')
    return (f'<div class="hero">\n<div>\n<h1>Cuvette</h1>\n{intro}\n</div>\n{image}\n</div>\n'
            f'<div class="cards">\n{"".join(cards)}</div>\n')
