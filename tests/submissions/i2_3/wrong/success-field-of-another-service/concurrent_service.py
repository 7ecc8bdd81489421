import time

import rclpy
from rclpy.node import Node
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from example_interfaces.srv import AddTwoInts


class DobotClient:
    """no robot on my desk at home, so only the waiting"""

    def start_homing(self):
        time.sleep(3)


class Homingnode(Node):

    def __init__ (self):
        super().__init__("homing_node")
        self.dobot = DobotClient()
        self.ticks = 0
        self.service = self.create_service(AddTwoInts, "slow_add", self.service_callback,
                                           callback_group=MutuallyExclusiveCallbackGroup())
        self.timer = self.create_timer(0.1, self.timer_callback,
                                       callback_group=ReentrantCallbackGroup())
        self.get_logger().info("Homing service ready")

    def timer_callback(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f"Tick {self.ticks}")

    def service_callback(self, request, response):
        try:
            self.get_logger().info("Starting slow addition")
            self.dobot.start_homing()
            response.sum = request.a + request.b
            response.success = True
            self.get_logger().info("Slow addition finished")
        except Exception as e:
            self.get_logger().error(f"Error occurred during the slow addition: {e}")
            response.success = False

        return response

def main(args=None):
    rclpy.init(args=args)
    node = Homingnode()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()

    except (KeyboardInterrupt):
        pass
    finally:
        rclpy.try_shutdown()

if __name__ == '__main__':
    main()
