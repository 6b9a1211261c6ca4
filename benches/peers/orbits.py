"""Measures the errors of SciPy's DOP853 and of REBOUND's IAS15 and WHFast for the problems of problems.py. Writes TOML.

    python orbits.py [PROBLEM…] > orbits.toml

Needs `pip install rebound==5.2.2 scipy numpy`. `location_error` is the largest distance of a body from its exact position. For the planets, IAS15
is the reference; DOP853 agrees with IAS15 within its tolerance. `seconds` is processor time, the least of three runs, or of
a single run that takes more than 5 s; `yardstick` is a plain loop of 10⁷ steps of Euler–Cromer for an oscillator in C by `cc -O2`, to compare machines.
"""

import subprocess
import sys
import tempfile
import time

import numpy
import rebound
import scipy
from scipy.integrate import solve_ivp

from problems import PROBLEMS

YARDSTICK = """
#include <stdio.h>
#include <time.h>
int main(int n, char **_) {
    volatile double w = n;
    double x = 1, v = 0, dt = 1e-3 * w;
    clock_t start = clock();
    for (int i = 0; i < 10000000; i++) { v -= dt * x; x += dt * v; }
    w = x;
    printf("%g", (double)(clock() - start) / CLOCKS_PER_SEC);
}
"""


def yardstick():
    with tempfile.TemporaryDirectory() as folder:
        source = f"{folder}/a.c"
        with open(source, "w") as file:
            file.write(YARDSTICK)
        subprocess.run(["cc", "-O2", source, "-o", f"{folder}/a"], check=True)
        return min(float(subprocess.run([f"{folder}/a"], capture_output=True, check=True).stdout) for _ in range(3))


def energy(G, masses, places, velocities):
    kinetic = 0.5 * (masses * (velocities**2).sum(1)).sum()
    pairs = [(i, j) for i in range(len(masses)) for j in range(i)]
    return kinetic - sum(G * masses[i] * masses[j] / numpy.linalg.norm(places[i] - places[j]) for i, j in pairs)



def energy_error(problem, places, velocities):
    G, masses, start, moving = problem[:4]
    if masses[1] == 0:
        # For a body without mass, the energy is that of 1 kg in the field of the other body.
        of = lambda x, v: 0.5 * (v[1] ** 2).sum() - G * masses[0] / numpy.linalg.norm(x[1] - x[0])
    else:
        of = lambda x, v: energy(G, masses, x, v)
    return abs(of(places, velocities) / of(start, moving) - 1)


def dop853(tolerance):
    def solve(problem):
        G, masses, places, velocities, duration, _ = problem
        count = len(masses)
        weights, one = G * masses[:, None], numpy.eye(count)

        def motion(_, state):
            x = state[: 3 * count].reshape(count, 3)
            d = x[None] - x[:, None]
            square = (d * d).sum(2) + one
            pull = (d / (square * numpy.sqrt(square))[:, :, None] * weights[None]).sum(1)
            return numpy.concatenate((state[3 * count :], pull.ravel()))

        start = numpy.concatenate((places.ravel(), velocities.ravel()))
        found = solve_ivp(motion, (0, duration), start, method="DOP853", rtol=tolerance, atol=tolerance, t_eval=[duration])
        end = found.y[:, -1]
        return end[: 3 * count].reshape(count, 3), end[3 * count :].reshape(count, 3), {"evaluations": found.nfev}

    return solve


def by_rebound(integrator, dt):
    def solve(problem):
        G, masses, places, velocities, duration, _ = problem
        sim = rebound.Simulation()
        sim.G = G
        for mass, (x, y, z), (u, v, w) in zip(masses, places, velocities):
            sim.add(m=mass, x=x, y=y, z=z, vx=u, vy=v, vz=w)
        sim.integrator = integrator
        if dt is not None:
            sim.dt = dt
        sim.integrate(duration, exact_finish_time=1)
        find = lambda names: numpy.array([[getattr(p, name) for name in names] for p in sim.particles])
        return find(("x", "y", "z")), find(("vx", "vy", "vz")), {"steps": sim.steps_done}

    return solve


METHODS = {
    "kepler": [("whfast", 2 * numpy.pi / 1000)],
    "ten_planets": [("whfast", 0.01)],
}


def measure(name):
    problem = PROBLEMS[name]()
    end = problem[5]
    runs = [("REBOUND", rebound.__version__, "IAS15", "default", by_rebound("ias15", None))]
    runs += [
        ("REBOUND", rebound.__version__, "WHFast", f"dt = {dt:.10g}", by_rebound(method, dt))
        for method, dt in METHODS.get(name, [])
    ]
    tolerances = [1e-12] if name == "ten_planets" else [1e-9, 1e-12]
    runs += [("SciPy", scipy.__version__, "DOP853", f"rtol = atol = {t:g}", dop853(t)) for t in tolerances]
    for program, version, method, settings, solve in runs:
        seconds = []
        for _ in range(3):
            start = time.process_time()
            places, velocities, work = solve(problem)
            seconds.append(time.process_time() - start)
            if seconds[0] > 5:
                break
        if end is None:
            # The first result is the reference for the later results.
            end = places
        away = numpy.linalg.norm(places - end, axis=1).max()
        print("[[record]]")
        print(f'problem = "{name}"\nprogram = "{program} {version}"\nmethod = "{method}"\nsettings = "{settings}"')
        print(f"location_error = {away:.2e}" if places is not end else "# It is the reference of the others.")
        print(f"relative_energy_error = {energy_error(problem, places, velocities):.2e}")
        for what, number in work.items():
            print(f"{what} = {number}")
        print(f"seconds = {min(seconds):.3g}\nyardstick = {yardstick():.3g}\n", flush=True)


for name in sys.argv[1:] or PROBLEMS:
    measure(name)
