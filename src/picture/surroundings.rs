//! Chooses the place of a text near a point or a body.
//!
//! A text belongs to what it names, so it stays near it. It never covers another text if it can evade it, and it evades lines and bodies only as
//! far as that keeps it near. So a field full of lines does not send a name across the picture.

use super::occupancy::Occupancy;
use super::text::Text;

/// The cost of covering another text or a panel. All costs are in heights of a line: so far a text goes to evade what it would cover.
const COST_OF_TEXT: f64 = 100.0;
/// The cost of covering an arrow, a joint or another line.
const COST_OF_LINE: f64 = 1.2;
/// The cost of covering a body.
const COST_OF_BODY: f64 = 1.1;

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
    /// Chooses the place with the lowest cost, and marks it as taken. Each place comes with the cost of its distance from the usual one, in
    /// heights of a line. Of equal places, the first counts. `None` without places.
    pub(super) fn settle<'a>(&mut self, places: impl Iterator<Item = (Text<'a>, f64)>) -> Option<Text<'a>> {
        let mut best: Option<(Text<'a>, f64)> = None;
        for (text, distance) in places {
            if best.as_ref().is_some_and(|(_, cost)| distance >= *cost) {
                continue;
            }
            let covered =
                [(&self.texts, COST_OF_TEXT), (&self.lines, COST_OF_LINE), (&self.bodies, COST_OF_BODY)];
            let covered = covered.into_iter().filter(|(taken, _)| !taken.has_room_for(&text));
            let cost = distance + covered.map(|(_, cost)| cost).sum::<f64>();
            if best.as_ref().is_none_or(|(_, least)| cost < *least) {
                best = Some((text, cost));
            }
        }
        let (text, _) = best?;
        self.texts.take_text(&text);
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::super::occupancy::Rectangle;
    use super::super::text::Vertical;
    use super::*;
    use crate::scene::Color;

    fn text(x: f64) -> Text<'static> {
        let y = Vertical::Middle(0.0);
        let says = "text".into();
        Text { name: "t", says, x, y, height: 0.1, align: 0.5, color: Color::WHITE, anchor: None }
    }

    fn surroundings() -> Surroundings {
        let [texts, lines, bodies] = [(); 3].map(|()| Occupancy::new(0.5));
        Surroundings { texts, lines, bodies }
    }

    const AT_ZERO: Rectangle = Rectangle { left: -0.1, right: 0.1, bottom: -0.1, top: 0.1 };

    #[test]
    fn a_text_evades_a_body_and_a_line_only_as_far_as_it_stays_near() {
        let near = || [(text(0.0), 0.0), (text(0.5), 1.0)].into_iter();
        let far = || [(text(0.0), 0.0), (text(0.5), 4.0)].into_iter();
        for take in
            [|it: &mut Surroundings| it.bodies.take(AT_ZERO), |it: &mut Surroundings| it.lines.take(AT_ZERO)]
        {
            for (places, expected) in [(near().collect::<Vec<_>>(), 0.5), (far().collect(), 0.0)] {
                let mut around = surroundings();
                take(&mut around);
                assert_eq!(around.settle(places.into_iter()).unwrap().x, expected);
            }
        }
        let mut around = surroundings();
        around.texts.take(AT_ZERO);
        assert_eq!(around.settle(far()).unwrap().x, 0.5, "another text is evaded at any distance");
        assert_eq!(around.settle(near()).unwrap().x, 0.0, "if all places are taken, the nearest one counts");
    }
}
