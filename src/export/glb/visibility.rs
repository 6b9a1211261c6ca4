//! Records when objects are present. glTF has no property for presence, so absent objects get the size 0.

use super::motion::SizeBudget;
use crate::export::ExportError;

/// The times in the animation at which an object appears or disappears (s), each with its scale from then on. Empty for an object that is
/// always present.
#[derive(Default)]
pub(super) struct Visibility {
    pub(super) times: Vec<f32>,
    /// The scale from each time on, as three equal numbers: 1 if the object is present, 0 if it is absent.
    pub(super) scales: Vec<f32>,
}

impl Visibility {
    /// Returns true if the object is always present.
    pub(super) fn is_always(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns true if the object is present in the first frame.
    pub(super) fn at_first(&self) -> bool {
        self.scales.first() != Some(&0.0)
    }

    /// Records whether the object is present in the latest frame. `frames` holds the times of all frames so far. Fails if the file would
    /// become too large.
    pub(super) fn add(
        &mut self,
        is_there: bool,
        frames: &[f32],
        budget: &mut SizeBudget,
    ) -> Result<(), ExportError> {
        let &[first, .., now] = frames else {
            let first = frames.first().copied().unwrap_or_default();
            return if is_there { Ok(()) } else { self.set(false, first, budget) };
        };
        if self.is_always() && !is_there {
            self.set(true, first, budget)?;
        }
        let was_there = self.scales.last() != Some(&0.0);
        if was_there == is_there { Ok(()) } else { self.set(is_there, now, budget) }
    }

    fn set(&mut self, is_there: bool, time: f32, budget: &mut SizeBudget) -> Result<(), ExportError> {
        budget.take(4)?;
        self.times.push(time);
        self.scales.extend([f32::from(u8::from(is_there)); 3]);
        Ok(())
    }
}
