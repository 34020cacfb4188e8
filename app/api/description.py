"""The interface's own description (OpenAPI 3.1), by which what is sent is checked.

No Streamlit in here.
"""

from __future__ import annotations

from typing import Any

from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.io.readers import phone_file
from fieldmon.monitoring.phones import findings, photos

#: findings in one request
MOST_FINDINGS = 500
#: bytes of a request that is no photo
MOST_BYTES = 1 << 20
VERSION = "1"
PATH = f"/api/v{VERSION}"

ID: dict[str, Any] = {
    "type": "string",
    "format": "uuid",
    "pattern": f"^{phone_file.ID}$",
    "description": "Made where the record is made, once: sending it again changes nothing.",
}
_MOMENT = {
    "type": "string",
    "format": "date-time",
    # an empty battery sets a clock to 1970
    "pattern": r"^(19[7-9]|2\d\d)\d-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)$",
}


def _within(name: str, kind: str | list[str] | None = None) -> dict[str, Any]:
    """Return a number of a finding: what it may be where a phone's file is read, too."""
    least, most = phone_file.LEAST_MOST[name]
    return {"type": kind or ["number", "null"], "minimum": least, "maximum": most}


def _text(name: str) -> dict[str, Any]:
    return {"type": "string", "maxLength": phone_file.LONGEST[name]}


_PLACE = {name: _within(name) for name in ("lon", "lat", "accuracy_m")}
_DATE = {"type": ["string", "null"], "pattern": r"^20\d\d-\d\d-\d\d$"}

