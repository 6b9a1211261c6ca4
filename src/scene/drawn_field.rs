//! The fields of forces that pictures show.

use glam::DVec3;

use super::Color;

/// A drawing of a force's field in a plane.
#[derive(Clone, Debug)]
pub struct DrawnField {
    /// The name of the drawing, unique among fields.
    pub name: String,
    /// The force, as an index in the scene.
    pub force: usize,
    /// Whether the magnetic field of the force is drawn instead of its force on a body at rest.
    pub is_magnetic: bool,
    /// How the field is drawn.
    pub style: FieldStyle,
    /// A point of the plane, m. `None` for the middle of the bodies that cause the force.
    pub at: Option<DVec3>,
    /// The normal of the plane, a unit vector. `None` for the axis that is nearest to the view of the camera.
    pub normal: Option<DVec3>,
    /// The distance between two arrows, m. `None` for a distance at which they fill the picture.
    pub spacing: Option<f64>,
    /// The length of an arrow per strength of the field, m per unit. `None` for lengths that show weak fields as well.
    pub scale: Option<f64>,
    /// The number of field lines at the strongest source, or of lines across the picture if no body causes the force.
    pub count: u32,
    /// The color of the drawing. `None` for a color of the palette of curves.
    pub color: Option<Color>,
}

/// How a field is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FieldStyle {
    /// As arrows on a grid.
    #[default]
    Arrows,
    /// As lines that follow the field.
    Lines,
    /// As lines of equal potential.
    Levels,
}

impl FieldStyle {
    /// All styles.
    pub const ALL: [FieldStyle; 3] = [FieldStyle::Arrows, FieldStyle::Lines, FieldStyle::Levels];

    /// Returns the name of the style in scenes.
    pub fn name(self) -> &'static str {
        match self {
            FieldStyle::Arrows => "arrows",
            FieldStyle::Lines => "lines",
            FieldStyle::Levels => "levels",
        }
    }
}
