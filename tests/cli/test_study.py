"""`fieldmon study`: its commands as a whole."""


def test_every_study_is_listed(run):
    code, out, _, _ = run("study", "--help")
    assert code == 0
    for name in ("prior", "calibrate", "samplers", "beliefs", "run", "no-prior"):
        assert f" {name} " in out
