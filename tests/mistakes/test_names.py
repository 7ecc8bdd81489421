"""Every mistake that the contract lists is proven by a submission that must fail for it, and for nothing else."""

from __future__ import annotations

import pytest

from tests.judging import find_cases
from tests.sampling import MISTAKES


def find_proofs() -> dict[str, list[str]]:
    """For each mistake, the submissions and criteria that must fail for it, without an alternative."""
    found: dict[str, list[str]] = {name: [] for name in MISTAKES}
    for case in find_cases()[0]:
        for criterion, texts in case.expected.causes.items():
            if len(texts) == 1 and texts[0] in found:
                found[texts[0]].append(f"{case} {criterion}".strip())
    return found


PROOFS = find_proofs()


@pytest.mark.parametrize("name", MISTAKES)
def test_each_mistake_is_proven_by_a_submission(name: str) -> None:
    assert PROOFS[name], f"no submission must fail with {name!r}"
