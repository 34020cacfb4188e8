"""Tests of a room in which many begin with one season."""

from tests.app.one_folder import seasons_folder  # noqa: F401 - takes the place of another
