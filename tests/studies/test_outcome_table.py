"""The study's table: read back as written, and gone on with."""

import os

import pytest
from typer.testing import CliRunner

from fieldmon.cli import main
from fieldmon.errors import FileProblem
from fieldmon.studies import outcome_table
from fieldmon.studies.outcome_table import OutcomeTable, csv_text, outcomes_from
from fieldmon.studies.samplers.contenders import CONTENDERS, NAMES
from fieldmon.studies.samplers.seasons import SeasonOutcome

ALWAYS = [contender.name for contender in CONTENDERS if contender.every == 1]


def outcomes(scenario, seed):
    return [
        SeasonOutcome(scenario, seed, name, 1.0 / (3 + seed), 2.0, 3.0, 4.0, 5.0, 6.5)
        for name in ("adaptive", "naive")
    ]


def test_a_table_is_read_back_as_it_was_written():
    made = outcomes("A, spread 30% to one", 0) + outcomes("B", 7)
    assert outcomes_from(csv_text(made, SeasonOutcome), "samplers.csv", SeasonOutcome) == made
    begin = "cell,seed,who,infested_plant_days,d50,d80,inspected,found,"
    assert csv_text(made, SeasonOutcome).startswith(begin)


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", "cell,seed,who\n"])
def test_another_table_is_refused(text):
    with pytest.raises(FileProblem, match="must be a table of this study"):
        outcomes_from(text, "samplers.csv", SeasonOutcome)


@pytest.mark.parametrize(
    "line", ["A,0,naive,x,2,3,4,5,6.5", "A,0,naive,nan,2,3,4,5,6", "A,0,naive,1", "A,0,na\ufffd"]
)
def test_a_line_that_was_changed_or_cut_is_named(line):
    text = csv_text(outcomes("A", 0), SeasonOutcome) + line
    with pytest.raises(FileProblem, match=r"^Line 4 of samplers\.csv must hold cell, seed, .*cut"):
        outcomes_from(text, "samplers.csv", SeasonOutcome)


def test_a_table_that_is_no_text_is_refused(tmp_path):
    file = tmp_path / "samplers.csv"
    file.write_bytes(b"\xff\xfe" + csv_text(outcomes("A", 0), SeasonOutcome).encode())
    with pytest.raises(FileProblem, match="must be a table of this study"):
        OutcomeTable(file, [], SeasonOutcome)


def test_a_chunk_that_lost_rows_is_made_again_but_others_are_left(tmp_path):
    file = tmp_path / "samplers.csv"
    rows = [*outcomes("A", 0), *outcomes("A", 1)[:1], *outcomes("B", 0)[:1]]
    file.write_text(csv_text(rows, SeasonOutcome))
    table = OutcomeTable(file, [("A", 0), ("A", 1)], SeasonOutcome, lambda rows: len(rows) == 2)
    assert [table.holds(key) for key in (("A", 0), ("A", 1), ("B", 0))] == [True, False, True]


def test_it_is_written_when_it_is_left_even_by_an_error(tmp_path):
    file = tmp_path / "samplers.csv"

    def interrupted():
        with OutcomeTable(file, [("A", 0), ("A", 1)], SeasonOutcome) as table:
            table.keep(("A", 1), outcomes("A", 1))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert outcomes_from(file.read_text(), "", SeasonOutcome) == outcomes("A", 1)


def test_it_is_written_now_and_then_into_a_folder_that_is_made_for_it(tmp_path, monkeypatch):
    file = tmp_path / "study" / "samplers.csv"
    table = OutcomeTable(file, [("A", 0)], SeasonOutcome)
    table.keep(("A", 0), outcomes("A", 0))
    assert not file.exists()
    monkeypatch.setattr(outcome_table, "_SAVED_EVERY_S", -1.0)
    table.keep(("A", 0), outcomes("A", 0))
    assert file.exists()


