"""How strong the tests of judges, forms, checks and mistakes are: change one operator at a time, and see who notices.

    uv run python -m tests.mutations [--mutants 100] [--seed 1] [--jobs 2]

Each mutant is a copy of the code in which one comparison, `and`, `not`, sum or number is another. It is killed if the
replay of the recordings (see `tests.recordings.replay`) prints something else, if one of the tests that start no
process fails, or, as scenarios run only then, if real runs of up to three exercises that use it do: of their part of
the sample in tests/test_soundness.py, and of their skeletons and solutions. Prints each survivor with its line, to be
looked at: it is equivalent, or a test is missing. Not for CI.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import os
import pkgutil
import random
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import checks

ROOT = Path(__file__).parents[1]
COPIED = ("tutor", "checks", "lessons", "tests", "docs", "pyproject.toml", "README.md", "CONTRIBUTING.md")
TESTS_OF = {
    "tutor/judge": ("tests/judge", "tests/checks", "tests/exercise"),
    "tutor/exercise": ("tests/exercise", "tests/checks"),
    "tutor/mistakes": ("tests/mistakes", "tests/checks"),
    "checks": ("tests/checks", "tests/exercise"),
}
SWAPPED: dict[type[ast.AST], tuple[str, str]] = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
}
LIMIT_S = 300.0
EXERCISES = 3
"""How many exercises are run for a mutant."""


@dataclass(frozen=True)
class Mutant:
    """A change of a file: the characters from `start` to `end` become `new`."""

    file: str
    line: int
    start: int
    end: int
    new: str

    def applied(self, text: str) -> str:
        """The file's text with the change."""
        return text[: self.start] + self.new + text[self.end :]

    def shown(self) -> str:
        """The place, and the line before and after."""
        text = (ROOT / self.file).read_text()
        before, after = (each.splitlines()[self.line - 1].strip() for each in (text, self.applied(text)))
        return f"{self.file}:{self.line}\n    - {before}\n    + {after}"


def mutants_of(file: Path) -> Iterator[Mutant]:
    """Yield every mutant of a file."""
    text = file.read_text()
    lines = [0]
    for line in text.splitlines(keepends=True):
        lines.append(lines[-1] + len(line))

    def place(line: int, column: int) -> int:
        return lines[line - 1] + len(text[lines[line - 1] :].encode()[:column].decode())

    def between(left: ast.expr, operator: ast.AST, right: ast.expr) -> Iterator[Mutant]:
        old, new = SWAPPED.get(type(operator), ("", ""))
        assert left.end_lineno is not None
        assert left.end_col_offset is not None
        start, end = place(left.end_lineno, left.end_col_offset), place(right.lineno, right.col_offset)
        at = text[start:end].find(old)
        if old and at >= 0:
            yield Mutant(str(file.relative_to(ROOT)), left.end_lineno, start + at, start + at + len(old), new)

    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Compare):
            yield from between(node.left, node.ops[0], node.comparators[0])
        elif isinstance(node, ast.BoolOp):
            yield from between(node.values[0], node.op, node.values[1])
        elif isinstance(node, ast.BinOp):
            yield from between(node.left, node.op, node.right)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            start, end = place(node.lineno, node.col_offset), place(node.operand.lineno, node.operand.col_offset)
            yield Mutant(str(file.relative_to(ROOT)), node.lineno, start, end, "")
        elif (
            isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool)
        ):
            assert node.end_lineno is not None
            assert node.end_col_offset is not None
            start, end = place(node.lineno, node.col_offset), place(node.end_lineno, node.end_col_offset)
            yield Mutant(str(file.relative_to(ROOT)), node.lineno, start, end, repr(node.value + 1))


def copy_of_the_tree(folder: Path) -> Path:
    """A copy of what the tests need, by hard links: a mutated file is written anew."""
    for name in COPIED:
        subprocess.run(["cp", "-al", ROOT / name, folder / name], check=True)
    return folder


