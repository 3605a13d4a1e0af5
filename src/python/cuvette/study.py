"""Studies: running, and their rows as pandas tables with units and environments."""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import warnings
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple

from . import progress as bars
from ._library import (
    Cancelled,
    InputError,
    NULL,
    Visit,
    call,
    described,
    encoded,
    ffi,
    lib,
    made,
    needed,
    on_column,
    on_news,
    on_run,
    on_value,
    sized,
    taken,
    text_of,
    visited,
)
from .image import Path
from .records import html_table, svg_of
from .scene import Scene

if TYPE_CHECKING:
    import pandas

TEXTS = (
    "study",
    "identity",
    "time_utc",
    "film_hash",
    "film_expected",
    "rays_by_depth",
    "isa",
    "config",
    "run",
    "check",
)
ALL = "all"


def columns() -> Dict[str, Tuple[str, str]]:
    """Unit and meaning of every column of rows.csv; a name with <axis> or <solid> stands for one column for each."""
    found: Dict[str, Tuple[str, str]] = {}

    def take(one: Any) -> None:
        found[text_of(one.name)] = text_of(one.unit), text_of(one.meaning)

    visited(lib.cuvette_each_column, on_column, take)
    return found


def _described(name: str, known: Dict[str, Tuple[str, str]], units: Dict[str, str]) -> Tuple[str, str]:
    if name in known:
        return known[name]
    if f"{name.split('.')[0]}.<solid>" in known:
        return known[f"{name.split('.')[0]}.<solid>"]
    return units.get(name, ""), "parameter of the study's grid"


def _environments(folder: str) -> Tuple[Dict[str, str], Dict[str, Dict[str, str]]]:
    """The environment of each run, and the facts of each environment, from runs.json and those of shards."""
    of_run: Dict[str, str] = {}
    facts: Dict[str, Dict[str, str]] = {}
    for name in sorted(os.listdir(folder)):
        if not (name.startswith("runs.") and name.endswith(".json")):
            continue
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            for run in json.load(file)["runs"]:
                environment = dict(run["environment"])
                key = of_run[run["id"]] = environment.pop("key")
                facts[key] = environment
    return of_run, facts


def _excluded(folder: str) -> List[str]:
    """The checks of the rows that a person excluded."""
    path = os.path.join(folder, "excluded.csv")
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8", newline="") as file:
        return [one["check"] for one in csv.DictReader(file)]


def _chosen(table: "pandas.DataFrame", folder: str, environment: Optional[str]) -> "pandas.DataFrame":
    counts = table["environment"].value_counts()
    if environment == ALL or (environment is None and len(counts) < 2):
        return table
    if environment == "main":
        environment = counts.index[0]
    listed = ", ".join(f"{key}: {count} rows" for key, count in counts.items())
    if environment is None:
        raise InputError(
            f"the rows are of {len(counts)} environments ({listed}), whose times must not be pooled",
            'choose one with environment=KEY or "main", or "all" and group by the column environment',
            folder,
        )
    if environment not in counts.index:
        raise InputError(f"there are no rows of the environment '{environment}'", f"choose one of {listed}", folder)
    return table[table["environment"] == environment].reset_index(drop=True)


def rows(
    folder: Path, environment: Optional[str] = None, raw: bool = False, units: Optional[Dict[str, str]] = None
) -> "pandas.DataFrame":
    """The rows of a study, `cuvette.rows("results/depth")`: one per repetition, without warm-ups, marked rows and those
    excluded by hand (raw=True: with them). The column environment has the key of the row's environment; rows of several
    environments need a choice: a key, "main" (that with most rows), or "all".

    attrs of the table: "units" and "meanings" by column, "environments" with the facts of each key, "left_out" with the
    number of rows by reason."""
    pandas = needed("pandas")

    place = os.fspath(folder)
    files = (
        [n for n in sorted(os.listdir(place)) if n == "rows.csv" or n.startswith("rows.shard")]
        if os.path.isdir(place)
        else []
    )
    if not files:
        raise InputError("there are no rows", "give the folder of a study's results, such as results/depth", place)
    kinds = {name: str for name in TEXTS}
    parts = [
        pandas.read_csv(os.path.join(place, name), dtype=kinds, na_values=["NA"], keep_default_na=False)
        for name in files
    ]
    table = pandas.concat(parts, ignore_index=True).drop_duplicates(ignore_index=True)
    if "run" not in table:
        raise InputError(
            "the rows are of an early version", "write them in the present form: cuvette study upgrade", place
        )
    of_run, facts = _environments(place)
    table["environment"] = table["run"].map(of_run).fillna("unknown")
    left_out: Dict[str, int] = {}
    reasons = {
        "warm-ups": table["warmup"] == 1,
        "marked": table["marked"] == 1,
        "excluded": table["check"].isin(_excluded(place)),
    }
    if not raw:
        left_out = {reason: int(mask.sum()) for reason, mask in reasons.items()}
        table = table[~(reasons["warm-ups"] | reasons["marked"] | reasons["excluded"])].reset_index(drop=True)
    table = _chosen(table, place, environment)
    known, given = columns(), units or {}
    described_columns = {name: _described(name, known, given) for name in table.columns if name != "environment"}
    table.attrs = {
        "units": {name: one[0] for name, one in described_columns.items()},
        "meanings": {name: one[1] for name, one in described_columns.items()},
        "environments": facts,
        "left_out": left_out,
    }
    return table


