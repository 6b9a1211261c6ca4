//! The verdict on a run, from the comparison of runs: its error, its order, its momenta, and how long it is accurate.

use serde::Serialize;

use super::compare::{Compared, Moment};
use super::lockstep::Ended;
use super::measure::Measured;
use super::neighbours::{Parting, parting};
use super::setting::Setting;
use super::trials::{Trial, factor};
use crate::dynamics::{Accounts, Method};
use crate::scene::Scene;
use crate::simulate::evaluations;

/// The verdict on an integrated run.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// The largest energy error, relative to the largest kinetic energy.
    pub drift: f64,
    /// The energy in each account at the end, J; empty accounts are left out.
    pub accounts: Vec<(&'static str, f64)>,
    /// Linear momentum.
    pub linear_momentum: Conserved,
    /// Angular momentum about the origin.
    pub angular_momentum: Conserved,
    /// The size of the scene: the diagonal of the box around the motion of bodies, m.
    pub size: f64,
    /// The largest error of any point of a body, m.
    pub error: f64,
    /// The error of each body that forces move, the largest first.
    pub bodies: Vec<BodyError>,
    /// The observed order of the method.
    pub order: Order,
    /// The separation of neighbours.
    pub neighbours: Parting,
    /// The mean exponential growth of their distance, which is its criterion: 2 for most regular motion; 0 if unknown.
    pub megno: f64,
    /// The time until which the run reaches the wanted accuracy.
    pub trusted: Trusted,
    /// The time until which no point has an error above 1 % of the size of the scene.
    pub trusted_to_a_percent: Trusted,
    /// The runs that broke down.
    pub broken: Vec<Broken>,
    /// The curves of a plot.
    #[serde(skip)]
    pub(super) curves: Curves,
}

/// The curves of a plot, frame by frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Curves {
    /// The times, s.
    pub(super) times: Vec<f64>,
    /// The energy error, relative to the largest kinetic energy.
    pub(super) drift: Vec<f64>,
    /// The largest error of any point, as a fraction of the size of the scene.
    pub(super) error: Vec<f64>,
    /// The distance of the twin, as a fraction of the largest possible distance.
    pub(super) neighbours: Vec<f64>,
}

/// The conservation of a momentum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Conserved {
    /// No body has any.
    Still,
    /// External forces change it, at any step.
    Changed,
    /// It should be conserved; this is its error.
    Kept {
        /// The largest change, relative to the largest sum of the magnitudes of all momenta.
        drift: f64,
    },
}

/// The error of a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyError {
    /// Its name.
    pub body: String,
    /// The largest error of its centre, m.
    pub place: f64,
    /// The time of the largest error, s.
    pub time: f64,
    /// The length of its path, m.
    pub way: f64,
    /// The largest error of its orientation, degrees.
    pub orientation: f64,
}

/// The decrease of the error with the step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Order {
    /// The runs differ only by rounding errors.
    Rounding,
    /// Too few frames can be compared.
    Unknown,
    /// The error decreases with the order of the method.
    Nominal {
        /// The measured order.
        measured: f64,
    },
    /// The error decreases with another order.
    Other {
        /// The measured order.
        measured: f64,
    },
    /// The method chooses its steps, and the error falls with its tolerance.
    Adaptive,
    /// The differences of the runs do not decrease with the step, so the error is unknown.
    None {
        /// The measured order.
        measured: f64,
    },
}

/// The time until which a run reaches an accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trusted {
    /// The time of the last such frame, s; `None` if not even the first frame after the start is accurate.
    pub until: Option<f64>,
    /// Its number.
    pub frame: usize,
    /// Whether it is the last frame of the run.
    pub to_the_end: bool,
}

/// A run that broke down.
#[derive(Clone, Debug, Serialize)]
pub struct Broken {
    /// Its name.
    pub run: &'static str,
    /// The time of the last frame, s.
    pub after: Option<f64>,
    /// The reason.
    pub why: String,
}

