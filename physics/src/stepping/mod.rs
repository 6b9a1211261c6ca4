//! Time-stepping: contacts of many bodies at once, at fixed steps.
//!
//! Among hundreds of touching bodies, impacts cannot be followed one by one. Time-stepping solves all contacts of a step together, as
//! inequalities of velocities, by a few sweeps over all contacts. Source: E. Catto, *Solver2D* (2024), and M. Macklin et al., *Small Steps
//! in Physics Simulation*, SCA 2019. The physics engine is rapier, which finds contacts, and solves contacts and joints. Forces, energies,
//! guided bodies, births and deaths come from a [`World`], whose bodies are taken over.
//!
//! Without contacts and joints, a step gives the same numbers as a step of Euler–Cromer. All forces are evaluated at the start of the
//! step.
//!
//! # Where it is used
//!
//! Scenes with `contacts = "time-stepping"` use this engine if forces move more than sixty bodies, or if a torus
//! collides (`is_by_moreau` in `scene/contact.rs` of jabuka). For fewer bodies, the world's own Moreau scheme is exact
//! in joints and fast enough.
//!
//! The engine takes over a `World`, so forces, given motions, presence, energy accounts and expected energy are the same. One step of jabuka
//! is one step of rapier with a single iteration that makes more sweeps. So all forces are evaluated for each step, all impulses of a step
//! can be read, and a step without contacts equals one of Euler–Cromer, up to rounding. jabuka also computes the rotation: a body gets the
//! angular velocity that leads to the orientation of free rotation (`rotation.rs`), so it conserves its angular momentum. Thin rods on
//! hinges are an exception (`thin_rods.rs`). The stiffness of contacts follows from the step. All small length tolerances of rapier follow
//! from the thinnest moving body.
//!
//! # Where rapier is corrected
//!
//! Each of these files explains one correction of rapier.
//!
//! | what | where |
//! | --- | --- |
//! | the energy of impulses | `bookkeeping.rs` |
//! | rotation of round bodies about their axis | `rolling.rs` |
//! | joints, and velocities that rapier would lose | `mean_velocity.rs`, `mechanisms.rs`, `joint_arcs.rs` |
//! | friction: its direction, and rotating points | `sliding.rs` |
//! | impacts of many points | `bounce.rs` |
//! | rebounds of bodies on joints | `rebound.rs`, `joint_response.rs` |
//! | contacts that rapier would keep | `fresh_contacts.rs`, `kept_contacts.rs` |
//! | concave meshes | `convex_parts.rs` |
//! | planes | `plane.rs` |
//! | surface properties of pairs | `mixing.rs`, `hooks.rs` |
//!
//! - **Energy**: an impulse changes the kinetic energy by its product with the mean of the velocities before and after the step, independent
//!   of other forces. So the loss at each contact is known, and the drift is only the error of the integration. The remaining impulses on a
//!   jointed body come from its joints. Those of motors can be told apart, since rapier puts their equation first in a joint. If bodies are
//!   pushed apart or sink into each other without a velocity, forces do work along this displacement, which the accounts add to the impacts.
//! - **Silent changes** of rapier are undone: there is no limit on speeds or rotations, no damping and no sleeping. rapier disables a body
//!   when its position is not finite; this ends the run. Continuous collision detection leaves spheres slightly inside a surface, where
//!   contacts are soft and a fast sphere would pass through. So such a body is moved to a place just before the surface.
//! - **Joints**: rapier moves bodies by velocities that correct the joints, and then keeps velocities without that correction. Each step
//!   would lose a part of the speed, and a pendulum most of its energy. So bodies on joints keep the mean velocity of the step, unless
//!   something else pushes them. All bodies of a mechanism do, or none. Only corrections that lead joints along their arcs become
//!   velocities, not those of joints that give way.
//! - **Friction**: rapier shortens the impulse that would stop the sliding; for a long body, this impulse has another direction than the
//!   sliding. So a sliding surface gets an additional velocity that leads to the right direction. rapier has a second model, with friction
//!   at each point of a contact. There, blocks slide 13 % too far, and slide on inclines where they should stay.
//! - **Rebounds on joints**: if rapier's sweeps have not found the whole impulse of an impact, the solver of `constraint` says what is
//!   missing.
//! - **Kept contacts**: rapier also keeps whole contacts in world axes, which makes towers stable. For bodies that slide or rotate, contacts
//!   are found anew.
//! - **Concave meshes** that move are cut along their own faces into convex parts, which is exact. rapier's own decomposition, by voxels,
//!   fills notches; it serves only meshes that would need more than 128 parts.
//! - **Planes** perpendicular to an axis are blocks, since rapier compares a half-space with every body.
//! - **Surface properties** of two bodies are combined by rapier's own rules where these suffice, because a pair with a hook is computed
//!   again at every step.

