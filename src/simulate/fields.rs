//! The field of a force at any point, for drawings.

use glam::DVec3;

use super::particles::{Sources, field};
use crate::physics::{BodyId, BodySnapshot, Dipoles, TestParticle, find};
use crate::scene::{DrawnField, ForceKind, Scene};

/// A body that causes a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSource {
    /// The index of the body in the scene.
    pub body: usize,
    /// The strength of the source: positive where field lines begin, negative where they end. A magnet has 0, since its lines are closed.
    pub strength: f64,
}

/// Computes the field of a force at points of space.
#[derive(Clone, Debug)]
pub struct FieldSampler {
    cause: Cause,
    sources: Vec<FieldSource>,
}

/// What a field consists of.
#[derive(Clone, Debug)]
enum Cause {
    /// The force on a body of 1 kg and 1 C at rest.
    Force(Box<TestParticle>),
    /// A uniform magnetic field, T.
    Uniform(DVec3),
    /// The magnetic field of magnets, with the bodies of the last moment.
    Magnets(Dipoles, Vec<BodySnapshot>),
}

impl FieldSampler {
    /// Prepares the field that a drawing shows. `None` for a force that has no field, such as a spring.
    pub fn new(scene: &Scene, drawn: &DrawnField) -> Option<FieldSampler> {
        let force = &scene.forces[drawn.force];
        let source = |body: &BodyId, strength: f64| FieldSource { body: body.index(), strength };
        let start = |body: &BodyId| &scene.bodies[body.index()].start;
        let (cause, sources) = match &force.kind {
            ForceKind::OnEach(force) if drawn.is_magnetic => {
                (Cause::Uniform(force.magnetic_field()?), Vec::new())
            }
            ForceKind::Dipoles(dipoles) => {
                let bodies = dipoles.bodies.iter().chain(dipoles.against.iter().flatten());
                let sources = bodies.map(|body| source(body, 0.0)).collect();
                (Cause::Magnets(dipoles.clone(), Vec::new()), sources)
            }
            kind => {
                let field = field(scene, force, 0.0, Sources::BothGroups)?;
                let cause = Cause::Force(Box::new(TestParticle::new(&field)));
                let sources = match kind {
                    ForceKind::Between(between) => {
                        let of = |body: &BodyId| source(body, between.source_strength(start(body)));
                        force.kind.bodies().iter().map(of).filter(|source| source.strength != 0.0).collect()
                    }
                    _ => Vec::new(),
                };
                (cause, sources)
            }
        };
        Some(FieldSampler { cause, sources })
    }

    /// Returns the bodies that cause the field. Empty for a field without sources, such as a uniform one.
    pub fn sources(&self) -> &[FieldSource] {
        &self.sources
    }

    /// Moves the sources to where they are at a time (s).
    pub fn follow(&mut self, time: f64, bodies: &[BodySnapshot]) {
        match &mut self.cause {
            Cause::Force(particle) => particle.follow(time, bodies),
            Cause::Uniform(_) => {}
            Cause::Magnets(dipoles, at) => {
                let all = dipoles.bodies.iter().chain(dipoles.against.iter().flatten());
                *at = all.filter_map(|body| find(bodies, body.index()).copied()).collect();
                at.sort_by_key(|body| body.id);
            }
        }
    }

    /// Returns the field at a point (m): the force on 1 kg and 1 C (N), or the magnetic field (T).
    pub fn at(&mut self, point: DVec3) -> DVec3 {
        match &mut self.cause {
            Cause::Force(particle) => particle.force_at(point),
            Cause::Uniform(field) => *field,
            Cause::Magnets(dipoles, bodies) => dipoles.field_at(point, bodies),
        }
    }

