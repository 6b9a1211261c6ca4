//! Tests of impacts, friction, rest and rolling against closed forms.

use std::collections::BTreeSet;

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, BodyId, Contacts, Dynamics, METHODS, Method, RigidBody, Rod, Shape, Surface, UniformGravity,
    World,
};

use crate::common::method;

pub(crate) const G: f64 = 9.81;
const STEP: f64 = 1.0 / 240.0;

/// Builds a world in which all bodies can be in contact with each other.
pub(crate) struct Table {
    world: World,
    shapes: Vec<Shape>,
    surfaces: Vec<Option<Surface>>,
    gravity: bool,
}

impl Table {
    pub(crate) fn new(method: &'static Method, gravity: bool) -> Table {
        let mut world = World::new();
        world.set_integrator(method);
        world.set_step(STEP);
        Table { world, shapes: Vec::new(), surfaces: Vec::new(), gravity }
    }

    pub(crate) fn add(
        &mut self,
        shape: Shape,
        mass: f64,
        surface: Surface,
        place: impl FnOnce(RigidBody) -> RigidBody,
    ) -> BodyId {
        let body = RigidBody::new(&shape, mass);
        self.shapes.push(shape);
        self.surfaces.push(Some(surface));
        self.world.add(place(body))
    }

    pub(crate) fn floor(&mut self, surface: Surface) -> BodyId {
        self.add(Shape::Plane { normal: DVec3::Y }, 1.0, surface, |body| body.with_fixed(true))
    }

    pub(crate) fn build(mut self) -> World {
        let surfaces = std::mem::take(&mut self.surfaces);
        let mut world = self.build_without_contacts();
        world.collide(Contacts { surfaces, apart: BTreeSet::new() });
        world
    }

    fn build_without_contacts(mut self) -> World {
        self.world.add_shapes(self.shapes);
        if self.gravity {
            self.world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -G, 0.0) });
        }
        self.world
    }
}

/// Advances the world to the time `t`, and asserts that no simulation error occurs.
#[allow(clippy::unwrap_used, reason = "only tests call it")]
pub(crate) fn advance(world: &mut World, t: f64) {
    world.advance(t, &[], &mut |_| {}).unwrap();
}

pub(crate) fn surface(restitution: f64, friction: f64) -> Surface {
    Surface { restitution: Some(restitution), friction: Some(friction), rolling_friction: None }
}

/// Returns the methods that give exact locations under constant forces.
pub(crate) fn exact() -> [&'static Method; 2] {
    [method("velocity-verlet"), method("rk4")]
}

/// Returns a world with a ball whose lowest point is 1 m above a floor, and the ball's number.
fn dropped(method: &'static Method, restitution: f64) -> (World, BodyId) {
    let mut table = Table::new(method, true);
    table.floor(Surface::default());
    let ball = table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(restitution, 0.0), |body| {
        body.with_location(DVec3::new(0.0, 1.1, 0.0))
    });
    (table.build(), ball)
}

/// Checks that a ball with restitution 1, dropped from 1 m, rises to the same height again: its energy at the 100th apex is that at the
/// first.
#[test]
fn the_hundredth_apex_is_as_high_as_the_first() {
    for method in exact() {
        let (mut world, ball) = dropped(method, 1.0);
        let flight = (2.0 / G).sqrt();
        let apex = flight * 200.0;
        advance(&mut world, apex - 0.5 * flight);
        assert!(world.balance().drift.abs() < 1e-12, "{}", world.balance().drift);
        advance(&mut world, apex);
        let height = world.location(ball).y - 0.1;
        assert!((height - 1.0).abs() < 1e-9, "{}: {height}", method.name);
        assert_eq!(world.impacts().len(), 100);
    }
}

