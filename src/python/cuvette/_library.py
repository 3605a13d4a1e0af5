"""The shared library: where it is, its errors as exceptions, and what the other modules need to call it."""

import importlib
import inspect
import os
import pathlib
import textwrap
import threading
from typing import Any, Callable, Iterator, List, Optional, TypeVar

from . import _declarations
from ._documents import FUNCTIONS

NAME = "libcuvette.so.0"
ffi: Any = _declarations.ffi


def _find() -> str:
    """The path of the library: CUVETTE_LIBRARY, else that of the same build or installation, else the system's."""
    asked = os.environ.get("CUVETTE_LIBRARY")
    if asked:
        return asked
    here = pathlib.Path(__file__).resolve().parent
    for folder in list(here.parents)[:4]:
        for place in (folder / NAME, folder / "lib" / NAME):
            if place.exists():
                return str(place)
    return NAME


def _load() -> Any:
    path = _find()
    try:
        return ffi.dlopen(path)
    except OSError as error:
        raise ImportError(f"{error}; install libcuvette, or set CUVETTE_LIBRARY to the path of {NAME}") from None


lib = _load()
NULL = ffi.NULL
Kind = TypeVar("Kind", bound=Callable[..., Any])


def import_module(module: str) -> Any:
    """Imports a module that only some functions need."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        raise ModuleNotFoundError(f"{error}; on Debian: sudo apt install python3-{package}", name=error.name) from None


class Error(Exception):
    """Why a call failed. str(error) is "file:line:column: what; remedy", without the parts that are unknown."""

    def __init__(self, what: str, remedy: str = "", file: str = "", line: int = 0, column: int = 0) -> None:
        self.what, self.remedy, self.file, self.line, self.column = what, remedy, file, line, column
        place = "".join(f"{part}:" for part in (file, line, column) if part)
        super().__init__(f"{place}{' ' if place else ''}{what}{'; ' if remedy else ''}{remedy}")


class InputError(Error, ValueError):
    """A file, a name or a value is invalid."""


class SystemFailure(Error, RuntimeError):
    """The system failed: memory, disk, threads."""


class BusyError(Error, RuntimeError):
    """A render or a motion uses the engine or the scene."""


class Cancelled(Error):
    """Stopped on request. After a render, `image` is the finished part; None before the first ray."""

    image: Any = None


_KINDS = {
    lib.CUVETTE_FAILURE: SystemFailure,
    lib.CUVETTE_BAD_INPUT: InputError,
    lib.CUVETTE_BUSY: BusyError,
    lib.CUVETTE_CANCELLED: Cancelled,
}


def text_of(chars: Any) -> str:
    return str(ffi.string(chars), "utf-8", "replace")


def error_of(status: int, why: Any) -> Error:
    kind = _KINDS.get(status, SystemFailure)
    return kind(text_of(why.what), text_of(why.remedy), text_of(why.file), why.line, why.column)


def encoded(text: Any) -> bytes:
    """A name, a path or a value as C text."""
    data = os.fsencode(text) if not isinstance(text, bytes) else text
    if b"\0" in data:
        raise InputError("a text contains the character 0", "remove it")
    return data


def call(function: Callable[..., Any], *arguments: Any) -> None:
    """Calls a function that returns a cuvette_status and takes `why` last; raises its error."""
    why = ffi.new("cuvette_diagnostic *")
    status = function(*arguments, why)
    if status != lib.CUVETTE_OK:
        raise error_of(status, why)


def new_handle(kind: str, function: Callable[..., Any], destroy: Callable[..., Any], *arguments: Any) -> Any:
    """Returns the handle that a function creates; it is released with the Python object."""
    out = ffi.new(f"cuvette_{kind} **")
    call(function, *arguments, out)
    return ffi.gc(out[0], destroy)


def read_text(function: Callable[..., Any], *arguments: Any) -> str:
    """The text that a function like cuvette_scene_get copies into memory of a known size."""
    size, length = 256, ffi.new("size_t *")
    while True:
        memory, why = ffi.new("char[]", size), ffi.new("cuvette_diagnostic *")
        status = function(*arguments, memory, size, length, why)
        if status == lib.CUVETTE_OK:
            return text_of(memory)
        if length[0] < size:
            raise error_of(status, why)
        size, length[0] = length[0] + 1, 0


class Visit:
    """A callback and its context; `also` is a second callback with the same context. An exception of the Python
    function ends the C call, if the callback returns bool; it is raised by `finish`."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function, self.error = function, None  # type: Callable[..., Any], Optional[BaseException]
        self.also: Optional[Callable[..., Any]] = None
        self.context = ffi.new_handle(self)

    def guard(self, function: Any, *arguments: Any) -> bool:
        try:
            return self.error is None and function(*arguments) is not False
        except BaseException as error:  # also KeyboardInterrupt: `finish` raises it, where the call was made
            self.error = error
            return False

    def __call__(self, *arguments: Any) -> bool:
        return self.guard(self.function, *arguments)

    def finish(self) -> None:
        if self.error is not None:
            error, self.error = self.error, None
            raise error


