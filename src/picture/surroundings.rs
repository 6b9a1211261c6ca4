//! Chooses the place of a text near a point or a body.
//!
//! A text belongs to what it names, so it stays near it. It never covers another text if it can evade it, and it evades lines and bodies only as
//! far as that keeps it near. So a field full of lines does not send a name across the picture. It leaves its favored places
//! (`favored_places.rs`) only where it would cover another text, or much else.

use super::occupancy::{Occupancy, Rectangle};
use super::text::{Text, Vertical};

/// The cost of covering another text or a panel. All costs are in heights of a line: so far a text goes to evade what it would cover.
const COST_OF_TEXT: f64 = 100.0;
/// The cost of covering an arrow, a joint or another line.
const COST_OF_LINE: f64 = 1.2;
/// The cost of covering a body.
const COST_OF_BODY: f64 = 1.1;
/// The cost of leaving the favored place in a single frame, and the additional cost for each height of a line between the two places. A text
/// that would cover only a line or only a body stays.
const COSTS_OF_LEAVING: [f64; 2] = [1.5, 0.6];
/// A text that has several possible places.
pub(super) struct Movable<'a> {
    pub(super) key: Key,
    /// The text, at any place.
    pub(super) text: Text<'a>,
    /// The places, in the same order in all frames. Of places with equal costs, the first one counts.
    pub(super) places: Vec<TextPlace>,
}

/// Identifies a text in all frames of a run.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Key {
    /// A note, by its name and number.
    Note(String, u8),
    /// A label beside its body, by its index in the scene.
    Label(usize),
    /// A label beside a ghost, by its index in the scene and the bits of the ghost's time.
    Ghost(usize, u64),
}

/// A possible place of a text.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextPlace {
    pub(super) x: f64,
    pub(super) y: Vertical,
    pub(super) align: f64,
    /// The cost of the distance from the usual place, in heights of a line.
    pub(super) cost: f64,
}

impl<'a> Movable<'a> {
    pub(super) fn at(&self, place: &TextPlace) -> Text<'a> {
        let TextPlace { x, y, align, .. } = *place;
        Text { x, y, align, ..self.text.clone() }
    }

    /// Returns a function that gives the area of the text at a place. The width of the text is computed once.
    pub(super) fn area(&self, aspect: f64) -> impl Fn(&TextPlace) -> Rectangle + use<> {
        let (area, y) = (self.text.area(aspect), self.text.y.above_middle(aspect));
        let wide = area.right - area.left;
        move |place| {
            let (left, up) = (place.x - place.align * wide, place.y.above_middle(aspect) - y);
            Rectangle { left, right: left + wide, bottom: area.bottom + up, top: area.top + up }
        }
    }

    /// The distance between two places of the text, given by its areas there, in heights of a line.
    pub(super) fn distance(&self, from: Rectangle, to: Rectangle) -> f64 {
        libm::hypot(to.left - from.left, to.bottom - from.bottom) / self.text.height
    }

    /// The mean of places with these indices and weights. `None` without places.
    fn mean(&self, weighted: &[(usize, f64)], aspect: f64) -> Option<TextPlace> {
        let (first, _) = *weighted.first()?;
        if weighted.iter().all(|(place, _)| *place == first) {
            return self.places.get(first).map(|place| TextPlace { cost: 0.0, ..*place });
        }
        let (mut mean, mut y, mut total) =
            (TextPlace { x: 0.0, y: Vertical::Middle(0.0), align: 0.0, cost: 0.0 }, 0.0, 0.0);
        for (place, weight) in weighted {
            let place = self.places.get(*place)?;
            mean.x += weight * place.x;
            mean.align += weight * place.align;
            y += weight * place.y.above_middle(aspect);
            total += weight;
        }
        Some(TextPlace {
            x: mean.x / total,
            y: Vertical::Middle(y / total),
            align: mean.align / total,
            cost: 0.0,
        })
    }
}

/// What texts near points and bodies evade.
pub(super) struct Surroundings {
    /// Texts, panels and the scale bar.
    pub(super) texts: Occupancy,
    /// Arrows, axes, springs, joints and the lines of marks.
    pub(super) lines: Occupancy,
    /// Bodies and their ghosts.
    pub(super) bodies: Occupancy,
}

impl Surroundings {
    /// The cost of what a text would cover.
    pub(super) fn covered(&self, area: Rectangle) -> f64 {
        let covered =
            [(&self.texts, COST_OF_TEXT), (&self.lines, COST_OF_LINE), (&self.bodies, COST_OF_BODY)];
        covered.into_iter().filter(|(taken, _)| !taken.is_free(area)).map(|(_, cost)| cost).sum()
    }

