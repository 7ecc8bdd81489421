"""Tab completion, requested as a shell does, through argcomplete's variables."""

from __future__ import annotations

from tests.ros2cli.bench import Bench

SEPARATOR = "\013"


def complete(bench: Bench, line: str) -> list[str]:
    """Return the completions of a line's last word."""
    answer = bench.folder / "offers"
    variables = {
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_IFS": SEPARATOR,
        "_ARGCOMPLETE_SHELL": "bash",
        "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
        "COMP_TYPE": "9",
    }
    bench.ros2(env=variables)
    return [word for word in answer.read_text().split(SEPARATOR) if word]


def test_launch_completes_packages_launch_files_and_paths(bench: Bench) -> None:
    package = bench.folder / "ws" / "src" / "mine"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='3'><name>mine</name></package>")
    (package / "setup.py").write_text("from setuptools import setup\nsetup(name='mine')\n")
    (package / "mine").mkdir()
    (package / "mine" / "__init__.py").touch()
    for name in ("my_launch.py", "my.launch.xml", "notes.txt"):
        (package / "launch" / name).touch()
    assert {"mine", "demo_nodes_py"} <= set(complete(bench, "ros2 launch "))
    assert complete(bench, "ros2 launch min") == ["mine"]
    assert complete(bench, "ros2 launch mine my") == ["my.launch.xml", "my_launch.py"]
    assert complete(bench, "ros2 launch nope m") == []
    assert complete(bench, "ros2 launch ws/src/mine/launch/m") == [
        "ws/src/mine/launch/my.launch.xml",
        "ws/src/mine/launch/my_launch.py",
    ]
    assert complete(bench, "ros2 launch ws/sr") == ["ws/src/"]
    assert all(word.startswith("-") for word in complete(bench, "ros2 launch mine my_launch.py "))
