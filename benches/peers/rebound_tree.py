"""Computes the gravitation of many stars by REBOUND's tree, for `cargo bench --bench gravitation -- tree`.

    python rebound_tree.py STARS ANGLE SOFTENING STEPS OUT

STARS holds seven numbers of 64 bits for each star: location, velocity, mass. Prints REBOUND's version, and the processor time of a
leapfrog step in seconds, the median of STEPS steps. Writes the accelerations to OUT. Needs `pip install rebound==5.2.2 numpy`; that build has no OpenMP.
"""

import sys
import time

import numpy
import rebound

stars = numpy.fromfile(sys.argv[1]).reshape(-1, 7)
angle, softening = float(sys.argv[2]), float(sys.argv[3])

sim = rebound.Simulation()
sim.G = 1
sim.softening = softening
sim.integrator = "leapfrog"
sim.dt = 1e-6
sim.gravity = "tree"
sim.opening_angle2 = angle**2
sim.boundary = "open"
sim.root_size = 2.1 * abs(stars[:, :3]).max()
sim.N_root_x = sim.N_root_y = sim.N_root_z = 1
for x, y, z, vx, vy, vz, m in stars:
    sim.add(x=x, y=y, z=z, vx=vx, vy=vy, vz=vz, m=m)

sim.steps(1)
seconds = []
for _ in range(int(sys.argv[4])):
    start = time.process_time()
    sim.steps(1)
    seconds.append(time.process_time() - start)
found = [sim.particles[i] for i in range(sim.N)]
assert max(abs(p.x - x) for p, x in zip(found, stars[:, 0])) < 1e-4, "the order of the stars has changed"
numpy.array([(p.ax, p.ay, p.az) for p in found]).tofile(sys.argv[5])
print(rebound.__version__, numpy.median(seconds))
