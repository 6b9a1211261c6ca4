//! Reads ropes, pulleys and gears.

use super::{Reader, about};
use crate::diagnostic::{Code, Diagnostic};
use crate::physics::{Anchor, Coordinate, Gear, Pulley, Rope};
use crate::scene::check::end;
use crate::scene::check::read::figure;
use crate::scene::check::view::View;
use crate::scene::grammar::joints::{gear, pulley};
use crate::scene::source::Value;
use crate::scene::{Joint, JointKind};

/// The relative tolerance for a `length` that is shorter than the rope's initial length, such as a rounded number.
const LENGTH_TOLERANCE: f64 = 1e-9;

impl Reader<'_, '_> {
    pub(super) fn rope(&mut self, view: &View<'_>) -> Option<Rope> {
        let (between, nodes) = self.ends(view, &[])?;
        let [from, to] = between.map(|anchor| end::place(anchor, self.bodies));
        let distance = from.distance(to);
        let length = view.get(&pulley::LENGTH).unwrap_or(distance);
        if length == 0.0 {
            let message = format!("the rope `{}` has no length", self.name);
            let help = "say how long it is: `length = 1`";
            self.refuse(message, nodes[1].span, "where the other end is", help);
            return None;
        }
        self.reaches(view, distance, "its ends are", "the rope");
        Some(Rope { between, length: length.max(distance) })
    }

    pub(super) fn pulley(&mut self, view: &View<'_>) -> Option<Pulley> {
        let nodes = view.list(&pulley::OVER)?;
        let over = nodes.iter().map(|node| end::anchor(node, self.context)).collect::<Option<Vec<_>>>()?;
        let (between, _) = self.ends(view, &over)?;
        let mut pulley = Pulley::new(between, &over, view.get(&pulley::RATIO), 0.0);
        let way = |ends: [Anchor; 2]| {
            let [from, to] = ends.map(|end| end::place(end, self.bodies));
            from.distance(to)
        };
        let needed = pulley.parts().map(|part| part.factor * way(part.ends)).sum();
        pulley.length = view.get(&pulley::LENGTH).unwrap_or(needed).max(needed);
        let nearest = pulley.nearest();
        let ways = pulley.parts().map(|part| (part.can_change, way(part.ends)));
        let near = ways.enumerate().find(|(_, (can_change, way))| *can_change && *way < nearest);
        if let Some((part, (_, way))) = near {
            let is_outer = part == 0 || part == over.len();
            let (what, label) = if is_outer {
                ("has an end where its rope runs over", "an end")
            } else {
                ("runs over two points at one place", "the point before")
            };
            let message = format!("the pulley `{}` {what}", self.name);
            let label = format!("{label} is {} m from here", about(way));
            let help = format!("each part of the rope keeps at least {} m", about(nearest));
            self.refuse(message, nodes[part.min(over.len() - 1)].span, &label, &help);
            return None;
        }
        self.reaches(view, needed, "its parts are", "the rope of the pulley");
        Some(pulley)
    }

    /// Reports a rope whose `length` is less than the initial length `needed`, m.
    fn reaches(&mut self, view: &View<'_>, needed: f64, what: &str, whose: &str) {
        let length = view.get(&pulley::LENGTH).unwrap_or(needed);
        if needed <= length * (1.0 + LENGTH_TOLERANCE) {
            return;
        }
        let message =
            format!("{whose} `{}` is too short: {} m are missing", self.name, about(needed - length));
        let span = view.span(&pulley::LENGTH).unwrap_or(self.span);
        let needed = figure(format!("{needed:.9}").parse().unwrap_or(needed));
        let error = Diagnostic::error(Code::JointApart, message);
        let error = error.at(span, format!("{what} {needed} m at the start"));
        self.context
            .diagnostics
            .push(error.help(format!("`length = {needed}` or more; without the key, it is taut")));
    }

    /// Reads a gear. `joints` holds the joints that the gear may couple.
    pub(super) fn gear(&mut self, view: &View<'_>, joints: &[Joint]) -> Option<Gear> {
        let nodes = view.list(&gear::JOINTS)?;
        let ratio = view.get(&gear::RATIO);
        let mut coordinates: Vec<Coordinate> = Vec::new();
        let mut names: Vec<&str> = Vec::new();
        for node in nodes {
            let Value::String(name) = &node.value else { return None };
            let joint = joints.iter().find(|joint| joint.name == **name).map(|joint| &joint.kind);
            let coordinate = match joint {
                Some(JointKind::Hinge(hinge)) => Some(hinge.coordinate()),
                Some(JointKind::Slider(slider)) => Some(slider.coordinate()),
                // An error in the coupled joint has already been reported.
                None if !self.gears.contains(&&**name) => return None,
                _ => None,
            };
            let why = match coordinate {
                Some(_) if names.contains(&&**name) => "the same joint as the one before it",
                Some(coordinate) => {
                    coordinates.push(coordinate);
                    names.push(name);
                    continue;
                }
                None if joint.is_none() => "a gear itself",
                None => "neither a hinge nor a slider",
            };
            let message = format!("the gear `{}` cannot couple these joints", self.name);
            self.refuse(message, node.span, why, "a gear couples two hinges, two sliders, or one of each");
            return None;
        }
        let [first, second] = *coordinates.as_slice() else { return None };
        let ratio = ratio?;
        if ratio == 0.0 {
            let message = format!("the gear `{}` has a ratio of 0", self.name);
            let span = view.span(&gear::RATIO).unwrap_or(self.span);
            let help = "such as `ratio = -2`: the second turns twice as fast, the other way";
            self.refuse(message, span, "the second would never move", help);
            return None;
        }
        Some(Gear { joints: [first, second], ratio })
    }
}
