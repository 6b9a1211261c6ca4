//! The values of angles and dimension lines at a moment, and the points between which they are drawn.

use glam::{DQuat, DVec3};

use super::shown;
use crate::physics::{Anchor, BodySnapshot, find};
use crate::scene::{Angle, Body, Distance, Leg};

/// An angle at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleNow {
    /// The point at which both legs begin, m.
    pub vertex: DVec3,
    /// The direction of the first leg, a unit vector.
    pub from: DVec3,
    /// The unit vector about which the first leg turns to the second, counterclockwise for a positive angle.
    pub axis: DVec3,
    /// The angle, rad: from 0 to π, or from −π to π if the angle has an axis of its own.
    pub value: f64,
}

impl AngleNow {
    /// Computes an angle from the poses of the bodies. `scene_bodies` are the bodies of the scene. `None` while one of its bodies is
    /// absent, or if a leg has no direction.
    pub fn of(angle: &Angle, scene_bodies: &[Body], bodies: &[BodySnapshot]) -> Option<AngleNow> {
        let vertex = place(angle.vertex, bodies)?;
        // As seen along the axis, a leg has only its part across the axis.
        let across = |leg: DVec3| match angle.axis {
            Some(axis) => (leg - axis * leg.dot(axis)).try_normalize(),
            None => Some(leg),
        };
        let [from, to] = angle.legs.map(|leg| across(direction(leg, vertex, scene_bodies, bodies)?));
        let (from, to) = (from?, to?);
        let turn = from.cross(to);
        // The arctangent keeps all digits of small and of flat angles, which the arccosine loses.
        let (axis, value) = match angle.axis {
            Some(axis) => (axis, libm::atan2(turn.dot(axis), from.dot(to))),
            None => {
                let axis = turn.try_normalize().unwrap_or_else(|| from.any_orthonormal_vector());
                (axis, libm::atan2(turn.length(), from.dot(to)))
            }
        };
        Some(AngleNow { vertex, from, axis, value })
    }

    /// The unit vector from the vertex that divides the angle, at a part of it: 0 is the first leg, 1 the second.
    pub fn leg(&self, part: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(part * self.value);
        self.from * cos + self.axis.cross(self.from) * sin
    }
}

/// A dimension line at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceNow {
    /// The points between which it is measured, m.
    pub ends: [DVec3; 2],
    /// The ends of the drawn line, m.
    pub line: [DVec3; 2],
    /// The distance, m.
    pub value: f64,
}

impl DistanceNow {
    /// Computes a distance from the poses of the bodies. `None` while one of its bodies is absent.
    pub fn of(distance: &Distance, bodies: &[BodySnapshot]) -> Option<DistanceNow> {
        let [a, b] = distance.between.map(|end| place(end, bodies));
        let ends = [a?, b?];
        let way = ends[1] - ends[0];
        let way = distance.along.map_or(way, |along| along * way.dot(along));
        let begin = ends[0] + distance.offset;
        Some(DistanceNow { ends, line: [begin, begin + way], value: way.length() })
    }
}

/// The direction of a leg that begins at `vertex`, m: a unit vector. `scene_bodies` are the bodies of the scene. `None` while its body is absent,
/// or if it has no direction.
pub(crate) fn direction(
    leg: Leg,
    vertex: DVec3,
    scene_bodies: &[Body],
    bodies: &[BodySnapshot],
) -> Option<DVec3> {
    match leg {
        Leg::Along(direction) => Some(direction),
        Leg::Towards(point) => (place(point, bodies)? - vertex).try_normalize(),
        Leg::Of { body, quantity, negligible } => {
            let vector = shown(quantity, &scene_bodies[body], find(bodies, body)?);
            vector.try_normalize().filter(|_| vector.length() > negligible)
        }
    }
}

/// The position (m) and the velocity (m/s) of an anchor. `None` while its body is absent.
pub(super) fn motion(anchor: Anchor, bodies: &[BodySnapshot]) -> Option<(DVec3, DVec3)> {
    match anchor {
        Anchor::Point(point) => Some((point, DVec3::ZERO)),
        Anchor::Body { id, at } => Some(find(bodies, id.index())?.point(at)),
    }
}

