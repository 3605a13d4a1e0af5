"""Traced optics against textbook formulas."""

from dataclasses import dataclass
from typing import Any

import numpy
from numpy.typing import NDArray

from ._library import import_module
from .records import Records


@dataclass(frozen=True)
class Metric:
    """A measured quantity and its closed form."""

    name: str
    verdict: str  #: "pass", "FAIL", or "none": the scene has nothing to measure it on
    measured: float
    theory: float
    error: float
    tolerance: float
    unit: str
    meaning: str


class Metrics(Records[Metric]):
    """A list of metrics."""

    @property
    def failures(self) -> "Metrics":
        return Metrics(one for one in self if one.verdict == "FAIL")


@dataclass(frozen=True)
class Curve:
    """Measured and theoretical values along x."""

    name: str
    x_label: str
    y_label: str
    x: NDArray[numpy.float64]
    measured: NDArray[numpy.float64]
    theory: NDArray[numpy.float64]

    def plot(self, axes: Any = None) -> Any:
        """Draws the curve with matplotlib; returns the axes."""
        if axes is None:
            axes = import_module("matplotlib.pyplot").figure().add_subplot()
        axes.plot(self.x, self.theory, "-", color="0.6", label="theory")
        axes.plot(self.x, self.measured, ".", markersize=4, label="traced")
        axes.set(xlabel=self.x_label, ylabel=self.y_label, title=self.name)
        axes.legend()
        return axes
