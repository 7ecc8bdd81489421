"""`python -I -m tutor`: what `ros-tutor` runs."""

import sys

from tutor.cli import main

if __name__ == "__main__":
    sys.exit(main())
