"""Scenes and renders: values, film hashes, arrays, counts, progress, Ctrl-C, threads, forks."""

import json
import math
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading

import cuvette
import numpy
import pytest
from conftest import ROD, ROOT, compute


def test_film_equals_the_programs(rod, program, tmp_path):
    image = rod.render({"liquid.ior": 1.4}, depth=8)
    sets = [
        part
        for text in ("liquid.ior=1.4", "render.depth=8", "render.width=80", "render.height=60")
        for part in ("--set", text)
    ]
    account = json.loads(program("render", ROD, *sets, "--json", "-o", str(tmp_path / "rod.png")))
    assert image.hash == account["film_hash"]
    assert image.counts.total == account["rays"]["total"]
    image.save(tmp_path / "own.png")
    assert "identical" in program("compare", str(tmp_path / "rod.png"), str(tmp_path / "own.png"))


def test_a_png_carries_its_scene(rod, program, tmp_path):
    path = str(tmp_path / "rod.png")
    image = rod.render({"liquid.ior": 1.4}, depth=5, threads=2)
    rod["liquid.ior"] = 1.9  # the file has the scene as it was rendered
    image.save(path)
    again = cuvette.read(path)
    assert again["liquid.ior"] == 1.4 and again["render.threads"] == 1 and again.render().hash == image.hash
    assert json.loads(program("render", path, "--json"))["film_hash"] == image.hash
    image.save(tmp_path / "deep.png", bits=16)
    assert cuvette.read(tmp_path / "deep.png").render().hash == image.hash
    rod.add_pixels("pattern", numpy.ones((2, 2, 3)))
    rod.render().save(path)
    with pytest.raises(cuvette.InputError, match="holds no scene"):
        cuvette.read(path)


def test_values_have_their_types(rod):
    rod["liquid.ior"] = 1.4
    rod["rod.visible"] = False
    rod["camera.position"] = numpy.array([0, 2.75, -7.5])
    rod["render.threads"] = "auto"
    assert rod["liquid.ior"] == 1.4 and isinstance(rod["render.depth"], int)
    assert rod["rod.visible"] is False and rod["render.threads"] == "auto"
    assert rod["camera.position"] == (0.0, 2.75, -7.5) and rod["render.integrator"] == "whitted"
    assert "liquid.ior" in rod and "liquid.iro" not in rod
    rod["render.depth"] = numpy.int64(7)
    assert rod["render.depth"] == 7


def test_settings_of_a_render_are_its_own(rod):
    before = str(rod)
    one, other = rod.render(depth=1), rod.render(depth=2)
    assert str(rod) == before and one.hash != other.hash
    assert len(one.counts.by_depth) == 2 and len(other.counts.by_depth) == 3


def test_set_is_all_or_nothing(rod):
    before = str(rod)
    with pytest.raises(cuvette.InputError):
        rod.set({"liquid.ior": 1.5, "liquid.iro": 2})
    assert str(rod) == before


def test_arrays_are_the_film(rod, tmp_path):
    image = rod.render()
    assert image.array.shape == image.srgb.shape == (60, 80, 3)
    assert image.array.dtype == numpy.float32 and image.srgb.dtype == numpy.uint8
    assert image.array is image.array and numpy.asarray(image) is image.array
    with pytest.raises(ValueError):
        image.array[0, 0] = 0
    image.save(tmp_path / "rod.pfm")
    data = (tmp_path / "rod.pfm").read_bytes()
    numbers = numpy.frombuffer(data[-60 * 80 * 12 :], "<f4").reshape(60, 80, 3)[::-1]
    assert numpy.array_equal(numbers, image.array)
    linear = numpy.clip(image.array.astype(float), 0, 1)
    encoded = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert numpy.abs(encoded * 255 - image.srgb).max() <= 0.5 + 1e-3


