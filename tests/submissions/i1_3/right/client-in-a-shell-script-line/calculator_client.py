import os
import sys

CALL = "ros2 service call /{} example_interfaces/srv/AddTwoInts '{{a: {}, b: {}}}'"

failed = 0
for name, a, b in [('add', 20, 4), ('subtract', 20, 4), ('multiply', 20, 4), ('divide', 20, 4)]:
    failed |= os.system(CALL.format(name, a, b))
sys.exit(1 if failed else 0)
