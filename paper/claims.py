#!/usr/bin/env -S python3 -B
"""Judge every claim of paper/claims.tsv by the rows of a folder, and print its verdict: reproduced, not reproduced, or
underpowered, which is what rows are that cannot decide it.

  paper/claims.py RESULTS OUT         after experiments/tables.sh RESULTS

Writes OUT/claims.tsv (id, verdict, figure, reason, sentence), OUT/claims.tex (the sentences that the paper prints
instead of claims that are not reproduced, and its table of claims) and OUT/numbers.tex (all numbers of the paper).
Status: 0; 1 if a claim is not reproduced; 2 if claims.tsv is wrong, or there are no rows.
"""

import pathlib
import re
import sys
from collections import Counter
from typing import NamedTuple

from paper_numbers import ROOT, numbers_of, plain
from predicates import Malformed, Missing, Predicate, Tables
from values import known, rows_of

PAPER = pathlib.Path(__file__).resolve().parent


class Verdict(NamedTuple):
    id: str
    verdict: str
    figure: str
    reason: str
    sentence: str
    shown: str


def fail(message):
    print(f"claims: {message}", file=sys.stderr)
    sys.exit(2)


def claims_of(path):
    """The claims, as dictionaries by column."""
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n").split("\t") for line in file if line.strip() and not line.startswith("#")]
    wrong = [
        f"{path}: {line[0]} has {len(line)} fields, not {len(lines[0])}" for line in lines if len(line) != len(lines[0])
    ]
    if wrong:
        fail("\n".join(wrong))
    return [dict(zip(lines[0], line)) for line in lines[1:]]


def environments_of(tables):
    """The environment of each study whose table has one."""
    found = {}
    for path in sorted(tables.glob("*.tsv")):
        for row in rows_of(path):
            if "n" in row and known(row, "environment"):
                found[path.stem] = row["environment"]
                break
    return found


def decide(claim, predicate, environments):
    """The verdict, what was measured, and the reason."""
    needs = claim["needs"].split()
    try:
        result = predicate.verdict()
    except Missing as missing:
        reason = str(missing)
        if f"{{{reason}}}" in claim["predicate"]:
            absent = [name for name in needs if name not in predicate.tables]
            reason = f"no rows of {absent[0]}" if absent else f"the rows do not give the number {reason}"
        return "underpowered", "-", reason
    if "{" in claim["predicate"]:  # a number of the paper depends on all cells of its study
        for name in needs:
            if name not in predicate.weight.studies:
                for row in predicate.tables.rows(name):
                    if "n" in row and float(row["n"]) > 0:
                        predicate.weight.add(name, row)
    weight, figure, reason = predicate.weight, "; ".join(predicate.figures), "-"
    bad = weight.bad / weight.rows if weight.rows else 0
    used = {environments[study] for study in weight.studies if study in environments}
    if weight.fewest is not None and weight.fewest < int(claim["rows"]):
        reason = f"{weight.fewest} rows of a cell, {claim['rows']} are needed"
    elif bad > float(claim["disturbed"]):
        most = float(claim["disturbed"]) * 100
        reason = f"{bad * 100:.0f} % of the rows are disturbed or marked, at most {most:.0f} % may be"
    elif len(used) > 1 and float(claim["disturbed"]) < 1:
        reason = "its studies were measured in different environments"
    elif result is None:
        reason = "the interval is too wide to decide"
    else:
        return ("reproduced" if result else "not reproduced"), figure, reason
    return "underpowered", figure, reason


def judge(claim, tables, numbers, environments):
    """One claim. `-` as predicate: no rows say anything about it, and `needs` is the command that does."""
    if claim["predicate"] == "-":
        decided = ("underpowered", "-", f"no rows say it; run {claim['needs']}")
    else:
        predicate = Predicate(claim["predicate"], tables, numbers, float(claim["tolerance"]), claim["unit"])
        decided = decide(claim, predicate, environments)
    return Verdict(claim["id"], *decided, claim["sentence"], claim.get("shown", "-"))


# --- for TeX


def braces(text):
    """The text within the braces that start a text, and what follows."""
    depth = 0
    for found in re.finditer(r"\\.|[{}]", text, flags=re.S):
        depth += {"{": 1, "}": -1}.get(found[0], 0)
        if depth == 0:
            return text[1 : found.start()], text[found.end() :]
    return text[1:], ""


def numbers_lacking(text, numbers):
    """By claim, a number that a sentence of the paper has, and the rows do not give."""
    lacking = {}
    for part in text.split(r"\claim{")[1:]:
        name, rest = braces("{" + part)
        for key in re.findall(r"\\val\{([^}]*)\}", braces(rest)[0]):
            if key not in numbers:
                lacking[name] = key
    return lacking