/// The position of an anchor, m. `None` while its body is absent.
pub(crate) fn place(anchor: Anchor, bodies: &[BodySnapshot]) -> Option<DVec3> {
    let Some(id) = anchor.body() else { return Some(anchor.place(|_| (DVec3::ZERO, DQuat::IDENTITY))) };
    let body = find(bodies, id.index())?;
    Some(anchor.place(|_| (body.location, body.orientation)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::simulate::Frames;

    fn scene(marks: &str) -> (Scene, Vec<BodySnapshot>) {
        let text = format!(
            "simulation = {{ duration = 0, gravity = [0, -10, 0] }}
            [body.a]\nshape.sphere.radius = 0.1\nlocation = [1, 2, 0]\nvelocity = [0, 3, 0]
            [body.b]\nshape.sphere.radius = 0.1\nlocation = [4, 6, 0]\n{marks}"
        );
        let scene = Scene::parse(&text).unwrap_or_else(|report| panic!("{report}"));
        let bodies = Frames::new(&scene).next().unwrap().unwrap().bodies.to_vec();
        (scene, bodies)
    }

    /// The angle between the x axis and the way from (1, 2) to (4, 6) has the tangent 4/3. About −z it is negative.
    #[test]
    fn an_angle_is_that_of_its_legs() {
        for (keys, expected) in [
            ("from = [2, 0, 0]\nto = 'b'", libm::atan2(4.0, 3.0)),
            ("from = 'b'\nto = [2, 0, 0]", libm::atan2(4.0, 3.0)),
            ("from = [2, 0, 0]\nto = 'b'\naxis = [0, 0, -1]", -libm::atan2(4.0, 3.0)),
            ("from = [1, 0, 9]\nto = 'b'\naxis = [0, 0, 5]", libm::atan2(4.0, 3.0)),
            ("from = [0, -1, 0]\nto = 'a.velocity'", std::f64::consts::PI),
            ("from = { point = [1, 2, -7] }\nto = { body = 'b', at = [-3, -4, -1e-9] }", 0.0),
            ("from = [1, 0, 0]\nto = 'a.acceleration'", std::f64::consts::FRAC_PI_2),
        ] {
            let (scene, bodies) = scene(&format!("[angle.alpha]\nat = 'a'\n{keys}"));
            let now = AngleNow::of(&scene.angles[0], &scene.bodies, &bodies).unwrap();
            assert!((now.value - expected).abs() < 1e-12, "{keys}: {now:?}");
            assert!(now.leg(0.0).abs_diff_eq(now.from, 1e-12) && now.leg(0.5).is_normalized());
        }
        let (scene, bodies) = scene("[angle.none]\nat = 'a'\nfrom = 'b.velocity'\nto = 'b'");
        assert_eq!(AngleNow::of(&scene.angles[0], &scene.bodies, &bodies), None, "b does not move");
    }

    #[test]
    fn a_distance_is_from_end_to_end_or_along_a_direction() {
        for (keys, expected, line) in [
            ("", 5.0, [[1.0, 2.0, 0.0], [4.0, 6.0, 0.0]]),
            ("along = [0, -2, 0]\noffset = [-1, 0, 0]", 4.0, [[0.0, 2.0, 0.0], [0.0, 6.0, 0.0]]),
        ] {
            let (scene, bodies) = scene(&format!("[distance.d]\nbetween = ['a', 'b']\n{keys}"));
            let now = DistanceNow::of(&scene.distances[0], &bodies).unwrap();
            assert!((now.value - expected).abs() < 1e-12, "{now:?}");
            assert!(now.line[0].abs_diff_eq(line[0].into(), 1e-12), "{now:?}");
            assert!(now.line[1].abs_diff_eq(line[1].into(), 1e-12), "{now:?}");
        }
    }

    /// The same throw, drawn from another origin, turned about the x axis, and in other units: lengths in units of 1 mm, times in units of 1 ms.
    /// Angles and the ratio of lengths stay the same, and an angle of a vanishing velocity is undefined in each.
    #[test]
    fn angles_do_not_depend_on_origin_axes_and_units() {
        let values = |[meter, second]: [f64; 2], shift: f64, turn: f64| {
            let (sin, cos) = libm::sincos(turn);
            let vector = |[x, y, z]: [f64; 3], unit: f64| {
                format!(
                    "[{:e}, {:e}, {:e}]",
                    unit * x,
                    unit * (y * cos - z * sin),
                    unit * (y * sin + z * cos)
                )
            };
            let (speed, fall) = (meter / second, meter / (second * second));
            let place = |point: [f64; 3]| vector([point[0] + shift, point[1], point[2]], meter);
            let text = format!(
                "simulation = {{ duration = {:e}, frame_rate = {:e}, gravity = {}, integrator = 'velocity-verlet' }}
                [body.a]\nshape.sphere.radius = {:e}\nlocation = {}\nvelocity = {}
                [body.b]\nshape.sphere.radius = {:e}\nlocation = {}\nvelocity = {}
                [angle.alpha]\nat = 'a'\nfrom = {}\nto = 'a.velocity'
                [angle.beta]\nat = 'a'\nfrom = 'a.acceleration'\nto = 'b'
                [angle.top]\nat = 'b'\nfrom = {}\nto = 'b.velocity'
                [distance.d]\nbetween = ['a', 'b']\nalong = {}",
                2.0 * second,
                10.0 / second,
                vector([0.0, -10.0, 0.0], fall),
                0.1 * meter,
                place([0.0, 1.0, 0.0]),
                vector([3.0, 4.0, 1.0], speed),
                0.1 * meter,
                place([2.0, 0.0, 0.5]),
                vector([0.0, 10.0, 0.0], speed),
                vector([1.0, 0.0, 0.0], 1.0),
                vector([1.0, 0.0, 0.0], 1.0),
                vector([1.0, 2.0, 0.0], 1.0),
            );
            let scene = Scene::parse(&text).unwrap_or_else(|report| panic!("{report}"));
            let frame = Frames::new(&scene).nth(10).unwrap().unwrap();
            let angle = |number: usize| AngleNow::of(&scene.angles[number], &scene.bodies, &frame.bodies);
            assert_eq!(angle(2), None, "b turns back at this moment, {:?}", frame.bodies[1].velocity);
            let length = DistanceNow::of(&scene.distances[0], &frame.bodies).unwrap().value / meter;
            [angle(0).unwrap().value, angle(1).unwrap().value, length]
        };
        let expected = values([1.0, 1.0], 0.0, 0.0);
        for found in [
            values([1.0, 1.0], 1000.0, 0.0),
            values([1.0, 1.0], 0.0, 0.7),
            values([1e3, 1e3], 0.0, 0.0),
            values([1e-9, 1.0], -1.0, 2.0),
        ] {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
            }
        }
    }
}
