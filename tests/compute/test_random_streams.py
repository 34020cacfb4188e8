"""Random streams: named, independent, and the same for everyone who asks."""

import zlib
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from fieldmon.compute.random_streams import RandomStreams, coin, coin_bits, coin_limit, coin_table
from fieldmon.errors import SettingError


def test_a_stream_does_not_depend_on_what_else_was_drawn():
    chance = RandomStreams(7)
    chance.of("start").random(1000)
    assert chance.of("spread", 3).random() == RandomStreams(7).of("spread", 3).random()


@pytest.mark.parametrize("other", [("spread", 4), ("inspect", 3), ("spread",), ("spread", 3, 0)])
def test_streams_of_other_names_and_days_differ(other):
    assert RandomStreams(7).key("spread", 3) != RandomStreams(7).key(*other)


def test_seeds_differ():
    assert RandomStreams(1).key("start") != RandomStreams(2).key("start")


def test_a_negative_seed_is_refused_with_a_sentence():
    with pytest.raises(SettingError, match="0 or more, but it is -1"):
        RandomStreams(-1)


@given(seed=st.integers(0, 2**40), i=st.integers(0, 10_000))
def test_a_coin_is_its_entry_of_the_table(seed, i):
    key = RandomStreams(seed).key("inspect")
    assert coin(key, i) == coin_table(key, i + 1)[i]


def test_coins_are_uniform_and_independent_of_their_neighbours_and_of_the_next_key():
    tables = np.array(
        [coin_table(RandomStreams(seed).key("spread", 1), 5000) for seed in range(40)]
    )
    assert stats.kstest(tables.ravel(), "uniform").pvalue > 1e-3
    assert abs(np.corrcoef(tables[:, 1:].ravel(), tables[:, :-1].ravel())[0, 1]) < 0.01
    assert abs(np.corrcoef(tables[1:].ravel(), tables[:-1].ravel())[0, 1]) < 0.01


def test_coins_agree_with_the_published_splitmix64_sequence():
    # first outputs of SplitMix64 seeded with 0 (Vigna's splitmix64.c)
    expected = np.array([0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F], np.uint64)
    assert coin_table(np.uint64(0), 3).tolist() == ((expected >> np.uint64(11)) / 2.0**53).tolist()


@given(seed=st.integers(0, 2**140), key=st.lists(st.integers(0, 2**70), max_size=4), name=st.text())
def test_a_key_is_what_numpys_seed_sequence_makes_of_seed_and_name(seed, key, name):
    spawn_key = (zlib.crc32(name.encode()), *key)
    (state,) = np.random.SeedSequence(seed, spawn_key=spawn_key).generate_state(1, np.uint64)
    assert RandomStreams(seed).key(name, *key) == state


@given(seed=st.integers(0, 2**140), name=st.text())
def test_keys_are_the_keys_one_by_one(seed, name):
    chance = RandomStreams(seed)
    assert list(islice(chance.keys(name), 70)) == [chance.key(name, day) for day in range(70)]


@given(key=st.integers(0, 2**64 - 1), i=st.integers(0, 10_000), chance=st.floats(0, 1))
def test_bits_are_below_the_limit_of_a_chance_where_the_coin_is_below_it(key, i, chance):
    key = np.uint64(key)
    its_own = float(coin(key, i))
    for limit in (chance, its_own, np.nextafter(its_own, 1.0), 0.0, 1.0):
        assert (coin_bits(key, i) < coin_limit(limit)) == (its_own < limit)
