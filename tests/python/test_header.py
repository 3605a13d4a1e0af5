"""The declarations for Python are those of cuvette.h: sizes and offsets by the C compiler, numbers, functions."""

import os
import re
import subprocess

import cuvette
import pytest
from conftest import ROOT
from cuvette._declarations import ffi
from cuvette._library import lib

HEADER = (ROOT / "src/cuvette.h").read_text()


def structs():
    names = sorted(
        set(re.findall(r"^\} (cuvette_\w+);", HEADER, re.M))
        - set(re.findall(r"^typedef enum (cuvette_\w+)", HEADER, re.M))
    )
    return [(name, [field for field, _ in ffi.typeof(name).fields]) for name in names]


def test_structs_have_the_compilers_layout(tmp_path):
    cc = os.environ.get("CC", "cc")
    lines = []
    for name, fields in structs():
        lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
        lines += [f'printf("{name}.{field} %zu\\n", offsetof({name}, {field}));' for field in fields]
    source = tmp_path / "layout.c"
    source.write_text('#include "cuvette.h"\n#include <stdio.h>\nint main(void) {\n' + "\n".join(lines) + "\n}\n")
    subprocess.run([*cc.split(), f"-I{ROOT}/src", "-o", tmp_path / "layout", source], check=True)
    printed = subprocess.run([tmp_path / "layout"], check=True, capture_output=True, text=True).stdout
    expected = []
    for name, fields in structs():
        expected.append(f"{name} {ffi.sizeof(name)}")
        expected += [f"{name}.{field} {ffi.offsetof(name, field)}" for field in fields]
    assert len(expected) > 100 and printed.splitlines() == expected


def test_every_function_and_number_of_the_header_is_declared():
    functions = set(re.findall(r"\b(cuvette_\w+)\(", re.sub(r"/\*.*?\*/", "", HEADER, flags=re.S)))
    assert len(functions) > 60
    for name in functions:
        assert ffi.typeof(getattr(lib, name)).kind == "function"
    for name, number in re.findall(r"\b(CUVETTE_[A-Z_]+) = (-?\d+)", HEADER):
        assert getattr(lib, name) == int(number)
    assert cuvette.__version__ == ".".join(re.findall(r"#define CUVETTE_VERSION_\w+ (\d+)", HEADER))


def test_the_declarations_are_renewed_with_the_header(tmp_path):
    """What declare.py makes of the header now is what the module has."""
    import importlib.util
    import sys

    made = ROOT / "build/python/params.json"
    if not made.exists():
        pytest.skip("another build folder")
    subprocess.run([sys.executable, ROOT / "src/python/declare.py", ROOT / "src/cuvette.h", made, tmp_path], check=True)
    present = importlib.util.find_spec("cuvette._declarations").origin
    assert (tmp_path / "_declarations.py").read_text() == open(present).read()
