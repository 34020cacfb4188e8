"""What `fieldmon drive` is told: who drives, by which means, and what is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_ranges import refusing, within
from fieldmon.cli.options import (
    Every,
    Feature,
    MaybePlotFile,
    PlotFiles,
    RecordsFile,
    StartTime,
    WorkDate,
)
from fieldmon.cli.sampler_names import OneSampler
from fieldmon.cli.worker_options import WorkerOptions
from fieldmon.compute.ranges import CHANCE, SEED
from fieldmon.samplers import USUAL_SAMPLER

if TYPE_CHECKING:
    from fieldmon.drive.vda5050.mqtt import RobotName

BrokerName = Annotated[
    str, typer.Option("--broker", help="MQTT broker: HOST:PORT or mqtts://USER:PASSWORD@HOST:PORT.")
]
Serial = Annotated[str, typer.Option(help="Serial number of the robot, as in its topics.")]
RobotModel = Annotated[
    Path | None,
    typer.Option(
        "--robot-model",
        help="Model of a robot for mujoco, URDF or MJCF (docs: drive names its joints).",
    ),
]
SteeringName = Annotated[
    str,
    typer.Option(
        help="For mujoco's own robot. differential: two driven wheels. ackermann: a steered axle, "
        "which turns at corners by arcs and shunts."
    ),
]


def _too_rough(height_m: float) -> str:
    from fieldmon.drive.ground import ROUGH_M

    return ROUGH_M.broken(height_m)


Rough = Annotated[
    float,
    typer.Option(
        help="With mujoco: height of bumps in metres (standard deviation).",
        callback=refusing(_too_rough),
    ),
]
GroundHeights = Annotated[
    Path | None, typer.Option("--ground", help="With mujoco: raster of heights (GeoTIFF), metres.")
]
Version = Annotated[str, typer.Option("--vda", help="Version of VDA 5050: 2.1 or 3.0.")]
Maker = Annotated[str, typer.Option("--manufacturer", help="Manufacturer, as in its topics.")]


class Drives(StrEnum):
    """Who drives."""

    CHARGED = "charged"
    MUJOCO = "mujoco"
    VDA5050 = "vda5050"


@dataclass(frozen=True)
class DriveOptions:
    """What `fieldmon drive` is told."""

    plot: MaybePlotFile = None
    robot: Annotated[
        Drives,
        typer.Option(
            help="charged: the seconds that are charged, no physics. mujoco: wheels in a physical "
            "simulation. vda5050: a robot that takes orders over MQTT."
        ),
    ] = Drives.CHARGED
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Table of the day (CSV); a table of its stops is written beside it.",
        ),
    ] = None
    bag: Annotated[
        Path | None, typer.Option(help="Bag of ROS 2 (.mcap), for RViz and Foxglove.")
    ] = None
    records: RecordsFile = None
    feature: Feature = None
    sampler: OneSampler = USUAL_SAMPLER
    every: Every = None
    on: WorkDate = None
    start: StartTime = "06:00"
    infested: Annotated[
        float,
        typer.Option(
            help="Share of plants that a simulated robot finds infested.", callback=within(CHANCE)
        ),
    ] = 0.02
    seed: Annotated[
        int, typer.Option(help="Seed of simulated insects and noise.", callback=within(SEED))
    ] = 1
    gnss: Annotated[
        float,
        typer.Option(
            help="Noise of simulated positions, metres (standard deviation).",
            callback=within(0, 100, unit=" metres"),
        ),
    ] = 0.0
    robot_model: RobotModel = None
    steering: SteeringName = "differential"
    rough: Rough = 0.0
    ground: GroundHeights = None
    made_up: Annotated[
        bool,
        typer.Option("--made-up", help="Record a simulated robot's made-up finds in the season."),
    ] = False
    broker: BrokerName = "127.0.0.1:1883"
    serial: Serial = "robot1"
    manufacturer: Maker = "fieldmon"
    vda: Version = "2.1"
    worker: WorkerOptions = field(default_factory=WorkerOptions)
    files: PlotFiles = field(default_factory=PlotFiles)

    def robot_name(self) -> RobotName:
        """Return what a robot is called over MQTT, and the version that it speaks."""
        from fieldmon.drive.vda5050.mqtt import RobotName
        from fieldmon.drive.vda5050.versions import known_version

        return RobotName(self.manufacturer, self.serial, known_version(self.vda))

    @property
    def name(self) -> str:
        """What the robot is called in tables and batches."""
        if self.robot is Drives.VDA5050:
            return f"{self.manufacturer}/{self.serial}"
        return str(self.robot)
