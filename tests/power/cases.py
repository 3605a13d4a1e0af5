"""The cases of power cuts: what the program does while it is recorded, and what resuming must give."""

import collections
import csv
import itertools
import os
import shutil
import subprocess

import check
import model

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.realpath(os.path.join(HERE, "../../experiments/scenes"))
SMALL = ["--set", "render.width=8", "--set", "render.height=6"]

STUDY = """study: cut
scene: {scenes}/rod.yaml
set: {{render.width: 8, render.height: 6, render.threads: 2}}
grid:{grid}
repetitions: {repetitions}
warmups: 1
{more}
"""
KEEP = "keep: {image: on, workers: on}"


def is_rows(path):
    name = os.path.basename(path)
    return name.startswith("rows") and check.is_table(name) and not check.is_torn(name)


Recorded = collections.namedtuple("Recorded", "events final begin")


class Case:
    """A folder with a study file or two, and the folder root in it, which is recorded."""

    def __init__(self, work, name, commands, before=(), studies=(), kills=()):
        self.name = name
        self.folder = os.path.join(work, name)
        self.root = os.path.join(self.folder, "root")
        os.makedirs(self.root)
        self.commands, self.before = commands, before
        self.kills = dict(kills)  # command: the event before which it is killed
        for file, text in studies:
            with open(os.path.join(self.folder, file), "w", encoding="utf-8") as out:
                out.write(text)
        self.study = os.path.join(self.folder, studies[-1][0]) if studies else ""

    def results(self, root):
        return os.path.join(root, "res")

    def call(self, program, words, root, environment=()):
        filled = [word.format(folder=self.folder, root=root, scenes=SCENES) for word in words]
        return subprocess.run([program, *filled], env={**os.environ, "LC_ALL": "C", **dict(environment)},
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)

    def record(self, program, recorder):
        for words in self.before:
            self.must(self.call(program, words, self.root))
        snapshot = model.snapshot(self.root)
        log = os.path.join(self.folder, "log")
        events = []
        for number, words in enumerate(self.commands):
            open(log, "w", encoding="utf-8").close()
            environment = {"LD_PRELOAD": recorder, "RECORD_LOG": log, "RECORD_ROOT": self.root}
            if number in self.kills:
                environment["RECORD_KILL"] = str(self.kills[number])
            ended = self.call(program, words, self.root, environment)
            with open(log, encoding="utf-8") as lines:
                events += [line.rstrip("\n").split("\t") for line in lines]
            if number in self.kills:
                assert ended.returncode == -9, f"{self.name}: it was to be killed: {ended.stdout}"
            else:
                self.must(ended)
                events.append(["done"])
        final = model.present(model.Disk(self.root, model.snapshot(self.root)))
        return Recorded(events, final, lambda: model.Disk(self.root, snapshot))

    def must(self, ended):
        if ended.returncode != 0:
            raise RuntimeError(f"{self.name}: {ended.args}: {ended.stdout}")

    def resume(self, program, root):
        """All commands again: each goes on, or has nothing to do."""
        for words, _ in itertools.groupby(self.commands):
            ended = self.call(program, words, root)
            if ended.returncode != 0 and "excluded already" not in ended.stdout:
                return ended.stdout.strip()[:300] or f"status {ended.returncode}"
        return None

    def check_resumed(self, root, final):
        there = model.present(model.Disk(root, model.snapshot(root)))
        for path, content in final.items():
            if path.endswith(".png") or path.endswith(".yaml"):
                if there.get(path) != content:
                    yield f"{path} differs from that of a run without a power cut"
            elif path not in there and not check.is_temporary(path) and not check.is_torn(path):
                yield f"{path} is missing"
        if measured(there) != measured(final):
            yield "the cells have other repetitions than after a run without a power cut"


def measured(files):
    """The repetitions of each cell; of an animation, the frames."""
    count = collections.Counter()
    merged = [path for path in files if is_rows(path) and "shard" not in path]
    for path in merged or [path for path in files if is_rows(path)]:
        text = files[path].decode(errors="replace").splitlines()
        for row in csv.DictReader(text):
            if row.get("warmup", "0") == "0":
                count[row.get("identity"), row.get("frame")] += 1
    return count


def study(grid, more=KEEP, repetitions=3):
    return STUDY.format(scenes=SCENES, grid="".join(f"\n  - {axis}" for axis in grid), more=more,
                        repetitions=repetitions)


def run(name, *more):
    return ["study", "run", "--quiet", "{folder}/" + name, "--results", "{root}/res", *more]


def animate(seconds, *more):
    return ["animate", "{scenes}/slime.yaml", "-o", "{root}/f%d.png", "--duration", seconds, "--fps", "20",
            *SMALL, "--set", "toy.level=1", *more]


def study_cases(work):
    depths = ["{render.depth: [1, 2, 3]}"]
    compared = ("a.study", study(depths, KEEP + "\nreference: {render.depth: 5}", 4))
    plain = ("a.study", study(depths))
    yield Case(work, "study", [run("a.study")], studies=[compared])
    yield Case(work, "killed and resumed", [run("a.study")] * 7, studies=[compared],
               kills={0: 9, 1: 25, 2: 33, 3: 48, 4: 60, 5: 71})
    yield Case(work, "merge", [run("a.study", "--shard", "0/2"), run("a.study", "--shard", "1/2"),
                               ["study", "merge", "{folder}/a.study", "--results", "{root}/res"]], studies=[plain])
    yield Case(work, "exclude", [["study", "exclude", "{folder}/a.study", "--results", "{root}/res", "--row", row,
                                  "--reason", "a door was slammed"] for row in ("0:1", "1:2")],
               before=[run("a.study")], studies=[plain])
    yield Case(work, "changed grid", [run("b.study")], before=[run("a.study")],
               studies=[plain, ("b.study", study(["{render.depth: [4, 3, 1]}", "{render.samples: [1]}"]))])
    yield Case(work, "more repetitions, by processes", [run("b.study")], before=[run("a.study")],
               studies=[plain, ("b.study", study(depths, KEEP + "\nprocesses: 2", 6))])


def other_cases(work):
    yield Case(work, "animation", [animate("0.2", "--rows", "{root}/rows.csv"),
                                   animate("0.2", "--rows", "{root}/rows.csv"),
                                   animate("0.3", "--rows", "{root}/rows.csv")], kills={0: 20})
    yield Case(work, "animation anew", [animate("0.2", "--set", "camera.position=[3, 1, -3]", "--restart")],
               before=[animate("0.2")])
    yield Case(work, "scene and images", [
        ["scene", "{scenes}/rod.yaml", "-o", "{root}/a.yaml", "--set", "render.depth=3"],
        ["scene", "{scenes}/rod.yaml", "-o", "{root}/a.yaml", "--set", "render.depth=2"],
        ["render", "{root}/a.yaml", "-o", "{root}/a.png", "--rays", "{root}/rays.pfm", *SMALL],
        ["render", "{root}/a.yaml", "-o", "{root}/a.png", *SMALL, "--set", "render.depth=1"]])


def all_cases(work):
    for some in (study_cases(work), other_cases(work)):
        for case in some:
            yield case
            shutil.rmtree(case.folder)