def test_rows_stand_in_the_order_asked_for_whatever_was_done_first(tmp_path):
    order = [("A", 0), ("B", 0), ("A", 1), ("B", 1)]
    texts = []
    for k, done in enumerate((order, order[::-1], [*order[2:], *order[:2]])):
        with OutcomeTable(tmp_path / f"{k}.csv", order, SeasonOutcome) as table:
            for key in done:
                table.keep(key, outcomes(*key))
        texts.append((tmp_path / f"{k}.csv").read_text())
    assert texts[0] == texts[1] == texts[2]
    made = outcomes_from(texts[0], "", SeasonOutcome)
    assert [o.scenario for o in made][::2] == ["A", "B", "A", "B"]


def test_what_the_file_holds_is_not_done_again_and_others_stay(tmp_path):
    file = tmp_path / "samplers.csv"
    file.write_text(csv_text(outcomes("other", 3) + outcomes("A", 0), SeasonOutcome))
    table = OutcomeTable(file, [("A", 0), ("A", 1)], SeasonOutcome)
    assert table.holds(("A", 0))
    assert not table.holds(("A", 1))
    with table:
        table.keep(("A", 1), outcomes("A", 1))
    assert table.asked() == outcomes("A", 0) + outcomes("A", 1)
    written = outcomes_from(file.read_text(), "", SeasonOutcome)
    assert written == outcomes("other", 3) + outcomes("A", 0) + outcomes("A", 1)


def test_of_two_studies_in_one_table_at_once_both_are_kept(tmp_path):
    file = tmp_path / "samplers.csv"
    one, other = (OutcomeTable(file, [(name, 0)], SeasonOutcome) for name in "AB")
    with one, other:
        one.keep(("A", 0), outcomes("A", 0))
        other.keep(("B", 0), outcomes("B", 0))
    written = outcomes_from(file.read_text(), "", SeasonOutcome)
    assert written == outcomes("B", 0) + outcomes("A", 0)
    assert one.asked() == outcomes("A", 0)


def test_what_was_simulated_is_kept_beside_a_table_that_can_no_longer_be_read(tmp_path):
    file = tmp_path / "samplers.csv"
    table = OutcomeTable(file, [("A", 0)], SeasonOutcome)
    table.keep(("A", 0), outcomes("A", 0))
    file.write_text("cell;seed\n")
    with pytest.raises(FileProblem, match=r"What was simulated is in samplers\.kept\.csv\.$"):
        table.save()
    assert outcomes_from((tmp_path / "samplers.kept.csv").read_text(), "", SeasonOutcome) == (
        outcomes("A", 0)
    )


def test_while_a_table_is_written_others_wait_with_reading_it(tmp_path, monkeypatch):
    fcntl = pytest.importorskip("fcntl")
    table = OutcomeTable(tmp_path / "samplers.csv", [("A", 0)], SeasonOutcome)

    tried = []

    def written(*_):
        tried.append(True)
        holding = os.open(tmp_path, os.O_RDONLY)
        try:
            with pytest.raises(BlockingIOError):
                fcntl.flock(holding, fcntl.LOCK_EX | fcntl.LOCK_NB)
        finally:
            os.close(holding)

    monkeypatch.setattr(outcome_table, "write_whole", written)
    table.save()
    assert tried


def test_the_command_writes_table_and_report_and_goes_on_where_it_stopped(tmp_path):
    args = ["study", "samplers", "--cell", "A,", "-o", str(tmp_path), "--seeds"]
    before = ""
    for seeds in ("2", "3"):
        result = CliRunner().invoke(main.app, [*args, seeds])
        assert result.exit_code == 0, result.output
        text = (tmp_path / "samplers.csv").read_text()
        assert text.startswith(before)
        before = text
        table = outcomes_from(text, "samplers.csv", SeasonOutcome)
        assert len(table) == len(NAMES) + (int(seeds) - 1) * len(ALWAYS)
    assert "Infested plant-days against dynamic, tuned" in result.output
    assert (tmp_path / "samplers.html").stat().st_size > 2000
