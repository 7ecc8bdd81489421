#!/usr/bin/env python3


from threading import Thread
import time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts
from example_interfaces.srv import AddTwoInts


class MoveIt2:
    # only what is used below
    def __init__(self, node, group_name, callback_group):
        self.node = node
        self.meshes = {}

    def add_collision_mesh(self, id, position):
        self.meshes[id] = position
        time.sleep(1.0)



def main():
    rclpy.init()
    node = Node("add_meshobj")
    callback_group = ReentrantCallbackGroup()

    moveit2 = MoveIt2(
        node=node,
        group_name="arm",
        callback_group=callback_group,
    )

    count = [0]
    def tick():
        count[0] += 1
        if count[0] % 10 == 0:
            node.get_logger().info("tick " + str(count[0]))

    def addmesh(req, res):
        print("Adding mesh...")
        for i in range(1, 4):
            moveit2.add_collision_mesh(
            id="Floor",
            position=[2.1, 0.00, 0.1],
            )
        res.sum = req.a + req.b
        return res

    executor = MultiThreadedExecutor(1)
    executor.add_node(node)
    executor_thread = Thread(target=executor.spin, daemon=True, args=())
    executor_thread.start()

    node.create_timer(0.1, tick, callback_group=callback_group)
    node.create_service(AddTwoInts, '/slow_add', addmesh, callback_group=callback_group)
    rclpy.spin(node)
    rclpy.shutdown()
    exit(0)


if __name__ == "__main__":
    main()
