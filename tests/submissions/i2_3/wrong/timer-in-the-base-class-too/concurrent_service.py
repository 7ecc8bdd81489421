#!/usr/bin/env python3
from abc import abstractmethod
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class ConfiguredNode(Node):
  """Base class for all our nodes: reads its configuration before anything else."""

  def __init__(self, node_name: str):
    super().__init__(node_name)
    for key, value in self.default_config().items():
      self.declare_parameter(key, value)

  def config(self, key: str):
    return self.get_parameter(key).value

  def default_config(self) -> dict:
    return {}


class ControlLoopNode(ConfiguredNode):
  """A node with a control loop."""

  def __init__(self, node_name: str):
    super().__init__(node_name)
    self.loop_count = 0
    # setup timer and other helpers
    self.timer = self.create_timer(self.timer_period(), self.control_loop)

  @abstractmethod
  def control_loop(self):
    pass

  def timer_period(self) -> float:
    return 0.1


class SlowAddNode(ControlLoopNode):

  def __init__(self):
    super().__init__('concurrent_service')
    self.service_group = MutuallyExclusiveCallbackGroup()
    self.timer_group = ReentrantCallbackGroup()
    self.server = self.create_service(
      AddTwoInts, 'slow_add', self.slow_add, callback_group=self.service_group)
    # the fast timer has to be in the reentrant group
    self.timer = self.create_timer(
      self.timer_period(), self.control_loop, callback_group=self.timer_group)

  def default_config(self) -> dict:
    return {'work_seconds': 3.0}

  def control_loop(self):
    self.loop_count += 1
    if self.loop_count % 10 == 0:
      self.get_logger().info(f'control loop {self.loop_count}')

  def slow_add(self, request, response):
    self.get_logger().info('slow_add: working')
    time.sleep(self.config('work_seconds'))
    response.sum = request.a + request.b
    self.get_logger().info('slow_add: done')
    return response


def main(args=None):
  rclpy.init(args=args)
  node = SlowAddNode()
  executor = MultiThreadedExecutor(num_threads=4)
  executor.add_node(node)
  try:
    executor.spin()
  except (KeyboardInterrupt, ExternalShutdownException):
    pass
  node.destroy_node()
  rclpy.try_shutdown()


if __name__ == '__main__':
  main()
