"""The user's own table of labels: read as it stands, and refused where it can mean two things."""

import pytest

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.label_file import COLUMNS, read_labels
from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import FileProblem

FULL = ProductLabel(
    "Acarol", "tomato", "spider mites", Dose(0.5, "l/ha"), 3, 12.0, ("4A", "28"), 2, "label 2025"
)
ROW = "Acarol,tomato,spider mites,0.5,l/ha,3,12,4A+28,2,label 2025"
NAMES = ",".join(COLUMNS)


def read(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "labels.csv"
    path.write_bytes(text.encode(encoding))
    return read_labels(path)


@pytest.mark.parametrize(
    "text",
    [
        f"{NAMES}\n{ROW}\n",
        f"# our labels\n{NAMES}\n{ROW}\n\n",
        f"{NAMES.replace(',', ';')}\n{ROW.replace(',', ';').replace('0.5', '0,5')}\n",
        "Trade name,Crop,Pest,Max dose,Unit,PHI (days),REI (hours),MoA,Max uses,Source\n" + ROW,
        f"{NAMES}\n{ROW}\n{ROW}\n",
    ],
)
def test_a_table_is_read_as_people_write_it(tmp_path, text):
    assert read(tmp_path, text).value == (FULL,)


def test_only_the_product_is_needed_and_what_says_nothing_is_told(tmp_path):
    found = read(tmp_path, "product,colour\nסבון,green\n", "cp1255")
    assert found.value == (ProductLabel("סבון"),)
    assert any("colour" in one.sentence for one in found.messages)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("colour,dose\na,1\n", "must have a column product"),
        ("", "must have a column product"),
        (f"{NAMES}\n", "must hold a label or more"),
        (f"{NAMES}\n,tomato,,,,,,,,\n", "line 2: A label must name its product"),
        (f"{NAMES}\nA,,,much,l/ha,,,,,\n", "line 2: max_dose must be a number, but it is 'much'"),
        (f"{NAMES}\nA,,,0.5 l/ha,,,,,,\n", "line 2: max_dose .* in the column unit, .*'0.5 l/ha'"),
        (f'{NAMES}\nA,,,"1,500 ml/ha",l/ha,,,,,\n', "line 2: max_dose .* in the column unit"),
        (f'{NAMES}\nA,,,"1,500",g/ha,,,,,\n', "line 2: max_dose is 1,500: is that 1500 or 1.5"),
        (f"# ours\n{NAMES}\nA,,,,,inf,,,,\n", "line 3: waiting_days must be a number"),
        (f"{NAMES}\nA,,,1,5,l/ha,,,,,,x\n", "line 2 has 12 cells, but there are 10 columns"),
        (f"{NAMES}\nA,,,2,,,,,,\n", "line 2: the dose is 2, but of which unit is not said"),
        (f"{NAMES}\nA,,,2,buckets,,,,,\n", "line 2: The unit of a dose must be"),
        (f"{NAMES}\nA,,,,,-1,,,,\n", "line 2: A waiting period must be 0 to"),
        (
            f"{NAMES}\nA,,,,,2.5,,,,\n",
            "line 2: waiting_days must be a whole number, but it is 2.5. Harvest .*up, 3",
        ),
        (f"{NAMES}\nA,,,,,,,,1.5,\n", "line 2: max_uses must be a whole number, but it is 1.5"),
        (f"{NAMES}\nA,,,,,,,sulphur,,\n", "line 2: A mode-of-action group must be one of IRAC"),
        (f"{NAMES}\nA,,,,,,,,0,\n", "line 2: A label allows one use or more"),
        (f"{NAMES}\nA,,,,,3,,,,\na ,,,,,7,,,,\n", "two lines are about a, and differ in .*Which"),
    ],
)
def test_a_table_that_is_wrong_says_where_and_asks_what_holds(tmp_path, text, said):
    with pytest.raises(FileProblem, match=f"labels.csv.*{said}"):
        read(tmp_path, text)


def test_a_file_that_is_not_there_is_a_sentence(tmp_path):
    with pytest.raises(FileProblem, match="must be readable"):
        read_labels(tmp_path / "none.csv")


def test_what_is_not_known_is_nothing_said_and_never_a_zero(tmp_path):
    for cell in ("", "?", "-", "unknown", "Not known", "n/a"):
        (label,) = read(tmp_path, f"product,waiting days,re-entry hours\nOil,{cell},{cell}\n").value
        assert (label.waiting_days, label.reentry_hours) == (None, None), cell
    (label,) = read(tmp_path, "product,waiting days\nOil,0\n").value
    assert label.waiting_days == 0