impl Broken {
    pub(super) fn of(run: &'static str, ended: &Ended) -> Broken {
        Broken { run, after: ended.after, why: ended.why.to_string() }
    }
}

impl Order {
    /// The observed order. It uses only times at which the runs are close to each other; elsewhere, their difference is meaningless.
    fn of(compared: &Compared, method: &Method) -> Order {
        /// Differences below this fraction of the size count as rounding.
        const ROUNDING: f64 = 1e-11;
        /// The runs count as close up to this fraction of the size,
        const NEAR: f64 = 0.05;
        /// and orders that differ by less than this count as equal.
        const SAME: f64 = 0.35;
        let far = |moment: &&Moment| moment.off.is_some_and(|off| off <= NEAR * compared.size);
        let near = compared.moments.iter().skip(1).take_while(far).filter_map(|moment| moment.squares);
        let (count, [coarse, fine]) = near
            .fold((0.0, [0.0; 2]), |(n, sum), squares| (n + 1.0, [sum[0] + squares[0], sum[1] + squares[1]]));
        let rounding = ROUNDING * compared.size;
        if count < 2.0 {
            return Order::Unknown;
        }
        if coarse <= count * rounding * rounding || fine == 0.0 {
            return Order::Rounding;
        }
        let (measured, nominal) = (0.5 * libm::log2(coarse / fine), f64::from(method.order));
        match measured {
            measured if measured < 0.4 => Order::None { measured },
            _ if method.adaptive => Order::Adaptive,
            measured if (measured - nominal).abs() <= SAME => Order::Nominal { measured },
            measured => Order::Other { measured },
        }
    }

    /// The factor from the difference of two runs to the error.
    pub(super) fn factor(self, method: &Method) -> f64 {
        match self {
            // A tenth of the tolerance leaves about a tenth of the error.
            _ if method.adaptive => 10.0 / 9.0,
            Order::Other { measured } => factor(measured.min(f64::from(method.order) + 4.0)),
            Order::None { .. } => factor(1.0),
            _ => factor(f64::from(method.order)),
        }
    }
}

impl Verdict {
    pub(super) fn of(
        scene: &Scene,
        own: Setting,
        measured: &Measured,
        compared: &Compared,
        accuracy: f64,
    ) -> Verdict {
        let order = Order::of(compared, own.method);
        let (factor, size) = (order.factor(own.method), compared.size);
        let kinetic = compared.largest_kinetic;
        let relative = |error: f64| if kinetic > 0.0 { error / kinetic } else { 0.0 };
        let energies = compared.moments.iter().map(|moment| moment.energy);
        let drift = energies.fold(0.0_f64, |most, now| if now.abs() > most.abs() { now } else { most });
        let mut bodies: Vec<(f64, BodyError)> = (measured.bodies.iter().zip(&compared.bodies))
            .map(|(&id, off)| {
                let body = scene.bodies[id].name.to_string();
                let orientation = (factor * off.most.angle).to_degrees().min(180.0);
                let error = BodyError {
                    body,
                    place: factor * off.most.place,
                    time: off.time,
                    way: off.way,
                    orientation,
                };
                (factor * off.most.point, error)
            })
            .collect();
        bodies.sort_by(|(one, _), (two, _)| two.total_cmp(one));
        let runs = ["the run", "the run at half the step", "the run at a quarter of the step", "the twin"];
        let broken = runs.iter().zip(&compared.ended);
        let broken = broken.filter_map(|(run, ended)| Some(Broken::of(run, ended.as_ref()?)));
        let accounts = Accounts::NAMES.into_iter().zip(compared.accounts.to_array());
        let curves = Curves::of(compared, factor);
        let ended = compared.ended[0].is_some();
        let (neighbours, megno) = parting(&curves.times, &curves.neighbours);
        Verdict {
            drift: relative(drift),
            accounts: accounts.filter(|(_, held)| held.abs() > 1e-11 * kinetic).collect(),
            linear_momentum: conserved(compared, 0),
            angular_momentum: conserved(compared, 1),
            size,
            error: bodies.first().map_or(0.0, |(error, _)| *error),
            bodies: bodies.into_iter().map(|(_, error)| error).collect(),
            order,
            neighbours,
            megno,
            trusted: Trusted::of(compared, factor, accuracy * size, ended),
            trusted_to_a_percent: Trusted::of(compared, factor, 0.01 * size, ended),
            broken: broken.collect(),
            curves,
        }
    }

