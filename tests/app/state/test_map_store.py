"""What maps are made of: kept under addresses that nobody guesses, let go of when there is much."""

import hashlib
import threading

import pytest

from app.state.map_store import BYTES, JSON, PATH, MapStore


def test_what_was_published_is_found_at_its_address_as_what_it_is():
    store = MapStore()
    text, data = store.publish(b"{}", JSON), store.publish(b"\0\1")
    assert store.get(text) == (JSON, b"{}")
    assert store.get(data) == (BYTES, b"\0\1")
    assert text.startswith(PATH)
    assert store.get(f"{PATH}0") is None


def test_the_same_content_has_the_same_address_however_often_it_is_published():
    store = MapStore()
    assert store.publish(b"plants") == store.publish(b"plants") != store.publish(b"others")


def test_an_address_cannot_be_worked_out_from_the_content():
    """Who knows a plot's layout must not learn whether somebody looks at it."""
    data = b"places of plants"
    mine, yours = (MapStore().publish(data) for _ in range(2))
    assert mine != yours
    plain = hashlib.blake2b(data, digest_size=20).hexdigest()
    assert plain not in mine
    assert len(mine.removeprefix(PATH)) == 40


def test_what_was_published_longest_ago_is_let_go_of_first_and_published_again():
    store = MapStore(at_most=30)
    first, second, third = (store.publish(bytes([k]) * 10) for k in range(3))
    assert store.publish(b"\0" * 10) == first  # is shown again
    fourth = store.publish(b"\3" * 10)
    assert [store.get(one) is not None for one in (first, second, third, fourth)] == [
        True, False, True, True
    ]  # fmt: skip
    assert store.publish(b"\1" * 10) == second
    assert store.get(second) == (BYTES, b"\1" * 10)


def test_what_is_larger_than_the_store_alone_is_kept_until_the_next():
    store = MapStore(at_most=5)
    large = store.publish(b"x" * 50)
    assert store.get(large) is not None
    store.publish(b"y")
    assert store.get(large) is None


@pytest.mark.parametrize("people", [8])
def test_many_people_at_once_find_what_they_published(people):
    store, missing = MapStore(at_most=10**6), []

    def publish(person):
        for k in range(200):
            data = f"{person % 3} {k}".encode()
            if store.get(store.publish(data)) != (BYTES, data):
                missing.append(data)

    at_work = [threading.Thread(target=publish, args=(k,)) for k in range(people)]
    for one in at_work:
        one.start()
    for one in at_work:
        one.join()
    assert missing == []
