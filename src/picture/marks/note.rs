//! Notes: texts at points of the world, placed where there is room.

use glam::DVec3;

use crate::font::Typeface;
use crate::picture::labels::Labels;
use crate::picture::screen::Screen;
use crate::picture::surroundings::{Key, Movable, TextPlace};
use crate::picture::text::{Text, Vertical, width};
use crate::scene::{Color, Piece};
use crate::simulate::MomentState;

/// The gap between a point and its text, in heights of a line.
const TEXT_GAP: f64 = 0.3;
/// The directions in which a text is tried, relative to the wanted one, degrees.
const TRIED_TURNS: [f64; 8] = [0.0, 35.0, -35.0, 70.0, -70.0, 110.0, -110.0, 180.0];
/// The additional distances at which a text is tried, in heights of a line.
const TRIED_DISTANCES: [f64; 5] = [0.0, 0.8, 1.6, 2.5, 3.5];
/// The cost of turning a text away from the wanted direction to the opposite one, in heights of a line.
const COST_OF_HALF_TURN: f64 = 3.0;
/// The cost of a place below its point or to the left of it if both sides are as good, in heights of a line.
const COST_OF_LOWER_SIDE: f64 = 0.3;

/// A text at a point of the world.
pub(in crate::picture) struct Note<'a> {
    /// What the note belongs to, such as `angle alpha`.
    pub(in crate::picture) name: &'a str,
    /// Tells notes of the same name apart.
    pub(in crate::picture) number: u8,
    pub(in crate::picture) says: Says<'a>,
    /// The point, m.
    pub(in crate::picture) at: DVec3,
    /// The direction from the point in which the text stands, a unit vector.
    pub(in crate::picture) away: DVec3,
    pub(in crate::picture) sides: Sides,
    pub(in crate::picture) color: Color,
}

/// The sides of its point on which a note can stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::picture) enum Sides {
    /// In the wanted direction, or near it.
    Wanted,
    /// In the wanted direction or in the opposite one. A place above the point or to the right of it is a little better.
    Both,
}

impl Sides {
    /// The cost of turning a text by an angle (degrees) away from the wanted direction, to the direction `way`.
    fn cost(self, turn: f64, way: [f64; 2]) -> f64 {
        let turn = turn.abs() / 180.0;
        match self {
            Sides::Wanted => turn * COST_OF_HALF_TURN,
            Sides::Both => {
                let is_low = 2.0 * way[1] + way[0] < 0.0;
                turn.min(1.0 - turn) * COST_OF_HALF_TURN + if is_low { COST_OF_LOWER_SIDE } else { 0.0 }
            }
        }
    }
}

/// The words of a note.
pub(in crate::picture) enum Says<'a> {
    /// Pieces of a text that the scene gives, with values of the moment.
    Text(&'a [Piece]),
    /// Words that the picture chooses.
    Words(String),
}

/// The possible places of a note. `None` if it is outside of the picture, or has no letters.
pub(in crate::picture) fn movable<'a>(
    note: Note<'a>,
    labels: &Labels,
    moment: &MomentState<'_>,
    screen: &Screen,
) -> Option<Movable<'a>> {
    let point = screen.project(note.at)?;
    if point.x.abs() > 1.0 || point.y.abs() > labels.aspect() {
        return None;
    }
    let says = match note.says {
        Says::Text(pieces) => labels.said(pieces, moment),
        Says::Words(words) => labels.with_sign(words),
    };
    if says.trim().is_empty() {
        return None;
    }
    let height = labels.note_height();
    let half = [width(&says, height) / 2.0, height / 2.0];
    // A hundredth of the picture's width in the wanted direction.
    let beyond = screen.project(note.at + note.away * (0.02 / point.scale));
    let wanted = beyond.map_or([0.0, 1.0], |beyond| [beyond.x - point.x, beyond.y - point.y]);
    let length = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
    let wanted = if length > 1e-6 { wanted.map(|part| part / length) } else { [0.0, 1.0] };
    let name = note.name;
    let text = Text {
        name,
        says: says.into(),
        x: point.x,
        y: Vertical::Middle(point.y),
        height,
        align: 0.5,
        color: note.color,
        typeface: Typeface::usual(),
        anchor: Some(note.at),
    };
    let place = |turn: f64, farther: f64| {
        let (sin, cos) = libm::sincos(turn.to_radians());
        let way = [wanted[0] * cos - wanted[1] * sin, wanted[0] * sin + wanted[1] * cos];
        let reach = half[0] * way[0].abs() + half[1] * way[1].abs() + (TEXT_GAP + farther) * height;
        let [x, y] = [point.x + way[0] * reach, point.y + way[1] * reach];
        // The base line is below the middle of the letters.
        let y = Vertical::Middle(y - 0.25 * height);
        let Text { x, y, align, .. } = labels.kept_inside(Text { x, y, ..text.clone() });
        TextPlace { x, y, align, cost: farther + note.sides.cost(turn, way) }
    };
    let places = TRIED_DISTANCES
        .into_iter()
        .flat_map(|farther| TRIED_TURNS.map(|turn| place(turn, farther)))
        .collect();
    Some(Movable { key: Key::Note(name.to_owned(), note.number), text, places })
}
