"""Files for robots, phones and paper: a planned day in the formats that others read."""

from fieldmon.geodata.handoff.door import FORMATS, write_handoff
from fieldmon.geodata.handoff.plan import HandoffPlan

__all__ = ["FORMATS", "HandoffPlan", "write_handoff"]