/// Checks the time at which a bouncing ball comes to rest, the sum of infinitely many bounces: t = √(2h/g) (1 + e) / (1 − e).
#[test]
fn a_ball_that_bounces_comes_to_rest_when_it_has_to() {
    for method in exact() {
        let (mut world, ball) = dropped(method, 0.8);
        let rest = (2.0 / G).sqrt() * 1.8 / 0.2;
        advance(&mut world, rest - 1e-6);
        assert!(world.velocity(ball).length() > 0.0, "{}", method.name);
        advance(&mut world, rest + 1e-6);
        assert_eq!(world.velocity(ball), DVec3::ZERO, "{}", method.name);
        for t in [4.1, 5.0, 20.0] {
            advance(&mut world, t);
            assert!((world.location(ball).y - 0.1).abs() < 1e-12, "{}", method.name);
        }
        let balance = world.balance();
        assert!((balance.accounts.impacts + G).abs() < 1e-12 * G, "{balance:?}");
        assert!(balance.drift.abs() < 1e-12, "{balance:?}");
        let snapshot = world.snapshot().unwrap();
        assert!((snapshot.contacts[0].force.y - G).abs() < 1e-12, "{:?}", snapshot.contacts);
    }
}

/// Checks that a solid sphere that slides at 5 m/s rolls at 5/7 of this speed after t = 2 v / (7 μ g).
#[test]
fn a_sphere_that_slides_begins_to_roll() {
    for method in exact() {
        let mut table = Table::new(method, true);
        table.floor(Surface::default());
        let ball = table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(0.0, 0.3), |body| {
            body.with_location(DVec3::new(0.0, 0.1, 0.0)).with_velocity(DVec3::new(5.0, 0.0, 0.0))
        });
        let mut world = table.build();
        let rolls = 2.0 * 5.0 / (7.0 * 0.3 * G);
        advance(&mut world, rolls - 1e-6);
        let slip = world.velocity(ball).x + 0.1 * world.angular_velocity(ball).z;
        assert!((slip - 1e-6 * 3.5 * 0.3 * G).abs() < 1e-9, "{}: {slip}", method.name);
        advance(&mut world, 1.0);
        let slip = world.velocity(ball).x + 0.1 * world.angular_velocity(ball).z;
        assert!(slip.abs() < 1e-14, "{}: {slip}", method.name);
        assert!((world.velocity(ball).x - 25.0 / 7.0).abs() < 1e-9, "{}", method.name);
        let way = 0.5 * (5.0 + 25.0 / 7.0) * rolls + 25.0 / 7.0 * (1.0 - rolls);
        assert!(
            (world.location(ball).x - way).abs() < 1e-9,
            "{} {way} {}",
            method.name,
            world.location(ball)
        );
        let balance = world.balance();
        assert!(balance.drift.abs() < 1e-9, "{balance:?}");
    }
}

/// Checks the number of impacts between two balls and a wall: for a mass ratio of 100ᵏ, the digits of the count are those of π.
#[test]
fn impacts_spell_pi() {
    for method in exact() {
        for (ratio, count) in [(1.0, 3), (100.0, 31), (1e4, 314), (1e6, 3141), (1e8, 31415)] {
            let mut table = Table::new(method, false);
            let smooth = surface(1.0, 0.0);
            table.add(Shape::Plane { normal: DVec3::X }, 1.0, smooth, |body| body.with_fixed(true));
            let ball = Shape::Sphere { radius: 0.1 };
            table.add(ball.clone(), 1.0, smooth, |body| body.with_location(DVec3::X));
            table.add(ball, ratio, smooth, |body| {
                body.with_location(DVec3::new(2.0, 0.0, 0.0)).with_velocity(DVec3::new(-1.0, 0.0, 0.0))
            });
            let mut world = table.build();
            advance(&mut world, 10.0);
            assert_eq!(world.impacts().len(), count, "{}", method.name);
            assert!(world.balance().drift.abs() < 1e-9, "{} {:?}", method.name, world.balance());
        }
    }
}

