"""Every text of the app in English, each under a name; `texts.NAME` is in the session's language.

A translation is one file, ``languages/LANGUAGE.po``; `language` finds a text in it by its name
here. A text that names a count is a `Plural`: its words for one, and for more.
"""

import sys
from types import ModuleType
from typing import Any

from fieldmon.reports import words
from fieldmon.samplers import of_equal_times

from . import language, signs
from .language import Plural, Text


def isolated(name: str) -> str:
    """Return a name that reads right inside any sentence, whatever its script and direction.

    Signs of its own that turn the direction end with it, and it leads nowhere.
    """
    return f"\u2068{signs.leading_nowhere(name, turning=False)}\u2069"


def written(said: str) -> str:
    """Return what somebody wrote, in one line of a page and word for word: no sign formats it."""
    return isolated(signs.unformatted(" ".join(said.split())))


TITLE = "fieldmon"
# the menu, and the pages of each item
MENU = {"plots": "Plots", "today": "Today", "season": "Season", "ahead": "Plan ahead",
         "plot": "Plot & data"}  # fmt: skip
PAGES_OF = "What to see here"
PAGES = {
    "plots": "Plots", "plot": "Plot & data",
    "today": "Plan", "scout": "Scout", "record": "Record",
    "season": "How it goes", "decide": "Decide", "field": "Plants & hot spots", "report": "Report",
    "compare": "Compare", "simulate": "Simulate", "drive": "Drive",
}  # fmt: skip
RESEARCH, REPORT, STUDY = "Research", "Report", "The thesis, without records"
SAMPLE, UPLOAD = "Sample estate", "My own files"
SAMPLE_NOTE = (
    "A made-up estate near Paran, to try things out. Nothing of it exists, and there it is always "
    "{day}."
)
PLOT_FROM = "Plot or season"
PLOT_FILE = "Plot: zipped shapefile, {formats}, ISOXML ..."
RECORD_FILE = "Pest records: CSV, Excel, GeoJSON ... (optional)"
PLANT_FILE = "Measured plant positions (optional)"
ROWS_FILE = "Rows as lines, or their end posts (optional)"
BLOCKS_FILE = "Blocks as areas, or lines that part the plot (optional)"
FILES = "Files: the plot, pest records, measured plants"
KEPT_FILE = "In use: {name}"
FORGET_FILE = "Take it out"
WHICH_PLOT = "Which plot"
EMPTY = (
    "### Bring a plot\n"
    "Drop a plot file into the first box: the boundary of a real plot, in any coordinate system. "
    "Records of pests are welcome but not needed. Your files stay on this machine, for a day after "
    "you saw them last; nobody sees them who does not have this page's address, and nothing is "
    "sent anywhere. Or choose the sample estate above first."
)
# where the map would be, while there is none
NO_MAP = {"bring": "Your plot will be drawn here", "asked": "One question comes first",
          "file": "This file cannot be drawn", "plot": "This plot cannot be drawn yet",
          "season": "This season cannot be opened"}  # fmt: skip
NO_MAP_DO = {
    "bring": "Drop its file into the first box, or draw it beside: rows, plants and today's route "
    "then stand here.",
    "asked": "Answer it beside: the plot is then drawn here.",
    "file": "Take it out, and drop another file; or add what belongs to it.",
    "plot": "Change the rows, or take back what was drawn last, beside.",
}
NO_MAP_TAKE_OUT, NO_MAP_TAKE_OUT_ALL = "Take out {name}", "Take out {name} and {n} more"
ROWS = "Rows"
BEARING = "Row direction (degrees from north)"
BEARING_HELP = "Leave empty to have it found from the boundary or the plants."
ROW_SPACING, PLANT_SPACING = "Row to row ({unit})", "Plant to plant ({unit})"
HEADLAND = "Headland ({unit})"
HALF_CANOPY = "Half a canopy ({unit})"
HALF_CANOPY_HELP = (
    "How far plants reach to each side of their middle. It counts for a robot whose width is said. "
    "Leave empty for {usual}."
)
SPACING_HELP = "Leave empty for what the file says, or else {rows} and {plants}."
WHO = "Who inspects"
ROBOT, SCOUT = "Robot", "Scout on foot"
HOURS, INSPECTION_S = "Working hours", "Seconds at a plant"
ROBOT_WIDTH = "Width of the robot ({unit})"
ROBOT_WIDTH_HELP = (
    "Ways keep half of it off the canopies of plants, and aisles that are too narrow are not "
    "entered. Left empty, the robot is a point."
)
ROBOT_TURNS = "Turning radius, if it cannot turn on the spot ({unit})"
ROBOT_TURNS_HELP = (
    "Of its sharpest turn. Row ends without room for it are left out, and row changes are charged "
    "what they take there. Needs a width."
)
ROBOT_TIMES_LABEL = "Time for row changes and stops"
ROBOT_TIMES_HELP = "Measured in simulated drives, or as the thesis has them."
ROBOT_TIMES_NAMES = {
    "measured": "Measured: {row} s a row, {stop} s a stop",
    "thesis": "Thesis: {row} s a row, {turn} s a turn",
    "own": "Own: {row} s a row, {turn} s a turn, {stop} s a stop",
}
SAMPLER = "Who chooses the plants"
SAMPLERS = {name: f"{kind.title}: {kind.does}" for name, kind in of_equal_times().items()}
SAMPLER_EVERY = "{does}; but here N is {every:g}, not {usual:g}"
DATE = "Day"
DATE_HELP = "Today by the clock of {zone}, unless you choose another day."
ZONE_OF_MACHINE = "this computer, since no time zone is known where the plot lies"
OTHER_DAY = "This page is about **{day}**, which is not today ({today})."
DAY_OUTSIDE = (
    "A day of the season must be from {first}, when it begins, to {last}, but {day} was chosen. "
    "This is about the nearest."
)
OTHER_DAY_RECORDED = "What you record here is recorded for {day}, unless a file names its day."
NOT_COME = (
    "Something is recorded of **{day}**, which has not come: it is {today}. No day before counts "
    "it. If that day is wrong, undo it in *Record*."
)
NOT_COME_CORRECT = (
    "The day of an inspection can be corrected there, too: choose its plant, then *{correct}*."
)
BACK_TO_TODAY = "Back to today"
PRESSED_BEFORE = (
    "*{button}* was pressed before the plot or the day just chosen was shown, so nothing was done. "
    "Press it again for what is shown now."
)
FACES_TO_INSPECT = "Faces to inspect"
PLANTS_TO_INSPECT, TIME, DRIVE, FINDS = "Plants to inspect", "Hours", "Drive", "Expected finds"
ASSUMED = "\\* assumed: {what}."
ASSUMED_WHAT = {
    "row_spacing_m": "rows {value} apart",
    "plant_spacing_m": "plants {value} apart",
    "row_bearing_deg": "the rows {value}° from north",
    "half_canopy_m": "plants reach {value} to each side",
    "background_chance": "{value} % of plants infested where nothing is known",
    "speed_m_s": "{value} km/h",
    "row_change_s": "a row change takes {value} s more, as in simulated drives",
    "stop_s": "a stop takes {value} s more, as in simulated drives",
    "detects": "an inspection finds {value} % of what is there",
    "rate_per_day": "each neighbour of an infested plant is infested with {value} % a night",
    "treated": "plants found infested are treated at once",
    "edge_chance": "{value} % more at edges and paths",
    "gate": "the gate at the nearest row end",
}
ASSUMED_ROBOT_TOO = "how fast and how thoroughly plants are inspected"
ASSUMED_OF_ROBOT = "Of who inspects: {what}."
ASSUMED_CHANGE, ASSUMED_ALL, ASSUMED_USE = "Change", "See all, or change", "Use these"
ASSUMED_NOTHING = "Nothing is assumed: all of it was said, or stands in your files."
ASSUMED_ROBOT = "Who inspects, and how thoroughly, is chosen further down, under Who inspects."
ASSUMED_LAID = "Rows and plants were laid when the season began and stay as they are."
ASSUMED_CHANGED = "The season reckons with these from its first morning on."
FINDS_ARE = "Plants found infested are"
FINDS_TREATED = {True: "treated at once", False: "only flagged"}
FINDS_FLAGGED_HOW = "*Plants found infested are*: *only flagged*, under *See all, or change*."
FINDS_ARE_HELP = (
    "Plants that are only flagged stay infested: they infest others, and count when it is decided "
    "whether to treat."
)
BACKGROUND = "Plants infested where nothing is known (%)"
BACKGROUND_HELP = "Far from records, edges and paths. Leave it empty for our guess."
BOUND = "Another route of these hours could expect {share} % more finds at most."
BOUND_BEST = "No other route of these hours can expect more finds."
BOUND_NONE = "No route of these hours can expect more than {finds} finds."
BOUND_HELP = (
    "Whichever plants it visits, no route fixed in the morning can expect more finds. Who plans "
    "again after each find may find more."
)
NO_STOPS = "The working day is too short to reach a plant and come back. Give more working hours."
MESSAGES = "What the import found"
MESSAGES_NONE, MESSAGES_DRAWN = "The files were read as they are.", "The plot is as you drew it."
FEW_PLANTS = Plural(
    "There is room for {n} plant only on this plot. Look whether its outline, and how far rows and "
    "plants are apart, are right.",
    "There is room for {n} plants only on this plot. Look whether its outline, and how far rows "
    "and plants are apart, are right.",
)
RECORDS_OF_BEGIN = "Of the records, as known on {day}, when the season began:"
CHOOSE = "The file leaves this open"
CHOOSE_BUTTON = "Use this"
UPLOAD_BUTTON, UPLOAD_MOST = "Upload", "{size} at most"
WORDS_TAKE = "Take them so"
THESE_ARE_PLANTS = "These are the plants"
CHOOSE_ON_MAP = "Which of these is your plot? Click it on the map, or choose here."
CHOOSE_OTHER, AT_SEA = "Another answer", "in the sea"
LEGEND_ZONE, LEGEND_GRID = "border of a time zone", "grid of {near} and {far}"
ANSWERS_ALT = Plural("Map of {n} place where the plot could lie.",
                     "Map of {n} places where the plot could lie.")  # fmt: skip
RECORDS_ON_MAP = (
    "Which of these is right? *Plot & data* shows on the map where the records then lie, with a "
    "ring round each find. Click it there, or choose here."
)
ANSWER_RECORDS = "{near} of {n} on the plot, {found} {found:find|finds}"
ANSWERS_OF_RECORDS_ALT = Plural(
    "Map of plot {name}: {n} place where the records could lie.",
    "Map of plot {name}: {n} places where the records could lie.",
)
LEFT_OUT = "**The records in {name} are not used on this plot.** What you see does without them."
UNDO_ANSWER = "Take back: {answer}"
# what an answer about a column says of it
ANSWER_OUTLINE = "Take them as the outline"
ANSWER_NO_COLUMN = {"present": "Every record is a find", "plot": "No column names the plot"}
ANSWER_COLUMNS = {"count": "{name}: how many were found", "present": "{name}: found or not",
                  "date": "{name}: the day", "plot": "{name}: which plot"}  # fmt: skip
