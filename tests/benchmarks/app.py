"""All figures of the app: first paint and idle use, the live page at 1 and 10 kHz, an echo at 1 kHz in a terminal.

uv run python -m tests.benchmarks.app
"""

from __future__ import annotations

import subprocess
import sys


def main() -> int:
    """Run all of them, each in its own process. Return exit code 1 if a target was missed."""
    codes = [
        subprocess.run([sys.executable, "-m", f"tests.benchmarks.{name}"]).returncode
        for name in ("paint", "live", "shell")
    ]
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main())