class Figure:
    """A drawn figure; a notebook shows it. `path` is the file; the script and its data are next to it."""

    def __init__(self, path: str) -> None:
        self.path = path

    def _repr_png_(self) -> Optional[bytes]:
        if not self.path.endswith(".png"):
            return None
        with open(self.path, "rb") as file:
            return file.read()

    def _repr_svg_(self) -> Optional[str]:
        if not self.path.endswith(".svg"):
            return None
        with open(self.path, encoding="utf-8") as file:
            return svg_of(file.read())

    def __repr__(self) -> str:
        return f"<cuvette.Figure {self.path}>"


def _or_null(text: Optional[Path]) -> Any:
    return NULL if text is None else ffi.new("char[]", encoded(text))


class Study:
    """A study file: a scene, a grid of parameter values, repetitions. cuvette-study(5) describes the file."""

    def __init__(self, path: Path) -> None:
        self.path = os.fspath(path)
        self._study = made("study", lib.cuvette_study_read, lib.cuvette_study_destroy, encoded(path))

    @property
    def name(self) -> str:
        return text_of(lib.cuvette_study_name(self._study))

    @property
    def title(self) -> str:
        return text_of(lib.cuvette_study_title(self._study))

    def __len__(self) -> int:
        """The number of cells."""
        return int(lib.cuvette_study_cells(self._study))

    @described("cuvette_study_scene")
    def scene(self, cell: int = 0) -> Scene:
        return Scene(made("scene", lib.cuvette_study_scene, lib.cuvette_scene_destroy, self._study, cell))

    @described("cuvette_study_each_value")
    def values(self, cell: int) -> Dict[str, str]:
        found: Dict[str, str] = {}

        def take(path: Any, value: Any) -> None:
            found[text_of(path)] = text_of(value)

        visited(lib.cuvette_study_each_value, on_value, take, self._study, cell)
        return found

    def state(self, results: Path = "results") -> Dict[str, Any]:
        """How much of the study exists: the fields of cuvette_study_progress."""
        out = sized("study_progress")
        call(lib.cuvette_study_state, self._study, encoded(results), out)
        fields = [name for name, _ in ffi.typeof("cuvette_study_progress").fields if name != "size"]
        return {name: text_of(v) if isinstance(v := getattr(out, name), ffi.CData) else v for name in fields}

    @described("cuvette_study_run")
    def run(
        self,
        results: Path = "results",
        *,
        progress: bars.Progress = None,
        any_environment: bool = False,
        wait_quiet_s: float = 0.0,
    ) -> "Study":
        """Ctrl-C stops the run and raises KeyboardInterrupt; the next one resumes. A study with `processes` is measured
        by as many fresh processes of Python, one after the other. Returns the study."""
        bar = bars.bar_of(progress, f"study {self.name}")
        count = lib.cuvette_study_processes(self._study)
        try:
            for process in range(1, count + 1) if count > 1 else ():
                self._run_process(os.fspath(results), any_environment, wait_quiet_s, process)
                if bar and bar(process / count) is False:
                    raise Cancelled("the study was stopped by its progress function")
            self._run(results, any_environment, wait_quiet_s, 0, bar)
        finally:
            bars.end(bar)
        return self

    def _run(self, results: Path, any_environment: bool, wait_quiet_s: float, process: int, bar: Any) -> None:
        visit = Visit(lambda share, left_s: bar(share) if bar else True)
        visit.also = lambda text: warnings.warn(
            f"{self.name}: {text_of(text)}".replace("--wait-quiet", "wait_quiet_s=60"), stacklevel=8
        )
        run = sized("run")
        folder = _or_null(results)
        run.results, run.any_environment, run.wait_quiet_s, run.process = folder, any_environment, wait_quiet_s, process
        run.progress, run.news, run.context = on_run, on_news, visit.context
        rows_made = ffi.new("size_t *")
        try:
            call(lib.cuvette_study_run, self._study, run, rows_made)
        except Cancelled:
            visit.finish()
            raise
        visit.finish()

    def _run_process(self, results: str, any_environment: bool, wait_quiet_s: float, process: int) -> None:
        code = (
            f"import cuvette\nstudy = cuvette.study({self.path!r})\n"
            f"study._run({results!r}, {any_environment!r}, {wait_quiet_s!r}, {process}, None)"
        )
        folder = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        path = os.pathsep.join(filter(None, (folder, os.environ.get("PYTHONPATH"))))
        child = subprocess.Popen(
            [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, stderr=subprocess.PIPE, text=True
        )
        try:
            errors = child.communicate()[1]
        except KeyboardInterrupt:
            child.send_signal(signal.SIGINT)
            child.wait()
            raise
        if child.returncode:
            last = errors.strip().splitlines()[-1:] or [f"status {child.returncode}"]
            raise InputError(f"process {process} failed: {last[0]}", "rows so far are kept", self.path)

    def _folder(self, results: Path) -> str:
        return os.path.join(os.fspath(results), self.name)

    def rows(
        self, results: Path = "results", environment: Optional[str] = None, raw: bool = False
    ) -> "pandas.DataFrame":
        """The rows of the study, as of cuvette.rows, with the units of the grid's parameters; warns of rows that fail
        a check."""
        fault = self.state(results)["fault"]
        if fault:
            warnings.warn(f"{self._folder(results)}: {fault}; see cuvette study verify", stacklevel=2)
        units = {p.path: p.unit for p in self.scene(0).parameters}
        return rows(self._folder(results), environment, raw, units)

    @described("cuvette_study_summary")
    def summary(self, results: Path = "results", environment: Optional[str] = None) -> "pandas.DataFrame":
        """One line per cell and environment, as a DataFrame."""
        pandas = needed("pandas")

        out, fault = ffi.new("char **"), ffi.new("char **")
        call(lib.cuvette_study_summary, self._study, encoded(results), _or_null(environment), out, fault)
        text = taken(out[0])
        self._warn(fault, results)
        kinds = {name: str for name in (*TEXTS, "environment")}
        return pandas.read_csv(io.StringIO(text), sep="\t", dtype=kinds, na_values=["NA"], keep_default_na=False)

    @described("cuvette_study_compare")
    def compare(self, a: str, b: str, column: Optional[str] = None, results: Path = "results") -> "pandas.DataFrame":
        """One line per pair of cells, and one over all (cell is NA); attrs has the environments of both sides."""
        pandas = needed("pandas")

        out, fault = ffi.new("char **"), ffi.new("char **")
        call(
            lib.cuvette_study_compare,
            self._study,
            encoded(results),
            encoded(a),
            encoded(b),
            _or_null(column),
            out,
            fault,
        )
        found = json.loads(taken(out[0]) or "{}")
        self._warn(fault, results)
        lines = []
        for line in [*found["cells"], found["all"]]:
            values = dict(zip(found["columns"], line.pop("values", [])))
            sides = {f"{key}_{side}": v for side in ("a", "b") for key, v in line.pop(side).items()}
            lines.append({**values, **sides, **line})
        table = pandas.DataFrame(lines)
        if len(lines):
            table.loc[len(lines) - 1, ["cell_a", "cell_b"]] = pandas.NA
        table.attrs = {"environments": found["environments"], "a": a, "b": b, "column": column or "wall_s"}
        return table

    def _warn(self, fault: Any, results: Path) -> None:
        text = taken(fault[0])
        if text:
            warnings.warn(f"{self._folder(results)}: {text}; see cuvette study verify", stacklevel=3)

    @described("cuvette_study_plot")
    def plot(
        self,
        output: Optional[Path] = None,
        *,
        results: Path = "results",
        x: Optional[str] = None,
        y: Optional[str] = None,
        by: Optional[str] = None,
        where: Sequence[str] = (),
        log: Optional[str] = None,
        published: Optional[Path] = None,
        images: bool = False,
    ) -> Figure:
        """The figure; output is its file, .png, .svg or .pdf (default: figure.png next to the rows)."""
        path = (
            os.fspath(output)
            if output
            else os.path.join(self._folder(results), "sheet.png" if images else "figure.png")
        )
        base, ending = os.path.splitext(path)
        given = sized("plot")
        kept = {
            "results": _or_null(results),
            "x": _or_null(x),
            "y": _or_null(y),
            "by": _or_null(by),
            "log": _or_null(log),
            "published": _or_null(published),
        }
        for name, text in kept.items():
            setattr(given, name, text)
        texts = [ffi.new("char[]", encoded(one)) for one in where]
        pointers = ffi.new("const char *[]", texts)
        given.where, given.where_count, given.images = pointers, len(texts), images
        call(lib.cuvette_study_plot, self._study, given, encoded(base), encoded(ending[1:]))
        return Figure(path)

    def __repr__(self) -> str:
        return f"<cuvette.Study {self.name}: {self.title}, {len(self)} cells>"

    def _repr_html_(self) -> str:
        cells = [self.values(i) for i in range(min(len(self), 200))]
        titles = list(cells[0]) if cells else []
        body = [[i, *(one[t] for t in titles)] for i, one in enumerate(cells)]
        return f"<p>{self.name}: {self.title}</p>{html_table(['cell', *titles], body)}"


@described("cuvette_study_read")
def study(path: Path) -> Study:
    """`cuvette.study("experiments/depth.study").run()`"""
    return Study(path)
