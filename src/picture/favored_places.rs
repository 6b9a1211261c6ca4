//! Chooses the favored places of texts over a whole run.
//!
//! If each frame chose the best place for itself, texts would jump in a film. So each text has favored places: those with the lowest costs over a
//! sample of frames, where each change of place costs something, too. Between two such places, it glides.

use std::collections::HashMap;

use super::occupancy::Rectangle;
use super::surroundings::{Key, Movable, Surroundings};

/// The cost of another favored place than in the frame before in the sample, and the additional cost for each height of a line between the
/// two places.
const COSTS_OF_CHANGE: [f64; 2] = [2.0, 0.5];
/// How long a text glides before and after a change of its place, in frames of the sample.
const FRAMES_OF_GLIDE: f64 = 2.0;

/// A frame of a sample: its time, s, what its texts evade, and the texts with their possible places.
pub(super) type Sample<'a> = (f64, Surroundings, Vec<Movable<'a>>);

/// The favored places of all texts of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Favored {
    /// The times of the frames in the sample, s, in order.
    times: Vec<f64>,
    /// For each text, the index of its favored place in each frame of the sample. `None` where the text is absent.
    places: HashMap<Key, Vec<Option<usize>>>,
}

impl Favored {
    /// Chooses the favored places of texts that a sample of frames shows. A text that comes later in a frame evades those before it.
    pub(super) fn new(samples: Vec<Sample<'_>>) -> Favored {
        let mut favored =
            Favored { times: samples.iter().map(|(time, ..)| *time).collect(), ..Favored::default() };
        let mut keys = Vec::new();
        let mut samples: Vec<(Surroundings, HashMap<Key, Movable<'_>>)> = samples
            .into_iter()
            .map(|(_, around, movables)| {
                keys.extend(movables.iter().map(|movable| movable.key.clone()));
                (around, movables.into_iter().map(|movable| (movable.key.clone(), movable)).collect())
            })
            .collect();
        for key in keys {
            if favored.places.contains_key(&key) {
                continue;
            }
            let places = cheapest(samples.iter().map(|(around, movables)| (around, movables.get(&key))));
            for ((around, movables), place) in samples.iter_mut().zip(&places) {
                if let (Some(movable), Some(place)) = (movables.get(&key), place) {
                    around.texts.take_text(&movable.at(&movable.places[*place]));
                }
            }
            favored.places.insert(key, places);
        }
        favored
    }

    /// The indices and weights of the favored places of a text at a time (s). Empty if the sample does not show it near this time.
    #[allow(clippy::cast_precision_loss, reason = "there are few frames in a sample")]
    pub(super) fn at(&self, key: &Key, time: f64) -> Vec<(usize, f64)> {
        let Some(places) = self.places.get(key) else { return Vec::new() };
        let next = self.times.partition_point(|sample| *sample <= time).clamp(1, self.times.len());
        let here = match self.times.get(next) {
            Some(end) => (next - 1) as f64 + (time - self.times[next - 1]) / (end - self.times[next - 1]),
            None => (next - 1) as f64,
        };
        let weight = |number: usize| 1.0 - (number as f64 - here).abs() / FRAMES_OF_GLIDE;
        let weighted = places.iter().enumerate().map(|(number, place)| Some(((*place)?, weight(number))));
        weighted.flatten().filter(|(_, weight)| *weight > 0.0).collect()
    }
}

/// The cheapest series of places of a text in a sample of frames, by dynamic programming (Viterbi algorithm). `None` where the text is absent.
fn cheapest<'s, 't: 's>(
    sample: impl Iterator<Item = (&'s Surroundings, Option<&'s Movable<'t>>)>,
) -> Vec<Option<usize>> {
    // The least cost of each place up to the present frame, and the place before that leads to it.
    let mut costs: Vec<f64> = Vec::new();
    let mut before: Vec<Option<Vec<usize>>> = Vec::new();
    for (around, movable) in sample {
        let Some(movable) = movable else {
            before.push(None);
            continue;
        };
        costs.resize(movable.places.len(), 0.0);
        let areas: Vec<Rectangle> = movable.places.iter().map(movable.area(around.texts.aspect())).collect();
        let change = |from: usize, to: usize| {
            let [change, farther] = COSTS_OF_CHANGE;
            change + farther * movable.distance(areas[from], areas[to])
        };
        let cheapest = least(&costs);
        let mut next = Vec::with_capacity(costs.len());
        let mut leading = Vec::with_capacity(costs.len());
        for (to, place) in movable.places.iter().enumerate() {
            let mut best = (costs[to], to);
            for (from, cost) in costs.iter().enumerate() {
                // Most places cannot lead to a lower cost, by any way.
                if from != to && cost + COSTS_OF_CHANGE[0] < best.0 {
                    let cost = cost + change(from, to);
                    best = if cost < best.0 { (cost, from) } else { best };
                }
            }
            next.push(best.0 - costs[cheapest] + place.cost + around.covered(areas[to]));
            leading.push(best.1);
        }
        costs = next;
        before.push(Some(leading));
    }
    let mut place = least(&costs);
    let mut places: Vec<Option<usize>> = before
        .into_iter()
        .rev()
        .map(|before| {
            let here = place;
            before.map(|before| {
                place = before[here];
                here
            })
        })
        .collect();
    places.reverse();
    places
}

/// The index of the least cost; of equal ones, the first.
fn least(costs: &[f64]) -> usize {
    (0..costs.len()).min_by(|one, other| costs[*one].total_cmp(&costs[*other])).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::super::surroundings::tests::{AT_ZERO, NEAR, movable, surroundings};
    use super::*;

    /// The places of a text in a run of 20 frames, where something is at its usual place in some of them.
    fn in_run(is_taken: impl Fn(usize) -> bool) -> Favored {
        let sample = |number: usize| {
            let mut around = surroundings();
            if is_taken(number) {
                around.lines.take(AT_ZERO);
            }
            (number as f64, around, vec![movable(&NEAR)])
        };
        Favored::new((0..20).map(sample).collect())
    }

    #[test]
    fn a_text_changes_its_place_only_where_this_is_better_for_long() {
        let places = |favored: &Favored| favored.places[&Key::Label(0)].clone();
        assert_eq!(places(&in_run(|number| number == 7)), [Some(0); 20]);
        assert_eq!(
            places(&in_run(|number| number % 3 != 0)),
            [Some(0); 20],
            "the other place costs about as much"
        );
        let mut around = in_run(|_| false);
        around.places.insert(Key::Label(1), vec![None, Some(3), Some(3), Some(4)]);
        around.times.truncate(4);
        assert_eq!(around.at(&Key::Label(1), 0.0), [(3, 1.0 - 1.0 / FRAMES_OF_GLIDE)]);
        assert_eq!(around.at(&Key::Label(1), 9.0).last(), Some(&(4, 1.0)), "after the last frame");
        assert_eq!(around.at(&Key::Label(2), 0.0), []);
    }

    /// A text stays away as long as another text is at its usual place, and returns only then.
    #[test]
    fn a_change_has_the_least_cost_over_the_run() {
        let sample = |number: usize| {
            let mut around = surroundings();
            if (5..9).contains(&number) {
                around.texts.take(AT_ZERO);
            }
            (number as f64, around, vec![movable(&NEAR)])
        };
        let favored = Favored::new((0..40).map(sample).collect());
        let expected: Vec<_> = (0..40).map(|number| Some(usize::from((5..9).contains(&number)))).collect();
        assert_eq!(favored.places[&Key::Label(0)], expected);
    }
}
