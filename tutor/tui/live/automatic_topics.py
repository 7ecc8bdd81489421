"""Which topics the live page follows on its own: the lesson's, and those of the learner's own nodes."""

from __future__ import annotations

from tutor.content import LiveView
from tutor.tui.live.state import LiveState
from tutor.tui.live.topics_panel import TopicsPanel

_MAX_AUTO_FOLLOWED = 8
"""At most this many topics of the learner's own nodes are followed automatically."""


class AutomaticTopics:
    """Follows topics in the panel that is passed, and unfollows those of earlier lessons."""

    def __init__(self, state: LiveState) -> None:
        self.own_nodes_running = False
        self._state = state
        self._stale: set[str] = set()
        self._followed: set[str] = set()

    def set_lesson(self, view: LiveView) -> None:
        """Note the lesson that is shown. Topics followed so far go once they have no publisher, unless it has them."""
        self._state.set_lesson(view)
        self._stale = {name for name in self._state.topics if not self._state.is_lesson_topic(name)}
        self._followed.clear()

    def follow_lesson_topics(self, panel: TopicsPanel) -> None:
        """Follow the lesson's topics; the first of them is shown."""
        for topic in reversed(self._state.lesson_view.topics):
            panel.follow(topic.name)
        panel.show_list()

    def follow_own_topics(self, panel: TopicsPanel) -> None:
        """Follow new topics while a node of the learner's runs, each only once: if unfollowed, it stays unfollowed."""
        if not self.own_nodes_running or self._state.graph is None:
            return
        for topic in self._state.graph.topics:
            name = topic.name
            if topic.is_standard or not topic.publishers or name in self._followed:
                continue
            if len(self._followed) >= _MAX_AUTO_FOLLOWED:
                return
            self._followed.add(name)
            if name not in self._state.topics:
                idle = not self._state.is_published(panel.chosen)
                panel.follow(name, show=idle and not panel.chosen_by_learner)

    def unfollow_stale_topics(self, panel: TopicsPanel) -> None:
        """Unfollow topics of earlier lessons that no longer have a publisher."""
        for name in [name for name in self._stale if not self._state.is_published(name)]:
            self._stale.discard(name)
            panel.unfollow(name)
