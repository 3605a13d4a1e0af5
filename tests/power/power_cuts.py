#!/usr/bin/env python3
"""Power cuts: runs the program on the cases of tests/power/cases.py while record.c records what it does to files, and
judges every tree that a power cut at any moment can leave (model.py) by the rules of check.py. A part of the trees is
also resumed by the program itself.

power_cuts.py PROGRAM RECORDER READER [--states N] [--resumed N] [--seed N] [--only CASE]
--states: different trees to judge, of each case at most; --resumed: trees to resume, of each case.
"""

import argparse
import os
import random
import shutil
import sys
import tempfile

import cases
import check
import model


class Folder:
    """A tree on disk, of which only what differs is written."""

    def __init__(self, path):
        self.path = path
        self.files = {}
        os.mkdir(path)

    def show(self, files):
        for path in sorted(set(self.files) - set(files), reverse=True):
            (os.rmdir if path.endswith("/") else os.unlink)(os.path.join(self.path, path))
        for path, content in sorted(files.items()):
            if self.files.get(path) == content:
                continue
            if path.endswith("/"):
                os.mkdir(os.path.join(self.path, path))
            else:
                with open(os.path.join(self.path, path), "wb") as file:
                    file.write(content)
        self.files = files

    def forget(self):
        """After a program has changed it."""
        shutil.rmtree(self.path)
        os.mkdir(self.path)
        self.files = {}


