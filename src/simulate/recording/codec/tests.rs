use glam::{DQuat, DVec3};

use super::super::super::simulation::Entry;
use super::super::events::{CONTACT_NUMBERS, LAW_NUMBERS};
use super::*;
use crate::physics::{
    Balance, BodySnapshot, ContactSnapshot, Impact, LawResidual, MotionLaw, Reaction, Snapshot,
};

const COUNTS: Counts = Counts { bodies: 3, joints: 2, impacts: 5 };

fn entry(time: f64, bodies: &[(usize, f64)]) -> Entry {
    let body = |&(id, x): &(usize, f64)| BodySnapshot {
        id,
        location: DVec3::new(x, -0.0, 1.0),
        orientation: DQuat::IDENTITY,
        velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        force: DVec3::new(0.0, x, 0.0),
    };
    let balance = Balance {
        kinetic: 1.0,
        given_kinetic: 1.5,
        potential: 2.0,
        total: 3.0,
        error: 4.5,
        drift: 4.0,
        linear_momentum: DVec3::X,
        angular_momentum: DVec3::Y,
        accounts: Accounts { work: 5.0, motors: 6.0, limits: -7.0, impacts: -8.0, friction: -9.0 },
    };
    let frame = (time > 1.5).then_some(7);
    let reactions = vec![
        Reaction::default(),
        Reaction {
            force: DVec3::new(0.0, -0.0, 3.0),
            torque: DVec3::splat((time - 1.5).max(0.0)),
            motor: -time,
        },
    ];
    let vector = |n: f64| DVec3::new(n, -0.0, time);
    let (place, normal) = (vector(1.0), vector(2.0));
    let contact =
        ContactSnapshot { bodies: [1, 2], place, normal, force: vector(3.0), friction: vector(4.0) };
    let impact = Impact { time, bodies: [0, 3], place, normal, impulse: vector(5.0), energy: 6.0 };
    let law =
        LawResidual { law: MotionLaw::AngularMomentum, time, bodies: [1, 2], amount: 0.5 * time, part: 1e-3 };
    Entry {
        frame,
        snapshot: Snapshot {
            time,
            bodies: bodies.iter().map(body).collect(),
            reactions,
            angles: vec![0.0, 7.0 * time],
            contacts: vec![contact; usize::from(time > 0.5)],
            penetration: 0.25 * time,
            laws: vec![law; usize::from(time > 0.5)],
            balance,
        },
        impacts: vec![impact; usize::from(time > 1.5) * 2],
        counts: ImpactCounts(vec![time.floor(), 0.0, -0.0, 7.0, time]),
    }
}

/// Bodies appear and disappear, -0 stays -0, and unchanged values take no bytes except those of their run.
#[test]
fn moments_are_read_as_they_were_written() {
    let entries = [
        entry(0.0, &[(0, 1.0), (2, 2.0)]),
        entry(1.0, &[(0, 1.0), (2, 2.0)]),
        entry(2.0, &[(1, 3.0), (2, 4.0)]),
        entry(3.0, &[]),
    ];
    let (mut encoder, mut page, mut sizes) = (Encoder::new(COUNTS), Vec::new(), Vec::new());
    for entry in &entries {
        let before = page.len();
        encoder.encode(entry, &mut page);
        sizes.push(page.len() - before);
    }
    let head = 4 + 8 * NUMBERS_PER_HEADER + 4;
    let of_counts = 4 + 3 * 5 + 2 * 8;
    let of_contacts = 4 + 8 * CONTACT_NUMBERS + 4 + 4 + 8 * LAW_NUMBERS;
    let bodies_and_joints = 3 * 5 + 4 + 2 * 5 + 2 * 8;
    assert_eq!(
        sizes[1],
        head + bodies_and_joints + of_counts + of_contacts,
        "present, absent, present; of two joints, the motor and the angle of the second; of five counts, the first and the last; one contact, one law"
    );
    let mut decoder = Decoder::new(COUNTS);
    for entry in &entries {
        let found = decoder.decode(&page).unwrap();
        assert_eq!(found, *entry);
        for (a, b) in found.snapshot.bodies.iter().zip(&entry.snapshot.bodies) {
            assert_eq!(a.location.y.to_bits(), b.location.y.to_bits());
        }
    }
    assert!(decoder.decode(&page).is_err(), "after the end");
    let mut decoder = Decoder::new(COUNTS);
    for entry in &entries {
        let (found, is_there) = decoder.decode_one(&page, 2).unwrap();
        let expected: Vec<_> = entry.snapshot.bodies.iter().filter(|body| body.id == 2).copied().collect();
        assert_eq!((found.snapshot.bodies, is_there), (expected.clone(), !expected.is_empty()));
    }
}

#[test]
fn what_is_cut_or_changed_never_panics() {
    let mut page = Vec::new();
    let mut encoder = Encoder::new(COUNTS);
    for entry in [entry(0.0, &[(0, 1.0), (2, 2.0)]), entry(2.0, &[(1, 3.0)])] {
        encoder.encode(&entry, &mut page);
    }
    for cut in 0..page.len() {
        let mut decoder = Decoder::new(COUNTS);
        while decoder.decode(&page[..cut]).is_ok() {}
    }
    for at in 0..page.len() {
        let mut changed = page.clone();
        changed[at] ^= 0xff;
        for wanted in 0..3 {
            let mut decoder = Decoder::new(COUNTS);
            (0..2).for_each(|_| drop(decoder.decode_one(&changed, wanted)));
        }
        let mut decoder = Decoder::new(COUNTS);
        (0..2).for_each(|_| drop(decoder.decode(&changed)));
    }
}
