//! The codes of diagnostics. Each code is explained by a file in `explanations/`; a missing file is a compile error.

/// Defines the enum [`Code`] from pairs of a variant and a name, and embeds the explanation of each code.
macro_rules! codes {
    ($($variant:ident = $name:literal,)*) => {
        /// The code of a diagnostic, such as `unknown-key`. Programs recognize an error by its code, and `jabuka explain` explains the
        /// code.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = concat!("`", $name, "`")] $variant,)*
        }

        impl Code {
            /// All codes, sorted by name.
            pub const ALL: &[Code] = &[$(Code::$variant,)*];

            /// Returns the name of the code, as shown to users: `unknown-key`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Code::$variant => $name,)*
                }
            }

            /// Returns the explanation of the code: the text of its file in `explanations/`.
            pub(crate) fn explanation(self) -> &'static str {
                match self {
                    $(Code::$variant => include_str!(concat!("../../explanations/", $name, ".md")),)*
                }
            }
        }
    };
}

codes! {
    AllFramesFail = "all-frames-fail",
    AngleUnit = "angle-unit",
    BadAsset = "bad-asset",
    BadColorMap = "bad-color-map",
    BadContacts = "bad-contacts",
    BadEmitter = "bad-emitter",
    BadField = "bad-field",
    BadFilmName = "bad-film-name",
    BadFilmRate = "bad-film-rate",
    BadFilmSize = "bad-film-size",
    BadFont = "bad-font",
    BadFrame = "bad-frame",
    BadIdentifier = "bad-identifier",
    BadImage = "bad-image",
    BadInclude = "bad-include",
    BadIntegrator = "bad-integrator",
    BadJoint = "bad-joint",
    BadLook = "bad-look",
    BadMark = "bad-mark",
    BadMesh = "bad-mesh",
    BadPlot = "bad-plot",
    BadSet = "bad-set",
    BadTemplate = "bad-template",
    BadVariableName = "bad-variable-name",
    BadViewName = "bad-view-name",
    BelowGround = "below-ground",
    BrokenJoint = "broken-joint",
    CameraAtLookAt = "camera-at-look-at",
    CannotEmit = "cannot-emit",
    CannotExport = "cannot-export",
    CannotInclude = "cannot-include",
    CannotOverwrite = "cannot-overwrite",
    CannotRead = "cannot-read",
    CannotWrite = "cannot-write",
    ComputedInclude = "computed-include",
    CorrectedStart = "corrected-start",
    Crossing = "crossing",
    CsvBody = "csv-body",
    CsvColumn = "csv-column",
    CsvNumber = "csv-number",
    CsvOrder = "csv-order",
    CsvSyntax = "csv-syntax",
    CsvUnit = "csv-unit",
    CsvVelocity = "csv-velocity",
    CurveWithoutLength = "curve-without-length",
    CyclicInclude = "cyclic-include",
    CyclicVariables = "cyclic-variables",
    DeepOverlap = "deep-overlap",
    DiskFull = "disk-full",
    Diverged = "diverged",
    DivisionByZero = "division-by-zero",
    DuplicateKey = "duplicate-key",
    EditedScript = "edited-script",
    EndBeforeStart = "end-before-start",
    EnergyAdded = "energy-added",
    EnergyDrift = "energy-drift",
    ExclusiveKeys = "exclusive-keys",
    FfmpegFailed = "ffmpeg-failed",
    FileTooLarge = "file-too-large",
    FirstOrder = "first-order",
    FixedMoves = "fixed-moves",
    FolderLocked = "folder-locked",
    FolderNotOurs = "folder-not-ours",
    FormulaOfBody = "formula-of-body",
    FormulaSyntax = "formula-syntax",
    ImageSizes = "image-sizes",
    ImpossibleInertia = "impossible-inertia",
    ImpossibleMass = "impossible-mass",
    ImpossibleShape = "impossible-shape",
    IncludeConflict = "include-conflict",
    IncompleteScripts = "incomplete-scripts",
    IndexName = "index-name",
    Indistinct = "indistinct",
    InternalError = "internal-error",
    Jammed = "jammed",
    JointApart = "joint-apart",
    JointGivesWay = "joint-gives-way",
    KeyframeOrder = "keyframe-order",
    LabelLetter = "label-letter",
    LabelSyntax = "label-syntax",
    LargeScripts = "large-scripts",
    Link = "link",
    LongShutter = "long-shutter",
    LosesHeight = "loses-height",
    MissingAsset = "missing-asset",
    MissingInclude = "missing-include",
    MissingKey = "missing-key",
    NamedTwice = "named-twice",
    NeverThere = "never-there",
    NoBodies = "no-bodies",
    NoBuoyancy = "no-buoyancy",
    NoContacts = "no-contacts",
    NoEffect = "no-effect",
    NoFfmpeg = "no-ffmpeg",
    NoFolder = "no-folder",
    NoImages = "no-images",
    NoPovray = "no-povray",
    NoRecording = "no-recording",
    NoScripts = "no-scripts",
    NoTemplates = "no-templates",
    NotAFile = "not-a-file",
    NotDrawn = "not-drawn",
    NotFinished = "not-finished",
    NotFinite = "not-finite",
    NotUtf8 = "not-utf8",
    NumberTooLarge = "number-too-large",
    NumberWithUnit = "number-with-unit",
    OneChain = "one-chain",
    OpenMesh = "open-mesh",
    OutOfRange = "out-of-range",
    OutsideSandbox = "outside-sandbox",
    Overlap = "overlap",
    OverlapAtStart = "overlap-at-start",
    PlaneActs = "plane-acts",
    PlaneMoves = "plane-moves",
    SameAsset = "same-asset",
    SameName = "same-name",
    SamePlace = "same-place",
    ScatterFull = "scatter-full",
    ShortTrajectory = "short-trajectory",
    SphericalSize = "spherical-size",
    SpringEnds = "spring-ends",
    Stalled = "stalled",
    Stopped = "stopped",
    Toml11 = "toml-1.1",
    TomlSyntax = "toml-syntax",
    TomlUnclosed = "toml-unclosed",
    TooFine = "too-fine",
    TooManyCopies = "too-many-copies",
    TooManyFrames = "too-many-frames",
    TooManyGhosts = "too-many-ghosts",
    TooManyParticles = "too-many-particles",
    TooManySteps = "too-many-steps",
    TooSmall = "too-small",
    TooThin = "too-thin",
    UnbalancedSdl = "unbalanced-sdl",
    UndeclaredTexture = "undeclared-texture",
    UnknownColor = "unknown-color",
    UnknownKey = "unknown-key",
    UnknownName = "unknown-name",
    UnnamedTable = "unnamed-table",
    UntrustedPath = "untrusted-path",
    UntrustedSdl = "untrusted-sdl",
    UntrustedTemplates = "untrusted-templates",
    ValueInSdl = "value-in-sdl",
    WrongCount = "wrong-count",
    WrongLength = "wrong-length",
    WrongPotential = "wrong-potential",
    WrongPovray = "wrong-povray",
    WrongType = "wrong-type",
    ZeroLength = "zero-length",
}

impl Code {
    /// Returns the code with this name. `None` for an unknown name.
    pub fn named(name: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|code| code.name() == name)
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_stand_in_the_order_of_their_names_and_are_found_by_them() {
        assert!(Code::ALL.is_sorted_by(|a, b| a.name() < b.name()));
        assert!(Code::ALL.iter().all(|&code| Code::named(code.name()) == Some(code)));
        assert_eq!(Code::named("unknown-kee"), None);
    }
}
