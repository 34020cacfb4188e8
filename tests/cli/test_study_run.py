"""`fieldmon study run`: a study of one's own plots."""

import pytest

from fieldmon.simulation import results
from tests.cli.estate import ZIP

FEW = ["--seeds", 3, "--days", 2, "--workers", 1, "--date", "2026-11-02"]


def test_samplers_are_compared_on_a_plot_and_the_seasons_kept(run, tmp_path):
    words = ["study", "run", ZIP, "--feature", "Nursery", "--hours", 2, "--hours", 4, *FEW]
    code, out, err, _ = run(*words, "--sampler", "naive", "--sampler", "dynamic", "-o", "mine")
    assert code == 0, err
    assert "http://127.0.0.1:" in err
    assert sum(line.startswith(("naive", "dynamic")) for line in out.splitlines()) == 4
    table = results.seasons(tmp_path / "mine")
    assert table.num_rows == 2 * 2 * 3
    assert set(table["plot"].to_pylist()) == {"Nursery"}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--sampler", "best"], "best"),
        (["--infested", "2"], "between 0 and 1"),
        (["--date", "today"], "YYYY-MM-DD"),
        (["--pest", "mote"], "one of thesis, spider-mite"),
        (["--pest", "thesis", "--spread", "0.2"], "--spread goes without --pest"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "run", ZIP, *words)
    assert (code, made) == (2, set())
    assert says in err
