"""The scale bar's page tells of clicks on the map."""

from app.show import scale_bar


def test_each_click_on_a_map_is_heard_once_though_the_browser_tells_of_the_last_ones(monkeypatch):
    state = {"scale_bar_a": {"points": [[5, 35.1, 30.1], [9, 35.2, 30.2]]}}
    monkeypatch.setattr(scale_bar.st, "session_state", state)
    assert scale_bar.new_points("scale_bar_a") == ((35.1, 30.1), (35.2, 30.2))
    assert scale_bar.new_points("scale_bar_a") == ()
    state["scale_bar_a"] = {"points": [[9, 35.2, 30.2], [11, 35.3, 30.3], [12, 35.4, 30.4]]}
    assert scale_bar.new_points("scale_bar_a") == ((35.3, 30.3), (35.4, 30.4))
    state["scale_bar_a"] = {"points": None}
    assert scale_bar.new_points("scale_bar_a") == ()
