"""What a plot was before its rows were changed is kept until somebody says that it is right."""

from app.state import plot_before
from tests.app.chosen import a_plot, chosen


def test_the_plot_before_a_change_is_kept_until_it_is_forgotten(session):
    wide, narrow = a_plot(), a_plot(row_spacing_m=3.0)
    assert plot_before.plot_before(chosen(wide)) is None
    assert plot_before.plot_before(chosen(narrow)) is wide
    assert plot_before.plot_before(chosen(narrow)) is wide, "another run of the same page"
    assert plot_before.plot_before(chosen(a_plot(row_spacing_m=3.0))) is wide, "the same plants"
    plot_before.forget()
    assert plot_before.plot_before(chosen(narrow)) is None
    assert session
