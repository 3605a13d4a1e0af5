#!/usr/bin/env -S python3 -B
"""Compare the program with published tables and closed forms: experiments/validation/*.cases.

  experiments/validate.py CUVETTE ROWS.csv [FILE.cases...]

experiments/validation/README.md describes the files. Writes a row for each case; results/README.md has the columns.
Exit status: 0; 1: a case is out of its tolerance, or has no value; 2: a file is wrong.
"""

import concurrent.futures
import csv
import functools
import json
import math
import os
import pathlib
import re
import string
import subprocess
import sys
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / "experiments/validation"
KEYS = "what source given expected nature unit scene files command read tolerance because".split()
NEEDED = "what source expected command read tolerance because".split()
COLUMNS = "kind case what source formula expected ours deviation tolerance reason unit nature verdict".split()


class Trouble(Exception):
    """One line for the user: what is wrong, where, what to do."""


class Record(dict):
    """A JSON object whose keys are attributes too. A key that is missing is an error, never a value."""

    __getattr__ = dict.__getitem__


class Image:
    """A PFM file: image(x, y) is a colour, 0,0 at the top left; image.mean() that of all pixels, by channel."""

    def __init__(self, path):
        head, size, _, data = pathlib.Path(path).read_bytes().split(b"\n", 3)
        self.width, self.height = map(int, size.split())
        if head != b"PF" or len(data) != 12 * self.width * self.height:
            raise ValueError("the image is incomplete")
        self.values = memoryview(data).cast("f")

    def __call__(self, x, y):
        if not (0 <= x < self.width and 0 <= y < self.height):
            raise IndexError("a pixel outside the image")
        at = 3 * ((self.height - 1 - y) * self.width + x)
        return tuple(self.values[at : at + 3])

    def mean(self):
        return tuple(math.fsum(self.values[k::3]) / (self.width * self.height) for k in range(3))


# --- what formulas can use ---


def nodes(ray):
    """A ray of a tree and all that follow."""
    return [ray] + [node for child in ray.children for node in nodes(child)]


def path(ray):
    """The rays of the refracted path."""
    found = [ray]
    while found[-1].children:
        found.append(found[-1].children[-1])
    return found


def axis_at(ray):
    """y at which a ray in the plane z = 0 crosses the axis of y."""
    return ray.origin[1] - ray.origin[0] * ray.direction[1] / ray.direction[0]


def angle(a, b):
    """Between two directions, in degrees."""
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return math.degrees(math.atan2(math.hypot(*cross), sum(x * y for x, y in zip(a, b))))


def leaving(ray, kind="refract"):
    """The rays of a tree that leave the scene."""
    return [node for node in nodes(ray) if node.end == "sky" and node.kind == kind]


def deviations(beam):
    """Of a beam's rays that leave the scene after two refractions: [(deviation in degrees, ray)...]."""
    paths = [path(ray.root) for ray in beam.rays]
    return [
        (angle(p[0].direction, p[-1].direction), p)
        for p in paths
        if len(p) == 3 and p[-1].end == "sky" and all(ray.kind != "reflect" for ray in p)
    ]


def least_deviation(beam):
    return min(deviation for deviation, _ in deviations(beam) if deviation > 1)


def rainbow(beam, reflections, beyond=0):
    """Deviations, 0 to 180 degrees, of a beam's rays, at z above `beyond`, that a drop reflected so often inside."""
    found = []
    for ray in beam.rays:
        at = next((child for child in ray.root.children if child.kind == "refract"), None)
        for kind in ("reflect",) * reflections + ("refract",):
            at = at and next((child for child in at.children if child.kind == kind), None)
        if at and at.end == "sky" and ray.root.origin[2] > beyond:
            found.append(angle(ray.root.direction, at.direction))
    return found


def crossing(a, b):
    """Of two rays in the plane z = 0."""
    (px, py, _), (ux, uy, _), (qx, qy, _), (vx, vy, _) = a.origin, a.direction, b.origin, b.direction
    t = ((qx - px) * vy - (qy - py) * vx) / (ux * vy - uy * vx)
    return px + t * ux, py + t * uy


@functools.cache
def h_function(albedo, mu, count=200):
    """Chandrasekhar's H of a half space that scatters evenly: 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 times the
    integral of m H(m) / (mu + m) over m from 0 to 1. Radiative Transfer, sec. 39."""
    m = [(i + 0.5) / count for i in range(count)]
    h = [1.0] * count

    def next_h(at):
        return 1 / (math.sqrt(1 - albedo) + albedo / 2 * sum(x * y / (at + x) for x, y in zip(m, h)) / count)

    for _ in range(60):
        h = [(old + next_h(at)) / 2 for old, at in zip(h, m)]
    return next_h(mu)


