"""All numbers of the paper, computed only from rows: from the tables of experiments/tables.sh, from small float images,
and from the lists of runs. `numbers_of(results)` returns them by key, as text for \\val and as the number that a reader
sees.
"""

import json
import math
import pathlib
import re
import struct
from collections import defaultdict

from queries import query_numbers
from study_numbers import study_numbers
from values import Printed, axis, combine, exact, fixed, known, rows_of, scaled, scientific, signed, tex_of, value_of

ROOT = pathlib.Path(__file__).resolve().parents[1]
PUBLISHED = ROOT / "experiments/published"
# Tables that the paper has no numbers of, or that functions below read.
APART = re.compile(r"published-|growth|paths$|visible-grid|query-|laws$|reproduced$")


class Numbers(dict):
    """Printed numbers by key."""

    def put(self, key, shown):
        """shown: Printed, or a text or whole number; nothing is put of None and of an empty text."""
        if shown is None or shown == "":
            return
        if not isinstance(shown, Printed):
            text = f"{shown:.6g}" if isinstance(shown, float) else str(shown)
            start = re.match(r"-?[0-9.]+(e-?[0-9]+)?", text)
            try:
                shown = Printed(text, float(start[0]) if start else None)
            except ValueError:
                shown = Printed(text, None)
        self[key] = shown


def places(number, count):
    return signed(fixed(number, count))


# --- metrics, curves, motion


def shown_metric(text, unit):
    """Angles are converted from radians to degrees, errors are not."""
    if text == "NA":
        return None
    if unit == "rad":
        return places(float(text) * 180 / math.pi, 3)
    return places(float(text), 2 if unit in ("px", "deg") else 4)


class Group:
    """Metrics that are counted together."""

    def __init__(self):
        self.values = self.none = self.passed = 0
        self.worst = self.tolerance = self.fraction = 0.0

    def count(self, row):
        if row["passes"] == "NA":
            self.none += 1
            return
        self.values += 1
        self.passed += int(row["passes"])
        if row["error"] == "NA":
            return
        error, tolerance = float(row["error"]), float(row["tolerance"]) if known(row, "tolerance") else 0
        self.worst, self.tolerance = max(self.worst, error), max(self.tolerance, tolerance)
        if tolerance > 0:
            self.fraction = max(self.fraction, error / tolerance)


def metrics(numbers, study, rows):
    """Every metric, STUDY/AXIS VALUES/METRIC/measured, theory and error; by metric and by its first word how many agree
    with theory, and the largest error."""
    columns = list(rows[0])
    axes = columns[2 : columns.index("metric")]
    if study == "polarisation":
        axes = axes[:2]  # both plates have the same rotation
    groups, cells, angles, through, wavelengths = defaultdict(Group), defaultdict(float), {}, {}, set()
    for row in rows:
        name, measured = row["metric"], row["measured"]
        key = "/".join([study, *(axis(row[column], 10) for column in axes)])
        numbers.put(f"{key}/{name}/measured", shown_metric(measured, row["unit"]))
        numbers.put(f"{key}/{name}/theory", shown_metric(row["theory"], row["unit"]))
        if known(row, "error"):
            numbers.put(f"{key}/{name}/error", scientific(float(row["error"])))
        family = name.split(".")[0]
        for group in dict.fromkeys(("metrics", name, family)):
            groups[group].count(row)
        fraction = 0.0
        if known(row, "error", "tolerance") and float(row["tolerance"]) > 0:
            fraction = float(row["error"]) / float(row["tolerance"])
        cells[key] = max(cells[key], fraction)
        if family in ("prism", "rainbow") and measured != "NA":
            angles[row[columns[2]], name[len(family) + 1 :]] = float(measured)
        if name.endswith(".own"):
            wavelengths.add(row[columns[3]])
        if study == "polarisation" and measured != "NA":
            through[name, row[columns[2]], row[columns[3]]] = float(measured)
    for key, fraction in cells.items():
        numbers.put(f"{key}/fraction", scientific(fraction))
    for name, group in groups.items():
        if not group.values:
            continue
        prefix = f"{study}/{name}"
        numbers.put(f"{prefix}/values", group.values)
        numbers.put(f"{prefix}/passed", group.passed)
        numbers.put(f"{prefix}/failed", group.values - group.passed)
        numbers.put(f"{prefix}/none", group.none)
        for name_of in ("worst", "tolerance", "fraction"):
            numbers.put(f"{prefix}/{name_of}", scientific(getattr(group, name_of)))
    if wavelengths:
        numbers.put(f"{study}/wavelengths", len(wavelengths))
    dispersion(numbers, study, angles)
    polarisation(numbers, through)


