"""Three thousand folders within one another in the log folder, that nobody may read."""

import os

os.chdir(os.environ["ROS_LOG_DIR"])
for _ in range(3000):
    os.mkdir("d")
    os.chdir("d")
os.chmod(os.environ["ROS_LOG_DIR"], 0)
os._exit(1)
