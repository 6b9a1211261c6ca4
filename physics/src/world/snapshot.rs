//! Snapshots of a world: the states of all bodies, reactions and contacts at one moment.

use super::rest::Rest;
use crate::{Balance, BodySnapshot, ContactSnapshot, LawResidual, Loads, Model, Snapshot, State, System};

/// Creates the snapshot of a state at `time`, s. `crowd` holds the contacts of bodies in the crowd. `loads` is working memory.
pub(super) fn picture(
    system: &mut System<'_>,
    time: f64,
    state: &State,
    (balance, rest, crowd, laws): (Balance, &Rest, &[ContactSnapshot], &[LawResidual]),
    loads: &mut Loads,
) -> Snapshot {
    let model = system.model();
    system.begin(time, state);
    system.evaluate(time, state, loads);
    if model.constraints().is_empty() {
        // Joints bear the forces of the crowd, which are among the loads of their bodies then.
        push_crowd(crowd, model, loads);
    }
    model.guide(time, loads);
    let bodies = BodySnapshot::of_all(model, state, loads);
    let mut contacts = system.contacts(time, state);
    let reactions = system.reactions();
    contacts.extend(rest.contacts());
    contacts.extend(crowd);
    contacts.sort_by_key(|contact| contact.bodies);
    Snapshot { time, bodies, reactions, contacts, laws: laws.to_vec(), balance, ..Snapshot::default() }
}

/// Adds the contact forces on bodies in the crowd to their loads.
pub(super) fn push_crowd(contacts: &[ContactSnapshot], model: &Model, loads: &mut Loads) {
    for contact in contacts {
        let force = contact.force + contact.friction;
        for (body, force) in contact.bodies.into_iter().zip([-force, force]) {
            if model.inverse_mass()[body] != 0.0 {
                loads.force[body] += force;
            }
        }
    }
}
