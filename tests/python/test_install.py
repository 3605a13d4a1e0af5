"""`make install-python` for a user: Python finds the module, the module its library; `make uninstall` removes just
that."""

import os
import subprocess
import sys

from conftest import ROD, ROOT


def make(*arguments: str) -> None:
    environment = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    run = subprocess.run(
        ["make", f"PYTHON={sys.executable}", *arguments],
        cwd=ROOT,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert run.returncode == 0, run.stdout[-2000:]


def test_install_and_uninstall(tmp_path):
    prefix = tmp_path / "home/.local"
    make("install-python", f"PREFIX={prefix}")
    (prefix / "lib/mine.txt").write_text("a file of the user")
    code = f"""
import cuvette, sys
print(cuvette.__file__)
print(next(line.split()[-1] for line in open("/proc/self/maps") if "libcuvette" in line))
print(cuvette.read({ROD!r}).render(width=16, height=12).hash)
"""
    environment = {"PYTHONUSERBASE": str(prefix), "PATH": os.environ["PATH"], "HOME": str(tmp_path)}
    printed = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, cwd=tmp_path, env=environment
    ).stdout.split()
    assert (prefix / printed[0]).with_name("py.typed").exists()  # without it type checkers ignore the annotations
    assert printed[0].startswith(str(prefix)) and printed[1].startswith(str(prefix)) and len(printed[2]) == 16
    make("uninstall", f"PREFIX={prefix}")
    left = [str(one) for one in prefix.rglob("*") if one.is_file() or one.is_symlink()]
    assert left == [str(prefix / "lib/mine.txt")]
    assert not list(prefix.rglob("cuvette"))