INSTEAD = {
    "reproduced": "Reproduced, but without all numbers of this sentence:",
    "not reproduced": "Not reproduced on these rows:",
    "underpowered": "These rows cannot establish whether",
}


def tex_of_claims(verdicts, numbers, environments):
    """\\setclaim{id}{sentence} for each claim that is not reproduced, or whose sentence in the paper has a number
    that the rows do not give, with the sentence that the paper prints instead; the numbers of claims; and
    \\claimtable, the lines of the table of claims."""
    paper = "".join((PAPER / name).read_text(encoding="utf-8") for name in ("paper.tex", "supplement.tex"))
    lacking = numbers_lacking(re.sub(r"^(\\newcommand|%).*\n", "", paper, flags=re.M), numbers)
    count = Counter(of.verdict for of in verdicts)
    tests = sum(of.reason.startswith("no rows say it") for of in verdicts)
    for of in verdicts:
        if of.verdict != "reproduced" or of.id in lacking:
            measured = "; ".join(
                part for part in (of.figure != "-" and f"measured: {of.figure}", of.reason != "-" and of.reason) if part
            )
            yield rf"\setclaim{{{of.id}}}{{\emph{{{INSTEAD[of.verdict]}}} {plain(of.sentence)} ({plain(measured)}).}}"
    for name, number in (
        ("all", len(verdicts)),
        ("reproduced", count["reproduced"]),
        ("not-reproduced", count["not reproduced"]),
        ("tests", tests),
        ("underpowered", count["underpowered"] - tests),
        ("environments", ", ".join(sorted(set(environments.values())))),
    ):
        yield rf"\setval{{claims/{name}}}{{{number}}}"
    yield r"\newcommand{\claimtable}{%"
    for of in verdicts:
        capital = of.sentence[:1].upper() + of.sentence[1:]
        yield rf"{plain(capital)} & {of.verdict} & {plain('' if of.figure == '-' else of.figure)} \\"
    yield "}"


# --- the page


def report(results, verdicts, environments):
    yield f"claims on the rows of {results}"
    for environment, count in sorted(Counter(environments.values()).items()):
        yield f"environment {environment}: {count} studies"
    missing = {}
    for of in verdicts:
        figure, reason = "" if of.figure == "-" else f"{of.figure}  ", "" if of.reason == "-" else f"({of.reason})"
        yield f"{of.verdict:<15s} {of.id:<18s} {figure}{reason}"
        if of.verdict != "reproduced":
            yield f"{'':34s} {of.sentence}"
        if study := re.fullmatch("no rows of ([a-z-]+)", of.reason):
            files = [f"experiments/{folder}{study[1]}.study" for folder in ("", "full/")]
            missing |= {file: True for file in files if (ROOT / file).is_file()}
    if missing:
        yield f"for the missing rows: cuvette study run {' '.join(missing)}"
    count = Counter(of.verdict for of in verdicts)
    yield (
        f"{len(verdicts)} claims: {count['reproduced']} reproduced, {count['not reproduced']} not reproduced, "
        f"{count['underpowered']} underpowered"
    )


def write(path, lines):
    path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")


def main(results, out):
    if not pathlib.Path(results).is_dir():
        fail(f"there is no folder {results}; give one with RESULTS=DIR")
    folder, out = pathlib.Path(results).resolve(), pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    environments = environments_of(folder / "tables")
    if not environments:
        fail(f"no tables of rows in {results}/tables; run make experiments, or give another folder with RESULTS=DIR")
    numbers, tables, verdicts = numbers_of(folder), Tables(folder / "tables"), []
    write(out / "numbers.tex", [
        "% made by paper/claims.py; change rows or scripts, not this",
        *(rf"\setval{{{key}}}{{{shown.tex}}}" for key, shown in sorted(numbers.items()))])  # fmt: skip
    for claim in claims_of(PAPER / "claims.tsv"):
        try:
            verdicts.append(judge(claim, tables, numbers, environments))
        except Malformed as wrong:
            fail(f"claims.tsv: claim {claim['id']}: {wrong}")
    write(out / "claims.tsv", ["\t".join(of[:5]) for of in verdicts])
    write(out / "claims.tex", tex_of_claims(verdicts, numbers, environments))
    for line in report(results, verdicts, environments):
        print(line)
    return int(any(of.verdict == "not reproduced" for of in verdicts))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        fail("usage: paper/claims.py RESULTS OUT")
    sys.exit(main(*sys.argv[1:]))
