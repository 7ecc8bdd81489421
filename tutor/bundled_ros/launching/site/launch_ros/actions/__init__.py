"""ROS-specific actions."""

from ._composable import ComposableNodeContainer, LoadComposableNodes
from ._lifecycle import LifecycleNode, LifecycleTransition
from ._node import Node
from ._settings import (
    PushROSNamespace,
    ROSTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from ._settings import PushROSNamespace as PushRosNamespace
from ._settings import ROSTimer as RosTimer

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]
