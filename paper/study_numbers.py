"""Every value of a study's summary as a number, STUDY/AXIS VALUES/COLUMN, formatted by its kind: times in ms, rays in
millions, fractions in percent; and numbers derived from them: ratios and differences of measured values have an
interval, or with fewer than six repetitions a range.
"""

import math
import re
from collections import defaultdict

from values import axis, combine, digits, exact, known, scaled, scientific, significant, tex_of, value_of

HIERARCHIES = ("none", "sphere", "octant", "bvh")


def formatted(column, text):
    if text in ("NA", ""):
        return None
    if re.search(r"_s(_[a-z]+)?$", column):
        return digits(float(text) * 1e3)
    if column.startswith("rays_"):
        return f"{float(text) / 1e6:.3f}"
    if column in ("others_fraction", "differing_fraction"):
        return f"{float(text) * 100:.1f}"
    if column in ("peak_rss_bytes", "accel_bytes"):
        return f"{float(text) / 1048576:.1f}"
    if column == "psnr_db":
        return f"{float(text):.1f}"
    if column == "ssim":
        return f"{float(text):.4f}"
    if re.fullmatch("flip|mse|largest|error_rms|noise_rms|reference_noise_rms", column):
        return significant(float(text))
    if re.match("first_hits|total_internal|n$|marked|triangles|instances", column):
        return str(int(float(text)))
    return text


def real(row, column):
    """A number of the summary; None if it has none."""
    return float(row[column]) if known(row, column) else None


def key_of(study, row, axes):
    """The key of a cell: its axes, of studies whose axes all depend on one of them only that one."""
    value = [axis(row[column]) for column in axes]
    text = [row[column] for column in axes]
    if study == "methods":
        parts = ["path", text[1]] if text[0] == "path" else [text[0]]
    elif study == "lighting":
        parts = [text[0]]
    elif study == "triangles":
        parts = ["empty"] if text[2] == "off" else [text[0], value[1]]
    elif study == "coverage":
        parts = [text[0], f"{(real(row, 'first_hits.model') or 0) / 1000:.0f}"]
    elif study == "hidden":
        parts = [value[0], text[4]]
    elif study == "shading":
        parts = [
            "few" if float(text[0]) < 100 else "many",
            text[2] if text[3] == "off" else "shadows",
            text[4] if float(text[5]) else "unlit",
        ]
    elif study == "texture":
        parts = text[:3]
    elif study == "slime-step":
        parts = [value[0], text[1], value[4]]
    elif study == "build":
        parts = [text[0], value[1], text[2], value[5]]
    else:
        parts = value
    return "/".join([study, *parts])


class Cells:
    """The cells of a study that have rows: by key the line of the summary, its axes, and its main values."""

    def __init__(self, study, rows):
        columns = list(rows[0])
        self.study, self.axes = study, columns[1 : columns.index("n")]
        self.measured = columns[columns.index("n") :]
        self.rows = [row for row in rows if (real(row, "n") or 0) > 0]
        self.by_key = {key_of(study, row, self.axes): row for row in self.rows}

    def value(self, row, column):
        """A measured value with its interval; None without one."""
        return value_of({name: row[name] for name in self.measured}, column)

    def rate(self, row):
        """Rays in a second of CPU time."""
        cpu, rays = self.value(row, "cpu_s"), real(row, "rays_total")
        return self.value(row, "rays_total/cpu_s") or (combine("/", exact(rays), cpu) if rays and cpu else None)

    def of(self, key, column):
        row = self.by_key.get(key)
        return self.value(row, column) if row else None


def put_value(numbers, key, value):
    if value is not None:
        numbers.put(key, tex_of(value))


def put_cost(numbers, key, value):
    """A cost is a difference of two times. It is a number only if it is certainly positive."""
    if value is not None and value.kind != "unbounded" and value.low > 0:
        numbers.put(key, tex_of(value))


def put_ratio(numbers, key, above, below):
    put_value(numbers, key, combine("/", above, below))


