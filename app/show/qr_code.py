"""An address as a picture that phones read. No Streamlit in here."""

from __future__ import annotations

from html import escape

import segno


def image(address: str, alt: str) -> str:
    """Return the picture of an address, dark on light on any page: many phones read no other.

    Examples
    --------
    >>> image("http://192.0.2.7:8501/", "For the phone")[:41]
    '<img class="qr" alt="For the phone" src="'
    """
    drawn = segno.make(address, error="m", micro=False).svg_data_uri(
        scale=8, border=4, dark="#000", light="#fff"
    )
    return f'<img class="qr" alt="{escape(alt)}" src="{escape(drawn)}">'
