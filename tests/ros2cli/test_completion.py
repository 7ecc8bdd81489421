"""What Tab offers, asked for as a shell asks: by argcomplete's variables."""

from __future__ import annotations

import subprocess

from tests.ros2cli.bench import Bench, command

SEPARATOR = "\013"


def offers(bench: Bench, line: str) -> list[str]:
    """What is offered for the last word of a line."""
    answer = bench.folder / "offers"
    asked = {
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_IFS": SEPARATOR,
        "_ARGCOMPLETE_SHELL": "bash",
        "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
        "COMP_TYPE": "9",
    }
    subprocess.run(command(), env={**bench.env, **asked}, cwd=bench.folder, timeout=60, check=False)
    return [offer for offer in answer.read_text().split(SEPARATOR) if offer]


def test_launch_offers_packages_their_launch_files_and_paths(bench: Bench) -> None:
    package = bench.folder / "ws" / "src" / "mine"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='3'><name>mine</name></package>")
    (package / "setup.py").write_text("from setuptools import setup\nsetup(name='mine')\n")
    (package / "mine").mkdir()
    (package / "mine" / "__init__.py").touch()
    for name in ("my_launch.py", "my.launch.xml", "notes.txt"):
        (package / "launch" / name).touch()
    assert {"mine", "demo_nodes_py"} <= set(offers(bench, "ros2 launch "))
    assert offers(bench, "ros2 launch min") == ["mine"]
    assert offers(bench, "ros2 launch mine my") == ["my.launch.xml", "my_launch.py"]
    assert offers(bench, "ros2 launch nope m") == []
    assert offers(bench, "ros2 launch ws/src/mine/launch/m") == [
        "ws/src/mine/launch/my.launch.xml",
        "ws/src/mine/launch/my_launch.py",
    ]
    assert offers(bench, "ros2 launch ws/sr") == ["ws/src/"]
    assert all(offer.startswith("-") for offer in offers(bench, "ros2 launch mine my_launch.py "))