SEVERITIES = {
    "seen": "Seen",
    "repaired": "Repaired",
    "guessed": "Guessed",
    "dropped": "Left out",
    "doubtful": "Please look",
}
STOPS = "Stops in order"
LEGEND_CHANCE = words.LEGEND_CHANCE
LEGEND_ROUTE, LEGEND_GATE = "route; numbers: its legs, stops from near", "gate: start and end"
LEGEND_DAYS, LEGEND_NEVER = "{n} days ago", "never inspected"
LEGEND_HOT = "hot spot: finds cluster more than chance allows"
LEGEND_TREATED = "treated in the last two weeks"
LEGEND_SEEN, LEGEND_NOT_SEEN = "record: pests seen", "record: none seen"
LEGEND_NOT_KNOWN, TIP_NOT_KNOWN = "record: not known", "not known"
LEGEND_STATES = {"found": "found", "clean": "looked clean", "never": "never inspected"}
LEGEND_RECORDED = "known from records"
LEGEND_NOT_INSPECTED = "could not inspect, or gone"
LEGEND_TRUTH = "infested, not yet found (only a simulation knows)"
# on the map itself, where the browser shows it
MAP_WORDS = {
    "zoom_in": "Closer", "zoom_out": "Further", "whole_plot": "The whole plot", "layers": "Layers",
    "shade": "Plants by", "opacity": "Opacity", "select": "Select plants", "play": "Play the day",
    "time_of_day": "Time of the day", "picture": "Save a picture", "picture_name": "map.png",
    "fold": "Fold the panel away", "unfold": "Show the panel", "sheet": "Pull the day's work up",
    "draw_hint": "Click on the map.", "draw_back": "Back", "draw_drop": "Drop",
    "draw_done": "Finish",
    "play_season": "Play the season", "day": "Day", "film": "Save the season as a film",
    "film_name": "season",
    "lasso_hint": "Draw round the plants; with Shift, to those selected before.",
    "select_rows": "Select rows", "rows_hint": "Tap plants or row numbers: a whole row each.",
    "too_many": "At most {most} plants can be selected at once.",
    "plots_here": "Plots here: {n}",
    "keys": "Map. Arrow keys move it, plus and minus zoom, Enter opens what is under the cross, "
            "Escape leaves.", "corners": "Points: {n}",
    "ground": "Ground", "ground_away": "The ground's pictures cannot be reached.",
    "legend": "What the signs mean",
    "scale": "The scale bar is {bar} long; the arrow points north.",
    "speed": "Speed", "follow": "Follow the robot", "follow_one": "Follow", "whom": "Which robot",
    "driven": "{time} · {stops} stops, {found} found",
    "live": "live, {seconds} s ago", "paused": "paused, {seconds} s ago",
    "lost": "connection lost, last heard {seconds} s ago", "waiting": "not heard yet",
    "failed": "an error, {seconds} s ago", "ended": "not listened to any more",
    "away": "the server is not reached", "unheard": "the broker is not reached",
    "lost_before": "connection lost, not heard since", "idle": "no order yet",
    "held": "waits until more of its way is released", "done": "its order is done",
    "off": "signed off", "elsewhere": "drives another plot",
    "double": "two robots with one serial number",
    # beside a robot on the map, where there is little room
    "robot_paused": "{name}: stands", "robot_lost": "{name}: lost", "robot_failed": "{name}: error",
    "robot_held": "{name}: waits", "robot_done": "{name}: done", "robot_off": "{name}: off",
    "robot_double": "{name}: two of them",
    "here": "Where I am", "corner_here": "Corner where I stand",
    "closer": "From so far away a corner is not exact: come closer, then tap again.",
    "standing": "A corner where you stand, to about {off} m.",
    "rough": "A corner must be known to {most} m, but you are seen to {off} m only. Wait a moment "
             "under open sky, and press again.",
    "nowhere": "The browser says no position: allow it, and open the app over https or on this "
               "machine itself. Or type the position.",
}  # fmt: skip
SEASON_INTRO = (
    "A simulated season on this plot. The start is drawn from the chance map; insects spread to "
    "neighbouring plants at night; every strategy meets the same insects. Found so far is in "
    "percent of all infestations so far."
)
# pests and weather
PEST_AND_WEATHER = "Pest and weather"
PEST_NOTE = (
    "Which pest is looked for, and how warm it was. The chance map then follows that pest's "
    "nights, and the season says when its next generation is due."
)
WHICH_PEST, NO_PEST, OWN_PEST = "Pest", "Any pest: nights are as assumed", "From a file"
PEST_FILE = "Pest: TOML, as the documentation says"
WEATHER_FILE = "Weather by hours or days: CSV or Excel of a station, IPM Decisions JSON"
PEST_USE = "Use these in the season"
PEST_CHANGED = "The season's nights are believed by these from the first on."
PEST_KEPT = "Pest of this season: {pest}."
WEATHER_KEPT = "Its weather: {first} to {last}."
WEATHER_NEEDS_PEST = "Weather goes with a pest, which says what warmth does: choose one."
PEST_PARTS = {
    "stages": "Stages", "generation": "A generation", "increase": "Rate of increase",
    "movement": "How it moves", "entry": "How it enters", "detection": "How it is seen",
    "course": "Its course in a plant",
}  # fmt: skip
CELSIUS = "{n} °C"
PEST_COLUMNS = ("Stage", "Development threshold (°C)", "Degree-days")
PEST_NOT_FOUND = "Not found, or our choice"
PEST_GENERATION = "A generation takes {degree_days} degree-days above {threshold}."
PEST_INCREASE = "Rate of increase a day"
PEST_RATE = "{rate} at {at}"
PEST_MOVES = {
    "adjacent": "It goes to each plant beside it with a chance of {per_day} a day.",
    "exponential": "A plant sends out {per_day} a day, on average {reach} m far.",
    "cauchy": "A plant sends out {per_day} a day, half of them farther than {reach} m.",
}
PEST_RATE_ASSUMED = "Its file does not say that chance: it is assumed."
PEST_WITH_WIND = "It goes with the wind."
PEST_IN_RAIN = "It moves only on days with {rain} mm of rain or more."
PEST_IN_RAINY_HOURS = "It moves only in hours with {rain} mm of rain or more."
PEST_ENTERS = (
    "It comes in with a chance of {edge} a day at the edge, {paths} beside a path, {anywhere} "
    "anywhere."
)
PEST_COURSE = "A plant shows it after {hidden} days and infects others after {latency}."
PEST_COUNT = "What is counted: {what}."
DEGREE_DAYS = "Degree-days"
NEXT_GENERATION = "Next generation around {when}."
GATHERED = "{degree_days} degree-days above {threshold} since {since}, of {needed} a generation."
STAGE_NOW = "Those of that day: {stage}."
NO_GENERATION = "At this warmth the next generation is more than a year away."
GENERATION_MARK = "generation {n}"
NEEDS_WEATHER = "Bring its weather on Plot & data to see when its next generation is due."
NO_DEVELOPMENT = "Its file does not say how warmth brings it on."
DAYS_FILLED = Plural(
    "{n} of the days so far is filled in from those about it: no weather is known.",
    "{n} of the days so far are filled in from those about them: no weather is known.",
)
DEVELOPMENT_NOTE = (
    "Counted from the first find, or the season's first day until there is one. Beyond the "
    "weather's end it goes on as in the same week of other years, or in its last seven days "
    "(dashed)."
)
DAYS, INFESTED, SPREAD, SEED = "Days", "Infested at the start (%)", "Spread a night (%)", "Seed"
VISIT_EVERY = "A visit every (days)"
VISIT_EVERY_HELP = (
    "1: a visit on every day. 7: on days 1, 8, 15 and so on. Between visits nobody inspects, and "
    "insects go on."
)
VISITS_ON = "Visits on {visits} of {days} days: {on}."
VISIT_OF_DAY = "Visit {visit} of {visits}."
NO_VISIT = "No visit on this day. The last one, visit {visit} of {visits}, was on day {day}."
VISITS_CAME_TO = (
    "The whole season: {hours} hours worked, {percent} of the plants inspected a visit."
)
SPREAD_HELP = "Chance a night that an infested plant infests each plant next to it."
AS_BELIEVED = "*Infested at the start* and *Spread a night* begin as the season believes on {day}."
START_AS_BELIEVED = "*Infested at the start* begins as the season believes on {day}."
NIGHTS_OF_PEST = "Spreads as the chosen pest, by its weather where that is known: {pest}."
SEED_HELP = "The same seed gives the same season."
DETECTION_AXIS, DAY_AXIS, FOUND_AXIS = "found so far (%)", "day", "plants found that day"
COMPARED = "Ways to choose the plants"
BOTH_FACES = "Inspect both faces of each row"
SHOW_SAMPLER, SHOW_DAY, SHOW_TRUTH = "On the map", "Day", "Show what is really infested"
LEFT = "Infested left"
FOUND_SO_FAR, FOUND_TODAY, VISITED_TODAY = "Found so far", "Found that day", "Inspected that day"
WORKING = "Working ..."
SEASON_GONE = (
    "There is no season {name} here: its file was moved, renamed or deleted. Put it back into the "
    "folder of seasons, or choose another plot or season."
)
SEASON_GONE_UNKEPT = (
    "What you just did was not kept: the season {name} was renamed or taken off the list "
    "meanwhile. Choose it above by its new name, or bring it back where a plot's file goes, and "
    "do it again."
)
SEASON_RENAMED = "The season {name} is called {new} now. Choose it above by that name."
SEASON_RENAMED_UNKEPT = (
    "What you just did was not kept: the season {name} is called {new} now. Choose it above by "
    "that name, and do it again."
)
HELD = "Another program holds the season {name} (QGIS, a backup?). Waiting until it is free:"
HELD_FOR = Plural("{n} second.", "{n} seconds.")
HELD_STILL = (
    "Another program holds the season {name} (QGIS, a backup?). Close that program and try again; "
    "nothing was changed."
)
TRY_AGAIN = "Try again"
_COMPILING = "so far. This happens once and takes a minute or two; the plan follows by itself."
COMPILING = Plural(
    "fieldmon is being compiled for this machine: {n} part " + _COMPILING,
    "fieldmon is being compiled for this machine: {n} parts " + _COMPILING,
)
OUTLINE_ALT = "Outline of plot {name}; its plants are not laid yet."
STUDY_TITLE = "The thesis's samplers without prior information"
STUDY_INTRO = (
    "Chapter 4 of A. Yehoshua's thesis (2023), made again: our mean and its interval beside each "
    "printed figure. The seven samplers themselves run on your own plot on the pages Simulate and "
    "Compare."
)
STUDY_TABLE, REPLICATES = "Table", "Seasons a row"
STUDY_RUN, STUDY_REPORT = "Run", "Download the report (HTML)"
STUDY_CSV = "Download the table (CSV)"
STUDY_PROGRESS = "{done} of {total} rows simulated"
STUDY_STOPPED = "Stopped. Nothing of it is kept; press Run to begin again."
STUDY_ALT = "Found so far by day, a line a configuration: {title}."

