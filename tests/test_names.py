"""Names that would mislead a reader of the code."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MODULES = sorted([*ROOT.glob("tutor/**/*.py"), *ROOT.glob("checks/**/*.py")])


@pytest.mark.parametrize("package", ["tutor", "checks"])
def test_no_module_shares_its_name_with_a_function_or_class_in_it(package: str) -> None:
    """With `next_wake.next_wake`, importing one hides the other."""
    shared = []
    for module in MODULES:
        name = module.parent.name if module.stem == "__init__" else module.stem
        if module.is_relative_to(ROOT / package) and not module.is_relative_to(ROOT / "tutor/bundled_ros/prefix"):
            definitions = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
            body = ast.parse(module.read_bytes()).body
            shared += [str(module) for each in body if isinstance(each, definitions) and each.name == name]
    assert shared == []