/// Checks a Newton's cradle of five touching balls, each on two rods: as many balls as were lifted rise on the other side.
#[test]
fn a_cradle_whose_balls_touch_gives_on_what_it_gets() {
    for lifted in 1..4 {
        let mut table = Table::new(method("velocity-verlet"), true);
        let mut balls = Vec::new();
        for i in 0..5 {
            let top = DVec3::new(0.2 * f64::from(i), 1.0, 0.0);
            let angle: f64 = if i < lifted { 0.5 } else { 0.0 };
            let at = top + DVec3::new(-libm::sin(angle), -libm::cos(angle), 0.0);
            let ball = table
                .add(Shape::Sphere { radius: 0.1 }, 1.0, surface(1.0, 0.0), |body| body.with_location(at));
            balls.push((ball, top));
        }
        let mut world = table.build();
        world.set_step(1.0 / 2000.0);
        for (ball, top) in &balls {
            for side in [-0.5, 0.5] {
                let anchor = Anchor::Point(*top + side * DVec3::Z);
                let length = (world.location(*ball) - (*top + side * DVec3::Z)).length();
                world.add_constraint(Rod { between: [anchor, Anchor::centre(*ball)], length });
            }
        }
        let angle = |world: &World, i: usize| {
            let (ball, top) = balls[i];
            let way = world.location(ball) - top;
            libm::atan2(way.x, -way.y).to_degrees()
        };
        let mut most = vec![(0.0_f64, 0.0_f64); 5];
        for k in 1..=2000 {
            advance(&mut world, 0.01 * f64::from(k));
            for (i, most) in most.iter_mut().enumerate() {
                let a = angle(&world, i);
                *most = (most.0.min(a), most.1.max(a));
            }
        }
        // The time of an apex can be missed by half an interval, so an angle is too small by the fraction ½ ω² t² at most, which is 4e-3°.
        let angle = 0.5_f64.to_degrees();
        for (i, (low, high)) in (0..).zip(most) {
            let expected = [if i < lifted { -angle } else { 0.0 }, if i >= 5 - lifted { angle } else { 0.0 }];
            let error = (low - expected[0]).abs().max((high - expected[1]).abs());
            assert!(error < 4e-3, "{lifted} lifted, ball {i}: {low} {high}");
        }
        assert!(world.balance().drift.abs() < 1e-6, "{:?}", world.balance());
    }
}

/// Adds a ramp: a fixed box tilted by an angle α about z. Returns a function from a body's half height to its location and orientation on
/// the ramp.
fn ramp(table: &mut Table, alpha: f64, surface: Surface) -> impl Fn(f64) -> (DVec3, DQuat) + use<> {
    let turn = DQuat::from_rotation_z(alpha);
    let up = turn * DVec3::Y;
    table.add(Shape::Box { size: DVec3::new(40.0, 1.0, 4.0) }, 1.0, surface, |body| {
        body.with_location(-0.5 * up).with_orientation(turn).with_fixed(true)
    });
    move |half| (half * up, turn)
}

/// Checks a block on a ramp: it slides with x = ½ g (sin α − μ cos α) t² if μ < tan α, and stays at rest otherwise.
#[test]
fn a_block_on_a_ramp_slides_or_sticks() {
    let alpha = 30.0_f64.to_radians();
    let (sin, cos) = libm::sincos(alpha);
    for method in exact() {
        for friction in [0.0, 0.1, 0.3, 0.5, 0.57, 0.577, 0.578, 0.7, 1.0] {
            let mut table = Table::new(method, true);
            let place = ramp(&mut table, alpha, Surface::default());
            let (at, turn) = place(0.25);
            let block = table.add(
                Shape::Box { size: DVec3::new(1.0, 0.5, 0.8) },
                2.0,
                surface(0.0, friction),
                |body| body.with_location(at).with_orientation(turn),
            );
            let mut world = table.build();
            advance(&mut world, 1.0);
            let way = (world.location(block) - at).dot(turn * DVec3::NEG_X);
            let expected = (0.5 * G * (sin - friction * cos)).max(0.0);
            assert!((way - expected).abs() < 1e-9, "{} {friction}: {way} {expected}", method.name);
            assert!((world.orientation(block).dot(turn)).abs() > 1.0 - 1e-14);
            assert!((world.location(block) - at).reject_from(turn * DVec3::X).length() < 1e-9);
            let balance = world.balance();
            assert!(expected == 0.0 || balance.drift.abs() < 1e-9, "{balance:?}");
        }
    }
}

