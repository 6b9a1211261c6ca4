//! Compares a run with the same run at half and at a quarter of its timestep, and with a twin: a run from a slightly different start.

use glam::DVec3;

use super::Stopped;
use super::lockstep::{ComparedRun, Ended, Watch, together};
use super::measure::{ComparedBodies, Distance, union};
use super::neighbours::displaced;
use super::other_scheme::{Apart, Other};
use super::setting::Setting;
use crate::physics::{Accounts, LawResidual, Snapshot};
use crate::scene::Scene;
use crate::simulate::EnergyError;

/// The differences between the compared runs at one frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moment {
    /// The time of the frame, s.
    pub(super) time: f64,
    /// The largest distance between a point of a body in the run and the same point in the run at half the timestep, m. `None` after the
    /// end of either run.
    pub(super) off: Option<f64>,
    /// The sums of the squared distances of all bodies, m²: between the runs at the timestep and at its half, and between the runs at its
    /// half and at its quarter.
    pub(super) squares: Option<[f64; 2]>,
    /// The energy error of the run, J.
    pub(super) energy: f64,
    /// The magnitudes of the changes of linear and angular momentum in the run since its first frame.
    pub(super) changed: [f64; 2],
    /// The mean-square differences between the run and a run from a slightly different start: of positions (m²), velocities (m²/s²) and
    /// orientations (rad²). `None` after the end of either run.
    pub(super) apart: Option<[f64; 3]>,
}

/// The result of comparing a run with the same run at smaller timesteps, and with a run from a slightly different start (its twin).
#[derive(Debug, Default)]
pub(super) struct Compared {
    pub(super) moments: Vec<Moment>,
    /// For each body: the largest differences between the run and the run at half the timestep, and the length of the body's path.
    pub(super) bodies: Vec<Deviation>,
    /// The diagonal of the box around the motion of all bodies, m, from the finest run.
    pub(super) size: f64,
    /// The largest speed of a body in the run, m/s.
    pub(super) fastest: f64,
    /// The largest energy error of the run.
    pub(super) energy: EnergyError,
    /// The largest sum of the magnitudes of all bodies' momenta during the run: linear (kg m/s) and angular (kg m²/s).
    pub(super) momenta: [f64; 2],
    /// The energy that each influence without a potential has brought in by the last frame of the run.
    pub(super) accounts: Accounts,
    /// The worst residual in the run of each law that no contact can break.
    pub(super) laws: Vec<LawResidual>,
    /// The breakdowns of the four runs: at the timestep, at its half, at its quarter, and of the run from a slightly different start.
    /// `None` for a run that reached its end.
    pub(super) ended: [Option<Ended>; 4],
    pub(super) steps: [u64; 3],
    /// The largest energy error in the run at half the timestep, relative to the energy of that run's scale.
    pub(super) drift_at_half: f64,
    /// The largest distance between a point of a body in the run at half the timestep and the same point in the run at a quarter of it, m.
    pub(super) off_at_half: f64,
    /// The distances between the run and the same run under the other contact law.
    pub(super) other: Apart,
}

/// The largest differences of a body between the run and the run at half the timestep, the time of the largest one (s), and the length of
/// the body's path (`way`, m).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Deviation {
    pub(super) most: Distance,
    pub(super) time: f64,
    pub(super) way: f64,
}

/// Values kept from earlier frames: the last positions of all bodies, the momenta at the first frame, the boxes around the motion, and the
/// largest energies.
struct Seen {
    before: Vec<Option<DVec3>>,
    momenta: Option<[DVec3; 2]>,
    boxes: [Option<[DVec3; 2]>; 3],
    energy_at_half: EnergyError,
}

/// Simulates four runs side by side, and compares them frame by frame: the scene's run, the run at half and at a quarter of its timestep,
/// and a run from a slightly different start (its twin). With contacts, also the runs under the `other` contact law.
pub(super) fn compare(
    scene: &Scene,
    own: Setting,
    measured: &ComparedBodies,
    other: Option<&Other>,
    watch: &mut Watch<'_>,
) -> Result<Compared, Stopped> {
    let settings = [own, own.finer(2), own.finer(4)];
    let mut scenes: Vec<Scene> = settings.iter().map(|setting| setting.applied(scene, own)).collect();
    scenes.push(displaced(scene, measured));
    let frames = scene.simulation.timeline.frames().max(1);
    #[allow(clippy::cast_precision_loss, reason = "there are at most a million")]
    let costs = settings.iter().chain([&own]).map(|setting| setting.cost(scene) / frames as f64);
    let mut runs: Vec<ComparedRun<'_>> =
        scenes.iter().zip(costs).map(|(scene, cost)| ComparedRun::new(scene, cost)).collect();
    runs.extend(other.iter().flat_map(|other| other.runs()));
    let mut found =
        Compared { bodies: vec![Deviation::default(); measured.bodies.len()], ..Compared::default() };
    let mut seen = Seen {
        before: vec![None; measured.bodies.len()],
        momenta: None,
        boxes: [None; 3],
        energy_at_half: EnergyError::default(),
    };
    together(&mut runs, scene, watch, &mut |moments| found.see(measured, &mut seen, moments))?;
    let size = |found: &[DVec3; 2]| (found[1] - found[0]).length();
    found.size = seen.boxes.iter().flatten().last().map_or(0.0, size);
    found.drift_at_half = seen.energy_at_half.drift(scene.simulation.contacts);
    found.steps = [0, 1, 2].map(|run| runs[run].steps());
    found.other.is_long = runs[4..].iter().any(|run| run.is_long);
    let mut ended = runs.into_iter().map(|run| run.ended);
    found.ended = std::array::from_fn(|_| ended.next().flatten());
    found.other.ended = ended.flatten().next();
    Ok(found)
}

