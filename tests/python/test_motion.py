"""Slimes: stopped and continued as in one go, grabbed by hands."""

import os
import signal
import subprocess
import sys

import cuvette
import pytest
from conftest import ROOT, compute

SLIME = str(ROOT / "experiments/scenes/slime.yaml")


@pytest.fixture
def scene():
    return cuvette.read(SLIME).set(width=40, height=30)


def test_advance_equals_a_scene_at_that_time(scene):
    motion = scene.motion()
    name = motion.names[0]
    motion.advance(0.05)
    state = motion.state(name)
    assert state.time_s == pytest.approx(0.05, abs=0.01) and state.steps > 0 and state.low < state.high
    at_rest = cuvette.read(SLIME).set({f"{name}.time_s": 0.05}, width=40, height=30)
    assert scene.render().hash == at_rest.render().hash
    with pytest.raises(cuvette.InputError):
        motion.advance(0.01)


def test_an_advance_is_stopped_and_continues(scene):
    motion, fractions = scene.motion(), []
    before = scene.render().hash

    def stop(fraction):
        fractions.append(fraction)
        return len(fractions) < 2

    with pytest.raises(cuvette.Cancelled):
        motion.advance(3, progress=stop)
    reached = motion.time_s
    assert 0 < reached < 3 and len(fractions) == 2 and scene.render().hash == before
    motion.advance(reached + 0.05)
    other = cuvette.read(SLIME).set(width=40, height=30)
    other.motion().advance(reached + 0.05)
    assert scene.render().hash == other.render().hash != before


CALLS = {
    "render": "scene.render()",
    "trace": "scene.trace((1, 1))",
    "load": "scene.load()",
    "realism": "scene.realism()",
    "motion": "motion.advance(3000)",
}


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_stops_a_slime(call):
    code = f"""
import cuvette, os, time
scene = cuvette.read({SLIME!r}).set(width=8, height=6)
if {call!r} == "motion":
    motion = scene.motion()
else:
    scene[f"{{scene.meshes[0]}}.time_s"] = 3000
try:
    print("begins", flush=True)
    {CALLS[call]}
except KeyboardInterrupt:
    print("stopped", time.process_time(), flush=True)
"""
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begins\n"
    began = compute(child, 0.5)
    child.send_signal(signal.SIGINT)
    word, at = child.stdout.read().split()
    assert word == "stopped" and child.wait() == 0 and float(at) - began < 2  # of CPU time


def test_stopped_slimes_leave_no_memory(scene):
    scene["toy.time_s"] = 3000

    def resident_kib() -> int:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") // 1024

    def stops(count: int) -> None:
        for _ in range(count):
            try:
                scene.load(progress=lambda fraction: False)
            except cuvette.Cancelled:
                continue
            raise AssertionError("not stopped")

    stops(20)
    before = resident_kib()
    stops(100)
    assert resident_kib() - before < 1024


def test_a_grabbed_slime_is_not_written_into_the_image(tmp_path):
    scene = cuvette.Scene().set(width=40, height=30)
    scene.add_light("lamp", position=(3, 5, -5))
    scene.add_mesh("toy", generate="slime", level=2)
    scene.add_solid("body", "mesh", mesh="toy", position=(0, 0, 0))
    path, motion = tmp_path / "slime.png", scene.motion()
    motion.advance(0.05)
    image = scene.render()
    image.save(path)
    assert cuvette.read(path).render().hash == image.hash
    with motion.grab("body", origin=(0, 50, 0), direction=(0, -1, 0), reach=0.3) as hand:
        hand.move((0, 0.1, 0))
        motion.advance(0.1)
        scene.copy().render().save(path)
    with pytest.raises(cuvette.InputError, match="holds no scene"):
        cuvette.read(path)


def test_a_hand(scene):
    motion = scene.motion()
    solid = next(s for s in scene.solids if f"{s}.mesh" in scene and scene[f"{s}.mesh"] == motion.names[0])
    x, y, z = scene[f"{solid}.position"]
    above = dict(origin=(x, y + 50, z), direction=(0, -1, 0))
    where = motion.pick(solid, **above)
    assert where is not None and motion.pick(solid, origin=(x, y + 50, z), direction=(0, 1, 0)) is None
    with motion.grab(solid, **above, reach=0.3) as hand:
        assert hand.where == where and motion.state(solid).held > 0
        hand.move((0, 0.1, 0))
        motion.advance(0.02)
    assert motion.state(solid).held == 0
    assert motion.grab(solid, origin=(x, y + 50, z), direction=(0, 1, 0)) is None
    assert motion.pick(solid, pixel=(20, 15)) is None or len(motion.pick(solid, pixel=(20, 15))) == 3
    with pytest.raises(cuvette.InputError, match="pass pixel, or origin"):
        motion.grab(solid)


def test_a_scene_without_slimes():
    with pytest.raises(cuvette.InputError):
        cuvette.Scene().motion()
