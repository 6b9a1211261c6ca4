//! Computes the digest that identifies a run: it covers everything that affects the motion of bodies.

use std::fmt::{self, Write};

use sha2::{Digest, Sha256};

use crate::scene::{Body, Force, ForceKind, Joint, Scene, SimulationSettings};
use crate::simulate::{self, Moments};

/// The SHA-256 that identifies a run.
pub(super) type CacheKey = [u8; 32];

/// Returns the digest of everything that affects the recording of a run: the causes of motion, the recorded moments, and the program
/// itself. Looks, cameras, labels and names do not affect it.
pub(super) fn of(scene: &Scene, moments: &Moments) -> CacheKey {
    let mut text = Text(Sha256::new());
    // Writing cannot fail, since a digest accepts all bytes.
    let _: fmt::Result = write_all(&mut text, scene, moments);
    text.0.finalize().into()
}

/// Each pattern names all fields, so that a new field cannot be forgotten: the compiler asks whether it affects the motion.
fn write_all(text: &mut impl Write, scene: &Scene, moments: &Moments) -> fmt::Result {
    // Numbers are written by `Debug`, since different numbers then have different texts.
    writeln!(text, "{} {moments:?}", env!("JABUKA_BUILD"))?;
    let Scene {
        simulation,
        bodies,
        forces,
        joints,
        pairs,
        // Of the surroundings, only the ground stops bodies; see `ground_that_stops`.
        environment: _,
        // Particles move no body. Their motion is computed from the recording.
        emitters: _,
        materials: _,
        color_maps: _,
        value_maps: _,
        conditions: _,
        camera: _,
        views: _,
        lights: _,
        labels: _,
        plots: _,
        angles: _,
        distances: _,
        areas: _,
        fields: _,
        measures: _,
        arrow_marks: _,
        approaches: _,
        file_columns: _,
        aggregates: _,
        scale_bar: _,
        grid: _,
        variable_sliders: _,
        handles: _,
        povray: _,
        output: _,
        name: _,
        title: _,
        digest: _,
        places: _,
        overrides: _,
        warnings: _,
    } = scene;

    let SimulationSettings { timeline, step, tolerance, method, gravity, contacts } = simulation;
    let tolerance = method.adaptive.then_some(tolerance);
    writeln!(text, "{timeline:?} {step:?} {tolerance:?}")?;
    writeln!(text, "{} {gravity:?}", method.name)?;
    writeln!(text, "{contacts:?} {:?} {pairs:?}", contacts.and(scene.ground_that_stops()))?;
    // A run that shows no contact forces may lack contacts.
    writeln!(text, "{}", simulate::lists_contacts(scene))?;
    for body in bodies {
        let Body {
            start,
            presence,
            motion,
            shape,
            collider,
            // The forces between dipoles contain the magnetic moments.
            magnetic_moment: _,
            name: _,
            material: _,
            look: _,
            // `moments` contains the times of ghosts.
            showing: _,
        } = body;
        writeln!(text, "{start:?} {presence:?} {motion:?}")?;
        if contacts.is_some() {
            // Shapes affect the motion only if bodies can touch.
            writeln!(text, "{shape:?} {collider:?}")?;
        }
    }
    for Force { name: _, kind, emitters: _, arrow: _ } in forces {
        match kind {
            ForceKind::Spring { links, look: _ } => writeln!(text, "{links:?}")?,
            ForceKind::Buoyancy { liquid, surface: _ } => writeln!(text, "{liquid:?}")?,
            kind => writeln!(text, "{kind:?}")?,
        }
    }
    for Joint { name: _, kind, servo, collides, look: _, arrows: _ } in joints {
        writeln!(text, "{kind:?} {servo:?} {collides}")?;
    }
    Ok(())
}

/// Returns true if forces move a body. Otherwise, all motion is prescribed, and computing it is faster than reading it from the cache.
pub(super) fn is_worth_keeping(scene: &Scene) -> bool {
    scene.bodies.iter().any(|body| !body.start.fixed && body.motion.is_none())
}

/// A writer that computes the digest of a text and does not store the text.
struct Text(Sha256);

impl Write for Text {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        self.0.update(piece.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod keys;

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(text: &str) -> CacheKey {
        let scene = Scene::parse(text).unwrap();
        of(&scene, &Moments::of(&scene))
    }

    #[test]
    fn all_that_moves_bodies_counts_and_nothing_else() {
        let scene = |extra: &str| {
            format!(
                "{extra}\n[body.a]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n[body.b]\nshape.sphere.radius = 1\n\
                 motion.formula.location = ['3 + t', 0, 0]\n[force.s.spring]\nbetween = ['a', [0, 0, 0]]\nstiffness = 3\n"
            )
        };
        let plain = digest(&scene(""));
        assert_eq!(plain, digest(&scene("")), "it is the same for the same");
        for same in [
            "title = 'x'",
            "[camera]\nlocation = [0, 0, 20]\nlook_at = [0, 0, 0]",
            "[label.x]\ntext = 'hello'",
            "output.size = [320, 180]",
        ] {
            assert_eq!(plain, digest(&scene(same)), "{same}");
        }
        for (from, to) in [
            ("radius = 1", "radius = 2"),
            ("velocity = [1, 0", "velocity = [1.0000000000000002, 0"),
            ("'3 + t'", "'3 + 2*t'"),
            ("'3 + t'", "'4 + t'"),
            ("[body.b]", "[body.b]\nstart = 2"),
            ("stiffness = 3", "stiffness = 4"),
            ("['a', [0, 0, 0]]", "['a', [0, 1, 0]]"),
        ] {
            assert_ne!(plain, digest(&scene("").replace(from, to)), "{to}");
        }
        for other in [
            "simulation.gravity = [0, -1, 0]",
            "simulation.step = 0.001",
            "simulation.integrator = 'rk4'",
            "simulation.duration = 3",
            "simulation.frame_rate = 30",
            "camera.shutter = 0.01",
        ] {
            assert_ne!(plain, digest(&scene(other)), "{other}");
        }
    }

    /// The recording contains the impacts of the pairs of bodies that labels count.
    #[test]
    fn a_label_that_counts_the_impacts_of_a_pair_counts() {
        let scene = |text: &str| {
            digest(&format!(
                "simulation.contacts = 'event-driven'\n[body.ball]\nshape.sphere.radius = 1\nlocation = [0, 3, 0]\n\
                 [label.a]\ntext = '{text}'\n"
            ))
        };
        assert_eq!(scene("${t}"), scene("${impacts}"));
        assert_ne!(scene("${t}"), scene("${ball.impacts.ground}"));
    }

    /// The digest must not contain memory addresses, since they differ between processes.
    #[test]
    fn no_address_is_in_what_is_digested() {
        let scene = Scene::parse(
            "
            simulation.integrator = 'rk4'
            [body.a]
            shape.sphere.radius = 1
            [body.b]
            shape.sphere.radius = 1
            motion.formula.location = ['3 + sin(t) * hypot(t, 2)', 'uniform(0, 1)', 'clamp(t, 0, 1)']
            [force.all.gravitation]
            [force.air.drag]
            linear = 0.1
            ",
        )
        .unwrap();
        let mut text = String::new();
        write_all(&mut text, &scene, &Moments::of(&scene)).unwrap();
        assert!(text.contains("Sin") && !text.contains("0x"), "{text}");
    }
}
