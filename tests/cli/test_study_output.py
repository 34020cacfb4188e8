"""Where studies leave their tables and reports."""

from contextlib import nullcontext

import pytest

from fieldmon.cli.study_output import can_be_folder, going_on, write_all
from fieldmon.errors import FileProblem
from fieldmon.simulation import executor, experiment
from tests.cli.estate import ZIP


def test_all_texts_are_written_and_said(tmp_path, capsys):
    write_all(tmp_path, {"a.csv": "x,y\n", "b.html": "שלום"})
    assert (tmp_path / "a.csv").read_bytes() == b"x,y\n"
    assert (tmp_path / "b.html").read_text(encoding="utf-8") == "שלום"
    said = [f"Written: {tmp_path / name}" for name in ("a.csv", "b.html")]
    assert capsys.readouterr().out.splitlines() == said


def test_who_stops_a_study_is_told_that_it_goes_on(tmp_path, capsys):
    with pytest.raises(KeyboardInterrupt), going_on(tmp_path / "samplers.csv"):
        raise KeyboardInterrupt
    assert f"kept in {tmp_path / 'samplers.csv'}; the same command" in capsys.readouterr().err
    with going_on(tmp_path / "samplers.csv"):
        pass
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("words", "kept"),
    [
        (["study", "run", ZIP, "--feature", "Nursery"], "study"),
        (["compare", "--hectares", "0.1"], "robots.csv"),
    ],
)
def test_who_stops_what_goes_on_is_told_so(run, monkeypatch, words, kept):
    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(experiment, "run", stopped)
    monkeypatch.setattr(executor, "cluster", lambda *_: nullcontext(executor.here()))
    code, _, err, _ = run(*words)
    assert code == 130
    told = f"What is done is kept in {kept}; the same command goes on from there.\nStopped;"
    assert told in err


def test_a_folder_is_made_when_there_is_something_to_write(tmp_path):
    folder = tmp_path / "study" / "first"
    can_be_folder(folder)
    assert not folder.parent.exists()
    write_all(folder, {"a.csv": "x\n"})
    assert (folder / "a.csv").read_text() == "x\n"


@pytest.mark.parametrize("name", ["c.csv", "report.HTML"])
def test_a_folder_that_is_called_as_a_file_is_refused_unless_it_is_there(tmp_path, name):
    with pytest.raises(FileProblem, match=rf"but .*{name} is the name of a file\. Name a folder"):
        can_be_folder(tmp_path / name)
    (tmp_path / name).mkdir()
    can_be_folder(tmp_path / name)
    can_be_folder(tmp_path / "seasons.parquet")


def test_what_stands_in_the_way_of_a_folder_is_named(tmp_path):
    (tmp_path / "file").touch()
    for place in ("file", "file/inside"):
        with pytest.raises(FileProblem, match=r"must be a folder, but .*file is a file"):
            can_be_folder(tmp_path / place)


def test_a_folder_in_which_one_may_not_write_is_refused_before_anything_is_simulated(
    tmp_path, monkeypatch
):
    monkeypatch.setattr("os.access", lambda place, _how: place != tmp_path)
    with pytest.raises(FileProblem, match="may write to"):
        can_be_folder(tmp_path / "none")
