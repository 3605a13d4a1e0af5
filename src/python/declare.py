"""Writes the generated half of the Python module: `declare.py cuvette.h PARAMETERS.json FOLDER`.

`_declarations.py` has the declarations of cuvette.h, taken from the header itself, in cffi's out-of-line ABI mode:
plain Python text, with which _library.py loads the shared library. No compiler is needed to install it, and one
package serves every architecture. `_documents.py` has the header's comments and the parameter table, for docstrings.
"""

import json
import pathlib
import re
import sys
import textwrap

import cffi

COMMENT = re.compile(r"/\*.*?\*/", re.S)


def declarations(header: str) -> str:
    """The header as cffi reads it: without comments, preprocessor lines and parts for C++ only."""
    text = re.sub(r"#ifdef __cplusplus\n(.*?)(#else\n(.*?))?#endif\n", r"\3", header, flags=re.S)
    numbers = re.findall(r"^#define (CUVETTE_[A-Z_]+) (\d+)$", text, re.M)
    text = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$", "", COMMENT.sub("", text), flags=re.M)
    text = re.sub(r"\bCUVETTE_API\s", "", text)
    return "".join(f"#define {name} {value}\n" for name, value in numbers) + re.sub(r"\n\s*\n+", "\n", text)


def plain(comment: str) -> str:
    """A comment's text, each paragraph in one line."""
    lines = [re.sub(r"^[ \t]*\*? ?", "", line).rstrip() for line in comment[2:-2].splitlines()]
    return re.sub(r"(?<!\n)\n(?!\n)", " ", "\n".join(lines).strip())


def comments(header: str) -> dict:
    """The comment above each function; functions without a comment have the previous one."""
    found, last = {}, ""
    for match in re.finditer(
        r"(/\*.*?\*/)|CUVETTE_API [^;]*?\b(cuvette_\w+)\(.*?;|(^typedef|^enum|\n\n)", header, re.S | re.M
    ):
        if match[1]:
            last = plain(match[1])
        elif match[2]:
            found[match[2]] = last
        elif match[3] and match[3] != "\n\n":
            last = ""
    return found


def parameter_lines(rows: list) -> str:
    def line(row: dict) -> str:
        unit = f", {row['unit']}" if row["unit"] else ""
        text = f"{row['path']}: {row['meaning']} ({row['range']}{unit}; default {json.dumps(row['default'])})"
        return textwrap.fill(text, 100, initial_indent="    ", subsequent_indent="        ")

    return "\n".join(map(line, rows))


def main(header_path: str, parameters_path: str, folder: str) -> None:
    header = pathlib.Path(header_path).read_text()
    place = pathlib.Path(folder)
    ffi = cffi.FFI()
    ffi.cdef(declarations(header))
    ffi.set_source("cuvette._declarations", None)
    made = place / "_declarations.py"
    ffi.emit_python_code(str(made))
    made.write_text("# mypy: ignore-errors\n" + made.read_text())
    rows = json.loads(pathlib.Path(parameters_path).read_text())["params"]
    (place / "_documents.py").write_text(
        '"""Texts of cuvette.h and of the parameter table; written by declare.py."""\n\n'
        f"FUNCTIONS: dict[str, str] = {comments(header)!r}\n\nPARAMETERS: str = {parameter_lines(rows)!r}\n"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
