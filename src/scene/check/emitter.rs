//! Reads particle emitters from `[emitter.NAME]`.

use std::sync::Arc;

use glam::DVec3;

use super::Context;
use super::read::figure;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::random::Stream;
use crate::physics::{Births, BodyId, Draw, Origin, ParticleSource, Shape, Surface, Triangles, has_surface};
use crate::scene::expand::in_string;
use crate::scene::grammar::emitters::{cuboid, disc, emitter, from, shape, sphere};
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::{Key, KeySpec};
use crate::scene::sampled_number::{SampledFormula, SampledNumber};
use crate::scene::{Body, Color, ContactLaw, Emitter, SimulationSettings};

/// The maximum number of particles of one emitter that are alive at the same time.
const MAX_ALIVE: f64 = 1_000_000.0;
/// The maximum number of particles of one emitter that may collide at the same time with event-driven contacts.
const MAX_COLLIDING: f64 = 1_000.0;
/// The maximum number of timesteps that an emitter may take before time 0.
const MAX_EARLY_STEPS: f64 = 100_000.0;
/// The maximum number of births before time 0. With more births, an `f64` cannot distinguish the birth times.
const MAX_EARLY_BIRTHS: f64 = 1e12;
/// The number of samples that the check of a formula with random numbers draws.
const SAMPLES_PER_FORMULA: u64 = 4096;

/// The keys for the surface properties of particles.
static SURFACE_KEYS: [&Key<Option<f64>>; 2] = [&emitter::RESTITUTION, &emitter::FRICTION];

/// Reads one emitter.
struct Reader<'a, 'c> {
    name: &'a str,
    span: Span,
    view: &'a View<'a>,
    simulation: &'a SimulationSettings,
    bodies: &'a [Body],
    random: Stream,
    context: &'a mut Context<'c>,
}

pub(super) fn read(
    root: &View<'_>,
    simulation: &SimulationSettings,
    bodies: &[Body],
    context: &mut Context<'_>,
) -> Vec<Emitter> {
    let usual_seed = root.get(&scene::SEED);
    let read = |(name, span, view): (&str, Span, View<'_>)| {
        let seed = view.get(&emitter::SEED).unwrap_or(usual_seed);
        let random = Stream::new(u64::from(seed), &format!("emitter.{name}"));
        Reader { name, span, view: &view, simulation, bodies, random, context }.emitter()
    };
    root.named(&scene::EMITTER).into_iter().map(read).collect()
}

impl Reader<'_, '_> {
    fn emitter(&mut self) -> Emitter {
        let view = self.view;
        let births = self.births();
        let (lifetime, longest_life) = self.lifetime(&births);
        let speed = view.get(&emitter::SPEED);
        if let SampledNumber::Formula(formula) = &speed {
            self.each_draw(&emitter::SPEED.spec, formula, &births, |_| None);
        }
        let direction = view.get(&emitter::DIRECTION);
        let (origin, carrier) = self.origin(direction);
        let is_surface = matches!(origin, Origin::Surface(_));
        let source = ParticleSource {
            births,
            lifetime: lifetime.shared(),
            longest_life,
            origin,
            direction: direction.or((!is_surface).then_some(DVec3::Y)),
            spread: view.get(&emitter::SPREAD).to_radians(),
            speed: speed.shared(),
            mass: view.get(&emitter::MASS),
            charge: view.get(&emitter::CHARGE),
            random: self.random.clone(),
        };
        let emitter = Emitter {
            name: self.name.into(),
            source: Arc::new(source),
            carrier,
            radius: view.table(&emitter::SHAPE).table(&shape::SPHERE).get(&sphere::RADIUS).unwrap_or(1.0),
            sizes: view.get_as::<Vec<f64>>(&emitter::SIZE).unwrap_or_else(|| vec![1.0]),
            colors: view.get(&emitter::COLOR).unwrap_or_else(|| vec![Color::WHITE]),
            collides: self.surface(),
            glow: view.get(&emitter::GLOW),
            streak: view.get(&emitter::STREAK),
        };
        self.can_be_advanced();
        self.not_too_many(&emitter);
        self.not_too_early(&emitter);
        if emitter.collides.is_some() {
            self.can_collide(&emitter);
        }
        emitter
    }

