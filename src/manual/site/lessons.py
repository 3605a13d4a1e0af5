"""Lessons as pages, from what `cuvette lesson show` prints: question, controls, prediction, curve, answer, command."""

import json
import re
from html import escape

from chart import chart
from page import Page, Trouble, output_of


def show(root, source, program):
    return json.loads(output_of(program, 'lesson', 'show', source, cwd=root))


def page(root, source, program):
    lesson = show(root, source, program)
    if not lesson['result']['passes']:
        raise Trouble(f'{source}: the curve differs from theory; run: cuvette lesson check {source}')
    title = escape(lesson['title'])
    up = '../' * source.count('/')
    body = [
        f'<h1>{title}</h1>\n<p class="question" lang="{escape(lesson["language"])}">{escape(lesson["question"])}</p>\n',
        f'<p>The scene is <a href="{up}{escape(lesson["scene"])}">{escape(lesson["scene"])}</a>, the lesson ',
        f'<code>{source}</code>; <code>cuvette lab</code> opens it in the gallery.</p>\n',
        controls(lesson['controls']), prediction(lesson['prediction']), answer(lesson), commands(lesson['commands']),
    ]
    return Page(f'lesson-{lesson["name"]}', lesson['title'], title, ''.join(body), escape(lesson['question']))


def controls(rows):
    text = ['<h2 id="controls">Controls</h2>\n<table>\n<thead><tr><th>control</th><th>parameter</th><th>values</th>'
            '</tr></thead>\n<tbody>\n']
    for row in rows:
        values = ', '.join(row['choices']) if 'choices' in row else f'{row["from"]:g} to {row["to"]:g}'
        text.append(f'<tr><td>{escape(row["label"])}</td><td><code>{escape(row["parameter"])}</code></td>'
                    f'<td>{escape(values)}</td></tr>\n')
    return ''.join(text) + '</tbody>\n</table>\n'


def prediction(asked):
    text = f'<h2 id="prediction">Predict</h2>\n<p>{escape(asked["ask"])}</p>\n'
    if 'choices' in asked:
        text += '<ul>\n' + ''.join(f'<li>{escape(choice)}</li>\n' for choice in asked['choices']) + '</ul>\n'
    return text


def answer(lesson):
    """Folded, so that a reader predicts first; without scripts."""
    right = lesson['prediction'].get('right')
    return ''.join([
        '<h2 id="answer">Measure, and compare</h2>\n<details>\n<summary>Show the curve and the answer</summary>\n',
        f'<p>The right prediction: <b>{escape(right)}</b>.</p>\n' if right else '',
        measured(lesson), f'<p>{escape(filled(lesson))}</p>\n</details>\n',
    ])


def filled(lesson):
    """The answer with the lesson's values in place of {NAME}."""
    result = lesson['result']
    values = {**result['values'], 'theory': result['theory'], 'measured': result['measured']}
    return re.sub(r'\{(\w+)\}', lambda hole: f'{values[hole[1]]:.4g}', lesson['answer'])


def measured(lesson):
    """Times are of one machine and one moment: a page of the manual would differ with each build."""
    measure, result = lesson['measure'], lesson['result']
    if measure.get('timed'):
        return '<p>This lesson measures times: <code>cuvette lab</code> shows the curve of your machine.</p>\n'
    unit = f' {escape(measure["unit"])}' if measure['unit'] else ''
    return (chart(lesson) + f'<p>{escape(measure["reading"])}: measured <b>{result["measured"]:.8g}</b>{unit}, theory '
            f'<b>{result["theory"]:.8g}</b>{unit}.</p>\n')


def commands(lines):
    return ('<h2 id="commands">The same numbers on the command line</h2>\n<pre>'
            + escape('\n'.join(lines), quote=False) + '</pre>\n')


def overview(root, source):
    title = 'Lessons'
    body = [f'<h1>{title}</h1>\n<p>Guided experiments: each has a question, named controls, a prediction to make, and ',
            'a curve of traced rays next to theory. <code>cuvette lab</code> opens them in the browser, where the ',
            'controls act; cuvette-lesson(1) checks them, and cuvette-lesson(5) describes the files, for lessons of ',
            'your own.</p>\n<!-- pages -->\n']
    return Page('lessons', 'All lessons', title, ''.join(body))
