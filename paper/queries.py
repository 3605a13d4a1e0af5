"""The tests of a ray by the number of triangles (query-*.tsv of experiments/tables.py), and what geometry asks for.

A line that meets a convex body meets a convex part of it with a probability of the ratio of their surfaces (Cauchy;
MacDonald and Booth 1990 build on it). At a level of the tree with m boxes of edge h, a ray therefore enters about m
h^2 of them. Triangles that fill a volume have h ~ m^(-1/3), hence m^(1/3) boxes: the leaves' level outweighs all
others, and the power is 1/3. On a surface h ~ m^(-1/2), hence as many boxes on each level, and the sum is the number
of levels: a logarithm.
"""

import math
from itertools import groupby

from values import known, rows_of

LATTICE = 4000


def triangles_of_lattice():
    """The normals, of twice the length of its area, of triangles with corners anywhere in a unit cube: points of a
    lattice (Korobov's kind, of the golden ratio's generalisation to nine dimensions)."""
    root = 1.0
    for _ in range(60):
        root = (1 + root) ** 0.1
    steps = [root**-k for k in range(1, 10)]
    for i in range(1, LATTICE + 1):
        p = [(i * step + 0.5) % 1 for step in steps]
        (ax, ay, az), (bx, by, bz) = ([p[k + j] - p[j] for j in range(3)] for k in (3, 6))
        yield ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def shadow(normals, x, y, z):
    """The mean shadow of these triangles along a unit direction. Along an axis it is the mean area of a triangle in a
    unit square, 11/144 (a classical result, which the paper prints beside ours)."""
    return sum(abs(nx * x + ny * y + nz * z) for nx, ny, nz in normals) / len(normals) / 2


def chords(normals):
    """The path of every twentieth camera ray (experiments/scenes/soup.yaml) through the cube [-1, 1]^3: its length, and
    the mean shadows, along the ray, of a triangle in a cube of edge 1 and of its box. Of three numbers in 0..1 the
    largest and the smallest differ by 1/2 in the mean, and the axes are independent."""
    slope, origin = math.tan(math.pi / 8), (0, 0, -3)
    for j in range(10, 300, 20):
        for i in range(10, 400, 20):
            direction = ((i - 200) / 150 * slope, (j - 150) / 150 * slope, 1)
            near, far = 0.0, 1e9
            for o, d in zip(origin, direction):
                if d:
                    near, far = max(near, min((-1 - o) / d, (1 - o) / d)), min(far, max((-1 - o) / d, (1 - o) / d))
            if far > near:
                length = math.hypot(*direction)
                unit = [abs(d) / length for d in direction]
                yield (far - near) * length, shadow(normals, *unit), sum(unit) / 4


def ask(lines, total):
    """The fraction of rays that hit something, and the boxes of single triangles that a ray meets up to its first hit,
    for a soup of that many triangles, each within a cube of edge e, a quarter of the spacing 2 / cbrt(total): boxes and
    hits are Poisson in the length of the path, if the ends of the cube are left aside."""
    e, density = 0.5 / total ** (1 / 3), total / 8
    passed = boxes = 0.0
    for length, of_triangle, of_box in lines:
        box_rate, hit_rate = density * e**2 * of_box, density * e**2 * of_triangle
        passed += math.exp(-hit_rate * length)
        boxes += box_rate * (1 - math.exp(-hit_rate * length)) / hit_rate
    return 1 - passed / len(lines), boxes / len(lines)


def grouped(count):
    """4000000 as 4\\,000\\,000."""
    return f"{int(count):,}".replace(",", r"\,")


