"""Live documents: the laboratory in one file, with the scene of a program."""

import base64
import html
import re
import zlib

import cuvette
import pytest
from conftest import ROOT

PAGE = '<!doctype html><html><head><title>Lab</title></head><body>\u00b5 &amp; "</body></html>'


@pytest.fixture
def laboratory(tmp_path, monkeypatch):
    path = tmp_path / "live.html"
    path.write_text(PAGE, encoding="utf-8")
    monkeypatch.setenv("CUVETTE_LIVE", str(path))


def scene_of(document):
    code = re.search(r'<head><script type="text/plain" id="cuvette-scene">([\w-]+)</script>', document)[1]
    return cuvette.parse(zlib.decompress(base64.urlsafe_b64decode(code + "=" * (-len(code) % 4))).decode())


def test_document_has_the_scene_as_it_is_now(laboratory, rod):
    rod["liquid.ior"] = 1.4
    live = rod.live()
    assert scene_of(live.html).render(depth=3).hash == rod.render(depth=3).hash
    assert re.sub(r"<script.*?</script>", "", live.html) == PAGE


def test_notebook_shows_the_document_in_a_frame(laboratory, rod):
    live = rod.live(width=500, height=300)
    shown = re.fullmatch(r'<iframe [^>]*width="500" height="300"[^>]* srcdoc="([^"]*)"></iframe>', live._repr_html_())
    assert html.unescape(shown[1]) == live.html


def test_save_for_slides(laboratory, rod, tmp_path):
    rod.live().save(tmp_path / "turn.html")
    assert (tmp_path / "turn.html").read_text(encoding="utf-8") == rod.live().html
    assert cuvette.read(tmp_path / "turn.html").render().hash == rod.render().hash


def test_without_the_laboratory(rod, monkeypatch, tmp_path):
    monkeypatch.setenv("CUVETTE_LIVE", str(tmp_path / "none.html"))
    with pytest.raises(
        cuvette.InputError, match="cannot find the laboratory in one file, .*none.html; make it with: make .* site"
    ):
        rod.live()


def test_scene_that_reads_files(laboratory):
    with pytest.raises(cuvette.InputError, match="cannot name files, but tiles reads"):
        cuvette.read(ROOT / "experiments/scenes/chequer.yaml").live()
