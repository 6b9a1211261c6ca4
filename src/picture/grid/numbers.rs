//! The numbers of a grid and the names of its axes, in the image plane.

use glam::DVec3;

use super::super::occupancy::{Occupancy, Rectangle};
use super::super::screen::Screen;
use super::super::text::{MARGIN, Text, Vertical, width};
use super::super::thing::Thing;
use crate::font::Typeface;
use crate::scene::Color;

/// The possible distances between two lines with numbers, in spacings of the grid. The smallest one that leaves enough room is used.
const STEPS: [f64; 9] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0];
/// If the end of a line is outside the picture, this many points of the line are tested to find one inside.
const TESTED_POINTS: u32 = 48;

/// A grid laid out for a camera, with its numbers.
#[derive(Clone, Debug)]
pub(in super::super) struct GridLayout {
    /// The lines of the grid.
    pub(super) lines: Thing<'static>,
    /// The numbers along both axes of the grid.
    pub(super) axes: [Axis; 2],
    /// The height of a line of text in the image plane.
    pub(super) height: f64,
    /// The height of the picture, relative to its width.
    pub(super) aspect: f64,
    pub(super) ink: Color,
}

/// The numbers along one edge of a grid.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// The side of the line ends on which the numbers are written.
    pub(super) beside: Beside,
    /// The numbers of the grid lines that begin at the edge, in order.
    pub(super) numbers: Vec<Number>,
    /// The name of the axis, with its unit.
    pub(super) title: String,
}

/// The number that is written at a grid line.
#[derive(Clone, Debug)]
pub(super) struct Number {
    /// The number of the line, counted in spacings from the origin.
    pub(super) line: f64,
    pub(super) says: String,
    /// The two ends of the line, m. The text is at the first end.
    pub(super) ends: [DVec3; 2],
}

/// The position of numbers relative to the ends of their lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Beside {
    /// Below the line ends. The axis name is to the right of the last number.
    Below,
    /// To the left of the line ends. The axis name is above the last number.
    Left,
    /// To the left of the line ends. The axis name replaces the last number.
    LeftOnGround,
}

/// The texts of a grid: the names of its axes, and its numbers.
pub(in super::super) struct Written {
    pub(in super::super) titles: Vec<Text<'static>>,
    pub(in super::super) numbers: Vec<Text<'static>>,
}

/// A text with a position in the image plane, but without a color. `align` is the part of the text at `x`; `middle` and `half` are its
/// horizontal center and half-width.
struct Placed {
    line: f64,
    says: String,
    x: f64,
    y: f64,
    align: f64,
    middle: f64,
    half: f64,
}

