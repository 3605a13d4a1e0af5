"""Put mutants into a copy of the sources: instrument.py TREE COUNT SEED.

All are compiled into one program, which runs the one whose number is in the environment variable MUTANT, so that the
copy is built once. Of all places of src/optics, src/geometry, src/render and src/study that can be changed, COUNT are
drawn, half of them as many from each folder; no two of them overlap. TREE/mutants.tsv lists them: number, file, line,
kind, text, changed text, the whole line. A place is a comparison, a sum, a product, a logical operator, a negation, a
number with a point, or a statement that can be left out."""

import bisect
import os
import random
import re
import subprocess
import sys

import clang.cindex as ci

FOLDERS = ("optics", "geometry", "render", "study")
CHANGES = {  # operators of C and what a slip of the pen makes of them
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "&&": ("||",), "||": ("&&",),
}
REALS = (ci.TypeKind.DOUBLE, ci.TypeKind.FLOAT)
KEEPS = re.compile(r"\b(free|assert|\w*_destroy|\w*_release|memset|munmap|close|fclose|abandon\w*|set_large_pages)\b")
HEADER = """/* Which mutant runs; see tests/mutants/instrument.py. */
#pragma once
extern int mutant_active;
extern unsigned char mutant_reached[1 << 14];
#define MUTANT(number) (mutant_reached[number] = 1, mutant_active == (number))
"""
SOURCE = """#include "base/mutant.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
int mutant_active;
unsigned char mutant_reached[1 << 14];
__attribute__((constructor)) static void choose(void)
{
    const char *number = getenv("MUTANT");
    mutant_active = number ? atoi(number) : 0;
}
__attribute__((destructor)) static void report(void)
{
    const char *path = getenv("MUTANT_REACHED");
    const int file = path ? open(path, O_WRONLY | O_CREAT | O_APPEND, 0666) : -1;
    for (int i = 1; file >= 0 && i < (int)sizeof mutant_reached; i++)
        if (mutant_reached[i])
            dprintf(file, "%d\\n", i);
}
"""


def arguments():
    packages = ["libpng", "zlib", "libjpeg", "OpenEXR", "hwloc", "yaml-0.1", "jansson"]
    flags = subprocess.run(["pkg-config", "--cflags", *packages], capture_output=True, text=True, check=True).stdout
    own = subprocess.run(["gcc", "-print-file-name=include"], capture_output=True, text=True, check=True).stdout.strip()
    own = own if not os.path.isdir("/usr/lib/clang/14/include") else "/usr/lib/clang/14/include"
    return ["-std=gnu17", "-D_GNU_SOURCE", "-Isrc", "-DKERNEL_ISA=sse2", '-DCUVETTE_VERSION="0"',
            '-DCUVETTE_COMPILER_FLAGS=""', "-isystem", own, *flags.split()]


class Places:
    """The places of one translation unit that lie in the folders, found once for each file."""

    def __init__(self):
        self.texts, self.found = {}, {}

    def text(self, path):
        if path not in self.texts:
            with open(path, "rb") as file:
                self.texts[path] = file.read()
        return self.texts[path]

    def add(self, path, start, end, kind, changed):
        self.found.setdefault((path, start, end, changed), kind)

    def walk(self, node, ancestors):
        for child in node.get_children():
            where = child.location.file
            if where is None or (not ancestors and not is_ours(where.name)):
                continue
            self.visit(child, ancestors)
            self.walk(child, [*ancestors, child])

    def visit(self, node, ancestors):
        start, end = node.extent.start, node.extent.end
        if start.file is None or end.file is None or start.file.name != end.file.name or not is_ours(start.file.name):
            return
        if not any(a.kind == ci.CursorKind.FUNCTION_DECL for a in ancestors) or is_constant(ancestors):
            return
        path, kind = os.path.normpath(start.file.name), node.kind
        text = self.text(path)[start.offset:end.offset].decode()
        if kind == ci.CursorKind.BINARY_OPERATOR:
            self.operator(path, node, text)
        elif kind == ci.CursorKind.UNARY_OPERATOR and text[:1] in ("-", "!") and text[1:2] != "-":
            self.add(path, start.offset, end.offset, "negation", "!" + text if text[0] == "!" else text[1:])
        elif kind == ci.CursorKind.FLOATING_LITERAL and re.fullmatch(r"[0-9.e+-]+", text) and float(text) != 0:
            self.add(path, start.offset, end.offset, "number", f"({text} * 1.01)")
        if ancestors[-1].kind == ci.CursorKind.COMPOUND_STMT and self.can_go(path, node, text, end.offset):
            self.add(path, start.offset, end.offset, "statement", "")

    def operator(self, path, node, text):
        left, right = list(node.get_children())
        if left.extent.end.file is None or left.extent.start.offset != node.extent.start.offset:
            return
        if right.extent.end.offset != node.extent.end.offset:
            return
        all_text = self.text(path)
        between = all_text[left.extent.end.offset:right.extent.start.offset].decode()
        if between.strip() == "-" and right.type.get_canonical().kind == ci.TypeKind.POINTER:
            return  # pointers have no sum
        for changed in CHANGES.get(between.strip(), ()):
            if between.strip() in "*/" and node.type.get_canonical().kind not in REALS:
                continue
            self.add(path, node.extent.start.offset, node.extent.end.offset, "operator",
                     all_text[node.extent.start.offset:left.extent.end.offset].decode() + " " + changed + " " +
                     all_text[right.extent.start.offset:node.extent.end.offset].decode())

    def can_go(self, path, node, text, end):
        kinds = (ci.CursorKind.CALL_EXPR, ci.CursorKind.COMPOUND_ASSIGNMENT_OPERATOR)
        assigns = node.kind == ci.CursorKind.BINARY_OPERATOR and re.match(r"[^=!<>]*[^=!<>]=[^=]", text)
        return (node.kind in kinds or assigns) and self.text(path)[end:end + 1] == b";" and not KEEPS.search(text)