def every_cell(numbers, cells):
    """What the cells of each study have."""
    for key, row in ((key_of(cells.study, row, cells.axes), row) for row in cells.rows):
        for column in cells.measured:
            if not re.search("/|^imbalance|^environment$", column):
                numbers.put(f"{key}/{column}", formatted(column, row[column]))
        put_value(numbers, f"{key}/imbalance", scaled_or_none(cells.value(row, "imbalance"), 100))
        rate = scaled_or_none(cells.rate(row), 1e-6)
        put_value(numbers, f"{key}/rate", rate)
        rays_camera, triangles = real(row, "rays_camera"), real(row, "triangles")
        if rays_camera and known(row, "cut_depth_throughput"):
            numbers.put(f"{key}/cut", scientific(real(row, "cut_depth_throughput") / rays_camera, 2, 10))
        if triangles:
            numbers.put(f"{key}/bytes-triangle", f"{(real(row, 'accel_bytes') or 0) / triangles:.0f}")
            put_value(numbers, f"{key}/million-rays", rate)
        if rays_camera:
            hits = sum(real(row, f"first_hits.{name}") or 0 for name in ("vessel", "liquid"))
            numbers.put(f"{key}/glass", f"{hits / rays_camera * 100:.1f}")


def scaled_or_none(value, factor):
    return None if value is None else scaled(value, factor)


def whole_study(numbers, cells):
    """Cells, rows, and what the bars of a study's figures are."""
    study, counts = cells.study, [int(row["n"]) for row in cells.rows]
    numbers.put(f"{study}/marked", sum(int(real(row, "marked") or 0) for row in cells.rows))
    numbers.put(f"{study}/disturbed-rows", sum(int(real(row, "disturbed") or 0) for row in cells.rows))
    if not counts:
        return
    numbers.put(f"{study}/cells", len(counts))
    numbers.put(f"{study}/rows", sum(counts))
    fewest, most = min(counts), max(counts)
    numbers.put(f"{study}/n", f"{fewest}--{most}" if most > fewest else fewest)
    count = f"$n = {fewest}" + (f"$ to~${most}" if most > fewest else "") + "$"
    if all(known(row, "wall_s_low") for row in cells.rows):
        numbers.put(f"{study}/bars", rf"95\,\% intervals of the median, {count}")
    else:
        numbers.put(f"{study}/bars", f"smallest and largest value, {count}" if most > 1 else count)
    others = [real(row, "others_fraction") for row in cells.rows if known(row, "others_fraction")]
    if others:
        numbers.put(f"{study}/others", f"{sum(others) / len(others) * 100:.0f}")


# --- single studies


def depth(numbers, cells):
    first = next((row for row in cells.rows if float(row["render.depth"]) == 0), None)
    for key, row in cells.by_key.items() if first else ():
        put_ratio(numbers, f"{key}/growth", cells.value(row, "cpu_s"), cells.value(first, "cpu_s"))
        numbers.put(f"{key}/rays-growth", digits(real(row, "rays_total") / real(first, "rays_total")))


def threads(numbers, cells):
    walls = defaultdict(dict)
    for row in cells.rows:
        walls[row["render.schedule"]][row["render.threads"]] = cells.value(row, "wall_s")
    for schedule, wall in walls.items():
        prefix = f"threads/{schedule}"
        for count in wall:
            put_ratio(numbers, f"{prefix}/{count}/speedup", wall.get("1"), wall[count])
        put_ratio(numbers, f"{prefix}/two-four", wall.get("2"), wall.get("4"))
        best = min(wall, key=lambda count: wall[count].mid)
        numbers.put(f"{prefix}/best", best)
        if "1024" in wall:
            loss = combine("-", combine("/", wall["1024"], wall[best]), exact(1))
            put_value(numbers, f"{prefix}/loss", exact(0) if best == "1024" else scaled(loss, 100))


def sectors(numbers, cells):
    walls = {}
    for key, row in cells.by_key.items():
        wall, axes = cells.value(row, "wall_s"), [row[axis_name] for axis_name in cells.axes]
        walls[axes[0], axes[1], axes[2]] = wall
        if axes[2] == "4":
            put_ratio(numbers, f"{key}/two-four", walls.get((axes[0], axes[1], "2")), wall)
        put_value(numbers, f"{key}/wall", scaled(wall, 1e3))


def pool(numbers, cells):
    walls = {(row["render.pool"], row["render.threads"]): cells.value(row, "wall_s") for row in cells.rows}
    for (used, count), wall in walls.items():
        if used == "off" and ("on", count) in walls:
            put_cost(numbers, f"pool/{count}/added", scaled(combine("-", wall, walls["on", count]), 1e3))


