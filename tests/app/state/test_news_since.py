"""A browser is sent what changed since it asked last, and has the same as if it were sent all."""

import copy
import json

from hypothesis import given
from hypothesis import strategies as st

from app.state import news_since
from app.state.news_since import NewsSince


def taken_in(data, news):
    """Return what the browser has, as `withNews` of `map_view/src/drive.js` makes it."""
    now = copy.deepcopy(data) | ({"robots": []} if news.get("whole") else {})

    def put(path, value):
        at, *names = now, *path.split(".")
        for name in names[:-1]:
            if isinstance(at, list):
                at.extend({} for _ in range(len(at), int(name) + 1))
                at = at[int(name)]
            else:
                at = at.setdefault(name, {})
        at[names[-1]] = value(at.get(names[-1], []))

    for path, value in news["values"].items():
        put(path, lambda _, value=value: value)
    for path, (same, more) in news["lists"].items():
        put(path, lambda before, same=same, more=more: [*before[:same], *more])
    return now | {"number": news["number"]}


def a_day(n=3, lag=0.1, robots=1):
    one = {"at": [*range(n)], "way": [], "heard": {"standing": "live", "lag": lag}}
    return {"link": "live", "stops": [[k, k] for k in range(n)], "robots": [one] * robots}


def test_what_is_new_is_sent_and_nothing_else():
    now = [a_day()]
    news = NewsSince(lambda: now[0])
    had = news.whole()
    told = json.loads(news.since(had["number"]))
    assert told == {"number": had["number"], "lists": {}, "values": {}}, "nothing changed"
    now[0] = a_day(4, lag=0.5)
    told = json.loads(news.since(had["number"]))
    assert told["lists"] == {"robots.0.at": [3, [3]], "stops": [3, [[3, 3]]]}
    assert told["values"] == {"robots.0.heard.lag": 0.5}
    # another tab has less, one that missed an answer asks again
    now[0] = a_day(6, robots=2)
    assert taken_in(had, json.loads(news.since(had["number"])))["robots"] == now[0]["robots"]


def test_who_knows_nothing_or_what_is_long_gone_is_sent_everything(monkeypatch):
    monkeypatch.setattr(news_since, "_KEPT", 3)
    lag = iter(range(99))
    news = NewsSince(lambda: a_day(lag=next(lag)))
    first = news.whole()["number"]
    assert len(json.loads(news.since(first))["lists"]) == 0
    for number in (None, first, first + 999):
        for _ in range(4):
            news.whole()
        told = json.loads(news.since(number))
        assert {one[0] for one in told["lists"].values()} == {0}
        assert {"stops", "robots.0.at", "robots.0.way"} == {*told["lists"]}


def test_a_robot_that_is_gone_is_no_more_told_of():
    now = [a_day(robots=2)]
    news = NewsSince(lambda: now[0])
    had = news.whole()
    now[0] = a_day(robots=1)
    told = json.loads(news.since(had["number"]))
    assert told["whole"] is True
    assert taken_in(had, told) == now[0] | {"number": told["number"]}


LISTS = st.lists(st.integers(0, 3), max_size=6)


@given(st.lists(st.tuples(LISTS, st.integers(0, 2), st.booleans()), min_size=1, max_size=8))
def test_whatever_changes_every_tab_has_what_is_now(days):
    now = [{}]
    news = NewsSince(lambda: now[0])
    tabs = []
    for one, value, asks in days:
        now[0] = {"list": one, "robots": [{"at": one[::-1], "heard": {"lag": value}}]}
        tabs = [
            taken_in(had, json.loads(news.since(had["number"]))) if asks or not k else had
            for k, had in enumerate(tabs)
        ]
        tabs.append(news.whole())
        number = tabs[-1]["number"]
        assert all(had == now[0] | {"number": number} for had in tabs if had["number"] == number)
    last = [taken_in(had, json.loads(news.since(had["number"]))) for had in tabs]
    assert last == [now[0] | {"number": last[0]["number"]}] * len(last)
