//! Renders all images of a sequence. Up-to-date images stay, equal ones are rendered once, and POV-Ray renders all others.

use std::collections::{HashMap, HashSet};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::order::coarse_to_fine;
use super::pool::Pool;
use super::process::{RenderTask, Setup};
use super::record::{Record, State, Verdict};
use super::result_collector::ResultCollector;
use super::{Fault, Images, PovRay, RenderError, Sequence, inputs};

/// A job that renders the images of a sequence of scripts, with its settings.
pub struct Job<'a> {
    /// The scripts to render.
    pub sequence: &'a Sequence,
    /// The folder that the images are rendered into.
    pub images: &'a Images,
    /// The installed POV-Ray.
    pub povray: &'a PovRay,
    /// The command-line options of POV-Ray that affect pixels.
    pub options: Vec<String>,
    /// The number of POV-Ray processes. `None` for as many as keep the processors busy.
    pub jobs: Option<usize>,
    /// The number of threads that each POV-Ray process renders with.
    pub threads: usize,
    /// The number of new attempts for a frame after POV-Ray has crashed on it.
    pub retries: u32,
    /// True to continue even if all frames fail.
    pub keep_going: bool,
    /// The time limit for rendering a frame. `None` for a limit far above the time of other frames.
    pub time_limit: Option<Duration>,
    /// True to check up-to-date images against their digests. An image with changed bytes is rendered again.
    pub verify: bool,
}

/// A progress event of a job.
pub enum Event<'a> {
    /// The job has found out which images it has to render.
    Planned {
        /// The number of images that are up to date.
        up_to_date: usize,
        /// The number of images to render.
        to_make: usize,
    },
    /// An image was rendered, or copied from an equal one.
    Made {
        /// The number of the frame.
        frame: usize,
        /// The rendering time of the image, s. `None` for a copy.
        seconds: Option<f64>,
    },
    /// A frame could not be rendered.
    Failed(&'a Fault),
}

/// The result of a job.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// The number of images that POV-Ray has rendered.
    pub rendered: usize,
    /// The number of images that were copied, because their scripts equal those of other images.
    pub copied: usize,
    /// The number of images that were already up to date.
    pub up_to_date: usize,
    /// The frames whose images had been changed since they were rendered. Such an image is rendered again.
    pub changed: Vec<usize>,
    /// The frames that are rendered again because the records of their images have no digest to verify.
    pub unverified: Vec<usize>,
    /// The failed frames, in the order of their numbers.
    pub failed: Vec<Fault>,
    /// The number of removed images of frames that the film no longer has.
    pub removed: usize,
    /// The number of the frame that took longest to render, and its time, s.
    pub slowest: Option<(usize, f64)>,
    /// The number of POV-Ray processes that were started.
    pub processes: usize,
    /// The warnings that POV-Ray has printed.
    pub warnings: Vec<String>,
    /// True if the user stopped the job before its end.
    pub stopped: bool,
}

/// Frames with equal scripts. Only the first of them is rendered; the others get copies of its image.
pub(super) struct Group {
    /// The indices of the frames' scripts in the sequence.
    pub(super) members: Vec<usize>,
    pub(super) record: Record,
}

