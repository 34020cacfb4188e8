"""What fieldmon is made of besides itself, and under which licences.

    python .ci/sbom.py > sbom.json     # CycloneDX 1.5
    python .ci/sbom.py --licences      # a table

Every distribution that fieldmon needs to run, as it is installed here, and what these need in turn.
"""

from __future__ import annotations

import json
import sys
import tomllib
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

_PROJECT = tomllib.loads(
    (Path(__file__).resolve().parents[1] / "pyproject.toml").read_text("utf-8")
)["project"]
_UNKNOWN = "not stated"
_LONGEST = 60


def needed() -> dict[str, metadata.Distribution]:
    """Return all that fieldmon needs to run here, by name."""
    found: dict[str, metadata.Distribution] = {}
    asked: set[tuple[str, frozenset[str]]] = set()
    # what is installed of fieldmon itself may be of yesterday
    waiting = [(line, frozenset[str]()) for line in _PROJECT["dependencies"]]
    while waiting:
        line, extras = waiting.pop()
        requirement = Requirement(line)
        marker = requirement.marker
        told = [{"extra": extra} for extra in ("", *extras)]
        if marker is not None and not any(marker.evaluate(extra) for extra in told):
            continue
        wanted = canonicalize_name(requirement.name), frozenset(requirement.extras)
        if wanted not in asked:
            asked.add(wanted)
            found[wanted[0]] = own = metadata.distribution(wanted[0])
            waiting += [(more, wanted[1]) for more in own.requires or ()]
    return dict(sorted(found.items()))


def licence(distribution: metadata.Distribution) -> str:
    """Return the licence that a distribution states, in short."""
    about = distribution.metadata
    if stated := about.get("License-Expression"):
        return stated
    classed = [
        line.rpartition(" :: ")[2]
        for line in about.get_all("Classifier") or ()
        if line.startswith("License :: ") and line != "License :: OSI Approved"
    ]
    if classed:
        return " AND ".join(classed)
    first = (about.get("License") or "").strip().partition("\n")[0]
    return first[:_LONGEST] or _UNKNOWN


def bill() -> dict[str, object]:
    """Return the bill of materials as CycloneDX has it."""
    components = [
        {
            "type": "library",
            "name": one.metadata["Name"],
            "version": one.version,
            "purl": f"pkg:pypi/{name}@{one.version}",
            "licenses": [{"license": {"name": licence(one)}}],
        }
        for name, one in needed().items()
    ]
    made = {"type": "application", "name": "fieldmon", "version": _PROJECT["version"]}
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": made},
        "components": components,
    }


def main() -> None:
    """Write the bill, or the table of licences."""
    if "--licences" in sys.argv[1:]:
        lines = [f"{one.metadata['Name']:32} {one.version:16} {licence(one)}"
                 for one in needed().values()]  # fmt: skip
        sys.stdout.write("\n".join(lines) + "\n")
    else:
        sys.stdout.write(json.dumps(bill(), indent=1) + "\n")


if __name__ == "__main__":
    main()
