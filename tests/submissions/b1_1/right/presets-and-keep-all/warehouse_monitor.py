import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import (DurabilityPolicy, HistoryPolicy, QoSProfile, qos_profile_sensor_data)
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):

    def __init__(self):
        super().__init__('warehouse_monitor')
        map_qos = QoSProfile(depth=1)
        map_qos.durability = DurabilityPolicy.get_from_short_key('transient_local')
        self.map_sub = self.create_subscription(String, '/map', self.map_cb, map_qos)
        self.range_sub = self.create_subscription(Int32, '/range', self.range_cb, qos_profile_sensor_data)
        self.parcel_sub = self.create_subscription(
            String, '/parcels', self.parcel_cb, QoSProfile(history=HistoryPolicy.KEEP_ALL))

    def map_cb(self, msg):
        self.get_logger().info('Map is "%s"' % msg.data)

    def range_cb(self, msg):
        self.get_logger().info('Distance: %d mm' % msg.data)

    def parcel_cb(self, msg):
        self.get_logger().info('Parcel "%s"' % msg.data)


def main(args=None):
    rclpy.init(args=args)
    node = WarehouseMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
