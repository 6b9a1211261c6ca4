//! The keys of `[force.NAME]`.

use crate::dynamics::{Coulomb, Dipoles, Gravitation};
use crate::scene::law::{OF_PLACE, QUANTITIES};

use super::Kind::{Boolean, Either, List, ListOfBody, Number, OfBody, Reference, Table};
use super::keys::{ANY, AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::repeat::LINKS;
use super::{Bound, Collection, Key, Kind, Rule, TableSpec};

/// The key that names the bodies of a force.
const fn on(meaning: &'static str, default: &'static str) -> Key {
    Key::new("on", List { of: &Reference(Collection::Target), min: 1, max: usize::MAX }, meaning)
        .default(default)
        .also(&["bodies", "body"])
}

/// The key that names two groups of bodies of which each acts on the other.
const fn between(meaning: &'static str) -> Key {
    Key::new("between", List { of: &GROUP, min: 2, max: usize::MAX }, meaning)
        .default("among all of `on`")
        .also(&["groups", "pairs"])
}

/// A body, the copies of one, or a list of such.
static GROUP: Kind = Either(&[
    Reference(Collection::Body),
    List { of: &Reference(Collection::Body), min: 1, max: usize::MAX },
]);

/// The key that keeps a force between pairs finite.
const fn softening() -> Key {
    Key::new(
        "softening",
        NON_NEGATIVE,
        "Keeps close encounters mild: √(r² + softening²) counts for r (Plummer)",
    )
    .unit("m")
    .default_number(0.0)
    .also(&["epsilon", "eps"])
}

pub(super) static FORCE: TableSpec =
    TableSpec {
        noun: "a force",
        rule: Rule::ExactlyOne(&["constant", "drag", "spring", "gravitation", "coulomb", "lorentz", "lennard_jones", "buoyancy", "dipoles", "j2", "formula"]),
        keys: &[
            Key::new("constant", Table(&CONSTANT), "The same force or torque on several bodies")
                .also(&["uniform"]),
            Key::new("drag", Table(&DRAG), "The resistance of air or a liquid, at rest or as a wind")
                .also(&["air", "friction", "resistance"]),
            Key::new(
                "spring",
                Table(&SPRING),
                "A spring with a damper between bodies or points, or a chain of such springs",
            ),
            Key::new("gravitation", Table(&GRAVITATION), "Newton's gravitation between all pairs of bodies")
                .also(&["newton", "gravity"]),
            Key::new("coulomb", Table(&COULOMB), "Coulomb's force between all pairs of charged bodies")
                .also(&["electrostatic"]),
            Key::new(
                "lorentz",
                Table(&LORENTZ),
                "Uniform electric and magnetic fields, which act on charged bodies",
            )
            .also(&["field", "electromagnetic", "magnetic", "electric"]),
            Key::new(
                "lennard_jones",
                Table(&LENNARD_JONES),
                "The force between neutral atoms, which attract each other, and repel each other where they are close",
            )
            .also(&["lennard-jones", "lj", "LJ", "van_der_waals"]),
            Key::new("buoyancy", Table(&BUOYANCY), "A liquid at rest, which carries what is below its surface")
                .also(&["archimedes", "float", "water", "liquid"]),
            Key::new(
                "dipoles",
                Table(&DIPOLES),
                "Magnets on bodies, in the fields of each other and in a uniform one",
            )
            .also(&["magnetic_dipoles", "magnetic-dipoles", "magnets", "dipole"]),
            Key::new("j2", Table(&J2_KEYS), "What the flattening of a planet adds to its gravity")
                .also(&["J2", "oblateness", "flattening"]),
            Key::new(
                "formula",
                Table(&FORMULA),
                "A force by formulas of where each body is, how it moves, and what it is",
            )
            .also(&["custom", "expression"]),
            LINKS,
        ],
    };

static CONSTANT: TableSpec = TableSpec {
    noun: "a constant force",
    rule: Rule::Any,
    keys: &[
        Key::new("force", VECTOR, "The force at the centre of each body, in world axes")
            .unit("N")
            .default_numbers(&[0.0, 0.0, 0.0]),
        Key::new("torque", VECTOR, "The torque on each body, in world axes")
            .unit("N·m")
            .default_numbers(&[0.0, 0.0, 0.0]),
        on("The bodies that it acts on", "all that can move"),
    ],
};

static DRAG: TableSpec = TableSpec {
    noun: "a drag",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "linear",
            NON_NEGATIVE,
            "Force per speed through the air, against it: of what is slow or small",
        )
        .unit("N·s/m")
        .default_number(0.0)
        .also(&["coefficient", "c", "damping", "viscous"]),
        Key::new(
            "quadratic",
            NON_NEGATIVE,
            "Force per square of that speed: ½ density × drag coefficient × area",
        )
        .unit("N·s²/m²")
        .default_number(0.0)
        .also(&["square", "turbulent"]),
        Key::new("wind", VECTOR, "The velocity of the air")
            .unit("m/s")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["velocity", "air", "flow"]),
        on("The bodies that it acts on", "all that can move"),
    ],
};

