"""However often and wherever the line breaks, nothing is lost and nothing is doubled.

`FIELDMON_DISCONNECTS=1000 FIELDMON_ROUNDS=200` for as many as a release is held to.
"""

import asyncio
import os
from concurrent.futures import ThreadPoolExecutor

import pytest

from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import photos, scouts
from tests.app.api.asking import in_own_loop
from tests.app.api.phone import ENDINGS, Phone
from tests.monitoring.phone import told
from tests.monitoring.rules import keeps_the_rules

DISCONNECTS = int(os.environ.get("FIELDMON_DISCONNECTS", "25"))
ROUNDS = int(os.environ.get("FIELDMON_ROUNDS", "4"))


def holds_exactly(path, phones):
    """Hold a season to what its phones recorded: each record and photo once, byte for byte."""
    season = Season(path)
    ids, rows = told(season)
    wanted = {one["id"]: one for phone in phones for one in phone.findings.values()}
    assert len(ids) == len(set(ids)) == len(wanted)
    assert sorted(rows) == sorted((k, one["plant"], one["result"]) for k, one in wanted.items())
    for phone in phones:
        for name, (_, data) in phone.photos.items():
            assert photos.picture(season, name) == ("image/jpeg", data)
    assert len(photos.photos_of(season)) == sum(len(phone.photos) for phone in phones)
    assert season.verify() == ()
    keeps_the_rules(path)


@pytest.mark.timeout(1800)
def test_a_line_that_breaks_at_any_moment_loses_nothing_and_doubles_nothing(served):
    phone = Phone(served.key, seed=1)

    async def day():
        while phone.disconnects < DISCONNECTS or phone.waiting or phone.waiting_photos:
            if phone.disconnects < DISCONNECTS and phone.chance.random() < 0.3:
                result = phone.chance.choice(["clean", "found", "skipped"])
                phone.record(phone.chance.randrange(400), result, photo=phone.chance.random() < 0.2)
            over = phone.disconnects >= DISCONNECTS
            if phone.waiting or phone.waiting_photos:
                await phone.send("well" if over else phone.chance.choice(ENDINGS))

    in_own_loop(day)
    assert phone.disconnects >= DISCONNECTS
    assert len(phone.findings) > DISCONNECTS / 5
    holds_exactly(served.season.path, [phone])


@pytest.mark.timeout(1800)
def test_three_phones_at_once_on_one_season(served):
    keys = [served.key, *(scouts.let_in(served.season, name) for name in ("Ben", "Cem"))]
    phones = [Phone(key, seed) for seed, key in enumerate(keys)]

    def work(phone):
        async def day():
            for k in range(ROUNDS):
                # plants of others too: both are kept
                phone.record(phone.chance.randrange(60), "clean", photo=k % 5 == 0)
                await phone.send(phone.chance.choice(["well", "well", "answer lost"]))
            while phone.waiting or phone.waiting_photos:
                await phone.send("well")

        asyncio.run(day())

    with ThreadPoolExecutor(3) as threads:
        list(threads.map(work, phones))
    assert sum(len(phone.findings) for phone in phones) == 3 * ROUNDS
    holds_exactly(served.season.path, phones)