    /// Reports an integrator that cannot move particles. Particles need timesteps of equal length.
    fn can_be_advanced(&mut self) {
        let method = self.simulation.method;
        if method.take_over.is_some() {
            let message = format!("the integrator `{}` moves no particles", method.name);
            let error = Diagnostic::error(Code::BadEmitter, message).at(self.span, "");
            let help = "take another one: `simulation.integrator = \"rk4\"`";
            self.context.diagnostics.push(error.help(help));
        }
    }

    /// Reads the surface properties of the particles. `None` if the particles do not collide.
    fn surface(&mut self) -> Option<Surface> {
        let view = self.view;
        let [restitution, friction] = SURFACE_KEYS.map(|key| view.get(key));
        if view.get(&emitter::COLLIDES) {
            return Some(Surface { restitution, friction, rolling_friction: None });
        }
        for key in SURFACE_KEYS {
            let message = format!("`{}` of `{}` has no effect", key.spec.name, self.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            let help = "let bodies stop its particles: `collides = true`";
            let warning = |span| warning.at(span, "its particles do not collide").help(help);
            self.context.diagnostics.extend(view.key_span(key).map(warning));
        }
        None
    }

    /// Reports the reasons why the particles cannot collide, such as too many particles or a body that is a torus.
    fn can_collide(&mut self, emitter: &Emitter) {
        let span = self.view.key_span(&emitter::COLLIDES).unwrap_or(self.span);
        let most = emitter.most_alive(self.simulation.timeline.end());
        match self.simulation.contacts {
            Some(ContactLaw::EventDriven) if most > MAX_COLLIDING && most <= MAX_ALIVE => {
                let message = format!("`{}` would have {most:.0} particles at once that collide", self.name);
                let error = Diagnostic::error(Code::TooManyParticles, message);
                let label = format!("with `event-driven` contacts, at most {MAX_COLLIDING} may");
                let key = self.how_many().name;
                let help = format!(
                    "take the other scheme, which has no such limit: `simulation.contacts = \"time-stepping\"`; or let fewer \
                     be born by `{key}`, or let them live shorter by `lifetime`"
                );
                self.context.diagnostics.push(error.at(span, label).help(help));
            }
            Some(ContactLaw::TimeStepping) => {
                for body in self.bodies.iter().filter(|body| body.collider.is_some()) {
                    if !body.shape.has_torus() {
                        continue;
                    }
                    let message = format!("particles of `{}` cannot collide with `{}`", self.name, body.name);
                    let error = Diagnostic::error(Code::BadContacts, message);
                    let help = format!(
                        "build `{}` as a `compound` of capsules or spheres, or let all pass through it: `collides = false`",
                        body.name
                    );
                    let label = "no distance is computed for a torus";
                    self.context.diagnostics.push(error.at(span, label).help(help));
                    // Stop after the first torus: bodies with a torus are mostly copies of one body.
                    break;
                }
            }
            // Without contacts, `contact::check` reports all keys that need contacts.
            _ => {}
        }
    }

    /// Reads the birth times of the particles.
    fn births(&mut self) -> Births {
        let (view, simulation) = (self.view, self.simulation);
        let start = simulation.timeline.without_rounding(view.get(&emitter::START));
        let end =
            view.get(&emitter::END).map_or(f64::INFINITY, |end| simulation.timeline.without_rounding(end));
        if end < start {
            let message =
                format!("`{}` starts at {} s and ends at {} s", self.name, figure(start), figure(end));
            let error = Diagnostic::error(Code::EndBeforeStart, message);
            let spans = [(&emitter::END.spec, "this must be later"), (&emitter::START.spec, "than this")];
            let spans = spans.into_iter().filter_map(|(key, label)| Some((view.span(key)?, label)));
            self.context.diagnostics.push(spans.fold(error, |error, (span, label)| error.at(span, label)));
        } else if start > simulation.timeline.end() {
            let warning = Diagnostic::warning(Code::NeverThere, format!("`{}` sends out nothing", self.name));
            let label = format!("the scene goes from 0 to {} s", figure(simulation.timeline.end()));
            let span = view.span(&emitter::START).unwrap_or(self.span);
            self.context.diagnostics.push(warning.at(span, label));
        }
        let end = end.max(start);
        let Some(burst) = view.get(&emitter::BURST).filter(|_| view.has(&emitter::BURST)) else {
            if let Some(span) = view.key_span(&emitter::EVERY) {
                let message = format!("`every` of `{}` has no effect", self.name);
                let warning = Diagnostic::warning(Code::NoEffect, message);
                self.context.diagnostics.push(warning.at(span, "it is the time between bursts"));
            }
            return Births::rate(view.get(&emitter::RATE).unwrap_or(1.0), start, end);
        };
        Births {
            start,
            end,
            at_once: u64::from(burst),
            every: view.get(&emitter::EVERY).unwrap_or(f64::INFINITY),
        }
    }

    /// Warns of colors and sizes that change over a life, if lives do not end.
    fn warn_of_endless_lives(&mut self) {
        let is_list = [
            (&emitter::COLOR.spec, self.view.get(&emitter::COLOR).is_some_and(|colors| colors.len() > 1)),
            (
                &emitter::SIZE.spec,
                self.view.get_as::<Vec<f64>>(&emitter::SIZE).is_some_and(|sizes| sizes.len() > 1),
            ),
        ];
        for (key, _) in is_list.into_iter().filter(|(_, is_list)| *is_list) {
            let message = format!("only the first `{key}` of `{}` has an effect", self.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            let help = "give the particles a `lifetime`, over which they change";
            let span = self.view.key_span(key);
            self.context.diagnostics.extend(
                span.map(|span| warning.at(span, "particles without `lifetime` do not age").help(help)),
            );
        }
    }

    /// Reads the lifetime of the particles, and returns it with the longest lifetime, s.
    ///
    /// If a formula gives the lifetime, the longest lifetime is the largest of many samples. Longer lifetimes in the run are cut to the
    /// longest lifetime.
    fn lifetime(&mut self, births: &Births) -> (SampledNumber, f64) {
        let lifetime = self.view.get(&emitter::LIFETIME).unwrap_or(SampledNumber::Constant(f64::INFINITY));
        if let SampledNumber::Constant(f64::INFINITY) = lifetime {
            self.warn_of_endless_lives();
        }
        let longest = match &lifetime {
            SampledNumber::Constant(lifetime) => *lifetime,
            SampledNumber::Formula(formula) => {
                let too_short = |life: f64| (life <= 0.0).then(|| format!("a life of {life:.3} s"));
                self.each_draw(&emitter::LIFETIME.spec, formula, births, too_short)
            }
        };
        (lifetime, longest)
    }

    /// Samples the formula of the key `key` and returns the largest value. Reports the first sample that is non-finite or that `wrong`
    /// rejects.
    fn each_draw(
        &mut self,
        key: &KeySpec,
        formula: &SampledFormula,
        births: &Births,
        wrong: impl Fn(f64) -> Option<String>,
    ) -> f64 {
        let end = births.end.min(self.simulation.timeline.end()).max(births.start);
        let mut largest = f64::MIN_POSITIVE;
        let Some(span) = self.view.span(key) else { return largest };
        for number in 0..SAMPLES_PER_FORMULA {
            #[allow(clippy::cast_precision_loss, reason = "both are small")]
            let t = births.start + (end - births.start) * number as f64 / (SAMPLES_PER_FORMULA - 1) as f64;
            let value = formula.draw(t, &mut self.random.substream(u64::MAX - number));
            if !value.is_finite() {
                let error = formula.explain_non_finite(t, &mut self.random.substream(u64::MAX - number));
                if let Some(error) = error {
                    let raw = self.context.sources.raw(span);
                    let place = in_string(raw, formula.text(), &error.range, span);
                    let diagnostic = Diagnostic::error(error.code, error.message).at(place, error.label);
                    self.context.diagnostics.push(diagnostic);
                }
                return largest;
            }
            if let Some(what) = wrong(value) {
                let message = format!("this formula gives some particles of `{}` {what}", self.name);
                let help = format!("keep it above 0: `{key} = \"max(0.1, {})\"`", formula.text());
                let error = Diagnostic::error(Code::OutOfRange, message).at(span, "").help(help);
                self.context.diagnostics.push(error);
                return largest;
            }
            largest = largest.max(value);
        }
        largest
    }

    /// Reads the point, area or volume in which particles are born, and the body that carries the emitter.
    fn origin(&mut self, direction: Option<DVec3>) -> (Origin, Option<BodyId>) {
        let from = self.view.table(&emitter::FROM);
        let number = |name: Option<&str>| self.context.names.bodies.get(name?).copied();
        let (surface, body) = (number(from.get(&from::SURFACE)), number(from.get(&from::BODY)));
        let carrier = surface.or(body).map(BodyId::new);
        if let (Some(_), Some(span)) = (surface, from.key_span(&from::BODY)) {
            let message = format!("`body` of `{}` has no effect", self.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            self.context.diagnostics.push(warning.at(span, "`surface` names the body"));
        }
        if let Some(surface) = surface {
            let body = &self.bodies[surface];
            if let Shape::Mesh { mesh, scale } = &body.shape {
                return (Origin::Triangles(Triangles::new(mesh, *scale)), carrier);
            }
            if !has_surface(&body.shape) {
                let message = format!("particles cannot come from the surface of `{}`", body.name);
                let error = Diagnostic::error(Code::BadEmitter, message);
                let label = "only from a sphere, box, cylinder, capsule, cone, torus or mesh";
                let help = format!(
                    "`from = {{ point = [0, 0, 0], body = \"{}\" }}` lets them come from a point of it",
                    body.name
                );
                let span = from.span(&from::SURFACE).unwrap_or(self.span);
                self.context.diagnostics.push(error.at(span, label).help(help));
            }
            return (Origin::Surface(body.shape.clone()), carrier);
        }
        if let Some(disc) = from.variant(&from::DISC) {
            let normal = disc.get(&disc::NORMAL);
            let origin = Origin::Disc {
                centre: disc.get(&disc::LOCATION),
                normal: normal.or(direction).unwrap_or(DVec3::Y),
                radius: disc.get(&disc::RADIUS).unwrap_or(1.0),
            };
            return (origin, carrier);
        }
        if let Some(view) = from.variant(&from::BOX) {
            let centre = view.get(&cuboid::LOCATION);
            return (Origin::Box { centre, size: view.get(&cuboid::SIZE).unwrap_or(DVec3::ONE) }, carrier);
        }
        (Origin::Point(from.get(&from::POINT).unwrap_or_default()), carrier)
    }

    /// Reports an emitter that starts too long before time 0. That time is simulated in timesteps, like the run itself.
    fn not_too_early(&mut self, emitter: &Emitter) {
        let births = emitter.source.births;
        let before = births.start.max(-emitter.source.longest_life);
        let longest = MAX_EARLY_STEPS * self.simulation.step.min(self.simulation.timeline.interval());
        let can_be_counted = -births.start / births.every <= MAX_EARLY_BIRTHS;
        if -before <= longest && can_be_counted {
            return;
        }
        let message = format!("`{}` starts {} s before the run", self.name, figure(-births.start));
        let label = format!("at most {} s are computed before", figure(longest));
        let error = Diagnostic::error(Code::OutOfRange, message);
        self.context.diagnostics.push(error.at(self.view.span(&emitter::START).unwrap_or(self.span), label));
    }

    /// Returns the key that says how many particles are born.
    fn how_many(&self) -> &'static KeySpec {
        if self.view.has(&emitter::BURST) { &emitter::BURST.spec } else { &emitter::RATE.spec }
    }

    fn not_too_many(&mut self, emitter: &Emitter) {
        let most = emitter.most_alive(self.simulation.timeline.end());
        // Particles that die before the next frame take computing time too.
        let between_frames = emitter.births_within(self.simulation.timeline.interval());
        let key = self.how_many();
        if most <= MAX_ALIVE && between_frames > MAX_ALIVE {
            let message =
                format!("`{}` would have {between_frames:.0} births from one frame to the next", self.name);
            let error = Diagnostic::error(Code::TooManyParticles, message);
            let label = format!("at most {MAX_ALIVE} are computed");
            self.context.diagnostics.push(error.at(self.view.span(key).unwrap_or(self.span), label));
        }
        if most <= MAX_ALIVE {
            return;
        }
        let message =
            format!("`{}` would have {most:.0} particles at once; at most {MAX_ALIVE} are drawn", self.name);
        let error = Diagnostic::error(Code::TooManyParticles, message);
        let help = format!("let fewer be born by `{key}`, or let them live shorter by `lifetime`");
        let span = self.view.span(key).unwrap_or(self.span);
        self.context.diagnostics.push(error.at(span, "").help(help));
    }
}
