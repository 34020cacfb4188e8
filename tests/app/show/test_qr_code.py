"""The picture of an address is dark on light, names itself, and is of nothing but itself."""

import re

from app.show.qr_code import image


def test_it_is_a_picture_in_itself_with_words_for_those_who_cannot_see_it():
    drawn = image("http://192.0.2.7:8501/?season=Gate+2026&part=scout", 'For "the" phone')
    assert re.fullmatch(
        r'<img class="qr" alt="For &quot;the&quot; phone" src="data:image/svg.*">', drawn
    )
    assert "192.0.2.7" not in drawn


def test_other_addresses_are_other_pictures():
    assert image("http://192.0.2.7/a", "") != image("http://192.0.2.7/b", "")
