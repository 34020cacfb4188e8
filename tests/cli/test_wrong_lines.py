"""Wrong command lines end with a sentence and exit code 2, soon, and nothing is written."""

import pytest

from tests.cli import wrong_lines

LINES = 60


@pytest.fixture(scope="module")
def old_season(tmp_path_factory):
    """Return a small season, brought up to date once."""
    return wrong_lines.small_season(tmp_path_factory.mktemp("old"))


@pytest.mark.parametrize("first", range(0, LINES, 20))
def test_twenty_wrong_lines_are_each_a_sentence(first, tmp_path, old_season):
    """5 000 of them: see `tests.cli.wrong_lines`."""
    ended_badly = {}
    for seed in range(first, first + 20):
        folder = tmp_path / str(seed)
        folder.mkdir()
        wrong_lines.prepare(folder, old_season)
        words = wrong_lines.wrong_line(seed)
        problem = wrong_lines.trouble(words, folder, certain=wrong_lines.is_certain(seed))
        if problem:
            ended_badly[seed] = words, problem
    assert ended_badly == {}


def test_every_command_is_among_them():
    first_words = {tuple(wrong_lines.wrong_line(seed))[:1] for seed in range(2000)}
    assert {words[:1] for words, _ in wrong_lines.commands()} <= first_words


def test_what_makes_a_line_wrong_is_not_said_again_rightly():
    """The last of two counts: `--seeds many --seeds 1` was a right line, and ran a study."""
    for seed in range(2000):
        said = [word for word in wrong_lines.wrong_line(seed) if word.startswith("--")]
        assert len(said) == len({*said}), seed
