"""Studies: running, resuming, stopping; rows, summaries, comparisons and figures as tables."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

import cuvette
import pandas
import pytest
from conftest import ROOT

pytestmark = pytest.mark.filterwarnings("ignore:.*other processes use")

TEXT = f"""study: tiny
title: A tiny study
scene: {ROOT}/experiments/scenes/rod.yaml
set: {{render.width: 40, render.height: 30}}
grid:
  - render.depth: [0, 2, 4]
repetitions: 6
"""


@pytest.fixture
def study(tmp_path):
    (tmp_path / "tiny.study").write_text(TEXT)
    return cuvette.study(tmp_path / "tiny.study")


def test_run_to_rows(study, tmp_path, program):
    results = tmp_path / "results"
    fractions = []
    study.run(results, progress=fractions.append)
    assert fractions == sorted(fractions) and all(0 <= s <= 1 for s in fractions)
    state = study.state(results)
    assert (state["cells"], state["cells_done"], state["rows"], state["fault"]) == (3, 3, 18, "")
    rows = study.rows(results)
    assert len(rows) == 18 and list(rows["render.depth"].unique()) != [] and set(rows["render.depth"]) == {0, 2, 4}
    assert rows.attrs["units"]["wall_s"] == "s" and rows.attrs["units"]["first_hits.rod"] == "rays"
    assert list(rows.attrs["environments"]) == [state["environment"]] == list(rows["environment"].unique())
    assert rows["film_hash"].str.len().eq(16).all() and rows["cycles"].dtype.kind in "fi"
    for cell in range(3):
        hashes = rows[rows["cell"] == cell]["film_hash"].unique()
        assert list(hashes) == [study.scene(cell).render().hash]
        assert study.values(cell) == {"render.depth": str([0, 2, 4][cell])}
    summary = study.summary(results)
    medians = rows.groupby("render.depth")["wall_s"].median()
    assert list(summary["wall_s_median"]) == pytest.approx(list(medians)) and list(summary["n"]) == [6, 6, 6]
    own = program("study", "summary", "--results", str(results), str(tmp_path / "tiny.study")).splitlines()
    assert len(own) == 4 and own[0].split("\t") == list(summary.columns)
    before = len(study.rows(results, raw=True))
    study.run(results)
    assert len(study.rows(results, raw=True)) == before


def test_compare_and_plot(study, tmp_path):
    results = tmp_path / "results"
    study.run(results)
    found = study.compare("render.depth=0", "render.depth=4", results=results)
    assert len(found) == 2 and found["ratio"].iloc[0] > 0 and "verdict" in found
    rays = study.compare("render.depth=0", "render.depth=4", "rays_total", results)
    totals = [study.scene(cell).render().counts.total for cell in (0, 2)]
    assert rays["ratio"].iloc[0] == pytest.approx(totals[1] / totals[0])  # exact, unlike times
    assert found["reason"].iloc[0] != ""  # one process: no verdict without a reason
    with pytest.raises(cuvette.InputError, match="render.depth"):
        study.compare("render.depth=0", "render.depth=3", results=results)
    if not shutil.which("gnuplot"):
        pytest.skip("gnuplot is not installed")
    figure = study.plot(results=results, y="wall_s")
    assert figure._repr_png_().startswith(b"\x89PNG") and os.path.exists(results / "tiny/figure.gp")
    drawn = study.plot(tmp_path / "tiny.svg", results=results, where=["render.depth=2"])
    assert "<svg" in drawn._repr_svg_()
    with pytest.raises(cuvette.InputError, match="jpeg"):
        study.plot(tmp_path / "tiny.jpeg", results=results)


def add_environment(study, results, monkeypatch) -> str:
    """The study's rows once more, as of another machine; its key."""
    monkeypatch.setenv("CUVETTE_MACHINE", "another")
    study.run(results)
    return study.state(results)["environment"]


def test_rows_of_unlike_environments_are_not_pooled_in_silence(study, tmp_path, monkeypatch, program):
    results = tmp_path / "results"
    study.run(results)
    key = add_environment(study, results, monkeypatch)
    with pytest.raises(cuvette.InputError, match="2 environments .*18 rows.* must not be pooled"):
        cuvette.rows(results / "tiny")
    both = cuvette.rows(results / "tiny", "all")
    assert len(both) == 36 and both.groupby("environment").size().tolist() == [18, 18]
    assert len(cuvette.rows(results / "tiny", key)) == 18
    assert len(cuvette.rows(results / "tiny", "main")) == 18
    with pytest.raises(cuvette.InputError, match="no rows of the environment 'abc'"):
        cuvette.rows(results / "tiny", "abc")
    as_the_summary(study, both, results, program)


def test_excluded_and_damaged_rows(study, tmp_path, program):
    results = tmp_path / "results"
    study.run(results)
    first = study.rows(results).iloc[0]
    program(
        "study",
        "exclude",
        "--results",
        str(results),
        str(tmp_path / "tiny.study"),
        "--row",
        first["checksum"],
        "--reason",
        "a cat on the keyboard",
    )
    rows = study.rows(results)
    assert len(rows) == 17 and rows.attrs["left_out"]["excluded"] == 1 and len(study.rows(results, raw=True)) > 17
    path = results / "tiny/rows.csv"
    path.write_text(path.read_text().replace(str(rows.iloc[3]["wall_s"]), "1e-9"))
    with pytest.warns(UserWarning, match="verify"):
        rows = study.rows(results)
    assert len(rows) == 16
    as_the_summary(study, rows, results, program)


