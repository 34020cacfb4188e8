"""`fieldmon study`: its commands as a whole."""

import pytest


def test_every_study_is_listed_with_what_it_does(run):
    code, out, _, _ = run("study", "--help")
    assert code == 0
    for name in ("prior", "calibrate", "samplers", "beliefs", "run", "no-prior"):
        assert f" {name} " in out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["samplers", "-o", "none"], "must exist"),
        (["samplers", "--cell", "Z"], "A cell must begin with Z"),
        (["samplers", "--maps", "."], "must hold one of"),
        (["beliefs", "-o", "none"], "must exist"),
        (["beliefs", "--cell", "Z"], "A cell must begin with 'Z'"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", *words)
    assert (code, made) == (2, set())
    assert says in err
