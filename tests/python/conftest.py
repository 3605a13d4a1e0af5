"""Fixtures of the tests: the program to compare with, and a small scene; waiting for a child process at work."""

import os
import pathlib
import subprocess
import time

import pytest

import cuvette

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROD = str(ROOT / "experiments/scenes/rod.yaml")


def cpu_s(child: subprocess.Popen) -> float:
    """The CPU time that a child process has used."""
    fields = pathlib.Path(f"/proc/{child.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def compute(child: subprocess.Popen, seconds: float) -> float:
    """Waits until a child process has used that much more CPU time, or has ended; returns its CPU time."""
    until = cpu_s(child) + seconds
    while child.poll() is None and cpu_s(child) < until:
        time.sleep(0.02)
    return cpu_s(child)


@pytest.fixture
def program():
    """Runs the program of the same build and returns what it prints."""

    def run(*arguments: str) -> str:
        path = os.environ.get("CUVETTE", str(ROOT / "build/cuvette"))
        return subprocess.run([path, *arguments], check=True, capture_output=True, text=True, cwd=ROOT).stdout

    return run


@pytest.fixture
def rod() -> cuvette.Scene:
    """The rod in a glass of water, 80 x 60 pixels."""
    return cuvette.read(ROD).set(width=80, height=60)
