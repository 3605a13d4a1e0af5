"""Scenes: parameters by name, objects, rendering."""

import math
import os
import re
from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import NDArray

from . import progress as bars
from ._documents import PARAMETERS
from ._library import (
    NULL,
    Cancelled,
    InputError,
    Visit,
    call,
    described,
    encoded,
    engines,
    error_of,
    ffi,
    lib,
    new_handle,
    names_of,
    on_curve,
    on_lens_number,
    on_metric,
    on_parameter,
    on_progress,
    on_text,
    read_text,
    sized,
    text_of,
    visit_each,
)
from .image import Image, Path
from .live import Live
from .motion import Motion
from .optics import Curve, Metric, Metrics
from .rays import Query, Tracer
from .records import Records

Value = Union[bool, int, float, str, Tuple[float, ...]]


@dataclass(frozen=True)
class Parameter:
    """One parameter of a scene."""

    path: str  #: "ball.radius"
    value: str  #: as text, as in a scene file
    unit: str  #: "" for ratios and words
    range: str  #: "integer 1..65536"
    initial: str  #: its default
    meaning: str


class Parameters(Records[Parameter]):
    """A list of parameters."""


def _text_of_value(value: Any) -> str:
    if isinstance(value, (bool, numpy.bool_)):
        return "on" if value else "off"
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, (int, float, numpy.integer, numpy.floating)):
        return repr(value.item() if isinstance(value, numpy.generic) else value)
    if isinstance(value, (Sequence, numpy.ndarray)):
        return ",".join(_text_of_value(one) for one in value)
    raise InputError(
        f"a {type(value).__name__} is no value of a parameter", "pass a number, a text or a list of numbers"
    )


def _path_of(name: str) -> str:
    """A parameter as a keyword: depth is render.depth, liquid__ior is liquid.ior."""
    return name.replace("__", ".") if "__" in name else f"render.{name}"