def run(tree: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", *words]
    try:
        return subprocess.run(
            command, cwd=tree, env=environment, capture_output=True, text=True, timeout=LIMIT_S, check=False
        )
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 1, "too slow", "")


@cache
def imported_by(module: str) -> frozenset[str]:
    """The modules of judges, forms and checks that a module imports, directly or indirectly, and itself."""
    found, left = set[str](), [module]
    while left:
        name = left.pop()
        path = ROOT / name.replace(".", "/")
        file = path.with_suffix(".py") if path.with_suffix(".py").is_file() else path / "__init__.py"
        if name in found or not name.startswith(("tutor.exercise", "tutor.judge", "checks.")) or not file.is_file():
            continue
        found.add(name)
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module and node.module != "tutor.exercise":
                left += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return frozenset(found)


def exercises_that_use(file: str) -> list[str]:
    """The ids of the exercises whose judges and scenarios use a module, itself given as a path."""
    module = file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    found = []
    for info in pkgutil.iter_modules(checks.__path__, "checks."):
        check = importlib.import_module(info.name).CHECK
        parts = [part for criterion in check.criteria for part in (criterion.judge, *criterion.facts)]
        own = {getattr(part, "__module__", "") for part in parts} | {info.name}
        if any(module in imported_by(name) for name in own):
            found.append(check.exercise)
    return found


def fails_in_real_runs(mutant: Mutant, tree: Path) -> bool:
    """Whether real runs notice the mutant."""
    used = [] if mutant.file.startswith("tutor/mistakes") else exercises_that_use(mutant.file)[:EXERCISES]
    if not used:
        return False
    named = " or ".join(f"[{exercise}/" for exercise in used)
    sampled = run(tree, "pytest", "-x", "-q", "-p", "no:cacheprovider", "tests/test_soundness.py", "-k", named)
    return sampled.returncode not in (0, 5) or bool(run(tree, "tutor", "author", "check", *used).returncode)


def killed_by(mutant: Mutant, tree: Path, replayed: str) -> str:
    """What notices the mutant: "replay", "tests", "runs", or "" if nothing does."""
    file = tree / mutant.file
    text = file.read_text()
    file.unlink()  # a hard link to ours
    file.write_text(mutant.applied(text))
    try:
        replay = run(tree, "tests.recordings.replay")
        if (replay.stdout, replay.stderr) != (replayed, ""):
            return "replay"
        chosen = next(tests for folder, tests in TESTS_OF.items() if mutant.file.startswith(folder))
        if run(tree, "pytest", "-x", "-q", "-p", "no:cacheprovider", "--quick", *chosen).returncode:
            return "tests"
        return "runs" if fails_in_real_runs(mutant, tree) else ""
    finally:
        file.write_text(text)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutants", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    files = [file for folder in TESTS_OF for file in sorted((ROOT / folder).rglob("*.py"))]
    every = [mutant for file in files for mutant in mutants_of(file)]
    chosen = random.Random(arguments.seed).sample(every, min(arguments.mutants, len(every)))
    with tempfile.TemporaryDirectory() as scratch:
        trees = [copy_of_the_tree(Path(tempfile.mkdtemp(dir=scratch))) for _ in range(arguments.jobs)]
        replayed = run(trees[0], "tests.recordings.replay").stdout

        def judge(mutant: Mutant) -> str:
            tree = trees.pop()
            try:
                killer = killed_by(mutant, tree, replayed)
                print(f"{killer or 'survived':9} {mutant.file}:{mutant.line}", file=sys.stderr)
                return killer
            finally:
                trees.append(tree)

        with ThreadPoolExecutor(arguments.jobs) as pool:
            kills = dict(zip(chosen, pool.map(judge, chosen), strict=True))
    for mutant in chosen:
        if not kills[mutant]:
            print(mutant.shown())
    by = [kill for kill in kills.values() if kill]
    print(
        f"{len(by)} of {len(chosen)} mutants killed: {by.count('replay')} by the replay, {by.count('tests')} by tests, "
        f"{by.count('runs')} by real runs"
    )


if __name__ == "__main__":
    main()
