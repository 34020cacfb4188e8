"""Files of a command become a plot."""

import pytest

from fieldmon.cli.files_to_plot import estate, prepared
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from fieldmon.io.plot_request import PlotRequest, PlotSources, RecordSource
from tests.cli.estate import ZIP

ROWS = RecordSource(Upload("r.csv", b"row,plant,date,count\n3,7,2026-03-01,4\n"), RecordOptions())


def test_a_plot_is_prepared_and_what_there_is_to_say_is_said(capsys):
    made = prepared(PlotRequest(PlotSources(ZIP, PlotOptions(feature="Nursery")), records=ROWS))
    out, err = capsys.readouterr()
    assert out.startswith(f"Nursery: {len(made.plot.grid):,} plants in")
    assert err.splitlines() == [said.message.line() for said in made.messages]


@pytest.mark.parametrize(
    ("make", "how"),
    [
        (prepared, '--feature "Gate" or --feature 1.'),
        (estate, 'Answer with --record-option plot="Gate", for instance.'),
    ],
)
def test_a_question_says_how_to_answer_it(make, how):
    with pytest.raises(ChoiceNeeded) as asked:
        make(PlotRequest(PlotSources(ZIP), records=ROWS))
    assert str(asked.value).endswith(how)
