#!/usr/bin/env -S python3 -B
"""Write the tables of a results folder that no summary of a study has, for figures, claims and the paper.

  experiments/tables.py RESULTS TABLES      reads RESULTS/tables; part of experiments/tables.sh, after the summaries

determinism, determinism-bits   of experiments/determinism.sh: price and films of each build, of this run ("this") and
                                of results/machines
films, machines                 each shipped scene on all machines (results/films); films of other machines' studies
query-tests, query-exponents    tests of a ray by the number of triangles, and the local power
query-times                     memory of a hierarchy, and the time of a test
laws                            laws fitted to the times of triangles and coverage, and to the published times
STUDY-curve-errors              of each curve the number of points and the largest deviation from theory
A table without rows is not written. CUVETTE: the program.
"""

import csv
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
from collections import defaultdict

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Columns.
PRICES = (
    "machine part compiler isa scene n price_median price_low price_high price_min price_max cpu_s_median "
    "without_cpu_s_median disturbed"
).split()
BITS = (
    "machine film contract scenes frames n films most_films counts max_difference differing_fraction ray_difference "
    "ray_error"
).split()
FILMS = "scene n emulated names processors architectures compilers isas films values different".split()
HIERARCHIES = ("none", "sphere", "octant", "bvh")


def rows_of(path):
    """The lines of a table (.tsv) or of rows (.csv), as dictionaries by column; none without the file."""
    if not path.is_file():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file, delimiter="\t" if path.suffix == ".tsv" else ","))


def known(row, *columns):
    """Whether a line has a value in each of these columns."""
    return all(row.get(column) not in (None, "", "NA") for column in columns)


def write(path, columns, lines):
    """Numbers that were computed get nine digits; texts stay as they are."""
    if lines:
        with open(path, "w", encoding="utf-8") as file:
            for line in (columns, *lines):
                file.write("\t".join(f"{x:.9g}" if isinstance(x, float) else str(x) for x in line) + "\n")


# --- the same bits everywhere


def rank_of(count):
    """The rank of the order statistic where the 95 % interval of the median of count values begins; 0: there is none.
    Hahn and Meeker, Statistical Intervals: the largest k for which a binomial (count, 1/2) is below k with a
    probability of at most 0.025.
    """
    k, term, total = 0, 0.5**count, 0.0
    while k < count / 2:
        total += term
        if total > 0.025:
            break
        term *= (count - k) / (k + 1)
        k += 1
    return k


def prices(machine, rows):
    """The ratio of the CPU time of the program as it is to that of a build without a part of what makes the same bits
    everywhere, in the same round. Scene "all": in each round the geometric mean over the scenes. disturbed: rounds in
    which others used more than a quarter of the machine; the system counts in steps of 10 ms, and one step is up to a
    fifth of such a short frame.
    """
    groups = dict.fromkeys((row["compiler"], row["isa"]) for row in rows)
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    rounds = range(1 + max(int(row["repetition"]) for row in rows))
    cpu_s, loud = {}, set()
    for row in rows:
        group, repetition = (row["compiler"], row["isa"]), int(row["repetition"])
        cpu_s[f"{row['film']}-{row['contract']}", group, row["scene"], repetition] = float(row["cpu_s"])
        if float(row["others_fraction"]) > 0.25:
            loud |= {(group, row["scene"], repetition), (group, "all", repetition)}

    def line(part, group, scene, ratios, ours, theirs):
        ordered, k = sorted(ratios), rank_of(len(ratios))
        ends = (ordered[k - 1], ordered[-k]) if k else ("NA", "NA")
        medians = [statistics.median(times) if times else "NA" for times in (ours, theirs)]
        disturbed = sum((group, scene, r) in loud for r in rounds)
        price = statistics.median(ordered)
        return (machine, part, *group, scene, len(ordered), price, *ends, ordered[0], ordered[-1], *medians, disturbed)

    for part, without in (("both", "float-fast"), ("film", "float-off"), ("contraction", "fixed-fast")):
        for group in groups:
            logs = defaultdict(list)
            for scene in scenes:
                pairs = [
                    (cpu_s.get(("fixed-off", group, scene, r), 0), cpu_s.get((without, group, scene, r), 0), r)
                    for r in rounds
                ]
                pairs = [(ours, theirs, r) for ours, theirs, r in pairs if ours > 0 and theirs > 0]
                for ours, theirs, r in pairs:
                    logs[r].append(math.log(ours / theirs))
                if pairs:
                    ours, theirs, _ = zip(*pairs)
                    yield line(part, group, scene, [a / b for a, b in zip(ours, theirs)], ours, theirs)
            means = [math.exp(sum(logs[r]) / len(scenes)) for r in rounds if len(logs[r]) == len(scenes)]
            if means:
                yield line(part, group, "all", means, [], [])


