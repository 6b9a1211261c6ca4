"""Runs the orbits of `benches/kepler.rs` with REBOUND's IAS15 on one thread, with the same rotated copies, and prints the same figures.

    python benches/peers/kepler.py
"""

import math
import time

import rebound

ECCENTRICITY = 0.9
ORBITS = 100
COPIES = 20
REPEATS = 5


def turned(copy, vector):
    x, y, z, w = ((copy + 1) * math.sqrt(root) % 1.0 - 0.5 for root in (2, 3, 5, 7))
    length = math.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / length, y / length, z / length, w / length
    a, b, c = vector
    p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return (a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p)


def run(copy):
    at = turned(copy, (1 - ECCENTRICITY, 0, 0))
    speed = math.sqrt((1 + ECCENTRICITY) / (1 - ECCENTRICITY))
    velocity = turned(copy, (0, speed, 0))
    simulation = rebound.Simulation()
    simulation.integrator = "ias15"
    simulation.add(m=1)
    simulation.add(m=1e-20, x=at[0], y=at[1], z=at[2], vx=velocity[0], vy=velocity[1], vz=velocity[2])
    start = time.process_time()
    simulation.integrate(ORBITS * 2 * math.pi)
    spent = time.process_time() - start
    sun, planet = simulation.particles
    place = [planet.x - sun.x, planet.y - sun.y, planet.z - sun.z]
    motion = [planet.vx - sun.vx, planet.vy - sun.vy, planet.vz - sun.vz]
    energy = sum(v * v for v in motion) / 2 - 1 / math.sqrt(sum(x * x for x in place))
    return (energy + 0.5) / 0.5, math.dist(place, at), spent, simulation.steps_done


def main():
    energy = place = spent = 0.0
    for copy in range(COPIES):
        runs = [run(copy) for _ in range(REPEATS)]
        energy += runs[0][0] ** 2
        place += runs[0][1] ** 2
        spent += min(one[2] for one in runs)
    energy, place = math.sqrt(energy / COPIES), math.sqrt(place / COPIES)
    print(f"IAS15 of REBOUND {rebound.__version__}: {energy:.2e}  {place:.2e}  {spent / COPIES * 1e3:.2f} ms  {runs[0][3]}")


main()
