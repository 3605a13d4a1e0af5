"""Ray trees, fans and queries: the film's values, Snell's law, the program's output."""

import csv
import json
import math
import threading

import cuvette
import numpy
import pytest
from conftest import ROD, ROOT


def test_a_trees_radiance_is_the_pixels(rod):
    image = rod.render(depth=5)
    query = rod.query(depth=5)
    for x, y in ((40, 30), (20, 45), (60, 10), (39, 27)):
        tree = query.trace((x, y))
        assert numpy.array_equal(numpy.float32(tree.radiance), image.array[y, x])
        assert tree.radiance == pytest.approx(tuple(sum(n.added[k] for n in tree) for k in range(3)), abs=1e-12)


def test_nodes_obey_snell_and_fresnel(rod):
    hits = [n.hit for n in rod.trace((40, 30), depth=6) if n.hit and not n.hit.opaque]
    assert len(hits) > 5
    for hit in hits:
        sin_in = math.sqrt(1 - hit.cos_in**2)
        if hit.total_internal:
            assert hit.n_before * sin_in > hit.n_after and hit.R == 1 and hit.angle_out_deg is None
            continue
        assert hit.n_before * sin_in == pytest.approx(hit.n_after * math.sqrt(1 - hit.cos_out**2), abs=1e-9)
        r_s = (hit.n_before * hit.cos_in - hit.n_after * hit.cos_out) / (
            hit.n_before * hit.cos_in + hit.n_after * hit.cos_out
        )
        assert hit.R_s == pytest.approx(r_s**2, abs=1e-12) and hit.R + hit.T == pytest.approx(1)


def test_a_tree_is_navigable(rod):
    tree = rod.trace((40, 30), depth=3)
    first = tree[0]
    assert first.kind == "camera" and first.parent is None and first.medium_name == "air"
    assert all(child.parent.index == 0 for child in first.children) and len(first.children) >= 2
    assert tree[-1].index == len(tree) - 1 and len(list(tree)) == len(tree)
    assert set(n.end for n in tree) <= set(cuvette.rays.ENDS)
    with pytest.raises(IndexError):
        tree[len(tree)]
    with pytest.raises(AttributeError, match="medium_name"):
        first.medium_nam
    assert "vessel" in first.hit._repr_html_() and "distance" in dir(first.hit)


def test_arrays_are_views_that_outlive_their_tree(rod):
    tree = rod.trace((40, 30))
    expected = [n.hit.R for n in tree if n.hit]
    array = tree.array
    assert not array.flags.owndata and not array.flags.writeable
    del tree
    cuvette.read(ROD).trace((1, 1))
    assert list(array["R"][array["end"] == 0]) == expected


def test_tree_equals_the_programs(rod, program, tmp_path):
    sets = ["--set", "render.width=80", "--set", "render.height=60"]
    rod.trace((40, 30)).save(tmp_path / "own.json")
    own = json.loads((tmp_path / "own.json").read_text())
    other = json.loads(program("trace", ROD, "--pixel", "40,30", *sets, "--json"))
    assert own["radiance"] == other["radiance"] and own["root"] == other["root"]
    assert str(rod.trace((40, 30))) == program("trace", ROD, "--pixel", "40,30", *sets)
    assert rod.trace((40, 30))._repr_svg_().startswith("<svg")
    with pytest.raises(cuvette.InputError, match="use .txt, .json, .csv or .svg"):
        rod.trace((40, 30)).save(tmp_path / "tree.png")


def same_tree(tree, text, tmp_path):
    tree.save(tmp_path / "own.json")
    own, other = json.loads((tmp_path / "own.json").read_text()), json.loads(text)
    return own["radiance"] == other["radiance"] and own["root"] == other["root"] and own["lambda_nm"]