def bits(machine, images, rows):
    """How many films each build makes of one scene, and how far they are from the film of the program as it is."""
    far = {
        (row["scene"], row["film_hash"]): (float(row["max_difference"]), float(row["differing_fraction"]))
        for row in images
    }
    expected, builds = {}, defaultdict(list)
    for row in rows:
        expected.setdefault(row["scene"], int(row["rays_total"]))
        builds[row["film"], row["contract"]].append(row)
    for build, made in builds.items():
        films, counts, off = defaultdict(set), set(), []
        for row in made:
            films[row["scene"]].add(row["film_hash"])
            counts.add((row["scene"], row["rays_total"]))
            off.append((abs(int(row["rays_total"]) - expected[row["scene"]]), expected[row["scene"]]))
        distances = [far.get((row["scene"], row["film_hash"]), (0.0, 0.0)) for row in made]
        yield (
            machine,
            *build,
            len(films),
            len(made),
            len(made),
            sum(map(len, films.values())),
            max(map(len, films.values())),
            len(counts),
            max(d for d, _ in distances),
            max(s for _, s in distances),
            max(rays for rays, _ in off),
            max(rays / of for rays, of in off),
        )


def determinism(results, tables):
    machines = {"this": results} | {folder.name: folder for folder in sorted((ROOT / "results/machines").glob("*"))}
    priced, made = [], []
    for machine, folder in machines.items():
        if rows := rows_of(folder / "determinism/rows.csv"):
            priced += prices(machine, rows)
            made += bits(machine, rows_of(folder / "determinism/images.csv"), rows_of(folder / "determinism/bits.csv"))
    write(
        tables / "determinism.tsv",
        PRICES,
        priced,
    )
    write(
        tables / "determinism-bits.tsv",
        BITS,
        made,
    )


def films(rows):
    """Each scene in the rows of every machine. A value that differs from the most frequent one of its scene and version
    is "different". Emulated machines are counted apart. processors: different models of processors that ran the scene
    themselves, not by emulation or in WebAssembly.
    """
    scenes = defaultdict(list)
    for row in rows:
        scenes[row["scene"]].append(row)
    for scene, of in scenes.items():
        columns = list(of[0])
        counted = columns[columns.index("film_hash") : columns.index("total_internal") + 1]
        times = defaultdict(lambda: defaultdict(int))
        for row in of:
            times[row.get("version", "1")][tuple(row[column] for column in counted)] += 1
        agreed = sum(max(of_version.values()) for of_version in times.values())
        own = {row["processor"] for row in of if row["emulated"] == "no" and not row["architecture"].startswith("wasm")}
        yield (
            scene,
            len(of),
            sum(row["emulated"] != "no" for row in of),
            len({row["name"] for row in of}),
            len(own),
            len({row["architecture"] for row in of}),
            len({row["compiler"] for row in of}),
            len({(row["architecture"], row["isa"]) for row in of}),
            len({row["film_hash"] for row in of}),
            len({value for of_version in times.values() for value in of_version}),
            len(of) - agreed,
        )


def write_films(tables):
    rows = [row for path in sorted((ROOT / "results/films").glob("*.csv")) for row in rows_of(path)]
    write(
        tables / "films.tsv",
        FILMS,
        films(rows),
    )


