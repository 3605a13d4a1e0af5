"""A lesson's curve as inline SVG: a line for theory, points for what was measured. Colours are in style.css."""

import math
from html import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 560, 320, 52, 14, 28, 46
MARKS = 30  # more would hide the line


def steps(low, high, most):
    """Round numbers from low to high, at most about `most`."""
    raw = (high - low) / most
    power = 10 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= raw)
    first = math.ceil(low / step - 1e-9)
    return [round(index * step, 12) for index in range(first, math.floor(high / step + 1e-9) + 1)]


def span(values):
    low, high = min(values), max(values)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def chart(lesson):
    points = [point for point in lesson['result']['points'] if None not in point]
    xs, ys = span([point[0] for point in points]), span([y for point in points for y in point[1:]])

    def at(x, y):
        across = LEFT + (x - xs[0]) / (xs[1] - xs[0]) * (WIDTH - LEFT - RIGHT)
        return f'{across:.1f}', f'{HEIGHT - BOTTOM - (y - ys[0]) / (ys[1] - ys[0]) * (HEIGHT - TOP - BOTTOM):.1f}'

    measure, title = lesson['measure'], escape(lesson['title'])
    out = [f'<figure class="chart">\n<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{title}: ',
           f'{escape(measure["y"])} by {escape(measure["x"])}">\n']
    for x in steps(*xs, 7):
        across = at(x, ys[0])[0]
        out.append(f'<path class="grid" d="M{across} {TOP}V{HEIGHT - BOTTOM}"/>'
                   f'<text x="{across}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{x:g}</text>\n')
    for y in steps(*ys, 5):
        down = at(xs[0], y)[1]
        out.append(f'<path class="grid" d="M{LEFT} {down}H{WIDTH - RIGHT}"/>'
                   f'<text x="{LEFT - 6}" y="{down}" dy="4" text-anchor="end">{y:g}</text>\n')
    line = ' '.join(','.join(at(x, theory)) for x, _, theory in points)
    out.append(f'<polyline class="theory" points="{line}"/>\n')
    sparse = max(1, math.ceil(len(points) / MARKS))
    for across, down in (at(x, measured) for x, measured, _ in points[::sparse]):
        out.append(f'<circle class="measured" cx="{across}" cy="{down}" r="3.2"/>\n')
    out += [f'<text x="{(WIDTH + LEFT) // 2}" y="{HEIGHT - 8}" text-anchor="middle">{escape(measure["x"])}</text>\n',
            f'<text x="4" y="14">{escape(measure["y"])}</text>\n</svg>\n',
            '<figcaption>Line: theory, in closed form. Points: rays traced by the program.</figcaption>\n</figure>\n']
    return ''.join(out)
