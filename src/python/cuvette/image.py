"""A rendered image: the film's values as NumPy arrays, its hash, the counts of rays, times."""

import os
import tempfile
from dataclasses import dataclass
from typing import Any, Optional, Tuple, Union

import numpy
from numpy.typing import NDArray

from ._library import borrowed, call, described, encoded, ffi, lib, sized

Path = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Counts:
    """Rays that were traced, by kind, and what ended them. Exact, and the same for any number of threads."""

    camera: int
    reflect: int
    refract: int
    shadow: int
    total_internal: int  #: total internal reflections
    cut_depth: int  #: rays not traced: beyond render.depth
    cut_weight: int  #: rays not traced: below render.min_weight
    cut_depth_throughput: Tuple[float, float, float]  #: sum of their weights, linear RGB
    cut_weight_throughput: Tuple[float, float, float]
    by_depth: Tuple[int, ...]  #: camera, reflected and refracted rays by recursion depth, up to the last one
    photon: int  #: rays of photons (render.caustics)

    @property
    def total(self) -> int:
        return self.camera + self.reflect + self.refract + self.shadow + self.photon


@dataclass(frozen=True)
class SolidCounts:
    """Counts of one solid."""

    tests: int  #: rays tested against it; 0 for a solid in a hierarchy
    hits: int  #: hits on its interfaces, without shadow rays and photons
    first_hits: int  #: camera rays whose first interface is on it


class Image:
    """The result of a render. `numpy.asarray(image)` is `image.array`; a notebook shows it."""

    def __init__(self, frame: Any, solids: Tuple[str, ...]) -> None:
        self._frame, self._solids = frame, solids
        self._array: Optional[NDArray[numpy.float32]] = None
        self._srgb: Optional[NDArray[numpy.uint8]] = None

    @property
    def width(self) -> int:
        return int(lib.cuvette_frame_width(self._frame))

    @property
    def height(self) -> int:
        return int(lib.cuvette_frame_height(self._frame))

    @property
    @described("cuvette_frame_hash")
    def hash(self) -> str:
        """16 hex digits, as in the rows of a study."""
        return f"{lib.cuvette_frame_hash(self._frame):016x}"

    @property
    def array(self) -> NDArray[numpy.float32]:
        """Linear RGB, 1.0 is white: float32 of height x width x 3, row by row from the top. The library writes it into
        the array's own memory, once; the array is read-only, so that it remains the image of the hash."""
        if self._array is None:
            out = numpy.empty((self.height, self.width, 3), numpy.float32)
            memory = ffi.from_buffer("float[]", out)
            call(lib.cuvette_frame_rgb, self._frame, 0, 0, self.width, self.height, memory, 0)
            out.setflags(write=False)
            self._array = out
        return self._array

    @property
    def srgb(self) -> NDArray[numpy.uint8]:
        """The same encoded as sRGB: uint8 of height x width x 3, what a display needs."""
        if self._srgb is None:
            out = numpy.empty((self.height, self.width, 3), numpy.uint8)
            memory = ffi.from_buffer("unsigned char[]", out)
            call(lib.cuvette_frame_srgb, self._frame, 0, 0, self.width, self.height, memory, 0)
            out.setflags(write=False)
            self._srgb = out
        return self._srgb

    @described("cuvette_frame_layer")
    def layer(self, name: str) -> NDArray[numpy.float32]:
        """float32 of height x width x channels, or of height x width for one channel; a view of the library's own
        memory. Only for an image that was rendered with layers=True."""
        values, channels = ffi.new("float **"), ffi.new("int *")
        call(lib.cuvette_frame_layer, self._frame, encoded(name), values, channels)
        size = self.height * self.width * channels[0]
        memory = ffi.buffer(borrowed(values[0], self._frame), size * ffi.sizeof("float"))
        out = numpy.frombuffer(memory, numpy.float32)
        out.setflags(write=False)
        return out.reshape((self.height, self.width, 3) if channels[0] == 3 else (self.height, self.width))

    @described("cuvette_frame_map")
    def map(self, name: str) -> NDArray[numpy.float64]:
        """float64 of height x width. "rays", "time" and "cut" need an image that was rendered with maps=True."""
        out = numpy.empty((self.height, self.width), numpy.float64)
        call(lib.cuvette_frame_map, self._frame, encoded(name), ffi.from_buffer("double[]", out))
        return out

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return self.array if dtype is None else self.array.astype(dtype)

    @property
    def counts(self) -> Counts:
        c = sized("counters")
        call(lib.cuvette_frame_counters, self._frame, c)
        depths = list(c.by_depth)
        while len(depths) > 1 and depths[-1] == 0:
            depths.pop()
        plain = {name: getattr(c, name) for name in list(Counts.__dataclass_fields__)[:7]}
        lost = [(one[0], one[1], one[2]) for one in (c.cut_depth_throughput, c.cut_weight_throughput)]
        return Counts(
            **plain,
            cut_depth_throughput=lost[0],
            cut_weight_throughput=lost[1],
            by_depth=tuple(depths),
            photon=c.photon,
        )

    def solid_counts(self, solid: Union[int, str]) -> SolidCounts:
        """Counts of a solid, by its name or its index in the scene; only the first 64 are counted."""
        index = self._solids.index(solid) if isinstance(solid, str) and solid in self._solids else solid
        if isinstance(index, str):
            raise KeyError(f"the scene has no solid '{index}'; it has {', '.join(self._solids)}")
        c = sized("solid_counters")
        call(lib.cuvette_frame_solid_counters, self._frame, index, c)
        return SolidCounts(c.tests, c.hits, c.first_hits)

    @property
    def _times(self) -> Any:
        out = sized("statistics")
        call(lib.cuvette_frame_statistics, self._frame, out)
        return out

    @property
    def seconds(self) -> float:
        """Wall time of the frame, s."""
        return float(self._times.wall_s)

    @property
    def cpu_seconds(self) -> float:
        """CPU time of the process over the same interval, s."""
        return float(self._times.cpu_s)

    @property
    def threads(self) -> int:
        """Number of threads that rendered it."""
        return int(self._times.threads)

    @property
    def noise_rms(self) -> float:
        """Standard error of the film's values, root mean square; NaN without random paths."""
        return float(self._times.noise_rms)

    @described("cuvette_frame_write")
    def save(self, path: Path, bits: int = 8) -> None:
        """Writes the image to a file: .png, .jpg, .pfm or .exr."""
        call(lib.cuvette_frame_write, self._frame, encoded(path), bits)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "image.png")
            self.save(path)
            with open(path, "rb") as file:
                return file.read()

    def __repr__(self) -> str:
        size = f"{self.width} x {self.height}"
        return f"<cuvette.Image {size}, film {self.hash}, {self.counts.total} rays, {self.seconds:.3g} s>"