FINDING: dict[str, Any] = {
    "type": "object",
    "description": "What was seen at one plant, or `undoes`: an earlier finding taken back.",
    "required": ["id", "at"],
    "additionalProperties": False,
    "properties": {
        "id": ID,
        "at": _MOMENT | {"description": "When, by the clock of the phone."},
        "plant": _within("plant", ["integer", "null"]) | {"description": "From 0, as in plot."},
        "result": {"enum": [*RESULT_NAMES.values(), None]},
        "count": _within("count")
        | {"description": "Pests of a find: whole, from 1. Anything else does not count."},
        "stage": _text("stage"),
        "leaves": _within("leaves"),
        "notes": _text("notes")
        | {"description": "`gone`, or `gone: why`, of one skipped: it stands there no more."},
        **_PLACE,
        "on": _DATE
        | {"description": "The day meant; it has no time where that is not the day of `at`."},
        "after": {"anyOf": [_MOMENT, {"type": "null"}]}
        | {
            "description": "The `Date` of the last answer before it was made, and what passed "
            "since: a time before it is not believed."
        },
        "known_at": {"anyOf": [_MOMENT, {"type": "null"}]}
        | {
            "description": "When, by the `Date` of an answer of the season: how far the clock was "
            "off then is taken off. Null: it is not known, or the clock was set since."
        },
        "off_route": {"type": "boolean"},
        "undoes": {"anyOf": [ID, {"const": ""}]},
        "detects": {"type": ["number", "null"], "exclusiveMinimum": 0, "maximum": 1}
        | {"description": "Chance to see an infested plant so; null: as the season's plan has it."},
    },
}
FINDINGS: dict[str, Any] = {
    "type": "object",
    "required": ["sent", "findings"],
    "additionalProperties": False,
    "properties": {
        "sent": _MOMENT | {"description": "The phone's clock as it sends: it may be wrong."},
        "findings": {"type": "array", "maxItems": MOST_FINDINGS, "items": FINDING},
    },
}
ASKED: dict[str, Any] = {
    "type": "object",
    "additionalProperties": False,
    "properties": {
        "on": _DATE,
        "seconds_left": {"type": ["number", "null"], "minimum": 0, "maximum": 86_400},
    },
}
ASKED_PHOTO: dict[str, Any] = {
    "type": "object",
    "required": ["plant"],
    "additionalProperties": False,
    "properties": {
        "plant": _within("plant", "integer"),
        "note": {"type": "string", "maxLength": 200, "description": "What is to be seen on it."},
    },
}
TAKEN: dict[str, Any] = {
    "type": "object",
    "properties": {
        "taken": {
            "type": "array",
            "description": "Each finding sent. What stands here is on the disk.",
            "items": {
                "type": "object",
                "properties": {
                    "id": ID,
                    "new": {"type": "boolean"},
                    "problem": {
                        "type": "string",
                        "description": "Why it is kept and does not count; empty: it counts.",
                    },
                },
            },
        }
    },
}
_LIST = {"type": "array", "items": {"type": "integer"}}
_NUMBERS = {"type": "array", "items": {"type": "number"}}
_SAID = {
    "type": "array",
    "items": {
        "type": "object",
        "properties": {
            "plant": {"type": "integer"},
            "result": {"enum": [*RESULT_NAMES.values()]},
            "count": {"type": ["number", "null"]},
            "second": {"type": ["number", "null"], "description": "Since local midnight."},
            "who": {"type": "string"},
            "gone": {"type": "boolean"}
            | {"description": "Of one skipped: the plant does not stand there any more."},
        },
    },
}
ROUTE: dict[str, Any] = {
    "type": "object",
    "properties": {
        "plants": _LIST | {"description": "In order."},
        "walk_s": _NUMBERS | {"description": "Seconds of the way to each from the one before."},
        "end_s": {"type": "number", "description": "Seconds at the end, the way back included."},
        "line": {"type": "array", "items": _NUMBERS, "description": "The way, lon/lat."},
        "stops": _LIST | {"description": "The point of the line at which each stop is made."},
        "detects": {"type": "number"}
        | {"description": "Chance to see an infested plant so: to be told with each finding."},
    },
}
PLOT: dict[str, Any] = {
    "type": "object",
    "description": "Plants in columns, row by row; it never changes within a season.",
    "properties": {
        "name": {"type": "string"},
        "boundary": {"type": "object", "description": "GeoJSON."},
        "no_go": {"type": "object", "description": "GeoJSON."},
        "gate": {"type": ["array", "null"]},
        "zone": {"type": "string"},
        "row_spacing_m": {"type": "number"},
        "plant_spacing_m": {"type": "number"},
        "rows": {
            "type": "object",
            "properties": {
                "start": _LIST | {"description": "Plants of row k: start[k] to start[k + 1]."},
                "row": _LIST
                | {"description": "Its number, as named in the plot's file or from 1."},
                "sign": {"type": "array", "items": {"type": "string"}}
                | {"description": "How it is shown: its number, and its name if that says more."},
                "aisle": _LIST | {"description": "Rows of one number share their aisle."},
                "side": _LIST
                | {"description": "The aisle is left (1) or right (-1) of its plants in order."},
            },
        },
        "plants": {
            "type": "object",
            "properties": {
                "lon": _NUMBERS,
                "lat": _NUMBERS,
                "number": _LIST,
                "face": _LIST | {"description": "1 or 2 where plants have two, inspected apart."},
                "drawn_lon": _NUMBERS | {"description": "Both have one place: towards its aisle."},
                "drawn_lat": _NUMBERS,
            },
        },
    },
}
_PLAN = {"type": ["integer", "null"], "description": "Number of the plan kept of the day."}
_OTHERS = {
    "type": "array",
    "description": "Plants in aisles that others of the team, or who share the rows, have. "
    "As runs of first and last.",
    "items": _LIST,
}
REST: dict[str, Any] = {
    "type": "object",
    "properties": {"route": ROUTE, "plan": _PLAN, "others": _OTHERS},
}
DAY: dict[str, Any] = {
    "type": "object",
    "required": ["day", "live", "route", "plot"],
    "properties": {
        "season": {"type": "string"},
        "scout": {"type": "string"},
        "rows": {"type": ["array", "null"], "description": "First and last row of one's part."},
        "others": _OTHERS,
        "plot": {"type": "string", "description": "Changes if the plot does: fetch it anew."},
        "day": {"type": "string", "format": "date"},
        "live": {"type": "boolean", "description": "Whether it is today on the plot."},
        "past": {"type": "boolean", "description": "Whether it is over on the plot."},
        "starts": {"type": "string"},
        "robot": {"type": "object"},
        "begins": _MOMENT | {"description": "When this person's work began, or will."},
        "begun": {"type": "boolean", "description": "Whether the hours run by the clock now."},
        "seconds_left": {"type": "number", "description": "Of the hours: now where they run."},
        "has_route": {"type": "boolean"}
        | {"description": "False for who is neither of the team nor has rows: no hours either."},
        "route": ROUTE,
        "plan": _PLAN,
        "chance": _LIST | {"description": "Of each plant, in thousandths."},
        "found": _LIST,
        "clean": _LIST,
        "recorded": _LIST | {"description": "Found by records of before the season alone."},
        "gone": _LIST | {"description": "Plants that do not stand there any more."},
        "today": _SAID,
        "contradicting": _SAID,
        "taken_back": {
            "type": "array",
            "description": "This person's findings of the day that somebody else took back in the "
            "season: they count no more. Told again with another id, they do.",
            "items": ID,
        },
        "taken_back_before": {
            "type": "object",
            "description": "The same of the week before, by day.",
            "additionalProperties": {"type": "array", "items": ID},
        },
        "hot_spots": {"type": "array", "items": {"type": "object"}},
        "photos": {"type": "array", "items": {"type": "object"}},
        "photos_asked": {
            "type": "array",
            "description": "Photos asked for, not taken yet, and this person's to take.",
            "items": {
                "type": "object",
                "properties": {
                    "id": ID,
                    "plant": {"type": "integer"},
                    "note": {"type": "string"},
                    "who": {"type": "string"},
                    "at": _MOMENT,
                },
            },
        },
        "closed": {
            "type": "array",
            "description": "Rows with plants that nobody may come to after a treatment: first and "
            "last, and until when, in the plot's local time; which plants, as runs of first and "
            "last, and how many of these are somebody's own. They are on no route.",
            "items": {
                "type": "object",
                "properties": {
                    "rows": _LIST,
                    "until": {"type": "string"},
                    "plants": {"type": "array", "items": _LIST},
                    "own": {"type": "integer"},
                },
            },
        },
        "unwanted": {
            "type": "array",
            "description": "Plants that nobody is to inspect on that day, as was said in the app. "
            "As runs of first and last.",
            "items": _LIST,
        },
        "left_out": {
            "type": "array",
            "description": "Plants that plans leave out: nobody could inspect them last time, or "
            "they were found and only flagged. As runs of first and last; how many of them are "
            "somebody's own.",
            "items": {
                "type": "object",
                "properties": {
                    "why": {"enum": ["skipped", "flagged"]},
                    "plants": {"type": "array", "items": _LIST},
                    "own": {"type": "integer"},
                },
            },
        },
    },
}
ERROR: dict[str, Any] = {
    "type": "object",
    "required": ["error"],
    "properties": {
        "error": {"type": "string", "description": "A sentence for a person."},
        "cause": {"enum": ["held"], "description": "Of 503: another program holds the file."},
    },
}

