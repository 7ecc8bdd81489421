"""A case of the table: a launch file, and what the real launch makes of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

IMPORTS = """\
import os
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.events import matches_action
from launch.events import Shutdown as ShutdownEvent
from launch.events.process import ShutdownProcess, SignalProcess
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import Node, PushROSNamespace, PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackagePrefix, FindPackageShare
from launch.actions import Shutdown, TimerAction

"""


@dataclass(frozen=True)
class Case:
    """`actions` are the launch description's; `before` is code in front of it.

    `says`: for each process, by its name in the messages, all that it prints. `log`: messages of the launch that come
    in this order; others may come between. `absent`: texts that none of these holds. `files`: more files beside the
    launch file. $DIR is the folder of the launch file, $PREFIX that of the package `demo`; numbers of processes are N.
    """

    id: str
    source: str
    actions: str
    before: str = ""
    arguments: tuple[str, ...] = ()
    says: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    log: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    code: int = 0
    files: Mapping[str, str] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)
    interrupt_at: str = ""
    """Ctrl+C as soon as a line holds this text."""

    @property
    def text(self) -> str:
        return launch_file(self.actions, self.before)


def launch_file(actions: str, before: str = "") -> str:
    """The text of a launch file with these actions."""
    return f"{IMPORTS}{before}\ndef generate_launch_description():\n    return LaunchDescription([{actions}])\n"
