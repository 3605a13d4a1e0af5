"""The difference of two images, as a display shows them."""

import os
from dataclasses import dataclass
from typing import Any, Optional, Tuple, Union

import numpy
from numpy.typing import NDArray

from ._library import InputError, borrowed, call, described, encoded, ffi, lib, new_handle, sized
from .image import Image, Path
from .records import html_table

Pixels = Union[Image, Path, NDArray[Any]]


@described("cuvette_image_read")
def read_image(path: Path) -> NDArray[numpy.float32]:
    """Linear RGB: float32 of height x width x 3, a view of the library's own memory."""
    handle = new_handle("image", lib.cuvette_image_read, lib.cuvette_image_destroy, encoded(path))
    size = ffi.new("int[2]")
    pointer = lib.cuvette_image_rgb(handle, size, size + 1)
    memory = ffi.buffer(borrowed(pointer, handle), 3 * size[0] * size[1] * ffi.sizeof("float"))
    out = numpy.frombuffer(memory, numpy.float32).reshape(size[1], size[0], 3)
    out.setflags(write=False)
    return out


@dataclass(frozen=True)
class Comparison:
    """cuvette-compare(1) describes the numbers."""

    mse: float
    psnr_db: float
    ssim: float
    flip: float
    largest: float
    differing_fraction: float
    largest_at: Tuple[int, int]
    map: Optional[NDArray[numpy.float32]]  #: FLIP error of each pixel in false colour, linear RGB

    def _repr_html_(self) -> str:
        names = [name for name in self.__dataclass_fields__ if name != "map"]
        return html_table(("", ""), [(name, getattr(self, name)) for name in names])


def _pixels(image: Pixels) -> NDArray[numpy.float32]:
    if isinstance(image, (str, os.PathLike)):
        return read_image(image)
    array = numpy.ascontiguousarray(image.array if isinstance(image, Image) else image, numpy.float32)
    if array.ndim != 3 or array.shape[2] != 3:
        raise InputError(f"the image has the shape {array.shape}", "pass an array of height x width x 3, linear RGB")
    return array


@described("cuvette_compare")
def compare(a: Pixels, b: Pixels, map: bool = False) -> Comparison:
    """Compares images, files, or arrays of linear RGB."""
    one, other = _pixels(a), _pixels(b)
    if one.shape != other.shape:
        sizes = [f"{shape[1]} x {shape[0]}" for shape in (one.shape, other.shape)]
        raise InputError(f"one image is {sizes[0]}, the other {sizes[1]}", "render both at the same size")
    drawn = numpy.empty_like(one) if map else None
    found = sized("comparison")
    memory: Any = ffi.NULL if drawn is None else ffi.from_buffer("float[]", drawn)
    call(
        lib.cuvette_compare,
        one.shape[1],
        one.shape[0],
        ffi.from_buffer("float[]", one),
        ffi.from_buffer("float[]", other),
        memory,
        found,
    )
    return Comparison(
        found.mse,
        found.psnr_db,
        found.ssim,
        found.flip,
        found.largest,
        found.differing_fraction,
        (found.largest_x, found.largest_y),
        drawn,
    )
