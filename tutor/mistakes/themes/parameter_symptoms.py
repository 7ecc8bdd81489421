"""What the symptoms of parameters say where no mistake of the catalogue explains them.

The criterion's own words come first (`Observation.says` and `.do`); these are for criteria that have none.
"""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found
from tutor.mistakes.symptom_entries import in_words, symptom
from tutor.source.parameters import ON_SET, copied_once, registered_callback


@symptom("parameter-ignored", explains=[Symptom.CHANGE_IGNORED])
def parameter_ignored(case: Case) -> Iterator[Found]:
    """A parameter is set, but nothing changes.

    Setting a parameter changes the value that get_parameter() returns from then on. A copy made earlier, or a timer
    made from it, keeps the old one unless a callback brings it up to date.

    Bad:

        def __init__(self):
            self.greeting = self.get_parameter('greeting').value

        def greet(self):
            self.get_logger().info(self.greeting)

    Good:

        def greet(self):
            self.get_logger().info(self.get_parameter('greeting').value)

    See it: `ros2 param set NODE NAME VALUE`, then `ros2 param get NODE NAME`, and what the node does.
    """
    name = case.about("parameter", "the parameter")
    if case.about("at_start"):
        yield from in_words(
            case,
            f"{name} is given at start-up, but has no effect",
            "See what the node uses in its place: a value from the code, or one that was read before.",
        )
    for file in case.files:
        if not case.seen.says and (kept := copied_once(file, name)) is not None:
            code = file.line(kept.lineno)
            says = f"line {kept.lineno} copies {name} once, and nothing brings the copy up to date: {code}"
            do = "Read the parameter again where it is used, or update the copy in a parameter callback."
            yield found(file, kept, says=says, do=do)
    yield from in_words(
        case,
        f"{name} is set, but has no effect",
        "Find the line that uses its value, and see when that value is read.",
    )


@symptom("parameter-not-declared", explains=[Symptom.NOT_DECLARED])
def parameter_not_declared(case: Case) -> Iterator[Found]:
    """A node has no such parameter.

    A node has the parameters that it declares, with the types of their defaults. What is not declared cannot be set,
    neither at start-up nor later.

    Bad:

        self.volume = 7

    Good:

        self.declare_parameter('volume', 7)

    See it: `ros2 param list NODE`, and `ros2 param describe NODE NAME` for its type.
    """
    return in_words(
        case,
        f"the node has no parameter {case.about('parameter', 'of that name')}",
        "Declare it where the node is set up, with a default of the right type.",
    )


@symptom("good-value-refused", explains=[Symptom.REFUSED])
def good_value_refused(case: Case) -> Iterator[Found]:
    """A node refuses a good value.

    A value is refused by a callback that returns successful=False, by a range in the descriptor, by read_only, or
    because its type is not that of the parameter.

    Bad:

        def check(self, parameters):
            return SetParametersResult(successful=False)

    Good:

        def check(self, parameters):
            return SetParametersResult(successful=all(p.value != '' for p in parameters))

    See it: `ros2 param set NODE NAME VALUE` prints the reason.
    """
    name, value = case.about("parameter", "the parameter"), case.about("value", "a good value")
    shown = str(value).lower() if isinstance(value, bool) else str(value)
    for file in case.files:
        if (callback := registered_callback(file, ON_SET)) is not None and not case.seen.says:
            says = f"{callback.name} (line {callback.lineno}) does not let {name} be set to {shown}"
            yield found(file, callback, says=says, do="Find the condition there that does not hold for this value.")
    yield from in_words(
        case,
        f"{name} cannot be set to {shown}: the node refuses it",
        "Find where that reason comes from, and let good values through there.",
    )
