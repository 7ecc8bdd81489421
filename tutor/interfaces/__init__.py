"""Builds the message, service and action types that a learner defines, without colcon, CMake or an installed ROS."""

from tutor.interfaces.building import Build, build_workspace
from tutor.interfaces.package import InterfacePackage, find_packages
from tutor.interfaces.problem import Problem

__all__ = ["Build", "InterfacePackage", "Problem", "build_workspace", "find_packages"]
