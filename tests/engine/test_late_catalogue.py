"""The catalogue of mistakes is imported only when something has failed: most criteria pass."""

from __future__ import annotations

import subprocess
import sys

PASSES_THEN_FAILS = """
import sys
from tutor import engine
from tutor.content import load_course
from tutor.engine.explanation import explain
from tutor.engine.loading import load_check
from tutor.engine.progress import RunSnapshot, describe
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import failed, passed

checks = [load_check(lesson) for lesson in load_course().lessons]
for check in checks:
    explain(passed("5 messages", "5 messages"), check)
describe(RunSnapshot(Trace("node.py")), load_course().lessons[0].live)
print("tutor.mistakes" in sys.modules)
seen = Symptom.NO_MESSAGES.seen(Trace("node.py", sources={"node.py": "import rclpy\\n"}), topic="/a", type="b/msg/C")
print(bool(explain(failed("5 messages", "0 messages", seen), checks[0]).mistake), "tutor.mistakes" in sys.modules)
"""


def test_a_pass_does_not_import_it_and_a_failure_does() -> None:
    done = subprocess.run([sys.executable, "-c", PASSES_THEN_FAILS], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True", "True"]