def soup_numbers(put, points, hits):
    """points: triangles and triangles tested of a ray, of the soup in a BVH; hits: the fraction of rays that hit it."""
    normals = list(triangles_of_lattice())
    lines = list(chords(normals))
    put("soup/square", f"{shadow(normals, 0, 0, 1):.4f}")
    put("soup/square-known", f"{11 / 144:.4f}")
    asked = [ask(lines, n) for n, _ in points]
    for name, k in (("first", 0), ("last", -1)):
        covered, boxes = asked[k]
        put(f"soup/{name}/covered", f"{100 * covered:.0f}")
        put(f"soup/{name}/hit", f"{100 * hits[k]:.0f}")
        put(f"soup/{name}/asked", f"{boxes:.2f}")
        put(f"soup/{name}/overhead", f"{points[k][1] / boxes:.1f}")
    off = max(abs(hit - covered) for hit, (covered, _) in zip(hits, asked))
    put("soup/covered-off", f"{100 * off:.1f}")
    power = math.log(asked[-1][1] / asked[-2][1]) / math.log(points[-1][0] / points[-2][0])
    put("soup/asked/exponent", f"{power:.2f}")


def count_numbers(put, tables):
    exponents = rows_of(tables / "query-exponents.tsv")
    for key, rows in groupby(rows_of(tables / "query-tests.tsv"), lambda row: (row["scene"], row["hierarchy"])):
        rows, name = list(rows), "/".join(key)
        tests = [float(row["tests"]) for row in rows]
        put(f"{name}/first", f"{tests[0]:.1f}")
        put(f"{name}/last", f"{tests[-1]:.1f}")
        put(f"{name}/last/boxes", f"{float(rows[-1]['boxes']):.1f}")
        put(f"{name}/last/triangles", f"{float(rows[-1]['triangles_tested']):.2f}")
        put(f"{name}/n", grouped(float(rows[-1]["triangles"])))
        put(f"{name}/growth", f"{tests[-1] / tests[0]:.2f}")
        powers = [float(row["exponent"]) for row in exponents if (row["scene"], row["hierarchy"]) == key]
        for kind, power in (("first", powers[0]), ("last", powers[-1]), ("least", min(powers)), ("most", max(powers))):
            put(f"{name}/exponent/{kind}", f"{power:.2f}")


def time_numbers(put, rows):
    """ns a test at the fewest and at the most triangles of each hierarchy; film hashes of both studies."""
    for tree, of in groupby(sorted(rows, key=lambda row: row["hierarchy"]), lambda row: row["hierarchy"]):
        first, *_, last = of
        for name, row in (("first", first), ("last", last)):
            put(f"time/{tree}/{name}/ns", f"{float(row['ns_median']):.2f}")
            put(f"time/{tree}/{name}/mib", f"{float(row['accel_bytes']) / 1048576:.1f}")
        put(f"time/{tree}/last/n", grouped(last["triangles"]))
        for name, column in (("growth", "ns_median"), ("tests-growth", "tests"), ("time-growth", "visibility_s")):
            put(f"time/{tree}/{name}", f"{float(last[column]) / float(first[column]):.2f}")
    same = sum(row["same_film"] == "1" for row in rows)
    put("time/same", same)
    put("time/different", len(rows) - same)


def query_numbers(numbers, tables):
    def put(key, shown):
        numbers.put(f"queries/{key}", shown)

    points = [
        (float(row["triangles"]), float(row["triangles_tested"]))
        for row in rows_of(tables / "query-tests.tsv")
        if (row["scene"], row["hierarchy"]) == ("sparse", "bvh")
    ]
    hits = [
        float(row["first_hits.model"]) / float(row["query_rays_median"])
        for row in rows_of(tables / "queries.tsv")
        if (row["soup.generate"], row["render.accel"], row["render.shadows"]) == ("sparse", "bvh", "off")
        and known(row, "query_rays_median")
    ]
    if not (tables / "queries.tsv").is_file():
        return
    count_numbers(put, tables)
    if points:
        soup_numbers(put, points, hits)
    if rows := rows_of(tables / "query-times.tsv"):
        time_numbers(put, rows)
        for level in ("L2", "L3"):  # of the machine that measured the times, in MiB
            if known(rows[0], f"{level.lower()}_bytes"):
                put(f"cache/{level}", f"{int(rows[0][f'{level.lower()}_bytes']) / 1048576:g}")
