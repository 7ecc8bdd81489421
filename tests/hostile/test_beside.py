"""A submission that joins every domain beside the checks of others: `python -m tests.hostile.beside` in small."""

from __future__ import annotations

from tests.hostile.beside import BUSY, check_solutions, joined


def test_anyone_who_joins_every_domain_fails_nobody_else() -> None:
    with joined() as codes:
        ended = check_solutions(["i1.1", "i1.3", "i2.1"], 3)
    assert not [one for one in ended if one.exit and BUSY not in one.why]
    assert set(codes) <= {1, 130}
