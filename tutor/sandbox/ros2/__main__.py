"""`python -m tutor.sandbox.ros2`."""

import sys

from tutor.sandbox.ros2.command import main

sys.exit(main(sys.argv[1:]))
