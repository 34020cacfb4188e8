"""HTML pages from templates: what is put in is escaped, and a page needs nothing but itself."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from fieldmon.io.packaged import packaged_text

if TYPE_CHECKING:
    from jinja2 import Environment


def page(template: str, **values: object) -> str:
    """Return a page: a template with its blanks filled in, all styles inside it.

    Parameters
    ----------
    template
        Its path from where the packages stand, as ``"fieldmon/io/writers/field_sheet.html.j2"``. It
        extends ``fieldmon/io/templates/page.html.j2`` and stands beside the module that fills it.
    values
        What the template names. Texts are escaped, whatever stands in them; only
        `markupsafe.Markup`, a drawing for example, is put in as it is.

    Raises
    ------
    jinja2.UndefinedError
        Where the template names what is not given: a page is never half empty.
    """
    return _environment().get_template(template).render(values)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FunctionLoader, StrictUndefined  # noqa: PLC0415 - late

    return Environment(
        loader=FunctionLoader(packaged_text),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
