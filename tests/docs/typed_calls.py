"""What a strict type checker must let callers of the library write; mypy reads it with fieldmon."""

from datetime import date

import numpy as np
import pandas as pd

import fieldmon as fm


def inspections() -> list[fm.Inspections]:
    """Return inspections of lists, arrays and columns."""
    found = pd.DataFrame({"plant": [0, 1], "result": [0, 1], "who": ["Ann", None]})
    return [
        fm.Inspections.of([0, 1], [0, 1], "2026-11-18"),
        fm.Inspections.of(found["plant"], found["result"], "2026-11-18", who=found["who"]),
        fm.Inspections.of(np.arange(2), [0, 1], [date(2026, 11, 18)] * 2, who=["Ann", None]),
        fm.Inspections.of((0, 1), np.array([0, 1]), date(2026, 11, 18)).take([0, 1]),
    ]


def records() -> fm.Records:
    """Return a record of lists."""
    return fm.Records.of([[35.1, 30.3]], [1], "2026-11-18", count=[3.0]).take([0])