mod advance;
mod bodies;
mod bookkeeping;
mod bounce;
#[cfg(feature = "checkpoints")]
mod checkpoint;
mod contact_body;
mod convex_parts;
mod engine_input;
mod fresh_contacts;
mod hooks;
mod impacts;
mod joint;
mod joint_arcs;
mod joint_response;
mod kept_contacts;
mod mean_velocity;
mod mechanisms;
mod mesh;
mod mixing;
mod non_potential_work;
mod plane;
mod rebound;
mod rolling;
mod rotation;
mod shape;
mod sliding;
mod snapshot;
#[cfg(test)]
mod tests;
mod thin_rods;
mod touch;

use rapier3d_f64::prelude::{IntegrationParameters, PhysicsWorld, RigidBodyHandle, SpringCoefficients};

use self::bookkeeping::Bookkeeping;
use self::engine_input::EngineInput;
use self::joint::Joints;
use self::kept_contacts::KeptContacts;
use self::mean_velocity::MeanVelocity;
use self::mechanisms::Mechanisms;
use self::mixing::Mixing;
use self::non_potential_work::NonPotentialWork;
use self::rebound::Rebounds;
use self::rolling::Rolling;
use self::sliding::Sliding;
use self::thin_rods::ThinRods;
use super::contact::{Contacts, Impact};
use super::presence::PresenceSchedule;
use super::softness::CONTACT_FREQUENCY_RATIO;
use super::{Breakdown, Dynamics, EnergyLedger, Loads, Model, Snapshot, State, World};

pub use joint::{Link, LinkKind};

/// The number of sweeps over all contacts in a step with position correction.
const CONTACT_SWEEPS: usize = 2;
/// The number of final sweeps in a step, without position correction. Only the final sweeps solve friction. With two of them, a block
/// creeps down an incline on which friction should hold it.
const FINAL_CONTACT_SWEEPS: usize = 4;
/// The number of sweeps with position correction in scenes with joints. A sweep passes a force on by one joint only, so fewer sweeps let
/// chains stretch, and joints between light and heavy bodies: a rope bridge of twenty planks by 0.44 m instead of 0.01 m.
const JOINT_SWEEPS: usize = 16;
/// The number of final sweeps in scenes with joints.
const FINAL_JOINT_SWEEPS: usize = 8;
/// The largest number of additional sweeps with position correction for groups of bodies with a small mechanism. Welded beams bend less
/// then: one of eight parts of 5 kg with a load of 100 kg, by 0.08 m instead of 0.4 m.
const MAX_MECHANISM_SWEEPS: usize = 48;
/// The largest product of these additional sweeps and the joints of a mechanism, which limits their cost.
const MAX_JOINT_SOLUTIONS: usize = 1600;
/// The largest speed at which the physics engine separates overlapping bodies and corrects joints, m/s, if the thinnest moving body has a
/// thickness of 1 m. For other thicknesses, this speed grows with the root of the thickness, as the speed after a fall does.
const MAX_CORRECTION_SPEED: f64 = 3.0;
/// The damping ratio of contacts: their damping divided by critical damping.
const CONTACT_DAMPING_RATIO: f64 = 10.0;
/// The speed below which a body counts as resting, m/s, if the thinnest moving body has a thickness of 1 m. For other thicknesses, this
/// speed grows with the root of the thickness, as the speed after a fall does.
const MAX_RESTING_SPEED: f64 = 0.1;

