"""How a learner's source is read for a diagnosis."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tutor.engine.source import read_sources
from tutor.source import NodeFile, Program, SourceFile, values_of
from tutor.source.tree import parsed

CLIENT = """
class Client(Node):
    def __init__(self):
        self.add_client = self.create_client(AddTwoInts, "add")
        clients["divide"] = self.create_client(
            AddTwoInts, "divide"
        )
        # wait_for_service, says the lesson
        self.add_client.call_async(AddTwoInts.Request())
"""


def test_names_calls_and_assignments_are_found_and_comments_are_not() -> None:
    program = Program({"client.py": CLIENT}, "client.py")
    assert program.mentions("call_async")
    assert program.mentions("nothing", "Node")
    assert not program.mentions("wait_for_service")
    assert [call.lineno for call in program.calls("create_client", "call_async")] == [4, 5, 9]
    assert [program.file.assigned_to(call) for call in program.calls("create_client")] == [
        "self.add_client",
        "clients['divide']",
    ]


NODE = """
class Stats(Node):
    def __init__(self):
        self.create_subscription(String, "chatter", self.heard, 10)
        self.create_timer(1.0, lambda: self.tick(1))
    def heard(self, message):
        self.count(message)
        self.heard(None)
    def count(self, message): ...
    def tick(self, by): ...
    def other(self): ...
"""


@pytest.mark.parametrize(
    ("create", "found"), [("create_subscription", ["heard", "count"]), ("create_timer", ["tick"]), ("create", [])]
)
def test_callbacks_are_found_with_what_they_call(create: str, found: list[str]) -> None:
    assert [each.name for each in Program({"node.py": NODE}, "node.py").callbacks(create)] == found


@pytest.mark.parametrize("text", ["def broken(:", "\0", "(" * 5000])
def test_an_unparsable_file_yields_nothing(text: str) -> None:
    program = Program({"node.py": text}, "node.py")
    assert not program.mentions("Node")
    assert program.calls("call") == []


def test_files_imported_from_the_same_folder_are_included(tmp_path: Path) -> None:
    for name, text in {
        "node.py": "import helper\nfrom my_package.more import thing\nimport rclpy",
        "helper.py": "from node import main",
        "more.py": "def broken(:",
        "other.py": "",
    }.items():
        (tmp_path / name).write_text(text)
    assert sorted(read_sources(tmp_path / "node.py")) == ["helper.py", "more.py", "node.py"]
    (tmp_path / "node.py").write_bytes(b"# coding: latin-1\n# \xe9\nimport helper")
    assert "\xe9" in read_sources(tmp_path / "node.py")["node.py"]
    (tmp_path / "node.py").write_bytes(b"\xff\xfe")
    assert read_sources(tmp_path / "node.py") == {}


def test_warnings_about_the_learners_code_are_not_ours(tmp_path: Path, recwarn: pytest.WarningsRecorder) -> None:
    text = 'import re\nDIGITS = re.compile("\\d+")\nif 1 is 1:\n    pass\n'
    (tmp_path / "node.py").write_text(text)
    assert read_sources(tmp_path / "node.py")["node.py"] == text
    assert len(parsed(text).body) == 3
    assert not list(recwarn)


@pytest.mark.parametrize(
    ("calls", "found"),
    [
        ("offer('a', handle)", "handle"),
        ("offer('a', callback=handle)", "handle"),
        ("offer('a', handle)\noffer('b', other)", None),  # it depends on the call
        ("offer('a', unknown)", None),
    ],
)
def test_a_parameter_refers_to_the_function_that_all_callers_pass(calls: str, found: str | None) -> None:
    text = (
        "def offer(name, callback):\n    node.create_service(AddTwoInts, name, callback)\n\n"
        f"def handle(request, response):\n    return response\n\ndef other(request):\n    pass\n\n{calls}\n"
    )
    file = SourceFile(text)
    function = file.function(file.calls("create_service")[0].args[2])
    assert (function.name if function else None) == found


def test_annotated_assignments_in_functions_are_read_as_plain_ones() -> None:
    text = """
@dataclass
class Settings:
    rate: float = 1.0

    def __init__(self):
        self.timer: Timer = self.create_timer(1.0, self.tick)
        self.late: Timer
"""
    file = SourceFile(text)
    assert values_of("self.timer", file.tree)
    assert file.assigned_to(file.calls("create_timer")[0]) == "self.timer"
    kept = [ast.unparse(each) for each in file.nodes if isinstance(each, ast.AnnAssign)]
    assert kept == ["rate: float = 1.0", "self.late: Timer"]
    assert file.calls("create_timer")[0].lineno == 7


TWO_TIMERS = """\
class Sensor(Node):
    def __init__(self):
        self.publisher = self.create_publisher(Float64, 'temperature', 10)
        self.sampling = self.create_timer(0.1, self.sample)
        self.reporting = self.create_timer(0.5, self.report)

    def sample(self):
        self.latest = 20.0

    def report(self):
        self.publisher.publish(Float64(data=self.latest))
"""


def test_of_several_timers_the_one_that_publishes_is_the_first() -> None:
    callback = NodeFile(TWO_TIMERS).timer_callback
    assert callback is not None
    assert callback.name == "report"


def test_an_overridden_method_that_does_nothing_is_no_callback() -> None:
    base = "class B:\n  def f(self):\n    raise NotImplementedError\n"
    file = SourceFile(f"class A:\n  def f(self):\n    return 1\n{base}x = y(self.f)")
    found = file.function(file.calls("y")[0].args[0])
    assert found is not None
    assert found.lineno == 2
