//! Finds outliers: bodies that fly far away from most other bodies.

use super::Bounds;

/// The smallest number of moving bodies for which outliers are searched.
const MIN_MOVING_BODIES: usize = 8;
/// The largest fraction of the moving bodies that may be outliers.
const MAX_STRAY_FRACTION: f64 = 1.0 / 3.0;
/// The largest ratio of the run's size without outliers to its size with outliers. If the ratio is larger, no body counts as an outlier.
const MAX_SIZE_RATIO: f64 = 0.5;

/// The space that each body takes during a run, by the index of the body.
#[derive(Default)]
pub(super) struct Paths(Vec<Option<Path>>);

/// The space that a body takes during a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    is_fixed: bool,
    /// The box around the body in its first frame.
    start: Bounds,
    /// The box around the body in all frames.
    all: Bounds,
    /// The box around the body and its drawn axes, arrows and trail, in all frames.
    seen: Bounds,
}

/// The space of a run without its outliers. Of each outlier, only its first frame is included.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WithoutOutliers {
    /// The indices of the outliers, the one that gets farthest first.
    pub(super) outliers: Vec<usize>,
    /// The box around all bodies.
    pub(super) bounds: Bounds,
    /// The box around the bodies that are not fixed.
    pub(super) moving: Bounds,
    /// The box around all bodies and their drawn axes, arrows and trails.
    pub(super) seen: Bounds,
}

impl Paths {
    /// Adds a frame of a body: `here` is the box around the body, and `seen` the box around the body and its drawn axes, arrows and trail.
    pub(super) fn see(&mut self, body: usize, is_fixed: bool, here: Bounds, seen: Bounds) {
        if self.0.len() <= body {
            self.0.resize(body + 1, None);
        }
        let path = self.0[body].get_or_insert(Path { is_fixed, start: here, all: here, seen });
        path.all = path.all.union(here);
        path.seen = path.seen.union(seen);
    }

    /// The boxes around the fixed bodies, with their drawn axes, arrows and trails.
    pub(super) fn of_fixed(&self) -> impl Iterator<Item = Bounds> {
        self.0.iter().flatten().filter(|path| path.is_fixed).map(|path| path.seen)
    }

    /// The paths of all bodies, with their indices.
    fn all(&self) -> impl Iterator<Item = (usize, Path)> {
        self.0.iter().enumerate().filter_map(|(body, path)| Some((body, (*path)?)))
    }

    /// Finds the smallest number of outliers without which the run is much smaller, and returns the space without them. `None` if there are
    /// no outliers.
    pub(super) fn without_outliers(&self) -> Option<WithoutOutliers> {
        let mut paths: Vec<(usize, Path)> = self.all().collect();
        let moving = paths.iter().filter(|(_, path)| !path.is_fixed).count();
        if moving < MIN_MOVING_BODIES {
            return None;
        }
        let centre = middle_of_starts(&paths);
        // Outliers are the bodies that get farthest from the median of all starting points.
        let reach = |(_, path): &(usize, Path)| {
            let farthest = (path.all.max - centre).abs().max((path.all.min - centre).abs());
            if path.is_fixed { 0.0 } else { farthest.length() }
        };
        paths.sort_by(|one, two| reach(two).total_cmp(&reach(one)));
        let whole = paths.iter().map(|(_, path)| path.all).reduce(Bounds::union)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a number")]
        let most = ((moving as f64 * MAX_STRAY_FRACTION) as usize).max(1);
        // The space of the last paths, by the index of the first of them: one pass, as the number of paths may be large.
        let mut rests = vec![Space::default(); paths.len() + 1];
        for (i, (_, path)) in paths.iter().enumerate().rev() {
            rests[i] = rests[i + 1].with(path.is_fixed, path.all, path.seen);
        }
        let mut starts = Space::default();
        (1..=most).find_map(|outliers| {
            let (_, outlier) = paths.get(outliers - 1)?;
            starts = starts.with(outlier.is_fixed, outlier.start, outlier.start);
            let outliers_of = || paths[..outliers].iter().map(|(body, _)| *body).collect();
            let rest = starts.union(rests[outliers]).whole(outliers_of)?;
            (rest.bounds.diagonal() <= MAX_SIZE_RATIO * whole.diagonal()).then_some(rest)
        })
    }
}

