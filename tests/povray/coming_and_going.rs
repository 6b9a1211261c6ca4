//! Tests that bodies of limited lifetime are visible while they exist, and that their scripts cause no warnings of POV-Ray.

use glam::DVec3;

use crate::image::{is_green, is_red};
use crate::pinhole::{Pinhole, SIZE};
use crate::povray::render_all;
use crate::scene::{DARK, script_of};

/// Checks two balls of one material, of which neither, one, both and the other exist in successive frames, and a ball of another material
/// with a trail.
#[test]
fn bodies_are_seen_while_they_are_there() {
    let camera = Pinhole::new([0.0, 0.0, 10.0], [0.0, 0.0, 0.0]);
    let ball = |name: &str, keys: &str| format!("[body.{name}]\nshape.sphere.radius = 0.5\n{keys}\n");
    let text = [
        "simulation = { duration = 4, frame_rate = 1 }\n".to_owned(),
        "[material.red]\ncolor = 'red'\nfinish = 'luminous'\n".to_owned(),
        ball("one", "material = 'red'\nlocation = [-2, 0, 0]\nstart = 1\nend = 2"),
        ball("other", "material = 'red'\nlocation = [2, 0, 0]\nstart = 2\nend = 3"),
        ball("fast", "material.color = 'lime'\nlocation = [-1, 1, 0]\nvelocity = [1, 0, 0]\nend = 2\ntrail = { width = 0.3, color = 'lime' }"),
        camera.toml(),
        DARK.to_owned(),
        format!("[output]\nsize = [{}, {}]\n", SIZE[0], SIZE[1]),
    ]
    .concat();
    let images = render_all([0, 1, 2, 3, 4].map(|frame| script_of(&text, frame)), SIZE);
    let sees = |x: f64, y: f64| camera.sees(DVec3::new(x, y, 0.0));
    for (frame, [one, other]) in
        [[false, false], [true, false], [true, true], [false, true], [false, false]].into_iter().enumerate()
    {
        assert_eq!(is_red(images[frame].at(sees(-2.0, 0.0))), one, "frame {frame}");
        assert_eq!(is_red(images[frame].at(sees(2.0, 0.0))), other, "frame {frame}");
    }
    // The trail stays visible after the ball has disappeared.
    for frame in [2, 3, 4] {
        assert!(is_green(images[frame].at(sees(0.0, 1.0))), "frame {frame}: the trail");
        assert_eq!(is_green(images[frame].at(sees(1.0, 1.35))), frame == 2, "frame {frame}: the ball");
    }
}
