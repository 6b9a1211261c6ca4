//! The grammar of `[force.NAME]`.

use crate::physics::{Coulomb, Dipoles, Gravitation};
use crate::scene::force_formula::{OF_PLACE, QUANTITIES};

use super::Kind::{Boolean, Color, Either, List, ListOfBody, Number, OfBody, Reference, Table};
use super::key::table;
use super::kind::{ANY, AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::repeat::LINKS;
use super::showing;
use super::{Bound, Collection, KeySpec, Kind, Rule};

/// Describes the key `on`, a list of the bodies that a force acts on.
const fn on(meaning: &'static str, default: &'static str) -> KeySpec {
    KeySpec::new("on", List { of: &Reference(Collection::Target), min: 1, max: usize::MAX }, meaning)
        .default(default)
        .also(&["bodies", "body"])
}

/// Describes the key `between`, which names groups of bodies. Forces act between bodies of different groups.
const fn between(meaning: &'static str) -> KeySpec {
    KeySpec::new("between", List { of: &GROUP, min: 2, max: usize::MAX }, meaning)
        .default("among all of `on`")
        .also(&["groups", "pairs"])
}

/// A group for `between`: a body, all copies of a body, or a list of these.
static GROUP: Kind = Either(&[
    Reference(Collection::Body),
    List { of: &Reference(Collection::Body), min: 1, max: usize::MAX },
]);

/// Describes the key `softening`, a length that keeps the force between two bodies finite at small distances.
const fn softening() -> KeySpec {
    KeySpec::new(
        "softening",
        NON_NEGATIVE,
        "Softens close encounters: √(r² + softening²) replaces r (Plummer)",
    )
    .unit("m")
    .default_number(0.0)
    .also(&["epsilon", "eps"])
}

table! {
    force: "a force", Rule::ExactlyOne(&[
        "constant",
        "drag",
        "spring",
        "gravitation",
        "coulomb",
        "lorentz",
        "lennard_jones",
        "buoyancy",
        "dipoles",
        "j2",
        "formula",
    ]);
    CONSTANT: Any = KeySpec::new("constant", Table(&constant::TABLE), "The same force or torque on several bodies")
        .also(&["uniform"]),
    DRAG: Any = KeySpec::new("drag", Table(&drag::TABLE), "The resistance of air or a liquid, optionally with wind")
        .also(&["air", "friction", "resistance"]),
    SPRING: Any = KeySpec::new(
        "spring",
        Table(&spring::TABLE),
        "A spring with a damper between bodies or points, or a chain of such springs",
    ),
    GRAVITATION: Any = KeySpec::new("gravitation", Table(&gravitation::TABLE), "Newton's gravitation between all pairs of bodies")
        .also(&["newton", "gravity"]),
    COULOMB: Any = KeySpec::new("coulomb", Table(&coulomb::TABLE), "Coulomb's force between all pairs of charged bodies")
        .also(&["electrostatic"]),
    LORENTZ: Any = KeySpec::new(
        "lorentz",
        Table(&lorentz::TABLE),
        "Uniform electric and magnetic fields acting on charged bodies",
    )
    .also(&["field", "electromagnetic", "magnetic", "electric"]),
    LENNARD_JONES: Any = KeySpec::new(
        "lennard_jones",
        Table(&lennard_jones::TABLE),
        "The Lennard-Jones force between neutral atoms: repulsion when close, attraction farther away",
    )
    .also(&["lennard-jones", "lj", "LJ", "van_der_waals"]),
    BUOYANCY: Any = KeySpec::new("buoyancy", Table(&buoyancy::TABLE), "The buoyancy of a liquid at rest").also(&[
        "archimedes",
        "float",
        "water",
        "liquid",
    ]),
    DIPOLES: Any = KeySpec::new(
        "dipoles",
        Table(&dipoles::TABLE),
        "Magnetic dipoles on bodies, in each other's fields and a uniform one",
    )
    .also(&["magnetic_dipoles", "magnetic-dipoles", "magnets", "dipole"]),
    J2: Any = KeySpec::new("j2", Table(&j2::TABLE), "The correction of a planet's gravity for its flattening")
        .also(&["J2", "oblateness", "flattening"]),
    FORMULA: Any = KeySpec::new(
        "formula",
        Table(&formula::TABLE),
        "A force given by formulas of a body's position, velocity and properties",
    )
    .also(&["custom", "expression"]),
    REPEAT: Option<u32> = LINKS,
}

table! {
    constant: "a constant force", Rule::Any;
    FORCE: DVec3 = KeySpec::new("force", VECTOR, "The force at the center of each body, in world axes")
        .unit("N")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["f", "F", "value", "vector"]),
    TORQUE: DVec3 = KeySpec::new("torque", VECTOR, "The torque on each body, in world axes")
        .unit("N·m")
        .default_numbers(&[0.0, 0.0, 0.0]),
    ON: Any = on("The bodies under the force", "all that can move"),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    drag: "a drag", Rule::Any;
    LINEAR: f64 = KeySpec::new(
        "linear",
        NON_NEGATIVE,
        "Force per speed relative to the air, against it: for slow or small bodies",
    )
    .unit("N·s/m")
    .default_number(0.0)
    .also(&["coefficient", "c", "damping", "viscous"]),
    QUADRATIC: f64 = KeySpec::new(
        "quadratic",
        NON_NEGATIVE,
        "Force per speed squared: ½ density × drag coefficient × area",
    )
    .unit("N·s²/m²")
    .default_number(0.0)
    .also(&["square", "turbulent"]),
    WIND: DVec3 = KeySpec::new("wind", VECTOR, "The velocity of the air")
        .unit("m/s")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["velocity", "air", "flow"]),
    ON: Any = on("The bodies under the drag", "all that can move"),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    spring: "a spring", Rule::Any;
    BETWEEN: Any = KeySpec::new(
        "between",
        List {
            of: &Either(&[Reference(Collection::Body), VECTOR, Table(&end::TABLE)]),
            min: 2,
            max: usize::MAX,
        },
        "Its ends: each the name of a body (its center), a point of a body, or a point of the world; \
         more than two make a chain",
    )
    .unit("m")
    .required()
    .also(&["bodies", "ends", "connects"]),
    STIFFNESS: Option<f64> = KeySpec::new("stiffness", NON_NEGATIVE, "Force per change of length; of each spring of a chain")
        .unit("N/m")
        .required()
        .also(&["k", "constant", "strength"]),
    DAMPING: f64 = KeySpec::new("damping", NON_NEGATIVE, "Force per rate of change of length, against it")
        .unit("N·s/m")
        .default_number(0.0)
        .also(&["c", "friction", "damper"]),
    REST_LENGTH: Option<f64> = KeySpec::new("rest_length", NON_NEGATIVE, "The length without force")
        .unit("m")
        .default("each spring's length at the start")
        .also(&["length", "rest"]),
    LINE: value::Text = showing::LINE,
    COIL: Any = showing::COIL,
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    /// The grammar of an end of a spring or joint that is attached to a body at a given point.
    end: "a point of a body", Rule::Any;
    BODY: Option<value::Text> = KeySpec::new("body", Reference(Collection::Body), "The body of this end").required(),
    AT: DVec3 = KeySpec::new("at", VECTOR, "The point in the body's own axes, relative to its center of mass")
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["point", "location", "position", "offset", "anchor"]),
}

