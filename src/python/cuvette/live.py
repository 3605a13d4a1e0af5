"""A scene with the engine that renders it, in one HTML document, for notebooks and slides."""

import html
import os
import pathlib
from typing import Any

from ._library import InputError, lib, read_text
from .image import Path

NAME = "live.html"
REMEDY = "make it with: make setup-wasm setup-site site; or set CUVETTE_LIVE to it"


def _find() -> pathlib.Path:
    """The path in CUVETTE_LIVE; else live.html of the same build or installation."""
    asked = os.environ.get("CUVETTE_LIVE")
    here = pathlib.Path(__file__).resolve().parent
    near = [place for folder in list(here.parents)[:4] for place in (folder / NAME, folder / "share/cuvette" / NAME)]
    for place in [pathlib.Path(asked)] if asked else near:
        if place.exists():
            return place
    raise InputError(f"cannot find the laboratory in one file, {asked or NAME}", REMEDY)


class Live:
    """The laboratory with a scene, as a document that needs no server. A notebook shows it; `html` is its text."""

    def __init__(self, scene: Any, width: int = 960, height: int = 640) -> None:
        code = read_text(lib.cuvette_scene_write_link, scene)
        page = _find().read_text(encoding="utf-8")
        head = f'<head><script type="text/plain" id="cuvette-scene">{code}</script>'
        self.html, self.width, self.height = page.replace("<head>", head, 1), width, height

    def save(self, path: Path) -> None:
        """Writes the document to a file, for slides: a browser opens it, and an iframe shows it."""
        pathlib.Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        size = f'width="{self.width}" height="{self.height}" style="max-width: 100%; border: 0"'
        return f'<iframe title="Cuvette" {size} srcdoc="{html.escape(self.html)}"></iframe>'

    def __repr__(self) -> str:
        return f"<cuvette.Live {self.width} x {self.height}, {len(self.html)} characters>"
