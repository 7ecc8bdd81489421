"""The form about a package of message types: it is built, and its types have the fields that were agreed on."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tutor.exercise.form import Exercise, Form
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.interface_build import Definition, InterfaceBuild
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed

_NO_RUN = Trace("")
"""Nothing runs: types are built before a node starts."""


@dataclass(frozen=True)
class BuiltPackages:
    """The interface packages beside the submission, as they were built before its start."""

    async def __call__(self, bench: Bench) -> Sequence[InterfaceBuild]:
        return tuple(bench.interface_builds())


@dataclass(frozen=True)
class BuildsInterfaces(Form):
    """An interface package of the learner's is built, and its types have these fields, in this order.

    `types`: from a name such as "msg/Reading" to the fields, each as in "float64 value", with "---" between the parts
    of a service or an action. Defaults, constants and comments are up to the learner, and so are other types.

        BuildsInterfaces("types", "my_interfaces", {"srv/Half": ("int64 number", "---", "float64 half")})
    """

    package: str
    types: Mapping[str, Definition] = field(hash=False)

    @property
    def starts_a_program(self) -> bool:
        return False

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, BuiltPackages())

    def judge(self, builds: Sequence[InterfaceBuild]) -> Verdict:
        """Judge what became of the packages."""
        expected = f"{self.package} is built, with {' and '.join(self.types)}"
        build = next((build for build in builds if build.package == self.package), None)
        if build is None:
            others = ", ".join(other.package for other in builds)
            observed = f"there is no such package, only {others}" if others else "there is no interface package"
            return failed(expected, observed, self._not_built(observed, "", others))
        if build.problems:
            return failed(expected, build.problems[0], self._not_built(build.problems[0]), build.problems[1:4])
        for name, wanted in self.types.items():
            if name not in build.types:
                return failed(expected, f"{name} is not in it", self._missing(build, name))
            if (found := build.types[name]) != wanted:
                says = _difference(name, found, wanted)
                other = Symptom.OTHER_TYPES.seen(_NO_RUN, package=self.package, type=name, says=says)
                return failed(expected, says, other, [f"{name}: {'; '.join(found) or 'no fields'}"])
        return passed(expected, f"built: {', '.join(build.types)}")

    def _not_built(self, reason: str, do: str = "", others: str = "") -> Observation:
        return Symptom.NOT_BUILT.seen(_NO_RUN, package=self.package, reason=reason, others=others, do=do)

    def _missing(self, build: InterfaceBuild, name: str) -> Observation:
        unlisted = [file for file in build.unlisted if file.startswith(f"{name}.")]
        return Symptom.NOT_BUILT.seen(
            _NO_RUN,
            package=self.package,
            type=name,
            unlisted=unlisted[0] if unlisted else "",
            has=", ".join(build.types),
            reason=f"{name} is not in {self.package}",
            others="",
        )


def _difference(name: str, found: Definition, wanted: Definition) -> str:
    """Return the first difference between the fields of a type and those agreed on, in words."""
    names = {line.partition(" ")[2]: line.partition(" ")[0] for line in found if line != "---"}
    for line in wanted:
        kind, _, field_name = line.partition(" ")
        if line == "---" or names.get(field_name) == kind:
            continue
        if field_name in names:
            return f"{name}: {field_name} is {names[field_name]}, and was agreed to be {kind}"
        near = difflib.get_close_matches(field_name, names, n=1)
        return f"{name} has no field {field_name}" + (f", only {near[0]}" if near else "")
    agreed = {line.partition(" ")[2] for line in wanted}
    extra = [field_name for field_name in names if field_name not in agreed]
    if extra:
        return f"{name} has a field more than was agreed on: {extra[0]}"
    return f"the fields of {name} are in another order than agreed on, and so are their bytes in a message"