# -- who works, and how numbers are written
EARLIER_SETTINGS = (
    "This day goes by what counted then: {strategy}, from {starts}. Who works, and how long, is "
    "changed on a later day."
)
EARLIER_TEAM = (
    "This day goes by what counted then, for each of the team. Who works, and how long, is changed "
    "on a later day."
)
EARLIER_MEMBER = "{name}: {strategy}, from {starts}"
TEAM = "Team"
TEAM_NAME, TEAM_HOURS, TEAM_SECONDS, TEAM_START = "Name", "Hours", "Seconds", "Starts"
TEAM_ADD_ROBOT, TEAM_ADD_SCOUT = "Add a robot", "Add a scout"
TEAM_TAKE_OUT = "Take {name} out"
TEAM_MORE = "Contact, passing, and the team as a table"
TEAM_TOGETHER = {
    "contact": "Minutes between contacts", "least_gain": "Least gain, in finds",
    "passing": "Headland that two need to pass ({unit})",
}  # fmt: skip
TEAM_TOGETHER_HELP = {
    "contact": "A find of one is known to the others at the next contact; with 0, at once.",
    "least_gain": "Rows are given out anew during a day if that brings so many more finds.",
    "passing": "Where it is narrower nobody meets another head-on. With 0 they pass anywhere.",
}
TEAM_TABLE_NOTE = (
    "Speed, width, gate and more are columns of the table. Download it, fill them in, and bring it "
    "back. Commands take the same table."
)
TEAM_TABLE_OUT, TEAM_TABLE_IN = "Download the table (CSV)", "Bring a table"
TEAM_MANY = "{n} work here. So many are changed as a table, below."
TEAM_LATE = (
    "Another window changed who works since these boxes were filled. They hold what you said; it "
    "is not in use."
)
TEAM_NOW, TEAM_GO_ON = "Show who works now", "Go on with these"
TEAM_IN_SEASON = (
    "Several robots or scouts work in a season, where each has a day of its own: say so where you "
    "begin it, under Today."
)
TEAM_BEGIN = "Several robots or scouts will work"
TEAM_BEGIN_NOTE = (
    "The day above is that of one, as under Who inspects. It is planned for all of these once the "
    "season begins."
)
CHANGE, CHANGE_NOTE = "Use from now on", "Not in use yet. Earlier days stay as they were planned."
CHANGED_LATE = "{day} goes by this too: nothing is recorded of it yet."
CHANGED_LATER = "It counts from now on. {day} stays as it was planned: something is recorded of it."
PLAN_AS_NOW = "Plan this day by what counts now: {strategy}"
LAST_CHANGE = "Changed last: {what}."
UNDO_CHANGE, UNDO_NO_CHANGE = "Take back", "Take the last change back"
DISPLAY, LENGTH, AREA, DATE_LIKE = "Units and dates", "Lengths", "Areas", "Dates like"
LANGUAGE = "Language"
#: said in the other languages only: see `language.is_machine_made`
DRAFT = "A draft: what nobody has translated yet stands in English."
MACHINE_MADE = "Translated by a machine; no native speaker has read it yet."
UNITS = {"m": "m", "km": "km", "ft": "ft", "mi": "mi", "ha": "ha", "dunam": "dunam",
         "acre": "acre"}  # fmt: skip
IN_HOURS = "{hours} h"
IN_PERCENT = "{value} %"
STOP_NUMBER = "stop"

SEASON_NAMED = (
    "A season's name must be letters, digits, spaces and dashes, without \\ / : * ? \" < > | and "
    "no dot in front, but it is {name!r}."
)
SEASON_LONG = "A season's name must have {most} letters at most, but it has {n}."

# -- plants picked on the map
PICKED = "**{plants} selected.**"
PICKED_ALSO, PICKED_NEVER, PICKED_NONE = "Inspect these too", "Not these", "Clear"
WISHED, UNWISHED = "{plants} to be inspected besides.", "{plants} left out."
WISHES_UNMET = Plural(
    "{n:,} of those is not on the route: the hours, or the strategy, do not allow it.",
    "{n:,} of those are not on the route: the hours, or the strategy, do not allow it.",
)
WISHES_GONE = Plural(
    "{n:,} of those is not on the route: that plant is gone.",
    "{n:,} of those are not on the route: those plants are gone.",
)
WISHES_DROP = "As planned before"
WISHES_UNUSED = (
    "Nobody else has this yet: *Use this plan* keeps it with the season, and scouts go by it, too."
)

# -- all plots
PLOTS_TITLE = Plural("{n} plot", "{n} plots")
PLOTS_ALT = Plural("Map of {n} plot: {names}.", "Map of {n} plots: {names}.")
PLOTS_COLUMNS = {"name": "plot", "days_since": "days", "expected": "infested"}
PLOTS_HELP = {"days_since": "days since seen",
              "expected": "expected infested, found and only flagged ones too"}  # fmt: skip
PLOTS_STATES = {
    "fresh": "seen in the last 2 days", "due": "3 to 6 days ago",
    "late": "a week ago or longer, or hardly begun", "new": "no season yet",
}  # fmt: skip
PLOTS_TIP = "{name}: {expected} infested expected, {seen}"
PLOTS_TIP_NEW = "{name}: no season yet"
PLOTS_SEEN = {0: "seen today", None: "never seen", "begun": "begun, less than half a day done",
              "n": Plural("seen {n} day ago", "seen {n} days ago")}  # fmt: skip
PLOTS_PICK = "Click a plot on the map, or a row here."
PLAN_ALL = "Plan all that are due"
PLAN_ALL_OFF = "Without the plan"
PLAN_ALL_CREW = {"robots": "Robots", "robot_hours": "Hours of each robot", "scouts": "Scouts",
                 "scout_hours": "Hours of each scout",
                 "move_min": "Minutes from plot to plot"}  # fmt: skip
ROBOT_NAMED, SCOUT_NAMED = "robot {n}", "scout {n}"
PLAN_ALL_LEAD = Plural(
    "{plants} on {n} plot; expect {finds} finds.",
    "{plants} on {n} plots; expect {finds} finds.",
)
PLAN_ALL_ALSO = "Also plots seen in the last 2 days"
PLAN_ALL_NONE = (
    "No plot is due today: below is why. The box above plans those seen in the last 2 days all the "
    "same."
)
PLAN_ALL_WHEN = "{day}, from {start}."
PLAN_ALL_LATE = "It is {now} already: the times below are those of a whole day, as on Today."
PLAN_ALL_RULE = (
    "Plots come in the order of the infested plants expected there. Each goes to whoever then has "
    "most time for it, and everybody shares his hours among his plots by what is expected. A plot "
    "that would get less than a quarter of an hour waits. From plot to plot takes so many minutes, "
    "wherever they lie."
)
PLAN_ALL_LEFT_OUT = "Left out ({why}): {names}."
PLAN_ALL_LEFT_OUT_MANY = "Left out: {n} plots"
PLAN_ALL_FREE = "Free today: {names}."
PLAN_ALL_FREE_MANY = "Free today: {n} of {all}."
PLAN_ALL_KINDS = "The plots have robots of several kinds: here all are of the usual one."
PLAN_ALL_TEAM = "{plot} has a team of its own ({names}): here those chosen above work there."
PLAN_ALL_NOBODY = "Nobody works: give one robot or scout, or more."
PLAN_ALL_WORKING = "Planning the plots ..."
PLAN_ALL_DOWNLOAD = "Download all routes"
PLAN_ALL_COLUMNS = {"who": "who", "when": "when", "finds": "finds"}
PLOTS_LABEL = "{name}\n{who}, {start}-{end}"
WAYS_IN = {"sample": "Try the sample", "file": "My plot", "season": "Open a season"}
NO_SEASONS = (
    "There is no season here yet. One begins with a plot: bring yours or try the sample, then "
    "press Begin a season on Today. Seasons are files in the folder {folder}: one that was made "
    "elsewhere is put there, or dropped where a plot's file goes."
)
TO_ROUTE = "Show today's route"

# -- today
PLANTS_COUNTED = Plural("{n:,} plant", "{n:,} plants")
FACES_COUNTED = Plural("{n:,} face", "{n:,} faces")
BEGIN_TITLE = "Keep this season"
BEGIN_NOTE = (
    "Begin a season, and everything is kept from here on: routes, what was found, and what that "
    "says about the rest of the plot. Come back to it tomorrow from the list above."
)
KEEPING = "The season's file: backup, name, removal"
BACKUP = "Download a backup"
BACKUP_HELP = (
    "The whole season as one file, as it is now. Dropped where a plot's file goes, it is a season "
    "again."
)
RENAME_TO, RENAME = "New name", "Rename"
RENAME_CODES = "Phones need a new code after that: let them send all they have first."
RENAME_UNSAID = "The season is called {name} already. Type another name."
RENAMED = "The season is called **{name}** now."
REMOVE, REMOVE_YES, REMOVE_NO = "Remove from the list", "Yes, remove it", "Keep the season"
REMOVE_ASKS = (
    "Remove **{name}** from the list? Nothing of it is deleted: its file is moved to `{folder}`. "
    "Phones with a code of it can send nothing any more."
)
REMOVED = (
    "**{name}** is off the list. Its file is `{path}`; it can be brought back where a plot's file "
    "goes."
)
REMOVED_ONES, REMOVED_WHICH = "Seasons taken off the list", "Season"
BRING_BACK, SEASON_TAKE_IN = "Bring it back", "Keep it among the seasons"
SEASON_BACK = "**{name}** is among the seasons, as its file has it."
SEASON_FILE = (
    "**{name}** is the file of a season: as a plot alone it would lose its rows, its days and what "
    "was found. Kept among the seasons it goes on as it was."
)
SEASON_NAME, BEGIN = "Name of the season", "Begin the season"
EARLIER, NO_EARLIER = "Begin with what an earlier season learnt", "Without one"
EARLIER_HELP = (
    "Detection, arrivals and jumps, as a season on this plot or estate learnt them, are a first "
    "guess. It counts little against the finds of this season."
)
BEGIN_ASKS = "**Is this right: {what}?** Not all of it was said, and a season keeps it for good."
BEGIN_RIGHT, BEGIN_NOT_YET = "Right, begin the season", "Not yet"
BEGIN_GATE = "Set the gate on the map"
BEGUN = "Season {name} has begun. Its file is {path}."
START_SCOUTING = "Start scouting"
LAST_VISIT, VISIT_ON = "Last visit", "{day}: {what}"
STEPS = {"look_back": "Earlier visit", "plan": "Plan", "begin": "Keep it", "send": "Take along",
         "record": "Record", "report": "Report", "next_day": "Next day"}  # fmt: skip
STEP_BUTTONS = {"look_back": "Look back", "plan": "Use this plan", "begin": "Begin a season",
                "send": "Send to phone", "record": "Record finds", "report": "Print (PDF)",
                "next_day": "Plan the next day"}  # fmt: skip