/// Checks that sphere, cylinder and hoop roll down a ramp with 5/7, 2/3 and 1/2 of g sin α.
#[test]
fn bodies_race_down_a_ramp() {
    let alpha = 20.0_f64.to_radians();
    for method in exact() {
        let shapes = [
            (Shape::Sphere { radius: 0.3 }, 0.4),
            (Shape::Cylinder { radius: 0.3, height: 0.5 }, 0.5),
            (Shape::Cylinder { radius: 0.3, height: 0.2 }, 1.0),
        ];
        for (shape, moment) in shapes {
            let mut table = Table::new(method, true);
            let place = ramp(&mut table, alpha, surface(0.0, 0.6));
            let (at, turn) = place(0.3);
            let lying = turn * DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
            let inertia = DVec3::new(0.06, moment * 0.09, 0.06);
            let body = table.add(shape.clone(), 1.0, Surface::default(), |body| RigidBody {
                inertia,
                ..body.with_location(at).with_orientation(lying)
            });
            let mut world = table.build();
            advance(&mut world, 1.0);
            let way = (world.location(body) - at).dot(turn * DVec3::NEG_X);
            let expected = 0.5 * G * libm::sin(alpha) / (1.0 + moment);
            assert!((way - expected).abs() < 1e-9, "{} {shape:?}: {way} {expected}", method.name);
            let balance = world.balance();
            assert!(balance.drift.abs() < 1e-9, "{balance:?}");
        }
    }
}

/// Checks a billiard break of sixteen balls: momentum and energy are conserved, and with reversed velocities all balls return.
#[test]
fn a_billiard_break_can_be_reversed() {
    let build = |places: &[(DVec3, DVec3)]| {
        let mut table = Table::new(method("velocity-verlet"), false);
        let balls: Vec<BodyId> = places
            .iter()
            .map(|(place, velocity)| {
                table.add(Shape::Sphere { radius: 0.028 }, 0.17, surface(1.0, 0.0), |body| {
                    body.with_location(*place).with_velocity(*velocity)
                })
            })
            .collect();
        (table.build(), balls)
    };
    let mut places = vec![(DVec3::new(-0.6, 0.0, 0.002), DVec3::new(7.0, 0.0, 0.0))];
    for row in 0..5_u32 {
        for i in 0..=row {
            let side = f64::from(2 * i) - f64::from(row);
            places.push((DVec3::new(0.0505 * f64::from(row), 0.0, 0.0285 * side), DVec3::ZERO));
        }
    }
    let (mut world, balls) = build(&places);
    let before = world.balance();
    let mut count = 0;
    while count < 20 {
        let t = world.time() + 1e-3;
        advance(&mut world, t);
        count += world.impacts().len();
        assert!(t < 1.0, "{count}");
    }
    let turned: Vec<(DVec3, DVec3)> =
        balls.iter().map(|&ball| (world.location(ball), -world.velocity(ball))).collect();
    let time = world.time();
    let (mut back, again) = build(&turned);
    advance(&mut back, time);
    for (ball, (place, velocity)) in again.iter().zip(&places) {
        assert!((back.location(*ball) - place).length() < 1e-6);
        assert!((back.velocity(*ball) + velocity).length() < 1e-6);
    }
    advance(&mut world, 3.0);
    let after = world.balance();
    assert!(
        (after.linear_momentum - before.linear_momentum).length() < 1e-12 * before.linear_momentum.length()
    );
    assert!((after.total - before.total).abs() < 1e-10 * before.total);
}