def test_counts_are_complete(rod):
    counts = rod.render(depth=3).counts
    assert counts.camera == 80 * 60 == counts.by_depth[0]
    assert sum(counts.by_depth) == counts.camera + counts.reflect + counts.refract
    image = rod.render()
    assert image.solid_counts("rod").first_hits == image.solid_counts(3).first_hits > 0
    with pytest.raises(KeyError, match="it has ground, vessel, liquid, rod"):
        image.solid_counts("stick")


def test_a_scene_of_calls():
    scene = cuvette.Scene()
    scene.add_light("lamp", position=(4, 7, -5))
    scene.add_material("glass", transparency=1, ior=1.5)
    scene.add_solid("ball", "sphere", "glass", position=(0, 1, 0), radius=0.8)
    with pytest.raises(cuvette.InputError):
        scene.add_solid("box", "box", colour=(1, 0, 0))
    assert scene.solids == ("ball",) and scene.lights == ("lamp",) and scene.materials == ("glass",)
    scene.set(width=16, height=12)
    again = cuvette.parse(str(scene))
    assert again.render().hash == scene.render().hash
    scene.add_triangles("sheet", [[-1, 0, 2], [1, 0, 2], [0, 2, 2]], [[0, 1, 2]])
    scene.add_solid("shown", "mesh", mesh="sheet")
    assert scene.render().hash != again.render().hash
    with pytest.raises(cuvette.InputError, match="n x 3"):
        scene.add_triangles("wrong", [[0, 0]], [[0, 0, 0]])


def test_parameters_and_display(rod):
    rod["liquid.ior"] = 1.4
    named = {p.path: p for p in rod.parameters}
    assert named["liquid.ior"].value == "1.4" and named["camera.fov_deg"].unit == "deg"
    assert "liquid.ior" in rod._repr_html_() and "render.tile" not in rod._repr_html_()
    changed = {p.path for p in rod.changes}
    assert "tiles.diffuse" in changed and "ground.diffuse" not in changed and "vessel.transparency" not in changed
    rod["ground.diffuse"] = 0.3
    assert "ground.diffuse" in {p.path for p in rod.changes}
    assert "render.tile" in rod.parameters._repr_html_()
    assert rod.render()._repr_png_().startswith(b"\x89PNG")
    assert "render.depth" in cuvette.Scene.set.__doc__ and "YAML" in cuvette.read.__doc__
    assert rod.hints == [] or all("; " in hint for hint in rod.hints)


def test_progress(rod, capsys):
    fractions = []
    rod.render(progress=fractions.append)
    assert fractions[0] == 0 and fractions[-1] == 1 and fractions == sorted(fractions)
    rod.render()
    assert capsys.readouterr().err == ""  # no terminal: nothing is shown
    rod.render(progress=True)
    assert "render [" in capsys.readouterr().err
    with pytest.raises(cuvette.Cancelled) as caught:
        rod.render(progress=lambda fraction: False)
    assert caught.value.image is None
    with pytest.raises(cuvette.Cancelled) as caught:
        rod.render(progress=lambda fraction: fraction == 0, width=1600, height=1200, samples=16)
    assert 0 < caught.value.image.counts.camera < 1600 * 1200 * 16
    with pytest.raises(ZeroDivisionError):
        rod.render(progress=lambda fraction: 1 / 0)
    assert rod.render().hash == rod.render(progress=False).hash


def test_ctrl_c_stops_a_render():
    code = f"""
import cuvette, sys
scene = cuvette.read({ROD!r})
try:
    print("begins", flush=True)
    scene.render(samples=64, width=3000, height=3000, depth=40)
except KeyboardInterrupt:
    print("stopped", scene.render(width=8, height=6).hash)
"""
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    assert child.stdout.readline() == "begins\n"
    compute(child, 0.3)
    child.send_signal(signal.SIGINT)
    assert child.stdout.read().startswith("stopped ") and child.wait() == 0