    /// Chooses the place with the lowest cost, and marks it as taken. `favored` are the indices and weights of the favored places. `None`
    /// without places.
    pub(super) fn settle<'a>(&mut self, movable: &Movable<'a>, favored: &[(usize, f64)]) -> Option<Text<'a>> {
        let aspect = self.texts.aspect();
        let area = movable.area(aspect);
        let favored = movable.mean(favored, aspect);
        let with_leaving = |place: &TextPlace| {
            let [leaving, farther] = COSTS_OF_LEAVING;
            let distance = |favored: TextPlace| movable.distance(area(&favored), area(place));
            place.cost + favored.map_or(0.0, |favored| leaving + farther * distance(favored))
        };
        let places = movable.places.iter().map(|place| TextPlace { cost: with_leaving(place), ..*place });
        let mut best: Option<TextPlace> = None;
        for mut place in favored.into_iter().chain(places) {
            let is_better = |place: &TextPlace| best.is_none_or(|best| place.cost < best.cost);
            if is_better(&place) {
                place.cost += self.covered(area(&place));
                best = if is_better(&place) { Some(place) } else { best };
            }
        }
        let text = movable.at(&best?);
        self.texts.take_text(&text);
        Some(text)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::font::Typeface;
    use crate::scene::Color;

    fn text() -> Text<'static> {
        Text {
            name: "t",
            says: "text".into(),
            x: 0.0,
            y: Vertical::Middle(0.0),
            height: 0.1,
            align: 0.5,
            color: Color::WHITE,
            typeface: Typeface::usual(),
            anchor: None,
        }
    }

    /// A text with places at these distances to the right of the middle, with these costs.
    pub(in super::super) fn movable(places: &[(f64, f64)]) -> Movable<'static> {
        let place =
            |(x, cost): &(f64, f64)| TextPlace { x: *x, y: Vertical::Middle(0.0), align: 0.5, cost: *cost };
        Movable { key: Key::Label(0), text: text(), places: places.iter().map(place).collect() }
    }

    pub(in super::super) fn surroundings() -> Surroundings {
        let [texts, lines, bodies] = [(); 3].map(|()| Occupancy::new(0.5));
        Surroundings { texts, lines, bodies }
    }

    pub(in super::super) const AT_ZERO: Rectangle =
        Rectangle { left: -0.1, right: 0.1, bottom: -0.1, top: 0.1 };
    pub(in super::super) const NEAR: [(f64, f64); 2] = [(0.0, 0.0), (0.5, 1.0)];
    const FAR: [(f64, f64); 2] = [(0.0, 0.0), (0.5, 4.0)];

    #[test]
    fn a_text_evades_a_body_and_a_line_only_as_far_as_it_stays_near() {
        for take in
            [|it: &mut Surroundings| it.bodies.take(AT_ZERO), |it: &mut Surroundings| it.lines.take(AT_ZERO)]
        {
            for (places, expected) in [(NEAR, 0.5), (FAR, 0.0)] {
                let mut around = surroundings();
                take(&mut around);
                assert_eq!(around.settle(&movable(&places), &[]).unwrap().x, expected);
            }
        }
        let mut around = surroundings();
        around.texts.take(AT_ZERO);
        assert_eq!(
            around.settle(&movable(&FAR), &[]).unwrap().x,
            0.5,
            "another text is evaded at any distance"
        );
        assert_eq!(
            around.settle(&movable(&NEAR), &[]).unwrap().x,
            0.0,
            "if all are taken, the nearest one counts"
        );
    }

    #[test]
    fn a_text_leaves_its_favored_place_only_for_a_text_or_much_else() {
        let mut around = surroundings();
        around.lines.take(AT_ZERO);
        let at_zero = [(0, 1.0)];
        let near = [(0.0, 0.0), (0.25, 0.0)];
        assert_eq!(around.settle(&movable(&near), &[]).unwrap().x, 0.25);
        let mut around = surroundings();
        around.lines.take(AT_ZERO);
        assert_eq!(around.settle(&movable(&near), &at_zero).unwrap().x, 0.0);
        let mut around = surroundings();
        around.texts.take(AT_ZERO);
        assert_eq!(around.settle(&movable(&near), &at_zero).unwrap().x, 0.25);
        let favored = surroundings().settle(&movable(&FAR), &[(0, 1.0), (1, 3.0)]).unwrap();
        assert_eq!(favored.x, 0.375, "between two favored places, it glides");
    }
}
