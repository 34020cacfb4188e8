"""Who is told to end a command."""

import signal
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from fieldmon.cli.told_to_end import as_at_ctrl_c, told_to_end

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_ends_a_command_as_ctrl_c_does_unless_it_was_begun_to_pass_it_by(name):
    one, told = getattr(signal, name), []
    before = signal.getsignal(one)
    with pytest.raises(KeyboardInterrupt), told_to_end(as_at_ctrl_c):
        signal.raise_signal(one)
    assert signal.getsignal(one) == before
    signal.signal(one, signal.SIG_IGN)  # as nohup begins it
    try:
        with told_to_end(lambda: told.append(name)):
            signal.raise_signal(one)
    finally:
        signal.signal(one, before)
    assert told == []


def test_in_another_thread_nobody_is_told():
    def run():
        with told_to_end(as_at_ctrl_c):
            return signal.getsignal(signal.SIGTERM)

    with ThreadPoolExecutor(1) as threads:
        assert threads.submit(run).result() == signal.getsignal(signal.SIGTERM)