def dispersion(numbers, study, angles):
    """The spread between the lines F and C. The prism of experiments/scenes/prism.yaml has 60 degrees:
    n = sin((60 + D) / 2) / sin(60 / 2), Hecht, 5.5.1."""
    for medium in {medium for medium, _ in angles}:
        of = {line: angles.get((medium, line), 0.0) for line in "FCd"}
        if (medium, "F") in angles:
            numbers.put(f"{study}/{medium}/spread", places(abs((of["F"] - of["C"]) * 180 / math.pi), 3))
        if study == "dispersion" and (medium, "d") in angles:
            n = {line: 2 * math.sin(math.pi / 6 + of[line] / 2) for line in "FCd"}
            numbers.put(f"{study}/{medium}/index", places(n["d"], 5))
            if n["F"] > n["C"]:
                numbers.put(f"{study}/{medium}/abbe", places((n["d"] - 1) / (n["F"] - n["C"]), 2))


def polarisation(numbers, through):
    """The error of the mean of s and p, by angle; and its largest value, as a difference of fractions, with its
    angle."""
    most = {}
    for (name, light, angle), fraction in through.items():
        mean = through.get((name, "off", angle))
        if light != "on" or mean is None:
            continue
        if mean:
            numbers.put(f"polarisation/{angle}/{name}/more", places((fraction / mean - 1) * 100, 1))
        if fraction - mean > most.get(name, (0, ""))[0]:
            most[name] = (fraction - mean, angle)
    for name, (off, angle) in most.items():
        numbers.put(f"polarisation/{name}/most", places(off, 3))
        numbers.put(f"polarisation/{name}/most-at", axis(angle))


def curves(numbers, study, rows):
    for row in rows:
        numbers.put(f"{study}/curve/{row['curve']}/points", row["points"])
        numbers.put(f"{study}/curve/{row['curve']}/worst", scientific(float(row["error"])))
    numbers.put(f"{study}/curves/points", sum(int(row["points"]) for row in rows))


def shown_motion(number):
    """Three digits, as a power of ten if plain digits would hide the value."""
    if number == 0:
        return Printed("0", 0.0)
    size = abs(number)
    if size < 1e-3:
        power = scientific(size)
        return power if number > 0 else Printed(r"\ensuremath{-}" + power.tex, -power.value)
    count, scale = (0 if size >= 100 else 1 if size >= 10 else 2), size
    while scale < 1:
        scale, count = scale * 10, count + 1
    return signed(f"{'-' if number < 0 else ''}{size:.{count}f}")


def motion(numbers, study, rows):
    """Values of `cuvette motion`, STUDY/INTEGRATOR/STEP IN MS/STIFFNESS/NAME/measured, theory, error and relative
    error; by name the largest; by integrator the power of the step with which an error grows, over the cells of one
    stiffness."""
    worst, relative, errors = defaultdict(float), defaultdict(float), defaultdict(list)
    for row in rows:
        name, step_s, stiffness = row["name"], float(row["toy.dt_s"]), float(row["toy.stiffness"])
        key = f"{study}/{row['toy.integrator']}/{step_s * 1000:.6g}/{stiffness:.6g}/{name}"
        scale = 1000 if row["unit"] == "s" else 1
        for column in ("measured", "theory", "error"):
            if row[column] != "NA":
                numbers.put(f"{key}/{column}", shown_motion(float(row[column]) * scale))
        if row["error"] == "NA":
            continue
        error, theory = float(row["error"]), abs(float(row["theory"])) if known(row, "theory") else 0
        worst[name] = max(worst[name], error)
        if theory > 0:
            numbers.put(f"{key}/relative", shown_motion(error / theory))
            relative[name] = max(relative[name], error / theory)
        if error > 0 and stiffness == 10:
            errors[f"{study}/{row['toy.integrator']}/{name}"].append((math.log(step_s), math.log(error)))
    for name, error in worst.items():
        numbers.put(f"{study}/{name}/worst", shown_motion(error))
        if relative[name] > 0:
            numbers.put(f"{study}/{name}/worst-relative", shown_motion(relative[name]))
    for key, points in errors.items():
        if len(points) > 2:
            n, x, y = len(points), sum(x for x, _ in points), sum(y for _, y in points)
            xx, xy = sum(x * x for x, _ in points), sum(x * y for x, y in points)
            numbers.put(f"{key}/power", f"{(n * xy - x * y) / (n * xx - x * x):.2f}")