def sufficient_depth(numbers, cells):
    """By the rule of plots/convergence.gp."""
    enough = {}
    for row in cells.rows:
        beyond, depth_of = row[cells.axes[0]], row[cells.axes[1]]
        if known(row, "flip") and real(row, "flip") < 0.01:
            enough.setdefault(beyond, depth_of)
    for beyond, depth_of in enough.items():
        numbers.put(f"{cells.study}/{beyond}/enough", depth_of)


def methods(numbers, cells):
    whitted = next((row for row in cells.rows if row["render.integrator"] == "whitted"), None)
    paths = [row for row in cells.rows if row["render.integrator"] == "path" and (real(row, "error_rms") or 0) > 0]
    for name, column in (("rms-first", "error_rms"), ("flip-first", "flip")) if whitted else ():
        better = (
            row["render.paths"] for row in paths if known(row, column) and real(row, column) < real(whitted, column)
        )
        numbers.put(f"methods/{name}", next(better, None))
    for key, row in cells.by_key.items() if whitted else ():
        numbers.put(f"{key}/rays-ratio", digits(real(row, "rays_total") / real(whitted, "rays_total")))
    if len(paths) > 1:  # least-squares fit of log error against log N
        x = [math.log(float(row["render.paths"])) for row in paths]
        y = [math.log(real(row, "error_rms")) for row in paths]
        n, xy, xx = len(x), sum(a * b for a, b in zip(x, y)), sum(a * a for a in x)
        numbers.put("methods/slope", digits((n * xy - sum(x) * sum(y)) / (n * xx - sum(x) * sum(x))))


def relative_to_first(numbers, cells):
    first = cells.rows[0] if cells.rows else None
    for key, row in cells.by_key.items():
        put_ratio(numbers, f"{key}/cpu-ratio", cells.value(row, "cpu_s"), cells.value(first, "cpu_s"))
        numbers.put(f"{key}/rays-ratio", digits(real(row, "rays_total") / real(first, "rays_total")))


def polygons(numbers, cells):
    """The studies triangles and crowding."""

    def cpu(accel, count):
        return cells.of(f"{study}/{accel}/{count}", "cpu_s")

    study = cells.study
    for accel in HIERARCHIES:
        put_ratio(numbers, f"{study}/{accel}/growth", cpu(accel, 50000), cpu(accel, 10000))
        put_ratio(numbers, f"{study}/{accel}/gain", cpu("none", 10000), cpu(accel, 10000))
        if study == "triangles":
            put_ratio(numbers, f"{study}/{accel}/first-doubling", cpu(accel, 20000), cpu(accel, 10000))
            put_ratio(numbers, f"{study}/{accel}/last-doubling", cpu(accel, 4000000), cpu(accel, 2000000))
    put_ratio(numbers, f"{study}/octant-bvh", cpu("octant", 50000), cpu("bvh", 50000))


def build(numbers, cells):
    """The number of rays after which a build with one thread has paid off."""

    def ray_s(key):
        return combine("/", exact(1), cells.rate(cells.by_key[key])) if key in cells.by_key else None

    for scene in ("sparse", "dense", "sphere"):
        for accel in HIERARCHIES:
            prefix = f"build/{scene}/50000"
            saved = combine("-", ray_s(f"{prefix}/none/1"), ray_s(f"{prefix}/{accel}/1"))
            put_cost(numbers, f"{prefix}/{accel}/pays", combine("/", cells.of(f"{prefix}/{accel}/1", "build_s"), saved))


def hidden(numbers, cells):
    """The memory of a method in addition to triangles and film: hierarchies, or the depth buffer and its triangles."""
    for key, row in cells.by_key.items():
        size = (real(row, "accel_bytes") or 0) + (real(row, "drawn_bytes") or 0)
        if size > 0:
            numbers.put(f"{key}/memory", f"{size / 1048576:.1f}")
    for method in ("zbuffer", "raycast", "whitted"):
        more, fewer = (cells.of(f"hidden/{count}/{method}", "cpu_s") for count in (6, 3))
        put_ratio(numbers, f"hidden/{method}/more", more, fewer)


