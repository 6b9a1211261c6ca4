//! Counts the impacts in a run.

use crate::physics::Impact;
use crate::scene::Scene;

/// The numbers of impacts up to a moment. The list is empty if the scene has no contacts.
///
/// The elements are whole numbers: first the total of the run, then one total for each body, then the totals of the pairs that the scene
/// asks for, in reverse order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactCounts(pub(super) Vec<f64>);

impl ImpactCounts {
    /// The length of the list for a scene.
    pub fn size(scene: &Scene) -> usize {
        scene.simulation.contacts.map_or(0, |_| 1 + scene.bodies.len() + scene.pairs.len())
    }

    /// Creates the counts at the start of a run.
    pub(super) fn new(scene: &Scene) -> ImpactCounts {
        ImpactCounts(vec![0.0; ImpactCounts::size(scene)])
    }

    /// Counts an impact for the run, for its bodies and for their pair.
    pub(super) fn note(&mut self, scene: &Scene, impact: &Impact) {
        let bodies = impact.bodies.into_iter().filter(|&id| id < scene.bodies.len()).map(|id| 1 + id);
        let pairs = scene.pairs.iter().enumerate().filter(|(_, pair)| **pair == impact.bodies);
        let last = self.0.len().saturating_sub(1);
        let places: Vec<usize> = bodies.chain(pairs.map(|(pair, _)| last - pair)).chain([0]).collect();
        for place in places {
            self.0.get_mut(place).into_iter().for_each(|count| *count += 1.0);
        }
    }

    /// The number of all impacts in the run.
    pub fn of_run(&self) -> f64 {
        self.0.first().copied().unwrap_or_default()
    }

    /// The number of impacts of a body, given by its index in the scene.
    pub fn of_body(&self, body: usize) -> f64 {
        self.0.get(1 + body).copied().unwrap_or_default()
    }

    /// The number of impacts between the two bodies of a pair, given by its index in the scene's pairs.
    pub fn of_pair(&self, pair: usize) -> f64 {
        let place = self.0.len().checked_sub(1 + pair);
        place.and_then(|place| self.0.get(place)).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn an_impact_counts_for_the_run_its_bodies_and_its_pair() {
        let text = "simulation.contacts = 'event-driven'\ndefaults.body.location = [0, 5, 0]
            [body.a]\nshape.sphere.radius = 1\n[body.b]\nshape.sphere.radius = 1\n[body.c]\nshape.sphere.radius = 1
            [label.l]\ntext = '${b.impacts.a} ${c.impacts.ground} ${impacts}'";
        let scene = Scene::parse(text).unwrap();
        assert_eq!(scene.pairs, [[0, 1], [2, 3]]);
        let mut counts = ImpactCounts::new(&scene);
        for bodies in [[0, 1], [0, 2], [2, 3], [0, 1]] {
            let [place, normal, impulse] = [DVec3::ZERO; 3];
            counts.note(&scene, &Impact { time: 0.0, bodies, place, normal, impulse, energy: 0.0 });
        }
        assert_eq!(counts.of_run(), 4.0);
        assert_eq!([0, 1, 2].map(|body| counts.of_body(body)), [3.0, 2.0, 2.0]);
        assert_eq!([0, 1].map(|pair| counts.of_pair(pair)), [2.0, 1.0]);
    }
}