STEP_NOTHING, STEP_NO_VISIT = "nothing recorded", "none recorded"
STEP_PLANNED_FOR = "Planned for {day}"
STEP_UNUSED = "first use what you changed, with *Use from now on*, or set it back"
STEP_UNRECORDED = "nothing recorded; if nobody went, record one stop as *could not inspect*"
UNRECORDED = "Planned, and nothing recorded: {days}."
STEP_FOUND = Plural(
    "{found:,} found on {inspected:,} plant",
    "{found:,} found on {inspected:,} plants",
    by="inspected",
)
STEP_KEPT, STEP_REST = "{plan}; {left:,} left", "{plan} left"
STEP_KEPT_ANEW = "{plan}: {done:,} done, {left:,} left; the route as of now has {now:,}"
STEP_OF_ALL = "{own}; all together {all}"
STEP_OTHER = "{plan}, not given out yet; given out before: {kept}"
STEP_NO_STOPS = "no stops"
ROUTE_OF_NOBODY = (
    "The route shown is that of one who works alone; those who are out have their own."
)
HOURS_IN_ALL = "{hours} in all"
STEP_TREATED = Plural("{n:,} plant treated", "{n:,} plants treated")
PLAN_USED = "This is the plan for {day}: it is kept with the season."
SEND_TITLE = "Take the route along"
SEND_SCAN = "**Point the phone's camera here.** It opens the day's work, in the phone's language."
SEND_ALT = "Picture with the address of the day's work, for a phone's camera."
SEND_ALONE = (
    "This page can be seen on this computer only, so a phone cannot open it. Take the route along "
    "as a file; or let others in, as the documentation says, and come here by that address."
)
SEND_FILE = "**Or as a file**, for phones, robots and paper:"
WHY, WHY_TODAY = "Why there", "today"
CHANGED = {"visit": "Since the last visit, {day}", "before": "Since the visit before, {day}",
           "begun": "Since the season began, {day}"}  # fmt: skip
CHANGED_FIRST = "This is the first day of the season; from the next day on, changes stand here."
CHANGED_FINDS = Plural(
    "{found:,} found on {inspected:,} plant inspected on {day}.",
    "{found:,} found on {inspected:,} plants inspected on {day}.", by="inspected",
)  # fmt: skip
CHANGED_NONE = "No inspection of the days before is recorded."
CHANGED_TREATED = Plural("{n:,} plant was treated on {day}.", "{n:,} plants were treated on {day}.")
CHANGED_OUT = "Plants expected to be still infested: {now}; on the evening of {day}: {before}."
CHANGED_HOT = "Hot spots: {now} after {before}."
CHANGED_ROWS = "Rows whose chance rose most, in percentage points: {rows}."
DAY_DONE = Plural(
    "Done on {day}: {found:,} found on {inspected:,} plant.",
    "Done on {day}: {found:,} found on {inspected:,} plants.", by="inspected",
)  # fmt: skip
TODAY_OVER = "The working day is over: plan the next day, or give more hours."
TODAY_DONE = Plural(
    "{inspected:,} plant inspected so far, {found:,} found. The route shows the rest.",
    "{inspected:,} plants inspected so far, {found:,} found. The route shows the rest.",
    by="inspected",
)
FORMAT, DOWNLOAD_AS = "Format", "Download for {reader}"
COLUMN_ARRIVE, COLUMN_ROW, COLUMN_PLANT, COLUMN_CHANCE = "arrive", "row", "plant", "chance"
COLUMN_FACE = "face"
MAP_ALT = "Map of plot {name}. Plants: {plants}; stops on the route: {stops}; found: {finds}."

# -- what stands beside a thing on the map that is pointed at
TIP_PLANT, TIP_GATE, TIP_PATH = "row {row}, plant {plant}{note}", "gate: start and end", "path"
TIP_FACE = "{number}, face {face}"
TIP_ALONE, NEXT_ALONE = "plant {plant}{note}", "Plant {plant}"
SCOUT_LAST_ALONE = "Last: plant {plant}: {result}"
TIP_CHANCE, TIP_STATE = ": {chance} chance", ": {state}"
TIP_LEAST, TIP_MOST = "under 0.1 %", "over 99.9 %"
TIP_CHANCE_BETWEEN = ": {chance} chance ({low} to {high})"
TIP_SEEN_TODAY, TIP_NEVER = "{result} today", "never inspected"
TIP_THEN = "{said}, then {later}"
TIP_SEEN_BEFORE = Plural("{result} {n} day ago", "{result} {n} days ago")
TIP_LOOKS = Plural(", inspected {n} time", ", inspected {n} times")
TIP_FINDS = Plural(", found {n} time", ", found {n} times")
TIP_HOT = "hot spot {n}: {found:,} found of {inspected:,} inspected"
TIP_TREATED, TIP_TREATED_WITH = "treated on {day}", "treated on {day}: {product}"
TIP_RECORD, TIP_SEEN = "record of {day}: {result}", {1: "found", 0: "nothing"}
TIP_INFESTED, TIP_CORNER, TIP_NO_GO = "infested", "corner", "no-go area: not driven through"
LABEL_GATE, LABEL_NO_GO, LABEL_BLOCK = "gate", "no-go", "block {n}"
LEGEND_PLANT = "plant"
LEGEND_HEADLAND, LEGEND_AISLE, LEGEND_NO_GO = "headland", "aisle", "no-go area"

# -- plot and records
AREA_IS, PLANTS_ARE, ROWS_ARE = "Area", "Plants", "Rows"
BEARING_IS, SPACING_IS = "Row direction", "Rows / plants apart"
BEFORE_NOTE = "The plot as it was before the last change is drawn in orange."
BEFORE_DROP = "It is right now"
FOUND_ROWS = "Leave a box empty to take what was found. Plants are laid again at once."
FIXED = "The plants of a season are laid once and for all: its plant numbers stay valid."
ANOTHER_NOTE = (
    "Nothing is recorded yet: another season can be begun with other rows. This one stays as it is."
)
ANOTHER = "Begin another season"
ANOTHER_ELSEWHERE = (
    "This season must be the only plot at hand, but another one is open under My plot: take it "
    "away there, or begin the season from there."
)
ANOTHER_BARE = "The plot is open as it was begun, without its records of pests: bring them, too."
DRAW, DRAW_KIND = "Gate, paths, no-go areas, rows", "A click on the map sets"
DRAW_KINDS = {"": "nothing", "gate": "the gate", "path": "points of a path",
              "no_go": "corners of a no-go area", "row": "how rows bend",
              "cut": "a cut into blocks"}  # fmt: skip
DRAW_HINTS = {"gate": "Click where the gate is.", "path": "Click along the path.",
              "no_go": "Click the corners, one way round.",
              "row": "Drag a handle to bend the row; a click adds one.",
              "cut": "Click from one side of the plot to the other."}  # fmt: skip
DRAW_TYPED = "or type positions (lon,lat lon,lat ...)"
#: as the language writes fractions: with a comma, a space parts the two
DRAW_EXAMPLE = "35.1503,30.3601"
DRAW_ADD, DRAW_DONE, DRAW_UNDO, DRAW_DROP = "Add", "Finish", "Undo the last one", "Drop points"
DRAW_POINTS = Plural("{n} point so far.", "{n} points so far.")
DRAW_LEAST = (
    "{what} needs {least} points or more, but {n} are given. Add points on the map, or type them."
)
DRAW_WHAT = {"gate": "A gate", "path": "A path", "no_go": "A no-go area", "row": "A row",
             "cut": "A cut"}  # fmt: skip
DRAW_CROSSED = (
    "The edge of a no-go area must not cross itself, but it does. Give its corners in order, one "
    "way round."
)
DRAW_WRITTEN = "A position must be written lon,lat such as 35.1503,30.3601, but it is {text!r}."
DRAW_RANGE = "A longitude lies in -180..180 and a latitude in -90..90, but this is {text!r}."
# -- a plot without a file
OUTLINE_BEGIN = "Draw it on the map"
OUTLINE_OR = "No file? Tap the plot's corners on the map, type them, or walk to them with a phone."
OUTLINE = "### Draw the plot"
OUTLINE_NOTE = (
    "Find the place, then tap the corners on the map, one way round. A tap on an edge adds a "
    "corner there. A corner can be dragged; dragged onto the next one, it is gone."
)
OUTLINE_PLACE = "A position, or a link copied from a map"
OUTLINE_PLACE_HELP = (
    "Latitude first, as maps on the internet copy it, or with letters as in N 31.5012, E 34.9034. "
    "A link is only read, not opened."
)
OUTLINE_GO, OUTLINE_ADD = "Show this place", "Add as a corner"
OUTLINE_READ = "Read as latitude {lat}, longitude {lon}: {where}."
PLOT_LIES = "It lies at latitude {lat}, longitude {lon}: {where}."
OUTLINE_TURN = "Exchange latitude and longitude"
OUTLINE_STANDING = (
    "With a phone in the field: *Where I am* and *Corner where I stand*, on the map. The browser "
    "asks you first. A computer without GPS asks a service of the browser's maker for its position."
)
OUTLINE_NO_MAP = "Without a map from the internet there is a grid to measure by."
OUTLINE_EDGES = "Edges in order: {edges}."
OUTLINE_SAID = Plural("{n} corner, {area}", "{n} corners, {area}")
OUTLINE_CROSSES = "{n} corners; the edges after corners {one} and {other} cross"
OUTLINE_USE, OUTLINE_LEAVE = "This is my plot", "Back to the files"
OUTLINE_CORRECT, OUTLINE_DOWNLOAD = "Correct the corners", "Download the boundary (GeoJSON)"
OUTLINE_NAME = "My plot"
OUTLINE_ON_MAP = Plural("Map on which a plot is drawn: {n} corner so far.",
                        "Map on which a plot is drawn: {n} corners so far.")  # fmt: skip
OUTLINE_HINT = "Tap the corners of the plot, one way round."
OUTLINE_LEAST = (
    "A plot needs three corners or more, but {n} are set. Tap more on the map, or type them."
)
OUTLINE_CROSSED = (
    "The edge of a plot must not cross itself, but the edge after corner {one} meets the one after "
    "corner {other}. Set the corners in order, one way round, or drag one that is out of order."
)
OUTLINE_WIDE = (
    "A plot that is drawn must fit within {most}, but from end to end these corners are {wide} "
    "apart. Take back the corner that lies far off; draw plots that lie apart one by one."
)
OUTLINE_SMALL = (
    "The corners of a plot must enclose an area, but these {n} enclose next to none. Come closer "
    "on the map, and drag them to where they belong."
)
OUTLINE_WRITTEN = (
    "A position must be written latitude, longitude such as 31.5012, 34.9034, but it is {text!r}. "
    "Copy it from a map, or type it so."
)
OUTLINE_LINK = (
    "A link must hold a position, as those of OpenStreetMap, Google, Apple or Bing do in the "
    "address bar, but {text!r} holds none. Open it, move the map a little and copy the address "
    "again, or copy the position itself."
)
OUTLINE_RANGE = (
    "A latitude lies in -90..90 and a longitude in -180..180, but this is {text!r}. Correct it."
)
DRAW_NOTE = "Insects come in along paths; a no-go area carries no plants and is not driven through."
BEND_ROW = "Row to bend; the others follow it"
BEND_MAKES = Plural(
    "This makes {n:,} row with {plants}. It is drawn over the plot.",
    "This makes {n:,} rows with {plants}. They are drawn over the plot.",
)
BEND_USE, BEND_DROP = "Use these rows", "Drop them"
DIRECTIONS = "Which way do the rows run?"
DIRECTIONS_NOTE = (
    "The plants stand in rows several ways, as in a square or triangular planting. Each way is "
    "drawn over the plants. The longest rows are taken until you choose."
)
DIRECTION = Plural(
    "{number} · {bearing}° · {n} row, {apart} apart",
    "{number} · {bearing}° · {n} rows, {apart} apart",
)  # fmt: skip
DIRECTIONS_AGAIN = "Show every way again"
BLOCKS = "Blocks"
BLOCKS_NOTE = (
    "Leave a box empty for rows along the block's longest side, as far apart as elsewhere."
)
BLOCK = "**Block {name}**"
NO_ROWS = "The plants stand in no rows"
NO_ROWS_HELP = "They are visited one by one, by nearness."
RISK, RISK_FILE = "Risk from a raster", "GeoTIFF: NDVI, elevation, a risk map"
RISK_NOTE = "One more reason for a plant to be infested, beside records, edges and paths."
RISK_MEANS, RISK_AS_FILE = "Its numbers are", "what the file says"
RISK_MEANINGS = {
    "chance": "chances, 0 to 1",
    "percent": "chances in percent",
    "rank": "only an order: the higher, the more risk",
    "score": "scores: far above the average is much more risk",
}
RISK_SHARE, RISK_LOW = "Plants infested for this reason (%)", "Low numbers are the risky ones"
MISSING, MISSING_FILE = "Missing plants from a raster", "GeoTIFF: canopy height, NDVI"
MISSING_NOTE = (
    "No plant stands where the canopy is low. Rows and aisles stay as they are; plants that the "
    "raster does not show count as there."
)
MISSING_BELOW = "A plant is missing where the raster is below"
RECORDS, RECORDS_NONE = "Records up to", "There are no records of this plot."
RECORDS_SHOWN = "{shown:,} of {all:,} records shown ({found:,} with pests, {clean:,} without)."
UNDATED = "Records without a date are always shown."

