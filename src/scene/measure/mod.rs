//! The quantities that labels and plots can show: measures of the run, of its bodies, joints and forces, and formulas of them.

mod aggregate;
mod body;
mod emitter;
mod force;
mod joint;
mod run;

pub use aggregate::{Aggregate, Aggregation};
pub use body::BodyMeasure;
pub use emitter::EmitterMeasure;
pub use force::ForceMeasure;
pub use joint::{JointMeasure, JointState};
pub use run::RunMeasure;

use super::expression::Program;

/// A formula of measures. It has a value at each time of the run.
#[derive(Clone, Debug)]
pub struct MeasureFormula {
    /// The compiled formula. Its inputs are the values of the measures in `inputs`.
    pub program: Program,
    /// The measures that the formula names, in the order of the program's inputs.
    pub inputs: Vec<Measure>,
    /// The measure that the formula consists of, if it is the name of a single one.
    pub single: Option<Measure>,
    /// The symbol of the unit of the single measure. Empty for a pure number. `None` if the formula is not the name of a single measure.
    pub own_unit: Option<&'static str>,
    /// Whether the formula is a single count. A label shows all digits of a count.
    pub is_count: bool,
    /// The unit that the scene asks for. `None` for the own unit of the measure.
    pub asked_unit: Option<AskedUnit>,
}

/// A unit that a scene asks for, such as `km/h`.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedUnit {
    /// The symbol of the unit, as the scene gives it.
    pub symbol: Box<str>,
    /// The size of the unit in the own unit of the measure.
    pub size: f64,
}

impl MeasureFormula {
    /// Returns the unit of the formula's values. `None` if the formula is not the name of a single measure. The unit of a pure number is
    /// empty.
    pub fn unit(&self) -> Option<&str> {
        self.asked_unit.as_ref().map(|asked| &*asked.symbol).or(self.own_unit)
    }

    /// Returns the size of the unit of the formula's values, in the own unit of the measure.
    pub fn unit_size(&self) -> f64 {
        self.asked_unit.as_ref().map_or(1.0, |asked| asked.size)
    }

    /// Returns whether the values are an angle that jumps by a full turn, from 180° to −180° or back.
    pub fn jumps_by_a_turn(&self) -> bool {
        matches!(self.single, Some(Measure::Angle(_) | Measure::Joint(_, JointMeasure::Angle)))
    }

    /// Returns the only body that the formula names, as an index in the scene. `None` if there is none, or if there are several.
    pub fn body(&self) -> Option<usize> {
        let bodies = self.inputs.iter().filter_map(|measure| match measure {
            Measure::Body(Subject::One(body), _) => Some(*body),
            _ => None,
        });
        let first = bodies.clone().next();
        first.filter(|first| bodies.clone().all(|body| body == *first))
    }
}

/// The body that a measure belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// One body. The number is the index of the body in the scene.
    One(usize),
    /// Each body of the [aggregate](Aggregate) that contains the measure.
    Each,
}

/// A quantity of a run. It has a value at each time of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A quantity of the whole run, such as the time or the total energy.
    Run(RunMeasure),
    /// A quantity of one body.
    Body(Subject, BodyMeasure),
    /// A quantity of one joint. The number is the index of the joint in the scene.
    Joint(usize, JointMeasure),
    /// A quantity of one force, on one body or on all its bodies together. The number is the index of the force in the scene.
    Force(usize, Option<Subject>, ForceMeasure),
    /// The number of impacts between two bodies so far. The number is an index into `pairs` of the scene.
    Impacts(usize),
    /// A quantity of one emitter. The number is the index of the emitter in the scene.
    Emitter(usize, EmitterMeasure),
    /// A further column of the trajectory file of a body. The number is the index of the column in `file_columns` of the scene.
    FileColumn(Subject, usize),
    /// The smallest distance so far between the centers of two bodies, m. The number is an index into `approaches` of the scene.
    Closest(usize),
    /// The distance between the centers of two bodies, m. The number is the index of the second body in the scene.
    Distance(Subject, usize),
    /// An angle of the scene, degrees. The number is an index into `angles` of the scene.
    Angle(usize),
    /// The length of a dimension line, m. The number is an index into `distances` of the scene.
    Length(usize),
    /// The area of the last complete sector of a swept area, m². The number is an index into `areas` of the scene.
    Area(usize),
    /// A quantity of several bodies. The number is an index into `aggregates` of the scene.
    Aggregate(usize),
}

