"""The doctor: which ROS is used, what is wrong with the machine, and how to fix it. Does not import rclpy."""

from tutor.doctor.examination import examine
from tutor.doctor.finding import Finding

__all__ = ["Finding", "examine"]