_REFUSALS = {
    "401": "There is no key that holds for this season.",
    "403": "The request comes from another site.",
    "413": "It is too large.",
    "422": "It is not as described; nothing of it was taken.",
    "429": "Too many for a day.",
    "503": "The disk is full or the season's file is held by another program or away: try again.",
}


def _answer(schema: dict[str, Any], said: str) -> dict[str, Any]:
    return {"description": said, "content": {"application/json": {"schema": schema}}}


def _operation(
    said: str, answer: dict[str, Any], more: dict[str, Any] | None = None
) -> dict[str, Any]:
    refused = {code: _answer(ERROR, why) for code, why in _REFUSALS.items()}
    return {"summary": said, "responses": {"200": answer} | refused, **(more or {})}


def _body(schema: dict[str, Any]) -> dict[str, Any]:
    return {"requestBody": {"required": True, "content": {"application/json": {"schema": schema}}}}


def _query(**schemas: dict[str, Any]) -> dict[str, Any]:
    return {
        "parameters": [
            {"name": name, "in": "query", "required": "default" not in one, "schema": one}
            for name, one in schemas.items()
        ]
    }


_PICTURE = {
    "description": "The photo, byte for byte.",
    "content": {"image/*": {"schema": {"type": "string", "format": "binary"}}},
}
_AT = {"name": "season", "in": "path", "required": True, "schema": {"type": "string"}}
_PHOTO = {"name": "photo", "in": "path", "required": True, "schema": ID}
_OF_PHOTO = {
    "finding": ID | {"description": "The finding that it belongs to, which may come later."},
    "at": _MOMENT,
    **{name: _within(name, "number") | {"default": None} for name in ("lon", "lat", "accuracy_m")},
}


