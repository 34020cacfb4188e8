"""`fieldmon study treatments`, as a person runs it."""

import pytest


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", __file__], "must be a folder"),
        (["--sampler", "rose"], "A sampler must be one of"),
        (["--pest", "rose"], "rose"),
    ],
)
def test_bad_words_are_a_sentence(run, words, said):
    code, _, err, made = run("study", "treatments", *words)
    assert (code, made) == (2, set())
    assert said in err