static SPRING: TableSpec = TableSpec {
    noun: "a spring",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "between",
            List { of: &Either(&[Reference(Collection::Body), VECTOR, Table(&END)]), min: 2, max: usize::MAX },
            "Its ends: each the name of a body (its centre), a point of a body, or a point of the world; of more than \
             two, a chain from each to the next",
        )
        .unit("m")
        .required()
        .also(&["bodies", "ends", "connects"]),
        Key::new("stiffness", NON_NEGATIVE, "Force per change of length, of each spring of a chain")
            .unit("N/m")
            .required()
            .also(&["k", "constant", "strength"]),
        Key::new("damping", NON_NEGATIVE, "Force per speed of that change, against it")
            .unit("N·s/m")
            .default_number(0.0)
            .also(&["c", "friction", "damper"]),
        Key::new("rest_length", NON_NEGATIVE, "The length at which it does not pull or push")
            .unit("m")
            .default("its length at the start, for each of a chain its own")
            .also(&["length", "rest"]),
        super::showing::LINE,
        super::showing::COIL,
    ],
};

/// An end of a spring or a joint at a point of a body.
pub(in crate::scene) static END: TableSpec = TableSpec {
    noun: "a point of a body",
    rule: Rule::Any,
    keys: &[
        Key::new("body", Reference(Collection::Body), "The body that it is fastened to").required(),
        Key::new("at", VECTOR, "The point of the body, in the body's own axes, from its centre of mass")
            .unit("m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["point", "location", "position", "offset", "anchor"]),
    ],
};

static GRAVITATION: TableSpec = TableSpec {
    noun: "gravitation",
    rule: Rule::AtMostOne(&[&["on", "between"]]),
    keys: &[
        Key::new("constant", POSITIVE, "Newton's constant G")
            .unit("m³/(kg·s²)")
            .default_number(Gravitation::CONSTANT)
            .also(&["g", "G", "strength"]),
        softening(),
        Key::new(
            "opening_angle",
            Number(Bound::From(0.0, 1.0)),
            "For thousands of bodies: distant bodies act together, by a Barnes–Hut tree with quadrupoles, where their size is less than \
             this times their distance. At 0.5, forces are off by 4e-4, at 0.3 by 8e-5; energy and momentum drift by less than that. \
             Particles feel each body alone",
        )
        .default("0: the sum over all pairs")
        .also(&["theta", "angle", "opening", "tree", "barnes_hut"]),
        on("The bodies that attract each other; the fixed ones among them attract, too", "all but planes"),
        between(
            "Two groups, each a body, the copies of one, or a list: those of one attract those of the other, and not each other",
        ),
    ],
};

static COULOMB: TableSpec = TableSpec {
    noun: "a Coulomb force",
    rule: Rule::AtMostOne(&[&["on", "between"]]),
    keys: &[
        Key::new("constant", POSITIVE, "Coulomb's constant, 1/4πε₀")
            .unit("N·m²/C²")
            .default_number(Coulomb::CONSTANT)
            .also(&["k", "strength"]),
        softening(),
        on("The bodies that act on each other; the fixed ones among them act, too", "all with a charge"),
        between(
            "Two groups, each a body, the copies of one, or a list: those of one act on those of the other, and not on each other",
        ),
    ],
};

static LENNARD_JONES: TableSpec = TableSpec {
    noun: "a Lennard-Jones force",
    rule: Rule::AtMostOne(&[&["on", "between"]]),
    keys: &[
        Key::new("epsilon", POSITIVE, "How deep the potential 4 epsilon ((sigma/r)¹² − (sigma/r)⁶) is")
            .unit("J")
            .required()
            .also(&["eps", "depth", "e", "well_depth"]),
        Key::new("sigma", POSITIVE, "The distance at which the potential is 0; it is lowest at 1.12 of it")
            .unit("m")
            .required()
            .also(&["diameter", "s", "distance", "size"]),
        Key::new(
            "cutoff",
            POSITIVE,
            "Beyond it there is no force; the potential is shifted so that it begins at 0 there",
        )
        .unit("m")
        .default("2.5 sigma")
        .also(&["r_cut", "rc", "range", "cut_off"]),
        Key::new(
            "smooth",
            Boolean,
            "Shift the force as well, so that it begins at 0 at the cutoff: energy is kept better, and atoms attract each other less",
        )
        .default_flag(false)
        .also(&["shifted_force", "force_shift"]),
        on("The bodies that act on each other; the fixed ones among them act, too", "all but planes"),
        between(
            "Two groups, each a body, the copies of one, or a list: those of one act on those of the other, and not on each other",
        ),
    ],
};

static BUOYANCY: TableSpec = TableSpec {
    noun: "buoyancy",
    rule: Rule::Any,
    keys: &[
        Key::new("density", POSITIVE, "The density of the liquid; that of water is 1000")
            .unit("kg/m³")
            .required()
            .also(&["rho", "fluid_density"]),
        Key::new(
            "level",
            ANY,
            "The height of its surface, measured against `simulation.gravity` from the origin",
        )
        .unit("m")
        .default_number(0.0)
        .also(&["height", "surface", "y"]),
        on("The bodies that it carries", "all that can move"),
    ],
};

static DIPOLES: TableSpec = TableSpec {
    noun: "magnetic dipoles",
    rule: Rule::AtMostOne(&[&["on", "between"]]),
    keys: &[
        Key::new("constant", POSITIVE, "The magnetic constant over 4π, μ₀/4π")
            .unit("N/A²")
            .default_number(Dipoles::CONSTANT)
            .also(&["k", "strength"]),
        Key::new(
            "field",
            VECTOR,
            "A magnetic field that is the same everywhere, and turns them into its direction",
        )
        .unit("T")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["b", "B", "magnetic"]),
        on(
            "The bodies that act on each other; the fixed ones among them act, too",
            "all with a `magnetic_moment`",
        ),
        between(
            "Two groups, each a body, the copies of one, or a list: those of one act on those of the other, and not on each other",
        ),
    ],
};

