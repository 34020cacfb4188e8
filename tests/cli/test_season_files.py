"""Several seasons into one: each counts once."""

import shlex
import shutil

import pytest

from fieldmon.cli.season_files import opened
from fieldmon.errors import SettingError
from fieldmon.monitoring import Season
from tests.cli.estate import begin_next_year, table
from tests.cli.test_merge import worked


def test_a_season_is_not_taken_twice_nor_beside_its_copy(run, season, tmp_path):
    copy = shutil.copy(season, tmp_path / "my copy.gpkg")
    with pytest.raises(SettingError) as told:
        opened([season, copy])
    # the way out can be pasted, whatever the files are called and wherever they are
    assert shlex.split(str(told.value).rpartition(": fieldmon merge ")[2]) == [
        str(season),
        str(copy),
    ]
    worked(run, season, "a.csv", {0}, "Ann")
    for other in (season, copy):
        with pytest.raises(SettingError, match="would stand there twice"):
            opened([season, other])
        for words in (("export", "-o", "all.csv", "--of", "inspections"),
                      ("report", "-o", "all.pdf", "--certification")):  # fmt: skip
            code, _, err, made = run(words[0], season, other, *words[1:])
            assert (code, made) == (2, set())
            assert "copies of one" in err


def test_seasons_of_their_own_go_into_one_table(run, season, tmp_path):
    worked(run, season, "a.csv", {0}, "Ann")
    other = begin_next_year(run, tmp_path)
    assert [one.path for one in opened([season, other])] == [season, other]
    code, _, err, _ = run("export", season, other, "--of", "inspections", "-o", "all.csv")
    assert code == 0, err
    assert len(table(tmp_path / "all.csv")) == len(Season(season).history.inspections) == 6
