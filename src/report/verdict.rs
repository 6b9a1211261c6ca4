//! Judges a run by its comparison with other runs: finds its error, the order of its method, the conservation of momentum, and the time
//! until which the run is accurate.

use serde::Serialize;

use super::compare::{Compared, Moment};
use super::influence::OutsideInfluence;
use super::lockstep::Ended;
use super::measure::ComparedBodies;
use super::neighbours::{Separation, parting};
use super::other_scheme::{Other, OtherScheme};
use super::setting::Setting;
use super::trials::{Trial, factor};
use crate::physics::{Accounts, LawResidual, Method};
use crate::scene::{ContactLaw, Scene};
use crate::simulate::{EnergyScale, evaluations};

/// The measured errors of an integrated run.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// The largest energy error of the run, relative to the energy that `drift_scale` names.
    pub drift: f64,
    /// The energy that the drift is relative to.
    pub drift_scale: EnergyScale,
    /// The energy that each influence without a potential has brought in by the end, by name, J. Negligible amounts are left out.
    pub accounts: Vec<(&'static str, f64)>,
    /// The laws that no contact can break, but that contacts of the run have broken.
    pub broken_laws: Vec<BrokenLaw>,
    /// The conservation of the total linear momentum.
    pub linear_momentum: Conserved,
    /// The conservation of the total angular momentum about the origin.
    pub angular_momentum: Conserved,
    /// The size of the scene: the diagonal of the box around the motion of all bodies, m.
    pub size: f64,
    /// The largest error of any point of a body, m.
    pub error: f64,
    /// The errors of all bodies that forces move, the largest first.
    pub bodies: Vec<BodyError>,
    /// The measured order of the method: how fast the error decreases with the timestep.
    pub order: Order,
    /// The comparison with the same run under the other contact law. `None` without contacts.
    pub other_scheme: Option<OtherScheme>,
    /// How fast neighboring runs separate, which tells regular motion from chaos.
    pub neighbours: Separation,
    /// MEGNO, the mean exponential growth of the distance between two neighboring runs: 2 for most regular motion, 0 if unknown.
    pub megno: f64,
    /// The time until which the run reaches the requested accuracy.
    pub trusted: AccurateUntil,
    /// The time until which no point has an error above 1 % of the size of the scene.
    pub trusted_to_a_percent: AccurateUntil,
    /// The runs that broke down: this run, its repetitions at smaller timesteps, or the run from a slightly different start.
    pub broken: Vec<Broken>,
    /// The curves of a plot of the errors over time.
    #[serde(skip)]
    pub(super) curves: Curves,
}

/// The curves of a plot of the errors over time, with one value per frame. A curve ends early if a run broke down.
#[derive(Clone, Debug, Default)]
pub(super) struct Curves {
    /// The times of the frames, s.
    pub(super) times: Vec<f64>,
    /// The energy error at each frame, relative to the scale of the verdict's drift.
    pub(super) drift: Vec<f64>,
    /// The largest error of any point at each frame, as a fraction of the size of the scene.
    pub(super) error: Vec<f64>,
    /// The distance to a run from a slightly different start at each frame, in phase space: positions relative to the size of the scene,
    /// velocities relative to the largest speed, and angles in rad.
    pub(super) neighbours: Vec<f64>,
}

/// A law that no contact can break, but that contacts of the run have broken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BrokenLaw {
    /// What is not kept: `energy` or `angular momentum`.
    pub law: &'static str,
    /// The size of the worst residual, in `unit`.
    pub amount: f64,
    /// The unit of the amount.
    pub unit: &'static str,
    /// The time of the worst residual, s.
    pub time: f64,
}

/// The result of testing whether a run conserves its total momentum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Conserved {
    /// The momentum of every body is zero during the whole run.
    Still,
    /// Influences from outside change the momentum: gravity, fixed or guided bodies, drag and others.
    Changed,
    /// The momentum should be constant. Each change of it is an integration error.
    Kept {
        /// The largest change of the momentum, relative to the largest sum of the magnitudes of all bodies' momenta.
        drift: f64,
    },
}

/// The largest errors of a body during a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyError {
    /// The name of the body.
    pub body: String,
    /// The largest error of the position of the body's center, m.
    pub place: f64,
    /// The time of the body's largest error, s.
    pub time: f64,
    /// The length of the body's path, m.
    pub way: f64,
    /// The largest error of the body's orientation, degrees.
    pub orientation: f64,
}