# --- the same bits everywhere


def of_machine(row):
    return "" if row["machine"] == "this" else row["machine"] + "/"


def prices(numbers, rows):
    """Of a price: the quotient with its interval, and the same in per cent more."""
    medians, rounds = defaultdict(list), []
    for row in rows:
        price = value_of(row, "price")
        if price is None:
            continue
        prefix = f"determinism/{of_machine(row)}{row['part']}"
        key = f"{prefix}/{row['compiler']}/{row['isa']}" + ("" if row["scene"] == "all" else f"/{row['scene']}")
        numbers.put(key, tex_of(price))
        numbers.put(f"{key}/more", tex_of(scaled(combine("-", price, exact(1)), 100)))
        if row["scene"] == "all":
            medians[prefix].append(price.mid)
        if row["machine"] == "this" and int(row["n"]) > 0:
            rounds.append(int(row["n"]))
    for prefix, prices_of in medians.items():
        numbers.put(f"{prefix}/lowest", f"{min(prices_of):.2f}")
        numbers.put(f"{prefix}/highest", f"{max(prices_of):.2f}")
    numbers.put("determinism/rounds", min(rounds, default=None))


def bits(numbers, rows):
    for row in rows:
        key = f"bits/{of_machine(row)}{row['film']}-{row['contract']}"
        for name, column in (
            ("frames", "frames"),
            ("films", "films"),
            ("most", "most_films"),
            ("scenes", "scenes"),
            ("counts", "counts"),
            ("rays", "ray_difference"),
        ):
            numbers.put(f"{key}/{name}", row[column])
        numbers.put(f"{key}/difference", scientific(float(row["max_difference"])))
        numbers.put(f"{key}/fraction", f"{100 * float(row['differing_fraction']):.1f}")


def films(numbers, rows):
    of = {column: [int(row[column]) for row in rows] for column in rows[0] if column != "scene"}
    numbers.put("films/scenes", len(rows))
    numbers.put("films/rows", sum(of["n"]))
    numbers.put("films/agree", sum(of["n"]) - sum(of["different"]))
    numbers.put("films/alike", of["different"].count(0))
    numbers.put("films/emulated", sum(of["emulated"]))
    numbers.put("films/real", sum(of["n"]) - sum(of["emulated"]))
    for name in ("emulated", "names", "processors", "architectures", "compilers", "isas"):
        numbers.put(f"films/most/{name}", max(of[name]))
    numbers.put("films/most/builds", max(of["n"]))


def machines(numbers, rows):
    """Of the studies that were measured on another processor."""
    other = [row for row in rows if int(row["other"])]
    if other:
        numbers.put("machines/cells", sum(int(row["n"]) for row in other))
        numbers.put("machines/same", sum(int(row["same"]) for row in other))
        numbers.put("machines/studies", len(other))


# --- what the metrics detect


def detect(numbers, rows):
    """Of results/detect/rows.csv: for each kind of error the smallest size that the most sensitive metric detects in
    every cell, and that of each family; and which kinds no metric detects."""

    def power(size):
        return Printed(rf"\ensuremath{{1.0\cdot 10^{{{int(size[2:])}}}}}", float(size))

    names, detects, best = set(), defaultdict(int), {}
    for row in rows:
        metric, kind = row["metric"], row["error_kind"]
        key = f"detect/{row['scene']}/{kind}/{metric}"
        numbers.put(f"{key}/cells", row["cells"])
        numbers.put(f"{key}/detected", row["cells_detected"])
        if row["size_most"] != "NA":
            for name in ("least", "median", "most"):
                numbers.put(f"{key}/{name}", power(row[f"size_{name}"]))
        if row["scene"] == "rod" and metric.split(".")[-1] != "any":
            names.add(metric)
            detects[kind] += int(row["cells_detected"]) > 0
            if row["cells_detected"] == row["cells"] and (
                kind not in best or float(row["size_most"]) < float(best[kind]["size_most"])
            ):
                best[kind] = row
    for kind, count in detects.items():
        numbers.put(f"detect/metrics/{kind}", count)
        if kind in best:
            numbers.put(f"detect/best/{kind}", best[kind]["metric"].replace("_", r"\_"))
            numbers.put(f"detect/best/{kind}/size", power(best[kind]["size_most"]))
    numbers.put("detect/metrics", len(names))
    numbers.put("detect/kinds", len(detects))
    numbers.put("detect/kinds/undetected", sum(not count for count in detects.values()))


