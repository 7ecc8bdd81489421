import rclpy
import threading
from example_interfaces.srv import AddTwoInts

rclpy.init()
n = rclpy.create_node("c")
t = threading.Thread(target=rclpy.spin, args=(n,), daemon=True)
t.start()
for k in ("add", "subtract", "multiply", "divide"):
    c = n.create_client(AddTwoInts, k)
    c.wait_for_service()
    print(c.call(AddTwoInts.Request(a=-9, b=3)).sum)
rclpy.shutdown()
t.join()
