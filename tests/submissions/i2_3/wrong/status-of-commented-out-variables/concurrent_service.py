import rclpy
from rclpy.node import Node
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import String
from example_interfaces.srv import AddTwoInts
import threading
import time


class ArduPilotNode(Node):
    def __init__(self):
        super().__init__('ardupilot_node')

        # --- current target ---
        self.target_pose = PoseStamped()
        self.target_pose.pose.position.x = 0.0
        self.target_pose.pose.position.y = 0.0
        self.target_pose.pose.position.z = 2.0

        self.service_group = MutuallyExclusiveCallbackGroup()
        self.timer_group = ReentrantCallbackGroup()

        # 1. setpoints
        self.local_pos_pub = self.create_publisher(PoseStamped, '/drone/setpoint', 10)

        # 2. state
        self.state_sub = self.create_subscription(String, '/drone/state', self.state_cb, 10)

        # 3. commands
        self.cmd_sub = self.create_subscription(
            PoseStamped,
            '/drone/cmd_pose',
            self.command_cb,
            10
        )

        # 4. slow service
        self.slow_srv = self.create_service(
            AddTwoInts, 'slow_add', self.slow_add_cb, callback_group=self.service_group)

        # 5. heartbeat, 10Hz
        self.timer = self.create_timer(0.1, self.timer_cb, callback_group=self.timer_group)
        self.beats = 0

        self.current_state = 'STANDBY'
        self.get_logger().info("Node initialized. Serving /slow_add")

    def state_cb(self, msg):
        self.current_state = msg.data

    def command_cb(self, msg):
        """New target came in"""
        self.target_pose = msg

    def slow_add_cb(self, request, response):
        self.get_logger().info(f"Adding {request.a} and {request.b}, this takes 3 s")
        time.sleep(3)
        response.sum = request.a + request.b
        return response

    def timer_cb(self):
        """Heartbeat"""
        self.beats += 1
        self.target_pose.header.stamp = self.get_clock().now().to_msg()
        self.target_pose.header.frame_id = "map"  # or "odom"
        self.local_pos_pub.publish(self.target_pose)
        self.get_logger().info(f"Heartbeat {self.beats}")


def main():
    rclpy.init()
    node = ArduPilotNode()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)

    # callbacks run in the background
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()

    try:
        node.get_logger().info("Ready.")

        # --- keep the main thread alive ---
        while rclpy.ok():
            mode = node.current_state
            # alt = node.target_pose.pose.position.z
            # x = node.target_pose.pose.position.x
            # y = node.target_pose.pose.position.y

            node.get_logger().info(
                f"STATUS: {mode} | ALT: {alt:.2f}m | POS: ({x:.1f}, {y:.1f})"
            )
            time.sleep(1)

    except KeyboardInterrupt:
        node.get_logger().info("Shutting down node...")
    finally:
        executor.shutdown(timeout_sec=1.0)
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
