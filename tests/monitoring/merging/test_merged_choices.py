"""What was chosen in two copies: what one alone chose holds, what both did is said."""

from dataclasses import replace

import pytest

from fieldmon.decisions.labels import ProductLabel
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.file import label_table
from fieldmon.monitoring.merging.merge import merge_copies
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.settings import from_json
from tests.monitoring.merging.copies import PAIRS, apart, copied, copies_of, looks_for, merge

IN_ORDER = {
    "settings": "SELECT changed, name, value FROM settings ORDER BY fid",
    "batches": "SELECT at, kind, source, who FROM batches ORDER BY fid",
}


def test_what_one_copy_alone_chose_holds_and_what_both_did_is_said():
    chosen_by = set()
    for seed in range(PAIRS):
        one, other = apart(seed)
        ours = copied(one)
        differing = merge(ours, other).merged.contradictions
        for wanted in IN_ORDER.values():
            together = ours.execute(wanted).fetchall()
            for db in (one, other):  # each copy's own order, whatever its clock says
                rows = db.execute(wanted).fetchall()
                assert [row for row in together if row in rows] == rows
        rows = [[*db.execute(IN_ORDER["settings"])] for db in (one, other)]
        now, *values = (settings_log.now(db) for db in (ours, one, other))
        said = []
        for name in now:
            own = [row for row in rows[0] if row not in rows[1] and row[1] == name]
            others = [row for row in rows[1] if row not in rows[0] and row[1] == name]
            chosen_by.add((name, bool(own), bool(others)))
            if not (own and others):
                assert now[name] == values[1 if others else 0][name]
            elif values[0][name] != values[1][name]:
                assert now[name] in {each[name] for each in values}
                said.append(f"The setting {name} differs")
        kept, *tables = (label_table.read(db) for db in (ours, one, other))
        own, others = ({*season_log.labels_kept(db)} for db in (one, other))
        chosen_by.add(("labels", bool(own - others), bool(others - own)))
        if not (own - others and others - own):
            assert kept == tables[1 if others - own else 0]
        elif tables[0] != tables[1]:
            assert kept in tables
            said.append("The table of labels differs")
        assert [sentence.startswith(start) for sentence, start in zip(
            differing, said, strict=True)] == [True] * len(said)  # fmt: skip
        for db in (one, other, ours):
            db.close()
    each = {(name, *by) for name in ("robot", "labels") for by in ((0, 1), (1, 0), (1, 1))}
    assert each <= chosen_by


@pytest.mark.parametrize("both", [True, False])
def test_labels_that_were_replaced_do_not_come_back(path, other, both):
    ours, theirs = Season(path), Season(other)
    if both:
        ours.keep_labels([ProductLabel("Acarol", waiting_days=7), ProductLabel("Old")])
    theirs.keep_labels([ProductLabel("Acarol", waiting_days=21)])
    theirs.keep_labels([last := ProductLabel("Acarol", waiting_days=3)])
    done = ours.merge(theirs)
    assert ours.labels() == (last,)
    said = (
        "The table of labels differs (Acarol, Old): each copy replaced it. What was kept last "
        "counts, as a whole: the one there."
    )
    assert done.contradictions == ((said,) if both else ())
    assert theirs.merge(ours).contradictions == ()
    assert theirs.labels() == (last,)
    assert ours.verify() == ()


def test_a_pest_that_both_chose_differently_is_named_not_dumped():
    one, other = copies_of(2)
    looks_for(one, "mites")
    chosen = from_json(settings_log.now(one))
    settings_log.change(other, replace(chosen, pest=replace(chosen.pest, detection=0.5)))
    (said,) = merge_copies(one, other).merged.contradictions
    assert said == (
        "The setting pest differs: mites (this copy's figures) here, mites (the other copy's "
        "figures) there. What was chosen last counts: mites (the other copy's figures)."
    )
