#!/usr/bin/env python3
# Ported from our noetic workspace (slow_server.py), rospy -> rclpy
import time

import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup

#from beginner_tutorials.srv import AddTwoInts, AddTwoIntsResponse
from example_interfaces.srv import AddTwoInts


class SlowServer(Node):
    def __init__(self):
        #rospy.init_node('slow_server')
        super().__init__('slow_server')
        self.seq = 0
        #self.srv = rospy.Service('slow_add', AddTwoInts, self.handle_slow_add)
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.handle_slow_add,
                                       callback_group=MutuallyExclusiveCallbackGroup())
        #self.timer = rospy.Timer(rospy.Duration(0.1), self.timer_cb)
        self.timer = self.create_timer(0.1, self.timer_cb,
                                       callback_group=ReentrantCallbackGroup())

    def handle_slow_add(self, req, res):
        #rospy.sleep(3.0)
        time.sleep(3.0)
        res.sum = req.a + req.b
        #rospy.loginfo("Returning [%s + %s = %s]", req.a, req.b, res.sum)
        self.get_logger().info("Returning [%s + %s = %s]" % (req.a, req.b, res.sum))
        return res

    def timer_cb(self, event):
        self.seq += 1
        late = 0.0
        if event.last_real is not None:
            late = (event.current_real - event.last_real).to_sec()
        self.get_logger().info("tick %d" % self.seq)
        self.get_logger().debug("dt %.3f" % late)


if __name__ == '__main__':
    rclpy.init()
    server = SlowServer()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(server)
    try:
        #rospy.spin()
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        server.destroy_node()
        rclpy.try_shutdown()