def slime_frame(numbers, cells):
    """With one thread, its busy time is the frame's."""
    fractions, visible = [], {}
    for key, row in cells.by_key.items():
        fraction = scaled_or_none(cells.value(row, "visibility_s_sum/wall_s"), 100)
        if fraction is None:
            continue
        put_value(numbers, f"{key}/visible-fraction", fraction)
        visible[key] = scaled_or_none(cells.value(row, "visibility_s_sum/rays_total"), 1e9)
        put_value(numbers, f"{key}/visible-ray", visible[key])
        if row[cells.axes[2]] == "bvh" and float(row[cells.axes[0]]) == 0:
            fractions.append(fraction)
    if fractions:
        put_value(numbers, "slime-frame/ball/bvh/least-fraction", min(fractions, key=lambda fraction: fraction.mid))
        put_value(numbers, "slime-frame/ball/bvh/most-fraction", max(fractions, key=lambda fraction: fraction.mid))
    for level in range(8):
        ball, prefix = f"slime-frame/0/{level}", f"slime-frame/{level}"
        bvh = visible.get(f"{ball}/bvh")
        put_ratio(numbers, f"{prefix}/stretch", visible.get(f"slime-frame/0.5/{level}/bvh"), bvh)
        put_ratio(numbers, f"{prefix}/gain", visible.get(f"{ball}/none"), bvh)
        put_ratio(numbers, f"{prefix}/octant-bvh", visible.get(f"{ball}/octant"), bvh)


def slime_step(numbers, cells):
    """Microseconds a step, and seconds simulated in a second."""
    steps = {}
    for key, row in cells.by_key.items():
        step = cells.value(row, "motion_s/motion_steps")
        if real(row, "motion_steps") and step:
            steps[key] = step
            put_value(numbers, f"{key}/step", scaled(step, 1e6))
            simulated_s = exact(float(row[cells.axes[3]]))
            put_value(numbers, f"{key}/simulated", combine("/", simulated_s, cells.value(row, "motion_s")))
    for level in range(8):
        prefix = f"slime-step/{level}"
        of = {name: steps.get(f"{prefix}/{name}") for name in ("euler/1", "euler/2", "implicit/1", "implicit/2")}
        put_ratio(numbers, f"{prefix}/dearer", of["implicit/1"], of["euler/1"])
        put_ratio(numbers, f"{prefix}/speedup", of["euler/1"], of["euler/2"])
        put_ratio(numbers, f"{prefix}/implicit-speedup", of["implicit/1"], of["implicit/2"])


def shading(numbers, cells):
    """The cost of a shading: its frame minus the one without light. Shadow rays are not part of it, so that a frame
    with shadows has the cost of the one without. The excess of Phong shading over flat shading is the cost of its
    normals."""
    costs, phong = {}, []
    for key, row in cells.by_key.items():
        _, count, frame, shade = key.split("/")
        if shade == "unlit":
            continue
        frames = f"shading/{count}/{'whitted' if frame == 'shadows' else frame}"
        costs[key] = combine("-", cells.of(f"{frames}/{shade}", "cpu_s"), cells.of(f"{frames}/unlit", "cpu_s"))
        fraction = scaled_or_none(combine("/", costs[key], cells.value(row, "cpu_s")), 100)
        put_cost(numbers, f"{key}/cost", scaled_or_none(costs[key], 1e3))
        put_cost(numbers, f"{key}/fraction", fraction)
        if shade == "smooth" and fraction:
            phong.append(fraction)
        # Corners of the mesh, each of which Gouraud's original method would light once.
        if (shade, frame) == ("gouraud", "zbuffer"):
            points = real(row, "first_hits.model") / (float(row[cells.axes[0]]) * float(row[cells.axes[1]]))
            numbers.put(f"shading/{count}/points-corner", f"{points:.0f}" if points > 10 else significant(points))
    if phong:
        put_cost(numbers, "shading/least-phong", min(phong, key=lambda fraction: fraction.mid))
        put_cost(numbers, "shading/most-phong", max(phong, key=lambda fraction: fraction.mid))
    for key in costs:
        if key.endswith("/gouraud"):
            prefix = key.removesuffix("/gouraud")
            put_ratio(numbers, f"{prefix}/gouraud-phong", costs[key], costs.get(f"{prefix}/smooth"))


OWN = {
    "depth": depth, "threads": threads, "sectors": sectors, "pool": pool, "convergence": sufficient_depth,
    "methods": methods, "spectral": relative_to_first, "polarised": relative_to_first, "triangles": polygons,
    "crowding": polygons, "build": build, "hidden": hidden, "slime-frame": slime_frame, "slime-step": slime_step,
    "shading": shading,
}  # fmt: skip


def study_numbers(numbers, study, rows):
    cells = Cells(study, rows)
    every_cell(numbers, cells)
    whole_study(numbers, cells)
    if study in OWN:
        OWN[study](numbers, cells)
