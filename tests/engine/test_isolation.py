"""Two checks never discover each other, not even on one domain id."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from tests.engine.helpers import FILE, PUBLISHES, Scene, node
from tutor.ros.environment import learner_env

TYPE = "std_msgs/msg/String"

# Publishes on /other, and prints the nodes and topics that it discovers.
OTHER_NODE = node(
    PUBLISHES.replace('"chatter"', '"other"').replace("node.get_name()", "'from the other check'"),
    """
def look():
    print(sorted(node.get_node_names()), sorted(t for t, _ in node.get_topic_names_and_types()), flush=True)
node.create_timer(0.05, look)
heard = node.create_subscription(String, "chatter", lambda message: print("HEARD", message.data, flush=True), 10)
""",
)


@asynccontextmanager
async def other_checks_node(
    scene: Scene, folder: Path, domain_id: int, group: str
) -> AsyncIterator[asyncio.StreamReader]:
    """Start a node as another check does; yield its stdout."""
    (folder / "other_checks_node.py").write_text(OTHER_NODE)
    env = learner_env(scene.ros, domain_id=domain_id, log_dir=folder, package_root=None, isolated=True)
    process = await asyncio.create_subprocess_exec(
        scene.ros.python,
        folder / "other_checks_node.py",
        env={**env, "ROS_TUTOR_GROUP": group},
        stdout=asyncio.subprocess.PIPE,
    )
    try:
        assert process.stdout is not None
        yield process.stdout
    finally:
        process.kill()
        await process.communicate()


async def test_checks_on_one_domain_id_do_not_discover_each_other(scene: Scene, tmp_path: Path) -> None:
    watch = {"/chatter": TYPE, "/other": TYPE}
    async with scene.bench(node(PUBLISHES)).start(FILE, watch=watch) as run:
        assert await run.until(lambda: bool(run.samples_on("/chatter")), 20), run.trace()
        (domain_id,) = scene.seen_domains
        async with other_checks_node(scene, tmp_path, domain_id, "239.1.2.3") as stdout:
            seen: list[str] = []
            while not seen or "/other" not in seen[-1]:  # it is up, and discovery is running
                seen.append((await asyncio.wait_for(stdout.readline(), 20)).decode())
            received = len(run.samples_on("/chatter"))
            # Both run on for longer than discovery takes.
            assert await run.until(lambda: len(run.samples_on("/chatter")) >= received + 20, 20)
            while len(seen) < 20:
                seen.append((await asyncio.wait_for(stdout.readline(), 20)).decode())
            graph, others = run.graph, list(run.samples_on("/other"))
        # A node of the same check is discovered, which shows that the above can fail.
        async with other_checks_node(scene, tmp_path, domain_id, os.environ["ROS_TUTOR_GROUP"]) as stdout:
            line = ""
            while line.count("'learner'") != 2:
                line = (await asyncio.wait_for(stdout.readline(), 20)).decode()
            assert await run.until(lambda: bool(run.samples_on("/other")), 20)
    assert others == []
    assert graph.nodes == ("/learner",)
    assert {p.topic for p in graph.publishers} == {"/chatter"}
    assert not [line for line in seen if "HEARD" in line or "_ros_tutor" in line]
    assert all(line.count("'learner'") == 1 for line in seen), "itself only"
