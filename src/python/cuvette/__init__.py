"""Cuvette from Python: scenes, renders, rays, optics and studies of the ray tracer, in the same library as the program.

    import cuvette
    scene = cuvette.read("experiments/scenes/rod.yaml")
    scene["liquid.ior"] = 1.4
    image = scene.render(depth=8)
    print(image.hash, image.counts.total, image.array.mean())

The manual is `man cuvette-python`; parameters are described by help(cuvette.Scene.set).
"""

from ._library import BusyError, Cancelled, Error, InputError, SystemFailure, version
from .image import Counts, Image, SolidCounts
from .scene import Parameter, Parameters, Scene, read, read_text_scene as parse

__version__ = version()