impl Compared {
    fn see(&mut self, measured: &ComparedBodies, seen: &mut Seen, moments: &[Option<Snapshot>]) {
        let [run, half, quarter, twin, others @ ..] = moments else { return };
        for (kept, moment) in seen.boxes.iter_mut().zip([run, half, quarter]) {
            let here = moment.as_ref().and_then(|moment| measured.around(moment));
            // The box never shrinks. A finer run that breaks down early has only a part of the motion in its box.
            *kept = match (*kept, here) {
                (Some(kept), Some(here)) => Some(union(kept, here)),
                (kept, here) => kept.or(here),
            };
        }
        if let Some(half) = half {
            seen.energy_at_half.add(&half.balance);
        }
        let Some(run) = run else { return };
        let energy = self.energy.add(&run.balance);
        self.accounts = run.balance.accounts;
        self.laws.clone_from(&run.laws);
        let mut moment = Moment { time: run.time, energy, ..Moment::default() };
        self.see_ways(measured, seen, run);
        if let Some(half) = half {
            moment.off = Some(self.see_off(measured, [run, half]));
            let now = [run.balance.linear_momentum, run.balance.angular_momentum];
            let first = *seen.momenta.get_or_insert(now);
            moment.changed = [0, 1].map(|kind| (now[kind] - first[kind]).length());
            let momenta = measured.momenta(run);
            self.momenta = [0, 1].map(|kind| self.momenta[kind].max(momenta[kind]));
            if let Some(quarter) = quarter {
                let squares = |one, two| {
                    points(measured, [one, two]).fold((0.0, 0.0_f64), |(sum, most), (_, distance)| {
                        (sum + distance.point * distance.point, most.max(distance.point))
                    })
                };
                let (coarse, fine) = (squares(run, half), squares(half, quarter));
                moment.squares = Some([coarse.0, fine.0]);
                self.off_at_half = self.off_at_half.max(fine.1);
            }
        }
        self.other.see(measured, run, others);
        moment.apart = twin.as_ref().map(|twin| apart(measured, [run, twin]));
        self.moments.push(moment);
    }

    fn see_ways(&mut self, measured: &ComparedBodies, seen: &mut Seen, run: &Snapshot) {
        for (body, &id) in measured.bodies.iter().enumerate() {
            let now = run.body(id);
            if let (Some(now), Some(before)) = (now, seen.before[body]) {
                self.bodies[body].way += (now.location - before).length();
            }
            seen.before[body] = now.map(|now| now.location);
            self.fastest = self.fastest.max(now.map_or(0.0, |now| now.velocity.length()));
        }
    }

    /// Returns the largest distance between a point of a body in the run and the same point in the run at half the timestep, m. Updates the
    /// largest differences of each body.
    fn see_off(&mut self, measured: &ComparedBodies, moments: [&Snapshot; 2]) -> f64 {
        let mut most = 0.0_f64;
        for (body, distance) in points(measured, moments) {
            let off = &mut self.bodies[body];
            if distance.point > off.most.point {
                off.time = moments[0].time;
            }
            off.most.place = off.most.place.max(distance.place);
            off.most.angle = off.most.angle.max(distance.angle);
            off.most.point = off.most.point.max(distance.point);
            most = most.max(distance.point);
        }
        most
    }
}

/// Yields the distance between two snapshots for each compared body that both contain, with the index of the body among the compared ones.
pub(super) fn points<'s>(
    measured: &'s ComparedBodies,
    moments: [&'s Snapshot; 2],
) -> impl Iterator<Item = (usize, Distance)> + 's {
    (0..measured.bodies.len())
        .filter_map(move |body| Some((body, measured.distance(body, measured.pair(body, moments)?))))
}

/// Returns the mean-square differences between the bodies of two snapshots: of positions (m²), velocities (m²/s²) and orientations (rad²).
fn apart(measured: &ComparedBodies, moments: [&Snapshot; 2]) -> [f64; 3] {
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    for body in 0..measured.bodies.len() {
        let Some(pair) = measured.pair(body, moments) else { continue };
        let Distance { place, angle, .. } = measured.distance(body, pair);
        let faster = (pair[0].velocity - pair[1].velocity).length_squared();
        sums = [sums[0] + place * place, sums[1] + faster, sums[2] + angle * angle];
        count += 1.0;
    }
    sums.map(|sum| if count > 0.0 { sum / count } else { 0.0 })
}
