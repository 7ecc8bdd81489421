"""Every cause that the contract lists is proven by a submission that must fail for it, and for nothing else."""

from __future__ import annotations

import pytest

from tests.judging import find_cases
from tutor.judge.causes.names import MEANINGS


def find_proofs() -> dict[str, list[str]]:
    """For each cause, the submissions and criteria that must fail for it, without an alternative."""
    found: dict[str, list[str]] = {name: [] for name in MEANINGS}
    for case in find_cases()[0]:
        for criterion, texts in case.expected.causes.items():
            if len(texts) == 1 and texts[0] in found:
                found[texts[0]].append(f"{case} {criterion}".strip())
    return found


PROOFS = find_proofs()


@pytest.mark.parametrize("name", MEANINGS)
def test_each_cause_is_proven_by_a_submission(name: str) -> None:
    assert PROOFS[name], f"no submission must fail with the cause {name!r}"


def test_each_cause_has_a_meaning() -> None:
    assert all(MEANINGS.values())


if __name__ == "__main__":
    for name, meaning in MEANINGS.items():
        print(f"{name}: {meaning}", *(PROOFS[name] or ["-"]), sep="\n    ")
