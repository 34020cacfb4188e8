"""Awkward files come in right, or repaired and said so, or are refused with a sentence."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from fieldmon.errors import ChoiceNeeded, FieldmonError, SettingError
from fieldmon.io import read
from fieldmon.io.import_report import Severity
from tests import awkward


def come_in(case, folder):
    folder.mkdir()
    source = case.source(folder)
    if case.door == "records":
        return read.read_records(source, case.options, near=case.near, places=case.places)
    return getattr(read, f"read_{case.door}")(source, case.options)


@pytest.fixture(scope="module")
def told():
    """Remember by its name what the import of a case said: its messages, or its refusal."""
    return {}


def is_said(expected, findings):
    severity, _, words = expected.partition(": ")
    words, _, choice = words.partition(" [")
    return any(
        f.severity == severity
        and words in f"{f.feature or ''} {f.sentence}"
        and (not choice or (f.remedy and f"{f.remedy.option}={f.remedy.value}]" == choice))
        for f in findings
    )


def assert_is_at(case, value):
    wanted = np.array(case.at)
    if case.door == "records":
        np.testing.assert_allclose(value.lonlat, wanted, atol=2e-8)
        return
    corners = shapely.get_coordinates([field.boundary for field in value])
    for place in wanted:
        assert np.abs(corners - place).max(axis=1).min() < 2e-8


GOOD = [case for case in awkward.CASES if case.refuses is None]
BAD = [case for case in awkward.CASES if case.refuses is not None]


@pytest.mark.parametrize("case", GOOD, ids=lambda case: case.name)
def test_it_comes_in_where_it_is_and_says_what_was_odd(case, tmp_path, told):
    imported = come_in(case, tmp_path / "made")
    told[case.name] = imported.messages
    for expected in case.says:
        assert is_said(expected, imported.messages), "\n".join(str(f) for f in imported.messages)
    for grave in imported.of(Severity.DROPPED, Severity.DOUBTFUL):
        assert any(is_said(expected, [grave]) for expected in case.says), f"unexpected: {grave}"
    if case.at:
        assert_is_at(case, imported.value)
    if case.check:
        case.check(imported.value)


@pytest.mark.parametrize("case", BAD, ids=lambda case: case.name)
def test_it_is_asked_about_or_refused_with_a_sentence(case, tmp_path, told):
    with pytest.raises(FieldmonError) as refused:
        come_in(case, tmp_path / "made")
    told[case.name] = refused.value
    said = str(refused.value)
    assert case.refuses in said
    assert said.endswith((".", "?"))
    assert str(tmp_path.parent.parent) not in said
    if case.asks:
        option, *choices = case.asks
        assert isinstance(refused.value, ChoiceNeeded), said
        assert refused.value.option == option
        assert set(choices) <= set(refused.value.choices)
        if option == "crs" and choices:
            assert refused.value.choices[0] == choices[0]
    else:
        assert not isinstance(refused.value, ChoiceNeeded), said


#: what another file answers, not a value
OTHER_FILES = {"kind", "plots", "plants"}


def told_of(case, folder):
    """Return what the import of a case says."""
    try:
        return come_in(case, folder).messages
    except FieldmonError as refused:
        return refused


def suggested(outcome):
    """Return what an import suggests: the sentence, the option, and the values it can take."""
    if isinstance(outcome, ChoiceNeeded):
        if outcome.option not in OTHER_FILES:
            yield str(outcome), outcome.option, outcome.choices
    elif not isinstance(outcome, FieldmonError):
        for message in outcome:
            if message.remedy is not None:
                yield message.sentence, message.remedy.option, message.remedy.choices


@pytest.mark.parametrize("case", awkward.CASES, ids=lambda case: case.name)
def test_every_answer_that_is_suggested_is_taken_and_is_not_asked_for_again(case, tmp_path, told):
    if case.name not in told:
        told[case.name] = told_of(case, tmp_path / "made")
    for k, (said, option, choices) in enumerate(suggested(told[case.name])):
        # of many systems, whose answers are all taken in one way, the first and the last
        few = {0, len(choices) - 1} if option == "crs" else range(10)
        for i, choice in enumerate(choices[:10]):
            if i not in few:
                continue
            answered = replace(case, options=case.options.choose(option, choice))
            try:
                says = [str(m) for m in come_in(answered, tmp_path / f"{k}-{i}").messages]
            except SettingError as refused:
                pytest.fail(f"{option}={choice} was suggested, but: {refused}")
            except FieldmonError as other:
                says = [str(other)]
            keeps = option == "crs" and i == len(choices) - 1
            assert keeps or not any(said in one for one in says), f"{option}={choice}: {said}"


def test_a_number_of_the_record_is_never_offered_as_its_count():
    with pytest.raises(ChoiceNeeded) as asked:
        read.read_records(awkward.awkward_real_files.a_number_of_the_record_is_no_count())
    assert asked.value.choices == ("count=eggs", "present=")


def test_the_battery_is_as_large_as_it_claims():
    names = [case.name for case in awkward.CASES]
    assert len(set(names)) == len(names) >= 60