    /// Whether the run is accurate enough to know its size.
    pub(super) fn knows_the_size(&self) -> bool {
        self.error < 0.1 * self.size && self.broken.is_empty()
    }

    /// The known trials of the scene's own method: at its step, and at half of it.
    pub(super) fn known(&self, scene: &Scene, own: Setting, compared: &Compared) -> Vec<Trial> {
        let factor = self.order.factor(own.method);
        let errors = [self.error, factor * compared.off_at_half];
        let drifts = [self.drift, compared.drift_at_half];
        let trial = |place: usize| {
            let setting = own.finer([1, 2][place]);
            let ended = compared.ended[place].clone().or(compared.ended[place + 1].clone());
            Trial {
                integrator: own.method.name,
                step: setting
                    .written(scene)
                    .map(|step| if place == 0 { scene.simulation.step } else { step }),
                timestep: setting.timestep(scene),
                tolerance: setting.tolerance(),
                steps_per_frame: setting.steps,
                steps: compared.steps[place],
                evaluations: compared.steps[place] * evaluations(own.method),
                error: ended.is_none().then_some(errors[place]),
                drift: drifts[place],
                reaches: false,
                ended,
                setting,
                size: self.size,
            }
        };
        vec![trial(0), trial(1)]
    }
}

/// Whether a momentum is conserved. A change from outside is the same at half the step; an error becomes smaller.
fn conserved(compared: &Compared, kind: usize) -> Conserved {
    /// A change below this fraction is an error, even if it is the same at half the step.
    const SMALL: f64 = 1e-9;
    let most = compared.momenta[kind];
    if most == 0.0 {
        return Conserved::Still;
    }
    let near = |moment: &&Moment| moment.off.is_some_and(|off| off <= 0.1 * compared.size);
    let largest = |run: usize, moments: &mut dyn Iterator<Item = &Moment>| {
        moments.map(|moment| moment.changed[run][kind]).fold(0.0, f64::max)
    };
    let [of_run, of_half] = [0, 1].map(|run| largest(run, &mut compared.moments.iter().take_while(near)));
    if of_run > SMALL * most && of_half > 0.75 * of_run {
        return Conserved::Changed;
    }
    Conserved::Kept { drift: largest(0, &mut compared.moments.iter()) / most }
}

impl Trusted {
    /// The time until which a run's error is at most `most` metres.
    fn of(compared: &Compared, factor: f64, most: f64, ended: bool) -> Trusted {
        let is_right = |moment: &&Moment| moment.off.is_some_and(|off| factor * off <= most);
        let frames = compared.moments.iter().take_while(is_right).count();
        let last = compared.moments[..frames].last().filter(|_| frames > 1);
        Trusted {
            until: last.map(|moment| moment.time),
            frame: frames.saturating_sub(1),
            to_the_end: frames == compared.moments.len() && !ended,
        }
    }
}

impl Curves {
    fn of(compared: &Compared, factor: f64) -> Curves {
        let Compared { moments, size, fastest, largest_kinetic, .. } = compared;
        let part = |of: f64, whole: f64| if whole > 0.0 { of / whole } else { 0.0 };
        let apart = |moment: &Moment| {
            let [place, faster, angle] = moment.apart?;
            Some((part(place, size * size) + part(faster, fastest * fastest) + angle).sqrt())
        };
        Curves {
            times: moments.iter().map(|moment| moment.time).collect(),
            drift: moments.iter().map(|moment| part(moment.energy, *largest_kinetic)).collect(),
            error: moments.iter().map_while(|moment| Some(part(factor * moment.off?, *size))).collect(),
            neighbours: moments.iter().map_while(apart).collect(),
        }
    }
}
