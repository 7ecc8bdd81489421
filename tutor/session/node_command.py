"""How to start a node. Apart from `node`, which the first paint would have to wait for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class NodeCommand:
    """How to start one file as a node. `typed` is the command that a ROS user would type for it.

    `terminal`: whether its standard input is a terminal, which `ros2 launch` needs for Ctrl+C.
    """

    file: str
    argv: tuple[str, ...]
    env: dict[str, str]
    cwd: Path
    typed: str = ""
    terminal: bool = False
