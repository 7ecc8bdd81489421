"""The demo nodes of ROS (`demo_nodes_py`, `demo_nodes_cpp`), where no real ones are installed."""