impl Job<'_> {
    /// Renders the missing images. `watch` receives the progress. Setting `stop` ends the job.
    ///
    /// # Errors
    /// If the disk is full, a folder has disappeared, or all of the first frames fail. The failure of a single frame is no error: the
    /// result lists it.
    pub fn run(&self, watch: &mut dyn FnMut(Event<'_>), stop: &AtomicBool) -> Result<Outcome, RenderError> {
        let removed = self.images.remove_others(|name| self.sequence.has(name))?;
        let mut outcome = Outcome { removed, ..Outcome::default() };
        let records = inputs::records(self.sequence, &self.options.join(" "), self.povray.version())?;
        let groups = self.groups(&records, &mut outcome)?;
        let to_make = groups.iter().map(|group| group.members.len()).sum();
        watch(Event::Planned { up_to_date: outcome.up_to_date, to_make });
        if !groups.is_empty() {
            self.render(&groups, &mut outcome, watch, stop)?;
        }
        outcome.failed.sort_by_key(|fault| fault.frame);
        Ok(outcome)
    }

    /// Groups the scripts without up-to-date images, so that all scripts of a group are equal. If a script equals one that has an
    /// up-to-date image, this image is copied at once instead.
    fn groups(&self, records: &[Record], outcome: &mut Outcome) -> Result<Vec<Group>, RenderError> {
        let scripts = self.sequence.scripts();
        let state = |index: usize| self.images.state(&scripts[index].name, &records[index]);
        let (there, mut missing): (Vec<usize>, Vec<usize>) =
            (0..scripts.len()).partition(|&index| state(index) == State::UpToDate);
        let looks_missing: HashSet<String> = missing.iter().map(|&index| records[index].to_text()).collect();
        // Copying reads the image in any case, so an image is always verified before it is copied.
        let is_read = |index: &usize| self.verify || looks_missing.contains(&records[*index].to_text());
        let verdicts: Vec<Verdict> = there
            .par_iter()
            .map(|index| match is_read(index) {
                true => self.images.verify(&scripts[*index].name),
                false => Verdict::Intact,
            })
            .collect();
        let mut equals: HashMap<String, &str> = HashMap::new();
        for (&index, verdict) in there.iter().zip(verdicts) {
            let frame = scripts[index].frame;
            match verdict {
                Verdict::Changed => outcome.changed.push(frame),
                Verdict::Unverified if self.verify => outcome.unverified.push(frame),
                Verdict::Unverified => {
                    outcome.up_to_date += 1;
                    continue;
                }
                Verdict::Intact => {
                    outcome.up_to_date += 1;
                    equals.insert(records[index].to_text(), &scripts[index].name);
                    continue;
                }
            }
            missing.push(index);
        }
        missing.sort_unstable();
        let mut groups: Vec<Group> = Vec::new();
        let mut group_of: HashMap<String, usize> = HashMap::new();
        for index in missing {
            let (record, name) = (&records[index], &scripts[index].name);
            let text = record.to_text();
            if let Some(equal) = equals.get(&text) {
                self.images.copy(equal, name, record)?;
                outcome.copied += 1;
                continue;
            }
            let group = *group_of.entry(text).or_insert_with(|| {
                groups.push(Group { members: Vec::new(), record: record.clone() });
                groups.len() - 1
            });
            groups[group].members.push(index);
        }
        Ok(groups)
    }

    fn render(
        &self,
        groups: &[Group],
        outcome: &mut Outcome,
        watch: &mut dyn FnMut(Event<'_>),
        stop: &AtomicBool,
    ) -> Result<(), RenderError> {
        let sequence = self.sequence;
        let scripts = sequence.scripts();
        let setup = Setup {
            povray: self.povray,
            scripts: sequence.absolute(),
            options: &self.options,
            last: sequence.last,
            clock: match sequence.moment {
                Some(time) => [time; 2],
                None => [0.0, sequence.time(sequence.last)],
            },
            threads: self.threads,
        };
        let mut pool = Pool::new(setup, self.images, stop);
        pool.jobs = self.jobs;
        pool.retries = self.retries;
        pool.time_limit = self.time_limit;
        let task = |index: usize| {
            let script = &scripts[groups[index].members[0]];
            let asks_clock = groups[index].record.frame.is_some();
            RenderTask { index, frame: script.frame, script: script.file.clone(), moment: None, asks_clock }
        };
        let moments = |task: RenderTask| -> Vec<RenderTask> {
            let moments = sequence.moments.map(|moments| {
                (0..moments)
                    .map(|m| RenderTask { moment: Some(m), asks_clock: false, ..task.clone() })
                    .collect()
            });
            moments.unwrap_or_else(|| vec![task])
        };
        let tasks: Vec<RenderTask> = coarse_to_fine(groups.len()).map(task).flat_map(moments).collect();
        let mut collector = ResultCollector::new(self, groups, outcome, watch);
        let finished = pool.run(tasks, &mut |task, result| collector.take(&task, result))?;
        outcome.stopped = !finished;
        outcome.processes = pool.started();
        outcome.warnings = pool.warnings();
        Ok(())
    }
}
