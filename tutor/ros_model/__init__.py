"""ROS 2 as plain data: the graph, QoS, parameters and timing. Pure, so that any layer can import it."""

from tutor.ros_model.field import Field
from tutor.ros_model.graph import (
    Connection,
    Graph,
    NodeName,
    Service,
    ServiceEndpoint,
    Topic,
    TopicEndpoint,
    connections,
    is_hidden,
    is_standard_topic,
)
from tutor.ros_model.parameter import PARAMETER_TYPES, Parameter
from tutor.ros_model.qos import QoS, QoSMismatch, echo_qos, incompatible_policies
from tutor.ros_model.timing import Timing

__all__ = [
    "PARAMETER_TYPES",
    "Connection",
    "Field",
    "Graph",
    "NodeName",
    "Parameter",
    "QoS",
    "QoSMismatch",
    "Service",
    "ServiceEndpoint",
    "Timing",
    "Topic",
    "TopicEndpoint",
    "connections",
    "echo_qos",
    "incompatible_policies",
    "is_hidden",
    "is_standard_topic",
]
