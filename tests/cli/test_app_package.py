"""The app beside the command line is found by its place, whatever else is called so."""

import sys

from fieldmon.cli.app_package import app_package, app_words
from tests.paths import ROOT


def test_the_app_of_this_tree_is_found():
    package, folder = app_package()
    assert package in {"app", "fieldmon._app"}
    assert (folder / "words" / "texts.py").is_file()


def test_its_words_are_found_where_another_folder_is_called_app(tmp_path, monkeypatch):
    (tmp_path / "app").mkdir()
    (tmp_path / "app" / "__init__.py").write_text("raise RuntimeError('another app')")
    monkeypatch.syspath_prepend(tmp_path)
    words = app_words("language")
    assert app_words("translations").FOLDER.is_relative_to(ROOT)
    assert {"en", "he", "ar", "es"} == {*words.LANGUAGES}
    assert sys.modules[words.__name__] is words
