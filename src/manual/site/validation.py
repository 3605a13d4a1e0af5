"""The page of cuvette-validation(7): its text, then a table for each kind of cases, from the rows of make validate."""

import csv
import re
from html import escape

import manual

ROWS = 'experiments/validation/cases.csv'
FIGURES = (
    ('ball.svg', 'Parallel rays through a ball of n = 1.8, their caustic and focus: <code>cuvette fan</code>.'),
    ('calcite.svg', 'The ordinary and the extraordinary ray of one ray in calcite: <code>cuvette trace</code>.'),
)


def page(root, source):
    """The manual page without the list of cases, which the tables have."""
    made = manual.page(root / source)
    with open(root / ROWS, newline='', encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    kinds = list(dict.fromkeys(row['kind'] for row in rows))
    limits = sum(bool(row['nature']) for row in rows)
    passed = sum(row['verdict'] == 'pass' and not row['nature'] for row in rows)
    up = '../' * source.count('/')
    figures = ''.join(f'<figure><img src="{up}{ROWS.rpartition("/")[0]}/{name}" alt="{re.sub("<[^>]*>", "", text)}">'
                      f'<figcaption>{text}</figcaption></figure>\n' for name, text in FIGURES)
    tables = ''.join(table(root, kind, [row for row in rows if row['kind'] == kind], up) for kind in kinds)
    summary = (f'<p>{passed} of {len(rows) - limits} cases are within their tolerances. There are {limits} further '
               f'cases, limits of rays, where nature differs from the program. The rows are in '
               f'<a href="{up}{ROWS}">{ROWS}</a>.</p>\n')
    made.body = re.sub(r'(<h2 class="Sh" id="CASES">.*?</h2>\n).*?</section>',
                       lambda match: match[1] + summary + figures + tables + '</section>', made.body, flags=re.S)
    return made


def head(root, kind):
    """Title and purpose, of the first section of the kind's file."""
    text = (root / f'experiments/validation/{kind}.cases').read_text(encoding='utf-8')
    title, about = re.search(r'^title: (.*)\nabout: ((?:.|\n )*)', text, re.M).groups()
    return title, re.sub(r'\s+', ' ', about).strip()


def value(row, column):
    return f'{float(row[column]):.9g}' + (f' {escape(row["unit"])}' if row['unit'] else '')


def table(root, kind, rows, up):
    """A kind of limits has what nature does and how far the program is from it."""
    title, about = head(root, kind)
    limits = all(row['nature'] for row in rows)
    heads = ['nature', 'the program', 'off by', 'by rays'] if limits else ['expected', 'ours', 'deviation', 'tolerance']
    text = [f'<h3 id="{kind}">{escape(title)}</h3>\n<p>{escape(about)} The formulas are in <a href="{up}experiments/'
            f'validation/{kind}.cases">{kind}.cases</a>.</p>\n<table class="cases">\n'
            '<thead><tr><th>what, and source</th>'
            + ''.join(f'<th>{name}</th>' for name in heads) + '</tr></thead>\n<tbody>\n']
    for row in rows:
        ours = value(row, 'ours') if row['ours'] else 'no value'
        ours = ours if row['verdict'] == 'pass' else f'<b>{ours}: {row["verdict"]}</b>'
        deviation = f'{float(row["deviation"]):.2g}' if row['deviation'] else ''
        off = f'{float(row["ours"]) - float(row["nature"]):.9g}' if limits and row['ours'] else ''
        cells = ([value(row, 'nature'), ours, off, value(row, 'expected')] if limits else
                 [value(row, 'expected'), ours, deviation, f'{float(row["tolerance"]):.2g}'])
        text.append(f'<tr><td>{escape(row["what"])}<small>{escape(row["source"])}<br>'
                    f'Tolerance: {escape(row["reason"])}</small></td>'
                    + ''.join(f'<td>{cell}</td>' for cell in cells) + '</tr>\n')
    return ''.join(text) + '</tbody>\n</table>\n'