def _keep_error(kind: Any, error: BaseException, traceback: Any) -> None:
    """Stores an error that Visit.guard did not catch: a KeyboardInterrupt can arrive before its first statement."""
    ffi.from_handle(traceback.tb_frame.f_locals["context"]).error = error


def callback(result: str, *arguments: str) -> Any:
    """A C callback with a context that passes its arguments to the Visit; it returns false after an exception."""

    def forward(context: Any, *values: Any) -> Any:
        wants_more = ffi.from_handle(context)(*values)
        return wants_more if result == "bool" else None

    return ffi.callback(f"{result}(void *, {', '.join(arguments)})", forward, onerror=_keep_error)


on_progress = callback("bool", "double")
on_parameter = callback("bool", "const cuvette_parameter *")
on_text = callback("void", "const char *")
on_metric = callback("bool", "const cuvette_metric *")
on_lens_number = callback("bool", "const cuvette_lens_number *")
on_curve = callback("bool", "const cuvette_curve *")
on_value = callback("bool", "const char *", "const char *")
on_column = callback("bool", "const cuvette_column *")
on_beam_ray = callback("bool", "const cuvette_beam_ray *", "cuvette_tree *")
on_run = callback("bool", "double", "double")


def _pass_news(context: Any, text: Any) -> None:
    visit = ffi.from_handle(context)
    visit.guard(visit.also, text)


on_news = ffi.callback("void(void *, const char *)", _pass_news, onerror=_keep_error)


def visit_each(function: Callable[..., Any], callback: Any, act: Callable[..., Any], *arguments: Any) -> None:
    """Calls a function of the kind f(arguments, callback, context, why)."""
    visit = Visit(act)
    call(function, *arguments, callback, visit.context)
    visit.finish()


def described(name: str) -> Callable[[Kind], Kind]:
    """Appends the header's comment on a function to a docstring."""

    def add(function: Kind) -> Kind:
        own = inspect.cleandoc(function.__doc__ or "")
        comment = "\n\n".join(textwrap.fill(part, 100) for part in FUNCTIONS[name].split("\n\n"))
        function.__doc__ = f"{own}\n\n{comment}".strip()
        return function

    return add


class Engines:
    """Engines with their threads, kept for the next render: one per concurrent render."""

    def __init__(self) -> None:
        self.free: List[Any] = []
        self.lock = threading.Lock()
        os.register_at_fork(after_in_child=self.forget)

    def forget(self) -> None:
        """A child process has none of the threads, and must not wait for them to end."""
        self.free, self.lock = [ffi.gc(one, None) for one in self.free] and [], threading.Lock()

    def acquire(self) -> Any:
        with self.lock:
            if self.free:
                return self.free.pop()
        return new_handle("engine", lib.cuvette_engine_create, lib.cuvette_engine_destroy, NULL)

    def release(self, engine: Any) -> None:
        with self.lock:
            self.free.append(engine)


engines = Engines()


def sized(kind: str) -> Any:
    """A struct of zeros whose size is set."""
    out = ffi.new(f"cuvette_{kind} *")
    out.size = ffi.sizeof(f"cuvette_{kind}")
    return out


def owned_text(text: Any) -> Optional[str]:
    """The text that the library allocated for the caller, freed here; None for NULL."""
    if not text:
        return None
    try:
        return text_of(text)
    finally:
        lib.cuvette_text_destroy(text)


def borrowed(pointer: Any, owner: Any) -> Any:
    """A pointer that keeps the owner of its memory alive, and with it NumPy arrays that show the memory."""
    return ffi.gc(pointer, lambda _: owner)


def version() -> str:
    return text_of(lib.cuvette_version())


def names_of(count: int, name: Callable[[int], Any]) -> Iterator[str]:
    return (text_of(name(i)) for i in range(count))
