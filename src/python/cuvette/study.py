"""Studies: running, and their rows as pandas tables with units and environments."""

import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import warnings
from typing import TYPE_CHECKING, Any, Dict, Optional, Sequence, Tuple

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
    new_handle,
    import_module,
    on_column,
    on_news,
    on_run,
    on_value,
    owned_text,
    sized,
    text_of,
    visit_each,
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
    "checksum",
)
REASONS = {"warm-up": "warm-ups", "marked": "marked", "excluded": "excluded"}


def columns() -> Dict[str, Tuple[str, str]]:
    """Unit and meaning of every column of rows.csv; <axis> or <solid> in a name stands for a column each."""
    found: Dict[str, Tuple[str, str]] = {}

    def add(one: Any) -> None:
        found[text_of(one.name)] = text_of(one.unit), text_of(one.meaning)

    visit_each(lib.cuvette_each_column, on_column, add)
    return found


def _described(name: str, known: Dict[str, Tuple[str, str]], units: Dict[str, str]) -> Tuple[str, str]:
    if name in known:
        return known[name]
    if f"{name.split('.')[0]}.<solid>" in known:
        return known[f"{name.split('.')[0]}.<solid>"]
    return units.get(name, ""), "parameter of the study's grid"


def _facts(folder: str) -> Dict[str, Dict[str, str]]:
    """The facts of each environment, by its key, from runs.json and the runs files of shards."""
    facts: Dict[str, Dict[str, str]] = {}
    for path in sorted(pathlib.Path(folder).glob("runs.*json")):
        for run in json.loads(path.read_text(encoding="utf-8"))["runs"]:
            environment = dict(run["environment"])
            facts[environment.pop("key")] = environment
    return facts


def _table(text: Optional[str], separator: str = ",") -> "pandas.DataFrame":
    pandas = import_module("pandas")
    kinds = {name: str for name in (*TEXTS, "environment", "left_out")}
    return pandas.read_csv(io.StringIO(text or ""), sep=separator, dtype=kinds, na_values=["NA"], keep_default_na=False)


def _rows(
    handle: Any, folder: str, results: str, environment: Optional[str], raw: bool, units: Dict[str, str]
) -> "pandas.DataFrame":
    out, fault = ffi.new("char **"), ffi.new("char **")
    call(lib.cuvette_study_rows, handle, encoded(results), _or_null(environment), out, fault)
    table, found = _table(owned_text(out[0])), owned_text(fault[0])
    if found:
        warnings.warn(f"{folder}: {found}; see cuvette study verify", stacklevel=3)
    reason = table.pop("left_out")
    left_out = {} if raw else {REASONS[word]: int((reason == word).sum()) for word in REASONS}
    if not raw:
        table = table[reason == ""].reset_index(drop=True)
    known = columns()
    described_columns = {name: _described(name, known, units) for name in table.columns if name != "environment"}
    table.attrs = {
        "units": {name: one[0] for name, one in described_columns.items()},
        "meanings": {name: one[1] for name, one in described_columns.items()},
        "environments": _facts(folder),
        "left_out": left_out,
    }
    return table


@described("cuvette_study_rows")
def rows(folder: Path, environment: Optional[str] = None, raw: bool = False) -> "pandas.DataFrame":
    """The rows of a study, `cuvette.rows("results/depth")`: one per repetition, without warm-ups, marked rows and those
    excluded by hand (raw=True: with them). The column environment has the key of the row's environment; rows of several
    environments need a choice: a key, "main" (the one with most rows), or "all".

    attrs of the table: "units" and "meanings" by column, "environments" with the facts of each key, "left_out" with the
    number of rows by reason."""
    place = os.fspath(folder)
    return _rows(NULL, place, place, environment, raw, {})


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
        self._study = new_handle("study", lib.cuvette_study_read, lib.cuvette_study_destroy, encoded(path))

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
        return Scene(new_handle("scene", lib.cuvette_study_scene, lib.cuvette_scene_destroy, self._study, cell))

    @described("cuvette_study_each_value")
    def values(self, cell: int) -> Dict[str, str]:
        found: Dict[str, str] = {}

        def add(path: Any, value: Any) -> None:
            found[text_of(path)] = text_of(value)

        visit_each(lib.cuvette_study_each_value, on_value, add, self._study, cell)
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
        visit = Visit(lambda fraction, left_s: bar(fraction) if bar else True)
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
            raise InputError(
                f"process {process} failed: {last[0]}", "run the study again; the rows so far are kept", self.path
            )

    def _folder(self, results: Path) -> str:
        return os.path.join(os.fspath(results), self.name)

    def rows(
        self, results: Path = "results", environment: Optional[str] = None, raw: bool = False
    ) -> "pandas.DataFrame":
        """The rows of the study, like those of cuvette.rows, with the units of the grid's parameters; warns of rows
        with a fault (`cuvette study verify`)."""
        units = {p.path: p.unit for p in self.scene(0).parameters}
        return _rows(self._study, self._folder(results), os.fspath(results), environment, raw, units)

    @described("cuvette_study_summary")
    def summary(self, results: Path = "results", environment: Optional[str] = None) -> "pandas.DataFrame":
        """One line per cell and environment, as a DataFrame."""
        out, fault = ffi.new("char **"), ffi.new("char **")
        call(lib.cuvette_study_summary, self._study, encoded(results), _or_null(environment), out, fault)
        text = owned_text(out[0])
        self._warn(fault, results)
        return _table(text, "\t")

    @described("cuvette_study_compare")
    def compare(self, a: str, b: str, column: Optional[str] = None, results: Path = "results") -> "pandas.DataFrame":
        """One line per pair of cells, and one for all cells, with NA as cell_a and cell_b; attrs has the environments
        of both sides."""
        pandas = import_module("pandas")

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
        found = json.loads(owned_text(out[0]) or "{}")
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
        text = owned_text(fault[0])
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
    """Reads a study file: `cuvette.study("experiments/depth.study").run()`"""
    return Study(path)
