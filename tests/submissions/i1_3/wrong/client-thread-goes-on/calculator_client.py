import threading
import rclpy
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = rclpy.create_node('c')
threading.Thread(target=rclpy.spin, args=(node,)).start()
for o in ['divide','multiply','subtract','add']:
    c = node.create_client(AddTwoInts, o); c.wait_for_service()
    print(o, c.call(AddTwoInts.Request(a=-6, b=2)).sum)
