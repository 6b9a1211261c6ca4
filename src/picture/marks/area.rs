//! Swept areas: sectors between a center and the path of a body, and the line that sweeps them.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::angle::drawn;
use super::{FrameView, HELPING_LINE_RADIUS, Mark, Sketch};
use crate::picture::thing::{Form, Line, Thing};
use crate::scene::{Area, Color, Scene};
use crate::simulate::place;

/// The opacity of every second sector, and that of the paler ones between them.
const SECTOR_OPACITIES: [f64; 2] = [0.7, 0.35];
/// The angle by which the sectors of one turn may exceed a full turn, rad. The orbit of a coarse step turns a little.
const TURN_TOLERANCE: f64 = 0.02;

#[derive(Debug)]
struct AreaMark {
    /// The area, with a center on the drawn body.
    area: Area,
    /// The index of the area in the scene.
    number: usize,
    name: String,
    color: Color,
}

/// Plans the marks for the swept areas of a scene.
pub(super) fn marks(scene: &Scene) -> Vec<Arc<dyn Mark>> {
    let mark = |(number, area): (usize, &Area)| {
        let area = Area { center: drawn(area.center, &scene.bodies), ..area.clone() };
        let color = area.color.unwrap_or(Color::OF_CURVES[number % Color::OF_CURVES.len()]);
        Arc::new(AreaMark { name: format!("area {}", area.name), area, number, color }) as Arc<dyn Mark>
    };
    scene.areas.iter().enumerate().map(mark).collect()
}

impl Mark for AreaMark {
    fn draw<'a>(&'a self, scale: &FrameView<'_>, sketch: &mut Sketch<'a>) {
        let frame = scale.frame;
        let Some(center) = place(self.area.center, &frame.bodies) else { return };
        let mut turn = 0.0;
        let mut thing = |form| {
            sketch.things.push(Thing { name: self.name.as_str().into(), form, color: self.color });
        };
        // The sectors of the last turn do not overlap, so they do not hide each other.
        for sector in frame.past.areas.get(self.number).into_iter().flatten().rev() {
            turn += sector.turn;
            if turn > TAU + TURN_TOLERANCE {
                break;
            }
            let rim = sector.rim.iter().map(|point| center + *point);
            let points = std::iter::once(center).chain(rim).collect();
            thing(Form::Area { points, opacity: SECTOR_OPACITIES[sector.number % 2], is_liquid: false });
        }
        let [begin, _] = self.area.times(0);
        let is_sweeping = frame.time >= begin && frame.time <= self.area.until;
        if let Some(body) = frame.body(self.area.body).filter(|_| is_sweeping) {
            let radius = HELPING_LINE_RADIUS * scale.stroke;
            thing(Form::Lines { lines: vec![Line { from: center, to: body.location, radius }] });
        }
    }
}
