"""Every text of a report in one place; each remembers its words, for who speaks a language."""

from __future__ import annotations

from typing import Any

from fieldmon.compute.wording import Worded


def isolated(name: str) -> str:
    """Return a name that reads right inside any sentence, whatever its script and direction."""
    return f"\u2068{name}\u2069"


# -- both
FOOTER = "fieldmon"
PAGE = "{page} / {of}"
UNPRINTED = (
    "{n} {n:character|characters} of names cannot be printed with this program's fonts and "
    "{n:stands|stand} as ?: {codes}."
)
FEW_FINDS = "{n:.1f} finds"
HEADLINE = "Inspect {plants} in {rows} on {day}, {hours} h: about {finds} expected."
HEADLINE_NONE = "Nothing to inspect on {day}."
WORKED = (
    "Worked on {day}: {inspected:,} {inspected:plant|plants} inspected, {found:,} found infested."
)
PAST_MIDNIGHT = (
    "After midnight, in the shift that began on {day}, {inspected:,} more "
    "{inspected:plant was|plants were} inspected, {found:,} found infested: dated {next}."
)
OF_SHIFT_BEFORE = (
    "{n:,} of them {n:was|were} inspected after midnight, in the shift that began on {day}."
)
OF_SHIFT = "Of the shift that begins on {day}:"
MISSED = "{day} is past, and no inspection of it was recorded."
OTHERWISE = "Clean and found, of the same plant"
MISSED_OF = "No inspection of {who} was recorded."
MISSED_PLAN = "Stops planned: {planned:,}."
PLANNED_DONE = "Stops planned: {planned:,}; done: {done:,}; left out: {left:,}; added: {added:,}."
PLANNED_DAYS = "On {days} planned and worked:"
PLANNED_UNRECORDED = "Planned, and nothing recorded: {days}."
ROW, ROWS, ROWS_NAMED = "row {low}", "rows {low}–{high}", "rows {low}"
NO_ROWS = "no rows"
LEGEND_CHANCE = "Chance that a plant is infested"
LEGEND_RECORDED, LEGEND_ROUTE_ONLY = "from records", "route"
LEGEND_FOUND, LEGEND_ROUTE = "found infested", "route, arrows show the way"
LEGEND_STATES = ("never inspected", "looked clean")
LEGEND_NOT_INSPECTED = "could not inspect, or gone"
LEGEND_GATE, LEGEND_HOT, LEGEND_ZONES = "gate", "hot spot", "zones to treat"
NORTH = "N"
MAP_ALT = (
    "Map of plot {name}: {plants} {plants:plant|plants}, {stops} {stops:stop|stops} on the route, "
    "{finds} {finds:plant|plants} found."
)
SETTINGS, SETTING_COLUMNS = "Settings", ("what", "value", "where from")

# -- the day
DAY_TITLE = "Day of {day}"
DAY_SHEET, DAY_SHEET_OF = "The day's work", "The day's work: {who}"
PLANTS_TO_INSPECT, OF_PLANTS = "Plants to inspect", "of {n:,}"
TEAM = "Team"
DAY_OF = "The route is that of {who}; the others of the team have their own."
DAY_OF_NOBODY = "The route shown is that of one who works alone; those who are out have their own."
TIME, FROM_TO = "Hours", "{start} to {end}"
DRIVE, FINDS, OF_INFESTED = "Drive", "Expected finds", "of {n} infested on the route"
OF_HIDDEN = "of {n} infested, {seen} of them visible"
FOUND_TODAY, OF_INSPECTED = "Found that day", "of {n} inspected"
STOPS, STOPS_COLUMNS = "Stops by row, in order", ("row", "from", "plants", "which")
WHICH_MANY = "{n} between {low} and {high}"
STOPS_BY_ROW = "Stops by row"
STOPS_REST = "... and {n} more; the field sheet and the route files hold every stop."
EVERY_STOP = "Every stop"
EVERY_COLUMNS = ("stop", "arrive", "row", "plant", "chance")
TICK, WAS, RESULTS = "found?", "result", {0: "clean", 1: "found", 2: "could not inspect", -1: ""}
FOUND_BY_ROW, FOUND_COLUMNS = "Found that day, by row", ("row", "plants found")
FOUND_REST = "... and {n} more; the report as .html holds all."
REST, EARLIER_REST = "... and {n} more.", "... and {n} earlier."
NOTES = "Notes"

