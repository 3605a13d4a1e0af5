"""Rays: trees and fans as objects, queries with arrays of rays."""

import os
import tempfile
from typing import Any, Iterator, List, Optional, Sequence, Tuple

import numpy
from numpy.typing import NDArray

from ._library import (
    NULL,
    InputError,
    borrowed,
    call,
    described,
    encoded,
    ffi,
    lib,
    new_handle,
    on_beam_ray,
    sized,
    text_of,
    visit_each,
)
from .image import Path
from .records import html_table, svg_of

KINDS = ("camera", "reflect", "refract", "shadow")
ENDS = ("hit", "sky", "cut_depth", "cut_weight", "lit", "blocked")
_HIT = (
    "distance",
    "point",
    "normal",
    "error",
    "solid",
    "before",
    "after",
    "opaque",
    "total_internal",
    "solid_name",
    "face_name",
    "n_before",
    "n_after",
    "cos_in",
    "cos_out",
    "R_s",
    "R_p",
    "R",
    "T",
    "gain_classic",
    "gain_basic",
    "length_m",
    "transmittance",
    "angle_in_deg",
    "angle_out_deg",
)


def dtype_of(kind: str) -> "numpy.dtype[Any]":
    """The NumPy type of a struct, with its layout; texts are addresses."""
    fields: Any = {"names": [], "formats": [], "offsets": [], "itemsize": ffi.sizeof(kind)}
    for name, field in ffi.typeof(kind).fields:
        item, shape = field.type, ()  # type: Any, Tuple[int, ...]
        while item.kind == "array":
            item, shape = item.item, (*shape, item.length)
        if item.kind == "struct":
            form: Any = dtype_of(item.cname)
        else:
            letter = (
                "f"
                if item.cname in ("double", "float")
                else "u"
                if item.kind == "pointer" or item.cname[0] in ("u", "s")
                else "i"
            )
            form = f"{letter}{ffi.sizeof(item)}"
        fields["names"].append(name)
        fields["formats"].append((form, shape) if shape else form)
        fields["offsets"].append(field.offset)
    return numpy.dtype(fields)


def _array(kind: str, pointer: Any, count: int, owner: Any) -> NDArray[Any]:
    """The library's own memory as an array."""
    if count == 0:
        return numpy.empty(0, dtype_of(kind))
    out = numpy.frombuffer(ffi.buffer(borrowed(pointer, owner), count * ffi.sizeof(kind)), dtype_of(kind))
    out.setflags(write=False)
    return out


def _value(field: Any) -> Any:
    if isinstance(field, ffi.CData):
        kind = ffi.typeof(field).kind
        return tuple(field) if kind == "array" else text_of(field) if field != NULL else ""
    return field


class _View:
    """The fields of a C struct as attributes, and as a table in a notebook."""

    _fields: Tuple[str, ...] = ()

    def __init__(self, struct: Any, owner: Any) -> None:
        self._struct, self._owner = struct, owner

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._fields:
            raise AttributeError(f"a {type(self).__name__} has no {name}; it has {', '.join(self._fields)}")
        return _value(getattr(self._struct, name))

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self._fields]

    def _repr_html_(self) -> str:
        return html_table(("", ""), [(name, getattr(self, name)) for name in self._fields])


class Hit(_View):
    """Where a ray meets an interface: cuvette_node of cuvette.h describes the fields."""

    _fields = _HIT

    @property
    def angle_out_deg(self) -> Optional[float]:
        """None for total internal reflection, and at an opaque surface."""
        return None if self.total_internal or self.opaque else float(self._struct.angle_out_deg)

    def __repr__(self) -> str:
        return f"<Hit {self.solid_name} {self.face_name} at {self.distance:.6g}, {self.angle_in_deg:.4f} deg>"


