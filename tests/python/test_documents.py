"""The Python of README.md and of cuvette-python(7) works as printed."""

import re

import pytest
from conftest import ROOT

PAGE = (ROOT / "src/manual/man7/cuvette-python.7").read_text()
README = (ROOT / "README.md").read_text()


def blocks():
    yield re.search(r"^    import cuvette\n(?:    .*\n)+", README, re.M)[0].replace("\n    ", "\n").strip()
    for text in re.findall(r"^\.(?:EX|nf)\n(import cuvette\n.*?)^\.(?:EE|fi)", PAGE, re.M | re.S):
        yield text.replace("\\-", "-")


@pytest.mark.parametrize("code", list(blocks()))
def test_block(code, monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    exec(compile(code, "document", "exec"), {})
    assert capsys.readouterr().out.strip()


def test_there_are_some():
    assert len(list(blocks())) == 5
    assert len(next(blocks()).splitlines()) == 5