def dms(degrees, minutes=0, seconds=0):
    return degrees + minutes / 60 + seconds / 3600


def xyz(rgb):
    """Of linear sRGB: IEC 61966-2-1, the exact matrix of its primaries and white."""
    rows = (
        (0.4123907993, 0.3575843394, 0.1804807884),
        (0.2126390059, 0.7151686788, 0.0721923154),
        (0.0193308187, 0.1191947798, 0.9505321522),
    )
    return tuple(math.fsum(a * b for a, b in zip(row, rgb)) for row in rows)


def chromaticity(rgb):
    x, y, z = xyz(rgb)
    return x / (x + y + z), y / (x + y + z)


def integral(f, low, high, steps=2000):
    """Simpson's rule."""
    h = (high - low) / steps
    inner = (f(low + i * h) * (4 if i % 2 else 2) for i in range(1, steps))
    return h / 3 * math.fsum((f(low), f(high), *inner))


def root(f, low, high):
    """By halving; f changes its sign once."""
    sign = f(low) > 0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if (f(middle) > 0) == sign else (low, middle)
    return (low + high) / 2


def degrees_of(function):
    return lambda x: function(math.radians(x))


WORDS = {
    name: getattr(math, name)
    for name in "sqrt exp log log10 pi asin acos atan atan2 degrees radians hypot inf fsum".split()
}
WORDS |= {name: degrees_of(getattr(math, name)) for name in "sin cos tan".split()}  # of degrees
WORDS |= {"asin_deg": lambda x: math.degrees(math.asin(x)), "atan_deg": lambda x: math.degrees(math.atan(x))}
WORDS |= {
    f.__name__: f
    for f in (
        nodes,
        path,
        deviations,
        least_deviation,
        rainbow,
        crossing,
        h_function,
        axis_at,
        angle,
        xyz,
        chromaticity,
        leaving,
        dms,
        integral,
        root,
    )
}
WORDS |= {
    "abs": abs,
    "min": min,
    "max": max,
    "sum": sum,
    "range": range,
    "len": len,
    "sorted": sorted,
    "zip": zip,
    "complex": complex,
    "float": float,
}


def value_of(formula, names):
    """The formula's value. Files of the repository are as trusted as its scripts; what is not in WORDS is a slip."""
    return eval(re.sub(r"\s+", " ", formula), {"__builtins__": {}, **WORDS, **names})  # pylint: disable=eval-used


# --- files ---


def read_cases(file):
    """[{'case': name, key: text...}]; the first section describes the kind. Lines that begin with blanks continue."""
    sections, key = [], None
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        at = f"{file.name}:{number}"
        if not line.strip() or line.startswith("#"):
            continue
        if match := re.fullmatch(r"\[([\w .-]+)\]", line):
            sections.append({"case": match[1], "at": at})
            key = None
        elif line[0] == " " and key:
            sections[-1][key] += "\n" + line
        elif (match := re.fullmatch(r"(\w+):(.*)", line)) and sections and match[1] not in sections[-1]:
            key = match[1]
            sections[-1][key] = match[2]
        else:
            raise Trouble(
                f"{at}: not a section, a new key or a line that continues; see experiments/validation/README.md"
            )
    for section in sections:
        for key in section.keys() - {"case", "at"}:
            first, _, rest = section[key].partition("\n")
            section[key] = (first.strip() + "\n" + textwrap.dedent(rest)).strip()
    return sections


def check(sections, file):
    kind, *rest = sections
    scenes = {s["case"][6:]: s["scene"] for s in rest if s["case"].startswith("scene ")}
    cases = [s for s in rest if not s["case"].startswith("scene ")]
    if len({s["case"] for s in rest}) < len(rest):
        raise Trouble(f"{file.name}: two cases have one name; rename one")
    for case in cases:
        if wrong := [key for key in case if key not in (*KEYS, "case", "at")]:
            raise Trouble(f"{case['at']}: unknown key '{wrong[0]}'; the keys are {' '.join(KEYS)}")
        if wrong := [key for key in NEEDED if not case.get(key)]:
            raise Trouble(f"{case['at']}: the case has no '{wrong[0]}'; add it")
        if case.get("scene", "").startswith("@"):
            case["scene"] = scenes[case["scene"][1:]]
        case["kind"] = kind["case"]
    return cases


# --- running ---


