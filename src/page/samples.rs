//! Encodes data for the plots as little-endian 64-bit numbers.

use std::io;

use glam::DVec3;

use super::numbers::{put, put_balance};
use super::run::PageRun;
use crate::physics::{BodySnapshot, RigidBody};

/// Encodes the energy and momentum balance of each frame, in the layout of [`put_balance`].
pub(super) fn balance(run: &PageRun, frames: impl Iterator<Item = usize>) -> io::Result<Vec<u8>> {
    let (recording, mut all) = (run.recording(), Vec::new());
    let mut reader = recording.read();
    for frame in frames {
        // Reading one body is faster than reading all of them.
        let (moment, _) = reader.body(frame, 0)?;
        let impacts =
            if run.scene.simulation.contacts.is_some() { moment.impacts.of_run() } else { f64::NAN };
        put_balance(&mut all, moment.time, &moment.balance, impacts);
    }
    Ok(all)
}

/// Encodes the motion of a body in each frame: the time; location, velocity, angular velocity and net force, with 3 numbers each; the
/// kinetic energy; the number of impacts. While the body is absent, all numbers except the time are NaN. Without contacts, the number of
/// impacts is NaN.
pub(super) fn of_body(
    run: &PageRun,
    body: usize,
    frames: impl Iterator<Item = usize>,
) -> io::Result<Vec<u8>> {
    let rigid = &run.scene.bodies[body].start;
    let (recording, mut all) = (run.recording(), Vec::new());
    let mut reader = recording.read();
    for frame in frames {
        put(&mut all, &[run.scene.simulation.timeline.time(frame)]);
        let (moment, at) = reader.body(frame, body)?;
        let Some(at) = at else {
            put(&mut all, &[f64::NAN; 14]);
            continue;
        };
        let counts_impacts = run.scene.simulation.contacts.is_some();
        let impacts = if counts_impacts { moment.impacts.of_body(body) } else { f64::NAN };
        let vectors =
            [at.location, at.velocity, at.angular_velocity, at.force].map(|vector| vector.to_array());
        put(&mut all, vectors.as_flattened());
        put(&mut all, &[kinetic(rigid, &at), impacts]);
    }
    Ok(all)
}

/// Encodes the contacts of a body in each frame, with 11 numbers for each contact: the index of the frame, that of the other body, the point
/// of contact, the normal force on the body, and the friction on it. The ground has the index after that of the last body.
pub(super) fn contacts_of(
    run: &PageRun,
    body: usize,
    frames: impl Iterator<Item = usize>,
) -> io::Result<Vec<u8>> {
    let (recording, mut all) = (run.recording(), Vec::new());
    let mut reader = recording.read();
    for frame in frames {
        let moment = reader.seen(frame)?;
        for contact in moment.contacts.iter().filter(|contact| contact.bodies.contains(&body)) {
            let [first, second] = contact.bodies;
            // The forces are those on the second body.
            let (other, sign) = if body == first { (second, -1.0) } else { (first, 1.0) };
            put(&mut all, &[frame as f64, other as f64]);
            put(&mut all, &contact.place.to_array());
            put(&mut all, &(sign * contact.force).to_array());
            put(&mut all, &(sign * contact.friction).to_array());
        }
    }
    Ok(all)
}

/// Returns the kinetic energy of a body, translational and rotational, J.
fn kinetic(body: &RigidBody, at: &BodySnapshot) -> f64 {
    if body.fixed || body.mass <= 0.0 {
        return 0.0;
    }
    let of_principal_axes = at.orientation * body.principal_axes;
    let spin = of_principal_axes.inverse() * at.angular_velocity;
    0.5 * (body.mass * at.velocity.length_squared() + (body.inertia * spin * spin).dot(DVec3::ONE))
}

#[cfg(test)]
mod tests {
    use super::super::numbers::{NUMBERS_PER_BALANCE, NUMBERS_PER_CONTACT, NUMBERS_PER_SAMPLE};
    use super::*;
    use crate::Scene;