def as_the_summary(study, rows, results, program):
    """The command's summary has the number and the median of just these rows."""
    try:
        text = program("study", "summary", "--results", str(results), study.path)
    except subprocess.CalledProcessError as failed:  # of damaged rows, which it reports
        text = failed.stdout
    lines = [dict(zip(text.splitlines()[0].split("\t"), line.split("\t"))) for line in text.splitlines()[1:]]
    assert sum(int(line["n"]) for line in lines) == len(rows)
    for line in lines:
        mine = rows[(rows["cell"] == int(line["cell"])) & (rows["environment"] == line["environment"])]
        assert len(mine) == int(line["n"]) and mine["wall_s"].median() == pytest.approx(float(line["wall_s_median"]))
        assert mine["cpu_s"].max() == pytest.approx(float(line["cpu_s_max"]))


@pytest.mark.parametrize("name", ["depth", "threads", "slime-frame", "triangles", "crowding"])
def test_rows_are_those_of_the_summary(name, program):
    study = cuvette.study(next((ROOT / "experiments").rglob(f"{name}.study")))
    rows = study.rows(ROOT / "results/reference", "all")
    as_the_summary(study, rows, ROOT / "results/reference", program)
    alone = cuvette.rows(ROOT / f"results/reference/{name}", "all")
    assert alone.equals(rows) and alone.attrs["left_out"] == rows.attrs["left_out"]


def test_the_main_environment_is_that_of_the_library(study, tmp_path, monkeypatch):
    """Of environments with equal numbers of rows the last; rows of a grid that has shrunk are not the study's."""
    results = tmp_path / "results"
    study.run(results)
    key = add_environment(study, results, monkeypatch)
    main = study.rows(results, "main")
    assert set(main["environment"]) == {key} == set(study.summary(results, "main")["environment"])
    (tmp_path / "tiny.study").write_text(TEXT.replace("[0, 2, 4]", "[4, 0]"))
    smaller = cuvette.study(tmp_path / "tiny.study")
    assert set(smaller.rows(results, "main")["render.depth"]) == {0, 4} and len(smaller.rows(results, "main")) == 12
    assert len(cuvette.rows(results / "tiny", "main")) == 18


def test_the_committed_run():
    rows = cuvette.rows(ROOT / "results/reference/depth")
    assert len(rows) == 108 and rows.attrs["left_out"]["warm-ups"] == 27
    assert all(rows.attrs["meanings"][name] for name in rows.columns if name != "environment")
    assert isinstance(rows, pandas.DataFrame) and rows["rays_camera"].eq(480000).all()


def test_ctrl_c_stops_a_study_and_the_next_run_resumes(tmp_path):
    (tmp_path / "long.study").write_text(
        TEXT.replace("tiny", "long")
        .replace("40", "800")
        .replace("30}", "600}")
        .replace("[0, 2, 4]", "[8, 9, 10, 11, 12]")
        .replace("repetitions: 6", "repetitions: 100000")
    )
    code = f"""
import cuvette
study = cuvette.study({str(tmp_path / 'long.study')!r})
try:
    study.run({str(tmp_path / 'results')!r})
except KeyboardInterrupt:
    print("stopped", study.state({str(tmp_path / 'results')!r})["rows"])
"""
    child = subprocess.Popen([sys.executable, "-W", "ignore", "-c", code], stdout=subprocess.PIPE, text=True)
    rows = tmp_path / "results" / "long" / "rows.csv"
    while child.poll() is None and (not rows.exists() or len(rows.read_text().splitlines()) < 3):
        time.sleep(0.05)
    child.send_signal(signal.SIGINT)
    assert child.stdout.read().startswith("stopped ") and child.wait() == 0


def test_processes(tmp_path):
    (tmp_path / "many.study").write_text(TEXT.replace("tiny", "many") + "processes: 3\n")
    study = cuvette.study(tmp_path / "many.study").run(tmp_path / "results", progress=False)
    rows = study.rows(tmp_path / "results")
    assert rows["run"].nunique() == 3 and study.state(tmp_path / "results")["cells_done"] == 3


def test_errors(tmp_path):
    (tmp_path / "bad.study").write_text(TEXT.replace("repetitions", "repetitoins"))
    with pytest.raises(cuvette.InputError) as caught:
        cuvette.study(tmp_path / "bad.study")
    assert caught.value.line == 7 and "repetitions" in caught.value.remedy
    with pytest.raises(cuvette.InputError, match="there are no rows"):
        cuvette.rows(tmp_path)
    (tmp_path / "tiny.study").write_text(TEXT)
    study = cuvette.study(tmp_path / "tiny.study")
    with pytest.raises(cuvette.InputError, match="3 cells, but no cell 3"):
        study.scene(3)
    assert "render.depth" in study._repr_html_() and len(study) == 3


def test_columns_are_the_dictionarys():
    text = (ROOT / "results/README.md").read_text()
    for name, (unit, meaning) in cuvette.columns().items():
        assert f"| `{name}` | {unit} |" in text and meaning.split(";")[0][:30] in text