# --- images


def middle_row(path):
    """The middle row of a colour PFM, linear red, green and blue; and its height. None without the file."""
    if not path.is_file():
        return None, 0
    kind, size, _, pixels = path.read_bytes().split(b"\n", 3)
    assert kind == b"PF", f"{path} is not a colour PFM"
    width, height = map(int, size.split())
    values = struct.unpack_from(f"<{3 * width}f", pixels, 12 * (height // 2) * width)
    return list(zip(*[iter(values)] * 3)), height


def slab(numbers, results):
    """Light through a slab: the middle pixel of each thickness, the value of the slab's law, and the largest deviation.
    Index and coefficients are those of experiments/scenes/absorber.yaml, in 1/m; the law's R is Fresnel's at normal
    incidence."""
    reflected, worst, points = (0.33 / 2.33) ** 2, 0.0, 0
    for row in rows_of(results / "tables/absorber.tsv"):
        pixels, _ = middle_row(results / f"absorber/images/{int(row['cell']):04d}.pfm")
        if not pixels:
            continue
        thickness = row["liquid.size.z"]
        for name, absorb, light in zip(("red", "green", "blue"), (200, 60, 10), pixels[len(pixels) // 2]):
            alone = math.exp(-absorb * float(thickness) / 1000)
            numbers.put(f"absorber/{thickness}/{name}", f"{light:.5f}")
            numbers.put(f"absorber/{thickness}/{name}-alone", f"{alone:.5f}")
            worst = max(worst, abs(light - (1 - reflected) ** 2 * alone / (1 - reflected**2 * alone**2)))
            points += 1
    if points:
        numbers.put("absorber/worst", scientific(worst, largest=math.inf))
        numbers.put("absorber/points", points)


def ball(numbers, results):
    """Light through a ball of slime of radius 1, 6 away, in a field of view of 0.493 degrees: the difference of the
    path length of green light inside, absorbed by 1/m, from the ball's chord (rms over a row of pixels), and the
    light left by a surface that transmits a fraction, relative to its square."""
    for row in rows_of(results / "tables/slime-light.tsv"):
        level, fraction = row["toy.level"], row["jelly.transparency"]
        pixels, height = middle_row(results / f"slime-light/images/{int(row['cell']):04d}.pfm")
        if not pixels:
            continue
        off, worst = [], 0.0
        for i, (_, green, _) in enumerate(pixels):
            slope = (i + 0.5 - len(pixels) / 2) / (height / 2) * math.tan(math.radians(0.493 / 2))
            b = 6 * slope / math.sqrt(1 + slope**2)
            if b * b >= 1:
                continue
            chord, kept = 2 * math.sqrt(1 - b * b), green / float(fraction) ** 2
            off.append(-math.log(kept) - chord)
            worst = max(worst, abs(kept / math.exp(-chord) - 1))
        key = f"slime-light/{level}/{fraction}"
        numbers.put(f"{key}/off", scientific(math.sqrt(sum(x * x for x in off) / len(off))))
        numbers.put(f"{key}/worst", scientific(worst))
        numbers.put(f"{key}/pixels", len(off))


# --- published numbers, designs, machine, laws


def published(numbers):
    """The published numbers, and numbers derived from them."""
    triangles, coverage, crowding, depth, threads = (
        rows_of(PUBLISHED / f"{name}.csv") for name in ("triangles", "coverage", "crowding", "depth", "threads")
    )
    for row in triangles:
        numbers.put(f"published/triangles/{row['triangles']}", row["time_s"])
    for row in coverage:
        numbers.put(f"published/coverage/{row['pixels']}", row["time_s"])
    sparse_s = {row["triangles"]: float(row["time_s"]) for row in triangles}
    for row in crowding:
        count = row["triangles"]
        numbers.put(f"published/crowding/{count}", row["time_s"])
        if int(count) > 0 and count in sparse_s:
            numbers.put(f"published/crowding/{count}/slower", f"{float(row['time_s']) / sparse_s[count]:.0f}")
    for row in depth:
        cpu_s = float(row["cpu_s"])
        numbers.put(f"published/depth/{row['depth']}/cpu", f"{cpu_s:.3f}")
        numbers.put(f"published/depth/{row['depth']}/growth", f"{cpu_s / float(depth[0]['cpu_s']):.2f}")
    for row in threads:
        wall_s = float(row["wall_s"])
        numbers.put(f"published/threads/{row['threads']}/wall", f"{wall_s:.3f}")
        numbers.put(f"published/threads/{row['threads']}/speedup", f"{float(threads[0]['wall_s']) / wall_s:.2f}")
    numbers.put("published/threads/best", min(threads, key=lambda row: float(row["wall_s"]))["threads"])


def designs(numbers, tables):
    """The design of each study that has rows: processes that share its repetitions, frames before the first row."""
    for file in (*ROOT.glob("experiments/*.study"), *ROOT.glob("experiments/full/*.study")):
        if (tables / f"{file.stem}.tsv").is_file():
            given = dict(re.findall(r"^(processes|warmups): *(\d+)$", file.read_text(encoding="utf-8"), flags=re.M))
            for name, value in ({"processes": "1"} | given).items():
                numbers.put(f"{file.stem}/{name}", value)


def facts(results, study):
    """What the first run of a study notes of the machine and the build; empty without a list of runs."""
    path = results / study / "runs.json"
    if not path.is_file():
        return {}
    runs = json.loads(path.read_text(encoding="utf-8"))
    run = runs["runs"][0] if runs["runs"] else {}
    return run | run.get("environment", {}) | runs["machine"]


def machine(numbers, results):
    of = next(filter(None, (facts(results, study) for study in ("threads", "depth", "profile", "ior", "pool"))), {})
    for name in ("processing_units", "topology", "compiler", "flags", "isa", "version"):
        if of.get(name) is not None:
            numbers.put(f"machine/{name}", plain(str(of[name])))


def plain(text):
    """Escapes characters that TeX would interpret."""
    return re.sub(r"[_%$#&]", r"\\\g<0>", re.sub(r"[\\{}~^]", " ", text))


def laws(numbers, rows):
    """The laws fitted to the studies of triangles and of the area that they cover (tables/laws.tsv): times in ms, the
    published ones in s, except b of a line, which is in ms for 1000 pixels; deviations in percent."""
    for row in rows:
        a, b, off = (float(row[name]) for name in ("a", "b", "deviation"))
        scale = 1 if row["series"] == "published" else 1e3
        if row["law"] == "line":
            key = f"line/{row['series']}"
            numbers.put(f"{key}/a", f"{a * scale:.3g}")
            numbers.put(f"{key}/b", f"{b * 10:.3g}")
            numbers.put(f"{key}/off", f"{off * 100:.1f}")
        elif row["series"] in ("octant", "bvh", "published"):
            wide = row["extent"] == "wide"
            key = f"law/{row['series']}" + ("/wide" if wide else "")
            name = "power-off" if row["law"] == "power" else "off"
            numbers.put(f"{key}/{name}", f"{off * 100:.{0 if wide else 1}f}")
            if row["law"] == "power":
                numbers.put(f"{key}/power", f"{b:.2f}")
            elif not wide:
                numbers.put(f"{key}/a", f"{a * scale:.3g}")
                numbers.put(f"{key}/b", f"{b * scale:.3g}")
                # Where the logarithm is zero: a number of triangles only if it lies below those that were fitted.
                if a > 0 and b > 0:
                    numbers.put(f"{key}/zero", f"{1e4 * math.exp(-a / b):.0f}")


def numbers_of(results):
    """All numbers of a results folder, whose tables experiments/tables.sh wrote."""
    numbers, tables = Numbers(), results / "tables"
    of_table = {"determinism": prices, "determinism-bits": bits, "films": films, "machines": machines, "laws": laws}
    of_kind = {"metrics": metrics, "curve-errors": curves, "motion": motion}
    published(numbers)
    for path in sorted(tables.glob("*.tsv")):
        rows = rows_of(path)
        kind = re.search(r"-(metrics|curve-errors|curves|motion)$", path.stem)
        study = path.stem[: kind.start()] if kind else path.stem
        if not rows:
            continue
        if path.stem in of_table:
            of_table[path.stem](numbers, rows)
        elif APART.match(path.stem) or (kind and kind[1] == "curves"):
            continue
        elif kind:
            of_kind[kind[1]](numbers, study, rows)
        else:
            study_numbers(numbers, study, rows)
    designs(numbers, tables)
    slab(numbers, results)
    ball(numbers, results)
    if rows := rows_of(results / "detect/rows.csv"):
        detect(numbers, rows)
    machine(numbers, results)
    query_numbers(numbers, tables)
    return numbers
