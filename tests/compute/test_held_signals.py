"""Who stops a program waits for what must be whole."""

import signal
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from fieldmon.compute.held_signals import stops_wait

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_who_stops_waits_until_all_is_done_and_is_heard_then(name):
    one, done = getattr(signal, name), []

    def stop(*_):
        raise KeyboardInterrupt

    before = signal.signal(one, stop)
    try:
        with pytest.raises(KeyboardInterrupt), stops_wait():  # noqa: PT012 - that all is done
            signal.raise_signal(one)
            done.append(name)
        assert done == [name]
        assert signal.getsignal(one) == stop
        signal.signal(one, signal.SIG_IGN)
        with stops_wait():
            assert signal.getsignal(one) == signal.SIG_IGN
    finally:
        signal.signal(one, before)


def test_in_another_thread_nobody_waits():
    def run():
        with stops_wait():
            return signal.getsignal(signal.SIGINT)

    with ThreadPoolExecutor(1) as threads:
        assert threads.submit(run).result() == signal.getsignal(signal.SIGINT)
