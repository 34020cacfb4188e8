"""`fieldmon study samplers`, as a person runs it."""

import pytest


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-o", "none"], "must exist"),
        (["--scenario", "Z", "--scenario", "Y"], "A scenario must begin with Z or Y"),
        (["--maps", "."], "must hold one of"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "samplers", *words)
    assert (code, made) == (2, set())
    assert says in err
