//! Places copies of a body at random in a volume, without overlaps.

use std::collections::{BTreeMap, HashMap};

use glam::{DQuat, DVec3};

use super::CopyPose;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::random::Stream;
use crate::scene::grammar::repeat::{cuboid, cylinder, scatter, sphere, volume};
use crate::scene::view::View;

/// The settings of `repeat.scatter`, which places copies at random.
pub(super) struct Scatter {
    pub(super) count: usize,
    volume: Volume,
    /// The minimum gap between the bounding spheres of two copies, m.
    gap: f64,
    turned: bool,
}

/// The volume in which copies are placed, centered at the origin. Lengths in m.
enum Volume {
    Box { size: DVec3 },
    Sphere { radius: f64 },
    Cylinder { radius: f64, height: f64 },
}

/// The error that one of the copies cannot be placed in the volume.
pub(super) struct Full {
    /// The number of copies that were placed before the error.
    placed: usize,
    /// The reason why the next copy could not be placed.
    why: Why,
}

enum Why {
    /// The copy is unbounded, such as a plane.
    Endless,
    /// The bounding sphere of the copy is larger than the volume.
    TooLarge,
    /// All random places that were tried overlap other copies.
    Crowded,
    /// The search needs more than this number of comparisons with other copies.
    Costly(u64),
}

impl Scatter {
    pub(super) fn read(view: &View<'_>) -> Option<Scatter> {
        let within = view.variant(&scatter::WITHIN)?;
        let volume = if let Some(view) = within.variant(&volume::BOX) {
            Volume::Box { size: view.get(&cuboid::SIZE)? }
        } else if let Some(view) = within.variant(&volume::SPHERE) {
            Volume::Sphere { radius: view.get(&sphere::RADIUS)? }
        } else {
            let view = within.variant(&volume::CYLINDER)?;
            Volume::Cylinder { radius: view.get(&cylinder::RADIUS)?, height: view.get(&cylinder::HEIGHT)? }
        };
        Some(Scatter {
            count: usize::try_from(view.get(&scatter::COUNT)?).ok()?,
            volume,
            gap: view.get(&scatter::GAP),
            turned: view.get(&scatter::TURNED),
        })
    }

    /// Places copies at random. `sizes` are the radii of their bounding spheres, m. Tries random places for each copy until the copy
    /// overlaps no earlier copy. Earlier copies are never moved. `stream` gives each copy its own random stream.
    pub(super) fn places(
        &self,
        sizes: &[Option<f64>],
        mut stream: impl FnMut(usize) -> Stream,
    ) -> Result<Vec<CopyPose>, Full> {
        /// The maximum number of random places tried for each copy. Even when the volume is almost full of equal spheres, about one try in
        /// a hundred succeeds.
        const MAX_TRIES_PER_COPY: usize = 20_000;
        let most = most_looks(sizes.len());
        let mut taken = Taken::default();
        let mut places = Vec::with_capacity(sizes.len());
        for (placed, size) in sizes.iter().enumerate() {
            let radius = size.ok_or(Full { placed, why: Why::Endless })?;
            if !self.volume.holds(radius) {
                return Err(Full { placed, why: Why::TooLarge });
            }
            let mut stream = stream(placed);
            let turn = if self.turned { any_turn(&mut stream) } else { DQuat::IDENTITY };
            let mut free = None;
            for _ in 0..MAX_TRIES_PER_COPY {
                let place = self.volume.point(radius, &mut stream);
                if taken.is_free(place, radius + self.gap) {
                    free = Some(place);
                    break;
                }
                if taken.looks > most {
                    return Err(Full { placed, why: Why::Costly(most) });
                }
            }
            let offset = free.ok_or(Full { placed, why: Why::Crowded })?;
            taken.add(offset, radius);
            places.push(CopyPose { offset, turn });
        }
        Ok(places)
    }
}

impl Full {
    /// Returns the diagnostic for this error. `name` is the repeated body, `count` is the wanted number of copies, and `span` is that of
    /// the `repeat`.
    pub(super) fn diagnostic(&self, name: &str, count: usize, span: Span) -> Diagnostic {
        let Full { placed, why } = self;
        let (message, label) = match why {
            Why::Endless => (format!("`{name}` cannot be scattered"), "it is endless".to_owned()),
            Why::TooLarge => {
                let message = format!("`{name}[{placed}]` does not fit into the volume");
                (message, "the ball around it is larger than this".to_owned())
            }
            Why::Crowded => {
                let message = format!("only {placed} of {count} copies of `{name}` find a place");
                (message, "no more of them fit in here at random".to_owned())
            }
            Why::Costly(most) => {
                let message = format!("only {placed} of {count} copies of `{name}` find a place");
                (message, format!("the search ended after {} million comparisons", most / 1_000_000))
            }
        };
        let error = Diagnostic::error(Code::ScatterFull, message).at(span, label);
        match why {
            Why::Endless => error,
            _ => error.help(
                "balls at random fill at most a third of a volume; more fit into a larger volume, or a `grid`",
            ),
        }
    }
}

impl Volume {
    /// Returns true if a sphere of this radius, m, fits into the volume. Along a direction in which the volume has no extent, only the
    /// center has to fit.
    fn holds(&self, radius: f64) -> bool {
        let fits = |length: f64| length == 0.0 || radius <= length / 2.0;
        match self {
            Volume::Box { size } => size.to_array().into_iter().all(fits),
            Volume::Sphere { radius: outer } => radius <= *outer,
            Volume::Cylinder { radius: outer, height } => radius <= *outer && fits(*height),
        }
    }

