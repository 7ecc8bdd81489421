"""A test case: a launch file, and what the real launch does with it."""

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
    """`actions` are the entities of the launch description; `before` is code in front of its function.

    `printed`: everything that each process prints, by the name of the process in the log. `log`: messages of the
    launch in this order, possibly with others between them; `*` matches anything. `absent`: texts that occur neither in
    the log nor in the output of processes. `files`: more files beside the launch file. $DIR stands for the launch
    file's folder, $PREFIX for the prefix of the package `demo`, and N for process ids.
    """

    id: str
    source: str
    actions: str
    before: str = ""
    arguments: tuple[str, ...] = ()
    printed: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    log: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    code: int = 0
    files: Mapping[str, str] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)
    interrupt_at: str = ""
    """Press Ctrl+C at the first line that contains this text."""

    @property
    def text(self) -> str:
        return launch_file(self.actions, self.before)


def launch_file(actions: str, before: str = "") -> str:
    """Return the text of a launch file with these actions."""
    return f"{IMPORTS}{before}\ndef generate_launch_description():\n    return LaunchDescription([{actions}])\n"
