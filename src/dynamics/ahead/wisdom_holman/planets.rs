//! Planets about a heavy body, in Jacobi coordinates.

use glam::DVec3;

use super::super::bodies::Field;
use super::kepler;

/// A body relative to the centre of mass of all those nearer to the heavy one.
#[derive(Clone, Copy)]
struct Planet {
    body: usize,
    mass: f64,
    /// Its mass plus those of all nearer bodies, kg.
    within: f64,
    place: DVec3,
    velocity: DVec3,
}

/// All bodies, the heavy one first. The position and velocity of the first are those of the centre of mass of all.
#[derive(Clone, Default)]
pub(super) struct Planets {
    constant: f64,
    planets: Vec<Planet>,
    /// Working memory for the positions, accelerations and masses of all bodies.
    places: Vec<DVec3>,
    pulls: Vec<DVec3>,
}

impl Planets {
    /// Reads the bodies from a field's stage, the heaviest first, then by distance.
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
            // Relative to the centre of the bodies before; then that centre is updated with this one.
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

    /// Calls `see` for each body with its position and velocity in the world.
    pub(super) fn each(&self, mut see: impl FnMut(usize, DVec3, DVec3)) {
        let Some((sun, planets)) = self.planets.split_first() else { return };
        // From the centre of mass of all bodies inwards.
        let (mut at, mut motion) = (sun.place, sun.velocity);
        for Planet { body, mass, within, place, velocity } in planets.iter().rev() {
            let part = mass / within;
            at -= part * *place;
            motion -= part * *velocity;
            see(*body, at + *place, motion + *velocity);
        }
        see(sun.body, at, motion);
    }

    /// Advances all bodies along their orbits about the inner masses, for `dt`, s.
    pub(super) fn drift(&mut self, dt: f64) {
        let Some((sun, planets)) = self.planets.split_first_mut() else { return };
        sun.place += dt * sun.velocity;
        for Planet { within, place, velocity, .. } in planets {
            kepler::drift(self.constant * *within, dt, place, velocity);
        }
    }

    /// Kicks the planets for `dt`, s, with the perturbations: they attract each other, and the inner masses are not at one point.
    pub(super) fn kick(&mut self, dt: f64) {
        let Planets { constant, planets, places, pulls } = self;
        let count = planets.len();
        if count < 3 {
            return;
        }
        // Positions relative to the centre of mass of all.
        let mut at = DVec3::ZERO;
        for k in (1..count).rev() {
            let Planet { mass, within, place, .. } = planets[k];
            at -= mass / within * place;
            places[k] = at + place;
        }
        places[0] = at;
        pulls.fill(DVec3::ZERO);
        // All pairs except the heavy body and the first planet, whose orbit includes their attraction.
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
        // Accelerations relative to the inner centres of mass.
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