def machines(results):
    """The lines of `cuvette study films` of a run against the rows of other machines, of studies with cells that both
    have; the header first.
    """
    studies = sorted(ROOT.glob("experiments/*.study")) + sorted(ROOT.glob("experiments/full/*.study"))
    program = os.environ.get("CUVETTE", str(ROOT / "build/cuvette"))
    lines = []
    for folder in sorted((ROOT / "results/machines").glob("*/")):
        command = [program, "study", "films", "--results", results, "--against", folder, *studies]
        said = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False).stdout
        header, *compared = [line.split("\t") for line in said.splitlines()] or [[]]
        lines = lines or [["machine", *header]]
        lines += [[folder.name, *line] for line in compared if int(line[header.index("n")]) > 0]
    return lines


# --- tests of a ray


def caches(results):
    """Bytes of the second and third level on the machine that measured the triangles: "L2 1024 KiB, L3 32 MiB"."""
    runs = results / "triangles/runs.json"
    topology = json.loads(runs.read_text(encoding="utf-8"))["machine"].get("topology") if runs.is_file() else None
    found = dict(
        (level, (number, unit)) for level, number, unit in re.findall(r"(L[23]) ([\d.]+) ([KM])iB", topology or "")
    )
    return [
        int(float(found[level][0]) * (1024 if found[level][1] == "K" else 1048576)) if level in found else "NA"
        for level in ("L2", "L3")
    ]


def queries(results, tables):
    """The tests of a ray (experiments/queries.study), and the time of a test, from the study of triangles, which has
    the times of the same frames: those of one thread in visibility queries, nearest hits and shadows.
    """
    series, timed = defaultdict(list), []
    times = {
        (row["render.accel"], row["soup.count"]): row
        for row in rows_of(results / "tables/triangles.tsv")
        if row["model.visible"] == "on"
    }
    for row in rows_of(results / "tables/queries.tsv"):
        rays = float(row["query_rays_median"]) if known(row, "query_rays_median") else 0
        if rays <= 0:
            continue
        boxes, triangles = float(row["query_boxes_median"]), float(row["query_triangles_median"])
        if row["render.shadows"] == "off":
            series[row["soup.generate"], row["render.accel"]].append(
                (
                    float(row["triangles"]),
                    (boxes + triangles) / rays,
                    boxes / rays,
                    triangles / rays,
                    row["environment"],
                )
            )
        elif row["soup.generate"] == "sparse" and (row["render.accel"], row["soup.count"]) in times:
            of = times[row["render.accel"], row["soup.count"]]
            ns = [
                1e9 * float(of[f"visibility_s_sum_{end}"]) / (boxes + triangles)
                if known(of, f"visibility_s_sum_{end}")
                else "NA"
                for end in ("median", "min", "max")
            ]
            timed.append(
                (
                    row["render.accel"],
                    row["soup.count"],
                    of["accel_bytes"],
                    *ns,
                    boxes + triangles,
                    of["visibility_s_sum_median"],
                    int(row["film_hash"] == of["film_hash"]),
                    *caches(results),
                    of["environment"],
                )
            )
    order = [(scene, tree) for scene in ("sparse", "sphere", "dense") for tree in ("octant", "bvh")]
    write(
        tables / "query-tests.tsv",
        "scene hierarchy triangles tests boxes triangles_tested environment".split(),
        [(*key, *point) for key in order for point in series[key]],
    )
    write(
        tables / "query-exponents.tsv",
        "scene hierarchy triangles exponent environment".split(),
        [
            (*key, math.sqrt(a[0] * b[0]), math.log(b[1] / a[1]) / math.log(b[0] / a[0]), a[-1])
            for key in order
            for a, b in zip(series[key], series[key][1:])
        ],
    )
    write(
        tables / "query-times.tsv",
        (
            "hierarchy triangles accel_bytes ns_median ns_min ns_max tests visibility_s same_film l2_bytes l3_bytes "
            "environment"
        ).split(),
        timed,
    )


# --- laws


def least_squares(points, weight=lambda y: 1.0):
    """a, b of y = a + b x with the least sum of weighted squares; points: x, y."""
    w, wx, wy, wxx, wxy = (
        sum(column)
        for column in zip(*((g, g * x, g * y, g * x * x, g * x * y) for x, y in points for g in [weight(y)]))
    )
    b = (w * wxy - wx * wy) / (w * wxx - wx * wx)
    return (wy - b * wx) / w, b