# -- the map of the field
SHADES = {"chance": "chance of infestation", "state": "found, clean, never inspected",
          "age": "days since inspected"}  # fmt: skip
MAP_LAYERS = {"before": "as it was before", "route": "route", "numbers": "stop numbers",
              "hot": "hot spots", "treated": "treated", "records": "records", "rows": "row numbers",
              "plan": "plan of the plot", "ground": "ground", "grid": "grid"}  # fmt: skip

# -- to treat or not
DECIDE_NEEDS_SEASON = (
    "**To treat or not** is answered from what was inspected. Begin a season and record a day."
)
DECIDE_AREA, DECIDE_LIQUID = "To be sprayed, of the area under plants", "Liquid"
DECIDE_LITRES = "{value} l"
DECIDE_INSIDE, DECIDE_OUTSIDE = "Infested in the zones", "Infested elsewhere"
DECIDE_SAVING = "Costs less than the whole plot by"
DECIDE_ENOUGH = "Chance that it is enough"
DECIDE_SAVING_HELP = (
    "Less than spraying the whole plot, in the currency in which the costs are given. The infested "
    "plants elsewhere lose {lost}, which is no part of it."
)
DECIDE_ENOUGH_HELP = "That the plot is below the action threshold once the zones are treated."
DECIDE_ZONES = Plural("{n} zone", "{n} zones")
DECIDE_ZONE, DECIDE_ROWS, DECIDE_PLANTS = "zone", "rows", "plants of the row"
DECIDE_INFESTED, DECIDE_ITSELF, DECIDE_WRONG = "infested", "by itself", "may be wrong"
DECIDE_WRONG_HELP = (
    "By itself: whether this zone alone needs treating. May be wrong: the chance that this answer "
    "is wrong; where it says inspect more, that treating would be needless."
)
DECIDE_VERDICTS = {"treat": "treat", "do not treat": "do not treat", "inspect more": "inspect more"}
DECIDE_NUMBERS = "numbers of the zones"
DECIDE_ON_MAP = "zones to treat"
DECIDE_TIP = Text("Zone {zone}: {share:.0%} infested; {verdict}")
DECIDE_SPRAYER, DECIDE_COSTS, DECIDE_PRODUCT = "Sprayer", "Costs, in any currency", "Product"
DECIDE_BOXES = {
    "level": "Treat from, % of the plants infested", "sure": "Sure of it, %",
    "rate": "Rate, l/{area}", "rows": "Rows of a section (0: knapsack)",
    "on": "Least length of a zone, {length}", "off": "Least gap between two, {length}",
    "ring": "Knapsack: plants around each", "per_ha": "{one_area}: product, water, work",
    "per_zone": "Each zone", "loss": "An infested plant, a day",
    "days": "Days that it stays infested", "works": "Treating cleans, %",
    "reserve": "Never sprayed, for predators, %",
}  # fmt: skip
DECIDE_LEAVES = "By another action threshold, or by leaves counted"
DECIDE_THRESHOLD = "Action threshold"
DECIDE_OWN, DECIDE_OWN_TAKE = "Action thresholds of your own (CSV)", "Take these thresholds"
DECIDE_OWN_HELP = (
    "Columns name, measure, level and source; the measure is share of plants, share of leaves or "
    "mean per leaf. They are kept until the page is closed."
)
DECIDE_OWN_KEPT = Plural("{n} threshold can be chosen now.", "{n} thresholds can be chosen now.")
DECIDE_TAKE = Text("Treat once {share:.1%} of the plants are infested")
DECIDE_THRESHOLDS = {
    "almond": "almond", "almond with predators": "almond with predators",
    "strawberry before fruit": "strawberry before fruit",
    "strawberry in fruit": "strawberry in fruit", "peppermint": "peppermint",
}  # fmt: skip
DECIDE_LOOKED_AT, DECIDE_COUNTED = "Leaves looked at", "Animals counted on them"
DECIDE_PRESENCE, DECIDE_LEAVES_INFESTED = "Only infested leaves were counted", "Infested leaves"
DECIDE_FILE, DECIDE_DOWNLOAD, DECIDE_PDF = "Zones as a file", "Download the zones", "Page to print"
DECIDE_FILES = {
    "xml.zip": "terminal: ISOXML 4, areas", "grid1.xml.zip": "terminal: ISOXML 4, grid of zones",
    "grid2.xml.zip": "terminal: ISOXML 4, grid of rates",
    "v3.xml.zip": "older terminal: ISOXML 3, areas",
    "v3.grid1.xml.zip": "older terminal: ISOXML 3, grid of zones",
    "v3.grid2.xml.zip": "older terminal: ISOXML 3, grid of rates",
    "shp.zip": "farm program: shapefile", "gpkg": "farm program: GeoPackage",
    "geojson": "web map: GeoJSON", "kml": "phone: KML", "tif": "map of rates: GeoTIFF",
}  # fmt: skip

HOT_TITLE = "Hot spots"
HISTORY, HISTORY_TAP = "History of a plant", "Tap a plant on the map, or give its row and number."
HISTORY_ROW, HISTORY_PLANT, HISTORY_FACE = "Row", "Plant", "Face"
HISTORY_NOW = Text("Chance of infestation now: **{now}** (first morning: {first}).")
HISTORY_BETWEEN = Text("If the plot had fewer or more than expected: {low} to {high}.")
HISTORY_CHANCE = (
    "A chance says all that is believed of one plant. Its interval says what the chance would be "
    "at the low and high end of what the plot as a whole may have (90 %)."
)
HISTORY_TREATED = (
    "It was found infested, and in this season plants found are taken as treated at once: from "
    "then on it counts as clean, and its chance grows again as insects come from its neighbours."
)
HISTORY_STOP = "Stop {n:,} of {all:,} on the day's route, at {time}."
HISTORY_NO_STOP = "Not on the day's route."
HISTORY_NEVER = "Never inspected."
HISTORY_LINE = "{day}{time}: {result}"
HISTORY_SPRAYED, HISTORY_SPRAYED_WITH = "treated", "treated with {product}"
HERE, HERE_RESULTS = "**Row {row}, plant {plant}**", {0: "Record as clean", 1: "Record as found"}
HISTORY_RESULTS = {0: "clean", 1: "found", 2: "could not inspect"}

# -- the ground under the plot
GROUND = "Ground under the plot"
GROUND_NOTE = (
    "So that the plot is recognised at a glance. A file stays on this machine; nothing is asked of "
    "the internet for it."
)
GROUND_FILE = "Picture or heights (GeoTIFF), or a map in tiles (MBTiles, PMTiles)"
GROUND_SHOWS = "The file shows"
GROUND_KINDS = {"picture": "a picture of the ground", "heights": "heights, drawn as relief"}
GROUND_KEPT = "Kept with the season: {name}"
WEB_MAP = "Map from the internet"
WEB_MAPS = {"": "none", "osm": "OpenStreetMap", "other": "another, by its address"}
WEB_MAP_ADDRESS = "Address of its tiles"
WEB_MAP_HELP = (
    "As a provider of aerial pictures writes it, with {z}, {x} and {y} ({-y} where rows count from "
    "the south). Whether you may use it, the provider says."
)
WEB_MAP_LIKE = (
    "The address of a map must begin with https:// and hold {{z}}, {{x}} and {{y}} after the "
    "server's name, but it is {address!r}. Copy it as the provider writes it."
)
WEB_MAP_ASK = (
    "**Ask {host} for pictures?** Each browser that shows this plot then asks {host} for pictures "
    "of the area in view. {host} learns that browser's internet address, and which area is looked "
    "at and when. It is told nothing else: no plants, no finds, no names."
)
WEB_MAP_SEASON = "This holds for this season on this machine, until you take it back."
WEB_MAP_SESSION = "This holds until you close this page, or take it back."
WEB_MAP_AGREE = "Agree: show pictures from {host}"
WEB_MAP_AGREED = "Pictures come from {host}, as agreed on {day}: it sees which area is looked at."
WEB_MAP_BACK = "Stop asking {host}"

