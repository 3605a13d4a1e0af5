"""Lists of results as tables, in notebooks and for pandas."""

import dataclasses
import difflib
import html
from typing import Any, List, Sequence, TypeVar

from ._library import import_module

Item = TypeVar("Item")


def html_table(titles: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    def cell(value: Any) -> str:
        text = html.escape(f"{value:.6g}" if isinstance(value, float) else str(value))
        return f'<td style="text-align: {"right" if isinstance(value, (int, float)) else "left"}">{text}</td>'

    head = "".join(f'<th style="text-align: left">{html.escape(title)}</th>' for title in titles)
    return f"<table><tr>{head}</tr>{''.join('<tr>' + ''.join(map(cell, row)) + '</tr>' for row in rows)}</table>"


def svg_of(document: str) -> str:
    """The svg element of a drawing, without the XML declaration, which notebooks refuse."""
    return document[document.index("<svg") :]


class Records(List[Item]):
    """A list of results, each with the same fields; a notebook shows a table. A text as the
    index selects the result whose first field equals it: `scene.parameters["liquid.ior"]`."""

    def __getitem__(self, key: Any) -> Any:
        if not isinstance(key, str):
            return super().__getitem__(key)
        names = [row[0] for row in self._rows()]
        if key not in names:
            close = difflib.get_close_matches(key, names, 1)
            hint = f"did you mean '{close[0]}'?" if close else f"there are {', '.join(names)}"
            raise KeyError(f"there is no '{key}'; {hint}")
        return self[names.index(key)]

    def _rows(self) -> List[List[Any]]:
        return [[getattr(one, field.name) for field in dataclasses.fields(one)] for one in self]

    def _titles(self) -> List[str]:
        return [field.name for field in dataclasses.fields(self[0])] if self else []

    def _repr_html_(self) -> str:
        return html_table(self._titles(), self._rows())

    def table(self) -> Any:
        """A pandas DataFrame."""
        pandas = import_module("pandas")

        return pandas.DataFrame(self._rows(), columns=self._titles())
