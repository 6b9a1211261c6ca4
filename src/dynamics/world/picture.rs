//! What can be seen of a world at one moment.

use super::rest::Rest;
use crate::dynamics::{Balance, BodySnapshot, ContactSnapshot, Loads, Model, Snapshot, State, System};

/// All that can be known of a moment; `loads` is room to work in.
pub(super) fn picture(
    system: &mut System<'_>,
    time: f64,
    state: &State,
    (balance, rest, crowd): (Balance, &Rest, &[ContactSnapshot]),
    loads: &mut Loads,
) -> Snapshot {
    let model = system.model();
    system.begin(time, state);
    system.evaluate(time, state, loads);
    push_crowd(crowd, model, loads);
    model.guide(time, loads);
    let body = |id: usize| BodySnapshot {
        id,
        location: state.location[id],
        orientation: model.world_from_body(id, state),
        velocity: state.velocity[id],
        angular_velocity: model.angular_velocity(id, state),
        force: loads.force[id],
    };
    let reactions = system.reactions();
    let present = (0..state.len()).filter(|&id| model.is_present(id));
    let mut contacts = system.contacts();
    contacts.extend(rest.contacts());
    contacts.extend(crowd);
    contacts.sort_by_key(|contact| contact.bodies);
    Snapshot { time, bodies: present.map(body).collect(), reactions, contacts, penetration: 0.0, balance }
}

/// Adds the forces at contacts of the crowd to the loads.
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
