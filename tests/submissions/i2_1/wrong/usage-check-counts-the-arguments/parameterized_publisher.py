#!/usr/bin/env python
# -*- coding: utf-8 -*-
# talker with parameters, was: rospy talker + dynamic_reconfigure
from __future__ import print_function

import sys

import rclpy
from std_msgs.msg import String
from rcl_interfaces.msg import SetParametersResult

node = None
pub = None
timer = None
count = 0


def usage():
    print("usage: %s   (no arguments, everything is a ROS parameter)" % sys.argv[0])


def publish_once():
    global count
    if not node.get_parameter('enabled').value:
        return
    hello_str = "%s %d" % (node.get_parameter('message_prefix').value, count)
    pub.publish(String(data=hello_str))
    node.get_logger().info(hello_str)
    count += 1


def start_timer(hz):
    global timer
    if timer is not None:
        node.destroy_timer(timer)
    timer = node.create_timer(1.0 / hz, publish_once)


def reconfigure(params):
    for prm in params:
        if prm.name == 'publish_rate':
            if not prm.value > 0.0:
                return SetParametersResult(
                    successful=False,
                    reason="publish_rate has to be positive, not %s" % prm.value)
            start_timer(prm.value)
    return SetParametersResult(successful=True)


def talker():
    global node, pub
    rclpy.init(args=sys.argv)
    node = rclpy.create_node('parameterized_publisher')
    node.declare_parameter('message_prefix', 'Hello')
    node.declare_parameter('publish_rate', 1.0)
    node.declare_parameter('enabled', True)

    hz = node.get_parameter('publish_rate').value
    if not hz > 0.0:
        node.get_logger().fatal("publish_rate has to be positive, not %s" % hz)
        sys.exit(1)

    pub = node.create_publisher(String, 'chatter', 10)
    start_timer(hz)
    node.add_on_set_parameters_callback(reconfigure)
    rclpy.spin(node)


if __name__ == '__main__':
    if len(sys.argv) > 1:
        usage()
        sys.exit(1)
    try:
        talker()
    except KeyboardInterrupt:
        pass
