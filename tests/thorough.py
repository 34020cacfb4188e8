"""How much tests try: a few examples and seeds in each run, many where somebody asks for them."""

import os

# each property is tried on so many examples instead of its own number: `thorough` of conftest.py
EXAMPLES = int(os.environ.get("FIELDMON_EXAMPLES", "0"))


def times(few, many):
    """Return how often a test tries something: `many` times where `EXAMPLES` are asked for."""
    return many if EXAMPLES else few


def seeds(few, many):
    """Return a test's first `few` seeds, or `many` where `EXAMPLES` are asked for."""
    return range(times(few, many))