class Trial:
    """One case: its log, the trees, and the verdicts."""

    def __init__(self, case, options, work):
        self.case, self.options = case, options
        self.random = random.Random(options.seed)
        self.folder = Folder(os.path.join(work, "cut"))
        self.reader = check.Reader(options.reader)
        self.reached = self.judged = self.resumed = 0
        self.chosen = []
        self.answers = {}  # tree: what the reader said
        self.faults = {}
        self.belongs = {}
        self.rows = {}  # check of each row that was written

    def fault(self, text, files):
        first = text not in self.faults
        self.faults[text] = self.faults.get(text, 0) + 1
        if first and len(self.faults) <= 5:
            tables = ", ".join(f"{p} {len(c)}" for p, c in sorted(files.items()) if not p.endswith("/"))
            print(f"# {self.case.name}: {text}\n#   in: {tables[:600]}")

    def read(self, files, key):
        """The rows of the tree, before and after the start of a run."""
        if key not in self.answers:
            self.folder.show(files)
            results = self.case.results(self.folder.path)
            self.answers[key] = self.reader.ask(self.case.study, results, "read")
            if self.random.random() < self.options.started:
                again = self.reader.ask(self.case.study, results, "resume")
                self.folder.forget()
                if again[0] is None or set(again[0]) != set(self.answers[key][0] or again[0]):
                    self.fault(f"a run starts with other rows, or not at all: {again[1]}", files)
                elif again[1]:
                    self.fault(f"after the start of a run: {again[1]}", files)
        return self.answers[key]

    def check_rows(self, files, key, promise):
        found, wrong = self.read(files, key)
        if found is None:
            self.fault(f"the rows cannot be read: {wrong}", files)
            return
        if wrong:
            self.fault(f"the rows are at fault: {wrong[:100]}", files)
        if len(set(found)) != len(found):
            self.fault("a row is there twice", files)
        if set(found) - self.rows.keys():
            self.fault("a row is there that was not written", files)
        lost = (promise.rows & self.known) - set(found)
        if lost:
            self.fault(f"{len(lost)} acknowledged rows are lost", files)

    def judge(self, files, promise):
        key = tuple(sorted((path, hash(content)) for path, content in files.items()))
        new = key not in self.answers
        self.judged += new
        for text in check.check_files(files, promise):
            self.fault(text, files)
        for text in check.check_tables(files, promise):
            self.fault(text, files)
        for text in check.check_belonging(files, self.belongs):
            self.fault(text, files)
        if self.case.study:
            self.check_rows(files, key, promise)
        else:
            self.answers[key] = None
        if new:
            self.choose(files)

    def choose(self, files):
        """A random choice of the trees to resume (reservoir sampling)."""
        if len(self.chosen) < self.options.resumed:
            self.chosen.append(files)
        elif self.random.random() < self.options.resumed / self.judged:
            self.chosen[self.random.randrange(len(self.chosen))] = files

    def resume(self, files):
        """Runs the last command of the case again on the tree, and compares with the run that was not cut."""
        self.resumed += 1
        self.folder.show(files)
        said = self.case.resume(self.options.program, self.folder.path)
        if said:
            self.fault(f"resuming fails: {said}", files)
        else:
            for text in self.case.check_resumed(self.folder.path, self.final):
                self.fault(f"after resuming: {text}", files)
        self.folder.forget()

    def play(self, disk, events):
        promise = check.Promise(disk)
        promise.rows = set()
        fraction = self.options.states // sum(fields[0] in ("sync", "done") for fields in events) + 1
        for fields in events:
            promise.before(disk, fields)
            if fields[0] in ("sync", "done"):
                self.cut(disk, promise, fraction)
            if fields[0] == "done":
                promise.program_ended(disk)
                self.acknowledge_rows(disk, promise, None)
            else:
                disk.event(fields)
                promise.after(disk, fields)
                if fields[0] == "sync":
                    self.acknowledge_rows(disk, promise, disk.by_number.get(int(fields[1])))
        self.cut(disk, promise, fraction)

    def cut(self, disk, promise, most):
        """A power cut now: judges as many trees as asked that have not been met before."""
        trees = list(model.states(disk, self.options.states_per_cut, self.random))
        self.reached += len(trees)
        first, others = trees[:most // 2], trees[most // 2:]  # the first are the extremes of each change
        self.random.shuffle(others)
        before = self.judged
        for files in first + others:
            if self.judged - before < most:
                self.judge(files, promise)

    def acknowledge_rows(self, disk, promise, node):
        """The rows of the table that was flushed, or of all tables."""
        for path, content in check.all_files(disk):
            if cases.is_rows(path) and (node is None or check.folder_node(disk, path) is node):
                promise.rows.update(check.column(content, "checksum"))

    def learn(self, disk, events):
        """What belongs where, from every complete run of the case."""
        check.learn_belonging(model.present(disk), self.belongs)
        for fields in events:
            if fields[0] == "done":
                check.learn_belonging(model.present(disk), self.belongs)
            else:
                disk.event(fields)
            if fields[0] in ("write", "rename"):
                for path, content in check.all_files(disk):
                    if cases.is_rows(path):
                        self.rows.update(dict.fromkeys(check.column(content, "checksum")))

    def run(self, recorded):
        log, self.final, begin = recorded.events, recorded.final, recorded.begin
        disk = begin()
        self.learn(disk, log)
        if model.present(disk) != self.final:
            self.fault("the log does not give the files on disk", self.final)
            return
        if self.case.study:
            self.folder.show(self.final)
            self.known = set(self.reader.ask(self.case.study, self.case.results(self.folder.path), "read")[0])
        self.play(begin(), log)
        for files in self.chosen:
            self.resume(files)


def read_options():
    parser = argparse.ArgumentParser()
    for name in ("program", "recorder", "reader"):
        parser.add_argument(name, type=os.path.abspath)
    parser.add_argument("--states", type=int, default=1000)
    parser.add_argument("--states-per-cut", type=int, default=2000)
    parser.add_argument("--started", type=float, default=0.05)
    parser.add_argument("--resumed", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only")
    return parser.parse_args()


def main():
    options = read_options()
    base = os.environ.get("TMPDIR") or ("/dev/shm" if os.access("/dev/shm", os.W_OK) else None)
    work = tempfile.mkdtemp(prefix="cuvette-power-", dir=base)
    total = [0, 0, 0]
    bad = number = 0
    try:
        for case in cases.all_cases(work):
            if options.only and options.only != case.name:
                continue
            number += 1
            trial = Trial(case, options, case.folder)
            trial.run(case.record(options.program, options.recorder))
            text = f"{case.name}: {trial.reached} states, {trial.judged} different, {trial.resumed} resumed"
            print(f"{'not ok' if trial.faults else 'ok'} {number} - {text}", flush=True)
            for fault, count in trial.faults.items():
                print(f"#   {count} times: {fault}")
            bad += bool(trial.faults)
            total = [a + b for a, b in zip(total, (trial.reached, trial.judged, trial.resumed))]
    finally:
        shutil.rmtree(work, ignore_errors=True)
    print(f"# {total[0]} states after power cuts, {total[1]} different trees judged, {total[2]} resumed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
