#!/usr/bin/env python3
"""What a render from Python costs compared with the command: rounds that alternate between the two, medians.

    PYTHONPATH=build/python python3 experiments/python_bench.py [ROUNDS] [PROGRAM]

A frame of the command: the time of `cuvette render --repeat N + 1` less that of `--repeat 1`, divided by N. A frame
from Python: that of N calls of scene.render(), divided by N. Wall time suffers from other programs, CPU time hardly.
Columns: size, s by the command, s from Python, ratio; the last three of CPU time."""

import os
import statistics
import subprocess
import sys
import time

import cuvette

SCENE = "experiments/scenes/rod.yaml"


def process(program: str, size: tuple, frames: int) -> tuple:
    """Wall and CPU time of one process."""
    sets = [part for name, value in zip(("width", "height"), size) for part in ("--set", f"render.{name}={value}")]
    began = time.perf_counter()
    child = subprocess.Popen(
        [program, "render", SCENE, *sets, "--repeat", str(frames), "--json"], stdout=subprocess.DEVNULL
    )
    usage = os.wait4(child.pid, 0)[2]
    child.returncode = 0
    return time.perf_counter() - began, usage.ru_utime + usage.ru_stime


def by_command(program: str, size: tuple, frames: int) -> tuple:
    one, many = process(program, size, 1), process(program, size, frames + 1)
    return tuple((b - a) / frames for a, b in zip(one, many))


def by_python(scene: cuvette.Scene, frames: int) -> tuple:
    began, cpu_began = time.perf_counter(), time.process_time()
    for _ in range(frames):
        scene.render().hash  # the command compares the hashes of its frames
    return (time.perf_counter() - began) / frames, (time.process_time() - cpu_began) / frames


def main(rounds: int = 11, program: str = "build/cuvette") -> None:
    print("size\tcommand_s\tpython_s\tratio\tcommand_cpu_s\tpython_cpu_s\tratio")
    for size, frames in (((80, 60), 500), ((400, 300), 40), ((800, 600), 10)):
        scene = cuvette.read(SCENE).set(width=size[0], height=size[1])
        scene.render().hash  # the command compares the hashes of its frames
        times: list = [[], []]
        for turn in range(rounds):
            for which in (0, 1) if turn % 2 else (1, 0):
                times[which].append(by_python(scene, frames) if which else by_command(program, size, frames))
        command, python = ([statistics.median(column) for column in zip(*one)] for one in times)
        columns = [f"{a:.6f}\t{b:.6f}\t{b / a:.4f}" for a, b in zip(command, python)]
        print(f"{size[0]}x{size[1]}", *columns, sep="\t", flush=True)


if __name__ == "__main__":
    main(*(int(a) if a.isdigit() else a for a in sys.argv[1:]))