class Node(_View):
    """One ray of a tree: kind, end, depth, origin, direction, ... and its hit, parent and children."""

    _fields = (
        "depth",
        "origin",
        "direction",
        "weight",
        "stokes",
        "added",
        "n",
        "medium_name",
        "medium",
        "light",
        "light_distance",
        "light_transmittance",
    )

    def __init__(self, nodes: "_Nodes", index: int) -> None:
        super().__init__(nodes._pointer[index], nodes)
        self._nodes, self.index = nodes, index

    @property
    def kind(self) -> str:
        return KINDS[self._struct.kind]

    @property
    def end(self) -> str:
        return ENDS[self._struct.end]

    @property
    def hit(self) -> Optional[Hit]:
        return Hit(self._struct, self._owner) if self.end == "hit" else None

    @property
    def parent(self) -> Optional["Node"]:
        return None if self._struct.parent < 0 else self._nodes[self._struct.parent]

    @property
    def children(self) -> List["Node"]:
        found, at = [], self._struct.first_child
        while at >= 0:
            found.append(self._nodes[at])
            at = found[-1]._struct.next
        return found

    def __repr__(self) -> str:
        return f"<Node {self.index}: {self.kind}, depth {self.depth}, in {self.medium_name}, {self.hit or self.end}>"


class _Nodes:
    """A sequence of nodes in the library's memory."""

    _pointer: Any
    _count: int
    _handle: Any

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: int) -> Node:
        if not -self._count <= index < self._count:
            raise IndexError(f"there are {self._count} rays")
        return Node(self, index % self._count)

    def __iter__(self) -> Iterator[Node]:
        return (self[i] for i in range(self._count))

    @property
    def array(self) -> NDArray[Any]:
        """All nodes as a structured array without a copy: `tree.array["R_s"]`. Kinds and ends are numbers, indices of
        cuvette.rays.KINDS and ENDS."""
        return _array("cuvette_node", self._pointer, self._count, self._handle)


def _written(write: Any, handle: Any, ending: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, f"rays{ending}")
        call(write, handle, encoded(path))
        with open(path, encoding="utf-8") as file:
            return file.read()


class Tree(_Nodes):
    """A ray and all that follow from it; `tree[0]` is the first ray. str(tree) is the text of `cuvette trace`; a
    notebook shows the drawing."""

    def __init__(self, handle: Any) -> None:
        count = ffi.new("size_t *")
        self._handle, self._pointer = handle, lib.cuvette_tree_nodes(handle, count)
        self._count = int(count[0])

    @property
    @described("cuvette_tree_radiance")
    def radiance(self) -> Tuple[float, ...]:
        rgb = ffi.new("double[3]")
        call(lib.cuvette_tree_radiance, self._handle, rgb)
        return tuple(rgb)

    @described("cuvette_tree_write")
    def save(self, path: Path) -> None:
        call(lib.cuvette_tree_write, self._handle, encoded(path))

    def __str__(self) -> str:
        return _written(lib.cuvette_tree_write, self._handle, ".txt")

    def _repr_svg_(self) -> str:
        return svg_of(_written(lib.cuvette_tree_write, self._handle, ".svg"))

    def __repr__(self) -> str:
        return f"<cuvette.Tree of {len(self)} rays, radiance {', '.join(f'{v:.6g}' for v in self.radiance)}>"


class FanRay(_View):
    """One ray of a fan: cuvette_fan_ray of cuvette.h describes the fields; `path` has its nodes."""

    _fields = (
        "offset",
        "end_name",
        "exit_point",
        "exit_direction",
        "reach",
        "deviation_deg",
        "weight",
        "axis_at",
        "axis_point",
    )

    @property
    def leaves(self) -> bool:
        return bool(self._struct.leaves)

    @property
    def crosses_axis(self) -> bool:
        return bool(self._struct.crosses_axis)

    @property
    def path(self) -> List[Node]:
        first = self._struct.first
        return [self._owner.nodes[i] for i in range(first, first + self._struct.count)]


