"""Measured values with what is known of their error, and how the paper prints numbers.

A value has a median, two ends and a kind: "exact" (a count, or computed without noise), "interval" (95 % of the median,
from six repetitions on), "range" (smallest and largest, of fewer) or "unbounded" (one repetition, or a divisor that may
be 0). Sums, products and quotients combine the ends that are farthest apart. For independent medians that is wider than
their joint 95 % interval, whose half-widths add as squares; so it covers at least 95 %.
"""

import pathlib
import re
import sys
from typing import NamedTuple

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "experiments"))
from tables import known, rows_of  # pylint: disable=wrong-import-position,unused-import

KINDS = ("unbounded", "range", "interval", "exact")  # of a combination, the first


class Value(NamedTuple):
    mid: float
    low: float
    high: float
    kind: str


class Printed(NamedTuple):
    """A number as TeX, and the number that the reader sees."""

    tex: str
    value: float | None


def axis(text, places=6):
    """A value of an axis as part of a key."""
    if not re.fullmatch(r"[-+0-9.]+", text):
        return text
    number = float(text)
    return f"{number:.0f}" if number == int(number) else f"{number:.{places}g}"


# --- values


def exact(number):
    return Value(number, number, number, "exact")


# Columns that differ between repetitions; an axis, such as toy.time_s, does not.
MEASURED = re.compile(r"_s$|_s_|^imbalance$|_fraction$|^peak_rss|_switches$|^cycles|^instructions")
CONSTANT = re.compile(r"^differing_fraction$|^[a-z-]+[.]")


def value_of(row, name):
    """The value of a column of a summary: NAME_median or NAME, with NAME_low and NAME_high, or _min and _max; None if
    it has none."""
    mid = next((row[column] for column in (f"{name}_median", name) if known(row, column)), None)
    if mid is None:
        return None
    mid = float(mid)
    if known(row, f"{name}_low"):
        return Value(mid, float(row[f"{name}_low"]), float(row[f"{name}_high"]), "interval")
    if known(row, f"{name}_min") and float(row["n"]) > 1:
        return Value(mid, float(row[f"{name}_min"]), float(row[f"{name}_max"]), "range")
    measured = MEASURED.search(name) and not CONSTANT.search(name)
    return Value(mid, mid, mid, "unbounded" if measured else "exact")


def joint_kind(a, b):
    return next(kind for kind in KINDS if kind in (a.kind, b.kind))


def combine(op, a, b):
    """a op b, one of + - * /; None if a value is missing."""
    if a is None or b is None:
        return None
    kind = joint_kind(a, b)
    if op == "+":
        return Value(a.mid + b.mid, a.low + b.low, a.high + b.high, kind)
    if op == "-":
        return Value(a.mid - b.mid, a.low - b.high, a.high - b.low, kind)
    if op == "/" and b.low <= 0 <= b.high:
        return Value(a.mid / b.mid if b.mid else 0.0, 0.0, 0.0, "unbounded")
    of = (lambda x, y: x * y) if op == "*" else (lambda x, y: x / y)
    ends = [of(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    return Value(of(a.mid, b.mid), min(ends), max(ends), kind)


def scaled(value, factor):
    return combine("*", value, exact(factor))


def extreme(choose, a, b):
    """The larger (choose: max) or smaller (min) of two values, whichever that is: its ends are the larger or smaller
    ones."""
    return Value(choose(a.mid, b.mid), choose(a.low, b.low), choose(a.high, b.high), joint_kind(a, b))


def is_below(a, b, or_equal=False):
    """Whether a < b if the ends decide it, None otherwise."""
    if joint_kind(a, b) == "unbounded":
        return None
    if a.high < b.low or (or_equal and a.high <= b.low):
        return True
    if a.low > b.high or (not or_equal and a.low >= b.high):
        return False
    return None


# --- as text


def decimals_of(value):
    """Decimals that leave about two digits of the interval's half-width, and at most five digits of the value."""
    half, size = (value.high - value.low) / 2, abs(value.mid)
    certain = half <= 0
    places = 4 if certain else 1
    while not certain and half < 1 and places < 9:
        half, places = half * 10, places + 1
    if half >= 10:
        places = 0
    while certain and half == 0 and size >= 10 and places > 0:
        size, places = size / 10, places - 1
    return places


def fixed(number, places):
    """A number without the sign of a zero."""
    text = f"{number:.{places}f}"
    return text.lstrip("-") if float(text) == 0 else text


def short(number):
    return f"{number:.0f}" if number == int(number) and abs(number) < 1e9 else f"{number:.4g}"


def text_of(value):
    """ "1.93 [1.90, 1.97]"; a range has round brackets: "1.93 (1.90 to 1.97)"."""
    if value.kind == "exact":
        return short(value.mid)
    if value.kind == "unbounded":
        return f"{short(value.mid)} (unknown error)"
    places = decimals_of(value)
    mid, low, high = (fixed(number, places) for number in value[:3])
    return f"{mid} [{low}, {high}]" if value.kind == "interval" else f"{mid} ({low} to {high})"


def signed(text):
    """A number with the minus of TeX."""
    return Printed(re.sub("^-", r"\\ensuremath{-}", text), float(text))


def tex_of(value):
    """The same for TeX; paper.tex says how ends are set."""
    if value.kind in ("exact", "unbounded"):
        number = signed(short(value.mid))
        return number if value.kind == "exact" else Printed(number.tex + r"\single{}", number.value)
    places = decimals_of(value)
    mid, low, high = (signed(fixed(number, places)) for number in value[:3])
    macro = r"\within" if value.kind == "interval" else r"\ranging"
    return Printed(f"{mid.tex}{macro}{{{low.tex}}}{{{high.tex}}}", mid.value)


def scientific(number, places=1, largest=9.95):
    """A positive number as a power of ten."""
    if number == 0:
        return Printed("0", 0.0)
    exponent = 0
    while number < 1:
        number, exponent = number * 10, exponent - 1
    while number >= largest:
        number, exponent = number / 10, exponent + 1
    return Printed(
        rf"\ensuremath{{{number:.{places}f}\cdot 10^{{{exponent}}}}}", float(f"{number:.{places}f}e{exponent}")
    )


def digits(number):
    """About four digits, without an exponent."""
    size = abs(number)
    text = f"{size:.{0 if size >= 1000 else 1 if size >= 100 else 2 if size >= 10 else 3}f}"
    return signed(f"-{text}" if number < 0 else text)


def significant(number):
    """Three digits; a power of ten if plain digits would hide the value."""
    if number == 0:
        return Printed("0", 0.0)
    if number < 1e-4:
        return scientific(number, 2, 10)
    places, size = 2, number
    while size < 1 and places < 6:
        size, places = size * 10, places + 1
    return signed(f"{number:.{places}f}")
