"""`fieldmon plots`: what a file holds."""

from tests.cli.estate import ZIP


def test_the_plots_of_a_file_are_listed(run):
    code, out, _, _ = run("plots", ZIP)
    assert code == 0
    assert "ha  Gate" in out
    assert len(out.splitlines()) == 9
