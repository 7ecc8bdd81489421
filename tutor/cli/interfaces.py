"""Builds the workspace's message types before a command that uses them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tutor.cli import terminal

if TYPE_CHECKING:
    from tutor.workspace import Workspace

_SIGNS = ("*/CMakeLists.txt", "*/*/CMakeLists.txt", "*/msg/*.msg", "*/srv/*.srv", "*/action/*.action")
"""What is in the folder `src` of any workspace that defines types."""


def build_interfaces(workspace: Workspace) -> None:
    """Build what has changed of the message types that the workspace defines; say on stderr what is done, or is wrong.

    Whatever cannot be built does not keep a command from running: it may not need it.
    """
    sources = workspace.root / "src"
    if not workspace.exists or not any(path for pattern in _SIGNS for path in sources.glob(pattern)):
        return
    from tutor.interfaces import build_workspace  # late: most workspaces define no types
    from tutor.ros.environment import detect

    announced: set[str] = set()

    def announce(name: str, fraction: float) -> None:
        if name not in announced:
            announced.add(name)
            terminal.say(f"building {name}, whose definitions have changed ...")

    try:
        builds = build_workspace(workspace.root, detect(), announce)
    except OSError as error:
        terminal.say(f"message types cannot be built: {error.strerror or error}")
        return
    for build in builds:
        if build.prefix is None:
            more = f" (and {len(build.problems) - 1} more)" if len(build.problems) > 1 else ""
            terminal.say(f"{build.name} is not built: {build.problems[0].text(workspace.root)}{more}")
        elif build.package.unlisted:
            listed = ", ".join(build.package.unlisted)
            terminal.say(f"{build.name} is built without {listed}: CMakeLists.txt does not list it")
