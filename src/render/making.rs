//! Results of the pool → named images, and faults.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::exposure::Exposure;
use super::job::{Event, Group, Job, Outcome};
use super::pool::Fate;
use super::process::Unit;
use super::{Fault, RenderError};

/// Handles the result of each unit, as it comes.
pub(super) struct Making<'a> {
    job: &'a Job<'a>,
    groups: &'a [Group],
    outcome: &'a mut Outcome,
    watch: &'a mut dyn FnMut(Event<'_>),
    /// A process takes its folder with it, so images of moments wait here for the others of their frame.
    exposures: HashMap<usize, Exposure>,
    /// The groups that have failed.
    failed: HashSet<usize>,
}

impl<'a> Making<'a> {
    pub(super) fn new(
        job: &'a Job<'a>,
        groups: &'a [Group],
        outcome: &'a mut Outcome,
        watch: &'a mut dyn FnMut(Event<'_>),
    ) -> Making<'a> {
        Making { job, groups, outcome, watch, exposures: HashMap::new(), failed: HashSet::new() }
    }

    /// Records the result of a unit.
    pub(super) fn take(&mut self, unit: &Unit, fate: Fate) -> Result<(), RenderError> {
        match (fate, unit.moment) {
            (Fate::Image(path, seconds), None) => self.image(unit, &path, seconds),
            (Fate::Image(path, seconds), Some(moment)) => self.moment(unit, moment, &path, seconds),
            (Fate::Broken(said) | Fate::Died(said), _) => self.failure(unit, &said),
        }
    }

    /// Handles the image of a moment; the last one completes its frame.
    fn moment(&mut self, unit: &Unit, moment: u32, path: &Path, seconds: f64) -> Result<(), RenderError> {
        if self.failed.contains(&unit.index) {
            return Ok(());
        }
        let of = self.job.sequence.moments.unwrap_or(1);
        let exposure = match self.exposures.entry(unit.index) {
            Entry::Occupied(begun) => begun.into_mut(),
            Entry::Vacant(new) => new.insert(Exposure::new(self.job.images, unit.index)?),
        };
        if !exposure.add(path, moment, seconds, of)? {
            return Ok(());
        }
        let Some(exposure) = self.exposures.remove(&unit.index) else { return Ok(()) };
        self.image(unit, &exposure.develop()?, exposure.seconds)
    }

    /// Handles the image of a frame, which also serves all frames with equal scripts.
    fn image(&mut self, unit: &Unit, path: &Path, seconds: f64) -> Result<(), RenderError> {
        let (images, scripts) = (self.job.images, self.job.sequence.scripts());
        let group = &self.groups[unit.index];
        let first = &scripts[group.members[0]];
        images.adopt(path, &first.name, &group.record)?;
        self.outcome.rendered += 1;
        if self.outcome.slowest.is_none_or(|(_, slowest)| seconds > slowest) {
            self.outcome.slowest = Some((unit.frame, seconds));
        }
        (self.watch)(Event::Made { frame: first.frame, seconds: Some(seconds) });
        for &other in &group.members[1..] {
            images.copy(&first.name, &scripts[other].name, &group.record)?;
            self.outcome.copied += 1;
            (self.watch)(Event::Made { frame: scripts[other].frame, seconds: None });
        }
        Ok(())
    }

    /// Records the failure of a frame, and of all frames with equal scripts.
    fn failure(&mut self, unit: &Unit, said: &str) -> Result<(), RenderError> {
        /// If this many frames fail and none succeeds, the cause is not in the frames.
        const HOPELESS: usize = 8;
        // Other moments of the frame may still be rendering.
        self.exposures.remove(&unit.index);
        if !self.failed.insert(unit.index) {
            return Ok(());
        }
        let sequence = self.job.sequence;
        for &member in &self.groups[unit.index].members {
            let script = &sequence.scripts()[member];
            let path: PathBuf = sequence.folder().join(&script.file);
            let fault = Fault::parse(script.frame, path, said, self.job.povray);
            self.job.images.note_failure(&script.name, &fault.to_string())?;
            (self.watch)(Event::Failed(&fault));
            self.outcome.failed.push(fault);
        }
        if !self.job.keep_going && self.outcome.rendered == 0 && self.outcome.failed.len() >= HOPELESS {
            return Err(RenderError::AllFail(self.outcome.failed.len()));
        }
        Ok(())
    }
}
