"""ROS 2: which one is used, domains, and everything that is seen over DDS. The only importer of rclpy, and late."""
