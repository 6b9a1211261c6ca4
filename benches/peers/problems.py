"""The reference problems of orbits: masses, locations, velocities, time, and the positions of the bodies at the end. G = 1 unless stated otherwise.

Kepler returns to its start. The end of the Pleiades is that of the Test Set for IVP Solvers 2.4, problem PLEI, rounded to 16 digits. The
figure eight is C. Simó's, as A. Chenciner and R. Montgomery print it (Ann. Math. 152 (2000) 881): its start has nine digits, so it returns
to 3e-8 only. The planets are those of E. M. Standish's Keplerian elements for J2000 (JPL, "Approximate Positions of the Planets", table 1),
with Pluto and Ceres, in astronomical units, years and masses of the sun.
"""

from math import pi, radians

import numpy


def kepler():
    e = 0.9
    masses = numpy.array([1.0, 0.0])
    places = numpy.array([[0.0, 0.0, 0.0], [1 - e, 0.0, 0.0]])
    velocities = numpy.array([[0.0, 0.0, 0.0], [0.0, ((1 + e) / (1 - e)) ** 0.5, 0.0]])
    return 1.0, masses, places, velocities, 100 * 2 * pi, places


def pleiades():
    masses = numpy.arange(1.0, 8.0)
    places = numpy.zeros((7, 3))
    places[:, 0] = 3, 3, -1, -3, 2, -2, 2
    places[:, 1] = 3, -3, 2, 0, 0, -4, 4
    velocities = numpy.zeros((7, 3))
    velocities[5:, 0] = 1.75, -1.5
    velocities[3:5, 1] = -1.25, 1
    end = numpy.zeros((7, 3))
    end[:, 0] = (
        0.3706139143970502, 3.237284092057233, -3.222559032418324, 0.6597091455775310, 0.3425581707156584,
        1.562172101400631, -0.7003092922212495,
    )
    end[:, 1] = (
        -3.943437585517392, -3.271380973972550, 5.225081843456543, -2.590612434977470, 1.198213693392275,
        -0.2429682344935824, 1.091449240428980,
    )
    return 1.0, masses, places, velocities, 3.0, end


def figure_eight():
    first, moves = numpy.array([0.97000436, -0.24308753, 0]), numpy.array([0.466203685, 0.43236573, 0])
    places = numpy.array([first, -first, [0, 0, 0]])
    return 1.0, numpy.ones(3), places, numpy.array([moves, moves, -2 * moves]), 6.32591398, places


# Semi-major axis, eccentricity, inclination, mean longitude, longitude of the perihelion, longitude of the ascending node, and the sun's mass
# divided by the planet's mass.
ELEMENTS = {
    "mercury": (0.38709927, 0.20563593, 7.00497902, 252.25032350, 77.45779628, 48.33076593, 6023600),
    "venus": (0.72333566, 0.00677672, 3.39467605, 181.97909950, 131.60246718, 76.67984255, 408523.71),
    "earth and moon": (1.00000261, 0.01671123, -0.00001531, 100.46457166, 102.93768193, 0.0, 328900.56),
    "mars": (1.52371034, 0.09339410, 1.84969142, -4.55343205, -23.94362959, 49.55953891, 3098708),
    "ceres": (2.7675, 0.0758, 10.593, 231.3, 153.9, 80.33, 2.1e9),
    "jupiter": (5.20288700, 0.04838624, 1.30439695, 34.39644051, 14.72847983, 100.47390909, 1047.3486),
    "saturn": (9.53667594, 0.05386179, 2.48599187, 49.95424423, 92.59887831, 113.66242448, 3497.898),
    "uranus": (19.18916464, 0.04725744, 0.77263783, 313.23810451, 170.95427630, 74.01692503, 22902.98),
    "neptune": (30.06992276, 0.00859048, 1.77004347, -55.12002969, 44.96476227, 131.78422574, 19412.24),
    "pluto": (39.48211675, 0.24882730, 17.14001206, 238.92903833, 224.06891629, 110.30393684, 1.35e8),
}


def turned(angle, vector, axis):
    c, s = numpy.cos(angle), numpy.sin(angle)
    x, y, z = vector
    return numpy.array((c * x - s * y, s * x + c * y, z) if axis == "z" else (x, c * y - s * z, s * y + c * z))


def ten_planets():
    G = 4 * pi**2
    masses, places, velocities = [1.0], [numpy.zeros(3)], [numpy.zeros(3)]
    for a, e, inclination, longitude, perihelion, node, ratio in ELEMENTS.values():
        mean, argument = radians(longitude - perihelion), radians(perihelion - node)
        E = mean
        for _ in range(50):
            E -= (E - e * numpy.sin(E) - mean) / (1 - e * numpy.cos(E))
        b, mass = (1 - e * e) ** 0.5, 1 / ratio
        n = (G * (1 + mass) / a**3) ** 0.5
        place = numpy.array((a * (numpy.cos(E) - e), a * b * numpy.sin(E), 0))
        velocity = a * n / (1 - e * numpy.cos(E)) * numpy.array((-numpy.sin(E), b * numpy.cos(E), 0))
        lay = lambda v: turned(radians(node), turned(radians(inclination), turned(argument, v, "z"), "x"), "z")
        masses.append(mass)
        places.append(lay(place))
        velocities.append(lay(velocity))
    masses, places, velocities = map(numpy.array, (masses, places, velocities))
    places -= masses @ places / masses.sum()
    velocities -= masses @ velocities / masses.sum()
    return G, masses, places, velocities, 1000.0, None


PROBLEMS = {"kepler": kepler, "pleiades": pleiades, "figure_eight": figure_eight, "ten_planets": ten_planets}
