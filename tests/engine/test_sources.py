"""Which of a learner's files a diagnosis is told of."""

from __future__ import annotations

from pathlib import Path

from tutor.engine.source import sources


def test_what_a_launch_file_names_is_beside_it(tmp_path: Path) -> None:
    (tmp_path / "my_launch.py").write_text(
        "import helper\n\n\ndef generate_launch_description():\n"
        "    return [Node(package='my_package', executable='speaker'), include('more.launch.py')]\n"
    )
    for name in ("helper", "speaker", "more.launch", "other"):
        (tmp_path / f"{name}.py").write_text("x = 'other'\n")
    assert set(sources(tmp_path / "my_launch.py")) == {"my_launch.py", "helper.py", "speaker.py", "more.launch.py"}


def test_a_text_of_a_node_is_no_file(tmp_path: Path) -> None:
    (tmp_path / "talker.py").write_text("topic = 'chatter'\n")
    (tmp_path / "chatter.py").write_text("x = 1\n")
    assert set(sources(tmp_path / "talker.py")) == {"talker.py"}
