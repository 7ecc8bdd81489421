"""A bench for each test, as for those of the `ros2` commands."""

from tests.ros2cli.conftest import bench as bench
from tests.ros2cli.conftest import ros2_server as ros2_server
