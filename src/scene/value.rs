//! The types that keys of a scene are read as.

use std::sync::Arc;

use glam::DVec3;

use super::read;
use crate::scene::force_formula;
use crate::scene::grammar::{Declared, DefaultValue, Kind, ReadAs};
use crate::scene::sampled_number;
use crate::scene::source::Node;
use crate::scene::timed;

/// A type that values of keys are read as.
pub(in crate::scene) trait Value {
    /// The value that a reader gets.
    type Read<'a>;
    /// The type as the grammar knows it.
    const TYPE: ReadAs;

    /// Reads a value of a kind that fits the type. `None` if the value is invalid.
    fn read<'a>(node: &'a Node, kind: &Kind) -> Option<Self::Read<'a>>;

    /// Returns the default of a key. `None` if the key has no default value of this type.
    fn default<'a>(default: DefaultValue) -> Option<Self::Read<'a>>;
}

/// Declares how a type is read: the type, what a reader gets, its name in the grammar, the function that reads a value, and its default.
macro_rules! value {
    ($type:ty => $read:ty, $name:ident, |$node:ident, $kind:pat_param| $value:expr, |$given:ident| $default:expr) => {
        impl Value for $type {
            type Read<'a> = $read;
            const TYPE: ReadAs = ReadAs::$name;

            fn read<'a>($node: &'a Node, kind: &Kind) -> Option<Self::Read<'a>> {
                match kind {
                    $kind => $value,
                    #[allow(unreachable_patterns, reason = "the kind may not matter")]
                    _ => None,
                }
            }

            fn default<'a>($given: DefaultValue) -> Option<Self::Read<'a>> {
                $default
            }
        }

        impl Declared for $type {
            const TYPE: ReadAs = ReadAs::$name;
            const NEEDS_DEFAULT: bool = true;
        }
    };
}

impl<T: Value> Declared for Option<T> {
    const TYPE: ReadAs = T::TYPE;
    const NEEDS_DEFAULT: bool = false;
}

/// A direction, read as a unit vector.
pub(in crate::scene) struct Axis;
/// A quaternion of length 1, as its four numbers.
pub(in crate::scene) struct Quaternion;
/// A color.
pub(in crate::scene) struct Color;
/// A color, or a list of colors.
pub(in crate::scene) struct Colors;
/// Any kind of string.
pub(in crate::scene) struct Text;
/// A string that all copies of a body share in memory.
pub(in crate::scene) struct SharedText;
/// A number, or a formula of the time.
pub(in crate::scene) struct Timed;
/// A list of three items, each a number or a formula of the time.
pub(in crate::scene) struct TimedVector;
/// A number, or a formula of the time and of measures.
pub(in crate::scene) struct Varying;
/// A list of three items, each a number or a formula of the time and of measures.
pub(in crate::scene) struct VaryingPoint;
/// A number, or a formula with random numbers that is evaluated for each particle.
pub(in crate::scene) struct Sampled;
/// A number, or a formula of a body's quantities.
pub(in crate::scene) struct OfBody;
/// A list of three items, each a number or a formula of a body's quantities.
pub(in crate::scene) struct ListOfBody;

value!(f64 => f64, Number, |node, Kind::Number(bound)| read::number(node, *bound).ok(), |given| given.number());
value!(i64 => i64, Integer, |node, Kind::Integer(low, high)| read::integer(node, *low, *high).ok(), |given| given.integer());
value!(u32 => u32, Integer, |node, Kind::Integer(low, high)| u32::try_from(read::integer(node, *low, *high).ok()?).ok(),
    |given| u32::try_from(given.integer()?).ok());
value!(bool => bool, Boolean, |node, _| node.as_boolean(), |given| given.flag());
value!(DVec3 => DVec3, Vector, |node, Kind::Numbers(_, bound)| read::vector(node, *bound),
    |given| given.numbers().map(DVec3::from_array));
value!(Axis => DVec3, Axis, |node, _| read::direction(node).ok().map(DVec3::from_array),
    |given| given.numbers().map(DVec3::from_array));
value!(Quaternion => [f64; 4], Quaternion, |node, _| read::direction(node).ok(), |given| given.numbers());
value!(Color => crate::scene::Color, Color, |node, _| read::color(node).ok(),
    |given| given.word().and_then(crate::scene::Color::parse));
value!(Colors => Vec<crate::scene::Color>, Colors, |node, _| read::colors(node).ok(), |_given| None);
value!(Text => &'a str, Text, |node, _| node.as_str(), |given| given.word());
value!(SharedText => Arc<str>, Text, |node, _| node.as_shared_text(), |given| given.word().map(Arc::from));
value!(Timed => timed::Timed, Timed, |node, Kind::Timed(bound)| read::timed(node, *bound).ok(),
    |given| given.number().map(timed::Timed::Constant));
value!(TimedVector => timed::TimedVector, TimedVector,
    |node, Kind::TimedNumbers(_, bound)| read::timed_vector(node, *bound).ok(), |_given| None);
value!(Varying => read::UncheckedVarying<'a>, Varying, |node, Kind::Varying(bound)| read::varying(node, *bound).ok(),
    |given| given.number().map(|number| read::UncheckedVarying::Timed(timed::Timed::Constant(number))));
value!(VaryingPoint => [read::UncheckedVarying<'a>; 3], VaryingPoint,
    |node, Kind::VaryingNumbers(_, bound)| read::varying_point(node, *bound).ok(), |_given| None);
value!(Sampled => sampled_number::SampledNumber, Sampled, |node, Kind::Sampled(bound)| read::drawn(node, *bound).ok(),
    |given| given.number().map(sampled_number::SampledNumber::Constant));
value!(OfBody => force_formula::OfBody, OfBody, |node, Kind::OfBody(names)| read::of_body(node, names).ok(), |_given| None);
value!(ListOfBody => [force_formula::OfBody; 3], ListOfBody,
    |node, Kind::ListOfBody(_, names)| read::list_of_body(node, names).ok(), |_given| None);
value!(Vec<i64> => Vec<i64>, Integers,
    |node, kind| read::list_of(node, kind, |item, of| match of {
        Kind::Integer(low, high) => read::integer(item, *low, *high).ok(),
        _ => None,
    }),
    |given| given.integers());
value!(Vec<f64> => Vec<f64>, Numbers,
    |node, kind| read::list_of(node, kind, |item, of| match of {
        Kind::Number(bound) => read::number(item, *bound).ok(),
        _ => None,
    }),
    |_given| None);
value!(Vec<[f64; 2]> => Vec<[f64; 2]>, Pairs,
    |node, kind| read::list_of(node, kind, |item, of| match of {
        Kind::Numbers(_, bound) => read::numbers(item, *bound).ok(),
        _ => None,
    }),
    |_given| None);
value!(Vec<DVec3> => Vec<DVec3>, Vectors,
    |node, kind| read::list_of(node, kind, |item, of| match of {
        Kind::Numbers(_, bound) => read::vector(item, *bound),
        _ => None,
    }),
    |_given| None);
