"""`python FLAGS .../tutor/run_module.py MODULE ARGUMENTS...` runs one of our modules, as `python -m MODULE` does.

First on its path is the folder that holds our packages: the clone, or in an installation `site-packages/ros_tutor`,
which is on nobody else's path. So a program of the learner's never imports our packages, nor we another's `tutor`.
FLAGS contain `-I` or `-P`, without which Python puts the folder of this file first.
"""

import os
import runpy
import sys

FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
"""The folder that holds our packages."""


def main() -> None:
    """Run the module that the first argument names, with the arguments after it."""
    if FOLDER in sys.path:  # in a clone
        sys.path.remove(FOLDER)
    sys.path.insert(0, FOLDER)
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
