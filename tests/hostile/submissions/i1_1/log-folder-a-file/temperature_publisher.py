"""The log folder becomes a file."""

import os

os.rename(os.environ["ROS_LOG_DIR"], f"moved-{os.getpid()}")
open(os.environ["ROS_LOG_DIR"], "w").close()
os._exit(1)
