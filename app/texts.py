"""Every text of the app in one place: a translation is one file."""

TITLE = "fieldmon"
TODAY, SEASON, STUDY = "Today", "Season", "Study"
SAMPLE, UPLOAD = "Sample estate", "My own files"
SAMPLE_NOTE = "A made-up estate near Paran, to try things out. Nothing of it exists."
PLOT_FROM = "Plot"
PLOT_FILE = "Plot file (zipped shapefile, GeoPackage, GeoJSON, KML)"
RECORD_FILE = "Pest records (CSV, Excel, GeoJSON, ...)"
PLANT_FILE = "Measured plant positions (optional)"
WHICH_PLOT = "Which plot"
EMPTY = (
    "### Bring a plot\n"
    "Drop a plot file into the box on the left: the boundary of a real plot, in any coordinate "
    "system. Records of pests are welcome but not needed. Or look at the sample estate first."
)
ROWS = "Rows"
BEARING = "Row bearing (degrees from north)"
BEARING_HELP = "Leave empty to have it found from the boundary or the plants."
ROW_SPACING, PLANT_SPACING, HEADLAND = "Row to row (m)", "Plant to plant (m)", "Headland (m)"
SPACING_HELP = "Leave empty for what the file says, or else 4 m and 3 m."
WHO = "Who inspects"
ROBOT, SCOUT = "Robot", "Scout on foot"
HOURS, LOOK = "Working hours", "Seconds at a plant"
SAMPLER = "Who chooses the plants"
SAMPLERS = {
    "dynamic": "Dynamic: suspicious plants first",
    "adaptive": "Adaptive: the drive that should find most",
    "naive": "Naive: every plant, row by row",
    "bouncy": "Bouncy: every second plant",
    "snake": "Snake: up one side of an aisle, down the other",
    "snake-random": "Snake, every 1st to 4th plant by chance",
    "neighbor": "Neighbor: both sides of the aisle at each stop",
    "neighbor-random": "Neighbor, every 1st to 4th stop by chance",
    "random": "Random: a third of the plot, drawn every day",
}
DATE = "Day"
PLANTS_TO_INSPECT, TIME, DRIVE, FINDS = "Plants to inspect", "Hours", "Drive", "Expected finds"
FINDS_HELP = (
    "Infested plants on the route, by the chance map, times the chance that looking finds them."
)
OF = "of {n}"
DOWNLOAD = "Download the route (GeoJSON)"
NO_STOPS = (
    "The working day is too short to reach a plant and come back. Give more hours on the left."
)
FINDINGS = "What the import found"
FINDINGS_NONE = "Nothing to report: the files were read as they are."
CHOOSE = "The file leaves this open"
CHOOSE_BUTTON = "Use this"
STOPS = "Stops in order"
LAYERS = "Show"
LAYER_NAMES = {
    "plants": "plants",
    "route": "route",
    "numbers": "stop numbers",
    "hot": "hot spots",
    "records": "records",
}
LEGEND_CHANCE = "Chance that a plant is infested"
LEGEND_ROUTE = "Route: blue line, arrows in driving direction; green ring: gate; numbers: stops"
LEGEND_HOT = "Purple outlines: hot spots, where finds cluster more than chance allows"
LEGEND_RECORDS = "Records: filled where pests were seen, empty where not"
LEGEND_STATES = {"found": "found", "clean": "looked clean", "never": "never inspected"}
LEGEND_TRUTH = "Black dots: infested and not yet found (only a simulation knows)"
NORTH = "North is up; the bar is {m} m long."
SEASON_INTRO = (
    "A simulated season on this plot. The start is drawn from the chance map; insects spread to "
    "neighbouring plants at night; every sampler meets the same insects. Detection is all finds "
    "so far in percent of all infestations so far."
)
DAYS, INFESTED, SPREAD, SEED = "Days", "Infested at the start (%)", "Spread a night (%)", "Seed"
SPREAD_HELP = "Chance a night that an infested plant infests each plant next to it."
SEED_HELP = "The same seed gives the same season."
DETECTION_AXIS, DAY_AXIS, FOUND_AXIS = "found so far (%)", "day", "plants found that day"
COMPARED = "Samplers compared"
BOTH_FACES = "Inspect both faces of each row"
SHOW_SAMPLER, SHOW_DAY, SHOW_TRUTH = "On the map", "Day", "Show what is really infested"
LEFT = "Infested left"
FOUND_SO_FAR, FOUND_TODAY, VISITED_TODAY = "Found so far", "Found that day", "Inspected that day"
HOT_SPOTS = "{n} hot spot(s)"
WORKING = "Working ..."
STUDY_TITLE = "The thesis's samplers without prior information"
STUDY_INTRO = (
    "Chapter 4 of A. Yehoshua's thesis (2023), made again: our mean and its interval beside each "
    "printed figure. The seven samplers themselves run on your own plot on the Season page."
)
STUDY_TABLE, REPLICATES = "Table", "Seasons a row"
STUDY_RUN, STUDY_REPORT = "Run", "Download the report (HTML)"
STUDY_CSV = "Download the table (CSV)"
STUDY_PROGRESS = "{done} of {total} rows simulated"
PRIOR = "Study, prior information"
PRIOR_TITLE = "The thesis's samplers with prior information"
PRIOR_INTRO = (
    "Chapter 5 of A. Yehoshua's thesis (2023), made again: Dynamic, Naive and Bouncy with the "
    "thesis's robot, and the choices that its text leaves open as they fit its figures best. On "
    "this plot the season starts from its own records where it has any."
)
PRIOR_PART, PRIOR_OWN = "Scenario or sweep", "This plot"
