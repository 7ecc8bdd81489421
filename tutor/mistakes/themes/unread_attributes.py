"""Attributes that are set where nobody reads them."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake

DECISIONS = (
    Symptom.CHANGE_IGNORED,
    Symptom.WRONG_RATE,
    Symptom.BAD_VALUE_ACCEPTED,
    Symptom.REFUSED,
    Symptom.NOT_LOGGED,
    Symptom.WRONG_VALUES,
    Symptom.WRONG_LOG,
    Symptom.WRONG_ANSWER,
)
"""What is seen when a value goes astray that decides what a node does."""


@mistake(
    "wrong-attribute-set",
    explains=DECISIONS,
    says="{line}: setattr does not follow dots, so {attribute} stays as it is: {code}",
    do="Give setattr the object that has the attribute, and the attribute's own name.",
)
def dotted_attribute(case: Case) -> Iterator[Found]:
    """A name with a dot is given to setattr().

    setattr(node, 'config.volume', 7) makes an attribute whose name contains a dot; it does not go into node.config.

    Bad:

        setattr(self, 'config.' + name, value)

    Good:

        setattr(self.config, name, value)

    See it: log self.config afterwards.
    """
    for file in case.files:
        for call in file.calls("setattr"):
            match call.args:
                case [_, ast.BinOp(left=ast.Constant(value=str() as path), op=ast.Add()), _] if path.endswith("."):
                    pass
                case [_, ast.Constant(value=str() as path), _]:
                    pass
                case [_, ast.JoinedStr(values=[ast.Constant(value=str() as path), ast.FormattedValue()]), _] if (
                    path.endswith(".")
                ):
                    pass
                case _:
                    continue
            if "." in path:
                yield found(file, call, attribute=path.rpartition(".")[0])


@mistake(
    "class-attribute-set",
    explains=DECISIONS,
    says="{line} sets an attribute of the class, but the node's own attribute of that name hides it: {code}",
    do="Set the attribute of the node itself, self.",
)
def class_attribute(case: Case) -> Iterator[Found]:
    """The class gets the new value, but the node keeps the old one.

    An object's attribute hides that of its class. Once __init__ has set self.volume, a later Bell.volume = 7 changes
    nothing that the object reads.

    Bad:

        class Bell(Node):
            def __init__(self):
                self.volume = 5

            def follow(self, parameters):
                Bell.volume = parameters[0].value

    Good:

        class Bell(Node):
            def __init__(self):
                self.volume = 5

            def follow(self, parameters):
                self.volume = parameters[0].value

    See it: log self.volume afterwards.
    """
    for file in case.files:
        stored = [node for node in file.nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)]
        own = {ast.unparse(node) for node in stored}
        for node in stored:
            of_class = ast.unparse(node.value) in file.node_classes and file.node_method(node) is not None
            if of_class and f"{file.node}.{node.attr}" in own:
                yield found(file, node)