def description() -> dict[str, Any]:
    """Return the OpenAPI document."""
    season = f"{PATH}/seasons/{{season}}"
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "A season of fieldmon",
            "version": VERSION,
            "description": "Fetch the day, tell findings, ask for the rest. Whatever is sent "
            "twice is taken once, and answers come when it is on the disk. One person may tell "
            f"{findings.MOST_A_DAY} findings a day.",
        },
        "components": {"securitySchemes": {"key": {"type": "http", "scheme": "bearer"}}},
        "security": [{"key": []}],
        "paths": {
            f"{season}/plot": {
                "parameters": [_AT],
                "get": _operation("Rows and plants.", _answer(PLOT, "The plot.")),
            },
            f"{season}/day": {
                "parameters": [_AT],
                "get": _operation(
                    "A day as it stands; the route is given out.",
                    _answer(DAY, "The day."),
                    _query(
                        on=_DATE | {"default": None},
                        plan=_PLAN
                        | {
                            "default": None,
                            "description": "The plan that one has and goes on by; without it one "
                            "goes by the plan returned.",
                        },
                    ),
                ),
            },
            f"{season}/route": {
                "parameters": [_AT],
                "post": _operation(
                    "The rest of the day, planned anew.",
                    _answer(
                        {"type": "object", "properties": {"route": ROUTE, "plan": _PLAN}},
                        "The rest.",
                    ),
                    _body(ASKED),
                ),
            },
            f"{season}/findings": {
                "parameters": [_AT],
                "post": _operation("Tell findings.", _answer(TAKEN, "Taken."), _body(FINDINGS)),
            },
            **_photos(season),
        },
    }


def _photos(season: str) -> dict[str, Any]:
    """Return the paths of photos, sent and asked for."""
    done = _answer({"type": "object"}, "On the disk.")
    kept = _answer({"type": "object", "properties": {"new": {"type": "boolean"}}}, "On the disk.")
    send_photo = _query(**_OF_PHOTO) | {
        "requestBody": {
            "required": True,
            "description": f"JPEG, PNG or WebP of {photos.MOST_BYTES // 2**20} MB at most; "
            f"{photos.MOST_A_DAY} a person and day. `Content-Digest: sha-256=:...:` is checked.",
            "content": _PICTURE["content"],
        }
    }
    return {
        f"{season}/photos/{{photo}}": {
            "parameters": [_AT, _PHOTO],
            "get": _operation("A photo.", _PICTURE),
            "put": _operation("Send a photo.", kept, send_photo),
        },
        f"{season}/photos_asked/{{photo}}": {
            "parameters": [_AT, _PHOTO],
            "put": _operation(
                "Ask for a photo of a plant: it is asked for until one has come.",
                done,
                _body(ASKED_PHOTO),
            ),
            "delete": _operation("Ask for it no more.", done),
        },
    }
