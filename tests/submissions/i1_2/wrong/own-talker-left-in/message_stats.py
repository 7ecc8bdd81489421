#!/usr/bin/env python3
"""
Heartbeat / chatter statistics node
Publishes a periodic heartbeat and keeps statistics of the heartbeats it hears.
"""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from rclpy.qos import QoSProfile, ReliabilityPolicy


class DroneHeartbeat(Node):
    """
    Publishes heartbeats at a regular interval and counts what comes in.
    """

    def __init__(self):
        super().__init__('drone_heartbeat')

        # Define a reliable QoS profile
        reliable_qos = QoSProfile(depth=10)
        reliable_qos.reliability = ReliabilityPolicy.RELIABLE

        # Declare parameters
        self.declare_parameter('heartbeat_rate', 1.0)  # Hz
        self.declare_parameter('timeout_threshold', 2.0)  # Seconds
        self.declare_parameter('topic_name', 'chatter')

        # Get parameters
        heartbeat_rate = self.get_parameter('heartbeat_rate').value
        self.timeout_threshold = self.get_parameter('timeout_threshold').value
        topic_name = self.get_parameter('topic_name').value

        # Create publisher
        self.hearthbeath_publisher_ = self.create_publisher(String, topic_name, reliable_qos)
        self.chatter_sub = self.create_subscription(String, topic_name, self.chatter_callback, reliable_qos)

        self.chatter_up = False
        self.first_chatter_time = None
        self.last_chatter_time = self.get_clock().now()

        self.chatter_count = 0
        self.first_chatter = None
        self.last_chatter = None
        self.last_seq = None

        # Create timer
        timer_period = 1.0 / heartbeat_rate
        self.timer = self.create_timer(timer_period, self.timer_callback)

        self.heartbeat_count = 0
        self.get_logger().info(f'Heartbeat node started - listening on {topic_name}')

    def chatter_callback(self, msg: String):
        """Count the message and look at its number."""
        self.last_chatter_time = self.get_clock().now()
        if self.first_chatter_time is None:
            self.first_chatter_time = self.last_chatter_time
            self.first_chatter = msg.data

        seq = int(msg.data.split(': ')[1])
        self.check_sequence(seq)
        self.last_seq = seq

        self.chatter_count += 1
        self.last_chatter = msg.data

        # Log every 10th message to avoid spam
        if self.chatter_count % 10 == 0:
            delta = (self.last_chatter_time - self.first_chatter_time).nanoseconds / 1e9
            rate = self.chatter_count / delta if delta > 0 else 0.0
            self.get_logger().info(f'[STATS] count: {self.chatter_count}, rate: {rate:.2f} msg/s, '
                                   f'first: "{self.first_chatter}", last: "{self.last_chatter}"')

    def check_sequence(self, seq):
        if self.last_seq is None:
            return
        if seq > self.last_seq + 1:
            self.get_logger().warn(f'Gap: {seq - self.last_seq - 1} message(s) lost before {seq}')
        elif seq <= self.last_seq:
            self.get_logger().warn(f'Publisher restarted at {seq}')

    def check_health(self):
        """Healthy as long as the last message is not too old."""
        now = self.get_clock().now()
        chatter_delta = (now - self.last_chatter_time).nanoseconds / 1e9
        self.chatter_up = chatter_delta < self.timeout_threshold

    def timer_callback(self):
        """Timer - publishes the heartbeat message."""
        self.check_health()

        msg = String()
        msg.data = f'Hello World: {self.heartbeat_count}'

        self.hearthbeath_publisher_.publish(msg)
        self.heartbeat_count += 1


def main(args=None):
    rclpy.init(args=args)

    heartbeat_node = DroneHeartbeat()

    try:
        rclpy.spin(heartbeat_node)
    except KeyboardInterrupt:
        pass
    finally:
        heartbeat_node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
