//! The classical Runge–Kutta method of order 4.

use super::super::{State, System};
use super::runge_kutta::{Slope, follow};
use super::torque_free::{Stage, TorqueFree};
use super::{Integrator, Method};

/// The classical Runge–Kutta method. Source: W. Kutta, Z. Math. Phys. 46 (1901) 435; Hairer, Nørsett & Wanner, *Solving Ordinary
/// Differential Equations I*, II.1, table 1.2.
pub(super) const METHOD: Method = Method {
    name: "rk4",
    order: 4,
    symplectic: false,
    constraints: true,
    adaptive: false,
    summary: "fourth order: accurate over short times, loses energy slowly over long ones",
    create: || Box::new(Rk4::default()),
    take_over: None,
};

#[derive(Clone, Default)]
struct Rk4 {
    stage: State,
    slopes: [Slope; 4],
    straight: TorqueFree,
}

impl Integrator for Rk4 {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let half = 0.5 * dt;
        let Self { stage, slopes: [k1, k2, k3, k4], straight } = self;
        if TorqueFree::suits(system) {
            let stages = [
                Stage { time: t, weight: 1.0 / 6.0, next: half },
                Stage { time: t + half, weight: 1.0 / 3.0, next: half },
                Stage { time: t + half, weight: 1.0 / 3.0, next: dt },
                Stage { time: t + dt, weight: 1.0 / 6.0, next: 0.0 },
            ];
            return straight.advance(system, &stages, dt, state);
        }

        k1.measure(system, t, state);
        stage.clone_from(state);
        follow([(1.0, k1)], half, stage);
        k2.arrive(system, t + half, stage);
        stage.clone_from(state);
        follow([(1.0, k2)], half, stage);
        k3.arrive(system, t + half, stage);
        stage.clone_from(state);
        follow([(1.0, k3)], dt, stage);
        k4.arrive(system, t + dt, stage);
        follow([(1.0 / 6.0, k1), (1.0 / 3.0, k2), (1.0 / 3.0, k3), (1.0 / 6.0, k4)], dt, state);
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