# -- the season
NEEDS_SEASON = (
    "### Begin a season first\n"
    "This page shows what was found day by day. Begin a season on the Today page; then record "
    "what was found here, by hand, from a file, or with scout mode."
)
LEAST, MOST = "at least (90 %)", "at most (90 %)"
EXPECTED_LEFT, EXPECTED_HELP = "Still infested", "Expected, and the interval that holds 90 %."
CLEAN_CHANCE, DETECTED = "Chance that the plot is clean", "Share found"
NOT_KNOWN_YET = "not known yet"
DETECTED_HELP = (
    "Plants found so far, in percent of these and of those not found yet. Plants that a treatment "
    "cleaned before anybody found them are in neither: the share rises with it."
)
INSPECTED_EVER = "Inspected so far"
FOUND_EVER = "Found"
FOUND_AGAIN = (
    "{finds} finds on {plants} {plants:plant|plants}: {again} of them on plants that had been "
    "found on an earlier day. Days count finds, the figure above counts plants."
)
RECORD, RECORD_NOTE = "Record what was found", "Each recording is kept at once and can be undone."
INSPECTED_BY, NOBODY_SAID = "Who inspected", "Nobody said"
INSPECTED_BY_ANOTHER, INSPECTED_BY_NAME = "Another name ...", "Name of who inspected"
INSPECTED_BY_UNSAID = (
    "Another name must be typed where one is chosen, but the box is empty. Type who inspected, or "
    "choose somebody."
)
INSPECTED_BY_HELP = "Of inspections of which the file itself does not say who made them."
CORRECTED_BY = "Who corrected"
CORRECTED_BY_HELP = (
    "Inspections that QGIS or QField changed or deleted in a copy of this season come in as "
    "corrections, under this name."
)
CORRECTED_UNSAID = (
    "Corrections must have an author, but nobody is named. Say who corrected the inspections."
)
CORRECT_WHEN, CORRECT_BUTTON = "Correct the day or time of an inspection", "Correct"
CORRECT_WHEN_NOTE = "What is left empty stays as it is. Undo brings back what stood there before."
CORRECT_WHICH, CORRECT_DAY, CORRECT_TIME = "Inspection", "Right day", "Right time"
CORRECT_UNSAID = (
    "A day or a time must be said that is right, but both boxes are empty. Fill in one or both."
)
CORRECT_BOTH = "Correct it all the same, both hold"
CORRECTED = Plural("{n} correction taken", "{n} corrections taken")
RECORD_FILE_IN = (
    "The route file with its found column filled in, any table or GPS file with plants, rows "
    "or positions, a copy of this season that somebody worked on or QGIS or QField changed, or "
    "what a phone saved as not sent"
)
TAKE_DOUBTFUL = "Take doubtful results too"
MERGE = "Merge"
MERGE_COPY = (
    "**{name} is a copy of this season.** Merge takes in all that it holds, each once; Record "
    "takes its results alone. Nothing is written yet."
)
MERGE_BRINGS, MERGE_BROUGHT = (
    "It holds what this season lacks:",
    "**{name} was merged.** It brought:",
)
MERGED = "{name} was merged. What it brought stands under *A file*."
MERGE_OR_CORRECT = "Record takes what was changed there as corrections: say who corrected."
MERGE_BRINGS_NOTHING = "**{name} is a copy of this season**, and holds nothing that this one lacks."
MERGED_NOTHING = "{name} held nothing that this season lacks, any more. Nothing changed."
MERGE_NEW = Plural(
    "{n:,} inspection, {found:,} found ({days})",
    "{n:,} inspections of {plants:,} {plants:plant|plants}, {found:,} found ({days})",
)
MERGE_BY, MERGE_BY_ONE, MERGE_NOBODY = "inspected by {who}", "{who} ({n:,})", "nobody named"
MERGE_TREATED = Plural("{n} treatment: {what}", "{n} treatments: {what}")
MERGE_TAKEN_BACK = Plural(
    "{n:,} inspection that counts here was taken back or corrected there",
    "{n:,} inspections that count here were taken back or corrected there",
)
MERGE_CHOSEN = "choices: {what}"
MERGE_CODES = (
    "codes of {who}, which read this season and record into it: take back what you do not know"
)
MERGE_MOVED = "recordings get other numbers; the log has both"
MERGE_LOG = Plural("{n:,} entry of its log", "{n:,} entries of its log")
MERGE_DIFFERS = Plural("{n} thing to check:", "{n} things to check:")
MERGE_BACK = (
    "Below, under *Recorded so far*, each recording that came can be taken back. The season's log "
    "has this merge, and the copy's own entries below it; the copy itself stayed as it is."
)
RECORD_ONE, RECORD_ROUTE, RECORD_UPLOAD = "One plant", "Today's route", "A file"
RESULT, COUNT, RESULTS_OF = "Result", "Count", {
    0: "clean", 1: "found", 2: "could not inspect", 3: "gone",
}  # fmt: skip
RECORD_BUTTON, RECORDED = "Record", "{new} recorded, {known} known before."
NOTED = Plural("{n} note added to what was known.", "{n} notes added to what was known.")
COMPLETED = Plural("{n} known inspection was completed.", "{n} known inspections were completed.")
BY_A_SECOND = Plural(
    "{n} known inspection was made by a second person, too: it counts once.",
    "{n} known inspections were made by a second person, too: they count once.",
)
RECORDED_OF = "Recorded for {days}; this page is about {day}."
LEFT_OUT_CONTRADICTING = Plural(
    "{n} contradicting result left out.", "{n} contradicting results left out."
)
RECORD_REST = (
    "Say how many stops were done, from the first: they are recorded as clean, unless marked as "
    "found. A mark counts wherever it stands."
)
RECORD_STOPS = "Stops done"
RECORD_GIVEN_OUT = (
    "**These are the stops of the route given out.** The map shows what is left, planned anew: its "
    "stops are others."
)
RECORD_UNSAID = (
    "Something must be said before it is recorded, but no stop is done and none is marked. Say how "
    "many stops were done, or mark those where pests were found."
)
MOVED_HERE = (
    "Something was typed while the page of another day was still in view. It stands in the boxes "
    "of **{day}** now: check it before you record."
)
ONE_UNSAID = (
    "Row, plant and result must be said before they are recorded, but one of them is empty. Fill "
    "in all three."
)
ONE_FACE_UNSAID = (
    "A plant with two faces must be recorded with the one that was inspected, but none is chosen. "
    "Choose its face, or tap it on the map."
)
_CONTRADICTING = (
    "what is recorded or brought of the same plants and day. Nothing is recorded yet. Which holds?"
)
CONTRADICTING = Plural(
    "{n} result from {source} contradicts " + _CONTRADICTING,
    "{n} results from {source} contradict " + _CONTRADICTING,
)
CONTRADICTING_NO_MORE = Plural(
    "{n} result from {source} is not recorded yet, and contradicts nothing any more.",
    "{n} results from {source} are not recorded yet, and contradict nothing any more.",
)
NOT_RECORDED = Plural(
    "{n} result from {source} was not recorded: it contradicted what is recorded, and the page was "
    "loaded anew before it was said what holds. Bring it again.",
    "{n} results from {source} were not recorded: some contradicted what is recorded, and the page "
    "was loaded anew before it was said what holds. Bring them again.",
)
RECORDED_HOLDS = "The recorded one holds"
RECORD_THESE = Plural("Record this", "Record these {n}")
AND_MORE = "... and {n} more."
LEAVE_OUT = Plural("Leave these out, record the other one", "Leave these out, record {n} others")
LEAVE_OUT_ONLY = "Leave these out"
HOLDS = Plural("The new one holds", "The new ones hold")
CONFIRM = Plural("Record this too, both hold", "Record these {n} too, both hold")
RECORD_NONE = "Record nothing"
NOTICE_CLOSE = "Close this message"
BATCHES, UNDO, UNDONE = "Recorded so far", "Undo", "undone"
COUNTS_ELSEWHERE, CORRECTED_SINCE = "counts in another recording", "corrected since"
BATCHES_MORE = "Show {n} more"
REDO, REDONE_BEFORE = "Redo", "This counts again already. Nothing changed."
UNDO_ASK = "Take this back? It can be redone here."
UNDO_ASK_WHO = "{who} recorded it; a phone that has it is told so."
UNDO_ASK_DAY = "It is of {days}, and this page is about {day}."
UNDO_YES, UNDO_NO = "Take it back", "Leave it"
UNDONE_BEFORE = "This was taken back already, perhaps in another window. Nothing changed."
RESULT_COUNTED = "{result}, count {n}"
UNDONE_WHAT, AGAIN_WHAT = "Undone: {what}.", "Counts again: {what}."
UNDONE_FROM, UNDONE_WITH = "Undone: {what} from {source}.", "Undone: {what} with {product}."
BATCHES_SAID = {
    "findings": Plural("{n:,} plant, {found:,} found", "{n:,} plants, {found:,} found"),
    "treatment": "treatment {source}",
    "corrections": "corrections: {source}",
}
BATCH_OF_DAY, BATCH_EFFICACY = "inspected {days}", "efficacy {share}"
# as a season's file names them, in English: another language may be read later
BATCH_SOURCES = {"typed in": "typed in", "route table": "route table", "scout mode": "scout mode",
                 "phone": "phone"}  # fmt: skip
TREAT, TREAT_EFFICACY, TREAT_PRODUCT = "Treatment of the plot", "Efficacy (%)", "Product"
TREAT_ROWS, TREAT_ROWS_HELP = "Rows (empty: the whole plot)", "Rows as people count, such as 3-5,8."
TREAT_SELECTED = "Only the {plants} selected on the map"
TREAT_TWICE = (
    "A treatment is of rows, of what is selected on the map or of a file's area, but two of them "
    "are said. Leave one."
)
TREAT_FILE = "File of the area that was sprayed"
TREAT_FILE_HELP = "As it was downloaded on Decide, or any file of areas."
TREATED_PART = "Treatment noted, of {plants}."
TREAT_UNSAID = (
    "The efficacy of a treatment must be said, but it is empty. Give the percentage of pests that "
    "it kills, as on the label or by experience."
)
TREAT_SHARE = (
    "The efficacy must be said in percent, but {said:g} was given, which is hardly any. Give "
    "{meant:g} for {meant:g} %, or 0 if it kills none."
)
DECIDE_TREATED = "The zones were treated"
DECIDE_TREATED_NOTE = (
    "Noted are the zones that you see here: {plants}, {area}. If others were sprayed, from a file "
    "of before, drop that file."
)
DECIDE_ASKED_SINCE = (
    "What is asked was changed since these zones were drawn, so nothing was noted. Look at the "
    "zones as they are now, and note the treatment again."
)
TREAT_RECORD = "What a certifier asks: dose, waiting period, who and why"
TREAT_DOSE, TREAT_UNIT = "Dose of the product", "Unit of the dose"
TREAT_WATER = "Water, l/{area}"
TREAT_GROUP, TREAT_GROUP_HELP = "IRAC group", "The mode of action, such as 6, or 4A+28."
TREAT_WAIT, TREAT_ENTRY = "Days until harvest", "Hours until re-entry"
TREAT_BY_LABEL = "Empty: as the season's label table says, where it does."
TREAT_BEGAN, TREAT_ENDED = "Began at", "Ended at"
TREAT_ENDED_HELP = "Empty: waiting periods count from the end of the day."
TREAT_TEXTS = {
    "operator": "Operator",
    "reason": "Reason",
    "machinery": "Machinery",
    "crop": "Crop",
    "pest": "Pest",
    "authorised_by": "Authorised by",
    "active_ingredient": "Active ingredient",
    "weather": "Weather then",
}
TREAT_DOSE_UNSAID = (
    "A dose must have a number and a unit, but one of them is empty. Write both, such as 0.5 and "
    "l/ha, or none."
)
HARVEST, HARVEST_KEPT = "First day of harvest", "The first day of harvest was changed."
HARVEST_HELP = "Treatments whose waiting period is not over by then are warned of."
KEPT_CLOSED = (
    "The plan kept of this day leads where people may not be yet (plants: {n:,}). Plan it anew."
)
KEPT_ALL_CLOSED = (
    "The plan kept of this day leads where people may not be yet (plants: {n:,}). Give it to "
    "nobody."
)
HARVEST_FROM = "After the treatments so far, harvest is allowed from **{day}** on."
WAIT_OF, WAIT_BUTTON = "Days from {product} until harvest", "Its label says so"
WAIT_HELP = "0 only where the label says so. Empty: not known, and no day of harvest is named."
WAIT_UNSAID = (
    "The days that the label says must be typed first. While they are not known, leave it."
)
WAIT_KEPT = "How long to wait from {product} is kept among the season's labels."
LABELS, LABELS_IN = "What labels allow", "Your label table (CSV)"
LABELS_NOTE = (
    "A table of yours: product, crop, pest, max dose, unit, waiting days, re-entry hours, IRAC "
    "group, max uses, source. Treatments are held to it; no law is made up."
)
LABELS_BUTTON = "Take these labels"
LABELS_KEPT = Plural("{n} label is kept.", "{n} labels are kept.")
EFFECTS = "Whether treatments worked"
EFFECTS_TREATED = (
    "Plants found infested are taken as treated at once in this season: what that did is in these "
    "figures too."
)
TREAT_BUTTON, TREATED = "Note the treatment", "Treatment noted."
TREATED_BEFORE = "This treatment was noted already; nothing changed."
ROW_AGES, DAYS_SINCE, ROW_AXIS = "Days since each row was inspected", "days", "row"
OUT_AXIS, INSPECTED_AXIS, DATE_AXIS = "infested, not found yet (expected)", "inspected", "day"
ROW_NEVER, ROW_TODAY = "never", "today"
EVERY_ROW = "Every row was inspected."
NEVER_ROWS = Plural(
    "{n} of {all} rows was never inspected.", "{n} of {all} rows were never inspected."
)
LEARNT_TITLE = "What the inspections tell of the insects"
LEARNT_AT_FIRST = "Nothing was inspected yet: this is what is believed at first."
LEARNT_INTERVALS = "In brackets: intervals that hold with a chance of 90 %."
LEARNT_COUNTS_FOR = (
    "Chances go by the detection learnt; routes and their finds go by what is said of who inspects."
)
AHEAD_TITLE, AHEAD_AXIS = "If nobody inspects from now on", "infested (expected)"
AHEAD = (
    "About {last} plants are infested after {nights} nights without inspections ({low} to {high} "
    "with a chance of 90 %); now it is about {now}."
)
AHEAD_BASIS = {
    "none": "No weather is known: every night is taken as the season's settings say.",
    "forecast": "By the weather forecast.",
    "measured": "By the weather measured.",
    "partly": "By the weather forecast for {n} of the nights, and the usual of the date after it.",
    "partly_measured": (
        "By the weather measured for {measured} of the nights, and the usual of the date after it."
    ),
    "both": (
        "By the weather measured for {measured} of the nights and forecast for {n}, and the usual "
        "of the date after it."
    ),
    "both_all": "By the weather measured for {measured} of the nights, and forecast for {n}.",
    "usual": "By the usual weather of the date: there is no forecast.",
}
NOT_LEARNT = "This season traces finds to the plants next to them only, as it did when it began."

