"""Each aisle has one robot at a time, and who waits holds none."""

import threading

from fieldmon.drive.aisle_keeper import AisleKeeper


def test_all_aisles_of_a_way_are_given_or_none():
    keeper = AisleKeeper()
    assert keeper.enter("a", [1, 2])
    assert not keeper.enter("b", [3, 2])
    assert keeper.enter("c", [3])  # b took nothing
    keeper.keep_only("a", [1])
    assert keeper.enter("b", [2])
    assert not keeper.enter("b", [1])


def test_who_moves_no_more_blocks_its_aisle_for_others_alone():
    keeper = AisleKeeper()
    keeper.enter("a", [1])
    assert not keeper.blocked("b", [1])
    keeper.end("a")
    assert keeper.blocked("b", [1, 2])
    assert not keeper.blocked("a", [1])
    assert not keeper.blocked("b", [2])


def test_of_many_who_ask_at_once_one_has_it():
    keeper, got = AisleKeeper(), []
    gate = threading.Barrier(8)

    def ask(name):
        gate.wait()
        if keeper.enter(name, [7]):
            got.append(name)

    threads = [threading.Thread(target=ask, args=(str(k),)) for k in range(8)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert len(got) == 1