/// The space of some bodies: as [`WithoutOutliers`], with `None` for boxes around no bodies.
#[derive(Clone, Copy, Default)]
struct Space {
    bounds: Option<Bounds>,
    moving: Option<Bounds>,
    seen: Option<Bounds>,
}

impl Space {
    /// Adds a body.
    fn with(self, is_fixed: bool, bounds: Bounds, seen: Bounds) -> Space {
        let moving = (!is_fixed).then_some(bounds);
        self.union(Space { bounds: Some(bounds), moving, seen: Some(seen) })
    }

    fn union(self, other: Space) -> Space {
        let union =
            |one: Option<Bounds>, other: Option<Bounds>| one.into_iter().chain(other).reduce(Bounds::union);
        Space {
            bounds: union(self.bounds, other.bounds),
            moving: union(self.moving, other.moving),
            seen: union(self.seen, other.seen),
        }
    }

    /// Returns the boxes, or `None` if one of them is around no body.
    fn whole(self, outliers: impl Fn() -> Vec<usize>) -> Option<WithoutOutliers> {
        let (bounds, moving, seen) = (self.bounds?, self.moving?, self.seen?);
        Some(WithoutOutliers { outliers: outliers(), bounds, moving, seen })
    }
}

/// The median of each coordinate of the bodies' starting points, m.
fn middle_of_starts(paths: &[(usize, Path)]) -> glam::DVec3 {
    let median = |axis: usize| {
        let mut starts: Vec<f64> = paths.iter().map(|(_, path)| path.start.middle()[axis]).collect();
        let middle = starts.len() / 2;
        *starts.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    glam::DVec3::from_array(std::array::from_fn(median))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn cube(at: DVec3) -> Bounds {
        Bounds { min: at - 0.5, max: at + 0.5 }
    }

    /// A row of bodies, 1 m apart. The last body flies 50 m upward.
    fn row(bodies: usize) -> Paths {
        let mut paths = Paths::default();
        for i in 0..bodies {
            let at = cube(DVec3::X * i as f64);
            paths.see(i, false, at, at);
        }
        let far = cube(DVec3::new(bodies as f64, 50.0, 0.0));
        paths.see(bodies - 1, false, far, far);
        paths
    }

    #[test]
    fn one_of_ten_that_flies_away_counts_where_it_starts() {
        let rest = row(10).without_outliers().unwrap();
        assert_eq!(rest.outliers, [9]);
        assert_eq!(rest.bounds, Bounds { min: DVec3::splat(-0.5), max: DVec3::new(9.5, 0.5, 0.5) });
        assert_eq!((rest.moving, rest.seen), (rest.bounds, rest.bounds));
    }

    #[test]
    fn a_few_bodies_have_no_strays() {
        assert_eq!(row(7).without_outliers(), None);
    }

    #[test]
    fn a_third_of_the_bodies_may_fly_away_and_no_more() {
        let mut paths = row(10);
        let far = cube(DVec3::new(0.0, 60.0, 0.0));
        for body in 0..2 {
            paths.see(body, false, far, far);
            assert!(paths.without_outliers().is_some(), "{body}");
        }
        paths.see(2, false, far, far);
        assert_eq!(paths.without_outliers(), None);
    }

    #[test]
    fn a_body_that_stays_near_is_no_stray() {
        let mut paths = Paths::default();
        for i in 0..20 {
            let at = cube(DVec3::X * f64::from(i));
            paths.see(i as usize, false, at, at);
        }
        let near = cube(DVec3::new(0.0, 12.0, 0.0));
        paths.see(5, false, near, near);
        assert_eq!(paths.without_outliers(), None);
    }
}
