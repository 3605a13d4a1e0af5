"""What can be on a disk after a power cut, from a log of tests/power/record.c.

POSIX promises only this: what was written to a file before fsync returned is there, and what was entered in a folder
(created, linked, renamed, removed) before fsync of the folder returned. Everything since is there or not, in any order;
a write also in part: cut anywhere, or with sectors that were never written and read as zeros. A rename is one change.
Pillai et al., "All File Systems Are Not Created Equal", OSDI 2014, calls these the states of an abstract file system.
"""

import itertools
import os

SECTOR = 512
SUBSETS = 7  # every subset is tried of this many changes


class Node:
    """A file or folder: as it is for programs (now), as it is on disk at least (durable), and the changes between."""

    def __init__(self, is_folder, content):
        self.is_folder = is_folder
        self.now = content
        self.durable = content
        self.pending = []
        self.states = None  # a cache of options()

    def change(self, change):
        self.now = apply(self.now, change)
        self.pending.append(change)
        self.states = None

    def sync(self):
        self.durable = self.now
        self.pending = []
        self.states = None

    def options(self):
        """Everything that a power cut can leave of it."""
        if self.states is None:
            self.states = (folder_states if self.is_folder else file_states)(self.durable, self.pending)
        return self.states


def apply(content, change):
    if isinstance(content, dict):
        changed = dict(content)
        for name, node in change.items():
            if node is None:
                changed.pop(name, None)
            else:
                changed[name] = node
        return changed
    kind, at, data = change
    if kind == "truncate":
        return content[:at] + bytes(max(0, at - len(content)))
    if at > len(content):
        content += bytes(at - len(content))
    return content[:at] + data + content[at + len(data):]


def parts(content, change):
    """A write that was done in part."""
    kind, at, data = change
    if kind != "write":
        return
    size = len(data)
    yield apply(content, ("write", at, bytes(size)))
    first = SECTOR - at % SECTOR
    sectors = [0, *range(first, size, SECTOR), size]
    for a, b in zip(sectors, sectors[1:]):
        if b - a < size:
            yield apply(content, ("write", at, data[:a] + bytes(b - a) + data[b:]))
            yield apply(content, ("write", at, bytes(a) + data[a:b] + bytes(size - b)))
    cuts = range(size - 1, 0, -1) if size <= 2000 else sorted({1, 2, size // 2, size - 1, *range(SECTOR, size, SECTOR)})
    for cut in cuts:
        yield apply(content, ("write", at, data[:cut]))


def subsets(pending):
    """Subsets of the changes, in order: all, or for many changes prefixes and those that lack or have one."""
    count = len(pending)
    if count <= SUBSETS:
        for chosen in itertools.product((True, False), repeat=count):
            yield [p for p, there in zip(pending, chosen) if there]
        return
    for k in range(count + 1):
        yield pending[:k]
        yield pending[k:]
        yield pending[:k] + pending[k + 1:]
        yield pending[k:k + 1]


def distinct(contents, key):
    seen = {}
    for content in contents:
        seen.setdefault(key(content), content)
    return list(seen.values())


def after(content, changes):
    for change in changes:
        content = apply(content, change)
    return content


def file_states(durable, pending):
    def all_states():
        for chosen in subsets(pending):
            yield after(durable, chosen)
        content = durable
        for change in pending:
            yield from parts(content, change)
            content = apply(content, change)

    return distinct(all_states(), lambda content: content)


def folder_states(durable, pending):
    def all_states():
        for chosen in subsets(pending):
            yield after(durable, chosen)

    return distinct(all_states(), lambda entries: frozenset((name, id(node)) for name, node in entries.items()))


def snapshot(path):
    """The number and the content of a file, or of a folder and all below."""
    if os.path.isdir(path):
        content = {name: snapshot(os.path.join(path, name)) for name in sorted(os.listdir(path))}
    else:
        with open(path, "rb") as file:
            content = file.read()
    return os.stat(path).st_ino, content


class Disk:
    """The folder root, at first with the files of a snapshot, changed by the events of a log."""

    def __init__(self, root, files):
        self.root = os.path.realpath(root)
        self.by_number = {}
        self.top = self.take(files)

    def take(self, files):
        number, content = files
        is_folder = isinstance(content, dict)
        if is_folder:
            content = {name: self.take(child) for name, child in content.items()}
        self.by_number[number] = Node(is_folder, content)
        return self.by_number[number]

    def relative(self, path):
        return os.path.relpath(path, self.root)

    def place(self, path):
        """The folder of a path, and the last name."""
        folder = self.top
        *above, name = self.relative(path).split(os.sep)
        for step in above:
            folder = folder.now[step]
        return folder, name

    def enter(self, path, node):
        folder, name = self.place(path)
        folder.change({name: node})

    def event(self, fields):
        kind, *rest = fields
        if kind in ("create", "tmpfile", "mkdir"):
            node = Node(kind == "mkdir", {} if kind == "mkdir" else b"")
            self.by_number[int(rest[0])] = node
            if kind != "tmpfile":
                self.enter(rest[1], node)
        elif kind == "write":
            self.by_number[int(rest[0])].change(("write", int(rest[1]), bytes.fromhex(rest[2])))
        elif kind == "truncate":
            self.by_number[int(rest[0])].change(("truncate", int(rest[1]), b""))
        elif kind == "sync":
            if int(rest[0]) in self.by_number:
                self.by_number[int(rest[0])].sync()
        elif kind == "link":
            self.enter(rest[1], self.by_number[int(rest[0])])
        elif kind in ("unlink", "rmdir"):
            self.enter(rest[0], None)
        elif kind == "rename":
            folder, name = self.place(rest[0])
            other, new = self.place(rest[1])
            assert folder is other, "a rename between folders"
            folder.change({name: None, new: folder.now[name]})
        else:
            raise ValueError(kind)

    def nodes(self):
        """Every node that a power cut can leave in the tree."""
        found, todo = {}, [self.top]
        while todo:
            node = todo.pop()
            if id(node) in found:
                continue
            found[id(node)] = node
            if node.is_folder:
                for entries in node.options():
                    todo.extend(entries.values())
        return found.values()


def tree(node, chosen, path=""):
    """The files below a folder, by path, in a state; a folder's path ends with a slash."""
    files = {}
    for name, child in chosen(node).items():
        if child.is_folder:
            files[path + name + "/"] = b""
            files.update(tree(child, chosen, path + name + "/"))
        else:
            files[path + name] = chosen(child)
    return files


def present(disk):
    return tree(disk.top, lambda node: node.now)


def states(disk, most, random):
    """Trees after a power cut now: all, or, if they are more than most, those in which one node varies while all
    others are as new or as old as possible, and random ones."""
    open_nodes = [(node, node.options()) for node in disk.nodes() if len(node.options()) > 1]
    total = 1
    for _, options in open_nodes:
        total *= len(options)

    def make(choice):
        return tree(disk.top, lambda node: choice.get(id(node), node.now))

    if total <= most:
        for combination in itertools.product(*(options for _, options in open_nodes)):
            yield make({id(node): state for (node, _), state in zip(open_nodes, combination)})
        return
    for others in ("now", "durable"):
        base = {id(node): getattr(node, others) for node, _ in open_nodes}
        for node, options in open_nodes:
            for state in options:
                yield make({**base, id(node): state})
    for _ in range(most):
        yield make({id(node): random.choice(options) for node, options in open_nodes})