# -- the season
SEASON_TITLE = "Season from {begins} to {day}"
SEASON_SHEETS = (
    "Where it stands",
    "How it went",
    "Hot spots and finds",
    "Records, treatments, settings",
)
STANDS = (
    "About {expected} plants are still infested ({low:,} to {high:,} with a chance of 90 %); "
    "{found} found so far."
)
STANDS_CLEAN = "The plot is clean with a chance of {chance}."
STANDS_HOT = "Finds cluster in {n}."
STILL, INTERVAL = "Still infested", "{low} to {high} (90 %)"
FOUND_SO_FAR, FOUND_TWICE = "Plants found", "in {n:,} finds"
SHARE_FOUND, INSPECTED = "Share found", "Plants inspected"
NOTHING_INSPECTED = "nothing was inspected yet"
CLEAN, CLEAN_NOTE = "Chance it is clean", "as believed"
HOT_SPOTS, HOT_NOTE = "Hot spots", "see below"
ROWS_UNSEEN = "Never inspected: {rows}."
ROWS_LATE = "Not inspected for a week or more: {rows}."
ROWS_ALL = "Every row was inspected within the last week."
CHART_INSPECTED, CHART_FOUND = "Plants inspected a day", "Plants found a day"
CHART_SHARE = "Share found, of found and not found yet, % (line), and its 90 % interval"
CHART_STILL = "Infested and not found yet, as expected (line), and its 90 % interval"
CHART_TREATED = "treated"
CHART_ALT = "Chart by day: {title}."
DAYS = "Day by day"
DAY_COLUMNS = ("day", "inspected", "found", "not found yet (90 %)", "share found")
DAYS_REST = "... and {n} earlier; the season's file holds all."
HOT_LIST = "Hot spots"
HOT_MEANS = (
    "{rows}: {found:,} found among {inspected:,} inspected of its {plants:,} plants, where "
    "{expected} would be if finds were spread evenly. So many by chance alone: {p}."
)
HOT_BROUGHT = "{n:,} of them {n:is|are} known from the records brought only."
HOT_TREATED = "{n:,} more {n:was|were} found here and treated since."
HOT_ROWS = "Rows {first} to {last}, plants {low} to {high}"
HOT_ROW = "Row {first}, plants {low} to {high}"
HOT_PLANTS = "Plants {low} to {high}"
HOT_NONE = "No hot spots: finds cluster no more than chance allows."
CHANCE_P_SMALL, CHANCE_P = "less than 1 in 10,000", "about 1 in {n:,}"
FINDS_BY_ROW = "Plants found infested, by row"
FINDS_COLUMNS = ("row", "plants", "which")
FINDS_NONE = "No plant was found infested yet."
BATCHES = "What was recorded"
BATCH_COLUMNS = ("recorded", "what", "from", "by", "how many")
BATCH_KINDS = {
    "findings": "inspections",
    "treatment": "treatment",
    "corrections": "corrections",
}
BATCH_BROUGHT = "records brought"
BATCH_UNDONE = "{kind}, taken back"
BATCH_ELSEWHERE = "{kind}, counts in another recording"
BATCH_CORRECTED = "{kind}, corrected since"
BATCH_PART = "{kind}, of which {n:,} {n:counts|count}"
BATCHES_NONE = "Nothing was recorded yet."
#: where records come from that no file brought, as the season's file calls it
SOURCES = {
    "phone": "phone", "scout mode": "scout mode",
    "added by another program": "added by another program",
}  # fmt: skip
BATCHES_REST = "... and {n} earlier; fieldmon status --batches lists all."
CHANGED_LATER = "Taken back and corrected"
CHANGED_LATER_LINE = "{day} {time}, by {who}: {said}"
CHANGED_LATER_THERE = "{day} {time}, by {who}, in a copy that was merged: {said}"
CHANGED_LATER_REST = "... and {n} earlier; fieldmon log lists all."
TREATMENTS = "Treatments"
TREATMENT_COLUMNS = ("day", "product", "plants", "works on", "harvest from")
TREATMENTS_NONE = "No treatment was noted."
ASSUMED = "Assumed, though nobody said so: {what}."
ROWS_APART, PLANTS_APART = "From row to row", "From plant to plant"
ROWS_RUN, ROWS_RUN_SO = "Rows run along the longest side", "{deg:.1f}° from north"
SAMPLER, HOURS = "Who chooses the plants", "Working hours"
LOOK, SPEED = "Seconds at a plant", "Speed"
DETECTS = "Finds what is there"
TIMES = "Row change, turn and stop"
WAY_BACK = "Way back to the gate within the hours"
YES, NO = "yes", "no"
ON_FOOT = "On foot"
WIDTH, LENGTH, TURNING_RADIUS = "Width", "Length", "Turning radius"
MEMBER, MEMBER_DETECTS = "{name}: hours, seconds at a plant", "{name}: finds what is there"
MEMBER_VALUE = "{hours:g} h, {look:g} s"
DETECTS_LEARNT = "The same, as the season learnt"
SPREAD, ARRIVALS = "Spread to a neighbour, a night", "Plants new from outside, a night"
PEST, WEATHER, WEATHER_DAYS = "Pest, by which nights go", "Its weather", "{first} to {last}"
WEATHER_NONE = "none: as its figures hold"
ARRIVALS_NONE = "none"
ARRIVALS_VALUE = "1 in {n:,.0f}"
BACKGROUND = "Chance where nothing is known"
TREATED, TREATED_VALUES = "Plants found are", {True: "treated at once", False: "only flagged"}
CHANGES, CHANGED = "Changed meanwhile", "{name}: {before}, then {now}"
CHANGED_ON = "From {day} on: {what}."
GUESSED = "Guessed when the plot was read"
EARLIER, EARLIER_VALUE = "Begun with what was learnt on", "{plot}, until {until}"
FROM_CHOSEN, FROM_USUAL, FROM_FILE = "chosen", "the usual", "of the plot's file"
FROM_WEATHER = "of the weather file"
FROM_NOBODY = "assumed"
FROM_LEARNT = "for chances, not for routes"
ADVICE_TITLE = "Advice of {day}"
ADVICE_SHEET = "Treat, or not, and where"
ADVICE_ALT = "Map of the zones to treat."
AREA_SPRAYED, OF_PLANTED = "To be sprayed", "{share} of {of} under plants"
PRODUCT, PRODUCT_OPEN, RATE = "Product", "not said", "{rate:,g} l/ha"
LIQUID, LITRES, INFESTED_INSIDE = "Liquid", "{value} l", "Infested plants inside"
AND_ELSEWHERE, ENOUGH = "{n} elsewhere", "Chance that it is enough"
ZONES, ZONES_REST = "Zones", "... and {n} more; the files for the sprayer hold all."
ZONES_COLUMNS = ("zone", "rows", "plants of the row", "plants", "infested", "by itself")
VERDICTS = {"treat": "treat", "do not treat": "do not treat", "inspect more": "inspect more"}
MEANING = "How the numbers are meant"
MEANINGS = (
    "Unknown is not clean: a plant was found infested, or looked clean, or was never inspected.",
    "A chance is what a model believes after all records, inspections and nights; it is no count.",
    (
        "An interval of 90 % is to hold the true number nine times in ten; in simulated seasons of "
        "some kinds it holds less often."
    ),
    (
        "The share found is of plants found and those not found yet: it rises, too, when a "
        "treatment cleans plants that nobody found."
    ),
    "A hot spot is where finds cluster more than chance allows, three or more; false ones: 5 %.",
    "What is marked as assumed was neither measured nor chosen. Other values give other chances.",
)

