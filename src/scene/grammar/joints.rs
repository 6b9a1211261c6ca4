//! The keys of `[joint.NAME]`.

use super::Kind::{Choice, Color, Direction, Either, List, Reference, Table};
use super::forces::END;
use super::keys::{POSITIVE, VECTOR};
use super::{Collection, Key, Kind, Rule, TableSpec};

pub(super) static JOINT: TableSpec = TableSpec {
    noun: "a joint",
    rule: Rule::ExactlyOne(&["ball", "hinge", "slider", "fixed", "rod"]),
    keys: &[
        Key::new("ball", Table(&BALL), "A point of one stays at a point of the other; every turn is free")
            .also(&["spherical", "socket", "point", "pin"]),
        Key::new("hinge", Table(&HINGE), "The two turn against each other about one axis, as a door does")
            .also(&["revolute", "axle", "pivot"]),
        Key::new(
            "slider",
            Table(&SLIDER),
            "The second moves along an axis of the first, and does not turn against it",
        )
        .also(&["prismatic", "rail"]),
        Key::new("fixed", Table(&FIXED), "The two move as one body").also(&["weld", "rigid", "glue"]),
        Key::new("rod", Table(&ROD), "The distance of two points stays as it is; the rod has no mass")
            .also(&["distance", "link", "bar", "stick"]),
    ],
};

static AN_END: Kind = Either(&[Reference(Collection::Body), VECTOR, Table(&END)]);

const fn between(meaning: &'static str) -> Key {
    Key::new("between", List { of: &AN_END, min: 2, max: 2 }, meaning)
        .unit("m")
        .required()
        .also(&["bodies", "ends", "connects"])
}

const PAIR: &str =
    "The two that it joins: each the name of a body, a point of a body, or a point of the world";

const AT: Key = Key::new(
    "at",
    VECTOR,
    "Where they are joined at the start, in the world; not needed where an end says it",
)
.unit("m")
.also(&["point", "location", "position", "anchor"]);

const fn axis(meaning: &'static str) -> Key {
    Key::new("axis", Direction(3), meaning).required().also(&["direction", "normal"])
}

const LOOK: Key = Key::new(
    "look",
    Either(&LOOK_KINDS),
    "How it is drawn: `\"none\"`, or the size and color of its rod or pin",
)
.default("of steel, in a size that fits its bodies")
.also(&["draw", "drawn", "visible", "line"]);
static LOOK_KINDS: [Kind; 2] = [Choice(|| vec!["none"]), Table(&LOOK_TABLE)];

static LOOK_TABLE: TableSpec = TableSpec {
    noun: "the look of a joint",
    rule: Rule::Any,
    keys: &[
        Key::new("radius", POSITIVE, "The radius of the rod or of the pin")
            .unit("m")
            .default("a part of that of the smaller body")
            .also(&["thickness", "width", "size"]),
        Key::new("color", Color, "Its color").default("that of steel").also(&["colour"]),
    ],
};

static BALL: TableSpec = TableSpec {
    noun: "a ball joint",
    rule: Rule::Any,
    keys: &[between(PAIR), AT.default("the end that is a point of the world"), LOOK],
};

static HINGE: TableSpec = TableSpec {
    noun: "a hinge",
    rule: Rule::Any,
    keys: &[
        between(PAIR),
        AT.default("the end that is a point of the world"),
        axis("The axis about which they turn, in the world at the start"),
        LOOK,
    ],
};

static SLIDER: TableSpec = TableSpec {
    noun: "a slider",
    rule: Rule::Any,
    keys: &[
        between(PAIR),
        AT.default("the centre of the second"),
        axis("The axis along which the second moves, in the world at the start; it turns with the first"),
        LOOK,
    ],
};

static FIXED: TableSpec = TableSpec {
    noun: "a fixed joint",
    rule: Rule::Any,
    keys: &[between(PAIR), AT.default("the centre of the second"), LOOK],
};

static ROD: TableSpec = TableSpec {
    noun: "a rod",
    rule: Rule::Any,
    keys: &[
        between(
            "The two that it joins: each the name of a body (its centre), a point of a body, or a point of the world",
        ),
        Key::new("length", POSITIVE, "The distance of its ends")
            .unit("m")
            .default("as at the start")
            .also(&["distance", "l"]),
        LOOK,
    ],
};
