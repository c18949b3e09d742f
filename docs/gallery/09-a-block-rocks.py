"""A block rocks free.

Angle against angular velocity: between impacts the energy of the block is constant, and each impact takes some of it.
"""

import matplotlib.pyplot as plt
from barrelstack import Scene

scene = Scene("A block rocks free", run={"duration": "6 s"}, record={"frame_rate": "200 Hz"})
shape = {"type": "rectangle", "width": "0.3 m", "height": "1.2 m"}
start = {"position": ["0 m", "0.6 m"], "velocity": ["-0.36 m/s", "0.09 m/s"], "spin": "0.6 rad/s"}
scene.body("block", shape=shape, mass="200 kg", nodes="corners", **start)
scene.interface("block", "ground", stiffness="20 MN/m", damping="200 kN s/m", friction={"coefficient": 0.8})
states = []
scene.observe(lambda glance: states.append((*glance.poses[1, 2:], *glance.twists[1, 2:])), every=20)
figure, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(*zip(*[(1e3 * angle, spin) for angle, spin in states]), linewidth=0.8)
ax.set(xlabel="angle (mrad)", ylabel="angular velocity (rad/s)")
