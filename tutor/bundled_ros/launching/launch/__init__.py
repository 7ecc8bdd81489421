"""What launch files know as `launch`, `launch_xml` and `launch_yaml`."""