    /// Draws a uniformly distributed point for the center of a sphere of this radius, m, that fits into the volume.
    fn point(&self, radius: f64, stream: &mut Stream) -> DVec3 {
        let mut between = |length: f64| (2.0 * stream.uniform() - 1.0) * (length / 2.0 - radius).max(0.0);
        match self {
            Volume::Box { size } => DVec3::from_array(size.to_array().map(between)),
            Volume::Cylinder { radius: outer, height } => {
                let y = between(*height);
                let distance = (outer - radius) * stream.uniform().sqrt();
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * stream.uniform());
                DVec3::new(distance * cos, y, distance * sin)
            }
            Volume::Sphere { radius: outer } => {
                let distance = (outer - radius) * libm::cbrt(stream.uniform());
                let normal = DVec3::new(stream.normal(), stream.normal(), stream.normal());
                distance * normal.normalize_or(DVec3::X)
            }
        }
    }
}

/// Draws a uniformly distributed rotation. Four normally distributed numbers have a uniformly distributed direction; normalized, they are
/// the quaternion.
fn any_turn(stream: &mut Stream) -> DQuat {
    let [x, y, z, w] = [stream.normal(), stream.normal(), stream.normal(), stream.normal()];
    let length = (x * x + y * y + z * z + w * w).sqrt();
    if length > 0.0 {
        DQuat::from_xyzw(x / length, y / length, z / length, w / length)
    } else {
        DQuat::IDENTITY
    }
}

/// Returns the maximum number of comparisons for placing all copies. If spheres fill a third of the volume, each copy needs a few hundred
/// comparisons. Forty million comparisons take some seconds.
fn most_looks(copies: usize) -> u64 {
    5_000_000 + (1_000 * copies as u64).min(40_000_000)
}

/// The spheres placed so far, with a search grid for each class of size. With a single grid, one large sphere would make the cells large,
/// and many small spheres would share a cell.
#[derive(Default)]
struct Taken {
    /// The spheres by class of size. The key is the exponent of the smallest power of two that is at least the radius.
    sizes: BTreeMap<i32, OfSize>,
    /// The number of cells and spheres that the search has visited so far.
    looks: u64,
}

/// Spheres of similar size, with a grid of cells to search for neighbors.
struct OfSize {
    /// The largest radius of these spheres, m. The cells are twice as wide.
    largest: f64,
    balls: Vec<(DVec3, f64)>,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

impl Taken {
    /// Returns true if a sphere at `place` overlaps no placed sphere. `radius` includes the minimum gap, m.
    fn is_free(&mut self, place: DVec3, radius: f64) -> bool {
        let looks = &mut self.looks;
        self.sizes.values().all(|of_size| of_size.is_free(place, radius, looks))
    }

    #[allow(clippy::cast_possible_truncation, reason = "the exponent of a double is small")]
    fn add(&mut self, place: DVec3, radius: f64) {
        let exponent = libm::ceil(libm::log2(radius.max(f64::MIN_POSITIVE))) as i32;
        let new = || {
            let largest = libm::exp2(f64::from(exponent)).max(radius);
            OfSize { largest, balls: Vec::new(), cells: HashMap::new() }
        };
        let of_size = self.sizes.entry(exponent).or_insert_with(new);
        // Because of rounding, the power of two may be slightly smaller than the radius.
        of_size.largest = of_size.largest.max(radius);
        let number = of_size.balls.len();
        of_size.balls.push((place, radius));
        of_size.cells.entry(of_size.cell(place)).or_default().push(number);
    }
}

impl OfSize {
    #[allow(clippy::cast_possible_truncation, reason = "what is too far away saturates")]
    fn cell(&self, place: DVec3) -> [i64; 3] {
        (place / (2.0 * self.largest)).floor().to_array().map(|number| number as i64)
    }

    fn is_free(&self, place: DVec3, radius: f64, looks: &mut u64) -> bool {
        let mut is_apart = |(other, size): &(DVec3, f64)| {
            *looks += 1;
            other.distance(place) >= radius + size
        };
        let reach = radius + self.largest;
        let (low, high) = (self.cell(place - reach), self.cell(place + reach));
        #[allow(clippy::cast_precision_loss, reason = "an estimate")]
        let cells: f64 =
            low.iter().zip(high).map(|(low, high)| high.saturating_sub(*low) as f64 + 1.0).product();
        #[allow(clippy::cast_precision_loss, reason = "an estimate")]
        let all = self.balls.len() as f64;
        // If the sphere reaches more cells than there are spheres, comparing it with every sphere is faster.
        if cells > all {
            return self.balls.iter().all(is_apart);
        }
        let mut visited = 0;
        let is_free = (low[0]..=high[0]).all(|x| {
            (low[1]..=high[1]).all(|y| {
                (low[2]..=high[2]).all(|z| {
                    visited += 1;
                    let balls = self.cells.get(&[x, y, z]);
                    balls.is_none_or(|balls| balls.iter().all(|&ball| is_apart(&self.balls[ball])))
                })
            })
        });
        *looks += visited;
        is_free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If the grid cells were as large as the largest sphere, all small spheres would share a few cells, and each would be compared with
    /// all others.
    #[test]
    fn one_large_ball_does_not_make_small_ones_be_compared_with_each_other() {
        let looks = |count: usize| {
            let mut taken = Taken::default();
            taken.add(DVec3::ZERO, 1e3);
            for i in 0..count {
                #[allow(clippy::cast_precision_loss, reason = "there are few")]
                let place = DVec3::new(2e3 + 0.3 * (i % 100) as f64, 0.3 * (i / 100) as f64, 0.0);
                assert!(taken.is_free(place, 0.1));
                taken.add(place, 0.1);
            }
            assert!(!taken.is_free(DVec3::new(2e3, 0.0, 0.0), 500.0));
            taken.looks
        };
        let (few, many) = (looks(1_000), looks(4_000));
        assert!(many < 5 * few, "{few} looks, then {many}");
    }
}
