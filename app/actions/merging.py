"""A copy of the season that was brought: what it holds that the season lacks, and merging it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.io.options import Upload
from fieldmon.monitoring.season.copies_to_merge import ChangedElsewhere, merge_file

from ..state import cached_files, notices, seasons_folder
from ..state.brought_files import FINDINGS, file_of
from ..words import texts
from ..words.language import in_words, listed, of_error
from . import acting

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from streamlit.runtime.uploaded_file_manager import UploadedFile

    from fieldmon.monitoring.merging.merge import Merged
    from fieldmon.monitoring.season.copies_to_merge import MergedFile

    from ..state.choices import Choices
    from ..state.fresh_boxes import FreshBoxes

# things to look at that are shown
_MOST = 20
# what was merged here last: into which season, its name, and what came of it
_LAST = "merged here"


def show(choices: Choices, boxes: FreshBoxes, brought: UploadedFile) -> bool:
    """Show what a copy of the season holds that it lacks, and a button that merges it.

    Return whether there is one. Of another season it is said why it cannot be merged; of any other
    file nothing.
    """
    copy = Upload(brought.name, brought.getvalue())
    if not seasons_folder.is_of_season(copy.data):
        return False
    season = choices.open_season
    key = f"{season.key} {season.revision} {file_of(FINDINGS, (copy,)).key}"
    with st.container(border=True, key="merging"):
        try:
            ahead = cached_files.merging(key, season, copy)
        except ChangedElsewhere as problem:
            st.info(f"{of_error(problem)}\n\n{texts.MERGE_OR_CORRECT}")
            return False
        except FieldmonError as problem:
            st.info(of_error(problem))
            return False
        name = texts.isolated(copy.name)
        if not ahead.merged.changed:
            st.markdown(texts.MERGE_BRINGS_NOTHING.format(name=name))
            return False
        st.markdown(texts.MERGE_COPY.format(name=name))
        _show_what(choices, texts.MERGE_BRINGS, ahead)
        acting.at_press(texts.MERGE, _merge, choices, boxes, key="merge", boxes=boxes,
                        type="primary", icon=":material/merge:")  # fmt: skip
    return True


def show_last(choices: Choices) -> None:
    """Show what the copy brought that was merged last here, until it was looked at."""
    key, name, done = st.session_state.get(_LAST, ("", "", None))
    if key != choices.key or done is None:
        return
    with st.container(border=True, key="merged"):
        _show_what(choices, texts.MERGE_BROUGHT.format(name=texts.isolated(name)), done)
        st.caption(texts.MERGE_BACK)
        st.button(texts.NOTICE_CLOSE, key="merged_close", on_click=_forget)


def _forget() -> None:
    st.session_state.pop(_LAST, None)


@notices.reporting
def _merge(choices: Choices, boxes: FreshBoxes) -> str:
    """Merge the copy that was brought, as it is now with the season as it is now."""
    brought = boxes.said("findings_file")
    if brought is None:  # taken out again
        return ""
    name = texts.isolated(brought.name)
    done = merge_file(choices.open_season, Upload(brought.name, brought.getvalue()))
    boxes.empty()
    if not done.merged.changed:
        return texts.MERGED_NOTHING.format(name=name)
    st.session_state[_LAST] = choices.key, brought.name, done
    if _to_look_at(done):
        notices.warn()
    return texts.MERGED.format(name=name)


def _show_what(choices: Choices, first: str, done: MergedFile) -> None:
    """Show what a copy brings, or brought, and what is to be looked at because of it."""
    st.markdown(_paragraph(first, [*_brought(choices, done.merged)]))
    if to_look_at := _to_look_at(done):
        shown = [in_words(one) for one in to_look_at[:_MOST]]
        if (more := len(to_look_at) - _MOST) > 0:
            shown.append(texts.AND_MORE.format(n=more))
        st.warning(_paragraph(texts.MERGE_DIFFERS.format(n=len(to_look_at)), shown))


def _brought(choices: Choices, merged: Merged) -> Iterator[str]:
    """Yield what a copy holds that the season lacks, a line each."""
    if n := merged.new:
        of = merged.of_new
        days = choices.units.said_days(of.days[0], of.days[-1], choices.on)
        yield texts.MERGE_NEW.format(n=n, plants=of.plants, found=of.found, days=days)
        each = (
            texts.MERGE_BY_ONE.format(who=texts.isolated(who) if who else texts.MERGE_NOBODY, n=m)
            for who, m in of.by
        )
        yield texts.MERGE_BY.format(who=listed(each))
    if merged.treated:
        what = listed(in_words(one) for one in merged.treated)
        yield texts.MERGE_TREATED.format(n=merged.treatments, what=what)
    if n := merged.taken_back:
        yield texts.MERGE_TAKEN_BACK.format(n=n)
    if merged.more:
        yield in_words(merged.more)
    if merged.chosen:
        yield texts.MERGE_CHOSEN.format(what=listed(map(in_words, merged.chosen)))
    if merged.codes:
        who = listed(map(texts.isolated, dict.fromkeys(merged.codes)))
        yield texts.MERGE_CODES.format(who=who)
    if n := merged.entries:
        yield texts.MERGE_LOG.format(n=n)
    if merged.moved:
        yield texts.MERGE_MOVED


def _to_look_at(done: MergedFile) -> tuple[str, ...]:
    """Return what the copies tell differently, and what is to beware of since, a sentence each."""
    return *done.merged.contradictions, *done.entered, *done.merged.overlaps


def _paragraph(first: str, lines: Sequence[str]) -> str:
    return "\n".join([first, "", *(f"- {one}" for one in lines)])
