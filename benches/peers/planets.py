"""Runs the planets of `benches/planets.rs` with REBOUND on one thread: WHFast with its corrector of 17th order, and IAS15.

    python benches/peers/planets.py
"""

import math
import time

import rebound

YEARS = 1000
STEP = 0.01
PLANETS = [
    (0.387098, 0.20563, 1.66e-7),
    (0.723332, 0.00677, 2.448e-6),
    (1.0, 0.01671, 3.003e-6),
    (1.52368, 0.0934, 3.227e-7),
    (2.767, 0.0758, 4.7e-10),
    (5.2044, 0.0489, 9.548e-4),
    (9.5826, 0.0565, 2.859e-4),
    (19.2184, 0.04638, 4.366e-5),
    (30.11039, 0.00946, 5.151e-5),
    (39.482, 0.2488, 6.55e-9),
]


def simulation():
    sim = rebound.Simulation()
    sim.G = 4 * math.pi * math.pi
    sim.add(m=1)
    for k, (axis, eccentricity, mass) in enumerate(PLANETS):
        sin, cos = math.sin(2.4 * k), math.cos(2.4 * k)
        tilt, upright = math.sin(0.02 * (k % 4)), math.cos(0.02 * (k % 4))
        speed = math.sqrt(sim.G / axis * (1 + eccentricity) / (1 - eccentricity))
        near = axis * (1 - eccentricity)
        sim.add(
            m=mass,
            x=near * cos, y=near * sin * upright, z=near * sin * tilt,
            vx=-speed * sin, vy=speed * cos * upright, vz=speed * cos * tilt,
        )
    sim.move_to_com()
    return sim


def mercury(sim):
    sun, planet = sim.particles[0], sim.particles[1]
    return (planet.x - sun.x, planet.y - sun.y, planet.z - sun.z)


def run(prepare):
    sim = simulation()
    prepare(sim)
    kinetic = sum(p.m * (p.vx**2 + p.vy**2 + p.vz**2) / 2 for p in sim.particles)
    before = sim.energy()
    start = time.process_time()
    sim.integrate(YEARS)
    spent = time.process_time() - start
    return mercury(sim), (sim.energy() - before) / kinetic, spent


def whfast(sim):
    sim.integrator = "whfast"
    sim.dt = STEP
    settings = getattr(sim, "ri_whfast", None) or sim.integrator
    settings.corrector = 17
    settings.safe_mode = 0


def ias15(sim):
    sim.integrator = "ias15"


def main():
    reference = run(ias15)[0]
    for name, prepare in (("WHFast", whfast), ("IAS15", ias15)):
        place, energy, spent = min((run(prepare) for _ in range(2)), key=lambda one: one[2])
        print(f"{name} of REBOUND {rebound.__version__}: {energy:.1e}  {math.dist(place, reference):.1e} AU  {spent:.2f} s")


main()
