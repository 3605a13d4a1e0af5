"""The progress bar of a render or a study: on a terminal or in a notebook only, and only for what takes a while."""

import sys
import time
from typing import Callable, Optional, Union

Progress = Union[None, bool, Callable[[float], object]]

AFTER_S = 0.5
WIDTH = 40


def _is_watched() -> bool:
    """Whether a person sees standard error: on a terminal, or below a cell of a notebook."""
    return sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel")


class Bar:
    def __init__(self, what: str, after_s: float = AFTER_S) -> None:
        self.what, self.begin, self.next, self.shown = what, time.monotonic(), time.monotonic() + after_s, False

    def __call__(self, share: float, note: str = "") -> None:
        now = time.monotonic()
        if now < self.next:
            return
        self.next, self.shown = now + 0.1, True
        left = (now - self.begin) * (1 / share - 1) if share > 0 else float("nan")
        bar = "#" * int(WIDTH * share)
        text = f"{self.what} [{bar:<{WIDTH}}] {100 * share:3.0f} %"
        print(f"\r{text}{f', {left:.0f} s left' if left == left else ''}{note}\033[K", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def bar_of(progress: Progress, what: str) -> Optional[Callable[..., object]]:
    """None: a bar if someone sees it; True, False: always, never; a function: it gets the share from 0 to 1."""
    if callable(progress):
        return progress
    show = _is_watched() if progress is None else progress
    return Bar(what, 0 if progress else AFTER_S) if show else None


def end(bar: Optional[Callable[..., object]]) -> None:
    if isinstance(bar, Bar):
        bar.end()
