//! Turns the results of the POV-Ray processes into named images and reported failures.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use super::exposure::Exposure;
use super::images::Finished;
use super::job::{Event, Group, Job, Outcome};
use super::pool::TaskResult;
use super::process::RenderTask;
use super::{Fault, RenderError};

/// Receives the result of each picture that POV-Ray renders, in any order.
pub(super) struct ResultCollector<'a> {
    job: &'a Job<'a>,
    groups: &'a [Group],
    outcome: &'a mut Outcome,
    watch: &'a mut dyn FnMut(Event<'_>),
    /// The images of moments of unfinished frames, by the index of the frame's group. They are moved here, since a process removes its
    /// folder when it ends.
    exposures: HashMap<usize, Exposure>,
    /// The indices of the groups that have failed.
    failed: HashSet<usize>,
}

impl<'a> ResultCollector<'a> {
    pub(super) fn new(
        job: &'a Job<'a>,
        groups: &'a [Group],
        outcome: &'a mut Outcome,
        watch: &'a mut dyn FnMut(Event<'_>),
    ) -> ResultCollector<'a> {
        ResultCollector { job, groups, outcome, watch, exposures: HashMap::new(), failed: HashSet::new() }
    }

    /// Records the result of rendering one picture.
    pub(super) fn take(&mut self, task: &RenderTask, result: TaskResult) -> Result<(), RenderError> {
        match (result, task.moment) {
            (TaskResult::Image(image, seconds), None) => self.image(task, &image, seconds),
            (TaskResult::Image(image, seconds), Some(moment)) => self.moment(task, moment, &image, seconds),
            (TaskResult::Broken(said) | TaskResult::Died(said), _) => self.failure(task, &said),
        }
    }

    /// Stores the image of a moment of a frame with motion blur. The last moment completes the frame.
    fn moment(
        &mut self,
        task: &RenderTask,
        moment: u32,
        image: &Finished,
        seconds: f64,
    ) -> Result<(), RenderError> {
        if self.failed.contains(&task.index) {
            return Ok(());
        }
        let of = self.job.sequence.moments.unwrap_or(1);
        let exposure = match self.exposures.entry(task.index) {
            Entry::Occupied(begun) => begun.into_mut(),
            Entry::Vacant(new) => new.insert(Exposure::new(self.job.images, task.index)?),
        };
        if !exposure.add(image, moment, seconds, of)? {
            return Ok(());
        }
        let Some(exposure) = self.exposures.remove(&task.index) else { return Ok(()) };
        self.image(task, &exposure.develop()?, exposure.seconds)
    }

    /// Stores the image of a frame, and copies of it for all frames with equal scripts.
    fn image(&mut self, task: &RenderTask, image: &Finished, seconds: f64) -> Result<(), RenderError> {
        let (images, scripts) = (self.job.images, self.job.sequence.scripts());
        let group = &self.groups[task.index];
        let first = &scripts[group.members[0]];
        images.adopt(image, &first.name, &group.record)?;
        self.outcome.rendered += 1;
        if self.outcome.slowest.is_none_or(|(_, slowest)| seconds > slowest) {
            self.outcome.slowest = Some((task.frame, seconds));
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
    fn failure(&mut self, task: &RenderTask, said: &str) -> Result<(), RenderError> {
        /// If at least this many frames fail and none succeeds, the frames themselves are not the cause, and the job stops.
        const MIN_FAILURES_TO_STOP: usize = 8;
        // POV-Ray may still be rendering other moments of the failed frame. Their images are ignored.
        self.exposures.remove(&task.index);
        if !self.failed.insert(task.index) {
            return Ok(());
        }
        let sequence = self.job.sequence;
        for &member in &self.groups[task.index].members {
            let script = &sequence.scripts()[member];
            let path: PathBuf = sequence.folder().join(&script.file);
            let fault = Fault::parse(script.frame, path, said, self.job.povray);
            self.job.images.note_failure(&script.name, &fault.to_string())?;
            (self.watch)(Event::Failed(&fault));
            self.outcome.failed.push(fault);
        }
        if !self.job.keep_going
            && self.outcome.rendered == 0
            && self.outcome.failed.len() >= MIN_FAILURES_TO_STOP
        {
            return Err(RenderError::AllFail(self.outcome.failed.len()));
        }
        Ok(())
    }
}
