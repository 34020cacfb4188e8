"""`fieldmon app`: the app in the browser."""


def test_a_port_in_use_is_a_sentence(run):
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        code, _, err, _ = run("app", "--port", taken.getsockname()[1])
    assert code == 2
    assert "must be free" in err
