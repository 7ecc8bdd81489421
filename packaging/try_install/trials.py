"""What an installed ros-tutor must do."""

from __future__ import annotations

import re

from places import CLONE, Failed, Place

_SEES_OUR_PACKAGES = """
import importlib.util as util
found = [util.find_spec(name) for name in ("tutor", "checks", "lessons")]
print([spec.origin for spec in found if spec is not None and "ros_tutor" in str(spec.submodule_search_locations)])
"""


def try_program(place: Place, program: list[str]) -> None:
    """Use the program in a folder that is not its user's. Raises Failed."""
    version = re.search(r'__version__ = "(.*)"', (CLONE / "tutor/__init__.py").read_text())
    assert version is not None
    _expect(f"ros-tutor {version[1]}", place.use(*program, "--version"))
    _expect("Sensor Publisher", place.use(*program, "list"))
    _expect("passed", place.use(*program, "check", "i1.1", "--solution"))
    _expect("int64 sum", place.use(*program, "ros2", "interface", "show", "example_interfaces/srv/AddTwoInts"))
    # A learner's own programs never import our packages: these names belong to others.
    _expect("[]", place.use(*program, "shell", "-c", f"python3 -c '{_SEES_OUR_PACKAGES}'"))
    line = "ros-tutor chec"
    words = place.use(
        "sh", "-c", '"$@" 8>&1 >/dev/null', "sh", *program,
        _ARGCOMPLETE="1", _ARGCOMPLETE_SHELL="bash", COMP_LINE=line, COMP_POINT=str(len(line)),
    )  # fmt: skip
    _expect("checklist", words)


def _expect(text: str, output: str) -> None:
    if text not in output:
        raise Failed(f"{text!r} is not in {output.strip()[-300:]!r}")