    /// An absent body has a time and no other numbers. So each frame keeps its position in the list.
    #[test]
    fn a_body_that_is_not_there_has_no_numbers() {
        let text = "simulation.duration = 0.4\n[body.a]\nshape.sphere.radius = 1\nstart = 0.2\nvelocity = [1, 0, 0]\n";
        let scene = Scene::parse(text).unwrap();
        let run = PageRun::whole(scene);
        let bytes = of_body(&run, 0, 0..11).unwrap();
        let numbers: Vec<f64> =
            bytes.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap())).collect();
        assert_eq!(numbers.len(), 11 * NUMBERS_PER_SAMPLE);
        for (frame, of_frame) in numbers.chunks(NUMBERS_PER_SAMPLE).enumerate() {
            assert_eq!(of_frame[0], run.scene.simulation.timeline.time(frame));
            assert_eq!(of_frame[1..14].iter().all(|number| number.is_nan()), frame < 5, "{frame}");
        }
    }

    /// The ball hits the ground once within 0.4 s: it falls 0.2 m in 0.202 s.
    #[test]
    fn impacts_are_counted_where_there_are_contacts() {
        let text = "simulation = { duration = 0.4, gravity = [0, -9.81, 0], contacts = 'event-driven', integrator = 'rk4' }
            [body.ball]\nshape.sphere.radius = 0.1\nlocation = [0, 0.3, 0]\nrestitution = 1
            [body.far]\nshape.sphere.radius = 0.1\nlocation = [1, 5, 0]\n";
        let scene = Scene::parse(text).unwrap();
        let run = PageRun::whole(scene);
        let last = |bytes: Vec<u8>, size: usize| -> Vec<f64> {
            let numbers = bytes.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap()));
            numbers.skip(size - 1).step_by(size).collect()
        };
        let expected: Vec<f64> = (0..11).map(|frame| f64::from(u8::from(frame > 5))).collect();
        assert_eq!(last(balance(&run, 0..11).unwrap(), NUMBERS_PER_BALANCE), expected);
        assert_eq!(last(of_body(&run, 0, 0..11).unwrap(), NUMBERS_PER_SAMPLE), expected);
        assert_eq!(last(of_body(&run, 1, 0..11).unwrap(), NUMBERS_PER_SAMPLE), [0.0; 11]);
    }

    /// A crate of 8 kg rests on the ground, and a force pulls it along with 10 N. The ground holds it with its weight and with friction.
    #[test]
    fn contacts_hold_a_body_with_its_weight_and_with_friction() {
        let text = "simulation = { duration = 1, gravity = [0, -10, 0], contacts = 'event-driven' }
            [body.crate]\nshape.box.size = [1, 1, 1]\nmass = 8\nlocation = [0, 0.5, 0]\nfriction = 0.5
            [body.far]\nshape.sphere.radius = 0.1\nlocation = [9, 5, 0]
            [force.pull.constant]\nforce = [10, 0, 0]\non = ['crate']\n";
        let scene = Scene::parse(text).unwrap();
        let run = PageRun::whole(scene);
        let numbers: Vec<f64> = contacts_of(&run, 0, 20..21)
            .unwrap()
            .chunks_exact(8)
            .map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap()))
            .collect();
        let (contacts, rest) = numbers.as_chunks::<NUMBERS_PER_CONTACT>();
        assert!(rest.is_empty() && !contacts.is_empty());
        let mut sum = [0.0; 6];
        for contact in contacts {
            let [frame, other, _, height, _, forces @ ..] = contact;
            assert_eq!((*frame, *other), (20.0, 2.0));
            assert!(height.abs() < 1e-9, "{height}");
            sum.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
        }
        let expected = [0.0, 80.0, 0.0, -10.0, 0.0, 0.0];
        assert!(sum.iter().zip(expected).all(|(sum, force)| (sum - force).abs() < 1e-6), "{sum:?}");
        assert!(contacts_of(&run, 1, 20..21).unwrap().is_empty());
    }

    /// The sum of the kinetic energies of all bodies equals the kinetic energy of the run.
    #[test]
    fn the_energy_of_a_body_is_its_share_of_the_whole() {
        let scene = Scene::parse(
            "
            [simulation]
            duration = 0.4
            gravity = [0, -9.81, 0]
            [body.box]
            shape.box.size = [3, 1, 2]
            orientation = [10, 20, 30]
            angular_velocity = [0.1, 0.2, 5]
            [body.hammer]
            velocity = [1, 2, 3]
            angular_velocity = [3, 1, 0.2]
            shape.compound.parts = [
              { cylinder = { radius = 0.1, height = 1 } },
              { box.size = [0.4, 0.2, 0.1], location = [0.1, 0.5, 0] },
            ]
            ",
        )
        .unwrap();
        let run = PageRun::whole(scene);
        let numbers = |bytes: Vec<u8>| -> Vec<f64> {
            bytes.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap())).collect()
        };
        let whole = numbers(balance(&run, 0..11).unwrap());
        let [first, second] = [0, 1].map(|body| numbers(of_body(&run, body, 0..11).unwrap()));
        assert_eq!((whole.len(), first.len()), (11 * NUMBERS_PER_BALANCE, 11 * NUMBERS_PER_SAMPLE));
        for frame in 0..11 {
            assert_eq!(whole[frame * NUMBERS_PER_BALANCE], first[frame * NUMBERS_PER_SAMPLE]);
            let (sum, kinetic) = (
                first[frame * NUMBERS_PER_SAMPLE + 13] + second[frame * NUMBERS_PER_SAMPLE + 13],
                whole[frame * NUMBERS_PER_BALANCE + 1],
            );
            assert!((sum - kinetic).abs() < 1e-12 * kinetic, "{sum} {kinetic}");
        }
    }
}