def test_one_wavelength_equals_the_programs(program, tmp_path):
    """Of a ball that absorbs by wavelength, in which the three channels differ otherwise."""
    text = """
    render: {width: 40, height: 30}
    camera: {position: [0, 0, -6], target: [0, 0, 0]}
    lights: {lamp: {position: [3, 5, -5]}}
    solids:
      ball: {shape: sphere, position: [0, 0, 0], radius: 1, transparency: 1, medium: water,
             absorb_spectrum: [400, 0.1, 700, 0.7]}
    """
    path = tmp_path / "ball.yaml"
    path.write_text(text)
    scene = cuvette.read(path)
    tree = scene.trace((20, 15), wavelength_nm=650)
    assert same_tree(tree, program("trace", str(path), "--pixel", "20,15", "--lambda", "650", "--json"), tmp_path)
    inside = [n.hit.transmittance for n in tree if n.hit and n.medium_name != "air"]
    assert inside and all(len(set(one)) == 1 for one in inside)
    otherwise = [n.hit.transmittance for n in scene.trace((20, 15)) if n.hit and n.medium_name != "air"]
    assert all(len(set(one)) == 3 for one in otherwise)
    query = scene.query(wavelength_nm=450)
    assert query.trace((20, 15))[0].hit.n_after > tree[0].hit.n_after  # normal dispersion
    assert str(query.trace((20, 15))) == program("trace", str(path), "--pixel", "20,15", "--lambda", "450")
    program("fan", str(path), *"--from 0,0,-6 --to 0,0,0 --lambda 450 -o".split(), str(tmp_path / "fan.csv"))
    query.fan((0, 0, -6), (0, 0, 0)).save(tmp_path / "own.csv")
    assert (tmp_path / "own.csv").read_text() == (tmp_path / "fan.csv").read_text()
    with pytest.raises(cuvette.InputError, match="render.lambda_nm"):
        scene.query(wavelength_nm=10)
    with pytest.raises(cuvette.InputError, match="scene.query"):
        query.trace((20, 15), depth=2)


def test_beams_equal_the_programs(program):
    path = str(ROOT / "experiments/scenes/lens.yaml")
    rays = cuvette.read(path).beams(sun__white=True, sun__field_rows=2)
    settings = "--set sun.white=on --set sun.field_rows=2".split()
    beams = json.loads(program("trace", path, "--beams", "--json", *settings))["beams"]
    other = [(one["name"], ray) for one in beams for ray in one["rays"]]
    assert len(rays) == len(other) > 1 and len({ray.lambda_nm for ray in rays}) > 1
    for own, (name, ray) in zip(rays, other):
        assert (own.beam, own.lambda_nm, own.power, own.field) == (name, ray["lambda_nm"], ray["power"], ray["field"])
        assert (own.number, list(own.tree[0].hit.point)) == (ray["number"], ray["root"]["hit"]["point"])
        assert own.tree[0].hit.R == ray["root"]["hit"]["R"] and own.tree[1].n == ray["root"]["children"][0]["n"]
    assert {ray.field for ray in rays} == {0, 1}
    del rays[1:]
    assert rays[0].tree[0].kind == "camera" and rays[0].tree[0].medium_name == "air"  # its query is gone
    assert cuvette.Scene().beams() == []


def test_wrong_rays(rod):
    with pytest.raises(cuvette.InputError, match="outside the image"):
        rod.trace((80, 0))
    with pytest.raises(cuvette.InputError):
        rod.trace((1, 2), origin=(0, 0, 0))
    with pytest.raises(cuvette.InputError):
        rod.trace(origin=(0, 0, 0), direction=(0, 0, 0))
    with pytest.raises(cuvette.InputError, match="1 to 100000"):
        rod.fan((-3, 1.5, 0), (3, 1.5, 0), rays=0)
    with pytest.raises(cuvette.InputError, match="0 to 179"):
        rod.fan((-3, 1.5, 0), (3, 1.5, 0), spread_deg=200)


