"""What must hold after a power cut: the rules by which tests/power/power_cuts.py judges a tree.

A row is acknowledged when fsync of its file has returned; any other file when the program has gone on after it, which
is certain when the program has ended with status 0. The promise is in cuvette-study(1).
"""

import csv
import io
import json
import os
import re
import subprocess


def is_temporary(path):
    return os.path.basename(path).startswith(".cuvette-")


def is_table(path):
    return path.endswith(".csv")


def is_torn(path):
    return path.endswith(".torn.csv")


def whole_lines(content):
    """The complete lines of a table: with their newline, and without bytes that were never written."""
    return [line for line in content.split(b"\n")[:-1] if b"\0" not in line]


class Reader:
    """tests/power/reader.c"""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, *request):
        self.process.stdin.write("\t".join(request) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().rstrip("\n").split("\t")
        if answer[0] != "ok":
            return None, answer[-1] or "the reader has ended"
        return [c for c in answer[1].split(",") if c], answer[2]


class Promise:
    """What a log has promised up to an event: rows, files, and what belongs to which cell or frame."""

    def __init__(self, disk):
        self.lines = {}  # path of a table: its acknowledged lines
        self.versions = {}  # path of another file: every content that it had while complete
        self.done = {}  # path: the index in versions that is acknowledged
        self.unsynced = {}
        for path, content in all_files(disk):
            self.enter(path, content)
            self.done[path] = 0

    def enter(self, path, content):
        if is_table(path):
            self.lines[path] = rows_of(content)
        else:
            self.versions.setdefault(path, []).append(content)

    def before(self, disk, fields):
        kind = fields[0]
        if kind == "unlink" or kind == "rename":
            path = disk.relative(fields[1])
            self.done.pop(path, None)
            self.lines.pop(path, None)

    def after(self, disk, fields):
        kind = fields[0]
        if kind in ("link", "rename"):
            path = disk.relative(fields[2])
            folder, name = disk.place(fields[2])
            if is_table(path): # a table that is replaced keeps its lines, by the rules of merge: see the rows
                self.lines[path] = set()
            else:
                self.enter(path, folder.now[name].now)
        elif kind == "truncate":
            for path, content in all_files(disk): # worker rows without their row are moved aside
                if path in self.lines:
                    self.lines[path] &= rows_of(content)
        elif kind == "sync":
            node = disk.by_number.get(int(fields[1]))
            for path, content in all_files(disk):
                if is_table(path) and not is_torn(path) and folder_node(disk, path) is node:
                    self.lines[path] = rows_of(content)

    def program_ended(self, disk):
        for path, content in all_files(disk):
            if is_table(path):
                self.lines[path] = rows_of(content)
            elif not is_temporary(path):
                self.done[path] = len(self.versions[path]) - 1


def all_files(disk):
    def below(node, path):
        for name, child in node.now.items():
            if child.is_folder:
                yield from below(child, path + name + "/")
            else:
                yield path + name, child.now

    return below(disk.top, "")


def folder_node(disk, path):
    node = disk.top
    for step in path.split("/"):
        node = node.now[step]
    return node


def check_files(files, promise):
    """Files are complete or absent, and none that was acknowledged is missing."""
    for path, content in files.items():
        if path.endswith("/") or is_table(path) or is_temporary(path):
            continue
        known = promise.versions.get(path, [])
        if content not in known[promise.done.get(path, 0):]:
            yield f"{path} is incomplete, or older than one that was acknowledged"
    for path in promise.done:
        if path not in files:
            yield f"{path} was acknowledged and is missing"


def check_tables(files, promise):
    """No acknowledged line of a table is missing, and none is there twice."""
    for path, lines in promise.lines.items():
        if is_torn(path):
            continue
        if lines and path not in files:
            yield f"{path} was acknowledged and is missing"
            continue
        there = whole_lines(files.get(path, b""))
        if len(set(there)) != len(there):
            yield f"{path} has a line twice"
        missing = lines - set(there)
        if missing:
            yield f"{path} lacks {len(missing)} acknowledged lines"


def rows_of(content):
    """The lines after the header."""
    return set(whole_lines(content)[1:])


def column(content, name):
    """The values of a column in complete lines."""
    text = b"".join(line + b"\n" for line in whole_lines(content)).decode()
    return [row[name] for row in csv.DictReader(io.StringIO(text)) if row.get(name)]


def check_belonging(files, belongs):
    """An image with the number of a cell is that of the cell, by images/cells.tsv; a frame is that of the animation in
    its index. belongs: (cell or animation, name) to content, from complete runs."""
    for path, content in files.items():
        for owner, name in owners(files, path):
            if belongs.get((owner, name), content) != content:
                yield f"{path} is not the image of {owner}"


def owners(files, path):
    match = re.fullmatch(r"(.*/images/)(\d+)(\.png)", path)
    if match:
        for line in files.get(match[1] + "cells.tsv", b"").decode().splitlines()[1:]:
            number, identity = line.split("\t")
            if int(number) == int(match[2]):
                yield identity, match[3]
    match = re.fullmatch(r"((?:.*/)?)f(\d+)\.png", path)
    index = files.get(match[1] + "f%d.png.json") if match else None
    if index:
        yield json.loads(index)["definition"], match[2]


def learn_belonging(files, belongs):
    for path, content in files.items():
        for owner, name in owners(files, path):
            belongs[owner, name] = content
