"""The texts that a person sees in the laboratory, as the keys of its catalogues (src/web/page/languages/README.md).

python3 -B tests/source/texts.py keys PROGRAM        prints {KEY: [FILE, ..]} as JSON
python3 -B tests/source/texts.py check PROGRAM       prints what is wrong in the catalogues and in the page, a line each

A key is found where the page writes it: the first argument of say(), and each constant that element(), button(),
field() and the like show. The program's texts are the meanings of parameters and shapes and the lessons. PROGRAM is
build/cuvette."""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / 'src/web/page'

# --- tokens of JavaScript: [kind, text, line]; kinds: id, str, tmpl (its parts: [text, ..] around the holes), other ---

SPACE = re.compile(r'\s+|//[^\n]*|/\*.*?\*/', re.S)
WORD = re.compile(r'[\w$#]+')
STRING = re.compile(r"'(?:[^'\\\n]|\\.)*'|\"(?:[^\"\\\n]|\\.)*\"", re.S)
REGEX = re.compile(r'/(?:[^/\\\[\n]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/[a-z]*')
SIGN = re.compile(r'=>|\.\.\.|\?\.|\?\?=?|&&|\|\||[=!]==?|\*\*|[+]=|.', re.S)
ESCAPE = re.compile(r'\\(?:u\{([0-9a-f]+)\}|u([0-9a-f]{4})|x([0-9a-f]{2})|(.))', re.S | re.I)
PLAIN = {'n': '\n', 't': '\t', '\n': ''}


def unescaped(text):
    def letter(m):
        code = m[1] or m[2] or m[3]
        return chr(int(code, 16)) if code else PLAIN.get(m[4], m[4])

    return ESCAPE.sub(letter, text)


def template(source, at, line):
    """The parts of a template literal and the tokens in its holes, from its backtick on: (parts, tokens, end)."""
    parts, tokens, text = [], [], ''
    while source[at] != '`':
        if source[at] == '\\':
            text, at = text + source[at:at + 2], at + 2
        elif source.startswith('${', at):
            inner, at = tokenize(source, at + 2, line, True)
            parts, text = parts + [unescaped(text)], ''
            tokens += [['other', '(', line], *inner, ['other', ')', line], ['other', ',', line]]
        else:
            text, at = text + source[at], at + 1
    return parts + [unescaped(text)], tokens, at + 1


def divides(tokens):
    """Whether a slash after these tokens divides (and does not begin a regular expression)."""
    if not tokens:
        return False
    kind, text, _ = tokens[-1]
    return text not in ('return', 'typeof', 'case') if kind != 'other' else text in (')', ']')


def tokenize(source, at=0, first=1, hole=False):
    """All tokens; in a hole of a template up to its end, and the place after it."""
    tokens, depth = [], 0
    while at < len(source):
        line = first if hole else source.count('\n', 0, at) + 1
        if m := SPACE.match(source, at):
            at = m.end()
        elif source[at] == '`':
            parts, inner, at = template(source, at + 1, line)
            tokens.append(['tmpl', parts, line])
            if inner:
                tokens += [['other', '(', line], *inner, ['other', ')', line]]
        elif m := STRING.match(source, at):
            tokens.append(['str', unescaped(m[0][1:-1]), line])
            at = m.end()
        elif m := WORD.match(source, at):
            tokens.append(['id', m[0], line])
            at = m.end()
        elif source[at] == '/' and not divides(tokens) and (m := REGEX.match(source, at)):
            tokens.append(['regex', m[0], line])
            at = m.end()
        else:
            m = SIGN.match(source, at)
            depth += {'{': 1, '}': -1}.get(m[0], 0)
            at = m.end()
            if hole and depth < 0:
                return tokens, at
            tokens.append(['other', m[0], line])
    return tokens


def joined(tokens):
    """The same with 'a' + 'b' as one token."""
    found = []
    for token in tokens:
        if token[0] == 'str' and len(found) > 1 and found[-1][1] == '+' and found[-2][0] == 'str':
            found.pop()
            found[-1] = ['str', found[-1][1] + token[1], found[-1][2]]
        else:
            found.append(token)
    return found


# --- which strings of the page are texts ---

