"""What there is to translate and what is translated, read once a test session."""

from functools import cache

from app.words import catalogues


@cache
def entries():
    """Return every text of the app and sentence of the library."""
    return tuple(catalogues.entries())


@cache
def catalogue(code):
    """Return the catalogue of a language as it lies in the repository."""
    return catalogues.read(code)