impl GridLayout {
    /// The lines of the grid.
    pub(in super::super) fn lines(&self) -> &Thing<'static> {
        &self.lines
    }

    /// Places the numbers and axis names in the image plane, where there is room. They avoid the coils of springs, except for an axis name
    /// without another free position.
    pub(in super::super) fn written(&self, screen: &Screen, room: &Occupancy, coils: &Occupancy) -> Written {
        let lines = self.axes.each_ref().map(|axis| self.in_picture(axis, screen));
        let mut titles: Vec<Placed> = Vec::new();
        for (axis, numbers) in self.axes.iter().zip(&lines) {
            titles.extend(self.title(axis, numbers, &titles, [room, coils]));
        }
        let mut placed: Vec<Placed> = Vec::new();
        for numbers in lines {
            let every = |step: f64| numbers.iter().filter(move |number| number.line % step == 0.0);
            let fits = |step: &f64| {
                let texts: Vec<&Placed> = every(*step).collect();
                !texts.windows(2).any(|pair| self.collide(pair[0], pair[1]))
            };
            let step = STEPS.into_iter().find(fits).unwrap_or(f64::INFINITY);
            for number in numbers.into_iter().filter(|number| number.line % step == 0.0) {
                let others = titles.iter().chain(&placed);
                if others.into_iter().all(|other| !self.collide(other, &number))
                    && [room, coils].iter().all(|room| room.is_free(self.area(&number)))
                {
                    placed.push(number);
                }
            }
        }
        let texts = |placed: Vec<Placed>| placed.into_iter().map(|text| self.text(text)).collect();
        Written { titles: texts(titles), numbers: texts(placed) }
    }

    /// Places the numbers of an axis that are in the picture.
    fn in_picture(&self, axis: &Axis, screen: &Screen) -> Vec<Placed> {
        axis.numbers.iter().filter_map(|number| self.place(number, axis.beside, screen)).collect()
    }

    /// Places a number at the end of its line, or where the line enters the picture. `None` if the line is out of the picture.
    fn place(&self, number: &Number, beside: Beside, screen: &Screen) -> Option<Placed> {
        let [begin, end] = number.ends;
        let at = |part: f64| self.at(number, begin.lerp(end, part), beside, screen);
        let is_in = |part: f64| at(part).filter(|text| self.is_inside(text));
        if let Some(text) = is_in(0.0) {
            return Some(text);
        }
        let part = |point: u32| f64::from(point) / f64::from(TESTED_POINTS);
        let first = (1..=TESTED_POINTS).find(|point| is_in(part(*point)).is_some())?;
        let (mut outside, mut inside) = (part(first - 1), part(first));
        for _ in 0..24 {
            let middle = (outside + inside) / 2.0;
            if is_in(middle).is_some() { inside = middle } else { outside = middle }
        }
        // A number is written only if its line enters the picture over the edge that belongs to the axis. Otherwise the numbers of both
        // axes would be mixed at one edge.
        let over = at(outside);
        let own = over.is_none_or(|text| match beside {
            Beside::Below => text.y <= self.lowest(),
            Beside::Left | Beside::LeftOnGround => text.middle - text.half <= self.leftmost(),
        });
        at(inside).filter(|_| own)
    }

    fn at(&self, number: &Number, point: DVec3, beside: Beside, screen: &Screen) -> Option<Placed> {
        let point = screen.project(point)?;
        let height = self.height;
        let (x, y, align) = match beside {
            Beside::Below => (point.x, point.y - height, 0.5),
            Beside::Left | Beside::LeftOnGround => (point.x - 0.4 * height, point.y - 0.3 * height, 1.0),
        };
        Some(self.aligned(number.line, number.says.clone(), (x, y), align))
    }

    fn aligned(&self, line: f64, says: String, (x, y): (f64, f64), align: f64) -> Placed {
        let half = width(&says, self.height) / 2.0;
        Placed { line, says, x, y, align, middle: x + (1.0 - 2.0 * align) * half, half }
    }

    /// Places the name of an axis next to its last number. If there is no room, the name replaces a number as near to the last one as
    /// possible. Positions on coils are used only as a last resort.
    fn title(
        &self,
        axis: &Axis,
        numbers: &[Placed],
        others: &[Placed],
        [room, coils]: [&Occupancy; 2],
    ) -> Option<Placed> {
        let height = self.height;
        let title = |(x, y): (f64, f64), align: f64| {
            self.kept_inside(self.aligned(f64::NAN, axis.title.clone(), (x, y), align))
        };
        let last = numbers.last()?;
        let beyond = match axis.beside {
            Beside::Below => Some(title((last.middle + last.half + 0.6 * height, last.y), 0.0)),
            Beside::Left => Some(title((last.x + 0.4 * height, last.y + height), 0.5)),
            Beside::LeftOnGround => None,
        };
        // The only number of an axis must not be replaced, so the name is written behind it.
        let behind = title((last.middle + last.half + 0.6 * height, last.y), 0.0);
        let behind = (numbers.len() == 1 && axis.beside != Beside::Below).then_some(behind);
        let instead = numbers.iter().skip(1).rev().map(|number| match axis.beside {
            Beside::Below => title((number.middle, number.y), 0.5),
            Beside::Left | Beside::LeftOnGround => title((number.x, number.y), 1.0),
        });
        let is_free = |text: &Placed| {
            room.is_free(self.area(text)) && !others.iter().any(|other| self.collide(other, text))
        };
        // Near the edge of the picture, `kept_inside` may have moved the name back onto the last number.
        let beyond = beyond.filter(|text| !self.collide(text, last));
        let mut free = beyond.into_iter().chain(behind).chain(instead).filter(is_free);
        let off_coils = |text: &Placed| coils.is_free(self.area(text));
        let first = free.next()?;
        if off_coils(&first) { Some(first) } else { free.find(off_coils).or(Some(first)) }
    }

    /// Moves an axis name to the edge of the picture if it would extend beyond this edge.
    fn kept_inside(&self, text: Placed) -> Placed {
        let room = (1.0 - MARGIN / 2.0 - text.half).max(0.0);
        let high = self.aspect - self.height;
        let middle = text.middle.min(room).max(-room);
        let y = text.y.min(high.max(0.0)).max(0.3 * self.height - self.aspect);
        Placed { x: text.x + middle - text.middle, middle, y, ..text }
    }

    /// The lowest vertical position of a base line inside the picture.
    fn lowest(&self) -> f64 {
        0.3 * self.height - self.aspect
    }

    /// The smallest horizontal position of a number inside the picture.
    fn leftmost(&self) -> f64 {
        0.2 * self.height - 1.0
    }

    fn is_inside(&self, text: &Placed) -> bool {
        let above = text.y + 0.7 * self.height;
        text.middle - text.half > self.leftmost()
            && text.middle + text.half < -self.leftmost()
            && text.y > self.lowest()
            && above < self.aspect
    }

    fn collide(&self, a: &Placed, b: &Placed) -> bool {
        (a.middle - b.middle).abs() < a.half + b.half + 0.3 * self.height
            && (a.y - b.y).abs() < 0.9 * self.height
    }

    fn area(&self, text: &Placed) -> Rectangle {
        Rectangle {
            left: text.middle - text.half,
            right: text.middle + text.half,
            bottom: text.y - 0.25 * self.height,
            top: text.y + 0.75 * self.height,
        }
    }

    fn text(&self, Placed { says, x, y, align, .. }: Placed) -> Text<'static> {
        let y = Vertical::Middle(y);
        Text {
            name: "grid",
            says: says.into(),
            x,
            y,
            height: self.height,
            align,
            color: self.ink,
            typeface: Typeface::usual(),
            anchor: None,
        }
    }
}