# -- for a certifier
CERT_TITLE = "Plant protection record, {begins} to {day}"
CERT_SHEETS = ("Summary", "Applications", "Inspections")
CERT_LEAD = "{treatments} on {plots}; {inspections}, {finds}."
CERT_AREA, CERT_AREA_NOTE = "Area treated", "all treatments added"
CERT_INSPECTIONS, CERT_FINDS = "Inspections", "Finds"
CERT_CAUTIONS, CERT_CAUTIONS_NONE = "To beware of", "Nothing."
CERT_PLOTS = "Plots"
CERT_PLOT_COLUMNS = ("plot", "area", "from", "to", "treatments", "inspected", "found")
CERT_UNSAID, CERT_UNSAID_NONE = "Asked for and not said", "Nothing: all is complete."
# a name at the head of a line would turn the line's direction where it is read from the right
CERT_ON_PLOT, CERT_TITLE_OF = "On {plot}: {said}", "{number}. Treatment of {plot}, {day}"
CERT_MISSING = "On {plot}, {day}: {what}."
CERT_BY_WHOM = "Who made the inspections ({n:,} of {of:,})."
CERT_LOG = "Log"
CERT_LOG_HOLDS = (
    "On {plot}: {n:,} {n:entry|entries} since {since}, the chain holds. "
    "The last digest is {digest}."
)
CERT_MEANINGS = (
    "Each entry of the log has a digest of itself and of all before it: keep the last one.",
    "Whoever keeps it can tell later whether the past was changed: the log must still hold it.",
    "A waiting period counts from the end of the application; of its day, where no time was said.",
    "Its end is rounded up to a whole day.",
    "What labels allow is the grower's own table; where it says nothing, nothing was checked.",
)
CERT_COLUMNS, CERT_NOT_SAID = ("what", "said"), "not said"
CERT_FIELDS = {
    "product": "Product",
    "ingredient": "Active ingredient",
    "group": "Mode of action (IRAC)",
    "dose": "Dose",
    "water": "Water",
    "area": "Area",
    "plants": "Plants",
    "where": "Where",
    "time": "Began and ended",
    "zone": "Time zone",
    "crop": "Crop",
    "pest": "Pest",
    "operator": "Operator",
    "authorised": "Authorised by",
    "machinery": "Machinery",
    "weather": "Weather then",
    "waiting": "Waiting period",
    "harvest": "Harvest from",
    "entry": "Entry from",
    "reason": "Reason",
    "advised": "Advised",
}
# the day is of the treatment of which nobody said how long to wait
CERT_HARVEST_UNSAID = "not known, see {day}"
CERT_CORRECTED = "corrected by {who}"
CERT_BEGAN, CERT_ENDED = "began {time}", "ended {time}"
CERT_OF_PLOT, CERT_NONE = "Inspections on {plot}", "none"
CERT_DAY_COLUMNS = ("day", "inspected", "found", "by")


def _remembered(value: Any) -> Any:  # noqa: ANN401 - a text, or many in a dict or tuple
    if isinstance(value, dict):
        return {key: _remembered(one) for key, one in value.items()}
    if isinstance(value, tuple):
        return tuple(map(_remembered, value))
    return Worded(value)


#: every text by its name
TEXTS = {name: _remembered(value) for name, value in globals().copy().items() if name.isupper()}
globals().update(TEXTS)
