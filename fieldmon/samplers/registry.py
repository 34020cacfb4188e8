"""The samplers by name: the one place that lists them.

A new sampler is one file in this package and one line in `SAMPLERS`. The command line, the app,
studies and the promises in the tests find it there. Nothing is loaded before it is used: a
command's help must not wait for compiled loops.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from inspect import signature
from numbers import Integral
from typing import TYPE_CHECKING, Any, cast

from fieldmon.compute.arguments import must_be, must_be_known, shown
from fieldmon.compute.ranges import AllowedRange
from fieldmon.errors import SettingError
from fieldmon.samplers.own import asked, is_own, own_class

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fieldmon.samplers.base import Sampler


@dataclass(frozen=True)
class SamplerKind:
    """What is known of a sampler before it is loaded.

    Parameters
    ----------
    where
        ``"module:Class"``: the module of this package, and the sampler in it.
    title, does
        What people call it, and what it does, in a few words.
    every
        Its own N if it inspects every N-th plant or stop and takes another, else None.
    settings
        Settings that make this one of several kinds of its class.
    reads_chance
        Whether it reads the believed chances, see `Sampler`.
    chooses_time
        Whether it decides at each plant how long to inspect it.
    draws_share
        Whether it takes one N-th of the plot a day, drawn, however long the day is.
    s_per_plant_day
        About how many seconds a simulated day costs for each plant of the plot.
    """

    where: str
    title: str
    does: str
    every: int | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    reads_chance: bool = False
    chooses_time: bool = False
    draws_share: bool = False
    s_per_plant_day: float = 2e-8

    def __repr__(self) -> str:
        return f"<{self.title}: {self.does}>"

    def load(self) -> Callable[..., Sampler]:
        """Return the class."""
        module, name = self.where.split(":")
        loaded: Callable[..., Sampler] = getattr(import_module(f"{__package__}.{module}"), name)
        return loaded

    def settings_for(self, every: int | None) -> dict[str, float]:
        """Return the settings that a given N comes to: none where it takes none, or is given none.

        For whoever asks for an N whichever sampler is chosen, as the commands do.
        """
        return {} if every is None or self.every is None else {"every": every}


#: no plot has more plants than that
EVERY = AllowedRange(1, 10_000_000)
SAMPLERS = {
    "naive": SamplerKind("sweeps:Naive", "Naive", "every plant, row by row"),
    "bouncy": SamplerKind("sweeps:Bouncy", "Bouncy", "every second plant", every=2),
    "dynamic": SamplerKind(
        "dynamic:Dynamic", "Dynamic", "suspicious plants first",
        reads_chance=True, s_per_plant_day=4e-7,
    ),
    "adaptive": SamplerKind(
        "adaptive:Adaptive", "Adaptive", "the drive that should find most",
        reads_chance=True, s_per_plant_day=2.5e-6,
    ),
    "adaptive-looks": SamplerKind(
        "adaptive:Adaptive", "Adaptive-looks", "the same, longer at the plants most suspected",
        settings={"chooses_time": True},
        reads_chance=True, chooses_time=True, s_per_plant_day=2.5e-6,
    ),
    "decide": SamplerKind(
        "decide:Decide", "Decide", "the inspections that tell soonest whether treating pays",
        reads_chance=True, s_per_plant_day=4e-7,
    ),
    "snake": SamplerKind(
        "without_prior:Snake", "Snake", "up one side of an aisle, down the other", every=1
    ),
    "snake-random": SamplerKind(
        "without_prior:SnakeRandom", "Snake-random", "every 1st to 4th plant by chance"
    ),
    "neighbor": SamplerKind(
        "without_prior:Neighbor", "Neighbor", "both sides of the aisle at each stop", every=1
    ),
    "neighbor-random": SamplerKind(
        "without_prior:NeighborRandom", "Neighbor-random", "every 1st to 4th stop by chance"
    ),
    "random": SamplerKind(
        "without_prior:RandomShare", "Random", "a third of the plot, drawn every day", every=3,
        draws_share=True,
    ),
}  # fmt: skip
#: who plans where nobody says otherwise, and who is compared
USUAL_SAMPLER = "adaptive"
COMPARED = ("naive", "bouncy", "dynamic")


def check_every(every: int) -> None:
    """Raise `SettingError` unless every N-th plant or stop can be inspected."""
    instead = "Give 2 for every second one."
    must_be("'every' must be a whole number", every, Integral, instead, but_no=(bool,))
    if rule := EVERY.broken(every):
        raise SettingError(f"'every' must be {rule}, but it is {shown(every)}.")


def kind_of(name: str, what: str = "A sampler") -> SamplerKind:
    """Return what is known of a sampler; raise `SettingError` if there is none of that name.

    `what` was given, in the sentence.
    """
    if name in SAMPLERS:
        return SAMPLERS[name]
    sentence = f"{what} must be one of {', '.join(SAMPLERS)}, but it is {name!r}."
    if is_own(name):
        sentence += (
            " One of your own works in fieldmon plan and simulate, on a plot, and in fieldmon "
            "study run and samplers."
        )
    raise SettingError(sentence)


def sampler(name: str, **settings: Any) -> Sampler:  # noqa: ANN401 - each sampler has its own
    """Return the sampler called `name`; raise `SettingError` if there is none.

    Parameters
    ----------
    settings
        As its class takes them, see its docstring.
    """
    kind = kind_of(name)
    made = kind.load()
    if settings:  # to ask a class what it takes is most of what making one costs
        must_be_known(f"Settings of {name}", settings, list(signature(made).parameters))
    return made(**{**kind.settings, **settings})


def sampler_or_name(given: str | Sampler) -> Sampler:
    """Return the sampler of a name, or one of a caller's own: made, or ``my_sampler.py:Mine``.

    What one of a caller's own answers is checked, see `Checked`.

    Raise `SettingError` if there is none of that name, or it is no sampler.
    """
    if isinstance(given, str):
        return sampler_maker(given)()
    own = all(callable(getattr(given, name, None)) for name in ("walk", "inspection_times"))
    if isinstance(given, type) and own:
        raise SettingError(
            f"A sampler must be made, but it is {shown(given)} itself. Give {given.__name__}()."
        )
    if not own:
        raise SettingError(
            f"A sampler must be one of {', '.join(SAMPLERS)}, or one of your own with a method "
            f"walk, but it is {shown(given)}. Give its name, or derive your own from "
            "fieldmon.Sampler."
        )
    if type(given).__module__.startswith("fieldmon."):
        return given
    from fieldmon.samplers.checked_sampler import Checked  # noqa: PLC0415 - it has a loop to compile

    return Checked(given)


def sampler_maker(name: str) -> Callable[[], Sampler]:
    """Return what makes the sampler of a name, a new one each time.

    A file of a caller's own is read now: what is made later is of the same code.

    Raise `SettingError` if there is none of that name.
    """
    if not is_own(name):
        kind_of(name)
        return partial(sampler, name)
    kind = own_class(name)
    return lambda: sampler_or_name(cast("Sampler", asked(kind.__name__, kind)))


def sampler_with(name: str, every: int | None) -> Sampler:
    """Return the sampler of a name, or one of a caller's own, with a given N if it takes one."""
    if every is None or is_own(name):
        return sampler_or_name(name)
    return sampler(name, **kind_of(name).settings_for(every))


def of_equal_times() -> dict[str, SamplerKind]:
    """Return those that inspect every plant equally long, as they are offered to people.

    The usual one comes first, then those that read chances.
    """
    equal = {name: kind for name, kind in SAMPLERS.items() if not kind.chooses_time}
    order = sorted(equal, key=lambda name: (name != USUAL_SAMPLER, not equal[name].reads_chance))
    return {name: equal[name] for name in order}