class Scene(Tracer):
    """A scene. `scene["liquid.ior"] = 1.4` sets a parameter, `scene["liquid.ior"]` is its value, `scene.parameters`
    lists all. Objects are added by name: `scene.add_solid("ball", "sphere")`."""

    def __init__(self, handle: Any = None) -> None:
        self._scene = handle or new_handle("scene", lib.cuvette_scene_create, lib.cuvette_scene_destroy)

    # --- parameters

    @described("cuvette_scene_set")
    def __setitem__(self, path: str, value: Any) -> None:
        call(lib.cuvette_scene_set, self._scene, encoded(path), encoded(_text_of_value(value)))

    @described("cuvette_scene_get")
    def __getitem__(self, path: str) -> Value:
        """A number, True or False, a tuple of numbers, or a text."""
        name, text = encoded(path), read_text(lib.cuvette_scene_get, self._scene, encoded(path))
        if text in ("on", "off"):
            return text == "on"
        integer, real, count = ffi.new("int64_t *"), ffi.new("double *"), ffi.new("size_t *")
        several = ffi.new("double[64]")
        if text != "auto" and lib.cuvette_scene_get_int(self._scene, name, integer, NULL) == lib.CUVETTE_OK:
            return int(integer[0])
        if lib.cuvette_scene_get_double(self._scene, name, real, NULL) == lib.CUVETTE_OK:
            return float(real[0])
        if lib.cuvette_scene_get_vector(self._scene, name, several, 64, count, NULL) == lib.CUVETTE_OK:
            return tuple(several[0 : count[0]])
        return text

    def __contains__(self, path: object) -> bool:
        try:
            read_text(lib.cuvette_scene_get, self._scene, encoded(path))
        except InputError:
            return False
        return True

    def set(self, values: Optional[Mapping[str, Any]] = None, **short: Any) -> "Scene":
        """Sets several parameters, all or none: `scene.set({"liquid.ior": 1.4}, depth=8, rod__visible=False)`. As a
        keyword, depth is render.depth and rod__visible is rod.visible. Returns the scene."""
        wanted = {**(values or {}), **{_path_of(name): value for name, value in short.items()}}
        trial = self.copy() if len(wanted) > 1 else self
        for path, value in wanted.items():
            trial[path] = value
        if trial is not self:
            for path, value in wanted.items():
                self[path] = value
        return self

    @property
    def parameters(self) -> Parameters:
        """Every parameter of the scene, with unit, range, default and meaning."""
        found = Parameters()
        fields = list(Parameter.__dataclass_fields__)

        def add(one: Any) -> None:
            found.append(Parameter(*(text_of(getattr(one, name)) for name in fields)))

        visit_each(lib.cuvette_scene_each_parameter, on_parameter, add, self._scene)
        return found

    @property
    def changes(self) -> Parameters:
        """The parameters that differ from their defaults; those of a solid's surface only if they differ from its
        material's."""
        values = {p.path: p.value for p in self.parameters}
        material = dict(re.findall(r"^  ([\w-]+):\n(?:    .*\n)*?    material: ([\w-]+)$", str(self), re.M))

        def differs(one: Parameter) -> bool:
            group, name = one.path.split(".", 1)
            of_material = values.get(f"{material.get(group)}.{name}")
            return one.value != (one.initial if of_material is None else of_material)

        return Parameters(p for p in self.parameters if differs(p))

    def keys(self) -> Iterator[str]:
        return (p.path for p in self.parameters)

    def _ipython_key_completions_(self) -> List[str]:
        """What the tab key offers after `scene["`."""
        return list(self.keys())

    def __reduce__(self) -> Tuple[Any, ...]:
        """Pickles the scene as the text of its file: without meshes, textures and data from arrays."""
        return read_text_scene, (str(self), "scene of another process")

    # --- objects

    @described("cuvette_scene_add_solid")
    def add_solid(self, name: str, shape: str, material: Optional[str] = None, **values: Any) -> None:
        """`scene.add_solid("ball", "sphere", "glass", radius=0.5)`."""
        given = NULL if material is None else encoded(material)
        call(lib.cuvette_scene_add_solid, self._scene, encoded(name), encoded(shape), given)
        self._set_new(name, values)

    def add_light(self, name: str, **values: Any) -> None:
        call(lib.cuvette_scene_add_light, self._scene, encoded(name))
        self._set_new(name, values)

    def add_material(self, name: str, **values: Any) -> None:
        call(lib.cuvette_scene_add_material, self._scene, encoded(name))
        self._set_new(name, values)

    @described("cuvette_scene_add_mesh")
    def add_mesh(self, name: str, **values: Any) -> None:
        call(lib.cuvette_scene_add_mesh, self._scene, encoded(name))
        self._set_new(name, values)

    def _set_new(self, name: str, values: Mapping[str, Any]) -> None:
        """Sets the values of an object that was just added; removes the object if one is wrong."""
        try:
            for key, value in values.items():
                self[f"{name}.{key}"] = value
        except Exception:
            self.remove(name)
            raise

    @described("cuvette_scene_add_triangles")
    def add_triangles(self, name: str, vertices: Any, corners: Any, normals: Any = None, uvs: Any = None) -> None:
        """A mesh from arrays: vertices n x 3, corners (indices of vertices) m x 3."""
        kinds = {
            "vertices": (vertices, numpy.float64, 3),
            "corners": (corners, numpy.uint32, 3),
            "normals": (normals, numpy.float64, 3),
            "uvs": (uvs, numpy.float64, 2),
        }
        given = sized("triangles")
        arrays = {}
        for key, (values, dtype, columns) in kinds.items():
            if values is None:
                continue
            array = arrays[key] = numpy.ascontiguousarray(values, dtype)
            if array.ndim != 2 or array.shape[1] != columns:
                raise InputError(f"{key} have the shape {array.shape}", f"pass an array of n x {columns}")
            setattr(given, key, ffi.from_buffer(f"{'uint32_t' if dtype is numpy.uint32 else 'double'}[]", array))
        for key in ("normals", "uvs"):
            if key in arrays and len(arrays[key]) != len(arrays["vertices"]):
                raise InputError(
                    f"{len(arrays[key])} {key} for {len(arrays['vertices'])} vertices", "pass one per vertex"
                )
        given.vertex_count, given.triangle_count = len(arrays["vertices"]), len(arrays["corners"])
        call(lib.cuvette_scene_add_triangles, self._scene, encoded(name), given)

    @described("cuvette_scene_add_pixels")
    def add_pixels(self, name: str, rgb: Any) -> None:
        """A texture from an array of height x width x 3 linear values, row by row from the top."""
        array = numpy.ascontiguousarray(rgb, numpy.float32)
        if array.ndim != 3 or array.shape[2] != 3:
            raise InputError(f"the pixels have the shape {array.shape}", "pass an array of height x width x 3")
        memory = ffi.from_buffer("float[]", array)
        call(lib.cuvette_scene_add_pixels, self._scene, encoded(name), array.shape[1], array.shape[0], memory)

    def add_data(self, name: str, **values: Any) -> None:
        call(lib.cuvette_scene_add_data, self._scene, encoded(name))
        self._set_new(name, values)

    @described("cuvette_scene_add_values")
    def add_values(self, name: str, lambda_nm: Any, values: Any, extinction: Any = None) -> None:
        """Optical data from arrays of one length: wavelengths in nm, values there, and extinction indices or None."""
        given = [lambda_nm, values] + ([] if extinction is None else [extinction])
        arrays = [numpy.ascontiguousarray(each, numpy.float64) for each in given]
        if any(each.ndim != 1 or each.shape != arrays[0].shape for each in arrays):
            shapes = ", ".join(str(each.shape) for each in arrays)
            raise InputError(f"the arrays have the shapes {shapes}", "pass arrays of n numbers")
        memory = [ffi.from_buffer("double[]", each) for each in arrays] + ([NULL] if extinction is None else [])
        call(lib.cuvette_scene_add_values, self._scene, encoded(name), *memory, len(arrays[0]))

    @described("cuvette_scene_remove")
    def remove(self, name: str) -> None:
        call(lib.cuvette_scene_remove, self._scene, encoded(name))

    @described("cuvette_scene_rename")
    def rename(self, name: str, new_name: str) -> None:
        call(lib.cuvette_scene_rename, self._scene, encoded(name), encoded(new_name))

    @described("cuvette_scene_give_material")
    def set_material(self, solid: str, material: Optional[str]) -> None:
        given = NULL if material is None else encoded(material)
        call(lib.cuvette_scene_give_material, self._scene, encoded(solid), given)

    @described("cuvette_scene_move")
    def move(self, name: str, by: Sequence[float]) -> None:
        call(lib.cuvette_scene_move, self._scene, encoded(name), _three(by))

    @described("cuvette_scene_turn")
    def turn(self, name: str, degrees: Sequence[float]) -> None:
        call(lib.cuvette_scene_turn, self._scene, encoded(name), _three(degrees))

    @described("cuvette_scene_scale")
    def scale(self, name: str, factor: float) -> None:
        call(lib.cuvette_scene_scale, self._scene, encoded(name), factor)

    @described("cuvette_scene_look_at")
    def look_at(self, target: Sequence[float]) -> None:
        call(lib.cuvette_scene_look_at, self._scene, _three(target))

    def _names(self, kind: int) -> Tuple[str, ...]:
        count = lib.cuvette_scene_count(self._scene, kind)
        return tuple(names_of(count, lambda i: lib.cuvette_scene_name(self._scene, kind, i)))

    @property
    def solids(self) -> Tuple[str, ...]:
        return self._names(lib.CUVETTE_SOLID)

    @property
    def lights(self) -> Tuple[str, ...]:
        return self._names(lib.CUVETTE_LIGHT)

    @property
    def materials(self) -> Tuple[str, ...]:
        return self._names(lib.CUVETTE_MATERIAL)

    @property
    def meshes(self) -> Tuple[str, ...]:
        return self._names(lib.CUVETTE_MESH)

    @property
    def textures(self) -> Tuple[str, ...]:
        return self._names(lib.CUVETTE_TEXTURE)

    @property
    def data(self) -> Tuple[str, ...]:
        return self._names(lib.CUVETTE_DATA)

    # --- the scene

    @described("cuvette_scene_clone")
    def copy(self) -> "Scene":
        return Scene(new_handle("scene", lib.cuvette_scene_clone, lib.cuvette_scene_destroy, self._scene))

    __copy__ = copy

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Scene":
        return self.copy()

    @described("cuvette_scene_check")
    def check(self) -> None:
        call(lib.cuvette_scene_check, self._scene)

    @property
    def hints(self) -> List[str]:
        """One line for everything that is valid but looks like a mistake."""
        found: List[str] = []
        visit_each(lib.cuvette_scene_hints, on_text, lambda text: found.append(text_of(text)), self._scene)
        return found

    @described("cuvette_scene_write")
    def save(self, path: Path) -> None:
        call(lib.cuvette_scene_write, self._scene, encoded(path))

    @described("cuvette_scene_write_link")
    def live(self, width: int = 960, height: int = 640) -> Live:
        """The scene with its engine in one HTML document: a notebook shows it as a frame of this size, in which it can
        be turned and changed, `scene.live().save("turn.html")` writes it for slides. Needs live.html (`make site`)."""
        return Live(self._scene, width, height)

    def __str__(self) -> str:
        """The scene as the text of a scene file."""
        return read_text(lib.cuvette_scene_write_text, self._scene)

    def __repr__(self) -> str:
        size = f"{self['render.width']} x {self['render.height']}"
        return f"<cuvette.Scene {size}: {', '.join(self.solids) or 'no solids'}>"

    def _repr_html_(self) -> str:
        return self.changes._repr_html_()

    # --- rays and optics

    @described("cuvette_scene_load")
    def load(self, progress: bars.Progress = None) -> "Scene":
        """Ctrl-C stops. Calls that need the files and slimes load them, too. Returns the scene."""
        with bars.watched(progress, "slimes") as visit:
            call(lib.cuvette_scene_load, self._scene, on_progress, visit.context)
        return self

    @described("cuvette_query_wavelength_create")
    @described("cuvette_query_create")
    def query(self, wavelength_nm: Optional[float] = None, **short: Any) -> Query:
        """The scene as it is now, with these settings, for rays of your own."""
        scene = (self.copy().set(**short) if short else self).load()
        if wavelength_nm is None:
            handle = new_handle("query", lib.cuvette_query_create, lib.cuvette_query_destroy, scene._scene, NULL)
        else:
            create = lib.cuvette_query_wavelength_create
            handle = new_handle("query", create, lib.cuvette_query_destroy, scene._scene, wavelength_nm, NULL)
        return Query(handle, scene.lights, scene.solids)

    @described("cuvette_scene_each_metric")
    def realism(self) -> Metrics:
        """Traced quantities and textbook formulas; a notebook shows a table, `.table()` is a pandas DataFrame."""
        found = Metrics()

        def add(one: Any) -> None:
            numbers = (one.measured, one.theory, one.error, one.tolerance)
            found.append(
                Metric(text_of(one.name), text_of(one.verdict), *numbers, text_of(one.unit), text_of(one.meaning))
            )

        visit_each(lib.cuvette_scene_each_metric, on_metric, add, self.load()._scene)
        return found

    @described("cuvette_scene_each_lens_number")
    def lens_report(self, system: Optional[str] = None) -> Dict[str, Dict[str, NDArray[numpy.float64]]]:
        """What `cuvette lens report` prints: the columns of each section as arrays, with a value for each record. The
        keys of records, `surface`, `field`, `lambda_nm` and `x`, are columns too, NaN where a record has none."""
        records: Dict[str, Dict[Tuple[float, ...], Dict[str, float]]] = {}

        def add(one: Any) -> None:
            key = (one.surface or math.nan, one.field or math.nan, one.lambda_nm, one.x)
            found = records.setdefault(text_of(one.section), {}).setdefault(tuple(map(repr, key)), {})
            found.update(zip(("surface", "field", "lambda_nm", "x"), key))
            found[text_of(one.quantity)] = one.value

        named = NULL if system is None else system.encode()
        visit_each(lib.cuvette_scene_each_lens_number, on_lens_number, add, self.load()._scene, named)
        return {
            section: {
                name: numpy.array([one.get(name, math.nan) for one in found.values()])
                for name in dict.fromkeys(name for one in found.values() for name in one)
            }
            for section, found in records.items()
        }

    @property
    def curves(self) -> Tuple[str, ...]:
        """Names of the curves that the scene has."""
        return tuple(self._curves())

    def _curves(self) -> Dict[str, Tuple[str, str]]:
        found = {}

        def add(one: Any) -> None:
            found[text_of(one.name)] = text_of(one.x), text_of(one.y)

        visit_each(lib.cuvette_scene_each_curve, on_curve, add, self._scene)
        return found

    @described("cuvette_scene_curve")
    def curve(self, name: str) -> Curve:
        """A curve of measured and theoretical values."""
        points, count = numpy.empty((1024, 3)), ffi.new("size_t *")
        memory = ffi.cast("double (*)[3]", ffi.from_buffer("double[]", points))
        call(lib.cuvette_scene_curve, self.load()._scene, encoded(name), memory, len(points), count)
        x, measured, theory = points[: count[0]].T
        return Curve(name, *self._curves().get(name, ("x", "y")), x, measured, theory)

    def motion(self) -> Motion:
        """The slimes of the scene in motion, from their initial state: the scene shows their shapes."""
        return Motion(self)

    # --- rendering

    def render(
        self,
        values: Optional[Mapping[str, Any]] = None,
        *,
        progress: bars.Progress = None,
        layers: bool = False,
        maps: bool = False,
        **short: Any,
    ) -> Image:
        """Renders the scene. Parameters as for `set` count for this render only: `scene.render(depth=8)`.

        progress: None, a bar on a terminal or in a notebook if it takes longer than half a second; True or False; or a
        function that receives the fraction done, 0 to 1, and may return False to stop. Ctrl-C stops the render and
        raises KeyboardInterrupt. Other Python threads run meanwhile.

        layers: keep the layers of render.integrator aov, which is then set (Image.layer). maps: keep the number of
        rays, the time and the fraction of cut light of each pixel (Image.map)."""
        if layers:
            short = {"integrator": "aov", **short}
        scene = self.copy().set(values, **short) if values or short else self
        bar = bars.bar_of(progress, "render")
        visit = Visit(bar or (lambda fraction: True))
        request = sized("request")
        request.progress, request.context = on_progress, visit.context
        request.layers, request.pixel_rays, request.pixel_time, request.pixel_cut = layers, maps, maps, maps
        engine, out, why = engines.acquire(), ffi.new("cuvette_frame **"), ffi.new("cuvette_diagnostic *")
        try:
            status = lib.cuvette_engine_render(engine, scene._scene, request, out, why)
        finally:
            bars.end(bar)
        engines.release(engine)
        frame = ffi.gc(out[0], lib.cuvette_frame_destroy) if out[0] else None
        visit.finish()
        if status == lib.CUVETTE_CANCELLED:
            stopped = Cancelled("the render was stopped by its progress function")
            stopped.image = frame and Image(frame, scene.solids)
            raise stopped
        if status != lib.CUVETTE_OK:
            raise error_of(status, why)
        return Image(frame, scene.solids)


def _three(values: Sequence[float]) -> Any:
    if len(values) != 3:
        raise InputError(f"{len(values)} numbers instead of 3", "pass x, y, z")
    return ffi.new("double[3]", [float(v) for v in values])


Scene.set.__doc__ = f"{Scene.set.__doc__}\n\nParameters (`cuvette params`):\n\n{PARAMETERS}"


@described("cuvette_scene_read")
def read(path: Path) -> Scene:
    """The scene of a file."""
    return Scene(new_handle("scene", lib.cuvette_scene_read, lib.cuvette_scene_destroy, encoded(path)))


@described("cuvette_scene_read_text")
def read_text_scene(text: str, name: str = "text") -> Scene:
    """The scene of a text, such as a scene file's."""
    data = text.encode()
    return Scene(
        new_handle("scene", lib.cuvette_scene_read_text, lib.cuvette_scene_destroy, encoded(name), data, len(data))
    )
