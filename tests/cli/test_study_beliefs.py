"""`fieldmon study beliefs`, as a person runs it."""

import pytest


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-o", "none"], "must exist"),
        (["--scenario", "Z"], "A scenario must begin with 'Z'"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "beliefs", *words)
    assert (code, made) == (2, set())
    assert says in err
