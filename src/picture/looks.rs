//! The looks of the bodies in each frame, as far as they follow values.

use std::sync::Arc;

use super::color_maps::ColorMaps;
use crate::scene::{LookAspect, MeasureFormula, Scene, ValueMap, Visibility};
use crate::simulate::{Frame, Ghost, Measures, MomentState, Survey, is_true};

/// The looks of the bodies in a frame, as far as they follow values. Each list has an item for each body of the scene, or is empty if no
/// body of the scene needs it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Looks {
    /// The color of each body, as an index into the [colors](super::Plan::mapped_colors) of its map. Bodies without a map have 0.
    pub colors: Vec<u16>,
    /// The transparency of each body, one of a few numbers. Bodies whose transparency never changes have 0.
    pub transparency: Vec<f64>,
    /// The glow of each body, one of a few numbers. Bodies whose glow never changes have 0.
    pub glow: Vec<f64>,
    /// The size of each body, relative to its largest drawn size. Bodies whose size never changes have 1.
    pub scale: Vec<f64>,
    /// Whether each body is drawn.
    pub is_drawn: Vec<bool>,
}

impl Looks {
    /// Returns the size of a body, relative to its largest drawn size.
    pub fn scale_of(&self, body: usize) -> f64 {
        self.scale.get(body).copied().unwrap_or(1.0)
    }

    /// Returns whether a body is drawn, if it is present.
    pub fn draws(&self, body: usize) -> bool {
        self.is_drawn.get(body).copied().unwrap_or(true)
    }
}

/// The looks of a run that follow values.
#[derive(Clone, Debug)]
pub(super) struct LookMaps {
    pub(super) colors: ColorMaps,
    numbers: Vec<Mapped>,
    /// The conditions under which bodies are drawn, each with its bodies, as indices in the scene.
    conditions: Vec<(MeasureFormula, Vec<usize>)>,
    /// The bodies that are never drawn.
    never: Vec<usize>,
    /// The largest scale of each body of the scene.
    largest: Vec<f64>,
    measures: Arc<Measures>,
    /// The number of bodies in the scene.
    bodies: usize,
}

/// A map of one part of the look, with the bodies that it acts on.
#[derive(Clone, Debug)]
struct Mapped {
    aspect: LookAspect,
    map: ValueMap,
    /// The values of the first and the last number.
    range: [f64; 2],
    /// The bodies, as indices in the scene, in increasing order.
    bodies: Vec<usize>,
}

impl LookMaps {
    /// Plans the looks of a run. `measures` are those of its scene.
    pub(super) fn new(scene: &Scene, survey: &Survey, measures: Arc<Measures>) -> LookMaps {
        let mut numbers = Vec::new();
        for aspect in LookAspect::ALL {
            for (number, map) in scene.value_maps.iter().enumerate() {
                let bodies = scene.bodies.iter().enumerate();
                let bodies = bodies.filter(|(_, body)| scene.value_map_of(body, aspect) == Some(number));
                let bodies: Vec<usize> = bodies.map(|(id, _)| id).collect();
                let range = survey.value_ranges.get(number).copied().unwrap_or([0.0, 1.0]);
                if !bodies.is_empty() {
                    numbers.push(Mapped { aspect, map: map.clone(), range, bodies });
                }
            }
        }
        let with = |visibility: Visibility| {
            let bodies = scene.bodies.iter().enumerate();
            bodies.filter(move |(_, body)| body.look.visible == visibility).map(|(id, _)| id).collect()
        };
        let conditions = scene.conditions.iter().enumerate();
        LookMaps {
            colors: ColorMaps::new(scene, survey, measures.clone()),
            numbers,
            conditions: conditions
                .map(|(number, it)| (it.clone(), with(Visibility::While(number))))
                .collect(),
            never: with(Visibility::Never),
            largest: scene.bodies.iter().map(|body| body.look.scale).collect(),
            measures,
            bodies: scene.bodies.len(),
        }
    }

    /// Returns the looks of the bodies in a frame.
    pub(super) fn at(&self, frame: &Frame) -> Looks {
        let moment = MomentState::now(frame);
        let mut looks = Looks { colors: self.colors.at(&moment), ..Looks::default() };
        for Mapped { aspect, map, range, bodies } in &self.numbers {
            let (numbers, usual) = match aspect {
                LookAspect::Transparency => (&mut looks.transparency, 0.0),
                LookAspect::Glow => (&mut looks.glow, 0.0),
                LookAspect::Scale => (&mut looks.scale, 1.0),
            };
            numbers.resize(self.bodies, usual);
            let values = self.measures.of_each(&map.of, bodies.iter().copied(), &moment);
            for (body, value) in bodies.iter().zip(values) {
                numbers[*body] = match aspect {
                    LookAspect::Transparency | LookAspect::Glow => map.step_at(value, *range),
                    LookAspect::Scale => map.number_at(value, *range) / self.largest[*body],
                };
            }
        }
        if !self.never.is_empty() || !self.conditions.is_empty() {
            looks.is_drawn.resize(self.bodies, true);
        }
        self.never.iter().for_each(|body| looks.is_drawn[*body] = false);
        for (condition, bodies) in &self.conditions {
            let values = self.measures.of_each(condition, bodies.iter().copied(), &moment);
            for (body, value) in bodies.iter().zip(values) {
                looks.is_drawn[*body] = is_true(value);
            }
        }
        looks
    }

    /// Returns the size of a ghost, relative to the largest drawn size of its body.
    pub(super) fn scale_of_ghost(&self, ghost: &Ghost) -> f64 {
        let is_of = |mapped: &&Mapped| {
            mapped.aspect == LookAspect::Scale && mapped.bodies.binary_search(&ghost.body.id).is_ok()
        };
        let Some(Mapped { map, range, .. }) = self.numbers.iter().find(is_of) else { return 1.0 };
        map.number_at(ghost.look.scale.unwrap_or(f64::NAN), *range) / self.largest[ghost.body.id]
    }
}
