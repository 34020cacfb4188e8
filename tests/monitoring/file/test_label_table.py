"""Labels in a season's file."""

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.monitoring.file import label_table

LABELS = (
    ProductLabel(
        "Acarol", "tomato", "mites", Dose(0.5, "l/ha"), 3, 12.0, ("4A", "28"), 2, "page 4"
    ),
    ProductLabel("סבון"),
)


def test_labels_come_back_as_they_were_and_take_the_place_of_those_before(db):
    assert label_table.read(db) == ()
    label_table.write(db, LABELS[1:])
    label_table.write(db, LABELS)
    assert label_table.read(db) == LABELS
