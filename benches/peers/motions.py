"""Measures the errors of MuJoCo and SciPy for the oscillator, the drag and the wing nut of docs/validation.md. Writes TOML.

    python motions.py > motions.toml

Needs `pip install mujoco==4.0.0 scipy==1.17.1 numpy`. The oscillator is x'' = -4 x from (1, 0) at (0, 1), the drag x'' = (0, -2) - 2 x' from rest at the
origin with the velocity (1, 0), both for 1 s; the error is that of the position. The nut has the moments of inertia 1, 2, 3 and the angular velocity (0.001, 5, 0.001);
the error is that of its angular velocity in body axes after 10 s. `seconds` is processor time, the least of three runs.
"""

import time
from math import cos, exp, sin

import mujoco
import numpy
import scipy
from scipy.integrate import solve_ivp

NUT = numpy.array([4.510627124012, -2.157369682769, 2.60421191226])
OSCILLATOR = numpy.array([cos(2), sin(2) / 2])
DRAG = numpy.array([(1 - exp(-2)) / 2, -1 + (1 - exp(-2)) / 2])

BODIES = {
    "wing_nut": '<freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 2 3"/>',
    "oscillator": '<joint type="slide" axis="1 0 0" stiffness="4"/><joint type="slide" axis="0 1 0" stiffness="4"/>'
    '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>',
    "drag": '<joint type="slide" axis="1 0 0" damping="2"/><joint type="slide" axis="0 1 0" damping="2"/>'
    '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>',
}


def by_mujoco(problem, integrator, step):
    gravity = "0 -2 0" if problem == "drag" else "0 0 0"
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step!r}" gravity="{gravity}" integrator="{integrator}"/>'
        f"<worldbody><body>{BODIES[problem]}</body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    if problem == "wing_nut":
        # The velocities of a free joint: the linear velocity, and the angular velocity in body axes.
        data.qvel[3:] = 0.001, 5, 0.001
    elif problem == "oscillator":
        data.qpos[:], data.qvel[:] = (1, 0), (0, 1)
        # The rest position of a spring is where the joint coordinate is zero.
        assert (model.qpos_spring == 0).all()
    else:
        data.qvel[:] = 1, 0
    steps = round((10 if problem == "wing_nut" else 1) / step)
    for _ in range(steps):
        mujoco.mj_step(model, data)
    if problem == "wing_nut":
        return numpy.linalg.norm(data.qvel[3:] - NUT), {"steps": steps}
    return numpy.linalg.norm(data.qpos - (OSCILLATOR if problem == "oscillator" else DRAG)), {"steps": steps}


def by_scipy(problem, tolerance):
    if problem == "wing_nut":
        moments = numpy.array([1.0, 2.0, 3.0])
        motion = lambda _, w: numpy.cross(moments * w, w) / moments
        start, end = [0.001, 5, 0.001], 10
    elif problem == "oscillator":
        motion = lambda _, s: numpy.array([s[2], s[3], -4 * s[0], -4 * s[1]])
        start, end = [1, 0, 0, 1], 1
    else:
        motion = lambda _, s: numpy.array([s[2], s[3], -2 * s[2], -2 - 2 * s[3]])
        start, end = [0, 0, 1, 0], 1
    found = solve_ivp(motion, (0, end), start, method="DOP853", rtol=tolerance, atol=tolerance)
    known = {"wing_nut": NUT, "oscillator": OSCILLATOR, "drag": DRAG}[problem]
    return numpy.linalg.norm(found.y[: len(known), -1] - known), {"evaluations": found.nfev}


print("# Made by motions.py.\n")
for problem in BODIES:
    step = 2.5e-4 if problem == "wing_nut" else 1 / 256
    mujoco_name, scipy_name = f"MuJoCo {mujoco.__version__}", f"SciPy {scipy.__version__}"
    runs = [
        (mujoco_name, "RK4", f"timestep = {step:g}", lambda: by_mujoco(problem, "RK4", step)),
        (mujoco_name, "Euler", f"timestep = {step:g}", lambda: by_mujoco(problem, "Euler", step)),
        (mujoco_name, "implicitfast", f"timestep = {step:g}", lambda: by_mujoco(problem, "implicitfast", step)),
        (scipy_name, "DOP853", "rtol = atol = 1e-12", lambda: by_scipy(problem, 1e-12)),
    ]
    for program, method, settings, solve in runs:
        seconds = []
        for _ in range(3):
            start = time.process_time()
            error, work = solve()
            seconds.append(time.process_time() - start)
        print(f'[[record]]\nproblem = "{problem}"\nprogram = "{program}"\nmethod = "{method}"\nsettings = "{settings}"')
        print(f"error = {error:.2e}")
        for what, number in work.items():
            print(f"{what} = {number}")
        print(f"seconds = {min(seconds):.3g}\n", flush=True)
