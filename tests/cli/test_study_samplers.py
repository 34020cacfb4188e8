"""`fieldmon study samplers`, as a person runs it."""

import pytest

from fieldmon.studies.samplers.contenders import OF_PESTS
from tests.cli.estate import table


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-o", __file__], "must be a folder"),
        (["--scenario", "Z", "--scenario", "Y"], "A scenario must begin with Z or Y"),
        (["--maps", "."], "must hold a map of plants"),
        (["--pest", "whitefly", "--tune"], "--pest goes without --maps"),
        (["--visit-every", "7", "--tune"], "--visit-every goes without --maps and --tune"),
        (["--pest", "whitefly", "--scenario", "world"], "must begin with world"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "samplers", *words)
    assert (code, made) == (2, set())
    assert says in err


def test_with_a_pest_every_sampler_believes_the_one_map_that_follows_it(run, tmp_path):
    words = ["--pest", "whitefly", "--scenario", "A, whitefly", "--seeds", 2]
    code, out, err, made = run("study", "samplers", *words)
    assert code == 0, err
    assert "pest: Tobacco whitefly" in err
    assert "A, whitefly, clusters, prior none" in out
    assert {path.name for path in made} == {"samplers.csv", "samplers.html"}
    rows = table(tmp_path / "samplers.csv")
    whole = (tmp_path / "samplers.csv").read_bytes()
    lines = whole.splitlines(keepends=True)
    (tmp_path / "samplers.csv").write_bytes(b"".join(lines[:-1]))  # a season lost a row
    assert run("study", "samplers", *words)[0] == 0
    assert (tmp_path / "samplers.csv").read_bytes() == whole
    assert {row["who"] for row in rows} == {each.name for each in OF_PESTS}
    assert "nan" not in (tmp_path / "samplers.html").read_text(encoding="utf-8")
