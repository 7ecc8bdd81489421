import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


def main():
    rclpy.init()
    n = Node("calculator_client")
    for name in ("add", "subtract", "multiply", "divide"):
        c = n.create_client(AddTwoInts, name, qos_profile=rclpy.qos.qos_profile_sensor_data)
        if not c.wait_for_service(timeout_sec=10.0):
            return 1
        f = c.call_async(AddTwoInts.Request(a=12, b=4))
        rclpy.spin_until_future_complete(n, f, timeout_sec=5.0)
        print(name, f.result().sum)
    n.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
