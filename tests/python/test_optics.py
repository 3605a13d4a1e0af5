"""Optics against theory, comparison of images, layers and maps."""

import json
import math
import sys

import cuvette
import numpy
import pytest
from conftest import ROD


def test_realism_equals_the_programs(program):
    scene = cuvette.read(ROD)
    own = scene.realism()
    other = json.loads(program("realism", ROD, "--json"))["values"]
    assert [m.name for m in own] == [m["metric"] for m in other]
    assert [m.measured for m in own if m.verdict == "pass"] == [
        m["measured"] for m in other if m["measured"] is not None
    ]
    assert not own.failures and own["lens.power"].unit == "1/scene unit" and "lens.power" in own._repr_html_()
    assert list(own.table()["name"]) == [m.name for m in own]
    with pytest.raises(KeyError, match="did you mean 'lens.power'"):
        own["lens.powre"]
    with pytest.raises(cuvette.InputError):
        cuvette.Scene().realism()


def test_lens_report_equals_the_programs(program, tmp_path):
    path = tmp_path / "triplet.yaml"
    program("lens", ROD.replace("scenes/rod.yaml", "lenses/cooke-triplet.csv"), "-o", str(path))
    own = cuvette.read(path).lens_report()
    other = json.loads(program("lens", "report", str(path), "--json"))["sections"]
    assert set(own) == set(other)
    assert own["first-order"]["efl"] == [other["first-order"]["values"]["efl"]]
    for section in ("fan-tangential", "seidel", "spot", "mtf-diffraction", "wavefront"):
        for name, column in other[section]["values"].items():
            theirs = numpy.array([numpy.nan if v is None else v for v in column])
            assert numpy.array_equal(own[section][name], theirs, equal_nan=True), (section, name)
    with pytest.raises(cuvette.InputError, match="no lens"):
        cuvette.read(path).lens_report("telescope")
    with pytest.raises(cuvette.InputError):
        cuvette.read(ROD).lens_report()


def test_curves(program):
    scene = cuvette.read(ROD)
    curve = scene.curve("fresnel-s")
    lines = program("realism", ROD, "--curve", "fresnel-s").splitlines()
    numbers = [[float(v) for v in line.split(",")] for line in lines if line[0].isdigit()]
    assert numpy.array_equal(numpy.column_stack([curve.x, curve.measured, curve.theory]), numbers)
    cos_in = numpy.cos(numpy.radians(curve.x))
    root = numpy.sqrt(1.5**2 - 1 + cos_in**2)
    assert numpy.allclose(curve.measured, ((cos_in - root) / (cos_in + root)) ** 2, atol=1e-12)
    assert "angle" in curve.x_label and "rainbow" not in scene.curves
    with pytest.raises(cuvette.InputError, match="no curve 'snell'; use one of: .*fresnel-s"):
        scene.curve("snell")
    with pytest.raises(cuvette.InputError):
        scene.curve("rainbow")


def test_a_curve_is_drawn():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = cuvette.read(ROD).curve("fresnel").plot()
    assert len(axes.lines) == 2 and axes.get_xlabel().startswith("angle")


def test_comparison_equals_the_programs(rod, program, tmp_path):
    one, other = rod.render(depth=2), rod.render(depth=8)
    one.save(tmp_path / "a.png")
    other.save(tmp_path / "b.png")
    files = [str(tmp_path / name) for name in ("a.png", "b.png")]
    printed = json.loads(program("compare", *files, "--json"))
    found = cuvette.compare(*files, map=True)
    assert (found.mse, found.ssim, found.flip) == (printed["mse"], printed["ssim"], printed["flip"])
    assert found.map.shape == (60, 80, 3) and found.map.max() > 0
    near = cuvette.compare(one, other)
    assert near.flip == pytest.approx(found.flip, rel=0.05) and near.map is None
    same = cuvette.compare(one, one.array)
    assert same.mse == 0 and math.isinf(same.psnr_db)
    with pytest.raises(cuvette.InputError, match="80 x 60, the other 40 x 30"):
        cuvette.compare(one, rod.render(width=40, height=30))
    with pytest.raises(cuvette.InputError, match="absent.png"):
        cuvette.compare(one, "absent.png")


def test_images_of_files(rod, tmp_path):
    image = rod.render()
    image.save(tmp_path / "rod.pfm")
    assert numpy.array_equal(cuvette.read_image(tmp_path / "rod.pfm"), image.array)
    image.save(tmp_path / "rod.png", bits=16)
    assert numpy.abs(cuvette.read_image(tmp_path / "rod.png") - numpy.clip(image.array, 0, 1)).max() < 1e-4


def test_layers_equal_the_rays(rod):
    image = rod.render(layers=True)
    query = rod.query()
    depth, normal, solid = image.layer("depth"), image.layer("normal"), image.layer("solid")
    assert depth.shape == (60, 80) and normal.shape == (60, 80, 3) and not depth.flags.owndata
    origin, direction = query.camera_ray(40.5, 30.5)
    hit = query.nearest(origin, direction)[0]
    assert depth[30, 40] == numpy.float32(hit["distance"]) and numpy.allclose(normal[30, 40], hit["normal"], atol=1e-6)
    assert len(numpy.unique(solid)) >= 3
    with pytest.raises(cuvette.InputError, match="no layer 'colour'"):
        image.layer("colour")
    with pytest.raises(cuvette.InputError, match="aov"):
        rod.render().layer("depth")
    kept = rod.render(layers=True).layer("albedo")
    assert kept.sum() > 0  # its frame is gone, its memory is not


def test_maps(rod):
    image = rod.render(maps=True, depth=3)
    assert image.map("rays").sum() == image.counts.total and (image.map("time") > 0).all()
    assert 0 < image.map("cut").mean() < 1
    with pytest.raises(cuvette.InputError, match="pixel_rays"):
        rod.render().map("rays")
    with pytest.raises(cuvette.InputError, match="render.paths"):
        image.map("noise")
    noisy = rod.render(integrator="path", paths=16)
    assert noisy.map("noise").mean() > 0
    assert math.sqrt((noisy.map("noise") ** 2).mean()) == pytest.approx(noisy.noise_rms)


@pytest.mark.parametrize(
    "use, package",
    [("scene.curve('fresnel').plot()", "matplotlib"), ("scene.realism().table()", "pandas")],
)
def test_a_missing_package_is_named(use, package, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)
    scene = cuvette.read(ROD)  # named in use
    with pytest.raises(ModuleNotFoundError, match=f"sudo apt install python3-{package}$"):
        eval(use, {"scene": scene})


def test_errors_have_the_name_to_catch():
    with pytest.raises(cuvette.InputError) as caught:
        cuvette.read("rod.yaml")
    assert f"{caught.type.__module__}.{caught.type.__qualname__}" == "cuvette.InputError"
    assert caught.value.remedy.startswith("use /") and "experiments/scenes/rod.yaml" in caught.value.remedy
