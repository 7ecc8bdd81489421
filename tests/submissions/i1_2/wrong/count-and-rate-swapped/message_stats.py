#!/usr/bin/env python3

# Message statistics for the chatter topic.
#
# message_stats.py
#
# This is the second of the listener examples: it does not only print what it hears, it also
# counts, and tells us every ten messages how things are going.


# Every Python node in ROS2 should include these lines.
import rclpy
from rclpy.node import Node

# The talker sends Strings.
from std_msgs.msg import String

# We need the wall clock for the rate.
from time import time


# How many messages between two reports.
REPORT = 10


# The idiom in ROS2 is to encapsulate everything to do with the node in a class that
# is derived from the Node class in rclpy.node.
class MessageStats(Node):
	def __init__(self):
		# Initialize the parent class, giving it a name.
		super().__init__('message_stats')

		# Everything that we keep between two callbacks lives in instance variables.
		self.total = 0
		self.first = None
		self.last = None
		self.started = None
		self.previous = None

		# Subscribe.  The last argument is the queue size.
		self.sub = self.create_subscription(String, 'chatter', self.callback, 10)

	# This is called for every message that comes in.
	def callback(self, msg):
		now = time()

		# The first message starts the clock.
		if self.started is None:
			self.started = now
			self.first = msg.data

		self.total += 1
		self.last = msg.data

		# Look at the number behind the colon.
		self.check(int(msg.data.split(':')[1]))

		if self.total % REPORT == 0:
			self.report(now)

	# Compare the number with the one before.
	def check(self, number):
		if self.previous is not None:
			if number < self.previous:
				self.get_logger().info('The talker started over at {0}'.format(number))
			elif number > self.previous + 1:
				self.get_logger().warn('Gap! {0} messages between {1} and {2} never arrived'.format(
					number - self.previous - 1, self.previous, number))
		self.previous = number

	# Print the report.  The first message is at time zero, so there is one interval less
	# than there are messages.
	def report(self, now):
		elapsed = now - self.started
		rate = (self.total - 1) / elapsed
		self.get_logger().info('{0} messages in total, {1:.2f} messages per second, first: "{2}", last: "{3}"'.format(
			rate, self.total, self.first, self.last))


# The idiom in ROS2 is to use a function to do all of the setup and work.
def main(args=None):
	# Initialize rclpy.
	rclpy.init(args=args)

	# The node class does all of the work.
	stats = MessageStats()

	# Give control over to ROS2.
	rclpy.spin(stats)

	# Make sure we shutdown everything cleanly.
	rclpy.shutdown()


# If we run the node as a script, then we're going to start here.
if __name__ == '__main__':
	# The main function takes an argument, but we don't need it here.
	main()