def given(case):
    names = {}
    for line in case.get("given", "").splitlines():
        for part in filter(str.strip, line.split(";")):
            name, _, formula = part.partition("=")
            names[name.strip()] = value_of(formula.strip(), names)
    return names


def shown(value):
    return repr(value) if isinstance(value, float) else str(value)


def run(program, case, names, folder):
    """Each line of the command is run in a new folder; returns the outputs and the image, if one was written."""
    texts = {name: shown(value) for name, value in names.items()}
    pathlib.Path(folder, "scene.yaml").write_text(
        string.Template(case.get("scene", "")).substitute(texts) + "\n", encoding="utf-8"
    )
    for name, text in re.findall(r"^(\S+): (.*)$", case.get("files", ""), re.M):
        pathlib.Path(folder, name).write_text(text.replace(r"\n", "\n") + "\n", encoding="utf-8")
    outs = []
    for line in case["command"].splitlines():
        words = string.Template(line).substitute(texts).split()
        words += [] if "--json" in words or words[0] == "fan" else ["--json"]
        if words[0] != "media":
            words.insert(1, "scene.yaml")
        done = subprocess.run(
            [program, *words], cwd=folder, capture_output=True, encoding="utf-8", check=False, timeout=170
        )
        if done.returncode:
            raise ValueError(done.stderr.strip().splitlines()[-1])
        outs.append(json.loads(done.stdout, object_hook=Record) if "--json" in words else None)
    found = {"outs": outs, "out": outs[0]}
    fan, images = pathlib.Path(folder, "fan.csv"), sorted(pathlib.Path(folder).glob("*.pfm"))
    if images:
        found["images"] = [Image(image) for image in images]
        found["image"] = found["images"][0]
    if fan.exists():
        with open(fan, newline="", encoding="utf-8") as file:
            found["fan"] = [Record(row) for row in csv.DictReader(line for line in file if not line.startswith("#"))]
    return found


def judge(program, case):
    """The row of a case. Whatever keeps its value from being computed is the verdict 'error'."""
    row = {
        "kind": case["kind"],
        "case": case["case"],
        "what": case["what"],
        "source": case["source"],
        "formula": case["expected"],
        "reason": case["because"],
        "unit": case.get("unit", ""),
        "ours": "",
        "deviation": "",
        "expected": "",
        "tolerance": "",
        "nature": "",
        "verdict": "error",
    }
    row = {key: re.sub(r"\s+", " ", text) for key, text in row.items()}
    try:
        names = given(case)
        expected = float(value_of(case["expected"], names))
        tolerance = float(value_of(case["tolerance"], {**names, "expected": expected}))
        row |= {"expected": expected, "tolerance": tolerance}
        if "nature" in case:
            row["nature"] = float(value_of(case["nature"], names))
        with tempfile.TemporaryDirectory() as folder:
            ours = float(value_of(case["read"], {**names, **run(program, case, names, folder)}))
        deviation = abs(ours - expected)
        within = math.isfinite(deviation) and 0 < tolerance < math.inf and deviation <= tolerance
        row |= {"ours": ours, "deviation": deviation, "verdict": "pass" if within else "fail"}
    except Exception as error:  # pylint: disable=broad-except
        print(f"{case['at']}: {case['case']}: error: {type(error).__name__}: {error}", file=sys.stderr)
    if row["verdict"] == "fail":
        print(
            f"{case['at']}: {case['case']}: {row['ours']!r} differs from {row['expected']!r} by "
            f"{row['deviation']:.3g}, more than {row['tolerance']:.3g}",
            file=sys.stderr,
        )
    return row


def main():
    if len(sys.argv) < 3:
        raise Trouble("usage: validate.py CUVETTE ROWS.csv [FILE.cases...]")
    program = str(pathlib.Path(sys.argv[1]).resolve())
    files = [pathlib.Path(name) for name in sys.argv[3:]] or sorted(FOLDER.glob("*.cases"))
    cases = [case for file in files for case in check(read_cases(file), file)]
    workers = len(os.sched_getaffinity(0))
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        rows = list(pool.map(lambda case: judge(program, case), cases))
    with open(sys.argv[2], "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows({key: shown(value) for key, value in row.items()} for row in rows)
    passed = sum(row["verdict"] == "pass" for row in rows)
    kinds = len({row["kind"] for row in rows})
    print(f"{passed} of {len(rows)} cases of {kinds} kinds are within their tolerances: {sys.argv[2]}")
    return 0 if rows and passed == len(rows) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Trouble, OSError) as problem:
        print(f"validate: {problem}", file=sys.stderr)
        sys.exit(2)
