"""The progress bar of a render or a study: on a terminal or in a notebook only, and only if the call takes a while."""

import contextlib
import html
import sys
import time
from typing import Any, Callable, Iterator, Optional, Union

from ._library import Cancelled, Visit

Progress = Union[None, bool, Callable[[float], object]]

AFTER_S = 0.5
WIDTH = 40


def _is_notebook() -> bool:
    return type(sys.stderr).__module__.startswith("ipykernel")


class Bar:
    """A line on the terminal, erased at the end."""

    def __init__(self, what: str, after_s: float = AFTER_S) -> None:
        self.what, self.begin, self.next, self.shown = what, time.monotonic(), time.monotonic() + after_s, False

    def __call__(self, fraction: float) -> None:
        now = time.monotonic()
        if now >= self.next:
            self.next = now + 0.1
            left = f", {(now - self.begin) * (1 / fraction - 1):.0f} s left" if fraction > 0 else ""
            self.show(fraction, left)
            self.shown = True

    def show(self, fraction: float, left: str) -> None:
        bar = "#" * int(WIDTH * fraction)
        text = f"\r{self.what} [{bar:<{WIDTH}}] {100 * fraction:3.0f} %{left}\033[K"
        print(text, end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


class NotebookBar(Bar):
    """A bar below the cell, empty at the end."""

    display: Any = None

    def show(self, fraction: float, left: str) -> None:
        from IPython.display import HTML, display

        bar = f"<progress value='{fraction:.3f}'></progress>"
        text = HTML(f"{html.escape(self.what)} {bar} {100 * fraction:.0f} %{left}")
        if self.display is None:
            self.display = display(text, display_id=True)
        else:
            self.display.update(text)

    def end(self) -> None:
        if self.display is not None:
            from IPython.display import HTML

            self.display.update(HTML(""))


def bar_of(progress: Progress, what: str) -> Optional[Callable[..., object]]:
    """The function that receives the finished fraction, 0 to 1. progress: None, a bar on a terminal or in a notebook;
    True, always a bar; False, none; or a function."""
    if callable(progress):
        return progress
    show = _is_notebook() or sys.stderr.isatty() if progress is None else progress
    kind = NotebookBar if _is_notebook() else Bar
    return kind(what, 0 if progress else AFTER_S) if show else None


def end(bar: Optional[Callable[..., object]]) -> None:
    if isinstance(bar, Bar):
        bar.end()


@contextlib.contextmanager
def watched(progress: Progress, what: str) -> Iterator[Visit]:
    """A bar for a call with on_progress and the context of the Visit. An exception of the progress function, also
    KeyboardInterrupt, is raised again; Cancelled if the function returned False."""
    bar = bar_of(progress, what)
    visit = Visit(bar or (lambda fraction: True))
    try:
        yield visit
    except Cancelled:
        if visit.error is None:
            raise
    finally:
        end(bar)
    visit.finish()