# Properties and arguments that are always shown; of a function, the first argument that is, and the one after the last.
SHOWN = {
    'text', 'title', 'aria-label', 'aria-valuetext', 'label', 'placeholder', 'alt', 'hint', 'unit', 'caption', 'remedy',
    'heading', 'textContent'
}
CALLS = {
    'say': (0, 1), 'button': (0, 1), 'group': (0, 1), 'field': (0, 1), 'checkbox': (0, 1), 'notice': (0, 1),
    'empty': (0, 1), 'ask': (0, 3), 'element': (2, 99), 'replace': (1, 99), 'fact': (0, 3), 'commandRow': (9, 9),
    'item': (1, 3)
}
# Properties and arguments that are never shown.
HIDDEN = {
    'class', 'd', 'id', 'key', 'icon', 'kind', 'role', 'type', 'css', 'cursor', 'transform', 'viewBox', 'path', 'style',
    'Content-Type', 'Accept', 'aria-controls', 'href', 'stroke-width', 'fill', 'inputmode', 'method'
}
UNSHOWN = {
    'querySelector', 'querySelectorAll', 'closest', 'matches', 'matchMedia', 'getElementById', 'get', 'set', 'post',
    'del', 'change', 'on', 'emit', 'addEventListener', 'dispatchEvent', 'setAttribute', 'param', 'unique', 'gesture',
    'gestures', 'memory', 'icon', 'startsWith', 'endsWith', 'includes', 'split', 'join', 'replace', 'createElement',
    'toggle', 'add', 'fetch', 'import', 'setProperty', 'of', 'blob', 'has', 'indexOf', 'getItem', 'part'
}
LETTERS = re.compile(r'[A-Za-z]{2,}')
# What looks like a text wherever it is: a capital and small letters, or words with a space between them.
TEXT = re.compile(r"^[A-Z][a-z’']+([ .,:;?!…(–-]|$)|[a-z)] [(a-zA-Z]|[a-z], ")
NAMES = re.compile(r'^[\w-]*-[\w-]*( [\w-]+)*$|^[\w -]*( |^)[\w]+-[\w-]+( |$)[\w -]*$')  # CSS classes
OPEN, CLOSE = set('([{'), set(')]}')


def surroundings(tokens, at):
    """(property, function, number of the argument) of the expression that the token belongs to."""
    depth, commas, start, place = 0, 0, None, at - 1
    while place >= 0:
        kind, text, _ = tokens[place]
        if kind == 'other':
            if text in CLOSE:
                depth += 1
            elif text in OPEN and depth:
                depth -= 1
            elif text in OPEN and text == '(' and (place == 0 or tokens[place - 1][0] != 'id'):
                pass  # only parentheses
            elif text in OPEN:
                break
            elif depth == 0 and text in ',;':
                start = place + 1 if start is None else start
                commas += 1
        place -= 1
    start = place + 1 if start is None else start
    named = start + 1 < at and tokens[start][0] in ('id', 'str') and tokens[start + 1][1] == ':'
    calls = place > 0 and tokens[place][1] == '(' and tokens[place - 1][0] == 'id'
    return tokens[start][1] if named else None, tokens[place - 1][1] if calls else None, commas


def is_text(tokens, at):
    text = tokens[at][1]
    before = tokens[at - 1][1] if at else ''
    after = tokens[at + 1][1] if at + 1 < len(tokens) else ''
    if not LETTERS.search(text) or re.fullmatch(r'&\w+;', text):
        return False
    if before in ('from', 'import', '===', '!==', 'case') or after in ('===', '!=='):
        return False
    if after == ':' and before in ('{', ','):
        return False  # the name of a property
    name, call, number = surroundings(tokens, at)
    if name in HIDDEN or call in UNSHOWN and call != 'replace':
        return False
    if name in SHOWN or call in CALLS and CALLS[call][0] <= number < CALLS[call][1]:
        return True
    return bool(TEXT.search(text)) and not NAMES.match(text) and not text.startswith(('/', '#', '.', '[', '<'))


def sources():
    languages = PAGE / 'shared/language.js'  # the names of languages, in themselves
    return sorted(set(PAGE.rglob('*.js')) - {languages, PAGE / 'shared/singulars.js'}) + [PAGE / 'index.html']


def page_keys(path):
    """The texts of a file of the page, without the spaces around them."""
    source = path.read_text(encoding='utf-8')
    if path.suffix == '.html':
        shown = re.findall(r'aria-label="([^"]+)"|>([^<>]*[a-z][^<>]*)<', source)
        return {(a or b).strip() for a, b in shown} - {'Cuvette'}
    tokens = joined(tokenize(source))
    found = set()
    for at, (kind, text, _) in enumerate(tokens):
        if kind == 'tmpl' and len(text) == 1:
            tokens[at] = ['str', text[0], 0]
        if tokens[at][0] == 'str' and is_text(tokens, at):
            found.add(tokens[at][1].strip())
    return found


# --- texts of the program ---

LESSON = r'title|question|label|ask|choices|reading|unit|answer|x|y'
BLOCK = re.compile(rf'^( *)({LESSON}): (?:>-?\n((?:\1  .*\n?)+)|(.*))$', re.M)
FLOW = re.compile(rf'[{{,] ?({LESSON}): (\[[^]]*\]|.*?)(?=, \w+:|\}})')
AXIS = re.compile(r'(.*?)(?:, (deg|px|nm|m|s|scene units))?', re.S)
CURVES = re.compile(r'\{"[\w-]+", "([^"]+)",\s*"([^"]+)"')
MEANING = re.compile(r'\.meaning =((?:\s*"(?:[^"\\]|\\.)*")+)')


def output(program, *arguments):
    return json.loads(subprocess.run([program, *arguments], check=True, capture_output=True, encoding='utf-8').stdout)


def axis_keys(text):
    """An axis has its unit after a comma."""
    return set(AXIS.fullmatch(text).groups('')) - {'', 'deg'}


