"""Files for robots, phones and paper: a planned day in the formats that others read."""

from fieldmon.io.writers.day_file import HandoffPlan
from fieldmon.io.writers.handoff import FORMATS, write_handoff

__all__ = ["FORMATS", "HandoffPlan", "write_handoff"]
