"""ROS 2: choosing an installation, domains, and everything over DDS. Only this package imports rclpy, and lazily."""