def lesson_keys(path):
    """The texts of a lesson, whose lines are those of experiments/lessons: one entry or one map a line."""
    source = re.sub(r'^ *#.*\n', '', path.read_text(encoding='utf-8'), flags=re.M)
    values = [' '.join(folded.split()) or line for *_, folded, line in BLOCK.findall(source)]
    values += [value for _, value in FLOW.findall(source)]
    for value in values:
        for one in value[1:-1].split(', ') if value.startswith('[') else [value]:
            text = one.strip().strip('\'"').replace("''", "'")
            if LETTERS.search(text):
                yield from axis_keys(text)


def parameter_keys(program):
    """Meanings, units, and names as labels; the coefficients of aspheres are named by their letters."""
    for row in output(program, 'params', '--json')['params']:
        yield row['meaning'], row['path']
        for text in row['unit'], row['name'].replace('_', ' '):
            if LETTERS.search(text) and not re.match(r'1/|a\d', text):
                yield text, row['path']


def program_keys(program):
    """Pairs of a text and its place."""
    yield from parameter_keys(program)
    for path in sorted((ROOT / 'experiments/lessons').glob('*.lesson')):
        yield from ((key, path.name) for key in lesson_keys(path))
    for axes in CURVES.findall((ROOT / 'src/realism/realism.c').read_text(encoding='utf-8')):
        yield from ((key, 'realism.c') for axis in axes for key in axis_keys(axis))
    for path in sorted((ROOT / 'src/geometry/shapes').glob('*.c')):
        source = path.read_text(encoding='utf-8')
        yield from ((word, path.name) for word in re.findall(r'\.word = "(\w+)",\s*\.meaning', source))
        for text in MEANING.findall(source):
            yield ''.join(re.findall(r'"((?:[^"\\]|\\.)*)"', text)), path.name


# --- the catalogues ---

HOLE = re.compile(r'\{(\w+)\}')
CATEGORIES = {'de': ('one', 'other'), 'es': ('one', 'many', 'other'), 'ru': ('one', 'few', 'many', 'other')}
# Texts with a hole and words that are not put together by say(): not shown, or only data.
COMPOSED = re.compile(r'[a-z]{2,} |[A-Z][a-z]+ | [a-z]{2,}')
COMMAND = re.compile(
    r'^ ?--|^cuvette |[<>=]|\(to |^[\w-]+\(|-\{\}|^[a-z]+-[a-z]+ \{\}|^[\{\}, ]* [nµm]?[msg]$|^engine/|^: status')


def all_keys(program):
    keys = {}
    for path in sources():
        for key in page_keys(path):
            keys.setdefault(key, []).append(str(path.relative_to(ROOT)))
    for key, place in program_keys(program):
        if place not in keys.setdefault(key, []):
            keys[key].append(place)
    return dict(sorted(keys.items()))


def wrong_entries(code, catalogue, keys):
    """What is wrong in a catalogue."""
    for key in keys.keys() - catalogue.keys():
        yield f'{code}.json has no translation of {key!r} ({keys[key][0]})'
    for key in catalogue.keys() - keys.keys():
        yield f'{code}.json has a text that nothing shows: {key!r}'
    for key, value in catalogue.items():
        forms = value if isinstance(value, dict) else {'other': value}
        if isinstance(value, dict) and set(value) - set(CATEGORIES[code]) or 'other' not in forms:
            yield f'{code}.json: {key!r} has forms other than {", ".join(CATEGORIES[code])}, or no form "other"'
        for form in forms.values():
            if set(HOLE.findall(form)) - set(HOLE.findall(key)) or not form.strip():
                yield f'{code}.json: the translation of {key!r} is empty or has other holes: {form!r}'


def composed(path):
    """Texts that are put together from parts and values instead of being one text of say()."""
    tokens = tokenize(path.read_text(encoding='utf-8'))
    for at, (kind, parts, line) in enumerate(tokens):
        text = '{}'.join(parts) if kind == 'tmpl' and len(parts) > 1 else ''
        if not COMPOSED.search(text) or COMMAND.search(text):
            continue
        name, call, _ = surroundings(tokens, at)
        if name not in HIDDEN and call not in UNSHOWN:
            yield f'{path.relative_to(ROOT)}:{line}: {text!r} is not one text of say()'


def check(program):
    keys = all_keys(program)
    for path in sources():
        if path.suffix == '.js':
            yield from composed(path)
    singulars = re.findall(r"'([^']+)':", (PAGE / 'shared/singulars.js').read_text(encoding='utf-8'))
    yield from (f'singulars.js has a text that nothing shows: {key!r}' for key in set(singulars) - keys.keys())
    for code in CATEGORIES:
        catalogue = json.loads((PAGE / f'languages/{code}.json').read_text(encoding='utf-8'))
        yield from wrong_entries(code, catalogue, keys)


def main():
    what, program = sys.argv[1:]
    if what == 'keys':
        print(json.dumps(all_keys(program), ensure_ascii=False, indent=1))
        return 0
    wrong = list(check(program))
    print('\n'.join(wrong))
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
