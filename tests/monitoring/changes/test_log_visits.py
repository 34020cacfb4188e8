"""A visit that was told plant by plant is one line of the log, which stays whole."""

from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.changes.log_entry import LogEntry
from fieldmon.monitoring.changes.log_visits import by_visit
from fieldmon.plot.local_clock import LocalClock

DAY = "2026-11-18"


def seen(batch, who="", found=0, to=DAY, **what):
    counts = {"found": found, "clean": 1 - found, "skipped": 0}
    return "seen", who, {"batch": batch, "source": f"robot {to}", "to": to, **counts, **what}


def planned(who="", on=DAY):
    return "planned", who, {"date": on, "stops": 9, "sampler": "adaptive", "expected": 1.0}


def a_log(*entries):
    return tuple(
        LogEntry(k, f"{DAY}T08:{k:02d}:00.000000Z", kind, who, what, f"digest {k}")
        for k, (kind, who, what) in enumerate(entries, 1)
    )


def lines(log, **how):
    return list(season_log.lines(log, LocalClock("UTC"), **how))


def test_a_driven_day_is_one_line_with_its_counts_and_every_entry_is_shown_on_demand():
    log = a_log(planned(), seen(1), seen(1, found=1), planned(), seen(1), seen(1))
    plan, visit, end = lines(log)
    assert plan.split()[2] == "planned"
    assert visit.startswith("    2  2026-11-18T08:02  seen")
    assert visit.endswith(
        "robot 2026-11-18: 1 found, 3 clean, 0 could not be inspected, batch 1; "
        "in 4 entries, the last (6) at 2026-11-18T08:06; planned anew 1 time"
    )
    assert end.startswith("6 entries, the chain holds")
    assert len(lines(log, whole=True)) == 7
    assert log[1].what["clean"] == 1, "the entry itself stays as it was written"


def test_robots_of_a_team_that_tell_in_turn_have_a_line_each():
    log = a_log(
        planned("A"), planned("B"), seen(1, "A"), seen(2, "B"), planned("B"), seen(1, "A", 1),
        seen(2, "B"), planned("A"),
    )  # fmt: skip
    told = by_visit(log)
    assert [(one.entry.kind, one.entry.who, one.n, one.replanned) for one in told] == [
        ("planned", "A", 1, 0), ("planned", "B", 1, 0), ("seen", "A", 2, 0), ("seen", "B", 2, 1),
        ("planned", "A", 1, 0),
    ]  # fmt: skip
    assert [one.entry.what["found"] for one in told[2:4]] == [1, 0]


def test_another_day_another_batch_and_whatever_happens_between_stand_apart():
    later = "2026-11-19"
    log = a_log(
        seen(1), planned(on=later), seen(2, to=later), seen(2, to=later), ("treated", "", {}),
        seen(2, to=later), seen(3, to=later, more="1 note added"), seen(3, to=later),
    )  # fmt: skip
    assert [one.entry.number for one in by_visit(log)] == [1, 2, 3, 5, 6, 7, 8]


def test_what_was_told_of_detection_is_said_of_the_whole_visit():
    (visit,) = by_visit(a_log(seen(1, detects=[0.5]), seen(1), seen(1, detects=[0.3, 0.5])))
    assert "told to find 30 %, 50 % of what is there" in visit.entry.sentence()