/// The order of convergence, measured from three runs: how fast the error decreases with the timestep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Order {
    /// The runs differ only by rounding errors, so the order cannot be measured.
    Rounding,
    /// Too few frames can be compared to measure the order.
    Unknown,
    /// The measured order agrees with the order of the method.
    Nominal {
        /// The measured order of convergence.
        measured: f64,
    },
    /// The error decreases with the timestep, with another order than that of the method.
    Other {
        /// The measured order of convergence.
        measured: f64,
    },
    /// The method is adaptive, and the error decreases with its tolerance.
    Adaptive,
    /// The differences between the runs do not decrease with the timestep, so the error is unknown.
    None {
        /// The measured order of convergence.
        measured: f64,
    },
}

/// The time until which a run reaches an accuracy, as a time and as a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AccurateUntil {
    /// The time of the last accurate frame, s. `None` if even the first frame after the start is inaccurate.
    pub until: Option<f64>,
    /// The number of the last accurate frame.
    pub frame: usize,
    /// True if the run is accurate up to its last frame.
    pub to_the_end: bool,
}

/// A run that broke down before its last frame.
#[derive(Clone, Debug, Serialize)]
pub struct Broken {
    /// The name of the run in the report: `the run at half the step`.
    pub run: &'static str,
    /// The time of the last computed frame, s. `None` if the run has no frame.
    pub after: Option<f64>,
    /// The error message that tells why the run broke down.
    pub why: String,
}

impl BrokenLaw {
    fn of(residual: &LawResidual) -> BrokenLaw {
        let LawResidual { law, time, amount, .. } = *residual;
        BrokenLaw { law: law.name(), amount, unit: law.unit(), time }
    }
}

impl Broken {
    pub(super) fn of(run: &'static str, ended: &Ended) -> Broken {
        Broken { run, after: ended.after, why: ended.why.to_string() }
    }
}