def test_other_threads_run_meanwhile(rod):
    """Renders of one scene in several threads at the same time, each with an engine of its own."""
    expected, found = rod.render().hash, []
    threads = [threading.Thread(target=lambda: found.append(rod.render().hash)) for _ in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert found == [expected] * 4


def test_a_child_process_renders_too(rod):
    expected = rod.render(threads=2).hash
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        os.write(write_end, rod.render(threads=2).hash.encode())
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(read_end, 16).decode() == expected


def test_errors_have_a_place_and_a_remedy(tmp_path):
    (tmp_path / "bad.yaml").write_text("render:\n  width: 80\n  hieght: 60\n")
    with pytest.raises(cuvette.Error) as caught:
        cuvette.read(tmp_path / "bad.yaml")
    error = caught.value
    assert (error.line, error.column) == (3, 3) and error.file.endswith("bad.yaml")
    assert "hieght" in error.what and "height" in error.remedy and isinstance(error, ValueError)
    assert str(error) == f"{error.file}:3:3: {error.what}; {error.remedy}"
    with pytest.raises(cuvette.InputError, match="absent.yaml"):
        cuvette.read("absent.yaml")
    with pytest.raises(cuvette.InputError, match="character 0"):
        cuvette.Scene()["render.depth"] = "1\0"
    with pytest.raises(cuvette.InputError):
        cuvette.Scene()["render.depth"] = {"a": 1}
    with pytest.raises(cuvette.InputError):
        cuvette.Scene().render(depth=math.nan)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.line) == (str(error), 3)


def test_many_small_renders_need_no_more_memory(rod):
    """RENDERS=10000 for the full number."""
    rod.set(width=8, height=6)

    def resident_kib() -> int:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") // 1024

    def renders(count: int) -> None:
        for i in range(count):
            image = rod.render(depth=i % 5)
            assert image.array.shape == (6, 8, 3) and image.counts.camera == 48

    renders(200)
    before = resident_kib()
    renders(int(os.environ.get("RENDERS", "1000")))
    assert resident_kib() - before < 1024


def render_hash(scene: cuvette.Scene) -> str:
    return scene.render().hash


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_a_pool_of_processes(rod, method):
    expected = [rod.render(depth=d).hash for d in (1, 2, 3)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map(render_hash, [rod.copy().set(depth=d) for d in (1, 2, 3)]) == expected


def test_a_scene_in_use_cannot_be_changed(rod):
    errors = []

    def change(fraction: float) -> None:
        with pytest.raises(cuvette.BusyError) as caught:
            rod["render.depth"] = 2
        errors.append(caught.value.remedy)

    rod.render(progress=change)
    assert errors and all(errors)
    rod["render.depth"] = 2


def test_names_are_offered_and_corrected(rod):
    assert "liquid.ior" in rod._ipython_key_completions_()
    assert rod.parameters["liquid.ior"].meaning.startswith("refractive index")
    with pytest.raises(KeyError, match="did you mean 'liquid.ior'"):
        rod.parameters["liquid.iro"]
    with pytest.raises(cuvette.InputError, match="did you mean 'render.depth'"):
        rod.render(dept=8)


def test_data_come_from_arrays(rod):
    rod.add_values("dye", [400, 700], numpy.array([3.0, 3.0]))
    assert rod.data == ("dye",)
    rod["liquid.absorb_data"] = "dye"
    dyed = rod.render(depth=3).array
    rod["liquid.absorb_data"] = ""
    assert numpy.array_equal(dyed, rod.render({"liquid.absorb_per_m": (3, 3, 3)}, depth=3).array)
    with pytest.raises(cuvette.InputError, match="shapes"):
        rod.add_values("wrong", [400, 700], [1.0])
    with pytest.raises(cuvette.InputError, match="dye2: it has 400 nm after 700 nm"):
        rod.add_values("dye2", [700, 400], [1.0, 2.0])
    with pytest.raises(cuvette.InputError):
        rod.add_data("crown", file="nowhere.yml", scale="none")
    assert rod.data == ("dye",)
