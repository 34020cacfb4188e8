"""A robot that drives now is watched."""

from app.actions import watching
from app.words import texts
from fieldmon.drive.vda5050.mqtt import BrokerError
from tests.app.driving import go, map_of, press, until


def test_a_robot_that_drives_now_is_asked_for_and_what_is_wrong_is_said(app):
    go(app, "drive")
    app.segmented_control(key="drive_source").set_value("live").run()
    assert any(one.value == texts.DRIVE_LIVE for one in app.caption)
    app.text_input(key="drive_broker").set_value("127.0.0.1:1").run()
    press(app, texts.DRIVE_WATCH)
    # by its box: who is at a page has no options of a command
    said = texts.DRIVE_NO_BROKER.format(where=texts.isolated("127.0.0.1:1"))
    until(lambda: any(one.value == said for one in app.run().error))
    refused = BrokerError("It must let us in.", "127.0.0.1:1", answers=True)
    assert "mqtt://USER" in watching._said(refused)
    assert map_of(app)["drive"] is None
    app.text_input(key="drive_serial robot1").set_value("robot-1, a/b").run()
    assert "but no /, +, # or $" in app.error[0].value
    app.segmented_control(key="drive_whose").set_value("all").run()
    assert not app.error
    assert not [box for box in app.text_input if box.key.startswith("drive_serial")]