def deviation(points, law):
    """The rms relative deviation of a law."""
    return math.sqrt(sum((law(x) / y - 1) ** 2 for x, y in points) / len(points))


def laws_of_triangles(series, extent, points):
    """T = a + b ln(n / 10000), weighted so that deviations are relative: a is the time at 10000 triangles, b the
    increment per factor e. T = a (n / 10000)^b, fitted to the logarithms.
    """
    points = [(math.log(n / 1e4), t) for n, t in points]
    a, b = least_squares(points, lambda t: 1 / t**2)
    yield "triangles", series, extent, "log", len(points), a, b, deviation(points, lambda x: a + b * x)
    k, p = least_squares([(x, math.log(t)) for x, t in points])
    yield "triangles", series, extent, "power", len(points), math.exp(k), p, deviation(
        points, lambda x: math.exp(k + p * x)
    )


def laws(results, tables):
    """Extent: report, its range of 10000 to 50000 triangles; wide, all from 10000 on; all, every number of pixels,
    where T = a + b pixels / 100000."""

    def columns(rows, *names):
        return [tuple(float(row[name]) for name in names[:2]) for row in rows if known(row, *names)]

    lines = []
    ours = ("cpu_s_median", "cpu_s_min", "cpu_s_max")
    triangles, coverage = rows_of(results / "tables/triangles.tsv"), rows_of(results / "tables/coverage.tsv")
    for series in (*HIERARCHIES, "published") if triangles else ():
        if series == "published":
            points = columns(rows_of(ROOT / "experiments/published/triangles.csv"), "triangles", "time_s")
        else:
            points = columns(
                [row for row in triangles if (row["model.visible"], row["render.accel"]) == ("on", series)],
                "soup.count",
                *ours,
            )
        points = [(n, t) for n, t in points if n >= 1e4]
        if len(few := [(n, t) for n, t in points if n <= 5e4]) >= 4:
            lines += laws_of_triangles(series, "report", few)
        if series != "published" and len(points) >= 6:
            lines += laws_of_triangles(series, "wide", points)
    for series in ("octant", "bvh", "published") if coverage else ():
        if series == "published":
            points = columns(rows_of(ROOT / "experiments/published/coverage.csv"), "pixels", "time_s")
        else:
            points = columns([row for row in coverage if row["render.accel"] == series], "first_hits.model", *ours)
        points = [(pixels / 1e5, t) for pixels, t in points]
        if len(points) >= 3:
            a, b = least_squares(points)
            lines.append(("coverage", series, "all", "line", len(points), a, b, deviation(points, lambda x: a + b * x)))
    write(tables / "laws.tsv", "study series extent law n a b deviation".split(), lines)


# --- curves


def curve_errors(results, tables):
    """Where the curves of the cells were not kept, as in results/reference, the table stays."""
    for study in sorted({path.parents[1] for path in results.glob("*/images/*-curves.tsv")}):
        points, largest = defaultdict(int), defaultdict(float)
        for path in sorted(study.glob("images/*-curves.tsv")):
            for row in rows_of(path):
                if known(row, "measured", "theory"):
                    points[row["curve"]] += 1
                    error = abs(float(row["measured"]) - float(row["theory"]))
                    largest[row["curve"]] = max(largest[row["curve"]], error)
        write(
            tables / f"{study.name}-curve-errors.tsv",
            "study curve points error".split(),
            [(study.name, curve, points[curve], f"{largest[curve]:.17g}") for curve in sorted(points)],
        )


def main(results, tables):
    determinism(results, tables)
    write_films(tables)
    lines = machines(results)
    if len(lines) > 1:
        write(tables / "machines.tsv", lines[0], lines[1:])
    queries(results, tables)
    laws(results, tables)
    curve_errors(results, tables)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(re.sub(r"\n\n.*", "", __doc__, flags=re.S) + "\nusage: experiments/tables.py RESULTS TABLES")
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