    /// Returns the potential at a point (m), J. Magnetic fields have none.
    pub fn potential(&mut self, point: DVec3) -> f64 {
        match &mut self.cause {
            Cause::Force(particle) => particle.potential_at(point),
            Cause::Uniform(_) | Cause::Magnets(..) => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::Frames;

    fn sampler(text: &str) -> FieldSampler {
        let scene = Scene::parse(&format!("simulation.duration = 0\n{text}")).unwrap();
        let frame = Frames::new(&scene).next().unwrap().unwrap();
        let mut sampler = FieldSampler::new(&scene, &scene.fields[0]).unwrap();
        sampler.follow(frame.time, &frame.bodies);
        sampler
    }

    /// Two charges on an axis: E = k (q₁/r₁² + q₂/r₂²), φ = k (q₁/r₁ + q₂/r₂).
    #[test]
    fn the_field_of_charges_follows_coulomb() {
        let mut field = sampler(
            "[body.a]\nshape.sphere.radius = 0.1\ncharge = 3e-6\n
            [body.b]\nshape.sphere.radius = 0.1\ncharge = -1e-6\nlocation = [2, 0, 0]\n
            [force.q.coulomb]\n[field.e]\nforce = 'q'",
        );
        let k = crate::physics::Coulomb::CONSTANT;
        let found = field.at(DVec3::new(3.0, 0.0, 0.0));
        let expected = k * (3e-6 / 9.0 - 1e-6);
        assert!((found.x - expected).abs() < 1e-9 * expected.abs() && found.y == 0.0, "{found}");
        let potential = field.potential(DVec3::new(0.0, 1.0, 0.0));
        let expected = k * (3e-6 - 1e-6 / 5.0_f64.sqrt());
        assert!((potential - expected).abs() < 1e-9 * expected, "{potential}, not {expected}");
        let strengths: Vec<f64> = field.sources().iter().map(|source| source.strength).collect();
        assert_eq!(strengths, [3e-6, -1e-6]);
    }

    /// A scene that is turned and shifted has the turned field, whatever the names and the order of its bodies are.
    #[test]
    fn the_field_depends_on_no_axes_origin_or_order() {
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
        let shift = DVec3::new(40.0, -7.0, 3.0);
        let places = [DVec3::ZERO, DVec3::new(2.0, 0.5, -1.0), DVec3::new(-1.0, 1.0, 0.0)];
        let charges = [3e-6, -1e-6, 2e-6];
        let text = |order: [usize; 3], place: &dyn Fn(DVec3) -> DVec3| {
            let bodies = order.map(|k| {
                let [x, y, z] = place(places[k]).to_array();
                let charge = charges[k];
                format!("[body.b{k}]\nshape.sphere.radius = 0.1\nlocation = [{x}, {y}, {z}]\ncharge = {charge:e}\n")
            });
            format!("{}[force.q.coulomb]\n[field.e]\nforce = 'q'", bodies.concat())
        };
        let mut plain = sampler(&text([0, 1, 2], &|place| place));
        let mut turned = sampler(&text([2, 0, 1], &|place| turn * place + shift));
        for point in [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.2, 0.1), DVec3::new(0.5, -0.5, 0.5)] {
            let (expected, found) = (turn * plain.at(point), turned.at(turn * point + shift));
            assert!(found.abs_diff_eq(expected, 1e-11 * expected.length()), "{found}, not {expected}");
            let [one, other] = [plain.potential(point), turned.potential(turn * point + shift)];
            assert!((one - other).abs() < 1e-11 * one.abs().max(1e4), "{one}, {other}");
        }
    }

    /// The field of gravitation points to the masses, of both groups if there are two.
    #[test]
    fn the_field_of_masses_follows_newton() {
        let mut field = sampler(
            "[body.a]\nshape.sphere.radius = 0.1\nmass = 4\n
            [body.b]\nshape.sphere.radius = 0.1\nmass = 1\nlocation = [3, 0, 0]\n
            [force.g.gravitation]\nbetween = [['a'], ['b']]\nconstant = 2\n[field.g]\nforce = 'g'",
        );
        // At x = 2, 4/2² − 1/1² = 0.
        assert!(field.at(DVec3::new(2.0, 0.0, 0.0)).length() < 1e-12);
        let found = field.at(DVec3::new(0.0, 0.0, 2.0));
        let far = 13.0 * 13.0_f64.sqrt();
        assert!(found.abs_diff_eq(2.0 * DVec3::new(3.0 / far, 0.0, -1.0 - 2.0 / far), 1e-12), "{found}");
    }

    /// On its axis, a magnet has the field 2 k m/r³; beside it, −k m/r³.
    #[test]
    fn the_field_of_a_magnet_is_that_of_a_dipole() {
        let mut field = sampler(
            "[body.a]\nshape.sphere.radius = 0.1\nmagnetic_moment = [0, 5, 0]\n
            [body.b]\nshape.sphere.radius = 0.1\nmagnetic_moment = [0, 1e-9, 0]\nlocation = [99, 0, 0]\n
            [force.m.dipoles]\n[field.b]\nforce = 'm'",
        );
        let k = Dipoles::CONSTANT;
        let [above, beside] = [DVec3::Y, DVec3::X].map(|way| field.at(2.0 * way));
        assert!((above - DVec3::Y * 2.0 * k * 5.0 / 8.0).length() < 1e-12 * k, "{above}");
        assert!((beside + DVec3::Y * k * 5.0 / 8.0).length() < 1e-12 * k, "{beside}");
    }

    #[test]
    fn crossed_fields_are_both_to_be_had() {
        let of = |key: &str| {
            sampler(&format!(
                "[body.a]\nshape.sphere.radius = 0.1\ncharge = 1\n
                [force.f.lorentz]\nelectric = [0, 2, 0]\nmagnetic = [0, 0, 3]\n[field.f]\nforce = 'f'\n{key}"
            ))
            .at(DVec3::ONE)
        };
        assert_eq!(of(""), DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(of("magnetic = true"), DVec3::new(0.0, 0.0, 3.0));
    }
}
