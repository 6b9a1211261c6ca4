//! Planets about a heavy body, in Jacobi coordinates: each position is relative to the centre of mass of all inner bodies.

use glam::DVec3;

use super::super::bodies::Field;
use super::kepler;

/// A body with its position and velocity relative to the centre of mass of all bodies nearer to the heavy body.
#[derive(Clone, Copy)]
struct Planet {
    body: usize,
    mass: f64,
    /// The mass of this body and of all bodies nearer to the heavy body, kg.
    within: f64,
    place: DVec3,
    velocity: DVec3,
}

/// All bodies, ordered by their distance from the heavy body, which is first. The first entry holds the position and velocity of the
/// common centre of mass.
#[derive(Clone, Default)]
pub(super) struct Planets {
    constant: f64,
    planets: Vec<Planet>,
    /// Working memory for the positions of all bodies, and for their accelerations divided by the gravitational constant.
    places: Vec<DVec3>,
    pulls: Vec<DVec3>,
}

impl Planets {
    /// Reads the bodies from the current stage: the heaviest body first, then the other bodies by their distance from the heaviest.
    pub(super) fn read(&mut self, field: &Field<'_>) {
        let (model, stage) = (field.model, &*field.stage);
        let mass = |i: usize| model.mass()[i];
        self.constant = model.gravitation().map_or(0.0, |gravitation| gravitation.constant);
        let mut order = field.bodies.moving.clone();
        let heaviest = order.iter().copied().max_by(|&a, &b| mass(a).total_cmp(&mass(b)).then(b.cmp(&a)));
        let sun = heaviest.map_or(DVec3::ZERO, |i| stage.location[i]);
        order.sort_by(|&a, &b| {
            let far = |i: usize| if Some(i) == heaviest { -1.0 } else { stage.location[i].distance(sun) };
            far(a).total_cmp(&far(b)).then(a.cmp(&b))
        });
        self.planets.clear();
        let (mut within, mut at, mut motion) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for body in order {
            let (mass, location, velocity) = (mass(body), stage.location[body], stage.velocity[body]);
            // The position and velocity are taken relative to the centre of mass of the earlier bodies. Then this body is added to that
            // centre.
            let (place, relative) = (location - at, velocity - motion);
            within += mass;
            at += mass / within * place;
            motion += mass / within * relative;
            self.planets.push(Planet { body, mass, within, place, velocity: relative });
        }
        if let Some(first) = self.planets.first_mut() {
            (first.place, first.velocity) = (at, motion);
        }
        let count = self.planets.len();
        self.places.resize(count, DVec3::ZERO);
        self.pulls.resize(count, DVec3::ZERO);
    }

    /// Calls `see` for each body with its index, position (m) and velocity (m/s), both in world axes.
    pub(super) fn each(&self, mut see: impl FnMut(usize, DVec3, DVec3)) {
        let Some((sun, planets)) = self.planets.split_first() else { return };
        // The loop proceeds inwards from the centre of mass of all bodies.
        let (mut at, mut motion) = (sun.place, sun.velocity);
        for Planet { body, mass, within, place, velocity } in planets.iter().rev() {
            let part = mass / within;
            at -= part * *place;
            motion -= part * *velocity;
            see(*body, at + *place, motion + *velocity);
        }
        see(sun.body, at, motion);
    }

    /// Advances all bodies by `dt` (s) along their Kepler orbits about the inner masses.
    pub(super) fn drift(&mut self, dt: f64) {
        let Some((sun, planets)) = self.planets.split_first_mut() else { return };
        sun.place += dt * sun.velocity;
        for Planet { within, place, velocity, .. } in planets {
            kepler::drift(self.constant * *within, dt, place, velocity);
        }
    }

    /// Changes the velocities of the planets by the perturbations during `dt`, s: planets attract each other, and the inner masses are not
    /// at a single point.
    pub(super) fn kick(&mut self, dt: f64) {
        let Planets { constant, planets, places, pulls } = self;
        let count = planets.len();
        if count < 3 {
            return;
        }
        // The positions are relative to the centre of mass of all bodies.
        let mut at = DVec3::ZERO;
        for k in (1..count).rev() {
            let Planet { mass, within, place, .. } = planets[k];
            at -= mass / within * place;
            places[k] = at + place;
        }
        places[0] = at;
        pulls.fill(DVec3::ZERO);
        // The loop visits all pairs except the heavy body with the first planet, because the orbit of that planet includes their
        // attraction.
        for j in 2..count {
            let (here, mass) = (places[j], planets[j].mass);
            let mut own = DVec3::ZERO;
            for ((place, pull), planet) in places[..j].iter().zip(&mut pulls[..j]).zip(&planets[..j]) {
                let d = *place - here;
                let square = d.length_squared();
                let weight = 1.0 / (square * square.sqrt());
                *pull -= (mass * weight) * d;
                own += (planet.mass * weight) * d;
            }
            pulls[j] += own;
        }
        // The kicks are accelerations relative to the inner centres of mass, without the part that the Kepler orbits include.
        let factor = dt * *constant;
        let mut mean = pulls[0];
        let mut within = planets[0].mass;
        for (k, (planet, pull)) in planets.iter_mut().zip(&*pulls).enumerate().skip(1) {
            let relative = *pull - mean;
            mean = (within * mean + planet.mass * *pull) / planet.within;
            within = planet.within;
            let mut push = relative;
            if k > 1 {
                let square = planet.place.length_squared();
                push += planet.within / (square * square.sqrt()) * planet.place;
            }
            planet.velocity += factor * push;
        }
    }
}