/// Fast bodies stop this far in front of a surface or behind it, as a fraction of the thickness of the thinnest moving body.
const ALLOWED_LINEAR_ERROR: f64 = 0.002;

/// Simulates bodies that move under forces and touch each other, in steps of equal length. All contacts of a step are solved together.
pub struct TimeStepping {
    time: f64,
    step: f64,
    steps: u64,
    model: Model,
    state: State,
    ledger: EnergyLedger,
    calendar: PresenceSchedule,
    /// The physics engine, which finds and solves contacts and joints.
    engine: PhysicsWorld,
    /// The physics engine's handle of each body of the model.
    handles: Vec<RigidBodyHandle>,
    /// The values of each body that are set in the physics engine.
    inputs: Vec<EngineInput>,
    /// Half of each body's thickness, m. A body that moves farther than this within a step counts as fast.
    half_thickness: Vec<f64>,
    /// The largest distance of each body's surface from its centre of mass, m.
    reach: Vec<f64>,
    mixing: Mixing,
    /// Bodies that are slower than this are at rest, m/s: the speed after a fall by a small part of the thinnest moving body.
    slow: f64,
    joints: Joints,
    mean_velocity: MeanVelocity,
    thin_rods: ThinRods,
    rolling: Rolling,
    sliding: Sliding,
    rebounds: Rebounds,
    kept_contacts: KeptContacts,
    books: Bookkeeping,
    driven: NonPotentialWork,
    /// Whether snapshots list the contacts.
    shows_contacts: bool,
    /// Working memory for the loads at one moment.
    loads: Loads,
    /// The state before the last step, from which moments within that step are interpolated.
    before: State,
    /// The bodies that have appeared since the last step, in ascending order.
    newcomers: Vec<usize>,
    failure: Option<Breakdown>,
}

impl TimeStepping {
    /// Takes over the bodies of a world with their forces, motions and lifetimes. Bodies touch each other by the rules of `contacts`, and
    /// `links` join them. Constraints of the world itself are ignored.
    #[must_use]
    pub fn new(world: World, contacts: &Contacts, links: &[Link]) -> TimeStepping {
        let parts = world.into_parts();
        let (mut model, mut state) = (parts.model, parts.state);
        links.iter().for_each(|link| model.push_constraint(link.kind.constraint()));
        let moves: Vec<bool> = bodies::moving(&model);
        let mixing = Mixing::new(contacts, &moves);
        let mut engine = PhysicsWorld::new();
        let length = bodies::typical_length(&model, contacts, &moves);
        engine.gravity = glam::DVec3::ZERO;
        fresh_contacts::find_contacts_anew(&mut engine);
        engine.integration_parameters = parameters(length, !links.is_empty());
        let inserted = bodies::insert(&mut engine, &mut model, &mut state, contacts, &mixing, length);
        let (handles, symmetries) = inserted;
        let joints = Joints::insert(&mut engine, links, &handles, &model);
        let rolling = Rolling::new(&engine, &symmetries, (&model, &joints), length);
        let colliders = symmetries.iter().map(|own| own.iter().map(|(handle, _)| *handle).collect());
        let kept_contacts = KeptContacts::new(&engine, colliders, &state);
        let held = joints.held(model.len());
        let mechanisms = Mechanisms::new(&model, &joints);
        for (body, count) in mechanisms.joint_counts(&joints) {
            if let Some(body) = engine.bodies.get_mut(handles[body]) {
                body.set_additional_pgs_iterations(MAX_MECHANISM_SWEEPS.min(MAX_JOINT_SOLUTIONS / count));
            }
        }
        let slow = MAX_RESTING_SPEED * length.sqrt();
        TimeStepping {
            time: parts.time,
            step: parts.step,
            steps: 0,
            loads: Loads::default(),
            before: State::default(),
            ledger: parts.ledger,
            calendar: parts.calendar,
            books: Bookkeeping::new(model.len(), length, held.clone()),
            rebounds: Rebounds::new(&model, &held, slow),
            reach: bodies::reach(&model),
            thin_rods: ThinRods::new(&joints.hinge_axes(&engine, model.len()), model.inertia(), &mechanisms),
            mean_velocity: MeanVelocity::new(&engine, &joints, mechanisms, model.len()),
            half_thickness: bodies::half_thickness(&model),
            driven: NonPotentialWork::default(),
            shows_contacts: true,
            newcomers: (0..model.len()).filter(|&i| model.is_present(i)).collect(),
            failure: None,
            model,
            state,
            sliding: Sliding::new((0..moves.len()).map(|i| moves[i] && !rolling.is_ball(i)).collect()),
            rolling,
            kept_contacts,
            inputs: EngineInput::read_all(&engine, &handles),
            handles,
            slow,
            engine,
            mixing,
            joints,
        }
    }

