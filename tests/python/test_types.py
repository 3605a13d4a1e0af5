"""The annotations of the module are consistent: mypy, if it is installed."""

import pathlib
import shutil
import subprocess

import cuvette
import pytest


def test_annotations(tmp_path):
    if not shutil.which("mypy"):
        pytest.skip("mypy is not installed")
    code = """
import cuvette
image: cuvette.Image = cuvette.read("rod.yaml").render(depth=8)
name: int = image.hash
"""
    (tmp_path / "user.py").write_text(code)
    folder = pathlib.Path(cuvette.__file__).parents[1]
    flags = ["--strict", "--ignore-missing-imports", "--cache-dir", str(tmp_path / "cache")]
    run = subprocess.run(["mypy", *flags, "-p", "cuvette"], capture_output=True, text=True, cwd=folder)
    assert run.returncode == 0, run.stdout
    run = subprocess.run(["mypy", *flags, tmp_path / "user.py"], capture_output=True, text=True, cwd=folder)
    assert 'user.py:4: error: Incompatible types in assignment (expression has type "str"' in run.stdout, run.stdout
