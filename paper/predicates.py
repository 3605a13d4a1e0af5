"""The language of the claims: comparisons of values of tables (claims.tsv explains it)."""

import operator
import re
from dataclasses import dataclass, field
from functools import reduce

from values import Value, combine, exact, extreme, is_below, joint_kind, known, rows_of, text_of, value_of

NUMBER = re.compile(r"[-+]?[0-9]+[.]?[0-9]*([eE][-+]?[0-9]+)?")
RELATIONS = {
    "=": operator.eq,
    "!=": operator.ne,
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
}
CHANGING = Value(0.5, 0.0, 1.0, "interval")


class Malformed(Exception):
    """The predicate is wrong, whatever the rows."""


class Missing(Exception):
    """The rows cannot decide the predicate."""


def study_of(table):
    return re.sub(r"-(metrics|curves|motion)$", "", table)


class Tables:
    """The tables of a folder, read when they are first used."""

    def __init__(self, folder):
        self.folder, self.read = folder, {}

    def rows(self, name):
        if name not in self.read:
            self.read[name] = rows_of(self.folder / f"{name}.tsv")
        return self.read[name]

    def __contains__(self, name):
        return (self.folder / f"{name}.tsv").is_file()


def full_name(row, short, table):
    """A column may be given without the part before its last dots: depth for render.depth."""
    if short in row:
        return short
    found = [name for name in row if name.endswith(f".{short}")]
    if not found:
        raise Missing(f"the rows of {study_of(table)} have no column {short}")
    return found[-1]


def holds(have, relation, want):
    if NUMBER.fullmatch(have) and NUMBER.fullmatch(want):
        return RELATIONS[relation](float(have), float(want))
    return RELATIONS[relation](have, want)


@dataclass
class Weight:
    """How well the cells that a predicate uses are measured."""

    fewest: int | None = None  # rows of a cell
    rows: int = 0
    bad: float = 0
    studies: dict = field(default_factory=dict)  # in the order of their use

    def add(self, table, row):
        self.studies[study_of(table)] = True
        if "n" not in row:
            return
        n = int(row["n"])
        marked = int(row["marked"]) if known(row, "marked") else 0
        self.fewest = n if self.fewest is None else min(self.fewest, n)
        self.rows += n + marked
        self.bad += marked
        if "disturbed" in row:
            self.bad += int(row["disturbed"]) if known(row, "disturbed") else 0
        elif is_disturbed(row):
            self.bad += n


def is_disturbed(row):
    """Whether other processes used more than 5 % of the machine in most rows of a cell. The system counts in steps of
    10 ms: a fraction that one step explains is none."""
    wall_s = float(row["wall_s_median"]) if known(row, "wall_s_median") else 0
    return known(row, "others_fraction") and wall_s > 0 and float(row["others_fraction"]) > 0.05 + 0.01 / wall_s


