#!/usr/bin/env python3

'''
# Team ID:          4711
# Theme:            Smart Greenhouse
# Author List:      -
# Filename:         temperature_publisher.py
# Functions:        main, clip
# Nodes:            Publishing Topics  - [ /sensor/temperature ]
#                   Subscribing Topics - [ ]
'''

################### IMPORT MODULES #######################

import sys
import random

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64

##################### FUNCTION DEFINITIONS #######################


def clip(value, low, high):
    '''
    Description:    Keeps a value between two limits

    Args:
        value, low, high (float)

    Returns:
        float
    '''
    return max(low, min(high, value))


##################### CLASS DEFINITION #######################

class temperature_publisher(Node):
    '''
    ___CLASS___

    Description:    Class which simulates the temperature sensor of the greenhouse
    '''

    def __init__(self):
        '''
        Description:    Initialization of class temperature_publisher
        '''

        super().__init__('temperature_publisher')                       # registering node

        ############ Parameters ############

        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'gh_temp_1')
        self.publish_rate = self.get_parameter('publish_rate').value
        self.sensor_name = self.get_parameter('sensor_name').value

        ############ Topic PUBLICATIONS ############

        self.temp_pub = self.create_publisher(Float64, '/sensor/temperature', 10)

        ############ Constructor VARIABLES ############

        self.timer = self.create_timer(1.0 / self.publish_rate, self.process_reading)
        self.get_logger().info(self.sensor_name + ' ready')

    def process_reading(self):
        '''
        Description:    Timer function used to draw and publish one reading
        '''
        msg = Float64()
        msg.data = clip(random.uniform(20.0, 30.0), 20.0, 30.0)
        self.temp_pub.publish(msg)
        self.get_logger().info('%s : %.2f' % (self.sensor_name, msg.data))


##################### FUNCTION DEFINITION #######################

def main():
    '''
    Description:    Main function which creates a ROS node and spins it
    '''

    rclpy.init(args=sys.argv)                                           # initialisation

    node = rclpy.create_node('temperature_process')                     # creating ROS node

    node.get_logger().info('Node created: temperature process')         # logging information

    temperature_class = temperature_publisher()                         # creating a new object for class

    try:
        rclpy.spin(node)                                                # spinning to make it alive in ROS 2 DDS
    except KeyboardInterrupt:
        pass

    temperature_class.destroy_node()                                    # destroy node after spin ends
    rclpy.try_shutdown()                                                # shutdown process


if __name__ == '__main__':
    '''
    Description:    If the python script is executed as main, only then main() function will be called
    '''
    main()
