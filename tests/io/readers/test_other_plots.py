"""Records that name another plot are none of this one's."""

import pytest

from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.plot.layout import rectangle

GRID = rectangle(6, 10)


def upload(text):
    return Upload("found.csv", text.encode())


def of_gate(rows, options=None, head="plot,row,plant,result", called=("Gate", "gate-2026")):
    table = "\n".join([head, *(row.replace("/", f",1,{k},") for k, row in enumerate(rows, 1))])
    return read_inspections(upload(table), GRID, options, called)


@pytest.mark.parametrize(
    ("rows", "n", "severity", "said"),
    [
        (["Pond/x", "Pond/clean", "Wadi/x"], 0, Severity.DOUBTFUL,
         "names Pond, Wadi, not plot Gate"),
        (["Gate/x", "Pond/x", "GATE /x", "Wadi/x", "/x"], 3, Severity.DROPPED,
         "2 records are of 2 other plots: Pond, Wadi."),
        (["Gate-2026/x", "Pond/x"], 1, Severity.DROPPED, "1 record is of 1 other plot: Pond."),
    ],
)  # fmt: skip
def test_records_that_name_another_plot_are_left_out_unless_one_says_they_are_its_own(
    rows, n, severity, said
):
    imported = of_gate(rows)
    assert len(imported.value) == n
    (told,) = [one for one in imported.of(severity) if said in one.sentence]
    assert told.remedy.setting == "columns=plot="
    answered = InspectionOptions().choose(told.remedy.option, told.remedy.value)
    assert len(of_gate(rows, answered).value) == len(rows)
    taken = of_gate(rows, InspectionOptions(take_doubtful=True))
    assert len(taken.value) == (len(rows) if severity == Severity.DOUBTFUL else n)


@pytest.mark.parametrize(
    ("rows", "head", "called"),
    [
        (["Gate/x", "gate/x", "/x"], "plot,row,plant,result", ("Gate",)),
        # how a table writes a plot's number
        (["03/x", "3/x"], "plot,row,plant,result", ("3",)),
        (["3/x", "3/x"], "plot,row,plant,result", ("Plot 3",)),
        # what is no plot's name, unless this plot's stands there too
        (["A/x", "B/x"], "block,row,plant,result", ("Gate",)),
        (["Paran/x"], "locality,row,plant,result", ("Gate",)),
        # who reads for no plot by name
        (["Pond/x"], "plot,row,plant,result", ()),
    ],
)
def test_names_of_this_plot_and_of_blocks_leave_no_record_out(rows, head, called):
    imported = of_gate(rows, None, head, called)
    assert len(imported.value) == len(rows)
    assert not {one.severity for one in imported.messages} & {Severity.DOUBTFUL, Severity.DROPPED}


def test_plots_that_differ_in_brackets_are_not_one():
    rows = ["two_plots (1)/x", "two_plots (2)/x"]
    imported = of_gate(rows, called=("two_plots (1)",))
    assert imported.value.plant.tolist() == [0]


@pytest.mark.parametrize(
    ("head", "name", "doubt"),
    [
        ("plot", "Old name", "1 record names another plot (Old name), but lies on this one"),
        ("plot", "GATE", ""),
        ("block", "A", ""),
    ],
)
def test_where_a_record_lies_says_more_than_the_plot_it_names_and_it_is_doubted(head, name, doubt):
    (lon, lat), far = GRID.lonlat([7])[0], "Pond,10.0,20.0,x"
    table = f"{head},lon,lat,found\n{name},{lon},{lat},x\n{far}\n"
    imported = read_inspections(upload(table), GRID, None, ("Gate",))
    assert imported.value.plant.tolist() == [7]
    doubts = [one.sentence for one in imported.of(Severity.DOUBTFUL) if "another" in one.sentence]
    assert [one.split(":")[0] for one in doubts] == ([doubt] if doubt else [])


@pytest.mark.parametrize(("names", "plants"), [(("Gate", "Pond"), [1]), (("Pond", "Wadi"), [])])
def test_of_an_export_a_name_says_more_than_where_a_record_lies(names, plants):
    (lon, lat), far, mark = GRID.lonlat([7])[0], ("10.0", "20.0"), f"i{'0' * 24}"
    lines = [
        f"{name},1,{k},{x},{y},found,{mark}"
        for name in names
        for k, x, y in ((2, "", ""), (8, lon, lat), (9, *far))
        if (name == "Gate") == (k == 2)
    ]
    table = "\n".join(["plot,row,plant,lon,lat,result,digest", *lines])
    options = InspectionOptions(take_doubtful="Gate" in names)
    assert read_inspections(upload(table), GRID, options, ("Gate",)).value.plant.tolist() == plants