class Predicate:
    """A predicate being read: self.rest is the text that is left. Both errors say why there is no answer."""

    def __init__(self, text, tables, numbers, tolerance=0.0, unit="-"):
        self.rest, self.tables, self.numbers = text, tables, numbers
        self.tolerance, self.unit = tolerance, "" if unit == "-" else f" {unit}"
        self.weight, self.figures = Weight(), []

    def take(self, pattern):
        self.rest = self.rest.lstrip(" ")
        found = re.match(pattern, self.rest)
        if not found:
            return ""
        self.rest = self.rest[found.end() :]
        return found[0]

    def need(self, pattern, what):
        if not self.take(pattern):
            raise Malformed(f"expected {what} at '{self.rest[:30]}'")

    # --- cells

    def select(self, table, conditions):
        """The lines that meet the conditions and have rows."""
        rows = self.tables.rows(table)
        if table not in self.tables:
            raise Missing(f"no rows of {study_of(table)}")
        for condition in conditions.split():
            found = re.search("!=|>=|<=|=|>|<", condition)
            if not found:
                raise Malformed(f"no comparison in '{condition}'")
            if rows:
                name = full_name(rows[0], condition[: found.start()], table)
                rows = [row for row in rows if holds(row[name], found[0], condition[found.end() :])]
        rows = [row for row in rows if "n" not in row or float(row["n"]) > 0]
        if not rows:
            raise Missing(f"no rows of {study_of(table)} with {conditions or 'any cell'}")
        return rows

    def reference(self):
        """TABLE[CONDITIONS].COLUMN: table, column and lines."""
        table = self.take("[a-z][a-z0-9-]*")
        self.need(r"\[", "[")
        conditions = self.take(r"[^]]*")
        self.need(r"\]", "]")
        self.need("[.]", ".column")
        column = self.take(r"\([^)]*\)|[A-Za-z_][A-Za-z0-9_.]*").strip("()")
        return table, column, self.select(table, conditions)

    def value(self, table, column, row):
        self.weight.add(table, row)
        if table.startswith("published-"):
            return exact(float(row[column]))
        value = value_of(row, column)
        if value is None and column not in row and f"{column}_median" not in row:
            column = full_name(row, column, table)
            value = value_of(row, column)
        if value is None:
            raise Missing(f"no value of {column} in the rows of {study_of(table)}")
        return value

    def over_cells(self, name):
        self.need(r"\(", "(")
        table, column, rows = self.reference()
        self.need(r"\)", ")")
        if name in ("count", "distinct"):
            for row in rows:
                self.weight.add(table, row)
            found = {row[full_name(row, column, table)] for row in rows} if name == "distinct" else rows
            return exact(len(found))
        values = [self.value(table, column, row) for row in rows]
        if name in ("rises", "falls"):
            steps = [is_below(a, b) if name == "rises" else is_below(b, a) for a, b in zip(values, values[1:])]
            return exact(0) if False in steps else CHANGING if None in steps else exact(1)
        return reduce({
            "sum": lambda a, b: combine("+", a, b),
            "most": lambda a, b: extreme(max, a, b),
            "least": lambda a, b: extreme(min, a, b),
        }[name], values)  # fmt: skip

    def number(self, key):
        if key not in self.numbers or self.numbers[key].value is None:
            raise Missing(key)
        return exact(self.numbers[key].value)

    # --- the grammar

    def factor(self):
        if text := self.take(r"[0-9]+([.][0-9]+)?(e-?[0-9]+)?"):
            return exact(float(text))
        if self.take("-"):
            return combine("-", exact(0), self.factor())
        if self.take(r"\("):
            value = self.expression()
            self.need(r"\)", ")")
            return value
        if text := self.take(r"\{[^}]*\}"):
            return self.number(text[1:-1])
        if name := self.take(r"(least|most|sum|count|distinct|rises|falls)(?=\()"):
            return self.over_cells(name)
        if not re.match(r"[a-z][a-z0-9-]*\[", self.rest):
            raise Malformed(f"expected a value at '{self.rest[:30]}'")
        table, column, rows = self.reference()
        if len(rows) > 1:
            raise Malformed(f"{len(rows)} cells match where one is expected: {table}")
        return self.value(table, column, rows[0])

    def product(self):
        value = self.factor()
        while op := self.take("[*/]"):
            value = combine(op, value, self.factor())
        return value

    def expression(self):
        value = self.product()
        while op := self.take("[-+]"):
            value = combine(op, value, self.product())
        return value

    def comparison(self):
        a = self.expression()
        op = self.take("<=|>=|<|>|=|~")
        if not op:
            raise Malformed(f"expected a comparison at '{self.rest[:30]}'")
        b = self.expression()
        self.figures.append(text_of(a) + self.unit)
        if op in ("<", "<="):
            return is_below(a, b, op == "<=")
        if op in (">", ">="):
            return is_below(b, a, op == ">=")
        if op == "=":
            if joint_kind(a, b) == "exact":
                return a.mid == b.mid
            return False if is_below(a, b) or is_below(b, a) else None
        ratio, low, high = combine("/", a, b), exact(1 - self.tolerance), exact(1 + self.tolerance)
        if is_below(ratio, low) or is_below(high, ratio):
            return False
        return True if is_below(low, ratio, True) and is_below(ratio, high, True) else None

    def verdict(self):
        """Conditions joined by "and": False if one is, None (unknown) if one is and none is False."""
        results = [self.comparison()]
        while self.take("and "):
            results.append(self.comparison())
        if self.rest.strip(" "):
            raise Malformed(f"unexpected '{self.rest.strip(' ')[:30]}'")
        return False if False in results else None if None in results else True
