"""Slimes in motion, and hands that grab them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, List, Optional, Sequence, Tuple

from . import progress as bars
from ._library import InputError, call, described, encoded, ffi, lib, new_handle, names_of, on_progress, sized

if TYPE_CHECKING:
    from .scene import Scene


@dataclass(frozen=True)
class Slime:
    """The state of a slime; cuvette_slime of cuvette.h describes the units."""

    time_s: float
    steps: int
    substeps: int
    masses: int
    held: int
    kinetic: float
    elastic: float
    compression: float
    gravity: float
    center: Tuple[float, ...]
    momentum: Tuple[float, ...]
    volume: float
    volume_at_rest: float
    low: float
    high: float
    speed_max: float


class Hand:
    """Holds masses of a slime, until it is released; as a context manager, until the end of the block."""

    def __init__(self, motion: "Motion", number: int, where: Tuple[float, ...]) -> None:
        self._motion, self._number, self.where = motion, number, where

    @described("cuvette_motion_move")
    def move(self, by: Sequence[float]) -> None:
        call(lib.cuvette_motion_move, self._motion._motion, self._number, ffi.new("double[3]", list(by)))

    @described("cuvette_motion_release")
    def release(self) -> None:
        call(lib.cuvette_motion_release, self._motion._motion, self._number)

    def __enter__(self) -> "Hand":
        return self

    def __exit__(self, *error: Any) -> None:
        self.release()


class Motion:
    """Advances the slimes of a scene in time. `motion.advance(1.5)`, then `scene.render()` shows the new shapes."""

    @described("cuvette_motion_create")
    def __init__(self, scene: "Scene") -> None:
        self.scene = scene
        self._motion: Any = new_handle("motion", lib.cuvette_motion_create, lib.cuvette_motion_destroy, scene._scene)

    @described("cuvette_motion_advance_watched")
    @described("cuvette_motion_advance")
    def advance(self, time_s: float, progress: bars.Progress = None) -> None:
        """progress: as in Scene.render. Ctrl-C stops the motion."""
        with bars.watched(progress, "motion") as visit:
            call(lib.cuvette_motion_advance_watched, self._motion, time_s, on_progress, visit.context)

    @property
    def time_s(self) -> float:
        """The time of the bodies."""
        return max((self.state(name).time_s for name in self.names), default=0.0)

    @property
    def names(self) -> Tuple[str, ...]:
        """The names of the slimes' meshes."""
        return tuple(
            names_of(lib.cuvette_motion_count(self._motion), lambda i: lib.cuvette_motion_name(self._motion, i))
        )

    @described("cuvette_motion_state")
    def state(self, name: str) -> Slime:
        out = sized("slime")
        call(lib.cuvette_motion_state, self._motion, encoded(name), out)
        values = (getattr(out, field) for field in Slime.__dataclass_fields__)
        plain: List[Any] = [tuple(v) if isinstance(v, ffi.CData) else v for v in values]
        return Slime(*plain)

    def _ray(self, pixel: Optional[Sequence[float]], origin: Any, direction: Any) -> Any:
        if pixel is not None:
            origin, direction = self.scene.query().camera_ray(*pixel)
        if origin is None or direction is None:
            raise InputError("a hand needs a ray", "pass pixel, or origin and direction")
        return ffi.new("cuvette_ray *", {"origin": list(origin), "direction": list(direction)})

    @described("cuvette_motion_pick")
    def pick(
        self,
        name: str,
        pixel: Optional[Sequence[float]] = None,
        origin: Optional[Sequence[float]] = None,
        direction: Optional[Sequence[float]] = None,
    ) -> Optional[Tuple[float, ...]]:
        """The point, or None on a miss."""
        where, distance = ffi.new("double[3]"), ffi.new("double *")
        ray = self._ray(pixel, origin, direction)
        call(lib.cuvette_motion_pick, self._motion, encoded(name), ray, where, distance)
        return tuple(where) if distance[0] < float("inf") else None

    @described("cuvette_motion_grab")
    def grab(
        self,
        name: str,
        pixel: Optional[Sequence[float]] = None,
        origin: Optional[Sequence[float]] = None,
        direction: Optional[Sequence[float]] = None,
        reach: float = 0.2,
    ) -> Optional[Hand]:
        """The hand, or None on a miss."""
        where, hand = ffi.new("double[3]"), ffi.new("int *")
        ray = self._ray(pixel, origin, direction)
        call(lib.cuvette_motion_grab, self._motion, encoded(name), ray, reach, hand, where)
        return None if hand[0] == lib.CUVETTE_NO_HAND else Hand(self, hand[0], tuple(where))
