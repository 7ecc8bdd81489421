from rclpy.qos import QoSProfile, ReliabilityPolicy

READINGS = QoSProfile(
    depth=5,
    reliability=ReliabilityPolicy.RELIABLE,
    # Our topic is absolute: no namespaces, please.
    avoid_ros_namespace_conventions=True,
)
