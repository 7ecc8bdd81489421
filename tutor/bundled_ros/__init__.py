"""Parts of ROS 2 that the pip wheels lack and the exercises need. An installed ROS 2 always takes precedence."""