# -- scouting
SCOUT_NEEDS = (
    "### Scouting keeps what you find\n"
    "Begin a season on the Today page first; then each tap here is saved at once."
)
NEXT, NEXT_PLACE = "Next", "Row {row} · plant {plant}"
NEXT_WAY = "{metres} {compass}{along}"
NEXT_ALONG = ", in this row"
NEXT_AISLE = ", change rows"
NEXT_CHANCE = Text("Chance {chance} · {done:,} done, {left:,} to go · {hours} left")
COMPASS = ("north", "north-east", "east", "south-east", "south", "south-west", "west",
           "north-west")  # fmt: skip
ARROWS = ("⬆️", "↗️", "➡️", "↘️", "⬇️", "↙️", "⬅️", "↖️")
CLEAN_BUTTON, FOUND_BUTTON = "Clean", "Found"
SKIP_BUTTON, GONE_BUTTON, UNDO_BUTTON = "Could not inspect", "Plant is gone", "Undo"
COUNT_LABEL = "Pests counted (if found)"
SCOUT_DONE = Plural(
    "### Done for today\n{inspected:,} plant inspected, {found:,} found.",
    "### Done for today\n{inspected:,} plants inspected, {found:,} found.", by="inspected",
)  # fmt: skip
SCOUT_DONE_OF = Plural(
    "### Nothing to inspect on {day}\n{inspected:,} plant inspected, {found:,} found.",
    "### Nothing to inspect on {day}\n{inspected:,} plants inspected, {found:,} found.",
    by="inspected",
)
SCOUT_START = (
    "Work starts at {start} by the settings of this season; it is {now}. The hours run from the "
    "first plant recorded."
)
SCOUT_NOW = "Begin now"
SCOUT_LONGER, SCOUT_LONGER_NOTE = "One hour more", "The working day is over. Work on?"
SCOUT_LAST = "Last: row {row}, plant {plant}: {result}"

# -- comparing
COMPARE_INTRO = (
    "Seasons are simulated on this plot: the start is drawn from today's chance map, and every "
    "strategy meets the same insects. Less loss (infested plants times days) is better. Once this "
    "tab is closed it waits, and stops after two minutes; *Go on* continues."
)
COMPARE_ASSUMED = (
    "Assumed: insects spread to the plants next to them only, and plants found are treated at once."
)
STRATEGY_SAMPLERS, STRATEGY_HOURS = "Ways to choose the plants", "Working hours"
WHOSE_DAY = "Whose day"
STRATEGY_INSPECTION_S, STRATEGY_ROBOTS = "Seconds at a plant", "Robots"
STRATEGY_ROBOTS_HELP = (
    "Several share the aisles out by what is believed, and hear of each other's finds every half "
    "hour; who reads no chances keeps to a section of its own."
)
SEEDS, SEEDS_HELP = "Seasons each", "More seasons, narrower intervals."
DRIVE_INTRO = (
    "Watch the robot drive the day between the rows: what it finds lights up, and the chances "
    "change as it learns. Nothing is recorded."
)
DRIVE_SOURCE = "Which day"
DRIVE_SOURCES = {"planned": "The planned day", "recorded": "A driven day", "live": "Live"}
DRIVE_LIVE = (
    "Robots that speak VDA 5050, listened to where their messages are exchanged. Nothing is sent "
    "and nothing is recorded here: `fieldmon drive --robot vda5050` does that, and goes on when "
    "you stop watching or close this tab."
)
DRIVE_BROKER, DRIVE_MANUFACTURER = "MQTT broker", "Manufacturer"
DRIVE_WHOSE = "Which robots"
DRIVE_WHOSE_KINDS = {"named": "By serial number", "all": "All of this manufacturer"}
DRIVE_SERIALS = "Serial numbers, with commas between them"
DRIVE_VDA = "Version of VDA 5050"
DRIVE_WATCH, DRIVE_WATCH_STOP = "Watch", "Stop watching"
DRIVE_NO_BROKER = (
    "No MQTT broker answers at {where}. Start one there, or say where it is in the box *MQTT "
    "broker*."
)
DRIVE_NOT_LET_IN = (
    "The MQTT broker at {where} does not let us in. Say it in the box *MQTT broker* as it knows "
    "you: mqtt://USER:PASSWORD@HOST:PORT."
)
DRIVE_CUT_OFF = (
    "The MQTT broker is not reached any more, and is sought again. What is shown is what was heard "
    "before."
)
DRIVE_NOT_HEARD = (
    "Not heard yet: {names}. Does it run, and are its manufacturer, its serial number and the "
    "version of VDA 5050 right?"
)
DRIVE_NOBODY = "No robot of {manufacturer} has been heard of at the broker yet."
DRIVE_DOUBLE = (
    "Two robots speak as {name}: places and finds of both are taken for those of one. Give each a "
    "serial number of its own."
)
DRIVE_ELSEWHERE = (
    "{name} drives another plot than this one: it is not on the map, and its finds do not count."
)
DRIVE_FAILED = "{name} reports an error that it cannot mend: {said}"
DRIVE_BATTERY = "battery {share} %"
DRIVE_INSPECTED = "{n} inspected, {found} found"
DRIVE_ENDS = "planned until {time}"
DRIVE_ROBOT = "Robot"
DRIVE_ROBOTS = {"charged": "Planned times", "mujoco": "Physical simulation"}
DRIVE_MADE_UP = (
    "The finds are made up: insects are drawn from the chance map, on this share of the plants. "
    "Once this tab is closed the drive waits, and is given up after two minutes."
)
DRIVE_SHARE = "Infested plants (%)"
DRIVE_BELIEVES = "This share is what the season believes on {day}."
DRIVE_RUN = "Drive the day"
DRIVE_DONE = Plural(
    "Driven: {n:,} stop, {found:,} found, {time}.", "Driven: {n:,} stops, {found:,} found, {time}."
)
DRIVE_STOPPED = "The drive was stopped: its day is thrown away, and nothing of it is kept."
DRIVE_PROGRESS = "{share} % of the day driven"
DRIVE_FILE = "Bag (.mcap) or stops (.stops.csv) that `fieldmon drive` wrote on this plot"
DRIVE_BELIEVED = (
    "Of a file only the way and the finds are known; chances are taken from this plot's map."
)
DRIVE_KEYS = "Space plays and pauses. Moving the map lets go of the robot."
DRIVE_ALT = "{name} from above and aside: the robot among the rows."
RUN, STOP, GO_ON = "Compare", "Stop", "Go on"
COMPARE_PROGRESS = "{done} of {total} seasons simulated"
COMPARE_EMPTY = "Choose and press Compare. Results appear as they come."
TOO_MANY = "Compare 1 to {most} strategies at once, but these are {n}. Choose fewer."
BEST, NO_DIFFERENCE, EVEN = "best", "no clear difference", "even"
WORSE = "{percent:+.0f} % loss ({low:+.0f} to {high:+.0f})"
ONE_SEASON = "(one season: no interval)"
INTERVAL_OF = "{value} ({low} to {high})"
COLUMN_STRATEGY, COLUMN_LOSS = "strategy", "infested plant-days"
COLUMN_FOUND = "found at the end"
COLUMN_VISITED, COLUMN_VISITED_EACH = "inspected a day", "inspected a visit"
COLUMN_HALF, COLUMN_VERDICT = "half found first on day", "verdict"
COLUMN_MOST, COLUMN_WORKED = "80 % found first on day", "hours worked"
STRATEGY = "Strategy"
USE_THIS = "Use this strategy"
VERDICT = (
    "**{best}** is best: {loss:,.0f} infested plant-days. {second} has {percent:.0f} % more "
    "({low:,.0f} to {high:,.0f} plant-days more, 95 % interval)."
)
VERDICT_ONE = (
    "One season so far: **{best}** is ahead of {second}. That tells little; more would tell."
)
VERDICT_EVEN = "**{names}** are even: {loss:,.0f} infested plant-days each."
VERDICT_TIED = (
    "**{best}** comes out best, but not clearly better than {second}: the 95 % interval of the "
    "difference holds 0. More seasons would tell."
)
NOW_USED = "{name} is in use now."
STRATEGY_NAME = "{sampler} · {hours:g} h · {seconds:g} s"
STRATEGY_TEAM = "{robots} × {strategy}"
GAIN = (
    "{robots} robots instead of {fewer} would save {saved:,.0f} ({low:,.0f} to {high:,.0f}) "
    "infested plant-days."
)
GAIN_FIRST = (
    "A second robot would save {saved:,.0f} ({low:,.0f} to {high:,.0f}) infested plant-days{more}."
)
GAIN_MORE = {
    "3": "; a third {saved:,.0f} ({low:,.0f} to {high:,.0f})",
    "4": "; a fourth {saved:,.0f} ({low:,.0f} to {high:,.0f})",
    "5": "; a fifth {saved:,.0f} ({low:,.0f} to {high:,.0f})",
}
GAIN_NONE = "Of one season no interval is known: simulate more to see what a robot would save."