class Fan:
    """Rays in one plane, each followed along its refracted path. A notebook shows the drawing."""

    def __init__(self, handle: Any) -> None:
        count = ffi.new("size_t *")
        self._handle, self._rays = handle, lib.cuvette_fan_rays(handle, count)
        self._count = int(count[0])
        self.nodes = _Nodes()
        self.nodes._handle, self.nodes._pointer = handle, lib.cuvette_fan_nodes(handle, count)
        self.nodes._count = count[0]

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: int) -> FanRay:
        if not -self._count <= index < self._count:
            raise IndexError(f"there are {self._count} rays")
        return FanRay(self._rays[index % self._count], self)

    @property
    def array(self) -> NDArray[Any]:
        """All rays as a structured array without a copy: `fan.array["deviation_deg"]`."""
        return _array("cuvette_fan_ray", self._rays, self._count, self._handle)

    @property
    def caustic(self) -> NDArray[Any]:
        """The crossings of neighbouring rays, n x 3."""
        count = ffi.new("size_t *")
        pointer = lib.cuvette_fan_crossings(self._handle, count)
        return _array("cuvette_crossing", pointer, count[0], self._handle)["at"]

    def _focus(self) -> Any:
        out = sized("focus")
        call(lib.cuvette_fan_focus, self._handle, out)
        return out

    @property
    def focus(self) -> Optional[Tuple[float, ...]]:
        """The point nearest to all deflected rays; None if they are parallel, or fewer than two."""
        found = self._focus()
        return tuple(found.point) if found.exists else None

    @property
    def focus_rms(self) -> float:
        """Root mean square of the rays' distances from the focus, scene units."""
        return float(self._focus().rms)

    @property
    def is_virtual(self) -> bool:
        """The focus is behind the rays."""
        return bool(self._focus().is_virtual)

    @described("cuvette_fan_write")
    def save(self, path: Path) -> None:
        call(lib.cuvette_fan_write, self._handle, encoded(path))

    def _repr_svg_(self) -> str:
        return svg_of(_written(lib.cuvette_fan_write, self._handle, ".svg"))

    def __repr__(self) -> str:
        focus = self.focus
        at = f"focus {', '.join(f'{v:.6g}' for v in focus)}" if focus else "no focus"
        return f"<cuvette.Fan of {len(self)} rays, {at}>"


class BeamRay:
    """A ray of one of the scene's beams: name of the beam, number among its `rays`, wavelength, power, number of its
    field point, and tree."""

    def __init__(self, ray: Any, tree: Tree) -> None:
        self.beam, self.number, self.rays = text_of(ray.beam_name), int(ray.number), int(ray.rays)
        self.lambda_nm, self.power, self.field, self.tree = float(ray.lambda_nm), float(ray.power), int(ray.field), tree

    def __repr__(self) -> str:
        return f"<BeamRay {self.beam} {self.number + 1} of {self.rays}, {self.lambda_nm:.6g} nm>"


class Tracer:
    """Base of the classes that trace trees and fans: a scene, as it is at the call, and a query."""

    def query(self, wavelength_nm: Optional[float] = None, **short: Any) -> "Query":
        raise NotImplementedError

    def trace(
        self,
        pixel: Optional[Sequence[int]] = None,
        origin: Optional[Sequence[float]] = None,
        direction: Optional[Sequence[float]] = None,
        wavelength_nm: Optional[float] = None,
        **short: Any,
    ) -> Tree:
        """The ray tree of a pixel, `scene.trace((400, 300))`, or of a ray, `scene.trace(origin=..., direction=...)`; at
        one wavelength, as `cuvette trace --lambda`, with wavelength_nm=580."""
        query = self.query(wavelength_nm, **short)._query
        if pixel is not None and origin is None and direction is None:
            return Tree(new_handle("tree", lib.cuvette_query_trace_pixel, lib.cuvette_tree_destroy, query, *pixel))
        if pixel is None and origin is not None and direction is not None:
            ray = ffi.new("cuvette_ray *", {"origin": list(origin), "direction": list(direction)})
            return Tree(new_handle("tree", lib.cuvette_query_trace, lib.cuvette_tree_destroy, query, ray))
        raise InputError("a tree starts with a pixel or a ray", "pass pixel, or origin and direction")

    @described("cuvette_query_fan")
    def fan(
        self,
        start: Sequence[float],
        to: Sequence[float],
        rays: int = 21,
        width: float = 1.0,
        spread_deg: float = 0,
        plane: Sequence[float] = (0, 0, 0),
        wavelength_nm: Optional[float] = None,
        **short: Any,
    ) -> Fan:
        """Rays around the axis from `start` through `to`, parallel over `width`, or spread from one point; plane is the
        normal of their plane."""
        rule = sized("fan_rule")
        rule.to, rule.normal, rule.rays, rule.width, rule.spread_deg = list(to), list(plane), rays, width, spread_deg
        setattr(rule, "from", list(start))
        query = self.query(wavelength_nm, **short)._query
        return Fan(new_handle("fan", lib.cuvette_query_fan, lib.cuvette_fan_destroy, query, rule))

    @described("cuvette_query_each_beam_ray")
    def beams(self, **short: Any) -> List[BeamRay]:
        """The rays of the scene's beams, by beam, field point, wavelength and number."""
        found: List[BeamRay] = []

        def add(ray: Any, tree: Any) -> None:
            found.append(BeamRay(ray, Tree(ffi.gc(tree, lib.cuvette_tree_destroy))))

        visit_each(lib.cuvette_query_each_beam_ray, on_beam_ray, add, self.query(**short)._query)
        return found


