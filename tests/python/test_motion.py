"""Slimes: in slices as in one go, grabbed by hands."""

import cuvette
import pytest
from conftest import ROOT

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
    with pytest.raises(cuvette.InputError, match="give pixel, or origin"):
        motion.grab(solid)


def test_a_scene_without_slimes():
    with pytest.raises(cuvette.InputError):
        cuvette.Scene().motion()
