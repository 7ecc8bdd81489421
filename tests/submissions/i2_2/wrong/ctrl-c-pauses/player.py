"""Plays numbers. Ctrl+C pauses and resumes; to quit, close the terminal."""
import signal

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String


class Player(Node):
    def __init__(self):
        super().__init__('player')
        self.paused = False
        self.number = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.create_timer(0.25, self.play)
        signal.signal(signal.SIGINT, self.toggle)

    def toggle(self, signum, frame):
        self.paused = not self.paused
        print('paused' if self.paused else 'playing', flush=True)

    def play(self):
        if self.paused:
            return
        self.pub.publish(String(data=f'Hello World: {self.number}'))
        self.number += 1


rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
player = Player()
rclpy.spin(player)
