"""Ways to pick a lifecycle node."""

from ..matchers.matches_node_name import matches_node_name

__all__ = ["matches_node_name"]
