"""The log folder becomes a link."""

import os

os.rename(os.environ["ROS_LOG_DIR"], f"moved-{os.getpid()}")
os.symlink("/tmp", os.environ["ROS_LOG_DIR"])
os._exit(1)
