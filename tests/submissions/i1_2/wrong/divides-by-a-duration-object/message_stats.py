#!/usr/bin/python3
import rclpy
from rclpy.node import Node

import rclpy.time
from std_msgs.msg import String

class ListenerNode(Node):

    def __init__(self):
        super().__init__('listener')

        # Init subscribers
        self.subscriber = self.create_subscription(String, '/chatter', self.receiveMessage, 10)

        self.get_logger().info('Listening...')


        self.totalNbMessages = 0
        self.nbBadId = 0
        self.prevId = None
        self.firstMsg = ''
        self.lastMsg = ''



    def receiveMessage(self, msg:String):
        """
        Receive a message from another computer
        """

        if self.totalNbMessages == 0:
            self.initTime = self.get_clock().now()
            self.firstMsg = msg.data


        # Save data
        self.totalNbMessages += 1
        self.lastMsg = msg.data


        # Check the id
        msgId = int(msg.data.split()[2])
        if self.prevId is not None and msgId != self.prevId + 1:
            self.nbBadId += 1
            self.get_logger().warning(f"-> Wrong id n°{msgId} after n°{self.prevId}")
        self.prevId = msgId


        if self.totalNbMessages % 10 == 0:
            # Check current time
            current_time = self.get_clock().now()
            duration = current_time - self.initTime
            frequency = self.totalNbMessages / duration

            self.get_logger().info(f"-> Received {self.totalNbMessages} messages at {frequency:.2f} msg/s")
            self.get_logger().info(f"-> First: {self.firstMsg}, last: {self.lastMsg}")
            self.get_logger().info(f"-> {self.nbBadId} messages had a wrong id")



def main(args=None):

    # Init
    rclpy.init(args=args)

    # Create the node
    node = ListenerNode()

    # Run the node
    rclpy.spin(node)

    rclpy.shutdown()



if __name__ == '__main__':
    main()