class Query(Tracer):
    """A snapshot of a scene for many rays. Any number of threads may use it."""

    def __init__(self, handle: Any, lights: Tuple[str, ...], solids: Tuple[str, ...]) -> None:
        self._query, self.lights, self.solids = handle, lights, solids

    def query(self, wavelength_nm: Optional[float] = None, **short: Any) -> "Query":
        """Returns the query itself: its settings are those that the scene had when it was created."""
        if wavelength_nm is not None or short:
            raise InputError("a query cannot be changed", "pass the settings to scene.query")
        return self

    @described("cuvette_query_cancel")
    def cancel(self) -> None:
        """Ends the query's calls in other threads: each raises Cancelled."""
        lib.cuvette_query_cancel(self._query)

    def camera_ray(self, x: float, y: float) -> Tuple[NDArray[Any], NDArray[Any]]:
        """Origin and direction of the camera ray through a point of the image; 0.5, 0.5 is the first pixel's centre."""
        ray = ffi.new("cuvette_ray *")
        call(lib.cuvette_query_camera_ray, self._query, x, y, ray)
        return numpy.array(list(ray.origin)), numpy.array(list(ray.direction))

    def _rays(self, origins: Any, directions: Any, reach: Any) -> NDArray[Any]:
        starts, headings = numpy.atleast_2d(origins), numpy.atleast_2d(directions)
        try:
            starts, headings = numpy.broadcast_arrays(starts, headings)
        except ValueError:
            raise InputError(f"{len(starts)} origins for {len(headings)} directions", "pass as many, or one") from None
        if starts.ndim != 2 or starts.shape[1] != 3:
            raise InputError(f"the rays have the shape {starts.shape}", "pass arrays of n x 3")
        rays = numpy.zeros(len(starts), dtype_of("cuvette_ray"))
        rays["origin"], rays["direction"], rays["reach"] = starts, headings, reach
        return rays

    @described("cuvette_query_nearest")
    def nearest(self, origins: Any, directions: Any, reach: Any = 0.0) -> NDArray[Any]:
        """Hits as a structured array, `hits["distance"]`; origins and directions are n x 3, or one for all rays."""
        rays = self._rays(origins, directions, reach)
        hits = numpy.empty(len(rays), dtype_of("cuvette_hit"))
        call(
            lib.cuvette_query_nearest,
            self._query,
            ffi.from_buffer("cuvette_ray[]", rays),
            len(rays),
            ffi.from_buffer("cuvette_hit[]", hits),
        )
        return hits

    @described("cuvette_query_occluded")
    def occluded(self, origins: Any, directions: Any, reach: Any = 0.0) -> NDArray[Any]:
        """Whether each ray is blocked, as an array of bool."""
        rays = self._rays(origins, directions, reach)
        blocked = numpy.empty(len(rays), numpy.uint8)
        call(
            lib.cuvette_query_occluded,
            self._query,
            ffi.from_buffer("cuvette_ray[]", rays),
            len(rays),
            ffi.from_buffer("unsigned char[]", blocked),
        )
        return blocked.astype(bool)

    @described("cuvette_query_medium")
    def medium(self, point: Sequence[float]) -> Optional[str]:
        """The name of the solid, or None outside."""
        at = ffi.new("int32_t *")
        call(lib.cuvette_query_medium, self._query, ffi.new("double[3]", list(point)), at)
        return None if at[0] == lib.CUVETTE_OUTSIDE else self.solids[at[0]]
