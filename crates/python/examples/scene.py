"""A free scene: the sliding distance of a block, against v²/(2 μ g), and an observer that ends a run."""

from barrelstack import Glance, Scene

scene = Scene("A block slides to rest", run={"duration": "1 s"})
scene.body(
    "block",
    shape={"type": "rectangle", "width": "1 m", "height": "0.3 m"},
    mass="100 kg",
    position=["0 m", "0.15 m"],
    velocity=["1 m/s", "0 m/s"],
    nodes="corners",
)
scene.interface("block", "ground", stiffness="5 MN/m", damping="10 kN s/m", friction={"coefficient": 0.3})
x = scene.run().frames.poses[:, 1, 0]
print(f"{x[-1] - x[0]:.4f} m; exactly {1 / (2 * 0.3 * 9.80665):.4f} m")


def slow(glance: Glance) -> bool:
    """Returns True once the block has lost half of its speed."""
    return bool(glance.twists[1, 0] < 0.5)


run = scene.observe(slow, every=10)
print(f"half as fast after {run.frames.time[-1]:.2f} s")
