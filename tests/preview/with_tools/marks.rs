//! Tests of angles, dimension lines and names of arrows on the page.

use crate::server::Scene;

/// The ball is far from the middle of the picture, so another viewpoint shows it elsewhere.
const MARKS: &str = "
    simulation.duration = 1
    [body.ball]
    shape.sphere.radius = 0.2
    location = [-3, 0, 0]
    velocity = [0, 2, 0]
    arrows.velocity = { scale = 0.3, label = 'v' }
    [body.other]
    shape.sphere.radius = 0.2
    location = [3, 0, 2]
    fixed = true
    [angle.alpha]
    at = 'ball'
    from = [1, 0, 0]
    to = 'ball.velocity'
    ";

in_the_browser! { Scene::of(MARKS), "marks.mjs":
    texts_stay_at_their_marks_from_every_viewpoint,
}
