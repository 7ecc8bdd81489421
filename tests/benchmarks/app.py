"""All figures of the app: first paint and rest, then the live page at 1 and 10 kHz.

uv run python -m tests.benchmarks.app
"""

from __future__ import annotations

import subprocess
import sys


def main() -> int:
    """Run one after the other, each in a process of its own. Exit code 1 where a figure was missed."""
    met = [subprocess.run([sys.executable, "-m", f"tests.benchmarks.{name}"]).returncode for name in ("paint", "live")]
    return 1 if any(met) else 0


if __name__ == "__main__":
    sys.exit(main())
