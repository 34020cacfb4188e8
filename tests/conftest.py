"""Settings for all tests."""

import os

from hypothesis import HealthCheck, settings

# the first example of a property pays for compiling; a landing must not depend on luck
settings.register_profile(
    "fieldmon",
    deadline=None,
    derandomize="CI" in os.environ,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("fieldmon")