impl Order {
    /// Measures the order of convergence from the three runs. It uses only the frames before the runs differ strongly, since their later
    /// differences do not show the order.
    fn of(compared: &Compared, method: &Method) -> Order {
        /// Differences below this fraction of the size of the scene count as rounding errors.
        const RELATIVE_ROUNDING: f64 = 1e-11;
        /// The largest difference between two runs that still shows the order, as a fraction of the size of the scene.
        const MAX_RUN_DIFFERENCE: f64 = 0.05;
        /// The largest difference between the measured and the method's order that counts as agreement.
        const ORDER_TOLERANCE: f64 = 0.35;
        let far = |moment: &&Moment| moment.off.is_some_and(|off| off <= MAX_RUN_DIFFERENCE * compared.size);
        let near = compared.moments.iter().skip(1).take_while(far).filter_map(|moment| moment.squares);
        let (count, [coarse, fine]) = near
            .fold((0.0, [0.0; 2]), |(n, sum), squares| (n + 1.0, [sum[0] + squares[0], sum[1] + squares[1]]));
        let rounding = RELATIVE_ROUNDING * compared.size;
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
            measured if (measured - nominal).abs() <= ORDER_TOLERANCE => Order::Nominal { measured },
            measured => Order::Other { measured },
        }
    }

    /// Returns the ratio of a run's error to its difference from the run at half the timestep.
    pub(super) fn factor(self, method: &Method) -> f64 {
        match self {
            // The finer run of an adaptive method has a tenth of the tolerance, so about a tenth of the error.
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
        measured: &ComparedBodies,
        compared: &Compared,
        other: Option<&Other>,
        accuracy: f64,
    ) -> Verdict {
        let order = Order::of(compared, own.method);
        let (factor, size) = (order.factor(own.method), compared.size);
        let contacts = scene.simulation.contacts;
        let (drift_scale, energy) = compared.energy.scale(contacts);
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
        let error = bodies.iter().map(|(error, _)| *error).fold(0.0, f64::max);
        let other_scheme = other.map(|other| {
            let name = |body: usize| scene.bodies[measured.bodies[body]].name.to_string();
            other.judge(name, &compared.other, error, accuracy * size, size)
        });
        bodies.sort_by(|(one, _), (two, _)| two.total_cmp(one));
        let runs = ["the run", "the run at half the step", "the run at a quarter of the step", "the twin"];
        let broken = runs.iter().zip(&compared.ended);
        let broken = broken.filter_map(|(run, ended)| Some(Broken::of(run, ended.as_ref()?)));
        let accounts = Accounts::NAMES.into_iter().zip(compared.accounts.to_array());
        // In time stepping, joints give way, and this account holds the energy that they take.
        let is_stepped = contacts == Some(ContactLaw::TimeStepping);
        let accounts = accounts.map(|(name, held)| match name {
            "limits" if is_stepped => ("joints", held),
            name => (name, held),
        });
        let outside = OutsideInfluence::of(scene);
        let curves = Curves::of(compared, factor, energy);
        let ended = compared.ended[0].is_some();
        let (neighbours, megno) = parting(&curves.times, &curves.neighbours);
        Verdict {
            drift: compared.energy.drift(contacts),
            drift_scale,
            accounts: accounts
                .filter(|(_, held)| held.abs() > 1e-11 * compared.energy.largest_kinetic)
                .collect(),
            broken_laws: compared.laws.iter().filter(|it| it.is_broken()).map(BrokenLaw::of).collect(),
            linear_momentum: conserved(compared, 0, outside.linear),
            angular_momentum: conserved(compared, 1, outside.angular),
            size,
            error,
            bodies: bodies.into_iter().map(|(_, error)| error).collect(),
            order,
            other_scheme,
            neighbours,
            megno,
            trusted: AccurateUntil::of(compared, factor, accuracy * size, ended),
            trusted_to_a_percent: AccurateUntil::of(compared, factor, 0.01 * size, ended),
            broken: broken.collect(),
            curves,
        }
    }

    /// Returns true if nothing is known that speaks against the estimated error: the scene has no contacts, or its run under the other
    /// contact law agrees, and contacts have broken no law.
    pub(super) fn is_confirmed(&self) -> bool {
        self.broken_laws.is_empty() && self.other_scheme.as_ref().is_none_or(OtherScheme::confirms)
    }

    /// Returns true if the run is known to be wrong: contacts have broken a law, or the run under the other contact law differs by more
    /// than `wanted`, m, and no error explains it. No method and no step can then be recommended.
    pub(super) fn is_contradicted(&self, wanted: f64) -> bool {
        let other = self.other_scheme.as_ref();
        !self.broken_laws.is_empty() || other.is_some_and(|other| other.contradicts(wanted))
    }

    /// Returns true if the run is accurate enough to show the size of the scene.
    pub(super) fn knows_the_size(&self) -> bool {
        self.error < 0.1 * self.size && self.broken.is_empty()
    }

    /// Returns the results that the comparison gives for the scene's own method: at its timestep, and at half of it.
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

/// Decides whether a run conserves a momentum (`kind`: 0 linear, 1 angular). `is_changed` is true if an influence from outside changes it.
/// Runs at other timesteps cannot decide this: the changes by impacts depend on the timestep as errors do.
fn conserved(compared: &Compared, kind: usize, is_changed: bool) -> Conserved {
    /// The largest change of a momentum that counts as an error even if an influence from outside may act, as a fraction of the largest sum
    /// of the magnitudes of all bodies' momenta.
    const MAX_MOMENTUM_ERROR: f64 = 1e-9;
    let most = compared.momenta[kind];
    if most == 0.0 {
        return Conserved::Still;
    }
    let largest = compared.moments.iter().map(|moment| moment.changed[kind]).fold(0.0, f64::max);
    if is_changed && largest > MAX_MOMENTUM_ERROR * most {
        return Conserved::Changed;
    }
    Conserved::Kept { drift: largest / most }
}

impl AccurateUntil {
    /// Finds the time until which a run's error is at most `most` meters. `factor` converts the difference of two runs to the error;
    /// `ended` is true if the run broke down.
    fn of(compared: &Compared, factor: f64, most: f64, ended: bool) -> AccurateUntil {
        let is_right = |moment: &&Moment| moment.off.is_some_and(|off| factor * off <= most);
        let frames = compared.moments.iter().take_while(is_right).count();
        let last = compared.moments[..frames].last().filter(|_| frames > 1);
        AccurateUntil {
            until: last.map(|moment| moment.time),
            frame: frames.saturating_sub(1),
            to_the_end: frames == compared.moments.len() && !ended,
        }
    }
}

impl Curves {
    /// The curves of a comparison. `factor` converts the difference of two runs to the error. The drift is relative to `energy`, J.
    fn of(compared: &Compared, factor: f64, energy: f64) -> Curves {
        let Compared { moments, size, fastest, .. } = compared;
        let part = |of: f64, whole: f64| if whole > 0.0 { of / whole } else { 0.0 };
        let apart = |moment: &Moment| {
            let [place, faster, angle] = moment.apart?;
            Some((part(place, size * size) + part(faster, fastest * fastest) + angle).sqrt())
        };
        Curves {
            times: moments.iter().map(|moment| moment.time).collect(),
            drift: moments.iter().map(|moment| part(moment.energy, energy)).collect(),
            error: moments.iter().map_while(|moment| Some(part(factor * moment.off?, *size))).collect(),
            neighbours: moments.iter().map_while(apart).collect(),
        }
    }
}