static J2_KEYS: TableSpec = TableSpec {
    noun: "the gravity of a bulge",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "of",
            Reference(Collection::Body),
            "The planet; its attraction as if it were round is `gravitation`",
        )
        .required()
        .also(&["planet", "body", "center"]),
        Key::new("j2", ANY, "The coefficient J₂ of its gravity: 1.0826e-3 for the earth")
            .required()
            .also(&["J2", "coefficient"]),
        Key::new("radius", POSITIVE, "The radius of its equator, to which J₂ belongs")
            .unit("m")
            .required()
            .also(&["r", "R", "equatorial_radius"]),
        Key::new("axis", AXIS, "Its axis, in its own axes").default_numbers(&[0.0, 1.0, 0.0]).also(&["pole"]),
        Key::new("constant", POSITIVE, "Newton's constant G")
            .unit("m³/(kg·s²)")
            .default_number(Gravitation::CONSTANT)
            .also(&["g", "G"]),
        on("The bodies that it acts on, and which act on the planet", "all others but planes"),
    ],
};

static FORMULA: TableSpec = TableSpec {
    noun: "a force by formulas",
    rule: Rule::Any,
    keys: &[
        Key::new(
            "force",
            ListOfBody(3, QUANTITIES),
            "The force at the centre of each body, in world axes: `x`, `y`, `z` are its place, `r` its distance from the origin, \
             `vx`, `vy`, `vz` its velocity, `speed` its magnitude, `t` the time",
        )
        .unit("N")
        .required()
        .also(&["f", "F", "formula", "value"]),
        Key::new(
            "potential",
            OfBody(OF_PLACE),
            "The potential energy of each body, of which the force at rest must be −∂U/∂x, −∂U/∂y, −∂U/∂z: it then counts as \
             energy, and only the work of what velocities add is booked",
        )
        .unit("J")
        .default("none: all of its work is booked")
        .also(&["u", "U", "energy", "potential_energy"]),
        on("The bodies that it acts on", "all that can move"),
    ],
};

static LORENTZ: TableSpec = TableSpec {
    noun: "a Lorentz force",
    rule: Rule::Any,
    keys: &[
        Key::new("electric", VECTOR, "The electric field E")
            .unit("V/m")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["e", "E"]),
        Key::new("magnetic", VECTOR, "The magnetic field B: the force is q (E + v × B)")
            .unit("T")
            .default_numbers(&[0.0, 0.0, 0.0])
            .also(&["b", "B"]),
        on("The bodies that it acts on", "all with a charge that can move"),
    ],
};
