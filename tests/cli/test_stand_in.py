"""`fieldmon stand-in`: a simulated robot for trying."""

from fieldmon.cli.stand_in import StandInOptions


def test_what_it_makes_up_of_a_plant_stays_the_same():
    options = StandInOptions(infested=0.3, seed=2)
    seen = [options.look(k) for k in range(300)]
    assert seen == [options.look(k) for k in range(300)]
    assert 50 < sum(seen) < 130


def test_impossible_settings_are_refused(run):
    code, _, err, _ = run("stand-in", "--faster", "0")
    assert code == 2
    assert "above 0" in err


def test_where_no_broker_answers_it_is_a_sentence(run):
    code, _, err, _ = run("stand-in", "--broker", "127.0.0.1:1")
    assert code == 2
    assert "MQTT broker must answer" in err