/// Checks a tumbling box and a double pendulum, far apart: enabling contacts that never happen changes no bit.
#[test]
fn contacts_that_nobody_makes_change_no_digit() {
    for method in METHODS.iter().filter(|method| method.constraints) {
        let run = |touches: bool| {
            let mut table = Table::new(method, true);
            table.floor(surface(1.0, 0.5));
            let size = DVec3::new(0.3, 0.1, 0.2);
            table.add(Shape::Box { size }, 2.0, surface(0.5, 0.5), |body| {
                body.with_location(DVec3::new(-5.0, 50.0, 0.0))
                    .with_angular_velocity(DVec3::new(0.1, 5.0, 0.2))
            });
            let mut bob = |x: f64| {
                let at = DVec3::new(x, 20.0, 0.0);
                table
                    .add(Shape::Sphere { radius: 0.1 }, 1.0, surface(1.0, 0.0), |body| body.with_location(at))
            };
            let [upper, lower] = [1.0, 2.0].map(&mut bob);
            let mut world = if touches { table.build() } else { table.build_without_contacts() };
            let hook = Anchor::Point(DVec3::Y * 20.0);
            world.add_constraint(Rod { between: [hook, Anchor::centre(upper)], length: 1.0 });
            world
                .add_constraint(Rod { between: [Anchor::centre(upper), Anchor::centre(lower)], length: 1.0 });
            (1..=50).for_each(|frame| advance(&mut world, f64::from(frame) / 25.0));
            world.state().clone()
        };
        assert!(run(true) == run(false), "{}", method.name);
    }
}

/// Checks that observing a run changes no bit of it. A ball slides and then rolls, and a block slides; the observed run also returns
/// moments within steps, balances and forces.
#[test]
fn looking_at_contacts_changes_no_bit() {
    for method in exact() {
        let run = |looks: bool| {
            let mut table = Table::new(method, true);
            table.floor(Surface::default());
            table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(0.3, 0.2), |body| {
                let spin = DVec3::new(3.0, 20.0, 40.0);
                body.with_location(DVec3::Y * 0.4)
                    .with_velocity(DVec3::new(3.0, 0.0, 1.0))
                    .with_angular_velocity(spin)
            });
            table.add(Shape::Box { size: DVec3::new(0.4, 0.2, 0.3) }, 1.0, surface(0.0, 0.2), |body| {
                body.with_location(DVec3::new(9.0, 0.1, 0.0)).with_velocity(DVec3::new(1.7, 0.0, 0.9))
            });
            // These balls are far from the others, so they form groups that are advanced one after another.
            for i in 0..4 {
                table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(0.5, 0.2), |body| {
                    let spin = DVec3::new(0.0, 3.0, 10.0);
                    body.with_location(DVec3::new(-4.0 - f64::from(i), 0.3 + 0.1 * f64::from(i), 0.0))
                        .with_angular_velocity(spin)
                });
            }
            let mut world = table.build();
            for frame in 1..=40 {
                let time = |part: f64| (f64::from(frame) - 1.0 + part) / 25.0;
                let moments: Vec<f64> =
                    if looks { vec![time(0.1), time(0.37), time(0.371)] } else { Vec::new() };
                let mut seen = 0;
                world.advance(time(1.0), &moments, &mut |_| seen += 1).unwrap();
                assert_eq!(seen, moments.len());
                if looks {
                    world.snapshot().unwrap();
                    world.balance();
                    world.forces();
                    let mut branch = world.clone();
                    branch.advance(time(1.3), &[], &mut |_| {}).unwrap();
                }
            }
            world.state().clone()
        };
        let [alone, watched] = [false, true].map(run);
        assert!(alone == watched, "{}: {:?} {:?}", method.name, alone.location, watched.location);
    }
}
