"""Descriptions of nodes' parameters."""

from launch._unsupported import lazily_refusing

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]

__getattr__ = lazily_refusing(__name__, frozenset({"ComposableLifecycleNode", "ComposableNode"}))