/// The quantities of two bodies, each with its name in formulas, its unit and its meaning.
const OF_TWO_BODIES: [(&str, &str, &str); 4] = [
    ("BODY.distance.OTHER", "m", "the distance between the centers of two bodies"),
    ("BODY.closest.OTHER", "m", "the smallest distance of the centers so far"),
    ("BODY.impacts.OTHER", "", "the number of impacts between two bodies so far"),
    ("BODY.impacts.ground", "", "the number of its impacts with the ground so far"),
];

/// The measures of marks, each with its name in formulas, its unit and its meaning.
const OF_MARKS: [(&str, &str, &str); 3] = [
    ("angle.NAME", "°", "the angle of `[angle.NAME]`"),
    ("distance.NAME", "m", "the length of `[distance.NAME]`"),
    ("area.NAME", "m²", "the area of the last complete sector of `[area.NAME]`"),
];

/// A line of the list of all measures.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedMeasure {
    /// The name in formulas, with a word in capitals for each name of a thing.
    pub name: String,
    /// The unit. Empty for a pure number.
    pub unit: String,
    /// The meaning.
    pub meaning: &'static str,
}

impl Measure {
    /// Returns the list of all measures, for people.
    pub fn listed() -> Vec<ListedMeasure> {
        let line = |name: String, unit: &str, meaning| ListedMeasure { name, unit: unit.to_owned(), meaning };
        let mut list: Vec<ListedMeasure> = Vec::new();
        list.extend(RunMeasure::ALL.map(|(name, of, meaning)| line(name.to_owned(), of.unit(), meaning)));
        list.extend(
            BodyMeasure::ALL.map(|(name, of, meaning)| line(format!("BODY.{name}"), of.unit(), meaning)),
        );
        list.extend(OF_TWO_BODIES.map(|(name, unit, meaning)| line(name.to_owned(), unit, meaning)));
        list.extend(
            JointMeasure::ALL.map(|(name, of, meaning)| line(name.to_owned(), &of.unit_in_words(), meaning)),
        );
        list.extend(
            EmitterMeasure::ALL
                .map(|(name, of, meaning)| line(format!("emitter.NAME.{name}"), of.unit(), meaning)),
        );
        let of_force = |(name, of, meaning): (&str, ForceMeasure, _)| {
            line(format!("force.NAME.{name}"), of.unit(), meaning)
        };
        list.extend(ForceMeasure::ALL.map(of_force));
        let of_force = |(name, of, _): (&str, ForceMeasure, _)| {
            line(
                format!("force.NAME.BODY.{name}"),
                of.unit(),
                "the same for one of the bodies that it acts on",
            )
        };
        list.extend(ForceMeasure::ALL.map(of_force));
        list.extend(OF_MARKS.map(|(name, unit, meaning)| line(name.to_owned(), unit, meaning)));
        let of_copies = |(name, _, meaning): (&str, _, _)| {
            line(format!("{name}(BODY.speed)"), BodyMeasure::Speed.unit(), meaning)
        };
        list.extend(Aggregation::ALL.map(of_copies));
        list
    }

    /// Replaces "each body of an aggregate" in a measure by one body. Other measures stay as they are.
    pub fn of_one(self, body: usize) -> Measure {
        let one = Subject::One(body);
        match self {
            Measure::Body(Subject::Each, measure) => Measure::Body(one, measure),
            Measure::Force(force, Some(Subject::Each), measure) => Measure::Force(force, Some(one), measure),
            Measure::Distance(Subject::Each, other) => Measure::Distance(one, other),
            Measure::FileColumn(Subject::Each, column) => Measure::FileColumn(one, column),
            other => other,
        }
    }

    /// Returns whether the measure belongs to each body of an aggregate.
    pub fn is_of_each(self) -> bool {
        self.of_one(0) != self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit is in a column of its own, so a meaning does not repeat it.
    #[test]
    fn each_measure_is_listed_once_with_its_meaning() {
        let list = Measure::listed();
        for (number, line) in list.iter().enumerate() {
            assert!(!line.meaning.is_empty() && !line.meaning.contains(", m/s"), "{line:?}");
            assert!(list[number + 1..].iter().all(|other| other.name != line.name), "{line:?}");
        }
    }
}
