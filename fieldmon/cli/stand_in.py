"""`fieldmon stand-in`: a simulated robot that speaks VDA 5050. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import typer

from fieldmon.cli.drive_options import BrokerName, Maker, Version
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import of_robot, within
from fieldmon.compute.ranges import CHANCE, SEED
from fieldmon.plot.robot import KM_H


@dataclass(frozen=True)
class StandInOptions:
    """What `fieldmon stand-in` is told."""

    broker: BrokerName = "127.0.0.1:1883"
    serial: Annotated[
        list[str] | None,
        typer.Option(help="Serial number, as in its topics; several for several robots."),
    ] = None
    manufacturer: Maker = "fieldmon"
    vda: Version = "2.1"
    speed: Annotated[
        float,
        typer.Option(help="Driving speed, km/h.", callback=of_robot("speed_m_s")),
    ] = 2.5
    faster: Annotated[
        float,
        typer.Option(
            help="How many times faster than the clock.", callback=within(0, 1e6, above=True)
        ),
    ] = 60.0
    infested: Annotated[
        float, typer.Option(help="Share of plants found infested.", callback=within(CHANCE))
    ] = 0.02
    seed: Annotated[int, typer.Option(help="Seed of what it finds.", callback=within(SEED))] = 1

    def look(self, plant: int) -> bool:
        """Return what it makes up of a plant: the same each time."""
        import numpy as np

        return bool(np.random.default_rng((self.seed, plant)).random() < self.infested)


@with_options
def stand_in(options: StandInOptions) -> None:
    """Simulate a VDA 5050 robot, to try fieldmon drive --robot vda5050; Ctrl-C ends it.

    It drives what it is ordered, looks, and makes up what it finds. --faster hurries its clock;
    while it waits for an order its day stands still.

    Example: fieldmon stand-in --broker 127.0.0.1:1883 --faster 100
    """
    from fieldmon.drive.vda5050.mqtt import Broker, RobotName
    from fieldmon.drive.vda5050.stand_in import StandIn
    from fieldmon.drive.vda5050.versions import known_version

    broker, version = Broker.of(options.broker), known_version(options.vda)
    robots = [
        StandIn(
            broker,
            RobotName(options.manufacturer, serial, version),
            options.look,
            options.speed / KM_H,
            options.faster,
        )
        for serial in dict.fromkeys(options.serial or ["robot1"])
    ]
    names = ", ".join(f"{options.manufacturer}/{robot.name.serial}" for robot in robots)
    typer.echo(f"{names} waits for orders at {options.broker}. End it with Ctrl-C.")
    for robot in robots[1:]:
        robot.start()
    try:
        robots[0].run()
    except KeyboardInterrupt:
        typer.echo("Ended.")
    finally:
        for robot in robots:
            robot.stop()
