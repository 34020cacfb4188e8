"""What is asked of advice, and how what was assumed is told from what was said."""

import pytest

from fieldmon.cli.report_languages import spoken
from fieldmon.compute.units import Units
from fieldmon.decisions.sprayer import TreatmentCosts
from fieldmon.monitoring.settings.advice_settings import AdviceSettings


@pytest.mark.parametrize(
    ("days", "said"), [(14.0, "14 يومًا"), (3.0, "3 أيام"), (2.0, "يومان"), (1.5, "1.5")]
)
def test_days_in_arabic_have_the_form_of_their_number(days, said):
    assumed = AdviceSettings(costs=TreatmentCosts(days=days)).assumed()
    assert said in spoken("ar", "")[0].say(assumed)


def test_what_was_set_is_not_called_assumed():
    usual = AdviceSettings().assumed()
    assert usual.startswith("Assumed: to treat 1 ha costs 100, a zone costs 0.5, ")
    assert "As you said" not in usual
    some = AdviceSettings(costs=TreatmentCosts(per_ha=50.0, days=10.0)).assumed()
    assert some == (
        "Assumed: a zone costs 0.5, an infested plant loses 0.1 a day, treating cleans 90 %. "
        "As you said: to treat 1 ha costs 50, it stays infested for 10 days."
    )
    learnt = AdviceSettings(costs=TreatmentCosts(works=0.15), learnt_of="soap").assumed()
    assert "As you said" not in learnt
    assert learnt.endswith("14 days. As this season learnt of soap: treating cleans 15 %.")
    dear = AdviceSettings(costs=TreatmentCosts(per_ha=120_000.0)).assumed()
    assert "to treat 1 ha costs 120,000" in dear
    everything = TreatmentCosts(50.0, 1.0, 0.2, 10.0, 0.8)
    said = AdviceSettings(costs=everything).assumed(Units(area="dunam"))
    assert said.startswith("As you said: to treat 1 dunam costs 5, a zone costs 1, ")
