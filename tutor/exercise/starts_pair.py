"""A form: a launch file starts a publisher and a subscriber."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.launch_graph import describe_pair, find_pair
from tutor.exercise.launch_run import Launch, LaunchRun
from tutor.exercise.launch_symptoms import seen_in_launch
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail


@dataclass(frozen=True)
class StartsPair(Form):
    """One launch without arguments starts two nodes: one that publishes and one that subscribes.

    On any topics: whether they are connected is for `PairCommunicates`. The second may come some seconds after the
    first. The exercise's program must be a `LaunchFile`:

        CHECK = check("x1.3", LaunchFile("lamp_launch.py"), StartsPair("starts"))
    """

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> Launch:
        return Launch(exercise.launch_file)

    def judge(self, seen: LaunchRun) -> Verdict:
        """Judge a launch without arguments."""
        expected = "one command, without arguments, starts two nodes: one that publishes and one that subscribes"
        found = find_pair(seen.trace.graph)
        nodes = seen.trace.graph.nodes
        observed = counted(len(nodes), "node") + (f": {', '.join(nodes)}" if nodes else "")
        if found is None:
            missing = seen_in_launch(Symptom.NOT_LAUNCHED, seen)
            return failed(expected, observed, missing, output_tail(seen.trace))
        return passed(expected, observed, describe_pair(found))
