"""Cuvette from Python: scenes, renders, rays, optics and studies of the ray tracer, in the same library as the program.

    import cuvette
    scene = cuvette.read("experiments/scenes/rod.yaml")
    scene["liquid.ior"] = 1.4
    image = scene.render(depth=8)
    print(image.hash, image.counts.total, image.array.mean())

The manual is `man cuvette-python`; parameters are described by help(cuvette.Scene.set).
"""

from ._library import BusyError, Cancelled, Error, InputError, SystemFailure, version
from .comparison import Comparison, compare, read_image
from .image import Counts, Image, SolidCounts
from .live import Live
from .motion import Hand, Motion, Slime
from .optics import Curve, Metric, Metrics
from .rays import Fan, FanRay, Hit, Node, Query, Tree
from .scene import Parameter, Parameters, Scene, read, read_text_scene as parse
from .study import Figure, Study, columns, rows, study

for _kind in (BusyError, Cancelled, Error, InputError, SystemFailure):
    _kind.__module__ = __name__  # the name in tracebacks is the one to catch

__version__ = version()
__all__ = [
    "BusyError",
    "Cancelled",
    "Comparison",
    "Counts",
    "Curve",
    "Error",
    "Fan",
    "FanRay",
    "Figure",
    "Hand",
    "Hit",
    "Image",
    "InputError",
    "Live",
    "Metric",
    "Metrics",
    "Motion",
    "Node",
    "Parameter",
    "Parameters",
    "Query",
    "Scene",
    "Slime",
    "SolidCounts",
    "Study",
    "SystemFailure",
    "Tree",
    "columns",
    "compare",
    "parse",
    "read",
    "read_image",
    "rows",
    "study",
]
