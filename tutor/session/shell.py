"""The learner's own shell, with ROS 2 and the workspace sourced: for `ros-tutor shell` and the app's terminals."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tutor.workspace import Workspace, domain_of

TERM = "xterm-256color"
"""What the app's terminals are like, for programs."""

_OTHER_TERMINAL = ("COLUMNS", "LINES", "STY", "TERM_PROGRAM", "TEXTUAL_", "TMUX", "VTE_VERSION")
"""The beginnings of variables that describe the terminal in which the app itself runs, or how it draws there."""


@dataclass(frozen=True, slots=True)
class ShellCommand:
    """How to start an interactive shell; `setup` is the workspace's setup file where it has one to be sourced."""

    name: str
    path: Path
    argv: tuple[str, ...]
    env: dict[str, str]
    setup: Path | None


def shell_command(workspace: Workspace, tools: Path, environ: Mapping[str, str] = os.environ) -> ShellCommand:
    """Return the command of the user's shell, sourced, in the workspace's domain.

    `tools` is a folder that the caller keeps as long as the shell. Raises LookupError if there is no shell that can be
    sourced, ValueError if the domain is no number, and OSError.
    """
    from tutor.bundled_ros.ros2 import sourced
    from tutor.bundled_ros.ros2.terminal import interactive_command, users_shell
    from tutor.ros.environment import detect  # imported late, not to delay the first paint

    name, path = users_shell(environ)
    ros = detect()
    env = sourced.sourced_environment(ros, workspace.root, domain_of(workspace), tools, environ)
    setup = sourced.setup_file(ros, workspace.root, name)
    argv = interactive_command(
        name,
        path,
        env=env,
        exported={name: value for name, value in env.items() if environ.get(name) != value},
        unset=sorted(set(environ) - set(env)),
        tools=tools,
        mark=f"(ROS 2: {workspace.root.name}) ",
        setup=setup,
    )
    return ShellCommand(name, path, tuple(argv), env, setup)


def in_the_app(environ: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return the environment of the app's terminals, before anything is sourced."""
    return {
        **{name: value for name, value in environ.items() if not name.startswith(_OTHER_TERMINAL)},
        "TERM": TERM,
        "COLORTERM": "truecolor",
    }
