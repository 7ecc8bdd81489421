"""The demo nodes of ROS (`demo_nodes_py`, `demo_nodes_cpp`), used when the real ones are not installed."""