def is_ours(path):
    parts = os.path.normpath(path).split(os.sep)
    return len(parts) > 2 and parts[0] == "src" and parts[1] in FOLDERS


def is_constant(ancestors):
    """Whether the compiler must know the value."""
    for above, below in zip(ancestors, ancestors[1:] + [None]):
        if above.kind in (ci.CursorKind.ENUM_CONSTANT_DECL, ci.CursorKind.FIELD_DECL, ci.CursorKind.CASE_STMT) and (
                above.kind != ci.CursorKind.CASE_STMT or below is None):
            return True
        if above.kind == ci.CursorKind.VAR_DECL:
            is_array = above.type.get_canonical().kind == ci.TypeKind.CONSTANTARRAY
            if above.storage_class == ci.StorageClass.STATIC or (is_array and below is None):
                return True
    return False


def find():
    places = Places()
    index, flags = ci.Index.create(), arguments()
    for folder in FOLDERS:
        for root, _, names in sorted(os.walk(os.path.join("src", folder))):
            for name in sorted(names):
                if name.endswith(".c"):
                    unit = index.parse(os.path.join(root, name), args=flags)
                    errors = [d for d in unit.diagnostics if d.severity >= ci.Diagnostic.Error]
                    if errors:
                        sys.exit(f"instrument.py: {errors[0]}")
                    places.walk(unit.cursor, [])
    return places


def draw(places, count, seed):
    """Half of them evenly from the folders, half from all places; none that touches another."""
    chance = random.Random(seed)
    order = sorted(places.found)
    chance.shuffle(order)
    taken, by_folder = {}, dict.fromkeys(FOLDERS, 0)

    def take(place):
        path, start, end, _ = place
        spans = taken.setdefault(path, [])
        at = bisect.bisect_left(spans, (start,))
        if at > 0 and spans[at - 1][1] > start or at < len(spans) and spans[at][0] < end:
            return False
        bisect.insort(spans, (start, end, place))
        by_folder[path.split(os.sep)[1]] += 1
        return True

    total = 0
    for fair in (True, False):
        for place in order:
            if total >= (count // 2 if fair else count):
                break
            if fair and by_folder[place[0].split(os.sep)[1]] >= count // 2 // len(FOLDERS):
                continue
            total += take(place)
    return sorted(place for spans in taken.values() for _, _, place in spans)


def rewrite(places, chosen):
    rows, by_file = [], {}
    for number, place in enumerate(chosen, 1):
        by_file.setdefault(place[0], []).append((number, place))
    for path, own in by_file.items():
        text = places.text(path)
        pieces, at = [], 0
        for number, (_, start, end, changed) in own:
            old = text[start:end].decode()
            new = f"(MUTANT({number}) ? ({changed}) : ({old}))" if changed else f"if (!MUTANT({number})) {old}"
            pieces += [text[at:start].decode(), new]
            at = end
            line = text[:start].count(b"\n") + 1
            whole_line = text.split(b"\n")[line - 1].decode().strip()
            shown = [re.sub(r"\s+", " ", t) for t in (old, changed, whole_line)]
            rows.append([number, path, line, places.found[(path, start, end, changed)], *shown])
        pieces.append(text[at:].decode())
        whole = "".join(pieces)
        include = '#include "base/mutant.h"\n'
        once = "#pragma once\n"
        whole = whole.replace(once, once + include, 1) if path.endswith(".h") else include + whole
        with open(path, "w") as file:
            file.write(whole)
    with open("mutants.tsv", "w") as file:
        file.writelines("\t".join(map(str, row)) + "\n" for row in sorted(rows))


def main():
    tree, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    os.chdir(tree)
    places = find()
    print(f"{len(places.found)} places", file=sys.stderr)
    rewrite(places, draw(places, count, seed))
    with open("src/base/mutant.h", "w") as file:
        file.write(HEADER)
    with open("src/base/mutant.c", "w") as file:
        file.write(SOURCE)


main()
