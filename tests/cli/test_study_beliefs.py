"""`fieldmon study beliefs`, as a person runs it."""

import re

import pytest


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-o", __file__], "must be a folder"),
        (["--scenario", "Z"], 'none begins with "Z". There are'),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "beliefs", *words)
    assert (code, made) == (2, set())
    assert says in err


def test_with_a_pest_the_map_that_follows_it_is_held_to_what_came_true(run):
    words = ["--pest", "whitefly", "--scenario", "A, whitefly", "--seeds", 1]
    code, out, err, made = run("study", "beliefs", *words)
    assert code == 0, err
    assert [line.split("  ")[0] for line in out.splitlines() if "Brier" in line] == ["traced pairs"]
    assert re.search(
        r"intervals of 90 and 50 % hold on \d+ and \d+ % of \d+ mornings? with infested plants, ",
        out,
    )
    (page,) = made
    assert "A, whitefly, clusters, prior none" in page.read_text(encoding="utf-8")