table! {
    gravitation: "gravitation", Rule::AtMostOne(&[&["on", "between"]]);
    CONSTANT: f64 = KeySpec::new("constant", POSITIVE, "Newton's constant G")
        .unit("m³/(kg·s²)")
        .default_number(Gravitation::CONSTANT)
        .also(&["g", "G", "strength"]),
    SOFTENING: f64 = softening(),
    OPENING_ANGLE: Option<f64> = KeySpec::new(
        "opening_angle",
        Number(Bound::From(0.0, 1.0)),
        "For thousands of bodies: a Barnes–Hut tree with quadrupoles groups distant bodies if their \
         size is less than this times their distance. At 0.5, forces are off by 4e-4, at 0.3 by 8e-5; \
         momentum drifts less. The energy and its drift are measured with the potential of the same tree, \
         so the drift shows errors of the steps, and not of the tree. Particles always feel each body separately",
    )
    .default("0: the direct sum over all pairs")
    .also(&["theta", "angle", "opening", "tree", "barnes_hut"]),
    ON: Any = on("The bodies that attract each other; fixed ones attract, too", "all but planes"),
    BETWEEN: Any = between(
        "Two groups, each a body, all copies of a body, or a list. Bodies attract those of the other \
         group only",
    ),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    coulomb: "a Coulomb force", Rule::AtMostOne(&[&["on", "between"]]);
    CONSTANT: f64 = KeySpec::new("constant", POSITIVE, "Coulomb's constant, 1/4πε₀")
        .unit("N·m²/C²")
        .default_number(Coulomb::CONSTANT)
        .also(&["k", "strength"]),
    SOFTENING: f64 = softening(),
    ON: Any = on("The bodies that act on each other; fixed ones act, too", "all with a charge"),
    BETWEEN: Any = between(
        "Two groups, each a body, all copies of a body, or a list. Bodies act on those of the other \
         group only",
    ),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    lennard_jones: "a Lennard-Jones force", Rule::AtMostOne(&[&["on", "between"]]);
    EPSILON: Option<f64> = KeySpec::new("epsilon", POSITIVE, "The depth of the potential 4 epsilon ((sigma/r)¹² − (sigma/r)⁶)")
        .unit("J")
        .required()
        .also(&["eps", "depth", "e", "well_depth"]),
    SIGMA: Option<f64> = KeySpec::new(
        "sigma",
        POSITIVE,
        "The distance at which the potential is 0; its minimum is at 1.12 sigma",
    )
    .unit("m")
    .required()
    .also(&["diameter", "s", "distance", "size"]),
    CUTOFF: Option<f64> = KeySpec::new(
        "cutoff",
        POSITIVE,
        "The distance beyond which there is no force; the potential is shifted to be 0 there",
    )
    .unit("m")
    .default("2.5 sigma")
    .also(&["r_cut", "rc", "range", "cut_off"]),
    SMOOTH: bool = KeySpec::new(
        "smooth",
        Boolean,
        "Shift the force as well, to be 0 at the cutoff: conserves energy better, but weakens the \
         attraction",
    )
    .default_flag(false)
    .also(&["shifted_force", "force_shift"]),
    ON: Any = on("The bodies that act on each other; fixed ones act, too", "all but planes"),
    BETWEEN: Any = between(
        "Two groups, each a body, all copies of a body, or a list. Bodies act on those of the other \
         group only",
    ),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    buoyancy: "buoyancy", Rule::Any;
    DENSITY: Option<f64> = KeySpec::new("density", POSITIVE, "The density of the liquid; water has 1000")
        .unit("kg/m³")
        .required()
        .also(&["rho", "fluid_density"]),
    LEVEL: f64 = KeySpec::new(
        "level",
        ANY,
        "The height of its surface, measured from the origin against `simulation.gravity`",
    )
    .unit("m")
    .default_number(0.0)
    .also(&["height", "y"]),
    SURFACE: Any = KeySpec::new("surface", Either(&SURFACE_KINDS), "Whether its surface is drawn")
        .default_flag(false)
        .also(&["show", "look", "draw", "visible"]),
    ON: Any = on("The bodies in the liquid", "all that can move"),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

static SURFACE_KINDS: [Kind; 2] = [Boolean, Table(&liquid_surface::TABLE)];

table! {
    liquid_surface: "the surface of a liquid", Rule::Any;
    COLOR: Option<value::Color> = KeySpec::new("color", Color, "Its color").default("that of water").also(&["colour"]),
}

table! {
    dipoles: "magnetic dipoles", Rule::AtMostOne(&[&["on", "between"]]);
    CONSTANT: f64 = KeySpec::new("constant", POSITIVE, "The magnetic constant over 4π, μ₀/4π")
        .unit("N/A²")
        .default_number(Dipoles::CONSTANT)
        .also(&["k", "strength"]),
    FIELD: DVec3 = KeySpec::new("field", VECTOR, "A uniform magnetic field, which aligns them")
        .unit("T")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["b", "B", "magnetic"]),
    ON: Any = on("The bodies that act on each other; fixed ones act, too", "all with a `magnetic_moment`"),
    BETWEEN: Any = between(
        "Two groups, each a body, all copies of a body, or a list. Bodies act on those of the other \
         group only",
    ),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    j2: "the gravity of a bulge", Rule::Any;
    OF: Option<value::Text> = KeySpec::new(
        "of",
        Reference(Collection::Body),
        "The planet; its spherical attraction needs a `gravitation`",
    )
    .required()
    .also(&["planet", "body", "center"]),
    J2: Option<f64> = KeySpec::new("j2", ANY, "The coefficient J₂ of its gravity: 1.0826e-3 for the earth")
        .required()
        .also(&["J2", "coefficient"]),
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "The radius of its equator, to which J₂ belongs")
        .unit("m")
        .required()
        .also(&["r", "R", "equatorial_radius"]),
    AXIS: value::Axis = KeySpec::new("axis", super::AXIS, "The rotation axis, in the planet's own axes")
        .default_numbers(&[0.0, 1.0, 0.0])
        .also(&["pole"]),
    CONSTANT: f64 = KeySpec::new("constant", POSITIVE, "Newton's constant G")
        .unit("m³/(kg·s²)")
        .default_number(Gravitation::CONSTANT)
        .also(&["g", "G"]),
    ON: Any = on("The bodies that act on the planet and it on them", "all others but planes"),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    formula: "a force by formulas", Rule::Any;
    FORCE: Option<value::ListOfBody> = KeySpec::new(
        "force",
        ListOfBody(3, QUANTITIES),
        "The force at the center of each body, in world axes: `x`, `y`, `z` are its position, `r` its \
         distance from the origin, `vx`, `vy`, `vz` its velocity, `speed` its magnitude, `t` the time",
    )
    .unit("N")
    .required()
    .also(&["f", "F", "formula", "value"]),
    POTENTIAL: Option<value::OfBody> = KeySpec::new(
        "potential",
        OfBody(OF_PLACE),
        "The potential energy of each body. The force at rest must equal −∂U/∂x, −∂U/∂y, −∂U/∂z; it \
         then counts as energy, and only the work of the velocity-dependent rest is booked",
    )
    .unit("J")
    .default("none: all of its work is booked")
    .also(&["u", "U", "energy", "potential_energy"]),
    ON: Any = on("The bodies under the force", "all that can move"),
    ARROW: Any = showing::ARROW_OF_FORCE,
}

table! {
    lorentz: "a Lorentz force", Rule::Any;
    ELECTRIC: DVec3 = KeySpec::new("electric", VECTOR, "The electric field E")
        .unit("V/m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["e", "E"]),
    MAGNETIC: DVec3 = KeySpec::new("magnetic", VECTOR, "The magnetic field B: the force is q (E + v × B)")
        .unit("T")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["b", "B"]),
    ON: Any = on("The bodies that it acts on", "all movable bodies with a charge"),
    ARROW: Any = showing::ARROW_OF_FORCE,
}
