"""Fixtures of the tests: the program to compare with, and a small scene."""

import os
import pathlib
import subprocess

import pytest

import cuvette

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROD = str(ROOT / "experiments/scenes/rod.yaml")


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