def test_fan_equals_the_programs(rod, program, tmp_path):
    fan = rod.fan((-3, 1.5, 0), (3, 1.5, 0), rays=21, width=1.6, rod__visible=False)
    program(
        "fan",
        ROD,
        "--from",
        "-3,1.5,0",
        "--to",
        "3,1.5,0",
        "--width",
        "1.6",
        "--rays",
        "21",
        "--set",
        "rod.visible=off",
        "-o",
        str(tmp_path / "fan.csv"),
    )
    fan.save(tmp_path / "own.csv")
    assert (tmp_path / "own.csv").read_text() == (tmp_path / "fan.csv").read_text()
    with open(tmp_path / "fan.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    assert [float(line["deviation_deg"]) for line in lines] == list(fan.array["deviation_deg"])
    assert len(fan) == 21 and len(fan.caustic) == 20 and fan[10].end_name == "sky" and fan[10].leaves
    assert fan._repr_svg_().startswith("<svg")


def test_focus_of_a_ball_lens():
    """Paraxial focus of a ball of index n and radius r: n r / (2 (n - 1)) behind its centre."""
    scene = cuvette.Scene()
    scene.add_solid("ball", "sphere", position=(0, 0, 0), radius=1, transparency=1, ior=1.5)
    fan = scene.fan((-5, 0, 0), (0, 0, 0), rays=11, width=0.002)
    assert fan.focus == pytest.approx((1.5, 0, 0), abs=1e-5) and not fan.is_virtual
    assert [n.medium_name for n in fan[0].path] == ["air", "ball", "air"]
    # a hollow ball in water spreads the light: the focus is in front
    scene.set({"background.ior": 1.5, "ball.ior": 1.0})
    assert scene.fan((-5, 0, 0), (0, 0, 0), rays=11, width=0.002).is_virtual


def test_queries_of_many_rays():
    scene = cuvette.Scene()
    scene.add_solid("ball", "sphere", position=(0, 0, 0), radius=2, transparency=1, ior=1.5)
    query = scene.query()
    offsets = numpy.linspace(-3, 3, 61)
    origins = numpy.column_stack([numpy.full(61, -10.0), offsets, numpy.zeros(61)])
    hits = query.nearest(origins, (1, 0, 0))
    inside = numpy.abs(offsets) < 2
    expected = 10 - numpy.sqrt(4 - offsets[inside] ** 2)
    assert numpy.allclose(hits["distance"][inside], expected, atol=1e-12) and (hits["solid"][inside] == 0).all()
    assert numpy.isinf(hits["distance"][~inside]).all()
    assert list(query.occluded(origins, (1, 0, 0))) == list(inside)
    assert not query.occluded((-10, 0, 0), (1, 0, 0), reach=5)[0]
    assert query.medium((0, 0, 0)) == "ball" and query.medium((9, 0, 0)) is None
    with pytest.raises(cuvette.InputError, match="61 origins for 2"):
        query.nearest(origins, numpy.ones((2, 3)))
    with pytest.raises(cuvette.InputError, match="n x 3"):
        query.nearest([[1, 2]], [[1, 2]])


def test_trees_of_one_query_in_several_threads(rod):
    query, found = rod.query(depth=4), []
    expected = query.trace((40, 30)).radiance
    threads = [
        threading.Thread(target=lambda: found.extend(query.trace((40, 30)).radiance for _ in range(20)))
        for _ in range(4)
    ]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert found == [expected] * 80


def test_another_thread_cancels_a_fan(rod):
    query, raised = rod.query(), []

    def follow():
        try:
            query.fan((-3, 1.5, 0), (3, 1.5, 0), rays=100000, width=1.5)
        except cuvette.Cancelled as error:
            raised.append(error)

    thread = threading.Thread(target=follow)
    thread.start()
    while thread.is_alive():
        query.cancel()  # without effect before the fan has begun
        thread.join(0.01)
    assert len(raised) == 1
    assert len(query.fan((-3, 1.5, 0), (3, 1.5, 0), rays=5, width=1.5)) == 5