# -- the report
REPORT_ABOUT, REPORT_KINDS = (
    "About",
    {
        "day": "the day",
        "season": "the season",
        "certification": "the record for a certifier",
    },
)
REPORT_PAPER, REPORT_PAPERS = "Paper", {"a4": "A4", "letter": "Letter"}
REPORT_WAS = "result"
#: of a team's day; else of the one who is chosen
REPORT_EACH = "A page for each of the team"
REPORT_PDF, REPORT_HTML, REPORT_PREVIEW = "Download as PDF", "Download as HTML", "Preview"

PRIOR = "The thesis, with records"
PRIOR_TITLE = "The thesis's samplers with prior information"
PRIOR_INTRO = (
    "Chapter 5 of A. Yehoshua's thesis (2023), made again: Dynamic, Naive and Bouncy with the "
    "thesis's robot, and the choices that its text leaves open as they fit its figures best. On "
    "this plot the season starts from its own records where it has any."
)
PRIOR_PART, PRIOR_OWN = "Scenario or sweep", "This plot"

# -- the scout's page, which works without a network: its script fills the blanks
SCOUT_PAGE = {
    "map_of": "Map",
    "map": "Map of the plot: arrow keys move it, + and - bring it closer",
    "zoom_in": "Closer", "zoom_out": "Farther", "to_next": "To the next plant",
    "whole_plot": "The whole plot",
    "progress": "{done} of {all} done",
    "progress_in_time": "{done} of {all} done, {left} fit",
    "time_left": "{hours}:{minutes} h left",
    "time_over": "The hours are over",
    "waiting": "{n} to send", "all_sent": "All sent", "some_refused": "{n} not taken",
    "menu": "Menu", "close": "Close", "ok": "OK", "cancel": "Cancel",
    "scan": "Scan the code that the app shows: Today, Send to phone.",
    "not_loaded": "{season}: nothing is loaded yet. A network is needed once.",
    "load_day": "Load the day", "old_day": "This route is of {day}: load today's",
    "taken_back": "Records of yours that count no more: {n}",
    "taken_back_before": "Records of yours of {day} that count no more: {n}",
    "taken_back_why": "Somebody took them back in the season.",
    "tell_again": "Send them again", "let_go": "Let them go",
    "newer_plan": "There is a newer plan: load it",
    "clock_wrong": "The clock of this phone is wrong: set it right.",
    "other_day": "What is recorded now counts for {day}.",
    "loading": "Loading ...", "route_done": "The route is done.",
    "no_route": "You have no route: you are not of the team, and without rows. Ask for a code with "
    "rows.",
    "place": "Row {row}, plant {plant}", "face": TIP_FACE,
    "no_position": "No position yet", "there": "You are there",
    "photo_asked": "A photo is asked for.", "photo_asked_of": "A photo is asked for: {note}",
    "asked": "Photos asked for: {n}", "photo_comes": "The photo is being kept ...",
    "kept": "Kept: {what}", "keeping": "Being kept: {what}",
    "added": "{n} more beside it",
    "away": "{m} m away", "chance": "Chance {n} %",
    "chance_least": "Chance under 0.1 %", "chance_most": "Chance over 99 %",
    "off_route": "Off the route",
    "who_says": "{who}: {result}", "contradiction": "Contradiction: {what}",
    "and_more": "... and {n} more.",
    "closed": "Sprayed: do not enter before {until}.",
    "closed_rows": "Rows {low} to {high} are sprayed: do not enter before {until}.",
    "closed_plants": "Plants not on the route before then: {n}.",
    "left_out_skipped": "Left out, as nobody could inspect them last time: {n}.",
    "left_out_flagged": "Left out, as they were found and only flagged: {n}.",
    "left_out_unwanted": "Left out, as the office said so: {n}.",
    "clean": "Clean", "found": "Found", "skipped": "Could not inspect",
    "gone": "Plant is gone",
    "count": "Pests", "leaves": "Leaves looked at", "stage": "Stage", "fewer": "{what}: one fewer",
    "more": "{what}: one more", "stage_egg": "Eggs", "stage_young": "Young",
    "stage_adult": "Adults", "stage_web": "Webs", "save_found": "Save the find",
    "photo": "Photo", "note_button": "Note", "undo": "Undo", "here": "I am at another plant",
    "other_plant": "Another plant", "back_to_route": "Back to the route",
    "photos": "Photos: {n}", "drop_photos": "Throw these photos away?",
    "which_face": "Which face?", "as_on_map": "Each arrow points to it as on the map.",
    "row": "Row", "plant": "Plant", "no_such_plant": "There is no such plant.",
    "several_rows": "Several rows are called {row}: tap the plant on the map.",
    "no_picture": "This is no picture that the phone can read.",
    "phone_full": "The phone is full: this was NOT kept. Make room and try again.",
    "no_disk": "This phone keeps nothing for this page now, so no work can begin. Leave private "
    "browsing and close other windows of this page. It tries again by itself.",
    "not_kept": "This was NOT kept ({why}). Try again.",
    "plan_rest": "Plan the rest anew",
    "ahead_takes": "What is ahead takes {minutes} {minutes:minute|minutes}.",
    "your_rows": "Your part: rows {low} to {high}.",
    "no_network": "There is no network now. All that you do is kept on this phone.",
    "state_idle": "Nothing was sent yet.", "state_sending": "Sending ...",
    "state_sent": "The season has everything.",
    "state_offline": "No network: all is kept on this phone and goes in by itself later.",
    "state_held": "Another program holds the season; it is tried again. All is kept on this phone.",
    "state_ended": "The key no longer holds. All is kept on this phone: ask for a new code and "
    "scan it.",
    "count_whole": "Pests of a find are a whole number from 1. Leave it empty if nobody counted.",
    "stranded": "Records of {who} that wait here: {n}. Their key no longer holds: save them to a "
    "file.",
    "plots": "Seasons on this phone",
    "refused": "Not taken", "send_again": "Send again what was not taken",
    "save_file": "Save what is not sent to a file",
    "hand": "Hand", "left": "Left", "right": "Right", "theme": "Light", "auto": "As the phone",
    "sun": "Sun", "dark": "Dark", "language": "Language",
    "stays": "The phone keeps this page's records until they are sent.",
    "may_be_cleared": "A phone short of room may clear pages: add this one to the home screen.",
}  # fmt: skip
INVITE = "On a phone, without a network"
INVITE_NOTE = (
    "Each person scans a code once, with the network, and then works from gate to gate without "
    "one. What was recorded goes in by itself afterwards. A code is shown once: who has it may "
    "record findings of this season until you take it back."
)
INVITE_LOCAL = (
    "Phones cannot reach the app as it runs now: start it with `fieldmon app --lan`. A code "
    "works on this machine only."
)
INVITE_NAME, INVITE_FIRST, INVITE_LAST = "Name", "From row", "To row"
INVITE_BUTTON, TAKE_BACK = "Make a code", "Take back"
INVITE_CODE = "Code for {name}"
INVITE_ALT = "Picture with a person's own address of the season, for a phone's camera."
INVITE_RULES = (
    "A new code for a name ends the earlier one at once. Without rows it is for the whole plot; "
    "two codes for the same rows share them. Hours run from the start of work that the settings "
    "say, or from the first plant if that is more than five minutes off."
)
INVITE_RULES_TEAM = (
    "A new code for a name ends the earlier one at once. One of the team needs no rows: the team's "
    "plan says who goes where. Any other name needs rows."
)
INVITE_ENDED = "The earlier code of {name} no longer holds."
INVITE_SHARED = (
    "{name} shares these plants with {others}: each gets aisles of their own. Whoever is out "
    "already loads the day again."
)
INVITE_BESIDE = "{name} is not of the team, and has a day of their own in these rows."
INVITED = "{name}, rows {low} to {high}"
# who is out, a line each
OUT, OUT_NO_CODE, OUT_MADE = "Who is out", "no code", "code made {at}"
OUT_HEARD, OUT_SILENT, OUT_LOADED = "heard {at}", "not heard yet", "has the day since {time}"
OUT_DONE = "{done:,} of {all:,} recorded"
OUT_CLOCK = "The phone's clock is {minutes:,} min off: its times are put right."
OUT_CLOCK_HOURS = "The phone's clock is {hours:,} h off: its times are put right."
OUT_CLOCK_DAYS = "The phone's clock is more than a day off: its times are put right."
OUT_OLDER = "Works by an older plan of the day: load the day again on the phone."
OUT_OTHER_DAY = "Has the plan of {day}: load the day again on the phone."
OUT_SHARES = "shares these plants with {others}"
OUT_OVERLAPS = "Rows overlap with those of {others}: make a code with other rows."
OUT_NEWER = Plural(
    "The route was planned before a newer find: plan the rest anew.",
    "The route was planned before {n:,} newer finds: plan the rest anew.",
)
OUT_NO_ROUTE = "Not of the team and without rows, so without a route: make a code with rows."
TAKEN_BACK = "{name} can no longer read or record anything of this season."
ASK_PHOTOS = "Photos asked for: {n}"
ASK_PHOTO, ASK_PHOTO_BUTTON = "What is to be seen on it", "Ask for a photo of {plants}"
ASK_PHOTO_NOTE = (
    "The route leads by, as far as the hours allow, and the scout's page shows it at the plant. It "
    "is asked for until a photo of the plant has come."
)
ASKED_PHOTO, ASK_NO_MORE = "Row {row}, plant {plant}. {note}", "No more"
SAID_OTHERWISE = (
    "Said otherwise of the same plant on this day. Look again, then say on *Record* which holds:"
)
FOUND_HOLDS, CLEAN_HOLDS = "Found holds", "Clean holds"
SETTLE_PLACE = "Row {row}, plant {plant}"
SETTLED = Plural("{place}: {n} result taken back.", "{place}: {n} results taken back.")

# -- other devices: who may open the app, and how a phone comes to trust it
LAN_PAGE = {
    "ask": "Password", "open": "Open", "wrong": "This is not the password.",
    "wait": "Too many tries: wait a minute.",
    "where": "It stands in the window in which fieldmon app was started.",
    "title": "Let this phone trust this fieldmon",
    "why": "Once for each phone: position, and work without a network, need a connection that the "
    "phone trusts.",
    "compare": "The certificate's fingerprint (SHA-256) must be the one that stands in the window "
    "of fieldmon app:",
    "download": "Download the certificate",
    "android": "Android", "iphone": "iPhone",
    "android_1": "Download the certificate.",
    "android_2": "Settings, Security, Encryption and credentials, Install a certificate, CA "
    "certificate: choose the file.",
    "android_3": "Scan your own code, and add the page to the home screen.",
    "iphone_1": "Open this page in Safari, download the certificate, and allow it.",
    "iphone_2": "Settings, Profile downloaded: install it. Then General, About, Certificate trust "
    "settings: switch it on.",
    "iphone_3": "Scan your own code in Safari, and add the page to the home screen before the "
    "first tap.",
}  # fmt: skip


class _Texts(ModuleType):
    """A module whose constants are read in the session's language."""

    def __getattribute__(self, name: str) -> Any:  # noqa: ANN401 - as the constant is
        value = ModuleType.__getattribute__(self, name)
        return language.translated(name, value) if name.isupper() and name[0] != "_" else value


sys.modules[__name__].__class__ = _Texts
