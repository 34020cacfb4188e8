"""What fieldmon is made of is told whole, each with its licence; its container holds no more."""

import json
import re
import subprocess
import sys
import tomllib

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.paths import ROOT


def told(*words):
    asked = [sys.executable, ROOT / ".ci" / "sbom.py", *words]
    return subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT).stdout


@pytest.fixture(scope="module")
def bill():
    return json.loads(told())


def test_every_dependency_is_in_the_bill_with_version_and_licence(bill):
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.5")
    parts = {canonicalize_name(part["name"]): part for part in bill["components"]}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    wanted = {canonicalize_name(Requirement(line).name) for line in project["dependencies"]}
    assert wanted <= set(parts)
    assert len(parts) > len(wanted)  # what these need is there too
    for name, part in parts.items():
        assert part["purl"] == f"pkg:pypi/{name}@{part['version']}"
        assert part["licenses"][0]["license"]["name"] not in {"", "not stated"}, name


def test_every_part_is_pinned_as_it_is_installed_in_the_container(bill):
    pins = (ROOT / ".ci" / "constraints.txt").read_text("utf-8")
    pinned = {canonicalize_name(line.split("==")[0]) for line in pins.splitlines() if "==" in line}
    missing = {canonicalize_name(part["name"]) for part in bill["components"]} - pinned
    assert missing == set()


def test_the_container_is_pinned_runs_as_nobody_in_particular_and_is_looked_after():
    lines = (ROOT / "Containerfile").read_text("utf-8")
    (base,) = re.findall(r"^FROM (\S+)", lines, re.MULTILINE)
    assert re.fullmatch(r"[\w./-]+:\d+\.\d+\.\d+-[\w-]+(@sha256:[0-9a-f]{64})?", base), base
    users = re.findall(r"^USER (\S+)", lines, re.MULTILINE)
    assert users
    assert users[-1] not in {"root", "0"}
    assert users[-1].split(":")[0].isdigit()  # so that a cluster sees that it is not root
    assert re.search(r"^HEALTHCHECK .*_stcore/health", lines, re.MULTILINE)
    assert re.search(r"^VOLUME /seasons$", lines, re.MULTILINE)
    assert "--read-only" in lines
    assert re.search(r"^CMD \[", lines, re.MULTILINE)  # no shell between: signals reach the app
    assert lines.rindex("USER ") < lines.rindex("CMD ")