    /// Sets whether snapshots list the contacts of their moment, which may be many. The default is true.
    pub fn show_contacts(&mut self, shown: bool) {
        self.shows_contacts = shown;
    }

    /// Sets the longest step, s. It must be positive.
    pub fn set_step(&mut self, step: f64) {
        self.step = step;
    }
}

/// Returns the physics engine's parameters. `length` is the thickness of the thinnest moving body, m.
fn parameters(length: f64, has_joints: bool) -> IntegrationParameters {
    let [sweeps, final_sweeps] =
        if has_joints { [JOINT_SWEEPS, FINAL_JOINT_SWEEPS] } else { [CONTACT_SWEEPS, FINAL_CONTACT_SWEEPS] };
    IntegrationParameters {
        length_unit: length,
        // Each step is a single step of the physics engine, so that forces are evaluated in each step, and all impulses can be read.
        num_solver_iterations: 1,
        num_internal_pgs_iterations: sweeps,
        num_internal_stabilization_iterations: final_sweeps,
        normalized_allowed_linear_error: ALLOWED_LINEAR_ERROR,
        // The physics engine must not limit the speeds of bodies.
        normalized_max_linear_velocity: f64::MAX,
        warmstart_joints: true,
        ..IntegrationParameters::default()
    }
}

/// Sets the length of the physics engine's step, s, and the parameters that depend on the step: the stiffness of contacts, and the largest
/// speed of corrections. Joints need corrections at the speed `correction`, m/s.
fn set_step(parameters: &mut IntegrationParameters, dt: f64, correction: f64) {
    let soft = SpringCoefficients {
        natural_frequency: CONTACT_FREQUENCY_RATIO / dt,
        damping_ratio: CONTACT_DAMPING_RATIO,
    };
    parameters.dt = dt;
    parameters.contact_softness = soft;
    parameters.static_contact_softness = soft;
    let length = parameters.length_unit;
    parameters.normalized_max_corrective_velocity =
        (MAX_CORRECTION_SPEED / length.sqrt()).max(correction / length);
}

impl Dynamics for TimeStepping {
    fn time(&self) -> f64 {
        self.time
    }

    fn advance(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) -> Result<(), Breakdown> {
        if t > self.time && t.is_finite() {
            self.advance_by_events(t, moments, see).map_err(|error| self.model.cause(error))?;
        }
        Ok(())
    }

    fn snapshot(&mut self) -> Result<Snapshot, Breakdown> {
        self.failure.map_or(Ok(()), |error| Err(self.model.cause(error)))?;
        let balance = self.ledger.measure(&self.model, self.time, &self.state);
        self.picture(self.time, balance, None).checked().map_err(|error| self.model.cause(error))
    }

    fn impacts(&mut self) -> Vec<Impact> {
        self.books.impacts.take()
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    #[cfg(feature = "checkpoints")]
    fn checkpoint(&mut self) -> Option<Vec<u8>> {
        self.save()
    }

    #[cfg(feature = "checkpoints")]
    fn resume(&mut self, checkpoint: &[u8]) -> bool {
        self.load(checkpoint)
    }
}
