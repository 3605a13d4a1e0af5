#!/usr/bin/env -S python3 -B
"""Print the circles among the objects of a build, as the linker sees them: circles.py [--why] SOURCES FOLDER...

An object needs another one if that defines a symbol which it leaves undefined. The objects of a source, for several
instruction sets or from several FOLDERs (build/obj, build/plain), count as one, named by the path of the source below
SOURCES without its ending; objects whose source has gone are left out. One line per circle: its objects, in
alphabetical order. --why: indented, who needs whom, and the symbols."""

import collections
import pathlib
import subprocess
import sys


def objects(sources, folders):
    """Object files by the name of their source."""
    found = collections.defaultdict(list)
    for folder in map(pathlib.Path, folders):
        for path in folder.rglob("*.o"):
            name = path.relative_to(folder).with_name(path.name.split(".")[0])  # x_kernel.avx2.o is of x_kernel.c
            if (sources / name).with_suffix(".c").exists():
                found[str(name)].append(str(path))
    return found


def needs(found):
    """For each name the names that it needs, with the symbols."""
    name_of = {path: name for name, paths in found.items() for path in paths}
    listing = subprocess.run(["nm", "-A", "-P", "-g", *name_of], check=True, capture_output=True, text=True).stdout
    undefined, defined_in = collections.defaultdict(set), {}
    for line in listing.splitlines():
        path, symbol, kind = line.split()[:3]
        name = name_of[path.rstrip(":")]
        if kind == "U":
            undefined[name].add(symbol)
        elif kind not in "vw":
            defined_in[symbol] = name
    graph = {name: collections.defaultdict(set) for name in found}
    for name, symbols in undefined.items():
        for symbol in symbols & defined_in.keys():
            graph[name][defined_in[symbol]].add(symbol)
    return graph


def reachable(graph, start):
    seen, left = set(), [start]
    while left:
        for name in graph[left.pop()]:
            if name not in seen:
                seen.add(name)
                left.append(name)
    return seen


def circles(graph):
    """Objects of which each needs all others, directly or through others; the largest circles first."""
    reach = {name: reachable(graph, name) for name in graph}
    found = {tuple(sorted(other for other in reach[name] if name in reach[other])) for name in graph}
    return sorted((circle for circle in found if len(circle) > 1), key=lambda circle: (-len(circle), circle))


def main(arguments):
    why = arguments[:1] == ["--why"]
    sources, *folders = arguments[why:]
    graph = needs(objects(pathlib.Path(sources), folders))
    for circle in circles(graph):
        print(*circle)
        for name in circle if why else ():
            for other in sorted(graph[name].keys() & set(circle) - {name}):
                print(f"    {name} needs {other}:", *sorted(graph[name][other]))


main(sys.argv[1:])
