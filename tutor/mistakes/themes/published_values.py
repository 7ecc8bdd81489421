"""Values on a topic that are wrong: out of range, or not random."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.randomness import Pattern
from tutor.judge.series import is_int_in_float
from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.message_fields import field_values, is_int, narrow_float, unknown_field
from tutor.source import NodeFile

_DRAWING = ("uniform", "random", "randint", "randrange", "gauss", "normalvariate", "normal", "triangular", "choice")


@mistake(
    "int-in-a-float-field",
    name="an int in a float field",
    explains=[Symptom.WRONG_VALUES],
    evidence=Evidence.RUN,
    says="{what}, whose field is a float: rclpy reads its bits as those of a float, which gives numbers near 0",
    do="Make it a float before it goes into the message.",
    example=in_run(Symptom.WRONG_VALUES, wrong=(4e-323,)),
)
def int_in_float(case: Case) -> Iterator[Found]:
    """A float field gets an int.

    Without assertions, as in the wheels that ros-tutor brings, rclpy reads an int as if it were the bits of a float,
    and sends a number close to 0. A ROS with assertions stops with "must be of type 'float'".

    Bad:

        message.data = 25

    Good:

        message.data = 25.0

    See it: `ros2 topic echo TOPIC` shows something like 1.2e-322.
    """
    wrong = case.about("wrong") or case.about("drawn", ())
    if not wrong or not all(map(is_int_in_float, wrong)) or any(narrow_float(case)):  # the last says what else it is
        return
    for file in case.files:
        for value, given in field_values(file):
            if is_int(given):
                yield found(
                    file, value, what=f"line {value.lineno} puts an int ({ast.unparse(given)}) into the message"
                )
    yield Found({"what": "something that is no Python float, such as an int, is put into the message"})


@mistake(
    "initial-value-out-of-range",
    explains=[Symptom.WRONG_VALUES],
    says="{line}: the node starts with {value:g}, and publishes it before it draws a value: {code}",
    do="Draw a value before the first message, or start with one from the range.",
    example=in_run(Symptom.WRONG_VALUES, wrong=(0.0, 0.0)),
)
def initial_value(case: Case) -> Iterator[Found]:
    """A node publishes the value that it started with.

    An attribute keeps its first value until something sets another. A message that goes out before that carries the
    first value.

    Bad:

        self.volume = 0.0
        self.next_volume = lambda: random.uniform(3.0, 5.0)

    Good:

        self.volume = random.uniform(3.0, 5.0)

    See it: the first message in `ros2 topic echo`.
    """
    wrong = set(case.about("wrong", ()))
    for file in case.files:
        if len(wrong) == 1 and file.calls(*_DRAWING):
            value = next(iter(wrong))
            kept = [node for node in file.nodes if isinstance(node, ast.Assign) and _is_set_to(node, value)]
            if len(kept) == 1:
                yield found(file, kept[0], value=value)


def _is_set_to(node: ast.Assign, value: float) -> bool:
    """Whether an attribute is set to this constant, or to a message made of it, as in Float64(data=0.0)."""
    given: ast.expr = node.value
    if isinstance(given, ast.Call):
        inner = [*given.args, *(keyword.value for keyword in given.keywords)]
        given = inner[0] if len(inner) == 1 else given
    constant = given.value if isinstance(given, ast.Constant) else None
    return isinstance(node.targets[0], ast.Attribute) and isinstance(constant, int | float) and constant == value


@mistake(
    "out-of-range",
    explains=[Symptom.WRONG_VALUES],
    evidence=Evidence.SYMPTOM,
    says="{what}",
    do="Look at how a value is drawn, and at which numbers that can give.",
    example=in_run(Symptom.WRONG_VALUES, wrong=(75.0,), lowest=3.0, highest=5.0, other_unit="degrees Fahrenheit"),
)
def out_of_range(case: Case) -> Iterator[Found]:
    """Values leave the range.

    random.random() gives 0 to 1, random.gauss() any number; random.uniform(a, b) stays between a and b. An offset, or
    another unit (Fahrenheit for Celsius), moves all of them.

    Bad:

        message.data = random.random() * 5.0

    Good:

        message.data = random.uniform(3.0, 5.0)

    See it: the plot in Live, which shows the range.
    """
    if case.about("wrong"):
        lowest, highest, unit = case.about("lowest"), case.about("highest"), case.about("other_unit")
        what = f"some values are not in {lowest} to {highest}"
        yield Found({"what": f"these look like {unit}" if unit else what})


def _pattern(case: Case, *names: str) -> Iterator[Found]:
    pattern = case.about("pattern")
    elsewhere = (*unknown_field(case), *narrow_float(case))  # the value that was drawn is not the one that is sent
    if pattern is not None and pattern.name in names and not elsewhere:
        yield from _places(case, pattern)
        yield Found({"text": pattern.text})


def _places(case: Case, pattern: Pattern) -> Iterator[Found]:
    for file in case.files:
        tick = file.timer_callback
        reached = file.reachable_from(tick) if tick is not None else []
        for call in file.calls("seed", *_DRAWING):
            seeded = getattr(call.func, "attr", "") == "seed" and file.function_around(call) in reached
            if seeded or (file.function_around(call) is file.setup and not _draws_in(file, reached)):
                yield found(file, call, text=pattern.text)


def _draws_in(file: NodeFile, functions: list[ast.FunctionDef | ast.AsyncFunctionDef]) -> bool:
    return any(file.function_around(call) in functions for call in file.calls(*_DRAWING))


@mistake(
    "constant-value",
    explains=[Symptom.WRONG_VALUES],
    evidence=Evidence.RUN,
    says="{text}: a value that is drawn once, or drawn with the same seed each time, is the same in every message",
    do="Draw a new value for every message, where the message is made.",
    example=in_run(Symptom.WRONG_VALUES, pattern=Pattern("constant value", "all 8 values are 23.4")),
)
def constant(case: Case) -> Iterator[Found]:
    """Every message has the same value.

    What __init__ computes is computed once. random.seed() with a fixed number makes the next random number the same
    each time.

    Bad:

        def __init__(self):
            self.volume = random.uniform(3.0, 5.0)

    Good:

        def ring(self):
            volume = random.uniform(3.0, 5.0)

    See it: `ros2 topic echo TOPIC`.
    """
    return _pattern(case, "constant value")


@mistake(
    "ramp",
    explains=[Symptom.WRONG_VALUES],
    evidence=Evidence.RUN,
    says="{text}: that is a ramp, not a random value",
    do="Draw each value afresh, instead of computing it from the one before.",
    example=in_run(Symptom.WRONG_VALUES, pattern=Pattern("ramp", "each value is the one before it +0.5")),
)
def ramp(case: Case) -> Iterator[Found]:
    """Values go up or down in steps.

    A value that is computed from the one before, from a counter or from the clock is predictable. Random values jump.

    Bad:

        self.volume += 0.5

    Good:

        self.volume = random.uniform(3.0, 5.0)

    See it: the plot in Live.
    """
    return _pattern(case, "ramp")


@mistake(
    "short-cycle",
    name="pattern in the values",
    explains=[Symptom.WRONG_VALUES],
    evidence=Evidence.RUN,
    says="{text}: values that come from a short list, or from a curve, are not random",
    do="Draw each value from the whole range, for every message.",
    example=in_run(Symptom.WRONG_VALUES, pattern=Pattern("short cycle", "the same 3 values come again and again")),
)
def cycle(case: Case) -> Iterator[Found]:
    """The same values come again and again.

    A list that the node goes through, a sine, or a few numbers that were drawn at the start repeat themselves.

    Bad:

        self.volume = self.volumes[self.rings % 3]

    Good:

        self.volume = random.uniform(3.0, 5.0)

    See it: the plot in Live.
    """
    if case.about("pattern") is not None:
        yield from _pattern(case, case.about("pattern").name)
