//! Presets: named combinations of sky, ground and light.

/// A named combination of sky, ground, default lights and ambient light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// A blue sky over light tiles. This is the default.
    #[default]
    Daylight,
    /// A photographer's studio: white and seamless, with soft lights.
    Studio,
    /// Stars, a dim glow at the horizon, and the light of the moon.
    Night,
    /// A dark, even background for bright bodies.
    Blackboard,
    /// A white, even background for print.
    Paper,
    /// Stars all around, one hard sun, and no ground.
    Space,
}

impl Preset {
    /// All presets that a scene can choose from.
    pub const ALL: [Preset; 6] =
        [Preset::Daylight, Preset::Studio, Preset::Night, Preset::Blackboard, Preset::Paper, Preset::Space];

    /// Returns the preset with this name. `None` for an unknown name.
    pub fn named(name: &str) -> Option<Preset> {
        Preset::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// Returns the name of the preset in scenes and templates.
    pub fn name(self) -> &'static str {
        match self {
            Preset::Daylight => "daylight",
            Preset::Studio => "studio",
            Preset::Night => "night",
            Preset::Blackboard => "blackboard",
            Preset::Paper => "paper",
            Preset::Space => "space",
        }
    }

    /// Returns a short description of the preset.
    pub fn meaning(self) -> &'static str {
        match self {
            Preset::Daylight => "A blue sky over light tiles: the usual one",
            Preset::Studio => "A photographer's room: white and seamless, with soft lights",
            Preset::Night => "Stars, a dim glow at the horizon, and the light of the moon",
            Preset::Blackboard => "Dark and even, for bright bodies",
            Preset::Paper => "White and even, for print",
            Preset::Space => "Stars all around, one hard sun, no ground",
        }
    }

    /// Returns whether the preset has a ground.
    pub fn has_ground(self) -> bool {
        self != Preset::Space
    }

    /// Returns the ambient light of the preset relative to daylight: red, green and blue in linear RGB. The library's materials are
    /// designed for daylight.
    pub fn ambient(self) -> [f64; 3] {
        match self {
            Preset::Daylight | Preset::Studio => [1.0; 3],
            Preset::Paper => [1.15; 3],
            Preset::Blackboard => [0.7; 3],
            Preset::Night => [0.09, 0.12, 0.2],
            Preset::Space => [0.015; 3],
        }
    }
}
