//! The energy error of a whole run, and the energy that it is compared with.

use serde::{Deserialize, Serialize};

use crate::dynamics::Balance;
use crate::scene::ContactLaw;

/// The energy that the energy error of a run is relative to.
///
/// Usually this is the largest kinetic energy. With time-stepping, bodies that only settle hardly move. Their contacts take more energy
/// than the bodies ever have as kinetic energy, and the error is relative to the energy taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EnergyScale {
    /// The largest kinetic energy in any frame.
    #[default]
    LargestKinetic,
    /// The energy that impacts and friction took from the bodies in the whole run.
    TakenByContacts,
}

impl EnergyScale {
    /// The name of the scale, as it follows "of the" in a message.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            EnergyScale::LargestKinetic => "largest kinetic energy",
            EnergyScale::TakenByContacts => "energy that contacts took",
        }
    }

    /// Whether the energy error is relative to the largest kinetic energy.
    pub(crate) fn is_largest_kinetic(&self) -> bool {
        *self == EnergyScale::LargestKinetic
    }
}

/// Finds the largest energy error of a run, and its scale, from the energy balance of each frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnergyError {
    /// The error with the largest magnitude so far, J.
    pub(crate) largest: f64,
    /// The largest kinetic energy so far, J.
    pub(crate) largest_kinetic: f64,
    /// The energy that contacts have taken so far, J.
    taken: f64,
}

impl EnergyError {
    /// Adds the balance of the next frame. Returns the energy error of this frame, J.
    pub(crate) fn add(&mut self, balance: &Balance) -> f64 {
        self.largest_kinetic = self.largest_kinetic.max(balance.kinetic);
        self.taken = balance.accounts.taken_by_contacts();
        let error = balance.drift * self.largest_kinetic;
        if error.abs() > self.largest.abs() {
            self.largest = error;
        }
        error
    }

    /// The scale of the error of the whole run, and its energy, J. `contacts` is how the scene treats contacts.
    pub(crate) fn scale(&self, contacts: Option<ContactLaw>) -> (EnergyScale, f64) {
        if contacts == Some(ContactLaw::TimeStepping) && self.taken > self.largest_kinetic {
            (EnergyScale::TakenByContacts, self.taken)
        } else {
            (EnergyScale::LargestKinetic, self.largest_kinetic)
        }
    }

    /// The largest error relative to the energy of its scale; 0 if nothing moved.
    pub(crate) fn drift(&self, contacts: Option<ContactLaw>) -> f64 {
        let (_, energy) = self.scale(contacts);
        if energy > 0.0 { self.largest / energy } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Accounts;

    /// The balance of a frame with a kinetic energy (J), an energy taken by impacts (J), and a drift.
    fn balance(kinetic: f64, taken: f64, drift: f64) -> Balance {
        let accounts = Accounts { impacts: -taken, ..Accounts::default() };
        Balance { kinetic, accounts, drift, ..Balance::default() }
    }

    #[test]
    fn bodies_that_settle_are_compared_with_what_contacts_took() {
        let mut error = EnergyError::default();
        error.add(&balance(2.0, 0.0, 0.0));
        assert_eq!(error.add(&balance(1.0, 8.0, 0.5)), 1.0);
        let stepped = Some(ContactLaw::TimeStepping);
        assert_eq!(
            (error.scale(stepped), error.drift(stepped)),
            ((EnergyScale::TakenByContacts, 8.0), 0.125)
        );
        let exact = Some(ContactLaw::EventDriven);
        for contacts in [None, exact] {
            let expected = ((EnergyScale::LargestKinetic, 2.0), 0.5);
            assert_eq!((error.scale(contacts), error.drift(contacts)), expected);
        }
    }

    #[test]
    fn bodies_that_move_are_compared_with_their_kinetic_energy() {
        let mut error = EnergyError::default();
        error.add(&balance(10.0, 8.0, -0.1));
        assert_eq!(error.drift(Some(ContactLaw::TimeStepping)), -0.1);
        assert_eq!(EnergyError::default().drift(None), 0.0);
    }
}
