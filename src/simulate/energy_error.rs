//! The energy error of a whole run, and the energy that it is compared with.

use serde::{Deserialize, Serialize};

use crate::physics::Balance;
use crate::scene::ContactLaw;

/// The energy that the energy error of a run is relative to.
///
/// Usually this is the largest kinetic energy. With contacts it may be very small, if bodies only settle, if they fall between two frames,
/// or if a machine lifts them slowly. If contacts take more energy than the largest kinetic energy, or motions and motors do more work, the error is relative to that
/// larger energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EnergyScale {
    /// The largest kinetic energy in any frame.
    #[default]
    LargestKinetic,
    /// The energy that impacts and friction took from the bodies in the whole run.
    TakenByContacts,
    /// The work in the whole run of everything that has no potential energy: given motions, motors and drag.
    Work,
}

impl EnergyScale {
    /// The name of the scale, as it follows "of the" in a message.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            EnergyScale::LargestKinetic => "largest kinetic energy",
            EnergyScale::TakenByContacts => "energy that contacts took",
            EnergyScale::Work => "work of motions, motors and drag",
        }
    }

    /// Whether the energy error is relative to the largest kinetic energy.
    #[must_use]
    pub fn is_largest_kinetic(&self) -> bool {
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
    /// The magnitude of the work of motions, motors and drag so far, J.
    work: f64,
    /// The largest sum of the kinetic energy and the magnitude of the potential energy so far, J. It determines the rounding errors of all
    /// energies.
    pub(crate) magnitude: f64,
}

impl EnergyError {
    /// Adds the balance of the next frame. Returns the energy error of this frame, J.
    pub(crate) fn add(&mut self, balance: &Balance) -> f64 {
        self.largest_kinetic = self.largest_kinetic.max(balance.kinetic);
        self.magnitude = self.magnitude.max(balance.kinetic + balance.potential.abs());
        self.taken = balance.accounts.taken_by_contacts();
        self.work = (balance.accounts.work + balance.accounts.motors).abs();
        if balance.error.abs() > self.largest.abs() {
            self.largest = balance.error;
        }
        balance.error
    }

    /// Returns the kind of energy that the error of the whole run is relative to, and the value of this energy, J. `contacts` is the
    /// contact law of the scene.
    pub(crate) fn scale(&self, contacts: Option<ContactLaw>) -> (EnergyScale, f64) {
        let mut scale = (EnergyScale::LargestKinetic, self.largest_kinetic);
        if contacts.is_some() {
            for other in [(EnergyScale::TakenByContacts, self.taken), (EnergyScale::Work, self.work)] {
                scale = if other.1 > scale.1 { other } else { scale };
            }
        }
        scale
    }

    /// Returns the largest error, relative to the energy that `scale` returns. 0 if nothing moved, or if contacts only moved bodies by
    /// rounding errors.
    pub(crate) fn drift(&self, contacts: Option<ContactLaw>) -> f64 {
        /// Energies below this fraction of `magnitude` are rounding errors of contacts and joints.
        const RELATIVE_ROUNDING: f64 = 1e-10;
        /// Errors below this fraction of `magnitude` are rounding errors of the energies themselves.
        const RELATIVE_ROUNDING_OF_ENERGIES: f64 = 1e-13;
        let (_, energy) = self.scale(contacts);
        if self.largest.abs() <= RELATIVE_ROUNDING_OF_ENERGIES * self.magnitude && energy < self.largest.abs()
        {
            return 0.0;
        }
        if contacts.is_some() && energy <= RELATIVE_ROUNDING * self.magnitude {
            return 0.0;
        }
        if energy > 0.0 { self.largest / energy } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Accounts;

    /// The balance of a frame with a kinetic energy, an energy taken by impacts, and an error, J.
    fn balance(kinetic: f64, taken: f64, error: f64) -> Balance {
        let accounts = Accounts { impacts: -taken, ..Accounts::default() };
        Balance { kinetic, accounts, error, ..Balance::default() }
    }

    #[test]
    fn bodies_that_settle_are_compared_with_what_contacts_took() {
        let mut error = EnergyError::default();
        error.add(&balance(2.0, 0.0, 0.0));
        assert_eq!(error.add(&balance(1.0, 8.0, 1.0)), 1.0);
        for law in [ContactLaw::TimeStepping, ContactLaw::EventDriven] {
            let expected = ((EnergyScale::TakenByContacts, 8.0), 0.125);
            assert_eq!((error.scale(Some(law)), error.drift(Some(law))), expected);
        }
        assert_eq!((error.scale(None), error.drift(None)), ((EnergyScale::LargestKinetic, 2.0), 0.5));
    }

    #[test]
    fn bodies_that_a_motor_lifts_slowly_are_compared_with_its_work() {
        let accounts = Accounts { motors: 20.0, impacts: -1.0, ..Accounts::default() };
        let mut error = EnergyError::default();
        error.add(&Balance { kinetic: 0.1, accounts, error: 0.1, ..Balance::default() });
        let stepped = Some(ContactLaw::TimeStepping);
        assert_eq!((error.scale(stepped), error.drift(stepped)), ((EnergyScale::Work, 20.0), 0.005));
    }

    #[test]
    fn rounding_errors_of_a_body_at_rest_are_no_drift() {
        let mut error = EnergyError::default();
        error.add(&Balance { kinetic: 1e-20, potential: -50.0, error: 1e-12, ..Balance::default() });
        assert_eq!(error.drift(Some(ContactLaw::TimeStepping)), 0.0);
        assert_eq!(error.drift(None), 0.0);
        error.add(&Balance { kinetic: 1e-20, potential: -50.0, error: 1e-9, ..Balance::default() });
        assert!((error.drift(None) / 1e11 - 1.0).abs() < 1e-9, "more than rounding");
    }

    #[test]
    fn bodies_that_move_are_compared_with_their_kinetic_energy() {
        let mut error = EnergyError::default();
        error.add(&balance(10.0, 8.0, -1.0));
        assert_eq!(error.drift(Some(ContactLaw::TimeStepping)), -0.1);
        assert_eq!(EnergyError::default().drift(None), 0.0);
    }
}
